// Outputs of a model beside its DOFs: sums of them, wherever a DOF is asked for.
#include "capi/barrier.hpp"
#include "capi/sparse_rows.hpp"

namespace plm::capi {
namespace {

template <class Index>
plm_status add_outputs(const char *function, plm_model *model, std::int32_t index_base, std::int64_t n,
                       const Index *row_ptr, const Index *dof, const double *coefficient,
                       std::int64_t *first_dof) {
    return call<ModelHandle>(function, model, [&](ModelHandle &m) {
        require_index_base(index_base);
        require_range(n, 1, INT64_MAX / 64, "n");
        require_pointer(first_dof, "first_dof");
        const SparseRows<Index> rows{"output row",
                                     "it never moves; leave it out, or check its coefficients",
                                     n,
                                     index_base,
                                     row_ptr,
                                     dof,
                                     coefficient};
        check_row_pointers(rows);
        std::vector<DofTerms> sums(static_cast<std::size_t>(n));
        for_entries(rows, m.input.n_dof, [&](std::int64_t i, std::int64_t j, double c) {
            sums[static_cast<std::size_t>(i)].push_back({j, c});
        });
        m.outputs->reserve(std::max(m.outputs->size() + sums.size(), 2 * m.outputs->size()));
        *first_dof = m.n_outputs();
        for (DofTerms &sum : sums) m.outputs->push_back(std::move(sum));
        return PLM_OK;
    });
}

} // namespace
} // namespace plm::capi

using namespace plm::capi;

plm_status plm_model_add_outputs_i32(plm_model *model, std::int32_t index_base, std::int64_t n,
                                     const std::int32_t *row_ptr, const std::int32_t *dof,
                                     const double *coefficient, std::int64_t *first_dof) {
    return add_outputs("plm_model_add_outputs_i32", model, index_base, n, row_ptr, dof, coefficient,
                       first_dof);
}

plm_status plm_model_add_outputs_i64(plm_model *model, std::int32_t index_base, std::int64_t n,
                                     const std::int64_t *row_ptr, const std::int64_t *dof,
                                     const double *coefficient, std::int64_t *first_dof) {
    return add_outputs("plm_model_add_outputs_i64", model, index_base, n, row_ptr, dof, coefficient,
                       first_dof);
}
