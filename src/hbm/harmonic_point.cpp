#include "hbm/harmonic_point.hpp"
#include "hbm/follow.hpp"
#include "hbm/harmonic_choice.hpp"
#include "hbm/make_system.hpp"
#include "hbm/solved_point.hpp"
#include "motions/first_harmonics.hpp"
#include <algorithm>

namespace plm {
namespace {

bool solve_with(std::shared_ptr<const ReducedModel> reduced, const HbmOptions &options, double omega,
                const BranchPoint *guess, StartPaths paths, Watch watch, Branch &branch, BranchPoint &point) {
    const auto system = make_system(reduced, options);
    vector<double> x(system->size(), 0.0);
    StartOutcome out;
    if (guess) {
        x = unknowns_of(*system, *guess);
        out = follow_to(*system, options, guess->omega, omega, watch, x);
    }
    if (!out.converged) {
        const vector<double> guessed = x;
        out.add(find_start(*system, *reduced, options, omega, guess != nullptr, watch, x, paths));
        if (guess && out.converged) warn_of_other_branch(*system, guessed, x, *guess, omega, branch);
    }
    branch.newton_work += out;
    if (!out.converged) return false;
    point = solved_point(*system, {x, omega}, out.residual, out.iterations);
    return true;
}

} // namespace

bool solve_from_few(std::shared_ptr<const ReducedModel> reduced, const HbmOptions &wanted, bool chosen,
                    double omega, const BranchPoint *guess, Watch watch, Branch &branch, BranchPoint &point) {
    if (solve_with(reduced, wanted, omega, guess, StartPaths::affordable, watch, branch, point)) return true;
    HbmOptions fewest = wanted;
    fewest.n_harmonics = highest_excitation(*reduced);
    if (!guess && fewest.n_harmonics < wanted.n_harmonics &&
        solve_with(reduced, fewest, omega, nullptr, StartPaths::affordable, watch, branch, point)) {
        const bool all = climb_harmonics(reduced, wanted, wanted.n_harmonics, point, watch);
        if (all || chosen) return true;
    }
    return !affords_paths(*reduced, wanted) &&
           solve_with(reduced, wanted, omega, guess, StartPaths::alone, watch, branch, point);
}

bool solve_by_harmonics(std::shared_ptr<const ReducedModel> reduced, const HbmOptions &asked, double omega,
                        const BranchPoint *guess, Watch watch, bool only_looks, Branch &branch,
                        BranchPoint &point) {
    const HbmOptions options = with_affordable_harmonics(*reduced, asked);
    HbmOptions wanted = with_first_harmonics(*reduced, options);
    if (guess && options.n_harmonics == 0) // a start with its harmonics cut would be another motion
        wanted.n_harmonics =
            std::min(options.max_harmonics,
                     std::max(wanted.n_harmonics, harmonics_of(*guess, options.period_multiple)));
    HbmOptions few = options;
    few.n_harmonics = std::min(wanted.n_harmonics, few_harmonics(*reduced));
    const bool chosen = options.n_harmonics == 0;
    const bool climbs = !guess && wanted.n_harmonics > 2 * few.n_harmonics;
    bool found = climbs && solve_from_few(reduced, few, chosen, omega, nullptr, watch, branch, point) &&
                 climb_harmonics(reduced, options, wanted.n_harmonics, point, watch);
    found = found || solve_from_few(reduced, wanted, chosen, omega, guess, watch, branch, point);
    if (found && !only_looks) settle_harmonics(reduced, options, point, watch);
    return found;
}

} // namespace plm
