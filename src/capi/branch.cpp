#include "capi/arguments.hpp"
#include "capi/barrier.hpp"
#include "capi/branch_end.hpp"
#include "capi/branch_input.hpp"
#include "contact/trig_polynomial.hpp"
#include "linalg/scale.hpp"
#include "linalg/work.hpp"
#include "motions/motion_measures.hpp"
#include "motions/penetration.hpp"
#include "orbits/periodicity.hpp"
#include <algorithm>

namespace plm::capi {

const std::shared_ptr<const Branch> &built(const BranchHandle &h) {
    return h.core;
}

plm_status end_status(std::int32_t reason) {
    switch (reason) {
    case PLM_REASON_NONE:
    case PLM_REASON_RANGE_END:
    case PLM_REASON_LOOP_CLOSED:
        return PLM_OK;
    case PLM_REASON_POINT_LIMIT:
    case PLM_REASON_EFFORT:
    case PLM_REASON_UNFINISHED:
        return PLM_TRUNCATED;
    case PLM_REASON_CANCELLED:
        return PLM_CANCELLED;
    default:
        return PLM_NOT_CONVERGED;
    }
}

void require_point(const Branch &branch, std::int64_t point) {
    require_range(point, 0, static_cast<std::int64_t>(branch.points().size()) - 1, "point");
}

void require_measure(const Branch &branch, std::int64_t dof, std::int32_t measure, std::int32_t harmonic) {
    require_range(dof, 0, branch.reduced().model->n_outputs() - 1, "dof");
    require_range(measure, PLM_PEAK, PLM_HARMONIC, "measure");
    if (measure == PLM_HARMONIC) require_range(harmonic, 0, branch.n_harmonics(), "harmonic");
}

namespace {

template <class T> void copy_out(const vector<T> &from, T *to) {
    if (to) std::copy(from.begin(), from.end(), to);
}

} // namespace
} // namespace plm::capi

using namespace plm::capi;

plm_status plm_branch_destroy(plm_branch **branch) {
    return destroy<BranchHandle>(branch);
}

plm_status plm_branch_get_amplitude(plm_branch *branch, std::int64_t dof, std::int32_t measure,
                                    std::int32_t harmonic, std::int64_t capacity, double *amplitude,
                                    std::int64_t *count) {
    return call<BranchHandle>("plm_branch_get_amplitude", branch, [&](BranchHandle &b) {
        require_measure(*b.core, dof, measure, harmonic);
        plm::vector<double> values(b.core->points().size());
        const double harmonics =
            static_cast<double>(b.core->n_harmonics()); // extrema: a grid of 16 H instants
        for (std::size_t k = 0; k < values.size() && amplitude; ++k) {
            plm::worked(200 * harmonics * harmonics);
            values[k] = b.core->amplitude(static_cast<std::int64_t>(k), dof,
                                          static_cast<plm::Measure>(measure), harmonic);
        }
        plm::require_finite_result(values.data(), static_cast<std::int64_t>(values.size()), "amplitude");
        return put_array(values, capacity, amplitude, count);
    });
}

plm_status plm_branch_get_coefficients(plm_branch *branch, std::int64_t point, std::int64_t first_dof,
                                       std::int64_t n, double *coefficient) {
    return call<BranchHandle>("plm_branch_get_coefficients", branch, [&](BranchHandle &b) {
        require_point(*b.core, point);
        const std::int64_t n_outputs = b.core->reduced().model->n_outputs(),
                           rows = 2 * b.core->n_harmonics() + 1;
        require_range(first_dof, 0, n_outputs - 1, "first_dof");
        require_range(n, 1, n_outputs - first_dof, "n");
        require_pointer(coefficient, "coefficient");
        plm::Matrix all(rows, n); // nothing is written unless all of it is known
        for (std::int64_t j = 0; j < n; ++j) copy_out(b.core->coefficients(point, first_dof + j), all.col(j));
        plm::require_finite_result(all.data(), rows * n, "coefficient");
        std::copy(all.data(), all.data() + rows * n, coefficient);
        return PLM_OK;
    });
}

plm_status plm_branch_get_history(plm_branch *branch, std::int64_t point, std::int64_t dof,
                                  std::int64_t n_times, double *q) {
    return call<BranchHandle>("plm_branch_get_history", branch, [&](BranchHandle &b) {
        require_point(*b.core, point);
        require_range(dof, 0, b.core->reduced().model->n_outputs() - 1, "dof");
        require_range(n_times, 1, 1 << 20, "n_times");
        require_pointer(q, "q");
        plm::worked(20.0 * static_cast<double>(n_times * (2 * b.core->n_harmonics() + 1)));
        const plm::vector<double> found = b.core->history(point, dof, n_times);
        plm::require_finite_result(found.data(), n_times, "q");
        copy_out(found, q);
        return PLM_OK;
    });
}

