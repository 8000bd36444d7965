// Where a response curve begins.
#pragma once
#include "motions/branch.hpp"

namespace plm {

struct CurveStart {
    BranchPoint point;
    /// Not empty: a second point beside the first, on the side to which the curve is followed; otherwise
    /// options.upward decides.
    std::vector<BranchPoint> towards;
    bool away = false; // the curve leaves on the other side: on past `point`, as one comes from towards[0]
};

} // namespace plm
