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
    void add(std::int64_t h, const Matrix &contact, double &residual, double &energy) const {
        const std::int64_t n = model_.n_free();
        const Matrix q = h == 0 ? static_field() : dynamic_field(h);
        const Matrix kq = multiply(model_.stiffness(), q);
        Matrix r = kq;
        if (h > 0) add_dynamics(h, q, kq, r);
        add_forces(h, contact, r);
        Matrix solved = r;
        model_.factor().solve(solved);
        for (std::int64_t c = 0; c < q.cols(); ++c) {
            residual += dot(n, r.col(c), solved.col(c));
            energy += dot(n, q.col(c), kq.col(c));
        }
    }

  private:
    Matrix static_field() const {
        Matrix q(model_.n_free(), 1);
        gemv('N', 1.0, reduced_.static_vectors(), point_.eta_0.data(), 0.0, q.data());
        return q;
    }

    Matrix dynamic_field(std::int64_t h) const {
        return product('N', 'N', reduced_.vectors, point_.eta.columns(2 * h - 2, 2));
    }

    // -(h w)^2 M q and the damping, which couples cosine and sine.
    void add_dynamics(std::int64_t h, const Matrix &q, const Matrix &kq, Matrix &r) const {
        const double w = static_cast<double>(h) * omega_;
        const Damping &damping = model_.damping();
        const Matrix mq = multiply(model_.mass(), q);
        Matrix loss = mq; // C q w + eta K q
        for (std::int64_t k = 0; k < loss.rows() * 2; ++k)
            loss.data()[k] =
                w * damping.alpha * mq.data()[k] + (w * damping.beta + damping.structural) * kq.data()[k];
        if (damping.has_matrix) {
            const Matrix cq = multiply(model_.damping_matrix(), q);
            for (std::int64_t k = 0; k < loss.rows() * 2; ++k) loss.data()[k] += w * cq.data()[k];
        }
        if (!damping.modal_ratio.empty()) add_modal_damping(h, w, loss);
        for (std::int64_t i = 0; i < r.rows(); ++i) {
            r(i, 0) += -w * w * mq(i, 0) + loss(i, 1);
            r(i, 1) += -w * w * mq(i, 1) - loss(i, 0);
        }
    }

    // Modal damping lives on the modes that the basis contains: C q = M P c eta there.
    void add_modal_damping(std::int64_t h, double w, Matrix &loss) const {
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
        const Matrix extra = multiply(model_.mass(), product('N', 'N', reduced_.vectors, ceta));
        for (std::int64_t k = 0; k < loss.rows() * 2; ++k) loss.data()[k] += w * extra.data()[k];
    }

    void add_forces(std::int64_t h, const Matrix &contact, Matrix &r) const {
        vector<double> f(model_.n_free());
        for (std::int64_t c = 0; c < r.cols() && contact.rows() > 0; ++c) {
            multiply_transposed(model_.gap_matrix(), contact.col(h == 0 ? 0 : 2 * h - 1 + c), f.data());
            for (std::int64_t i = 0; i < r.rows(); ++i) r(i, c) += f[i];
        }
        if (h == 0 && model_.has_preload())
            for (std::int64_t i = 0; i < r.rows(); ++i) r(i, 0) -= model_.preload()[i];
        if (h % period_multiple_ != 0) return;
        const auto found = model_.excitation().find(static_cast<int>(h / period_multiple_));
        if (found == model_.excitation().end()) return;
        for (std::int64_t i = 0; i < r.rows(); ++i) {
            r(i, 0) -= point_.force_scale * found->second.real[i];
            if (h > 0 && !found->second.imag.empty()) r(i, 1) += point_.force_scale * found->second.imag[i];
        }
    }

    const ReducedModel &reduced_;
    const Model &model_;
    const BranchPoint &point_;
    std::int64_t period_multiple_;
    double omega_; // of the response
};

} // namespace

double Branch::full_residual(std::int64_t point) const {
    const ContactMotion motion = whole_contact_motion(*reduced_, points_[point]);
    ContactIndicator indicator;
    make_event_force(points_[point].n_harmonics, motion.u.rows())->indicator(motion.u, indicator);
    Matrix contact;
    apply_indicator(indicator, *motion.stiffness, motion.u, contact);
    const FullResidual full(*reduced_, points_[point], period_multiple_);
    double residual = 0, energy = 0;
    const std::int64_t last = points_[point].n_harmonics;
    for (std::int64_t h = 0; h <= last; ++h) {
        worked(1e4 *
               static_cast<double>(reduced_->model->n_free())); // of a factorization's back-substitution
        full.add(h, contact, residual, energy);
    }
    return energy > 0 ? std::sqrt(std::max(0.0, residual) / energy) : std::sqrt(std::max(0.0, residual));
}

} // namespace plm
