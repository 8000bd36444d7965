#include "searches/exact_curve.hpp"
#include "motions/branch_path.hpp"
#include "orbits/orbit_point.hpp"
#include "orbits/orbit_points.hpp"
#include "orbits/stability.hpp"

namespace plm {
namespace {

class ExactTracer final : public PathOwner {
  public:
    ExactTracer(const HbmOptions &options, Watch watch, Branch &branch, double omega)
        : options_(options), watch_(watch), branch_(branch),
          equations_(orbit_equations(branch.reduced_model(), options, omega, FlowParameter::frequency)) {}

    void run(const CurveStart &start) {
        branch_.unknowns_used = "state";
        PathOptions limits = path_options(options_, 2 * M_PI * options_.frequency_min_hz,
                                          2 * M_PI * options_.frequency_max_hz);
        limits.upward = options_.upward;
        limits.initial_step = options_.initial_step;
        limits.locate = options_.bifurcations;
        try {
            take_outcome(follow_path(equations_, limits, first(start), *this), branch_);
        } catch (const Error &e) { // stopped in the middle of a point: those found so far stay valid
            if (e.status() != PLM_CANCELLED || branch_.points().empty()) throw;
            branch_.end_reason = e.reason();
        }
        equations_.modes()->forget_transitions(); // the points of the branch keep the modes
    }

    void record(const PathPoint &p) override {
        BranchPoint point = orbit_point(equations_, options_, {p.x, p.parameter}, p.residual, p.iterations);
        put_place(p, point);
        if (with_stability()) point.multipliers = equations_.multipliers();
        branch_.append(std::move(point));
    }

    bool cancelled(double fraction) override { return watch_.cancelled("sweep", fraction); }

    // By marching: to a stable motion, where there is one.
    bool rescue(double omega, vector<double> &x) override {
        NewtonOutcome out;
        const bool found = march_to_orbit(equations_, options_, omega, 0, watch_, x, out);
        branch_.newton_work += out;
        return found;
    }

    vector<std::int32_t> test_kinds() const override {
        if (!with_stability()) return {};
        return {PLM_BIFURCATION_PERIOD_DOUBLING, PLM_BIFURCATION_NEIMARK_SACKER};
    }

    void test(const vector<double> &, double, vector<double> &values) override {
        if (with_stability()) values = bifurcation_tests(equations_.multipliers());
    }

  private:
    bool with_stability() const { return options_.stability != StabilityKind::off; }

    PathStart first(const CurveStart &start) const {
        PathStart path;
        path.at = state_of(start.point);
        path.residual = start.point.residual;
        if (start.towards.empty()) return path;
        path.direction = difference(state_of(start.towards[0]), path.at);
        if (start.away) scale_by(-1, path.direction);
        return path;
    }

    PathState state_of(const BranchPoint &point) const {
        return {orbit_unknowns(equations_, point, options_.period_multiple), point.omega};
    }

    const HbmOptions options_;
    Watch watch_;
    Branch &branch_;
    OrbitEquations equations_;
};

} // namespace

void trace_exact_curve(const HbmOptions &options, const CurveStart &start, Watch watch, Branch &branch) {
    ExactTracer(options, watch, branch, start.point.omega).run(start);
}

} // namespace plm
