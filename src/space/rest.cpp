#include "space/rest.hpp"
#include "linalg/lapack.hpp"
#include "space/linear_contact.hpp"
#include <algorithm>
#include <cmath>
#include <utility>

namespace plm {

Error no_equilibrium(const char *load, const std::string &resultant) {
    return Error(status::convergence,
                 format("the %s drives a rigid-body motion that no support and no contact holds%s%s; "
                        "fix DOFs or check the direction of the %s",
                        load, resultant.empty() ? "" : ": ", resultant.c_str(), load))
        .reason(reason::no_equilibrium);
}

namespace {

// Slope of the energy along the step, t of it gone.
double slope_along(const RestEquations::Step &step, const Contact &contact, const vector<double> &u,
                   double t) {
    double s = step.slope + t * step.curvature;
    for (std::size_t i = 0; i < u.size(); ++i)
        s += step.gaps[i] * contact.force(static_cast<std::int64_t>(i), u[i] + t * step.gaps[i]);
    return s;
}

// No pair crosses zero by more than rounding makes of its penetration, whose terms are so large: a force is
// continuous there, and a pair that touches exactly counts as it happens to come out.
bool keeps_its_pairs(const Contact &contact, const vector<double> &terms, const vector<double> &from,
                     const vector<double> &to) {
    constexpr double rounding = 1e-12;
    vector<double> there(to);
    for (std::size_t i = 0; i < to.size(); ++i)
        if (std::abs(to[i] - from[i]) <= rounding * (terms[i] + std::abs(contact.initial_gap[i])))
            there[i] = from[i];
    return contact.states(there) == contact.states(from);
}

// Exact minimum along the step: the slope is piecewise linear and increasing in t. Where no pair changes its
// state on the way the energy is a parabola and the step leads to its lowest point, whatever rounding makes
// of the slope of a step that only refines.
double line_search(const RestEquations::Step &step, const Contact &contact, const vector<double> &terms,
                   const vector<double> &u) {
    vector<double> there(u);
    for (std::size_t i = 0; i < u.size(); ++i) there[i] += step.gaps[i];
    if (keeps_its_pairs(contact, terms, u, there)) return 1.0;
    const auto slope = [&](double t) { return slope_along(step, contact, u, t); };
    if (std::abs(slope(1.0)) <= 1e-9 * std::abs(slope(0.0))) return 1.0;
    double low = 0, high = 1;
    while (slope(high) < 0) {
        low = high;
        high *= 4;
        if (high > 1e12) return 1.0; // no minimum: rounding, or a rigid-body motion is pushed
    }
    for (int k = 0; k < 200 && high - low > 1e-15 * high; ++k) {
        const double middle = 0.5 * (low + high);
        (slope(middle) < 0 ? low : high) = middle;
    }
    return high;
}

class RestInSpace final : public RestEquations {
  public:
    explicit RestInSpace(const StaticProblem &p)
        : p_(p), pivot_(held_pivots(p.lambda)), eta_(p.gap.cols(), 0.0) {}

    vector<double> penetration() const override {
        vector<double> u = p_.contact.unloaded_penetration();
        gemv('N', 1.0, p_.gap, eta_.data(), 1.0, u.data());
        return u;
    }

    vector<double> terms() const override {
        vector<double> terms(static_cast<std::size_t>(p_.gap.rows()), 0.0);
        for (std::int64_t j = 0; j < p_.gap.cols(); ++j)
            for (std::int64_t i = 0; i < p_.gap.rows(); ++i) terms[i] += std::abs(p_.gap(i, j) * eta_[j]);
        return terms;
    }

    // -(D + G' k G)^-1 gradient over the pairs that press.
    Step step(const vector<double> &u) override {
        d_.assign(eta_.size(), 0.0);
        const vector<double> n = p_.contact.forces(u);
        gemv('T', -1.0, p_.gap, n.data(), 0.0, d_.data());
        vector<double> elastic(eta_.size());
        for (std::size_t j = 0; j < d_.size(); ++j) {
            elastic[j] = p_.lambda[j] * eta_[j] - p_.load[j];
            d_[j] -= elastic[j];
        }
        if (first_ < 0) first_ = norm2(static_cast<std::int64_t>(d_.size()), d_.data());
        solve_with_springs(pivot_, p_.gap, p_.contact.tangents(u), d_);
        Step step{vector<double>(u.size(), 0.0), 0, 0, pushes_rigid_motion()};
        gemv('N', 1.0, p_.gap, d_.data(), 0.0, step.gaps.data());
        for (std::size_t j = 0; j < d_.size(); ++j) {
            step.slope += d_[j] * elastic[j];
            step.curvature += p_.lambda[j] * d_[j] * d_[j];
        }
        return step;
    }

    void move(double part) override {
        for (std::size_t j = 0; j < d_.size(); ++j) eta_[j] += part * d_[j];
    }

    /// Once found: without what moves in directions that neither supports nor pairs hold. No energy tells it;
    /// the fictitious stiffness makes rounding of the load large there. None is the rest nearest to the
    /// unloaded state.
    vector<double> settled_coordinates(const vector<double> &u) {
        vector<std::int64_t> rigid;
        for (std::size_t j = 0; j < eta_.size(); ++j)
            if (p_.lambda[j] == 0) rigid.push_back(static_cast<std::int64_t>(j));
        const std::int64_t n = static_cast<std::int64_t>(rigid.size());
        const vector<double> k = p_.contact.tangents(u);
        Matrix held(n, n);
        for (std::int64_t b = 0; b < n; ++b)
            for (std::int64_t a = 0; a < n; ++a)
                for (std::int64_t i = 0; i < p_.gap.rows(); ++i)
                    held(a, b) += p_.gap(i, rigid[a]) * k[i] * p_.gap(i, rigid[b]);
        if (n == 0) return std::move(eta_);
        const SymmetricEigen e = symmetric_eigen(held);
        for (std::int64_t d = 0; d < n; ++d) {
            if (e.values[d] > pivot_[rigid[0]]) continue;
            double along = 0;
            for (std::int64_t a = 0; a < n; ++a) along += e.vectors(a, d) * eta_[rigid[a]];
            for (std::int64_t a = 0; a < n; ++a) eta_[rigid[a]] -= e.vectors(a, d) * along;
        }
        return std::move(eta_);
    }

