#include "hbm/harmonic_equations.hpp"
#include "contact/penetration_zeros.hpp"
#include "hbm/make_system.hpp"
#include "hbm/modal_factor.hpp"
#include "hbm/modal_jacobian.hpp"
#include "hbm/solved_point.hpp"
#include "hbm/start.hpp"
#include "structure/driven_harmonic.hpp"
#include <algorithm>
#include <cmath>

namespace plm {

HarmonicEquations::HarmonicEquations(std::shared_ptr<const ReducedModel> reduced, const HbmOptions &options,
                                     double omega, MultipliersOf multipliers)
    : reduced_(std::move(reduced)), options_(options), reference_(omega),
      system_(make_system(reduced_, options)), multipliers_(std::move(multipliers)) {}

void HarmonicEquations::residual(const double *x, double omega, double *r) {
    x_.assign(x, x + size());
    omega_ = omega;
    system_->residual(x, omega, r);
}

void HarmonicEquations::set(PathParameter parameter, double value) {
    if (parameter == PathParameter::stiffness) return system_->set_stiffness_factor(std::exp(value));
    options_.force_scale = value;
    system_->set_force_scale(value);
}

void HarmonicEquations::derivative(PathParameter parameter, double *r) {
    if (parameter == PathParameter::stiffness) return system_->stiffness_derivative(r);
    system_->force_derivative(r);
}

vector<double> HarmonicEquations::unknowns(const BranchPoint &point) const {
    return unknowns_of(*system_, point);
}

BranchPoint HarmonicEquations::solved_point(const PathState &at, double residual, std::int64_t iterations) {
    return plm::solved_point(*system_, at, residual, iterations);
}

bool HarmonicEquations::find(double omega, Watch watch, vector<double> &x, NewtonWork &work) {
    const StartOutcome out = find_start(*system_, *reduced_, options_, omega, true, watch, x);
    work += out;
    return out.converged;
}

vector<std::complex<double>> HarmonicEquations::multipliers(const vector<double> &x, double omega) {
    if (!multipliers_) return {};
    if (omega != known_omega_ || x != known_x_) {
        BranchPoint point;
        system_->to_point(x.data(), omega, point);
        known_multipliers_ = multipliers_->multipliers(point);
        known_x_ = x;
        known_omega_ = omega;
    }
    return known_multipliers_;
}

EquationsMemory HarmonicEquations::settle() {
    system_ = make_system(reduced_, options_);
    known_omega_ = -1;
    EquationsMemory memory;
    if (multipliers_) memory.beside = multipliers_->settle();
    return memory;
}

void HarmonicEquations::take(const EquationsMemory &memory) {
    if (multipliers_) multipliers_->take(memory.beside);
}

void HarmonicEquations::factor_bordered(const Border &border, std::unique_ptr<BorderedTangent> &out) {
    if (!out) out = std::make_unique<ModalFactor>();
    system_->factor_bordered(border, static_cast<ModalFactor &>(*out));
}

// --- folds

MotionGradient HarmonicEquations::tangent_change(const vector<double> &w, const vector<double> &v) {
    const ReducedModel &m = *reduced_;
    const Matrix change = contact_change(w, v),
                 motion = m.contact.gap_motion(change.cols() / 2, omega_, options_.period_multiple);
    vector<double> gradient(size(), 0.0);
    add_coordinates_of_gaps(m.gap_0, m.gap, -1.0, change, gradient.data());
    double by_frequency = -dot(size(), w.data(), frequency_derivative(v).data());
    if (m.contact.moves_by_frequency()) {
        const Matrix moved = m.contact.gap_motion_change(change.cols() / 2, omega_, options_.period_multiple);
        by_frequency += options_.force_scale * dot(moved.rows() * moved.cols(), moved.data(), change.data());
    }
    return {gradient, by_frequency, dot(motion.rows() * motion.cols(), motion.data(), change.data())};
}

// (dJ/domega) v: dR/domega is the same matrix times x, and what the loads change by, whatever x is.
vector<double> HarmonicEquations::frequency_derivative(const vector<double> &v) {
    vector<double> change(size()), back(size()), scratch(size()), opposite(v);
    for (double &o : opposite) o = -o;
    system_->residual(opposite.data(), omega_, scratch.data());
    system_->parameter_derivative_of_structure(back.data());
    system_->residual(v.data(), omega_, scratch.data());
    system_->parameter_derivative_of_structure(change.data());
    for (std::size_t j = 0; j < change.size(); ++j) change[j] = 0.5 * (change[j] - back[j]);
    system_->residual(x_.data(), omega_, scratch.data());
    return change;
}

// Z x (2H + 1) coefficients of the gaps for unknowns x, without the initial gap; the harmonics times
// `factor`.
Matrix HarmonicEquations::gap_motion(const double *x, double factor) const {
    const ReducedModel &m = *reduced_;
    const std::int64_t z = m.n_pairs(), r = m.size(), columns = (size() - m.static_size()) / r;
    Matrix eta(r, columns), u(z, columns + 1), dynamic(z, columns);
    std::copy(x + m.static_size(), x + size(), eta.data());
    gemv('N', 1.0, m.gap_0, x, 0.0, u.col(0));
    gemm('N', 'N', factor, m.gap, eta, 0.0, dynamic);
    std::copy(dynamic.data(), dynamic.data() + z * columns, u.col(1));
    return u;
}

// d(w^T J v) by the coefficients of the penetrations, Z x (2H + 1): the mean over the period of k_n ds W V
// with ds = du / |u'| at each switching instant; the residual of a harmonic is twice a mean, so that w's
// harmonics count twice in W(t).
Matrix HarmonicEquations::contact_change(const vector<double> &w, const vector<double> &v) const {
    const ReducedModel &m = *reduced_;
    const std::int64_t z = m.n_pairs();
    if (z == 0) return Matrix(0, 1);
    Matrix u = gap_motion(x_.data(), 1);
    const Matrix gaps = m.contact.gaps(u.cols() / 2, omega_, options_.force_scale, options_.period_multiple);
    for (std::int64_t k = 0; k < gaps.rows() * gaps.cols(); ++k) u.data()[k] -= gaps.data()[k];
    const SwitchingInstants switching = switching_instants(u);
    const Matrix ut = u.transposed(), vt = gap_motion(v.data(), 1).transposed(),
                 wt = gap_motion(w.data(), 2).transposed();
    const std::int64_t columns = u.cols() - 1, h = columns / 2;
    Matrix change(z, columns + 1);
    for (std::int64_t i = 0; i < z; ++i)
        for (double t : switching.instants[i]) {
            const double speed = std::abs(evaluate_trig(ut.col(i), h, t).slope);
            if (speed == 0) continue;
            const double weight = m.contact.stiffness[i] * evaluate_trig(vt.col(i), h, t).value *
                                  evaluate_trig(wt.col(i), h, t).value / (2 * M_PI * speed);
            change(i, 0) += weight;
            for (std::int64_t k = 1; k <= h; ++k) {
                change(i, 2 * k - 1) += weight * std::cos(static_cast<double>(k) * t);
                change(i, 2 * k) += weight * std::sin(static_cast<double>(k) * t);
            }
        }
    return change;
}

// --- phase resonance

// phase = row . x, Re(F^H q) of the lowest harmonic of the excitation; or the row's change by the frequency.
vector<double> HarmonicEquations::phase_row(bool changed) const {
    vector<double> row(static_cast<std::size_t>(size()), 0.0);
    const int driven = driven_harmonic(reduced_->excitation);
    if (driven == 0) return row;
    const std::int64_t r = reduced_->size(),
                       at = static_size() + 2 * (driven * options_.period_multiple - 1) * r;
    if (at + 2 * r > size())
        throw Error(
            status::argument,
            format("phase resonance is that of harmonic %d of the excitation, which n_harmonics leaves "
                   "out; set n_harmonics to %d or more",
                   driven, driven))
            .argument("n_harmonics");
    const HarmonicLoad usual = load_at(reduced_->excitation, driven, reference_),
                       load = changed ? load_change_at(reduced_->excitation, driven, omega_)
                                      : load_at(reduced_->excitation, driven, omega_);
    const double force = std::hypot(norm2(r, usual.real.data()), norm2(r, usual.imag.data()));
    const double scale = row_size(reference_) / (force > 0 ? force : 1);
    for (std::int64_t j = 0; j < r; ++j) {
        row[at + j] = scale * load.real[j];
        row[at + r + j] = -scale * load.imag[j];
    }
    return row;
}

double HarmonicEquations::phase() {
    return dot(size(), phase_row(false).data(), x_.data());
}

bool HarmonicEquations::phase_gradient(MotionGradient &gradient) {
    gradient = {phase_row(false), dot(size(), phase_row(true).data(), x_.data()), 0};
    return true;
}

} // namespace plm
