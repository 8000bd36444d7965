// Linear constraints among the DOFs of the model, as rows or as multipliers of its matrices.
#include "capi/barrier.hpp"
#include "capi/sparse_rows.hpp"
#include "structure/couplings.hpp"

namespace plm::capi {
namespace {

template <class Index>
plm_status add_constraints(const char *function, plm_model *model, std::int32_t index_base, std::int64_t n,
                           const Index *row_ptr, const Index *dof, const double *coefficient) {
    return call<ModelHandle>(function, model, [&](ModelHandle &m) {
        require_open(m);
        require_index_base(index_base);
        require_range(n, 0, INT64_MAX / 64, "n");
        const SparseRows<Index> rows{"constraint row",
                                     "it says nothing; leave it out, or check its coefficients",
                                     n,
                                     index_base,
                                     row_ptr,
                                     dof,
                                     coefficient};
        check_row_pointers(rows);
        ConstraintRows checked;
        for_entries(rows, m.input.n_dof, [&](std::int64_t, std::int64_t j, double c) {
            checked.dof.push_back(j);
            checked.coefficient.push_back(c);
        });
        for (std::int64_t i = 0; i < n; ++i) checked.ptr.push_back(row_ptr[i + 1] - index_base);
        append(m.input.constraints, checked);
        return PLM_OK;
    });
}

template <class Index>
plm_status set_multipliers(const char *function, plm_model *model, std::int32_t index_base, std::int64_t n,
                           const Index *dof) {
    return call<ModelHandle>(function, model, [&](ModelHandle &m) {
        require_open(m);
        require_index_base(index_base);
        require_range(n, 0, m.input.n_dof, "n");
        if (n > 0) require_pointer(dof, "dof");
        vector<char> seen(m.input.n_dof, 0);
        vector<std::int64_t> multipliers;
        for (std::int64_t i = 0; i < n; ++i) {
            require_dof(dof[i], index_base, m.input.n_dof, "dof", i);
            multipliers.push_back(dof[i] - index_base);
            if (seen[multipliers.back()]++)
                bad_argument("dof", i,
                             format("dof[%lld] = %lld comes a second time", static_cast<long long>(i),
                                    static_cast<long long>(dof[i])));
        }
        m.input.multipliers.swap(multipliers);
        return PLM_OK;
    });
}

} // namespace
} // namespace plm::capi

using namespace plm::capi;

plm_status plm_model_add_constraints_i32(plm_model *model, std::int32_t index_base, std::int64_t n,
                                         const std::int32_t *row_ptr, const std::int32_t *dof,
                                         const double *coefficient) {
    return add_constraints("plm_model_add_constraints_i32", model, index_base, n, row_ptr, dof, coefficient);
}

plm_status plm_model_add_constraints_i64(plm_model *model, std::int32_t index_base, std::int64_t n,
                                         const std::int64_t *row_ptr, const std::int64_t *dof,
                                         const double *coefficient) {
    return add_constraints("plm_model_add_constraints_i64", model, index_base, n, row_ptr, dof, coefficient);
}

plm_status plm_model_set_multipliers_i32(plm_model *model, std::int32_t index_base, std::int64_t n,
                                         const std::int32_t *dof) {
    return set_multipliers("plm_model_set_multipliers_i32", model, index_base, n, dof);
}

plm_status plm_model_set_multipliers_i64(plm_model *model, std::int32_t index_base, std::int64_t n,
                                         const std::int64_t *dof) {
    return set_multipliers("plm_model_set_multipliers_i64", model, index_base, n, dof);
}
