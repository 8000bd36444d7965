// Harmonic balance in the contact gaps: U + g = B D(omega) (F - B' N(U)) + slack N (formulation.hpp; slack is
// 0 in the penalty form), D the receptance of the open structure in the reduced model's coordinates. Exact
// for the same reduced model as modal_system.cpp; the size of the dense system is the number of pairs that
// open and close over the period times (2H + 1), whatever the size of the model. Pairs whose tangent is
// constant in time are eliminated harmonic by harmonic, exactly, and come back the moment it is not.
#include "hbm/formulation.hpp"
#include "hbm/gap_response.hpp"
#include "hbm/make_system.hpp"
#include "hbm/moving_pairs.hpp"
#include "hbm/system.hpp"
#include "linalg/work.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

using Complex = std::complex<double>;

// Coefficient of harmonic h of item i as c - i s, in an array whose coefficient columns are `stride` long.
Complex read(const double *v, std::int64_t stride, std::int64_t h, std::int64_t i) {
    return h == 0 ? Complex(v[i]) : Complex(v[(2 * h - 1) * stride + i], -v[2 * h * stride + i]);
}
void write(Complex value, std::int64_t stride, std::int64_t h, std::int64_t i, double *v) {
    if (h == 0) {
        v[i] = value.real();
    } else {
        v[(2 * h - 1) * stride + i] = value.real();
        v[2 * h * stride + i] = -value.imag();
    }
}

// The pairs whose tangent in one harmonic is kappa != 0, constant in time: they are eliminated.
struct Constant {
    vector<std::int64_t> pairs;
    vector<double> kappa;
    vector<Complex> held; // the displacements of one solution
};

class GapSystem final : public HbmSystem {
  public:
    GapSystem(std::shared_ptr<const ReducedModel> reduced, const HbmOptions &options)
        : m_(std::move(reduced)), h_(options.n_harmonics), n_(2 * h_ + 1), z_(m_->n_pairs()), r_(m_->size()),
          r0_(m_->static_size()), force_(make_contact_force(options, z_)),
          form_(make_formulation(*m_, options)), response_(m_, form_, h_),
          motion_(m_->contact.gap_motion(h_, omega_)), u_(z_, n_), contact_(z_, n_), constant_(h_ + 1),
          eta_(h_ + 1), force_scale_(options.force_scale), equations_(h_), cosine_(z_), sine_(z_),
          response_of_load_(r_) {
        GapSystem::set_extra_gap(0);
        if (form_.compliant) law_ = std::make_shared<const vector<double>>(form_.stiffness);
    }

    std::int64_t size() const override { return z_ * n_; }
    std::int64_t static_size() const override { return z_; }
    void set_force_scale(double scale) override {
        force_scale_ = scale;
        set_extra_gap(extra_gap_);
    }
    void force_derivative(double *r) override { // -B D F, and what the gaps move
        std::fill(r, r + size(), 0.0);
        if (m_->contact.moves()) {
            add_mean_by_gaps(motion_.col(0), r);
            for (std::int64_t k = 0; k < size(); ++k) r[k] += motion_.data()[k];
        }
        take_response_to_loads(1.0, &LoadPart::growth, r);
    }

    void set_stiffness_factor(double factor) override { stiffness_factor_ = factor; }
    void set_self_excitation(double xi) override { response_.set_self_excitation(xi); }

    void contact_force_change(const Matrix &force, double *r) override { // B D B' N - slack N
        std::fill(r, r + size(), 0.0);
        vector<double> &c = cosine_, &q = sine_;
        std::fill(q.begin(), q.end(), 0.0);
        for (std::int64_t h = 0; h <= h_; ++h) {
            for (std::int64_t i = 0; i < z_; ++i) {
                c[i] = force(i, h == 0 ? 0 : 2 * h - 1);
                if (h > 0) q[i] = force(i, 2 * h);
            }
            response_.subtract(h, c, q, r);
        }
        for (std::int64_t k = 0; k < size(); ++k) r[k] = -r[k];
    }
    const Matrix &contact_force() const override { return contact_; }
    void contact_motion_change(const double *x, Matrix &u) override {
        u.reset(z_, n_);
        std::copy(x, x + size(), u.data());
    }

    void set_extra_gap(double extra) override {
        extra_gap_ = extra;
        gap_ = m_->contact.gaps(h_, gap_omega_, force_scale_);
        for (std::int64_t i = 0; i < z_; ++i) gap_(i, 0) += extra;
    }

    void gap_derivative(double *r) override {
        std::fill(r, r + size(), 0.0);
        const vector<double> wider(z_, 1.0);
        add_mean_by_gaps(wider.data(), r);
        for (std::int64_t i = 0; i < z_; ++i) r[i] += 1.0;
    }

