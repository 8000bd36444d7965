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

} // namespace

ExactFlow OrbitConditions::flow(std::shared_ptr<const FlowModel> model,
                                std::shared_ptr<ContactModesKept> modes) const {
    ExactFlow flow(std::move(model), omega, force_scale, Watch(), std::move(modes));
    if (tolerance >= loose) flow.truncate(of_tolerance * tolerance);
    return flow;
}

OrbitEquations::OrbitEquations(std::shared_ptr<const FlowModel> model, FlowState rest,
                               const OrbitConditions &conditions, FlowParameter parameter)
    : model_(std::move(model)), rest_(std::move(rest)), conditions_(conditions), parameter_(parameter),
      modes_(std::make_shared<ContactModesKept>(model_)), weight_(size()), x_(size()), end_(size()),
      change_(size()) {
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
    known_ = known_ && other == value;
    other = value;
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

// By the frequency at a fixed phase: ExactFlow::differentiate().
void OrbitEquations::run(const double *x, double p) {
    if (known_ && p == p_ && std::equal(x_.begin(), x_.end(), x)) return;
    std::copy_n(x, size(), x_.begin());
    p_ = p;
    known_ = true;
    failed_ = false;
    const OrbitConditions now = conditions(p);
    try {
        ExactFlow flow = now.flow(model_, modes_);
        flow.differentiate(parameter_);
        FlowState state = this->state(x);
        ContactHistory recorder;
        const double duration = static_cast<double>(now.period_multiple) * flow.period();
        flow.advance(state, duration, &recorder);
        intervals_ = recorder.intervals();
        end_ = unknowns(state);
        const double back = parameter_ == FlowParameter::frequency ? duration / now.omega : 0;
        const std::int64_t moving = model_->n_moving();
        const vector<double> acceleration = flow.acceleration(state);
        for (std::int64_t j = 0; j < moving; ++j)
            change_[j] = (flow.change().y[j] - back * state.v[j]) * weight_[j];
        for (std::int64_t j = 0; j < model_->n_massive(); ++j)
            change_[moving + j] = flow.change().v[j] - back * acceleration[j];
        size_ = norm2(size(), end_.data());
    } catch (const Error &e) { // chatter, overflow: no motion from here
        if (e.status() != PLM_ERR_CONVERGENCE && e.status() != PLM_ERR_ARGUMENT) throw;
        failed_ = true;
    }
}

void OrbitEquations::residual(const double *x, double p, double *r) {
    run(x, p);
    for (std::int64_t i = 0; i < size(); ++i) r[i] = failed_ ? NAN : end_[i] - x[i];
}

bool OrbitEquations::is_small() const {
    return model_->n_moving() < large && conditions_.tolerance < loose;
}

void OrbitEquations::linearize() {
    linearize_within(is_small() ? 1e-15 : enough);
}

bool OrbitEquations::linearize_roughly() {
    linearize_within(is_small() ? 1e-15 : roughly);
    return !is_small();
}

void OrbitEquations::linearize_within(double tolerance) {
    const std::int64_t n = size();
    monodromy_.reset(n, n);
    multipliers_.clear();
    if (!failed_) {
        monodromy_ = plm::monodromy(*model_, intervals_, tolerance, Watch(), modes_.get());
        for (std::int64_t j = 0; j < n; ++j)
            for (std::int64_t i = 0; i < n; ++i) monodromy_(i, j) *= weight_[i] / weight_[j];
    }
    // of a motion that grows so fast nothing is left to correct by
    overflown_ = !all_finite(monodromy_.data(), n * n);
    if (overflown_) monodromy_.reset(n, n);
    Matrix a = tangent();
    lu_.factor(a);
}

const vector<std::complex<double>> &OrbitEquations::multipliers() const {
    if (multipliers_.empty()) multipliers_ = plm::multipliers(monodromy_);
    return multipliers_;
}

Matrix OrbitEquations::tangent() const {
    Matrix a = monodromy_;
    for (std::int64_t j = 0; j < size(); ++j) a(j, j) -= 1;
    return a;
}

void OrbitEquations::solve(double *b, std::int64_t n) {
    if (overflown_) std::fill_n(b, n * size(), NAN);
    if (all_finite(b, n * size())) lu_.solve(b, n, size());
}

void OrbitEquations::parameter_derivative(double *r) {
    std::copy(change_.begin(), change_.end(), r);
}

} // namespace plm
