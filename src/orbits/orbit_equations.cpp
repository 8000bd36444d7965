#include "orbits/orbit_equations.hpp"
#include "linalg/scale.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

// Coordinates up to so many times the excitation's frequency count with their energy in lengths along a path;
// faster ones, of which a stiff contact leaves some ringing at the beginning of the period that turns with
// every change of the frequency, with the less the faster they are.
constexpr double slow_enough = 10;
// Of the monodromy of a large model, whose contact sets hardly ever come back: Newton's method converges as
// well, and multipliers are right to 1e-5. Single precision, and half of the terms.
constexpr std::int64_t large = 48; // coordinates
constexpr double enough = 1e-7;
// The same, and fewer terms of the flow's series, where no better motions are asked for.
constexpr double loose = 1e-7, of_tolerance = 1e-5;
// Where the monodromy only leads Newton's method, of a piece: corrections are as good (with thirty times as
// much the cylinders of the examples take a third more of them).
constexpr double roughly = 1e-5;
// The last two points are farther apart than that from the next: a guess would be worth nothing.
constexpr double farthest_guess = 3;

} // namespace

ExactFlow OrbitConditions::flow(std::shared_ptr<const FlowModel> model,
                                std::shared_ptr<ContactModesKept> modes) const {
    ExactFlow flow(std::move(model), omega, force_scale, Watch(), std::move(modes));
    if (tolerance >= loose) flow.truncate(of_tolerance * tolerance);
    return flow;
}

OrbitEquations::OrbitEquations(std::shared_ptr<const FlowModel> model, FlowState rest,
                               const OrbitConditions &conditions, FlowParameter parameter,
                               std::shared_ptr<ContactModesKept> modes)
    : model_(std::move(model)), rest_(std::move(rest)), conditions_(conditions), parameter_(parameter),
      modes_(modes ? std::move(modes) : std::make_shared<ContactModesKept>(model_)), weight_(size()) {
    run_.x.resize(size());
    run_.end.resize(size());
    run_.change.resize(size());
    const std::int64_t moving = model_->n_moving();
    for (std::int64_t j = 0; j < moving; ++j)
        weight_[j] = std::sqrt(model_->lambda()[j] + model_->mass(j) * conditions_.omega * conditions_.omega);
    std::fill(weight_.begin() + moving, weight_.end(), 1.0);
    const double reach = slow_enough * slow_enough * conditions_.omega * conditions_.omega;
    for (std::int64_t j = 0; j < moving; ++j) {
        const double share = std::min(1.0, reach / (weight_[j] * weight_[j]));
        share_.push_back(share * share);
    }
    for (std::int64_t j = 0; j < model_->n_massive(); ++j) share_.push_back(share_[j]);
}

OrbitConditions OrbitEquations::conditions(double p) const {
    OrbitConditions now = conditions_;
    (parameter_ == FlowParameter::force_scale ? now.force_scale : now.omega) = p;
    return now;
}

void OrbitEquations::set_other(double value) {
    double &other = parameter_ == FlowParameter::force_scale ? conditions_.omega : conditions_.force_scale;
    if (other == value) return;
    run_.known = remembered_.known = false;
    before_ = last_ = {};
    other = value;
}

EquationsMemory OrbitEquations::settle() {
    run_.known = remembered_.known = false;
    return {modes_->settle(), before_, last_, guessed_, {}};
}

void OrbitEquations::take(const EquationsMemory &memory) {
    const std::int64_t n = size();
    const auto fits = [&](const EquationsMemory::Tangent &t) {
        return t.x.empty() ||
               (static_cast<std::int64_t>(t.x.size()) == n && t.change.rows() == n && t.change.cols() == n);
    };
    bool fit =
        fits(memory.before) && fits(memory.last) && (memory.before.x.empty() || !memory.last.x.empty());
    for (const PairStates &states : memory.contact_sets) fit = fit && states.size() == model_->n_pairs();
    if (!fit)
        throw Error(status::argument, "what is known of where the curve stands is not of these equations");
    run_.known = remembered_.known = false;
    before_ = memory.before, last_ = memory.last, guessed_ = memory.guessed;
    modes_->take(memory.contact_sets);
}

OrbitEquations OrbitEquations::beside(const OrbitConditions &conditions, FlowParameter parameter) const {
    return OrbitEquations(model_, rest_, conditions, parameter, modes_);
}

FlowState OrbitEquations::state(const double *x) const {
    FlowState state = rest_;
    state.time = 0;
    const std::int64_t moving = model_->n_moving();
    for (std::int64_t j = 0; j < moving; ++j) state.y[j] += x[j] / weight_[j];
    for (std::int64_t j = 0; j < model_->n_massive(); ++j) state.v[j] += x[moving + j];
    return state;
}

vector<double> OrbitEquations::unknowns(const FlowState &state) const {
    const std::int64_t moving = model_->n_moving();
    vector<double> x(size());
    for (std::int64_t j = 0; j < moving; ++j) x[j] = (state.y[j] - rest_.y[j]) * weight_[j];
    for (std::int64_t j = 0; j < model_->n_massive(); ++j) x[moving + j] = state.v[j] - rest_.v[j];
    return x;
}

