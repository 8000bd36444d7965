#include "hbm/nonlinear_mode.hpp"
#include "hbm/continuation.hpp"
#include "hbm/start.hpp"
#include "model/rest.hpp"
#include <algorithm>
#include <cmath>

namespace plm {

NonlinearModeSystem::NonlinearModeSystem(HbmSystem &inner, std::int64_t n_coordinates, vector<double> shape,
                                         double omega_reference, double largest_amplitude)
    : AugmentedSystem(inner, 2), r_(n_coordinates), shape_(std::move(shape)),
      omega_reference_(omega_reference), largest_(largest_amplitude), y_(inner.size() + 2), x_(inner.size()) {
}

void NonlinearModeSystem::unscale(const double *y, double amplitude, double *x) const {
    for (std::int64_t i = 0; i < inner_.size(); ++i) x[i] = (i < static_size() ? largest_ : amplitude) * y[i];
}

// r += -2 xi omega M q' with factor = 2 xi omega^2.
void NonlinearModeSystem::add_self_excitation(const double *x, double factor, double *r) const {
    const std::int64_t s = static_size(), harmonics = (inner_.size() - s) / (2 * r_);
    for (std::int64_t h = 1; h <= harmonics; ++h) {
        const std::int64_t a = s + 2 * (h - 1) * r_, b = a + r_;
        for (std::int64_t j = 0; j < r_; ++j) {
            r[a + j] -= factor * static_cast<double>(h) * x[b + j];
            r[b + j] += factor * static_cast<double>(h) * x[a + j];
        }
    }
}

void NonlinearModeSystem::residual(const double *y, double log_amplitude, double *r) {
    const std::int64_t n = inner_.size(), s = static_size();
    y_.assign(y, y + n + 2);
    amplitude_ = std::exp(log_amplitude);
    unscale(y, amplitude_, x_.data());
    inner_.set_force_scale(0);
    inner_.residual(x_.data(), omega(), r);
    add_self_excitation(x_.data(), 2 * y[n + 1] * omega() * omega(), r);
    for (std::int64_t i = 0; i < n; ++i) r[i] /= i < s ? largest_ : amplitude_;
    const double scale = omega_reference_ * omega_reference_; // like the other equations
    r[n] = scale * dot(r_, shape_.data(), y + s + r_);
    r[n + 1] = scale * (dot(r_, shape_.data(), y + s) - 1);
}

double NonlinearModeSystem::residual_scale() const {
    return omega_reference_ * omega_reference_;
}

void NonlinearModeSystem::assemble(Matrix &jacobian) {
    const std::int64_t n = inner_.size(), s = static_size();
    assemble_inner(jacobian);
    const double w = omega(), xi = y_[n + 1];
    for (std::int64_t j = s; j < n; ++j) { // self-excitation couples cosine and sine of one coordinate
        const std::int64_t k = (j - s) / r_, h = k / 2 + 1;
        const double c = 2 * xi * w * w * static_cast<double>(h);
        k % 2 == 0 ? jacobian(j + r_, j) += c : jacobian(j - r_, j) -= c;
    }
    double *by_omega = jacobian.col(n), *by_xi = jacobian.col(n + 1);
    inner_.omega_derivative(by_omega);
    add_self_excitation(x_.data(), 4 * xi * w, by_omega);
    add_self_excitation(x_.data(), 2 * w * w, by_xi);
    for (std::int64_t i = 0; i < n; ++i) by_omega[i] *= omega_reference_;
    for (std::int64_t j = 0; j < n + 2; ++j)
        for (std::int64_t i = 0; i < n; ++i) {
            const double column = j >= n ? 1 : j < s ? largest_ : amplitude_;
            jacobian(i, j) *= column / (i < s ? largest_ : amplitude_);
        }
    const double scale = omega_reference_ * omega_reference_;
    for (std::int64_t j = 0; j < r_; ++j) {
        jacobian(n, s + r_ + j) = scale * shape_[j];
        jacobian(n + 1, s + j) = scale * shape_[j];
    }
}

// At a solution: the unknowns scaled by the amplitude change with it, x' = x_dynamic.
void NonlinearModeSystem::omega_derivative(double *r) {
    const std::int64_t n = inner_.size(), s = static_size();
    Matrix jacobian;
    assemble(jacobian);
    vector<double> y(y_);
    std::fill(y.begin(), y.begin() + s, 0.0);
    y[n] = y[n + 1] = 0;
    gemv('N', 1.0, jacobian, y.data(), 0.0, r);
    r[n] = r[n + 1] = 0; // the normalisation is that of the scaled unknowns
}

void NonlinearModeSystem::to_point(const double *y, double log_amplitude, BranchPoint &point) {
    vector<double> x(inner_.size());
    unscale(y, std::exp(log_amplitude), x.data());
    inner_.to_point(x.data(), omega_reference_ * (1 + y[inner_.size()]), point);
    point.force_scale = 0;
}

void NonlinearModeSystem::from_point(const BranchPoint &point, double *y) {
    const std::int64_t n = inner_.size(), s = static_size();
    inner_.from_point(point, y);
    const double amplitude = dot(r_, shape_.data(), y + s);
    for (std::int64_t i = 0; i < n; ++i) y[i] /= i < s ? largest_ : amplitude;
    y[n] = point.omega / omega_reference_ - 1;
    y[n + 1] = 0;
}

// --- energies

namespace {

// Static part: strain, contact and load of (eta, u) at rest.
double rest_energy(const ReducedModel &m) {
    vector<double> u(m.n_pairs());
    bool loaded = false;
    for (double f : m.preload_0) loaded = loaded || f != 0;
    for (double g : m.initial_gap) loaded = loaded || g < 0;
    if (!loaded) return 0;
    const StaticState rest =
        solve_static({m.lambda_0, m.gap_0, m.preload_0, m.contact_stiffness, m.initial_gap});
    double energy = -dot(m.static_size(), m.preload_0.data(), rest.coordinates.data());
    for (std::int64_t j = 0; j < m.static_size(); ++j)
        energy += 0.5 * m.lambda_0[j] * rest.coordinates[j] * rest.coordinates[j];
    for (std::int64_t i = 0; i < m.n_pairs(); ++i)
        energy += ContactLaw::energy(m.contact_stiffness[i], rest.penetration[i]);
    return energy;
}

Matrix penetration_of(const ReducedModel &m, const BranchPoint &point) {
    const std::int64_t z = m.n_pairs();
    Matrix u(z, point.eta.cols() + 1);
    for (std::int64_t i = 0; i < z; ++i) u(i, 0) = -m.initial_gap[i];
    gemv('N', 1.0, m.gap_0, point.eta_0.data(), 1.0, u.col(0));
    const Matrix dynamic = product('N', 'N', m.gap, point.eta);
    std::copy(dynamic.data(), dynamic.data() + z * dynamic.cols(), u.col(1));
    return u;
}

// <N u> / 2 with N in the harmonics of u: exact, since the others are orthogonal to u.
void measure_contact(const ReducedModel &m, const BranchPoint &point, MotionMeasures &out) {
    const std::int64_t z = m.n_pairs();
    if (z == 0) return;
    const Matrix u = penetration_of(m, point);
    ContactIndicator s;
    make_event_force(u.cols() / 2, z)->indicator(u, s);
    Matrix force;
    apply_indicator(s, m.contact_stiffness, u, force);
    for (std::int64_t c = 0; c < u.cols(); ++c)
        out.contact += (c == 0 ? 0.5 : 0.25) * dot(z, force.col(c), u.col(c));
    for (std::int64_t i = 0; i < z; ++i) out.closed_share += s.averages(0, i) / static_cast<double>(z);
}

} // namespace

MotionMeasures measure_motion(const ReducedModel &m, const BranchPoint &point, std::int64_t period_multiple) {
    MotionMeasures out;
    for (std::int64_t j = 0; j < m.static_size(); ++j) {
        out.strain += 0.5 * m.lambda_0[j] * point.eta_0[j] * point.eta_0[j];
        out.load -= m.preload_0[j] * point.eta_0[j];
    }
    for (std::int64_t c = 0; c < point.eta.cols(); ++c) {
        const double h = static_cast<double>(c / 2 + 1),
                     w = h * point.omega / static_cast<double>(period_multiple);
        for (std::int64_t j = 0; j < m.size(); ++j) {
            const double square = point.eta(j, c) * point.eta(j, c);
            out.kinetic += 0.25 * w * w * square;
            out.strain += 0.25 * m.lambda[j] * square;
        }
    }
    measure_contact(m, point, out);
    out.total = out.kinetic + out.strain + out.contact + out.load - rest_energy(m);
    return out;
}

// --- the path over the amplitude

namespace {

class ModePath final : public PathOwner {
  public:
    ModePath(std::shared_ptr<const ReducedModel> reduced, const NonlinearModeOptions &options, Watch watch)
        : m_(std::move(reduced)), options_(options), watch_(watch), share_(share_at_rest(*m_)) {
        HbmOptions &o = options_.hbm;
        o.unknowns = UnknownSpace::modal;
        o.period_multiple = 1;
        if (o.n_harmonics <= 0) o.n_harmonics = 7;
        o.force_scale = 0;
        inner_ = make_system(m_, o);
    }