    double residual_scale() const override { return norm2(size(), u_.data()); }
    // nothing else holds the structure against the mean of the loads
    bool in_balance() const override { return !response_.mean().carried_away(); }

    void residual(const double *x, double omega, double *r) override {
        std::copy(x, x + size(), u_.data());
        set_frequency(omega);
        force_->indicator(u_, indicator_);
        apply_indicator(indicator_, form_.stiffness, u_, contact_);
        for (std::int64_t k = 0; k < size(); ++k) contact_.data()[k] *= stiffness_factor_;
        hold_mean();
        respond();
        gaps_of_response(r);
        for (std::int64_t k = 0; k < size(); ++k) r[k] = u_.data()[k] - r[k];
    }

    void linearize() override {
        moving_.clear();
        for (std::int64_t i = 0; i < z_; ++i)
            if (indicator_.varies(i)) moving_.push_back(i);
        for (std::int64_t h = 0; h <= h_; ++h) eliminate(h);
        const std::int64_t s = n_moving();
        Matrix &tangent = equations_.tangent();
        tangent.reset(n_ * n_, s);
        for (std::int64_t p = 0; p < s; ++p) {
            const double *average = indicator_.averages.col(moving_[p]);
            for (std::int64_t c = 0; c < n_; ++c)
                for (std::int64_t row = 0; row < n_; ++row)
                    tangent(row + c * n_, p) =
                        stiffness_factor_ * form_.stiffness[moving_[p]] * indicator_entry(average, row, c);
            tangent(0, p) -= response_.mean().stiffness()[moving_[p]];
            worked(12.0 * static_cast<double>(n_ * n_));
        }
        equations_.factor();
    }

    void solve(double *b, std::int64_t n) override {
        for (std::int64_t k = 0; k < n; ++k) solve_one(b + k * size());
    }

    // The eliminated parts do not change the sign: complex for h >= 1, positive definite for h = 0.
    int determinant_sign() const override { return equations_.determinant_sign(); }

    void parameter_derivative(double *r) override {
        std::fill(r, r + size(), 0.0);
        vector<Complex> &v = response_of_load_;
        for (std::int64_t h = 1; h <= h_; ++h) { // d/d omega of -B D f = B D (dD^-1) D f
            response_.harmonic(h).derivative(eta_[h].data(), v.data());
            response_.harmonic(h).apply(v.data());
            response_.write_gaps(v, 1.0, r + (2 * h - 1) * z_);
        }
        take_response_to_loads(force_scale_, &LoadPart::growth_rate, r); // and -B D dF/d omega
        if (!m_->contact.moves_by_frequency()) return;
        Matrix change = m_->contact.gap_motion_change(h_, omega_);
        for (std::int64_t k = 0; k < size(); ++k) r[k] += change.data()[k] *= force_scale_;
        add_mean_by_gaps(change.col(0), r);
    }

    void linear_response(const vector<double> &coupling, double omega, double *x) override {
        std::fill(u_.data(), u_.data() + size(), 0.0);
        set_frequency(omega);
        constant_indicator(coupling, h_, indicator_);
        contact_.reset(z_, n_);
        hold_mean();
        respond(); // at u = 0 with zero force: R = -(B D F - g)
        gaps_of_response(x);
        linearize();
        solve(x, 1);
    }

    void to_point(const double *x, double omega, BranchPoint &point) override {
        vector<double> scratch(size());
        residual(x, omega, scratch.data());
        point.omega = omega;
        point.force_scale = force_scale_;
        point.period_multiple = 1;
        point.eta_0 = eta_0_;
        point.n_harmonics = h_;
        point.eta.reset(r_, 2 * h_);
        for (std::int64_t h = 1; h <= h_; ++h)
            for (std::int64_t j = 0; j < r_; ++j) {
                point.eta(j, 2 * h - 2) = eta_[h][j].real(); // eta = a - i b
                point.eta(j, 2 * h - 1) = -eta_[h][j].imag();
            }
        point.contact_stiffness = law_;
        point.contact_motion = law_ ? u_ : Matrix();
    }

    void from_point(const BranchPoint &point, double *x) override {
        if (law_ && point.contact_stiffness && *point.contact_stiffness == *law_) {
            const std::int64_t known = std::min(n_, point.contact_motion.cols()) * z_;
            std::copy(point.contact_motion.data(), point.contact_motion.data() + known, x);
            std::fill(x + known, x + size(), 0.0);
            return;
        }
        Matrix dynamic(z_, 2 * h_), eta = point.eta;
        set_harmonics(eta, h_);
        gemm('N', 'N', 1.0, m_->gap, eta, 0.0, dynamic);
        move_gaps(point.omega);
        gemv('N', 1.0, m_->gap_0, point.eta_0.data(), 0.0, x);
        std::copy(dynamic.data(), dynamic.data() + z_ * 2 * h_, x + z_);
        for (std::int64_t k = 0; k < size(); ++k) x[k] -= gap_.data()[k];
        if (law_) add_slack_of_penalty(x);
    }

