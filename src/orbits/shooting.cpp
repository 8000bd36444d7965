#include "orbits/shooting.hpp"
#include "orbits/period_map.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

constexpr double least_damping = 1.0 / 64;
constexpr std::int64_t first_march = 4, longest_march = 512; // periods; doubled each time

// Whole periods do not matter to the excitation: times are kept small, and with them their rounding.
double phase_time(const ExactFlow &flow, double time) {
    return time - std::floor(time / flow.period()) * flow.period();
}

// Time is set back, since whole periods do not matter to the excitation.
void march(ExactFlow &flow, FlowState &state, std::int64_t periods) {
    const double begin = state.time;
    for (std::int64_t k = 0; k < periods; ++k) {
        flow.advance(state, begin + flow.period());
        state.time = begin;
    }
}

// One step of Newton's method, shortened until the state at the end comes closer to that at the start: along
// the step it does, unless the contact events change too much. False: nothing has changed.
bool improve(ExactFlow &flow, std::int64_t periods, FlowState &state, PeriodRun &run) {
    const vector<double> step = period_step(flow.model(), state, run, monodromy(flow.model(), run.intervals));
    for (double factor = 1; factor >= least_damping; factor *= 0.5) {
        FlowState next = moved(flow.model(), state, step, factor);
        PeriodRun next_run = run_periods(flow, next, periods);
        if (!(next_run.distance < (1 - 0.25 * factor) * run.distance)) continue;
        state = std::move(next);
        run = std::move(next_run);
        return true;
    }
    return false;
}

void keep_closer(const PeriodRun &run, const FlowState &state, PeriodRun &best, PeriodicOrbit &orbit) {
    if (!best.end.y.empty() && !(run.defect() < best.defect())) return;
    best = run;
    orbit.state = state;
    orbit.defect = run.defect();
}

} // namespace

PeriodicOrbit periodic_orbit(ExactFlow &flow, const FlowState &start, const ShootingOptions &options) {
    FlowState state = start;
    state.time = phase_time(flow, start.time);
    march(flow, state, options.transient_periods);
    PeriodicOrbit orbit;
    orbit.period_multiple = options.period_multiple;
    PeriodRun run = run_periods(flow, state, orbit.period_multiple), best;
    keep_closer(run, state, best, orbit);
    std::int64_t patience = first_march;
    while (orbit.iterations < options.max_iterations && orbit.defect > options.tolerance) {
        ++orbit.iterations;
        if (!improve(flow, orbit.period_multiple, state, run)) {
            if (!options.march_when_stuck) break;
            march(flow, state, patience * orbit.period_multiple);
            patience = std::min(2 * patience, longest_march);
            run = run_periods(flow, state, orbit.period_multiple);
        }
        keep_closer(run, state, best, orbit);
    }
    flow.complete(orbit.state);
    orbit.converged = orbit.defect <= options.tolerance;
    orbit.multipliers = multipliers(monodromy(flow.model(), best.intervals));
    orbit.contact_history = std::move(best.intervals);
    return orbit;
}

double periodicity_defect(ExactFlow &flow, const FlowState &state, std::int64_t period_multiple) {
    return run_periods(flow, state, period_multiple).defect();
}

} // namespace plm