    NonlinearMode run() {
        find_mode();
        find_amplitudes();
        system_ = std::make_unique<NonlinearModeSystem>(*inner_, m_->size(), shape_, omega_,
                                                        options_.amplitude_max);
        PathStart from = start();
        result_.branch = std::make_shared<Branch>(m_, 0.0);
        PathOptions range;
        range.low = std::log(options_.amplitude_min);
        range.high = std::log(options_.amplitude_max);
        range.upward = true;
        range.tolerance = options_.hbm.tolerance;
        range.max_iterations = options_.hbm.max_iterations;
        range.max_points = options_.hbm.max_points;
        range.min_step = options_.hbm.min_step;
        range.max_step = std::min(0.05, options_.hbm.max_step);
        const PathOutcome out = follow_path(*system_, range, from, *this);
        Branch &branch = *result_.branch;
        branch.end_reason = out.end_reason;
        branch.newton_iterations = out.newton_iterations;
        branch.factorizations = out.factorizations;
        branch.failed_steps = out.failed_steps;
        branch.space_used = "modal";
        return std::move(result_);
    }

    void record(const PathPoint &p) override {
        BranchPoint point;
        point.arclength = p.arclength;
        point.residual = p.residual;
        point.iterations = p.iterations;
        system_->to_point(p.x.data(), p.parameter, point);
        point.n_switching = system_->indicator().n_switching;
        result_.amplitude.push_back(std::exp(p.parameter));
        result_.damping_ratio.push_back(system_->damping_ratio(p.x.data()));
        result_.measures.push_back(measure_motion(*m_, point));
        result_.branch->append(std::move(point));
    }
    bool cancelled(double fraction) override {
        watch_.step("nonlinear mode", fraction);
        return false;
    }
    bool rescue(double, vector<double> &) override { return false; }