  private:
    void set_frequency(double omega) {
        omega_ = omega;
        response_.set_frequency(omega);
        move_gaps(omega);
    }
    void move_gaps(double omega) {
        if (omega == gap_omega_ || !m_->contact.moves_by_frequency()) return;
        gap_omega_ = omega;
        motion_ = m_->contact.gap_motion(h_, omega);
        set_extra_gap(extra_gap_);
    }

    // r -= scale B D F, each part of the excitation with its factor at omega_.
    void take_response_to_loads(double scale, double (LoadPart::*factor)(double) const, double *r) {
        for (const auto &[part, load] : m_->excitation) {
            const std::int64_t h = part.harmonic;
            const double f = scale * (part.*factor)(omega_);
            if (h > h_ || f == 0) continue;
            if (h == 0) {
                vector<double> &v = mean_;
                v = load.real;
                response_.mean().apply(v.data());
                gemv('N', -f, m_->gap_0, v.data(), 1.0, r);
                continue;
            }
            vector<Complex> &v = response_of_load_;
            for (std::int64_t j = 0; j < r_; ++j) v[j] = Complex(load.real[j], load.imag[j]);
            response_.harmonic(h).apply(v.data());
            of_load_.resize(2 * z_);
            response_.write_gaps(v, -f, of_load_.data());
            for (std::int64_t k = 0; k < 2 * z_; ++k) r[(2 * h - 1) * z_ + k] += of_load_[k];
        }
    }

    // The reference stiffness pulls at u + g.
    void add_mean_by_gaps(const double *change, double *r) {
        vector<double> moved(response_.mean().stiffness()), v(r0_);
        for (std::int64_t i = 0; i < z_; ++i) moved[i] *= change[i];
        gemv('T', 1.0, m_->gap_0, moved.data(), 0.0, v.data());
        response_.mean().apply(v.data());
        gemv('N', -1.0, m_->gap_0, v.data(), 1.0, r);
    }

    void hold_mean() {
        if (!response_.mean().depends_on_contact()) return;
        fill_mean_load(mean_);
        response_.mean().hold(indicator_, mean_.data());
    }

    void fill_mean_load(vector<double> &load) const {
        load = m_->preload_0;
        for (const auto &[part, mean] : m_->excitation)
            for (std::int64_t j = 0; part.harmonic == 0 && j < r0_; ++j)
                load[j] += force_scale_ * part.growth(omega_) * mean.real[j];
    }

    // eta = D (F - B' N) for every harmonic, from contact_.
    void respond() {
        fill_mean_load(eta_0_);
        vector<double> &n = cosine_;
        for (std::int64_t i = 0; i < z_; ++i)
            n[i] = contact_(i, 0) - response_.mean().stiffness()[i] * (u_(i, 0) + gap_(i, 0));
        gemv('T', -1.0, m_->gap_0, n.data(), 1.0, eta_0_.data());
        response_.mean().apply(eta_0_.data());
        for (std::int64_t h = 1; h <= h_; ++h) {
            response_.gather(contact_.col(2 * h - 1), contact_.col(2 * h), -1.0, eta_[h]);
            for (const auto &[part, load] : m_->excitation)
                for (std::int64_t j = 0; part.harmonic == h && j < r_; ++j)
                    eta_[h][j] += force_scale_ * part.growth(omega_) * Complex(load.real[j], load.imag[j]);
            response_.harmonic(h).apply(eta_[h].data());
        }
    }

    // x = u becomes v = u + slack N with the force of the penalty law: a first guess.
    void add_slack_of_penalty(double *x) {
        std::copy(x, x + size(), u_.data());
        force_->indicator(u_, indicator_);
        apply_indicator(indicator_, m_->contact.stiffness, u_, contact_);
        for (std::int64_t k = 0; k < size(); ++k) x[k] += form_.slack[k % z_] * contact_.data()[k];
    }

    // out = B eta - g + slack N
    void gaps_of_response(double *out) {
        gemv('N', 1.0, m_->gap_0, eta_0_.data(), 0.0, out);
        for (std::int64_t h = 1; h <= h_; ++h) response_.write_gaps(eta_[h], 1.0, out + (2 * h - 1) * z_);
        for (std::int64_t k = 0; k < size(); ++k) out[k] -= gap_.data()[k];
        if (form_.compliant)
            for (std::int64_t k = 0; k < size(); ++k) out[k] += form_.slack[k % z_] * contact_.data()[k];
    }

    // Tangent of a pair that does not switch, in harmonic h, less the part in the reference system.
    double constant_tangent(std::int64_t i, std::int64_t h) const {
        const double k = stiffness_factor_ * form_.stiffness[i] * indicator_.constant_share(i);
        return h == 0 ? k - response_.mean().stiffness()[i] : k;
    }

