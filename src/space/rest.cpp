#include "space/rest.hpp"
#include "space/linear_contact.hpp"
#include <algorithm>
#include <cmath>

namespace plm {

Error no_equilibrium(const char *load) {
    return Error(PLM_ERR_CONVERGENCE,
                 format("the %s drives a rigid-body motion that no support and no contact holds; "
                        "fix DOFs or check the direction of the %s",
                        load, load))
        .reason(PLM_REASON_NO_EQUILIBRIUM);
}

namespace {

// The energy is convex, so Newton with exact line search ends at the minimum from anywhere.
class RestProblem {
  public:
    explicit RestProblem(const StaticProblem &p) : p_(p), pivot_(held_pivots(p.lambda)) {}

    vector<double> penetration(const vector<double> &eta) const {
        vector<double> u = p_.contact.unloaded_penetration();
        gemv('N', 1.0, p_.gap, eta.data(), 1.0, u.data());
        return u;
    }

    vector<double> gradient(const vector<double> &eta, const vector<double> &u) const {
        vector<double> g(p_.gap.cols());
        const vector<double> n = p_.contact.forces(u);
        for (std::size_t j = 0; j < g.size(); ++j) g[j] = p_.lambda[j] * eta[j] - p_.load[j];
        gemv('T', 1.0, p_.gap, n.data(), 1.0, g.data());
        return g;
    }

    // -(D + G' k G)^-1 g over the pairs that press.
    vector<double> newton_step(const vector<double> &g, const vector<double> &u) const {
        vector<double> d(g);
        for (double &v : d) v = -v;
        solve_with_springs(pivot_, p_.gap, p_.contact.tangents(u), d);
        return d;
    }

    // The force that the fictitious stiffness of rigid-body coordinates would have to carry in a Newton step
    // d: none to `scale`, where supports and contact hold the structure.
    bool pushes_rigid_motion(const vector<double> &d, double scale) const {
        for (std::size_t j = 0; j < d.size(); ++j)
            if (p_.lambda[j] == 0 && pivot_[j] * std::abs(d[j]) > 1e-8 * scale) return true;
        return false;
    }

    // Slope of E along eta + t d.
    double slope(const vector<double> &eta, const vector<double> &d, const vector<double> &u,
                 const vector<double> &du, double t) const {
        double s = 0;
        for (std::size_t j = 0; j < d.size(); ++j)
            s += d[j] * (p_.lambda[j] * (eta[j] + t * d[j]) - p_.load[j]);
        for (std::size_t i = 0; i < u.size(); ++i) s += du[i] * p_.contact.force(i, u[i] + t * du[i]);
        return s;
    }

    // Exact minimum along d: the slope is piecewise linear and increasing in t.
    double line_search(const vector<double> &eta, const vector<double> &d, const vector<double> &u) const {
        vector<double> du(u.size(), 0.0);
        gemv('N', 1.0, p_.gap, d.data(), 0.0, du.data());
        const double first = slope(eta, d, u, du, 0.0), full = slope(eta, d, u, du, 1.0);
        if (std::abs(full) <= 1e-9 * std::abs(first)) return 1.0;
        double low = 0, high = 1;
        while (slope(eta, d, u, du, high) < 0) {
            low = high;
            high *= 4;
            if (high > 1e12) return 1.0; // no minimum: rounding, or a rigid-body motion is pushed
        }
        for (int k = 0; k < 200 && high - low > 1e-15 * high; ++k) {
            const double middle = 0.5 * (low + high);
            (slope(eta, d, u, du, middle) < 0 ? low : high) = middle;
        }
        return high;
    }

  private:
    const StaticProblem &p_;
    vector<double> pivot_;
};

} // namespace

StaticState solve_static(const StaticProblem &p) {
    const RestProblem problem(p);
    StaticState state;
    state.coordinates.assign(p.gap.cols(), 0.0);
    state.penetration = problem.penetration(state.coordinates);
    const std::int64_t limit = 200, m = p.gap.cols();
    int settled = 0; // steps with an unchanged contact set: the second one only refines
    double first = 0;
    bool pushed = false; // by the last step; a huge one has left the slope of the line search to rounding
    while (settled < 2 && state.iterations < limit) {
        const vector<double> g = problem.gradient(state.coordinates, state.penetration);
        const vector<double> d = problem.newton_step(g, state.penetration);
        if (state.iterations == 0) first = norm2(m, g.data());
        pushed = problem.pushes_rigid_motion(d, first);
        const double t = problem.line_search(state.coordinates, d, state.penetration);
        for (std::size_t j = 0; j < d.size(); ++j) state.coordinates[j] += t * d[j];
        const PairStates before = p.contact.states(state.penetration);
        state.penetration = problem.penetration(state.coordinates);
        settled = (p.contact.states(state.penetration) == before) ? settled + 1 : 0;
        ++state.iterations;
    }
    if (settled < 2)
        throw Error(PLM_ERR_CONVERGENCE,
                    format("the static equilibrium under the pre-load was not found in %lld "
                           "iterations; check the pre-load and the initial gaps",
                           static_cast<long long>(limit)))
            .reason(PLM_REASON_NO_EQUILIBRIUM);
    if (pushed) throw no_equilibrium("pre-load");
    return state;
}

namespace {

RestState solve_rest(const Space &space) {
    const Model &model = *space.model;
    RestState rest;
    rest.coordinates.assign(space.size(), 0.0);
    rest.penetration = model.contact().unloaded_penetration();
    if (model.has_preload() || model.contact().has_interference()) {
        vector<double> load(space.preload);
        load.resize(space.size(), 0.0);
        StaticState state = solve_static({space.lambda, space.gap, load, model.contact()});
        rest.coordinates = std::move(state.coordinates);
        rest.penetration = std::move(state.penetration);
        rest.iterations = state.iterations;
    }
    rest.states = model.contact().states(rest.penetration);
    rest.force = model.contact().forces(rest.penetration);
    rest.displacement = combine(space.vectors, rest.coordinates);
    return rest;
}

} // namespace

std::shared_ptr<const RestState> rest_of(const Space &space) {
    return space.rest.get([&] { return solve_rest(space); });
}

} // namespace plm
