// Harmonic balance in reduced coordinates (paper, eq. (10)): x = [eta_0 (r_0); a_1; b_1; ...; a_H; b_H (r
// each)].
#include "hbm/make_system.hpp"
#include "hbm/modal_factor.hpp"
#include "hbm/system.hpp"
#include "motions/free_motion.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

class ModalSystem final : public HbmSystem {
  public:
    ModalSystem(std::shared_ptr<const ReducedModel> reduced, const HbmOptions &options)
        : m_(std::move(reduced)), h_(options.n_harmonics), r_(m_->size()), r0_(m_->static_size()),
          z_(m_->n_pairs()), force_(make_contact_force(options, z_)), stiffness_(m_->contact.stiffness),
          motion_(m_->contact.gap_motion(h_, omega_)), u_(z_, 2 * h_ + 1), contact_(z_, 2 * h_ + 1),
          x_(size(), 0.0), grows_(grow(m_->excitation) || m_->contact.moves_by_frequency()),
          jacobian_(m_, h_) {
        require_balanced(*m_);
        load_.assign(size(), 0.0);
        excitation_ = excitation_by(&LoadPart::growth);
        ModalSystem::set_force_scale(options.force_scale);
    }

    std::int64_t size() const override { return r0_ + 2 * h_ * r_; }
    std::int64_t static_size() const override { return r0_; }

    void set_force_scale(double scale) override {
        force_scale_ = scale;
        set_loads();
        set_gaps();
    }

    void force_derivative(double *r) override {
        std::fill(r, r + size(), 0.0);
        if (m_->contact.moves()) add_change_by_gaps(motion_, r);
        for (std::int64_t j = 0; j < size(); ++j) r[j] -= excitation_[j];
    }

    void set_stiffness_factor(double factor) override {
        for (std::int64_t i = 0; i < z_; ++i) stiffness_[i] = factor * m_->contact.stiffness[i];
    }

    void contact_force_change(const Matrix &force, double *r) override { // B' N
        std::fill(r, r + size(), 0.0);
        add_coordinates_of_gaps(m_->gap_0, m_->gap, 1.0, force, r);
    }
    const Matrix &contact_force() const override { return contact_; }

    void contact_motion_change(const double *x, Matrix &u) override {
        u.reset(z_, 2 * h_ + 1);
        gaps_of_coordinates(m_->gap_0, m_->gap, x, u);
    }

    void set_extra_gap(double extra) override {
        extra_gap_ = extra;
        set_gaps();
    }

    void gap_derivative(double *r) override {
        Matrix wider(z_, 2 * h_ + 1);
        for (std::int64_t i = 0; i < z_; ++i) wider(i, 0) = 1;
        std::fill(r, r + size(), 0.0);
        add_change_by_gaps(wider, r);
    }

    // Moving walls act through the contact alone.
    double residual_scale() const override {
        vector<double> pushed(size(), 0.0);
        if (m_->contact.moves()) add_coordinates_of_gaps(m_->gap_0, m_->gap, 1.0, contact_, pushed.data());
        return std::hypot(norm2(size(), load_.data()), norm2(size(), pushed.data()));
    }

    void residual(const double *x, double omega, double *r) override {
        x_.assign(x, x + size());
        set_omega(omega);
        penetration();
        force_->indicator(u_, indicator_);
        apply_indicator(indicator_, stiffness_, u_, contact_);
        hold_mean();
        for (std::int64_t j = 0; j < size(); ++j) r[j] = -load_[j];
        jacobian_.add_linear_product(x, r);
        add_coordinates_of_gaps(m_->gap_0, m_->gap, 1.0, contact_, r);
    }

    void linearize() override { factor_bordered(no_border_, factor_); }

    void solve(double *b, std::int64_t n) override { factor_.solve(b, n); }

    int determinant_sign() const override { return factor_.determinant_sign(); }

    void factor_bordered(const Border &border, ModalFactor &out) override {
        jacobian_.set_tangent(indicator_, stiffness_);
        out.factor(jacobian_, border);
    }

    void jacobian_product(const double *v, double *r) override {
        jacobian_.set_tangent(indicator_, stiffness_);
        jacobian_.expand_tangent();
        jacobian_.product(false, v, r);
    }

    void set_self_excitation(double xi) override { jacobian_.set_self_excitation(xi); }