    void eliminate(std::int64_t h) {
        Constant &e = constant_[h];
        e.pairs.clear();
        e.kappa.clear();
        for (std::int64_t i = 0; i < z_; ++i) {
            if (indicator_.varies(i)) continue;
            const double kappa = constant_tangent(i, h);
            if (kappa == 0) continue;
            e.pairs.push_back(i);
            e.kappa.push_back(kappa);
        }
        coupled_ = moving_;
        coupled_.insert(coupled_.end(), e.pairs.begin(), e.pairs.end());
        response_.receptance_of(h, coupled_, real_, imag_);
        equations_.elimination(h).build(real_, imag_, n_moving(), e.kappa);
    }

    void solve_one(double *b) {
        const std::int64_t s = n_moving();
        vector<double> &moving = moving_motion_, &y = force_of_motion_;
        moving.resize(s * n_);
        y.resize(s * n_);
        for (std::int64_t h = 0; h <= h_; ++h) condense(h, b, moving.data());
        equations_.solve(moving.data());
        equations_.force(moving.data(), y.data());
        for (std::int64_t h = 0; h <= h_; ++h) expand(h, moving.data(), y.data(), b);
    }

    // Right-hand side of the moving pairs in harmonic h; e.held keeps what expand() needs.
    void condense(std::int64_t h, const double *b, double *moving) {
        Constant &e = constant_[h];
        e.held.clear();
        for (std::int64_t i : e.pairs) e.held.push_back(read(b, z_, h, i));
        vector<Complex> &v = of_moving_;
        v.clear();
        for (std::int64_t i : moving_) v.push_back(read(b, z_, h, i));
        equations_.elimination(h).condense(e.held, v.data());
        for (std::int64_t p = 0; p < n_moving(); ++p) write(v[p], n_moving(), h, p, moving);
    }

    // Writes du of harmonic h for all pairs: moving and eliminated ones as solved, the others from B D B' y.
    void expand(std::int64_t h, const double *moving, const double *y, double *b) {
        Constant &e = constant_[h];
        vector<Complex> &held = e.held, &forces = of_moving_;
        forces.clear();
        for (std::int64_t p = 0; p < n_moving(); ++p) forces.push_back(read(y, n_moving(), h, p));
        equations_.elimination(h).expand(forces, held);
        vector<double> &c = cosine_, &q = sine_; // contact force y = c - i q of all pairs
        std::fill(c.begin(), c.end(), 0.0);
        std::fill(q.begin(), q.end(), 0.0);
        for (std::int64_t p = 0; p < n_moving(); ++p)
            c[moving_[p]] = forces[p].real(), q[moving_[p]] = -forces[p].imag();
        for (std::size_t j = 0; j < e.pairs.size(); ++j)
            c[e.pairs[j]] = e.kappa[j] * held[j].real(), q[e.pairs[j]] = -e.kappa[j] * held[j].imag();
        response_.subtract(h, c, q, b);
        for (std::size_t j = 0; j < e.pairs.size(); ++j) write(held[j], z_, h, e.pairs[j], b);
        for (std::int64_t p = 0; p < n_moving(); ++p)
            write(read(moving, n_moving(), h, p), z_, h, moving_[p], b);
    }

    std::int64_t n_moving() const { return static_cast<std::int64_t>(moving_.size()); }

    std::shared_ptr<const ReducedModel> m_;
    std::int64_t h_, n_, z_, r_, r0_;
    std::unique_ptr<ContactForce> force_;
    LawForm form_;
    GapResponse response_;
    std::shared_ptr<const vector<double>> law_; // for points; null: penalty
    double omega_ = 1, gap_omega_ = 1;
    Matrix motion_; // of the gaps at a force scale of 1, Z x (2H + 1), and the gaps themselves
    Matrix gap_, u_, contact_;
    std::vector<Constant> constant_;
    std::vector<vector<Complex>> eta_; // harmonics >= 1
    vector<double> eta_0_;
    double force_scale_, extra_gap_ = 0, stiffness_factor_ = 1;
    vector<std::int64_t> moving_;
    mutable MovingPairs equations_; // its sign may take a solution
    // of one call to the next: no iteration allocates
    vector<std::int64_t> coupled_;
    vector<double> mean_, cosine_, sine_, of_load_, moving_motion_, force_of_motion_;
    vector<Complex> response_of_load_, of_moving_;
    Matrix real_, imag_;
};

} // namespace

std::unique_ptr<HbmSystem> make_gap_system(std::shared_ptr<const ReducedModel> reduced,
                                           const HbmOptions &options) {
    return std::make_unique<GapSystem>(std::move(reduced), options);
}

} // namespace plm
