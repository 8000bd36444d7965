// A whole response curve, from either end of its range, by exact motions or harmonics.
#pragma once
#include "motions/curve_recorder.hpp"
#include "motions/curve_verdicts.hpp"
#include "reduction/sweep_range.hpp"
#include "searches/single_response.hpp"
#include <chrono>

namespace plm {

class CurveCompression; // compressed_curve.hpp

/// What the curve of another force level leaves for the next one.
struct LevelBefore {
    std::shared_ptr<CurveCompression> compression; // that it was followed on; null: on the whole basis
    std::shared_ptr<const Branch> curve;           // null: there is none yet
    JudgedForce judged = {};                       // with the whole structure
};

struct SweepTask : ResponseTask {
    SweepRange reach = {};         // how far the curve may go on to have its peak inside
    const Output *asked = nullptr; // whose peak that is to be, too
    /// Taken up, and left for the next level. Null: this curve is the only one.
    LevelBefore *level_before = nullptr;
    /// A whole curve on that model with few harmonics, where one is known (sweep_with_few_harmonics()).
    std::shared_ptr<const Branch> look = nullptr;
    CurveRecorder *recorder = nullptr; // of its curves; null: they are not recorded
};

/// At least one point, within the effort that is left. PLM_ERR_CONVERGENCE where no motion is found,
/// PLM_CANCELLED where that takes more than the effort.
std::shared_ptr<Branch> sweep_whole(const SweepTask &task);

/// With few harmonics and a rough tolerance, in a second or so where that can be; with fewer where such a
/// curve does not come to the other end in a few hundred points or several seconds, as in a tangle of
/// bounces: the fewer harmonics, the simpler the curve. The last one tried where none comes to its end.
std::shared_ptr<Branch> sweep_with_few_harmonics(const SweepTask &task);

/// Whether a whole curve by harmonics tells of a larger motion than a part of one by exact motions: its
/// highest one is larger, and the structure goes on so in time, if not exactly. Where no motion is near, as
/// in a tangle of bounces, it falls to what there is.
bool says_more(const Branch &curve, const Branch &part, Watch watch);

/// The time that a branch has taken, which is said.
void finish(Watch watch, std::chrono::steady_clock::time_point begin, Branch &branch);

} // namespace plm
