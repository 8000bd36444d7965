// One solution of harmonic balance at one frequency, by whatever leads to it.
#pragma once
#include "hbm/options.hpp"
#include "hbm/start.hpp"
#include "motions/branch.hpp"

namespace plm {

/// From `guess`, a point known, or null. With the harmonics of `wanted` or, where they are chosen and have no
/// solution that is found, with as many as lead to one: the more pairs, the fewer of the ways to a first
/// solution can be gone with all of them. What it has cost, and what is said of it, goes to the branch.
bool solve_from_few(std::shared_ptr<const ReducedModel> reduced, const HbmOptions &wanted, bool chosen,
                    double omega, const BranchPoint *guess, Watch watch, Branch &branch, BranchPoint &point);

/// With as many harmonics as the point needs; only_looks: what the next ones would change is not measured.
bool solve_by_harmonics(std::shared_ptr<const ReducedModel> reduced, const HbmOptions &asked, double omega,
                        const BranchPoint *guess, Watch watch, bool only_looks, Branch &branch,
                        BranchPoint &point);

} // namespace plm