    void parameter_derivative(double *r) override {
        parameter_derivative_of_structure(r);
        if (!m_->contact.moves_by_frequency()) return;
        Matrix change = m_->contact.gap_motion_change(h_, omega_);
        for (std::int64_t k = 0; k < change.rows() * change.cols(); ++k) change.data()[k] *= force_scale_;
        add_change_by_gaps(change, r);
    }

    void parameter_derivative_of_structure(double *r) override {
        std::fill(r, r + size(), 0.0);
        for (std::int64_t h = 1; h <= h_; ++h) {
            const double *a = x_.data() + cosine_at(h), *b = a + r_;
            double *rc = r + cosine_at(h), *rs = rc + r_;
            const double k = static_cast<double>(h), mass = -2 * k * k * omega_,
                         excitation = -4 * k * jacobian_.self_excitation() * omega_;
            for (std::int64_t j = 0; j < r_; ++j) {
                rc[j] = m_->mass(j) * (mass * a[j] + excitation * b[j]);
                rs[j] = m_->mass(j) * (mass * b[j] - excitation * a[j]);
            }
            add_damping_product(k, b, rc);
            add_damping_product(-k, a, rs);
        }
        if (!grows_) return;
        const vector<double> change = excitation_by(&LoadPart::growth_rate);
        for (std::int64_t j = 0; j < size(); ++j) r[j] -= force_scale_ * change[j];
    }

    // Each harmonic answers to its own load alone, as the first one at its frequency would.
    void linear_response(const vector<double> &coupling, double omega, double *x) override {
        set_omega(omega);
        std::fill(x, x + size(), 0.0);
        ModalJacobian linear(m_, 1);
        constant_indicator(coupling, 1, indicator_);
        linear.set_hold(indicator_, load_.data());
        linear.set_tangent(indicator_, stiffness_);
        for (std::int64_t h = 1; h <= h_; ++h) {
            const vector<double> loads = loads_with_walls(coupling, h);
            const double *load = loads.data();
            if (h > 1 && std::all_of(load, load + 2 * r_, [](double f) { return f == 0; })) continue;
            linear.set_omega(static_cast<double>(h) * omega);
            linear.set_self_excitation(jacobian_.self_excitation() / static_cast<double>(h));
            factor_.factor(linear, no_border_);
            vector<double> b(static_cast<std::size_t>(linear.size()));
            if (h == 1) put_mean_load(coupling, b.data());
            std::copy_n(load, 2 * r_, b.data() + r0_);
            factor_.solve(b.data(), 1);
            if (h == 1) std::copy_n(b.data(), r0_, x);
            std::copy_n(b.data() + r0_, 2 * r_, x + cosine_at(h));
        }
    }

    void to_point(const double *x, double omega, BranchPoint &point) override {
        point.omega = omega;
        point.force_scale = force_scale_;
        point.period_multiple = 1;
        point.eta_0.assign(x, x + r0_);
        point.n_harmonics = h_;
        point.eta.reset(r_, 2 * h_);
        std::copy(x + r0_, x + size(), point.eta.data());
        point.contact_stiffness = nullptr; // the penalty law, whatever the point was before
        point.contact_motion = Matrix();
    }

    void from_point(const BranchPoint &point, double *x) override {
        std::copy(point.eta_0.begin(), point.eta_0.end(), x);
        const std::int64_t known = std::min(point.eta.cols(), 2 * h_) * r_;
        std::copy(point.eta.data(), point.eta.data() + known, x + r0_);
        std::fill(x + r0_ + known, x + size(), 0.0);
    }

