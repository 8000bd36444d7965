#include "searches/motion_choice.hpp"
#include "hbm/make_system.hpp"
#include "motions/effort_budget.hpp"
#include "orbits/orbit_cost.hpp"
#include <algorithm>

namespace plm {
namespace {

constexpr std::int64_t usual_harmonics = 20; // of points near a resonance

bool permits_exact(const ReducedModel &reduced, const HbmOptions &o) {
    if (o.motion == MotionKind::harmonics) return false;
    const bool asked = o.motion == MotionKind::exact;
    const auto refuse = [&](const char *argument, const std::string &why) {
        if (asked) throw Error(status::argument, why).argument(argument);
        return false;
    };
    if (reduced.structural != 0)
        return refuse("motion",
                      "structural damping has no exact motion in time; set motion to auto or harmonics");
    if (o.aft == AftKind::sampled)
        return refuse("aft", "an exact motion has no time samples; set aft to event, or motion to harmonics");
    if (o.stability == StabilityKind::hill)
        return refuse("stability", "Hill's method is one of harmonics; set stability to floquet");
    if (asked) return true;
    if (o.n_harmonics != 0 || o.tail_correction || o.unknowns != NonlinearUnknowns::automatic ||
        o.formulation != FormulationKind::automatic || reduced.n_pairs() == 0)
        return false;
    return true;
}

} // namespace

bool prefers_exact(const ReducedModel &reduced, const HbmOptions &o) {
    if (!permits_exact(reduced, o)) return false;
    return o.motion == MotionKind::exact ||
           // else there are no modes to go by
           (has_flow(reduced) &&
            exact_step_flops(reduced, o) <
                std::max(EffortBudget::cheap_step, harmonic_step_flops(reduced, usual_harmonics)));
}

bool prefers_exact_compressed(const ReducedModel &whole, const HbmOptions &o) {
    return prefers_exact(whole, o) ||
           (permits_exact(whole, o) && EffortBudget::step_on_compressed * exact_step_flops(whole, o) <
                                           harmonic_step_flops(whole, usual_harmonics));
}

} // namespace plm
