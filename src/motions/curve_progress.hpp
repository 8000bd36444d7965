// Where a curve stands, and the curves of a sweep that was stopped: from these it goes on with the points
// that it would have had.
#pragma once
#include "linalg/warnings.hpp"
#include "motions/periodic_equations.hpp"
#include "paths/path_progress.hpp"
#include <string>
#include <vector>

namespace plm {

class Branch;

/// What harmonic balance has chosen along a curve (hbm/harmonic_curve.cpp).
struct HarmonicChoices {
    std::int64_t n_harmonics = 0; // of an excitation's period
    bool modal = true, wants_modal = true, rejects = false;
    std::int64_t n_kept = 1, wanted_harmonics = 0, since_change = 0, blocked = 0, moved_most = 0,
                 failed_growths = 0;
    double base_arclength = 0;
};

struct CurveProgress {
    std::int64_t n_points = 0; // 0: it stands at its beginning, and nothing else is known
    NewtonWork newton_work;
    std::int64_t failed_steps = 0;
    std::string unknowns_used;
    std::int64_t work = 0;    // operations since it began
    std::int64_t attempt = 0; // its steps were shortened so often
    PathProgress path;
    EquationsMemory memory;
    HarmonicChoices harmonics;
};

/// One curve of a sweep, to its end or as far as it came.
struct FollowedCurve {
    std::shared_ptr<const Branch> curve; // null: the one that the record goes with
    Warnings warnings;                   // of that, when it was followed
    double allowed = 0;                  // operations that were left when it began
    std::int64_t work = 0;               // that it took
    CurveProgress progress;
};

struct SweepRecord {
    std::string options; // of the sweep, in words
    std::vector<FollowedCurve> curves;
};

} // namespace plm