  private:
    // The mode about rest nearest to the frequency asked for.
    void find_mode() {
        const ReducedModel &m = *m_;
        const std::int64_t r = m.size();
        Matrix k(r, r), coupled = m.gap;
        for (std::int64_t i = 0; i < m.n_pairs(); ++i)
            for (std::int64_t j = 0; j < r; ++j) coupled(i, j) *= share_[i] * m.contact_stiffness[i];
        if (m.n_pairs() > 0) gemm('T', 'N', 1.0, m.gap, coupled, 0.0, k);
        for (std::int64_t j = 0; j < r; ++j) k(j, j) += m.lambda[j];
        const SymmetricEigen modes = symmetric_eigen(k);
        const double wanted = 2 * M_PI * options_.frequency_hz;
        std::int64_t best = -1;
        for (std::int64_t j = 0; j < r; ++j) {
            const double omega = std::sqrt(std::max(0.0, modes.values[j]));
            if (omega > 0 && (best < 0 || std::abs(omega - wanted) < std::abs(omega_ - wanted)))
                best = j, omega_ = omega;
        }
        if (best < 0)
            throw Error(PLM_ERR_ARGUMENT, "the structure at rest has no elastic mode")
                .argument("frequency_hz");
        shape_.assign(modes.vectors.col(best), modes.vectors.col(best) + r);
    }

