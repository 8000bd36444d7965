// First solutions: from the structure at rest to a converged periodic response at one frequency.
#pragma once
#include "hbm/options.hpp"
#include "hbm/system.hpp"
#include "linalg/monitor.hpp"
#include "paths/continuation.hpp"
#include "reduction/reduced_model.hpp"

namespace plm {

struct StartOutcome : NewtonWork {
    bool converged = false;
    double residual = 0;
    /// What came next: its work is added, its outcome counts.
    void add(const StartOutcome &next);
};

/// Paths to a first solution turn at every pair that switches on the way. affordable: none where a step takes
/// long, and hundreds of pairs make thousands of steps; alone: those that were left out for that, after all
/// other ways.
enum class StartPaths { affordable, alone };
bool affords_paths(const ReducedModel &reduced, const HbmOptions &options);

/// Solves at omega; on entry x is a first guess when `have_guess`. Then, until one works: the linear response
/// about rest, about open and about closed contact; the path in the force from rest, or in the gap from open
/// contact; the path in the frequency from above. Throws PLM_CANCELLED when the host wants to stop.
StartOutcome find_start(HbmSystem &system, const ReducedModel &reduced, const HbmOptions &options,
                        double omega, bool have_guess, Watch watch, vector<double> &x,
                        StartPaths paths = StartPaths::affordable);

/// Newton's method at omega from x alone.
StartOutcome correct_at(HbmSystem &system, const HbmOptions &options, double omega, Watch watch,
                        vector<double> &x);

} // namespace plm
