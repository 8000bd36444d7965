// One motion at one frequency: exact, or with as many harmonics as it needs.
#pragma once
#include "hbm/options.hpp"
#include "linalg/monitor.hpp"
#include "motions/branch.hpp"

namespace plm {

/// On what responses are looked for, and how. To look otherwise is another task.
struct ResponseTask {
    std::shared_ptr<const ReducedModel> reduced; // widened for exact motions
    HbmOptions options;
    Watch watch;
    bool exact = false;      // curves of exact motions, where their first point is one
    bool only_looks = false; // what the next harmonics would change is not measured
};

/// guess: a point known, or null. What it has cost, and what is said of it, goes to the branch. False: none
/// was found.
bool solve_at(const ResponseTask &task, double omega, const BranchPoint *guess, Branch &branch,
              BranchPoint &point);
} // namespace plm
