// The model's matrices, damping and supports.
#include "capi/arguments.hpp"
#include "capi/barrier.hpp"
#include "capi/model_input.hpp"
#include "linalg/scale.hpp"
#include "structure/matrix_input.hpp"
#include <algorithm>

namespace plm::capi {

void require_open(const ModelHandle &m) {
    if (const char *why = m.frozen()) throw Error(PLM_ERR_STATE, why);
}

std::shared_ptr<const MatrixInput> &matrix_of(ModelInput &input, std::int32_t which) {
    return which == PLM_MASS ? input.mass : which == PLM_STIFFNESS ? input.stiffness : input.damping_matrix;
}

namespace {

template <class Index> struct MatrixArguments {
    std::int32_t which, storage, part, index_base, ownership;
    std::int64_t nnz;
    const Index *a, *b;
    const double *value;
};

template <class Index>
plm_status set_matrix(const char *function, plm_model *model, const MatrixArguments<Index> &x) {
    return call<ModelHandle>(function, model, [&](ModelHandle &m) {
        require_open(m);
        require_range(x.which, PLM_MASS, PLM_DAMPING, "which");
        require_range(x.storage, PLM_CSC, PLM_CSR, "storage");
        require_range(x.part, PLM_FULL, PLM_UPPER, "part");
        require_range(x.ownership, PLM_COPY, PLM_BORROW, "ownership");
        require_index_base(x.index_base);
        require_range(x.nnz, 0, INT64_MAX / 64, "nnz");
        if (x.storage != PLM_TRIPLETS || x.nnz > 0) require_pointer(x.a, "a");
        if (x.nnz > 0) require_pointer(x.b, "b"), require_pointer(x.value, "value");
        MatrixFormat layout;
        layout.n = m.input.n_dof, layout.nnz = x.nnz;
        layout.storage = x.storage, layout.part = x.part, layout.index_base = x.index_base;
        layout.negative_diagonal = x.which == PLM_DAMPING;
        layout.copy = false;
        MatrixInput(layout, x.a, x.b, x.value).check(); // before anything is copied
        layout.copy = x.ownership == PLM_COPY;
        auto matrix = std::make_shared<const MatrixInput>(layout, x.a, x.b, x.value);
        matrix_of(m.input, x.which) = std::move(matrix);
        return PLM_OK;
    });
}

template <class Index>
plm_status fix_dofs(const char *function, plm_model *model, std::int32_t index_base, std::int64_t n,
                    const Index *dof) {
    return call<ModelHandle>(function, model, [&](ModelHandle &m) {
        require_open(m);
        require_index_base(index_base);
        require_range(n, 0, INT64_MAX, "n");
        if (n > 0) require_pointer(dof, "dof");
        for (std::int64_t i = 0; i < n; ++i) require_dof(dof[i], index_base, m.input.n_dof, "dof", i);
        vector<std::int64_t> &fixed = m.input.fixed;
        fixed.reserve(std::max(fixed.size() + static_cast<std::size_t>(n), 2 * fixed.size()));
        for (std::int64_t i = 0; i < n; ++i) fixed.push_back(dof[i] - index_base);
        return PLM_OK;
    });
}

template <class Index>
plm_status set_elimination_order(const char *function, plm_model *model, std::int32_t index_base,
                                 std::int64_t n, const Index *dof) {
    return call<ModelHandle>(function, model, [&](ModelHandle &m) {
        require_open(m);
        require_index_base(index_base);
        const std::int64_t n_dof = m.input.n_dof;
        if (n != 0 && n != n_dof)
            bad_argument(
                "n", -1,
                format("n is %lld where the model has %lld DOFs: all of them, or none to remove the order",
                       static_cast<long long>(n), static_cast<long long>(n_dof)));
        if (n > 0) require_pointer(dof, "dof");
        vector<char> seen(n, 0);
        vector<std::int64_t> order(n);
        for (std::int64_t i = 0; i < n; ++i) {
            require_dof(dof[i], index_base, n_dof, "dof", i);
            order[i] = dof[i] - index_base;
            if (seen[order[i]]++)
                bad_argument("dof", i,
                             format("dof[%lld] = %lld comes a second time", static_cast<long long>(i),
                                    static_cast<long long>(dof[i])));
        }
        m.input.elimination_order.swap(order);
        return PLM_OK;
    });
}

void require_nonnegative(double value, const char *name) {
    if (!(value >= 0 && value <= largest_scale))
        bad_argument(name, -1,
                     format("%s is %g; it must be a number >= 0, and <= %g", name, value, largest_scale));
}

} // namespace
} // namespace plm::capi

