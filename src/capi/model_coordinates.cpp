// Where the DOFs of a model are.
#include "capi/barrier.hpp"
#include "capi/node_tables.hpp"

namespace plm::capi {
namespace {

template <class Index>
plm_status set_coordinates(const char *function, plm_model *model, std::int32_t index_base,
                           const NodeArrays<Index> &x) {
    return call<ModelHandle>(function, model, [&](ModelHandle &m) {
        require_open(m);
        require_index_base(index_base);
        require_range(x.n, 0, INT64_MAX / 64, "n");
        NodeReader<Index> reader(index_base, m.input.n_dof);
        vector<CoupledNode> nodes = reader.take(x, true);
        reader.refuse_repeated_dofs();
        m.input.nodes.swap(nodes);
        return PLM_OK;
    });
}

} // namespace
} // namespace plm::capi

using namespace plm::capi;

plm_status plm_model_set_coordinates_i32(plm_model *model, std::int32_t index_base, std::int64_t n,
                                         std::int32_t per_node, const std::int32_t *dof, const double *xyz) {
    return set_coordinates<std::int32_t>("plm_model_set_coordinates_i32", model, index_base,
                                         {"dof", "xyz", "per_node", n, per_node, dof, xyz});
}

plm_status plm_model_set_coordinates_i64(plm_model *model, std::int32_t index_base, std::int64_t n,
                                         std::int32_t per_node, const std::int64_t *dof, const double *xyz) {
    return set_coordinates<std::int64_t>("plm_model_set_coordinates_i64", model, index_base,
                                         {"dof", "xyz", "per_node", n, per_node, dof, xyz});
}
