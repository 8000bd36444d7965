// Superelements: dense matrices of a host that has reduced its structure itself, and its way back.
#include "capi/arguments.hpp"
#include "capi/barrier.hpp"
#include "capi/branch_input.hpp"
#include "capi/model_input.hpp"
#include "structure/dense_input.hpp"
#include <algorithm>

namespace plm::capi {
namespace {

/// A DOF of the whole structure in the coordinates of a basis: its row of the recovered columns.
vector<double> recovered_row(const ModelHandle &m, const SpaceVectors &vectors, std::int64_t full_dof) {
    vector<double> row;
    for (std::int64_t first = 0; first < vectors.cols(); first += recovery_block) {
        const std::int64_t some = std::min(recovery_block, vectors.cols() - first);
        const Field block = columns(vectors, first, some);
        Matrix motions(m.core->n_dof(), some);
        for (std::int64_t j = 0; j < some; ++j) m.core->expand(block, j, motions.col(j));
        const Matrix full = recovered(m.recovery, *m.owner, motions);
        for (std::int64_t j = 0; j < some; ++j) row.push_back(full(full_dof, j));
    }
    return row;
}

} // namespace
} // namespace plm::capi

using namespace plm::capi;

plm_status plm_model_set_dense_matrix(plm_model *model, std::int32_t which, std::int32_t part,
                                      const double *value, std::int64_t ld) {
    return call<ModelHandle>("plm_model_set_dense_matrix", model, [&](ModelHandle &m) {
        require_open(m);
        require_range(which, PLM_MASS, PLM_DAMPING, "which");
        require_range(part, PLM_FULL, PLM_UPPER, "part");
        require_pointer(value, "value");
        constexpr std::int64_t largest = 46340; // whose square BLAS can count
        if (m.input.n_dof > largest)
            bad_argument("model", -1,
                         plm::format("a dense matrix of %lld DOFs is too large; hand it over as a sparse one",
                                     static_cast<long long>(m.input.n_dof)));
        require_range(ld, m.input.n_dof, INT32_MAX, "ld");
        plm::DenseFormat format;
        format.n = m.input.n_dof, format.ld = ld, format.part = part;
        format.semi_definite = which != PLM_DAMPING;
        matrix_of(m.input, which) = plm::make_dense_input(format, value);
        return PLM_OK;
    });
}

plm_status plm_model_set_recovery(plm_model *model, std::int64_t n_full, plm_recover_fn fn, void *user) {
    return call<ModelHandle>("plm_model_set_recovery", model, [&](ModelHandle &m) {
        require_open(m);
        if (fn) require_range(n_full, 1, INT64_MAX / 64, "n_full");
        m.recovery = fn ? Recovery{n_full, fn, user} : Recovery();
        return PLM_OK;
    });
}

plm_status plm_model_recover(plm_model *model, std::int64_t n_columns, const double *reduced,
                             std::int64_t n_full, double *full) {
    return call<ModelHandle>("plm_model_recover", model, [&](ModelHandle &m) {
        const std::int64_t n_dof = m.core ? m.core->n_dof() : m.input.n_dof;
        require_range(n_columns, 0, INT64_MAX / 64 / n_dof, "n_columns");
        if (m.recovery.fn) require_range(n_full, m.recovery.n_full, m.recovery.n_full, "n_full");
        if (n_columns > 0) require_pointer(full, "full"), require_pointer(reduced, "reduced");
        require_finite_array(reduced, n_columns * n_dof, "reduced");
        plm::Matrix motions(n_dof, n_columns);
        std::copy_n(reduced, n_columns * n_dof, motions.data());
        const plm::Matrix all = recovered(m.recovery, *m.owner, motions);
        std::copy_n(all.data(), all.rows() * all.cols(), full);
        return PLM_OK;
    });
}

plm_status plm_model_recover_amplitude(plm_model *model, plm_branch *branch, std::int64_t full_dof,
                                       std::int32_t measure, std::int32_t harmonic, std::int64_t capacity,
                                       double *amplitude, std::int64_t *count) {
    return call<ModelHandle>("plm_model_recover_amplitude", model, [&](ModelHandle &m) {
        const plm::Branch &curve = *same_context<BranchHandle>(m, branch, "branch")->core;
        const plm::ReducedModel &reduced = curve.reduced();
        if (reduced.model != built(m))
            bad_argument("branch", -1,
                         "the branch was computed from another model, or before the loads of this one were "
                         "changed; name the one it is of, or compute it again");
        if (m.recovery.fn) require_range(full_dof, 0, m.recovery.n_full - 1, "full_dof");
        require_measure(curve, 0, measure, harmonic);
        plm::vector<double> values(curve.points().size());
        if (amplitude) {
            plm::DofInBasis dof{recovered_row(m, reduced.vectors, full_dof), {}};
            dof.of_static =
                reduced.same_static ? dof.of_dynamic : recovered_row(m, reduced.vectors_0, full_dof);
            const double h = static_cast<double>(curve.n_harmonics()); // extrema: a grid of 16 H instants
            for (std::size_t k = 0; k < values.size(); ++k) {
                plm::worked(200 * h * h);
                values[k] = curve.amplitude(static_cast<std::int64_t>(k), dof,
                                            static_cast<plm::Measure>(measure), harmonic);
            }
        }
        plm::require_finite_result(values.data(), static_cast<std::int64_t>(values.size()), "amplitude");
        return put_array(values, capacity, amplitude, count);
    });
}