using namespace plm::capi;

plm_status plm_model_set_matrix_i32(plm_model *model, std::int32_t which, std::int32_t storage,
                                    std::int32_t part, std::int32_t index_base, std::int32_t ownership,
                                    std::int64_t nnz, const std::int32_t *a, const std::int32_t *b,
                                    const double *value) {
    return set_matrix<std::int32_t>("plm_model_set_matrix_i32", model,
                                    {which, storage, part, index_base, ownership, nnz, a, b, value});
}

plm_status plm_model_set_matrix_i64(plm_model *model, std::int32_t which, std::int32_t storage,
                                    std::int32_t part, std::int32_t index_base, std::int32_t ownership,
                                    std::int64_t nnz, const std::int64_t *a, const std::int64_t *b,
                                    const double *value) {
    return set_matrix<std::int64_t>("plm_model_set_matrix_i64", model,
                                    {which, storage, part, index_base, ownership, nnz, a, b, value});
}

plm_status plm_model_set_rayleigh_damping(plm_model *model, double alpha, double beta) {
    return call<ModelHandle>("plm_model_set_rayleigh_damping", model, [&](ModelHandle &m) {
        require_nonnegative(alpha, "alpha");
        require_nonnegative(beta, "beta");
        return change_loads(
            m, [&](plm::ModelInput &input) { input.damping.alpha = alpha, input.damping.beta = beta; });
    });
}

plm_status plm_model_set_modal_damping(plm_model *model, std::int64_t n, const double *ratio) {
    return call<ModelHandle>("plm_model_set_modal_damping", model, [&](ModelHandle &m) {
        require_range(n, 0, INT64_MAX / 64, "n");
        if (n > 0) require_pointer(ratio, "ratio");
        for (std::int64_t j = 0; j < n; ++j)
            if (!(ratio[j] >= 0 && ratio[j] < 1))
                bad_argument("ratio", j,
                             plm::format("ratio[%lld] is %g; it must lie in [0, 1), the fraction of "
                                         "critical damping",
                                         static_cast<long long>(j), ratio[j]));
        plm::vector<double> copy(ratio, ratio + n);
        return change_loads(m, [&](plm::ModelInput &input) { input.damping.modal_ratio.swap(copy); });
    });
}

plm_status plm_model_set_structural_damping(plm_model *model, double eta) {
    return call<ModelHandle>("plm_model_set_structural_damping", model, [&](ModelHandle &m) {
        require_nonnegative(eta, "eta");
        return change_loads(m, [&](plm::ModelInput &input) { input.damping.structural = eta; });
    });
}

plm_status plm_model_fix_dofs_i32(plm_model *model, std::int32_t index_base, std::int64_t n,
                                  const std::int32_t *dof) {
    return fix_dofs("plm_model_fix_dofs_i32", model, index_base, n, dof);
}

plm_status plm_model_fix_dofs_i64(plm_model *model, std::int32_t index_base, std::int64_t n,
                                  const std::int64_t *dof) {
    return fix_dofs("plm_model_fix_dofs_i64", model, index_base, n, dof);
}

plm_status plm_model_set_elimination_order_i32(plm_model *model, std::int32_t index_base, std::int64_t n,
                                               const std::int32_t *dof) {
    return set_elimination_order("plm_model_set_elimination_order_i32", model, index_base, n, dof);
}

plm_status plm_model_set_elimination_order_i64(plm_model *model, std::int32_t index_base, std::int64_t n,
                                               const std::int64_t *dof) {
    return set_elimination_order("plm_model_set_elimination_order_i64", model, index_base, n, dof);
}
