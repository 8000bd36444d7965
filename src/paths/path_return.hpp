// Whether a path has come back: to where it began, in the direction in which it had left or against it, or to
// a point of its own, on a closed curve that a step has crossed over to.
#pragma once
#include "paths/passed_points.hpp"
#include "paths/path_progress.hpp"
#include "paths/path_walker.hpp"

namespace plm {

class PathReturn {
  public:
    PathReturn(PathWalker &walker, std::int64_t n_unknowns) : walker_(walker), passed_(n_unknowns) {}

    /// Where the path is closed, in which direction; the path itself begins there, or elsewhere.
    void begin(const PathState &target, const PathState &tangent, bool from_start);
    /// What of a path's progress is known here, from there and to there.
    void go_on(const PathProgress &from);
    void put(PathProgress &to) const;
    const PathState &target() const { return target_; }
    bool is_target(const PathState &at) const;
    /// What the step from `before` to the present point came back to: PLM_REASON_LOOP_CLOSED,
    /// PLM_REASON_TURNED_BACK, PLM_REASON_CROSSED_OVER, or PLM_REASON_NONE.
    std::int32_t by_step(const PathState &before, double moved, std::int64_t n_recorded);
    /// The present point is one to come back to.
    void pass() { passed_.add(walker_.metric(), walker_.now(), walker_.tangent()); }

  private:
    bool passes_target(const PathState &before, double moved, std::int64_t n_recorded) const;
    bool solve_on_step(const PathState &before, double parameter, PathState &at);
    bool goes_round(const PathState &before);

    PathWalker &walker_;
    PathState target_, target_tangent_;
    bool from_start_ = true;
    PassedPoints passed_;
};

} // namespace plm
