#include "searches/single_response.hpp"
#include "hbm/harmonic_choice.hpp"
#include "hbm/harmonic_point.hpp"
#include "motions/first_harmonics.hpp"
#include "orbits/orbit_points.hpp"
#include <algorithm>

namespace plm {
namespace {

// Along the exact motions from the guess, or beside a solution with few harmonics.
bool solve_exactly_at(const ResponseTask &task, double omega, const BranchPoint *guess, Branch &branch,
                      BranchPoint &point) {
    if (guess && guess->motion)
        return follow_exactly_to(task.reduced, task.options, *guess, omega, task.watch, point,
                                 branch.newton_work);
    HbmOptions few = task.options;
    few.n_harmonics = few_harmonics(*task.reduced);
    if (guess)
        few.n_harmonics = std::max(few.n_harmonics, harmonics_of(*guess, task.options.period_multiple));
    return solve_from_few(task.reduced, few, task.options.n_harmonics == 0, omega, guess, task.watch, branch,
                          point) &&
           make_exact(task.reduced, task.options, task.watch, point, branch.newton_work);
}

} // namespace

bool solve_at(const ResponseTask &task, double omega, const BranchPoint *guess, Branch &branch,
              BranchPoint &point) {
    if (task.exact && solve_exactly_at(task, omega, guess, branch, point)) return true;
    if (!solve_by_harmonics(task.reduced, task.options, omega, guess, task.watch, task.only_looks, branch,
                            point))
        return false;
    if (task.exact && !make_exact(task.reduced, task.options, task.watch, point, branch.newton_work))
        return task.options.motion != MotionKind::exact;
    return true;
}

} // namespace plm
