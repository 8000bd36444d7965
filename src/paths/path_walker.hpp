// Where a path is: the present point with the system linearised there, its tangent and its test functions,
// and how to get from beside the path onto it.
#pragma once
#include "paths/newton.hpp"
#include "paths/path.hpp"
#include "paths/path_progress.hpp"
#include <algorithm>
#include <cmath>
#include <vector>

namespace plm {

class PathWalker {
  public:
    /// Neighbouring tangents farther apart (rad) do not belong to one smooth piece of a path.
    static constexpr double sharp_angle = 0.6;
    /// A factorization so near to a point has its tangent and its tests.
    static constexpr double at_the_point = 1e-6;
    /// Test functions before those of the owner: fold, branch point.
    static constexpr std::size_t own_tests = 2;

    PathWalker(Residual &system, const PathOptions &options, PathOwner &owner);

    const PathState &now() const { return now_; }
    const PathState &tangent() const { return tangent_; }
    const Metric &metric() const { return metric_; }
    double cosine_with_tangent(const PathState &direction) const {
        return metric_.product(tangent_, direction);
    }
    double angle_with_tangent(const PathState &direction) const {
        return std::acos(std::min(1.0, std::max(-1.0, cosine_with_tangent(direction))));
    }
    std::int32_t kind(std::size_t test) const { return kinds_[test]; }
    std::size_t n_tests() const { return kinds_.size(); }
    bool is_factored() const { return factored_; }
    NewtonWork work;

    /// Goes to a point without asking whether it is a solution.
    void move(PathState to) {
        now_ = std::move(to);
        stands_ = false;
    }
    /// The system is linearised at the present point, as near as a last correction.
    void stand() { stands_ = true; }
    void set_tangent(const PathState &tangent) { tangent_ = tangent; }
    /// The metric follows the largest response met, so that the flanks behind a resonance cost few points, or
    /// that of now (PathOptions::scale_falls). True: it changed.
    bool take_scale(double least = 0);
    void linearize_here();
    /// A path goes on: the system is linearised here where it is led by that of the last point. False: that
    /// is no point of this system.
    bool go_on(const PathProgress &from);
    /// Where a correction has just led: the system stands there.
    void linearize_at_solution();
    /// The system is (or is no longer) factored near the present point.
    void set_factored(bool factored) { factored_ = factored; }
    /// Factors the system at another point.
    void linearize_at(const PathState &at);
    /// Unit tangent from the present factorization; oriented along `previous`, or into the range at the
    /// start.
    void make_tangent(const PathState *previous);
    /// sign(det) of the tangent bordered by the path's direction: along a path it changes at branch points
    /// only, where the path goes straight on, but not at a corner, however sharp.
    double orientation() const;
    /// The tangent on the side with this orientation.
    void orient(double wanted);
    void restore(const PathState &at, const PathState &tangent);
    /// The present point is one to come back to, and does so.
    void remember();
    void come_back();
    /// Back to the path in the plane across `direction` through the first guess; factored: by the present
    /// factorization, of which the tangent is, as long as it serves.
    NewtonOutcome correct(PathState &at, const PathState &direction, double min_damping, bool factored);
    NewtonOutcome correct_at_parameter(PathState &at);
    /// Test functions at the present point: the tangent's share of p (fold), the smallest stretch of the
    /// bordered tangent (branch point), the owner's. None where nothing is located.
    vector<double> tests();
    /// One of them.
    double test(std::size_t k);

  private:
    double fold_test() const { return tangent_.parameter * metric_.width; }
    double branch_test();

    Residual &system_;
    const PathOptions &options_;
    PathOwner &owner_;
    std::int64_t n_;
    Metric metric_;
    PathState now_, tangent_, remembered_, remembered_tangent_;
    bool factored_ = false, stands_ = false;
    std::vector<std::int32_t> kinds_; // of the test functions
    vector<double> scratch_;
};

} // namespace plm
