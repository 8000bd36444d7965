#include "paths/path_walker.hpp"
#include "linalg/dense.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

constexpr std::int64_t most_iterations_across = 12; // a shorter step is cheaper than more

} // namespace

PathWalker::PathWalker(Residual &system, const PathOptions &options, PathOwner &owner)
    : system_(system), options_(options), owner_(owner),
      n_(system.size()), metric_{0, options.high - options.low, system.weights()}, scratch_(n_) {
    kinds_ = {bifurcation::fold, bifurcation::branch_point};
    for (std::int32_t kind : owner.test_kinds()) kinds_.push_back(kind);
}

bool PathWalker::take_scale(double least) {
    const double before = metric_.scale;
    const std::int64_t s = system_.static_size();
    const double size =
        metric_.weights ? std::sqrt(metric_.dot(now_.x, now_.x)) : norm2(n_ - s, now_.x.data() + s);
    metric_.scale = std::max({options_.scale_falls ? 0 : before, least, size});
    if (metric_.scale == 0) metric_.scale = norm2(n_, now_.x.data());
    if (metric_.scale == 0) metric_.scale = 1; // nothing moves and nothing rests: any measure will do
    if (metric_.scale == before) return false;
    if (!tangent_.x.empty()) scale_by(1 / metric_.length(tangent_), tangent_); // its length stays 1
    return true;
}

void PathWalker::linearize_at(const PathState &at) {
    system_.residual(at.x.data(), at.parameter, scratch_.data());
    system_.linearize();
    ++work.factorizations;
    factored_ = stands_ = false;
}

void PathWalker::linearize_at_solution() {
    system_.linearize();
    ++work.factorizations;
    factored_ = stands_ = true;
}

void PathWalker::linearize_here() {
    linearize_at(now_);
    factored_ = stands_ = true;
}

bool PathWalker::go_on(const PathProgress &from) {
    const auto fits = [&](const PathState &state) { return static_cast<std::int64_t>(state.x.size()) == n_; };
    const bool known_test = from.tests.empty() || from.tests.size() >= own_tests;
    if (!(fits(from.at) && fits(from.direction) && fits(from.target) && fits(from.target_direction)) ||
        (from.last_step > 0 && !fits(from.last_direction)) || !known_test || !(from.scale > 0))
        return false;
    now_ = from.at;
    tangent_ = from.direction;
    metric_.scale = from.scale;
    if (!system_.is_cheap_to_linearize()) linearize_here();
    return true;
}

void PathWalker::make_tangent(const PathState *previous) {
    PathState t = tangent_at(system_);
    double sign = options_.upward ? 1 : -1;
    if (previous) sign = metric_.product(t, *previous) > 0 ? 1 : -1;
    scale_by(sign / metric_.length(t), t);
    tangent_ = std::move(t);
}

double PathWalker::orientation() const {
    return system_.determinant_sign() * (tangent_.parameter < 0 ? -1.0 : 1.0);
}

void PathWalker::orient(double wanted) {
    if (orientation() * wanted <= 0) scale_by(-1, tangent_);
}

void PathWalker::restore(const PathState &at, const PathState &tangent) {
    if (!(stands_ && now_.parameter == at.parameter && now_.x == at.x)) {
        now_ = at;
        linearize_here();
    }
    tangent_ = tangent;
}

void PathWalker::remember() {
    system_.remember();
    remembered_ = now_;
    remembered_tangent_ = tangent_;
}

void PathWalker::come_back() {
    if (system_.recall()) {
        now_ = remembered_;
        factored_ = stands_ = true;
    }
    restore(remembered_, remembered_tangent_);
}

NewtonOutcome PathWalker::correct(PathState &at, const PathState &direction, double min_damping,
                                  bool factored) {
    NewtonLimits limits;
    limits.tolerance = options_.tolerance;
    limits.max_iterations = std::min(options_.max_iterations, most_iterations_across);
    limits.min_damping = min_damping;
    limits.factored = factored;
    vector<double> slope;
    if (factored && tangent_.parameter != 0) {
        slope = tangent_.x;
        for (double &v : slope) v /= tangent_.parameter;
        limits.slope = &slope;
    }
    stands_ = false;
    const NewtonOutcome out = newton_across(system_, metric_, direction, limits, at);
    work += out;
    return out;
}

NewtonOutcome PathWalker::correct_at_parameter(PathState &at) {
    NewtonLimits limits;
    limits.tolerance = options_.tolerance;
    limits.max_iterations = options_.max_iterations;
    limits.parameter_scale = metric_.width;
    stands_ = false;
    const NewtonOutcome out = newton_at(system_, limits, at.x, at.parameter);
    work += out;
    return out;
}

vector<double> PathWalker::tests() {
    if (!options_.locate) return {};
    vector<double> owners;
    owner_.test(now_.x, now_.parameter, owners);
    vector<double> all = {fold_test(), branch_test()};
    all.insert(all.end(), owners.begin(), owners.end());
    return all;
}

double PathWalker::test(std::size_t k) {
    if (k < own_tests) return k == 0 ? fold_test() : branch_test();
    vector<double> owners;
    owner_.test(now_.x, now_.parameter, owners);
    return owners[k - own_tests];
}

// sign(det) of the tangent bordered by the path's direction, over the size of its solution for a fixed
// right-hand side: passes through zero like the smallest singular value. What p contributes to the solution
// goes along the tangent, the present factorization's own.
double PathWalker::branch_test() {
    vector<double> a = patternless_vector(n_);
    system_.solve(a.data(), 1);
    const double along = metric_.dot(tangent_.x, a) / (metric_.scale * metric_.scale);
    for (std::int64_t i = 0; i < n_; ++i) a[i] -= along * tangent_.x[i];
    const double size = norm2(n_, a.data());
    return size > 0 && std::isfinite(size) ? orientation() / size : 0;
}

} // namespace plm