    // Amplitude at which the first pair changes its state.
    void find_amplitudes() {
        if (options_.amplitude_min > 0 && options_.amplitude_max > options_.amplitude_min) return;
        vector<double> x(inner_->size());
        inner_->linear_response(share_, omega_, x.data());
        const ReducedModel &m = *m_;
        double first = 0;
        for (std::int64_t i = 0; i < m.n_pairs(); ++i) {
            double rest = -m.initial_gap[i], swing = 0;
            for (std::int64_t j = 0; j < m.static_size(); ++j) rest += m.gap_0(i, j) * x[j];
            for (std::int64_t j = 0; j < m.size(); ++j) swing += m.gap(i, j) * shape_[j];
            if (swing != 0 && share_[i] != 0.5 && (first == 0 || std::abs(rest / swing) < first))
                first = std::abs(rest / swing);
        }
        if (first == 0)
            throw Error(PLM_ERR_ARGUMENT,
                        "no pair changes its state at a certain amplitude: give the range of amplitudes")
                .argument("amplitude_min");
        if (options_.amplitude_min <= 0) options_.amplitude_min = 0.5 * first;
        if (options_.amplitude_max <= options_.amplitude_min) options_.amplitude_max = 100 * first;
    }

    PathStart start() {
        vector<double> x(inner_->size());
        inner_->linear_response(share_, omega_, x.data());
        std::fill(x.begin() + m_->static_size(), x.end(), 0.0);
        for (std::int64_t j = 0; j < m_->size(); ++j)
            x[m_->static_size() + j] = options_.amplitude_min * shape_[j];
        BranchPoint guess;
        inner_->to_point(x.data(), omega_, guess);
        PathStart from;
        from.x.resize(system_->size());
        system_->from_point(guess, from.x.data());
        from.parameter = std::log(options_.amplitude_min);
        NewtonLimits limits;
        limits.tolerance = options_.hbm.tolerance;
        limits.max_iterations = std::max<std::int64_t>(100, options_.hbm.max_iterations);
        const NewtonOutcome out = newton(*system_, SideCondition(), limits, from.x, from.parameter);
        if (!out.converged)
            throw Error(
                PLM_ERR_CONVERGENCE,
                format("no periodic motion was found at the smallest amplitude, %g", options_.amplitude_min))
                .reason(PLM_REASON_START_FAILED);
        from.residual = out.residual;
        return from;
    }

    std::shared_ptr<const ReducedModel> m_;
    NonlinearModeOptions options_;
    Watch watch_;
    vector<double> share_, shape_;
    double omega_ = 0;
    std::unique_ptr<HbmSystem> inner_;
    std::unique_ptr<NonlinearModeSystem> system_;
    NonlinearMode result_;
};

} // namespace

NonlinearMode follow_nonlinear_mode(std::shared_ptr<const ReducedModel> reduced,
                                    const NonlinearModeOptions &options, Watch watch) {
    return ModePath(std::move(reduced), options, watch).run();
}

} // namespace plm