void OrbitEquations::to_unknowns(vector<double> &derivative) const {
    for (std::int64_t j = 0; j < size(); ++j) derivative[j] /= weight_[j];
}

// By the frequency at a fixed phase: ExactFlow::differentiate().
void OrbitEquations::run(const double *x, double p) {
    if (run_.known && p == run_.p && std::equal(run_.x.begin(), run_.x.end(), x)) return;
    std::copy_n(x, size(), run_.x.begin());
    run_.p = p;
    run_.known = true;
    run_.failed = false;
    run_.monodromy_error = INFINITY;
    const OrbitConditions now = conditions(p);
    try {
        ExactFlow flow = now.flow(model_, modes_);
        flow.differentiate(parameter_);
        FlowState state = this->state(x);
        ContactHistory recorder;
        const double duration = static_cast<double>(now.period_multiple) * flow.period();
        flow.advance(state, duration, &recorder);
        run_.intervals = recorder.intervals();
        run_.end = unknowns(state);
        const double back = parameter_ == FlowParameter::frequency ? duration / now.omega : 0;
        const std::int64_t moving = model_->n_moving();
        const vector<double> acceleration = flow.acceleration(state);
        for (std::int64_t j = 0; j < moving; ++j)
            run_.change[j] = (flow.change().y[j] - back * state.v[j]) * weight_[j];
        for (std::int64_t j = 0; j < model_->n_massive(); ++j)
            run_.change[moving + j] = flow.change().v[j] - back * acceleration[j];
        run_.size = norm2(size(), run_.end.data());
    } catch (const Error &e) { // chatter, overflow: no motion from here
        if (e.status() != status::convergence && e.status() != status::argument) throw;
        run_.failed = true;
    }
}

void OrbitEquations::residual(const double *x, double p, double *r) {
    run(x, p);
    for (std::int64_t i = 0; i < size(); ++i) r[i] = run_.failed ? NAN : run_.end[i] - x[i];
}

bool OrbitEquations::is_small() const {
    return model_->n_moving() < large;
}

void OrbitEquations::linearize() {
    const double error = is_small() ? 1e-15 : enough;
    if (run_.monodromy_error <= error) return;
    linearize_within(error);
    if (is_small() || run_.failed || run_.overflown) return;
    std::swap(before_, last_);
    last_ = {run_.x, run_.p, run_.monodromy};
    guessed_ = false;
}

Tangent OrbitEquations::linearize_roughly() {
    if (is_small()) {
        linearize();
        return Tangent::exact;
    }
    if (guess_monodromy()) return Tangent::guessed;
    linearize_within(roughly);
    return Tangent::rough;
}

// Along a path, from those of the last two points; once from there.
bool OrbitEquations::guess_monodromy() {
    if (guessed_ || run_.failed || before_.x.empty()) return false;
    double square = 0, along = 0;
    for (std::int64_t i = 0; i < size(); ++i) {
        const double step = last_.x[i] - before_.x[i];
        square += share_[i] * step * step;
        along += share_[i] * step * (run_.x[i] - last_.x[i]);
    }
    const double factor = along / square;
    if (!(std::abs(factor) <= farthest_guess)) return false;
    const std::int64_t n = size();
    run_.monodromy = last_.change;
    run_.monodromy_error = INFINITY;
    for (std::int64_t k = 0; k < n * n; ++k)
        run_.monodromy.data()[k] += factor * (last_.change.data()[k] - before_.change.data()[k]);
    factor_tangent();
    guessed_ = true;
    return true;
}

void OrbitEquations::linearize_within(double tolerance) {
    const std::int64_t n = size();
    run_.monodromy.reset(n, n);
    if (!run_.failed) {
        run_.monodromy = plm::monodromy(*model_, run_.intervals, tolerance, Watch(), modes_.get());
        for (std::int64_t j = 0; j < n; ++j)
            for (std::int64_t i = 0; i < n; ++i) run_.monodromy(i, j) *= weight_[i] / weight_[j];
    }
    // of a motion that grows so fast nothing is left to correct by
    run_.overflown = !all_finite(run_.monodromy.data(), n * n);
    if (run_.overflown) run_.monodromy.reset(n, n);
    run_.monodromy_error = tolerance;
    factor_tangent();
}

void OrbitEquations::factor_tangent() {
    run_.multipliers.clear();
    Matrix a = tangent();
    run_.lu.factor(a);
}

const vector<std::complex<double>> &OrbitEquations::multipliers() const {
    if (run_.multipliers.empty()) run_.multipliers = plm::multipliers(run_.monodromy);
    return run_.multipliers;
}

Matrix OrbitEquations::tangent() const {
    Matrix a = run_.monodromy;
    for (std::int64_t j = 0; j < size(); ++j) a(j, j) -= 1;
    return a;
}

void OrbitEquations::solve(double *b, std::int64_t n) {
    if (run_.overflown) std::fill_n(b, n * size(), NAN);
    if (all_finite(b, n * size())) run_.lu.solve(b, n, size());
}

void OrbitEquations::parameter_derivative(double *r) {
    std::copy(run_.change.begin(), run_.change.end(), r);
}

} // namespace plm
