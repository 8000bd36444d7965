// How well a reduced solution satisfies the equations of the whole structure (paper, eq. (4)), harmonic by
// harmonic.
#include "contact/contact_force.hpp"
#include "linalg/work.hpp"
#include "motions/branch.hpp"
#include "motions/penetration.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

// Harmonics at once: solves and products with tall blocks cost several times less a column in blocks, of
// which some are held beside each other.
std::int64_t harmonics_at_once(const Model &model) {
    constexpr std::int64_t most = 8, entries = 1 << 20;
    return std::clamp<std::int64_t>(entries / std::max<std::int64_t>(1, model.n_free()), 1, most);
}

// Harmonics of the full-order residual, side by side with a cosine and a sine column each; h = 0, the mean,
// by itself with one column.
class FullResidual {
  public:
    FullResidual(const ReducedModel &reduced, const BranchPoint &point, std::int64_t period_multiple)
        : reduced_(reduced), model_(*reduced.model), point_(point), period_multiple_(period_multiple),
          omega_(point.omega / static_cast<double>(period_multiple)) {}

    // contact: Z x (2H + 1) force coefficients. Adds |R|^2 in the K^-1 norm and |q|^2 in the K norm.
    void add_mean(const Matrix &contact, double &residual, double &energy) const {
        const Field q = combine(reduced_.static_vectors(), point_.eta_0), kq = model_.stiffness_times(q);
        Field r = kq;
        if (contact.rows() > 0) add(1.0, model_.gap_rows().forces(contact.columns(0, 1)), r);
        if (model_.has_preload()) add(-1.0, model_.preload(), r);
        add_excitation({0}, r);
        add_norms(q, kq, r, residual, energy);
    }

    void add_harmonics(const vector<std::int64_t> &h, const Matrix &contact, double &residual,
                       double &energy) const {
        const std::int64_t first = 2 * h.front() - 2, columns = 2 * static_cast<std::int64_t>(h.size());
        const Matrix eta = point_.eta.columns(first, columns);
        const Field q = combine(reduced_.vectors, eta), kq = model_.stiffness_times(q);
        Field r = kq;
        add_dynamics(h, eta, q, kq, r);
        if (contact.rows() > 0) add(1.0, model_.gap_rows().forces(contact.columns(first + 1, columns)), r);
        add_excitation(h, r);
        add_norms(q, kq, r, residual, energy);
    }

  private:
    void add_norms(const Field &q, const Field &kq, const Field &r, double &residual, double &energy) const {
        Field solved = r;
        model_.solve(solved);
        for (double v : column_products(r, solved)) residual += v;
        for (double v : column_products(q, kq)) energy += v;
    }

    double frequency(std::int64_t h) const { return static_cast<double>(h) * omega_; }

    // What each harmonic makes of its two columns: `inertia` of them, and of damping by w loss +
    // constant_loss the sine's acting on the cosine, and the reverse.
    Matrix dynamics(const vector<std::int64_t> &h, double inertia, double loss, double constant_loss) const {
        const std::int64_t n = 2 * static_cast<std::int64_t>(h.size());
        Matrix d(n, n);
        for (std::int64_t c = 0; c < n; c += 2) {
            const double w = frequency(h[static_cast<std::size_t>(c / 2)]);
            d(c, c) = d(c + 1, c + 1) = -w * w * inertia;
            d(c + 1, c) = w * loss + constant_loss;
            d(c, c + 1) = -d(c + 1, c);
        }
        return d;
    }

    // -(h w)^2 M q and the damping.
    void add_dynamics(const vector<std::int64_t> &h, const Matrix &eta, const Field &q, const Field &kq,
                      Field &r) const {
        const Damping &damping = model_.damping();
        add_combination(1.0, model_.mass_times(q), dynamics(h, 1, damping.alpha, 0), r);
        if (damping.beta != 0 || damping.structural != 0)
            add_combination(1.0, kq, dynamics(h, 0, damping.beta, damping.structural), r);
        if (damping.has_matrix) add_combination(1.0, model_.damping_times(q), dynamics(h, 0, 1, 0), r);
        if (!damping.modal_ratio.empty()) add_modal_damping(h, eta, r);
    }

    // Modal damping lives on the modes that the basis contains: C q = M P c eta there.
    void add_modal_damping(const vector<std::int64_t> &h, const Matrix &eta, Field &r) const {
        const Damping &damping = model_.damping();
        if (damping.has_matrix) return; // its projection is inside c already and cannot be told apart
        Matrix ceta(reduced_.size(), eta.cols());
        if (!reduced_.damping.empty()) ceta = product('N', 'N', reduced_.damping, eta);
        for (std::int64_t c = 0; c < eta.cols(); ++c)
            for (std::int64_t j = 0; j < reduced_.size(); ++j) {
                if (reduced_.damping.empty()) ceta(j, c) = reduced_.damping_diagonal[j] * eta(j, c);
                ceta(j, c) -=
                    (damping.alpha * reduced_.mass(j) + damping.beta * reduced_.lambda[j]) * eta(j, c);
            }
        add_combination(1.0, model_.mass_times(combine(reduced_.vectors, ceta)), dynamics(h, 0, 1, 0), r);
    }

    void add_excitation(const vector<std::int64_t> &harmonics, Field &r) const {
        for (std::size_t k = 0; k < harmonics.size(); ++k) {
            const std::int64_t h = harmonics[k];
            if (h % period_multiple_ != 0) continue;
            for (const auto &[part, load] : model_.excitation()) {
                if (part.harmonic != h / period_multiple_) continue;
                Field force = load.real; // Re(F exp(i h w t)): the sine has -Im F
                if (h > 0) force.append(load.imag);
                Matrix place(force.cols(), r.cols());
                place(0, static_cast<std::int64_t>(2 * k)) = 1;
                if (h > 0) place(1, static_cast<std::int64_t>(2 * k + 1)) = -1;
                add_combination(-point_.force_scale * part.growth(point_.omega), force, place, r);
            }
        }
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
    const double back_substitution = 2e3 * static_cast<double>(reduced_->model->n_free()); // flops
    const std::int64_t last = points_[point].n_harmonics, block = harmonics_at_once(*reduced_->model);
    worked(back_substitution);
    reduced_->vectors.worth_forming(2 * last); // rather at once than after as many columns, one by one
    full.add_mean(contact, residual, energy);
    for (std::int64_t first = 1; first <= last; first += block) {
        vector<std::int64_t> harmonics;
        for (std::int64_t h = first; h <= last && h < first + block; ++h) harmonics.push_back(h);
        worked(back_substitution * static_cast<double>(harmonics.size()));
        full.add_harmonics(harmonics, contact, residual, energy);
    }
    return energy > 0 ? std::sqrt(std::max(0.0, residual) / energy) : std::sqrt(std::max(0.0, residual));
}

} // namespace plm