  private:
    // The force that the fictitious stiffness of rigid-body coordinates would have to carry in the step:
    // none, compared with the first gradient, where supports and contact hold the structure.
    bool pushes_rigid_motion() const {
        for (std::size_t j = 0; j < d_.size(); ++j)
            if (p_.lambda[j] == 0 && pivot_[j] * std::abs(d_[j]) > 1e-8 * first_) return true;
        return false;
    }

    const StaticProblem &p_;
    vector<double> pivot_, eta_, d_;
    double first_ = -1;
};

} // namespace

std::int64_t find_rest(RestEquations &equations, const Contact &contact, vector<double> &u) {
    constexpr std::int64_t limit = 200;
    std::int64_t iterations = 0;
    int settled = 0;     // steps that keep their contact set: the second one only refines
    bool pushed = false; // by the last step; a huge one has left the slope of the line search to rounding
    u = equations.penetration();
    while (settled < 2 && iterations < limit) {
        const RestEquations::Step step = equations.step(u);
        pushed = step.pushes_rigid_motion;
        equations.move(line_search(step, contact, equations.terms(), u));
        const vector<double> before = std::exchange(u, equations.penetration());
        settled = keeps_its_pairs(contact, equations.terms(), before, u) ? settled + 1 : 0;
        ++iterations;
    }
    if (settled < 2)
        throw Error(status::convergence,
                    format("the static equilibrium under the pre-load was not found in %lld "
                           "iterations; check the pre-load and the initial gaps",
                           static_cast<long long>(limit)))
            .reason(reason::no_equilibrium);
    if (pushed) throw no_equilibrium("pre-load");
    return iterations;
}

StaticState solve_static(const StaticProblem &p) {
    RestInSpace equations(p);
    StaticState state;
    state.iterations = find_rest(equations, p.contact, state.penetration);
    state.coordinates = equations.settled_coordinates(state.penetration);
    return state;
}

void RestState::put_forces(const Model &model) {
    model.rest_forces().put_penetrations(model.contact(), penetration);
    states = model.contact().states(penetration);
    force = model.contact().forces(penetration);
    model.rest_forces().put_forces(force);
}

bool is_loaded_at_rest(const Model &model) {
    return model.has_preload() || model.contact().has_interference() || !model.rest_forces().empty();
}

namespace {

// Where nothing holds the structure, the space has (K + sigma M)^-1 of loads, exact where the contact sees
// them. The rest of the displacement follows from the contact forces, but for rigid-body motion, which stays.
void follow_forces(const Model &model, const vector<double> &forces, Field &q) {
    constexpr int most_corrections = 6;
    constexpr double falls = 0.1, rounding = 1e-14; // of the displacement
    if (model.shift() == 0 || !model.is_whole()) return;
    const bool has_rigid_modes = model.n_rigid() > 0; // none where it is only nearly unheld
    Matrix n(model.n_pairs(), 1);
    for (std::int64_t i = 0; i < model.n_pairs(); ++i) n(i, 0) = -forces[static_cast<std::size_t>(i)];
    Field load = model.gap_rows().forces(n);
    if (model.has_preload()) add(1, model.preload(), load);
    const Field momenta = has_rigid_modes ? model.mass_times(model.rigid_modes()) : Field();
    double part = 1;
    for (int k = 0; k < most_corrections && part > rounding; ++k) {
        Field left = model.stiffness_times(q);
        left.scale({-1.0});
        add(1, load, left);
        model.solve(left);
        if (has_rigid_modes) add_combination(-1.0, model.rigid_modes(), projected(momenta, left), left);
        const double size = column_norms(q)[0], now = size > 0 ? column_norms(left)[0] / size : 0;
        if (!(now > model.uncertainty() && now < falls * part)) return; // rounding of the matrices
        add(1, left, q);
        part = now;
    }
}

RestState solve_rest(const Space &space) {
    const Model &model = *space.model;
    RestState rest;
    rest.coordinates.assign(space.size(), 0.0);
    rest.penetration = model.contact().unloaded_penetration();
    if (!model.preload_resultant().empty()) throw no_equilibrium("pre-load", model.preload_resultant());
    if (is_loaded_at_rest(model)) {
        vector<double> load(space.preload);
        load.resize(space.size(), 0.0);
        const GivenForces &given = model.rest_forces();
        gemv('T', -1.0, space.gap, given.loads(model.n_pairs()).data(), 1.0, load.data());
        const Contact others = given.without_them(model.contact());
        StaticState state = solve_static({space.lambda, space.gap, load, others});
        rest.coordinates = std::move(state.coordinates);
        rest.penetration = std::move(state.penetration);
        rest.iterations = state.iterations;
    }
    rest.put_forces(model);
    rest.displacement = combine(space.vectors, rest.coordinates);
    follow_forces(model, rest.force, rest.displacement);
    return rest;
}

} // namespace

std::shared_ptr<const RestState> rest_of(const Space &space) {
    return space.rest.get([&] { return solve_rest(space); });
}

} // namespace plm