plm_status plm_branch_get_field(plm_branch *branch, std::int64_t point, double time_fraction, std::int64_t n,
                                double *q) {
    return call<BranchHandle>("plm_branch_get_field", branch, [&](BranchHandle &b) {
        require_point(*b.core, point);
        require_finite(time_fraction, "time_fraction");
        const plm::Model &model = *b.core->reduced().model;
        require_range(n, model.n_dof(), model.n_dof(), "n");
        require_pointer(q, "q");
        const plm::Field field = b.core->field(point, time_fraction);
        plm::require_finite_result(field, "q");
        model.expand(field, 0, q);
        return PLM_OK;
    });
}

plm_status plm_branch_get_contact(plm_branch *branch, std::int64_t point, std::int64_t n_times,
                                  double *penetration, double *force, std::int32_t *closed) {
    return call<BranchHandle>("plm_branch_get_contact", branch, [&](BranchHandle &b) {
        require_point(*b.core, point);
        require_range(n_times, 1, 1 << 24, "n_times");
        const plm::Matrix u = b.core->penetration_coefficients(point);
        const plm::ContactMotion law =
            plm::whole_contact_motion(b.core->reduced(), b.core->points()[static_cast<std::size_t>(point)]);
        const plm::Matrix motion = law.u.transposed();
        const std::int64_t z = u.cols();
        for (std::int64_t k = 0; k < n_times; ++k) {
            plm::worked(40.0 * static_cast<double>(z * motion.rows()));
            for (std::int64_t i = 0; i < z; ++i) {
                const double t = 2 * M_PI * static_cast<double>(k) / static_cast<double>(n_times);
                const double v = plm::evaluate_trig(motion.col(i), (motion.rows() - 1) / 2, t).value;
                if (penetration)
                    penetration[i + k * z] = plm::evaluate_trig(u.col(i), b.core->n_harmonics(), t).value;
                if (force)
                    force[i + k * z] =
                        plm::ContactLaw::force((*law.stiffness)[static_cast<std::size_t>(i)], v);
                if (closed) closed[i + k * z] = plm::ContactLaw::closed(v);
            }
        }
        return PLM_OK;
    });
}

plm_status plm_branch_get_closed_share(plm_branch *branch, std::int64_t point, std::int64_t n,
                                       double *share) {
    return call<BranchHandle>("plm_branch_get_closed_share", branch, [&](BranchHandle &b) {
        require_point(*b.core, point);
        const std::int64_t z = b.core->reduced().n_whole_pairs();
        require_range(n, z, z, "n");
        if (n > 0) require_pointer(share, "share");
        const plm::vector<double> found = b.core->closed_share(point);
        plm::require_finite_result(found.data(), z, "share");
        copy_out(found, share);
        return PLM_OK;
    });
}

plm_status plm_branch_get_energy(plm_branch *branch, std::int64_t point, double *energy,
                                 double *contact_area) {
    return call<BranchHandle>("plm_branch_get_energy", branch, [&](BranchHandle &b) {
        require_point(*b.core, point);
        const plm::MotionMeasures m = plm::measure_motion(
            b.core->reduced(), b.core->points()[static_cast<std::size_t>(point)], b.core->period_multiple());
        plm::require_finite_result(&m.total, 1, "energy");
        if (energy) *energy = m.total;
        if (contact_area) *contact_area = m.closed_share;
        return PLM_OK;
    });
}

plm_status plm_branch_get_multipliers(plm_branch *branch, std::int64_t point, std::int64_t capacity,
                                      double *real, double *imag, std::int64_t *count) {
    return call<BranchHandle>("plm_branch_get_multipliers", branch, [&](BranchHandle &b) {
        require_point(*b.core, point);
        return put_complex_array(b.core->points()[static_cast<std::size_t>(point)].multipliers, capacity,
                                 real, imag, count);
    });
}

plm_status plm_branch_get_periodicity_defect(plm_branch *branch, std::int64_t point, double *defect) {
    return call<BranchHandle>("plm_branch_get_periodicity_defect", branch, [&](BranchHandle &b) {
        require_point(*b.core, point);
        require_pointer(defect, "defect");
        const double found = plm::periodicity_defect(*b.core, point);
        plm::require_finite_result(&found, 1, "defect");
        *defect = found;
        return PLM_OK;
    });
}

plm_status plm_branch_get_full_residual(plm_branch *branch, std::int64_t point, double *relative_residual) {
    return call<BranchHandle>("plm_branch_get_full_residual", branch, [&](BranchHandle &b) {
        require_point(*b.core, point);
        require_pointer(relative_residual, "relative_residual");
        const double found = b.core->full_residual(point);
        plm::require_finite_result(&found, 1, "relative_residual");
        *relative_residual = found;
        return PLM_OK;
    });
}

plm_status plm_branch_describe(plm_branch *branch, std::int64_t capacity, char *buffer,
                               std::int64_t *needed) {
    return call<BranchHandle>("plm_branch_describe", branch, [&](BranchHandle &b) {
        return put_text(plm::report_of(*b.core, b.found.get()), capacity, buffer, needed);
    });
}
