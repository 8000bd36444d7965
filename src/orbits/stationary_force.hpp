// The force of exact motions over their frequency and amplitude, and where it is stationary: there an
// isolated loop of the response at constant force is born, or merges with another curve (isola centre and
// simple bifurcation; Golubitsky and Schaeffer, Singularities and Groups in Bifurcation Theory I, 1985).
#pragma once
#include "linalg/monitor.hpp"
#include "motions/branch.hpp"
#include "motions/options.hpp"
#include <cmath>

namespace plm {

/// The force is least at an isola centre, and has a saddle where curves merge.
enum class ForceExtremum { centre, saddle };

/// The stationary force beside a point near a resonance, of an exact motion or of harmonic balance, which
/// counts from its own force scale; NaN where Newton's method does not lead to one of that kind.
double stationary_force(std::shared_ptr<const ReducedModel> reduced, const MotionOptions &options,
                        const BranchPoint &near, ForceExtremum kind, Watch watch);

/// Whether a force of that kind belongs to an extremum known roughly; one farther away belongs to another
/// loop.
inline bool is_of(double force, const BranchPoint &extremum) {
    constexpr double same_extremum = 0.3; // relative: a backbone of few harmonics is so far off
    return std::abs(force / extremum.force_scale - 1) < same_extremum;
}

} // namespace plm