  private:
    void set_omega(double omega) {
        const bool load_changes = grows_ && omega != omega_;
        omega_ = omega;
        jacobian_.set_omega(omega);
        if (!load_changes) return;
        excitation_ = excitation_by(&LoadPart::growth);
        set_loads();
        if (!m_->contact.moves_by_frequency()) return;
        motion_ = m_->contact.gap_motion(h_, omega_);
        set_gaps();
    }
    void set_loads() {
        for (std::int64_t j = 0; j < size(); ++j) load_[j] = force_scale_ * excitation_[j];
        for (std::int64_t j = 0; j < r0_; ++j) load_[j] += m_->preload_0[j];
    }
    void put_mean_load(const vector<double> &coupling, double *b) const {
        vector<double> gap_force(z_); // -B' k s (-g)
        for (std::int64_t i = 0; i < z_; ++i) gap_force[i] = stiffness_[i] * coupling[i] * gap_(i, 0);
        std::copy_n(load_.data(), r0_, b);
        if (z_ > 0) gemv('T', 1.0, m_->gap_0, gap_force.data(), 1.0, b);
    }
    // Cosine and sine of one harmonic (2 r), with what moving walls do through the springs of the coupling.
    vector<double> loads_with_walls(const vector<double> &coupling, std::int64_t h) const {
        vector<double> load(load_.begin() + cosine_at(h), load_.begin() + cosine_at(h) + 2 * r_),
            gap_force(z_);
        for (std::int64_t part = 0; part < 2 && m_->contact.moves(); ++part) {
            for (std::int64_t i = 0; i < z_; ++i)
                gap_force[i] = stiffness_[i] * coupling[i] * gap_(i, 2 * h - 1 + part);
            gemv('T', 1.0, m_->gap, gap_force.data(), 1.0, load.data() + part * r_);
        }
        return load;
    }
    // Of a change of the gaps, r += B' dN, dN = -k J(s) dg, at the last residual().
    void add_change_by_gaps(const Matrix &change, double *r) const {
        Matrix force;
        apply_indicator(indicator_, stiffness_, change, force);
        add_coordinates_of_gaps(m_->gap_0, m_->gap, -1.0, force, r);
    }
    void set_gaps() {
        gap_ = m_->contact.gaps(h_, omega_, force_scale_);
        for (std::int64_t i = 0; i < z_; ++i) gap_(i, 0) += extra_gap_;
    }
    void hold_mean() { jacobian_.set_hold(indicator_, load_.data()); }
    std::int64_t cosine_at(std::int64_t h) const { return jacobian_.cosine_at(h); }

    // At omega_, each part with its growth, or by how much it changes with the frequency.
    vector<double> excitation_by(double (LoadPart::*factor)(double) const) const {
        vector<double> sum(size(), 0.0);
        for (const auto &[part, load] : m_->excitation) {
            if (part.harmonic > h_) continue;
            const double f = (part.*factor)(omega_);
            for (std::int64_t j = 0; part.harmonic == 0 && j < r0_; ++j) sum[j] += f * load.real[j];
            if (part.harmonic == 0) continue;
            double *cosine = sum.data() + cosine_at(part.harmonic), *sine = cosine + r_;
            for (std::int64_t j = 0; j < r_; ++j) {
                cosine[j] += f * load.real[j]; // Re((F_r + i F_i) exp(i h t)) = F_r cos - F_i sin
                sine[j] -= f * load.imag[j];
            }
        }
        return sum;
    }

    void penetration() {
        gaps_of_coordinates(m_->gap_0, m_->gap, x_.data(), u_);
        for (std::int64_t k = 0; k < z_ * (2 * h_ + 1); ++k) u_.data()[k] -= gap_.data()[k];
    }

    // y += factor * C v
    void add_damping_product(double factor, const double *v, double *y) const {
        if (m_->damping.empty()) {
            for (std::int64_t j = 0; j < r_; ++j) y[j] += factor * m_->damping_diagonal[j] * v[j];
        } else {
            gemv('N', factor, m_->damping, v, 1.0, y);
        }
    }

    std::shared_ptr<const ReducedModel> m_;
    std::int64_t h_, r_, r0_, z_;
    std::unique_ptr<ContactForce> force_;
    vector<double> stiffness_, excitation_, load_;
    double omega_ = 1, force_scale_ = 1, extra_gap_ = 0;
    Matrix motion_; // of the gaps at a force scale of 1, Z x (2H + 1), and the gaps themselves
    Matrix gap_, u_, contact_;
    vector<double> x_;
    const bool grows_; // the excitation or the motion of walls, with the frequency
    ModalJacobian jacobian_;
    Border no_border_;
    ModalFactor factor_;
};

} // namespace

std::unique_ptr<HbmSystem> make_modal_system(std::shared_ptr<const ReducedModel> reduced,
                                             const HbmOptions &options) {
    return std::make_unique<ModalSystem>(std::move(reduced), options);
}

} // namespace plm
