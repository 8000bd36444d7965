// How well a reduced solution satisfies the equations of the whole structure (paper, eq. (4)), harmonic by
// harmonic.
#include "contact/contact_force.hpp"
#include "hbm/branch.hpp"
#include "hbm/formulation.hpp"
#include "linalg/work.hpp"
#include <cmath>

namespace plm {
namespace {

// One harmonic of the full-order residual: cosine and sine column; h = 0 uses the first only.
class FullResidual {
  public:
    FullResidual(const ReducedModel &reduced, const BranchPoint &point, std::int64_t period_multiple)
        : reduced_(reduced), model_(*reduced.model), point_(point), period_multiple_(period_multiple),
          omega_(point.omega / static_cast<double>(period_multiple)) {}

    // contact: Z x (2H + 1) force coefficients. Adds |R|^2 in the K^-1 norm and |q|^2 in the K norm.
    void add_harmonic(std::int64_t h, const Matrix &contact, double &residual, double &energy) const {
        const Field q = h == 0 ? combine(reduced_.static_vectors(), point_.eta_0)
                               : combine(reduced_.vectors, point_.eta.columns(2 * h - 2, 2));
        const Field kq = model_.stiffness_times(q);
        Field r = kq;
        if (h > 0) add_dynamics(h, q, kq, r);
        add_forces(h, contact, r);
        Field solved = r;
        model_.solve(solved);
        for (double v : column_products(r, solved)) residual += v;
        for (double v : column_products(q, kq)) energy += v;
    }

  private:
    // -(h w)^2 M q and the damping, which couples cosine and sine.
    void add_dynamics(std::int64_t h, const Field &q, const Field &kq, Field &r) const {
        const double w = static_cast<double>(h) * omega_;
        const Damping &damping = model_.damping();
        const Field mq = model_.mass_times(q);
        Field loss(q.rows(), q.cols()); // C q w + eta K q
        add(w * damping.alpha, mq, loss);
        add(w * damping.beta + damping.structural, kq, loss);
        if (damping.has_matrix) add(w, model_.damping_times(q), loss);
        if (!damping.modal_ratio.empty()) add_modal_damping(h, w, loss);
        Matrix turned(2, 2); // the loss of the sine acts on the cosine, and the reverse
        turned(1, 0) = 1, turned(0, 1) = -1;
        add(-w * w, mq, r);
        add_combination(1.0, loss, turned, r);
    }

    // Modal damping lives on the modes that the basis contains: C q = M P c eta there.
    void add_modal_damping(std::int64_t h, double w, Field &loss) const {
        const Damping &damping = model_.damping();
        Matrix eta = point_.eta.columns(2 * h - 2, 2), ceta(reduced_.size(), 2);
        if (reduced_.damping.empty()) {
            for (std::int64_t c = 0; c < 2; ++c)
                for (std::int64_t j = 0; j < reduced_.size(); ++j)
                    ceta(j, c) = reduced_.damping_diagonal[j] * eta(j, c);
        } else {
            ceta = product('N', 'N', reduced_.damping, eta);
        }
        for (std::int64_t c = 0; c < 2; ++c)
            for (std::int64_t j = 0; j < reduced_.size(); ++j)
                ceta(j, c) -=
                    (damping.alpha * reduced_.mass(j) + damping.beta * reduced_.lambda[j]) * eta(j, c);
        if (damping.has_matrix) return; // its projection is inside c already and cannot be told apart
        add(w, model_.mass_times(combine(reduced_.vectors, ceta)), loss);
    }

    void add_forces(std::int64_t h, const Matrix &contact, Field &r) const {
        if (contact.rows() > 0)
            add(1.0, model_.gap_rows().forces(contact.columns(h == 0 ? 0 : 2 * h - 1, r.cols())), r);
        if (h == 0 && model_.has_preload()) add(-1.0, model_.preload(), r);
        if (h % period_multiple_ != 0) return;
        const auto found = model_.excitation().find(static_cast<int>(h / period_multiple_));
        if (found == model_.excitation().end()) return;
        Field force = found->second.real; // Re(F exp(i h w t)): the sine has -Im F
        if (h > 0) {
            force.append(found->second.imag);
            force.scale({1.0, -1.0});
        }
        add(-point_.force_scale, force, r);
    }

    const ReducedModel &reduced_;
    const Model &model_;
    const BranchPoint &point_;
    std::int64_t period_multiple_;
    double omega_; // of the response
};

// Z x (2H + 1). Those of an exact motion are its own: the first harmonics of the motion have others.
Matrix contact_forces_of(const ReducedModel &reduced, const BranchPoint &point) {
    if (point.motion && !reduced.all_pairs) return point.motion->contact_forces(point.n_harmonics);
    const ContactMotion motion = whole_contact_motion(reduced, point);
    ContactIndicator indicator;
    make_event_force(point.n_harmonics, motion.u.rows())->indicator(motion.u, indicator);
    Matrix contact;
    apply_indicator(indicator, *motion.stiffness, motion.u, contact);
    return contact;
}

} // namespace

double Branch::full_residual(std::int64_t point) const {
    const Matrix contact = contact_forces_of(*reduced_, points_[point]);
    const FullResidual full(*reduced_, points_[point], period_multiple_);
    double residual = 0, energy = 0;
    const std::int64_t last = points_[point].n_harmonics;
    for (std::int64_t h = 0; h <= last; ++h) {
        worked(1e4 *
               static_cast<double>(reduced_->model->n_free())); // of a factorization's back-substitution
        full.add_harmonic(h, contact, residual, energy);
    }
    return energy > 0 ? std::sqrt(std::max(0.0, residual) / energy) : std::sqrt(std::max(0.0, residual));
}

} // namespace plm
