#include "hbm/follow.hpp"
#include "paths/quiet_owner.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

constexpr double start_change = 0.1;    // of the motion: the start is another problem's, or no solution
constexpr double tangent_error = 0.1;   // of a step: no other branch lies in between
constexpr double longest_tangent = 0.3; // of the motion
constexpr double same_place = 1e-6; // of the motion: a step may be too short for its error to mean anything
// Solutions farther from the start than this (share of the motion) are hardly those of its branch; at its own
// frequency more harmonics change it so much that one cannot tell.
constexpr double beside_the_start = 0.05, much_the_same = 0.3;

double distance(const vector<double> &a, const vector<double> &b, std::size_t first = 0) {
    double sum = 0;
    for (std::size_t i = first; i < a.size(); ++i) sum = std::hypot(sum, a[i] - b[i]);
    return sum;
}

class Follower {
  public:
    Follower(HbmSystem &system, const HbmOptions &options, double from, double to, Watch watch)
        : system_(system), options_(options), from_(from), to_(to), watch_(watch) {}

    StartOutcome run(vector<double> &x) {
        vector<double> here = x;
        const bool near = correct(from_, here) && distance(here, x) <= start_change * size_of(system_, x);
        out_.converged = near && (to_ == from_ || along_tangent(here) || continued(here));
        if (out_.converged) x = here;
        return out_;
    }

  private:
    bool correct(double omega, vector<double> &x) {
        out_.add(correct_at(system_, options_, omega, watch_, x));
        return out_.converged;
    }

    bool along_tangent(vector<double> &x) {
        vector<double> r(x.size()), ahead = x;
        system_.residual(x.data(), from_, r.data());
        system_.linearize();
        ++out_.factorizations;
        const PathState tangent = tangent_at(system_);
        for (std::size_t i = 0; i < x.size(); ++i) ahead[i] += (to_ - from_) * tangent.x[i];
        const vector<double> predicted = ahead;
        const double size = size_of(system_, x), step = distance(predicted, x);
        if (step > longest_tangent * size || !correct(to_, ahead)) return false;
        if (distance(ahead, predicted) > tangent_error * step + same_place * size) return false;
        x = ahead;
        return true;
    }

    bool continued(vector<double> &x) {
        PathOptions path;
        path.low = std::min(from_, to_);
        path.high = std::max(from_, to_);
        path.upward = to_ > from_;
        path.tolerance = options_.tolerance;
        path.max_iterations = options_.max_iterations;
        path.max_points = 1000;
        QuietOwner quiet(watch_);
        const PathOutcome out = follow_path(system_, path, {{x, from_}}, quiet);
        out_ += out.work;
        if (out.end_reason != reason::range_end || out.at.parameter != to_) return false;
        x = out.at.x;
        return correct(to_, x);
    }

    HbmSystem &system_;
    const HbmOptions &options_;
    double from_, to_;
    Watch watch_;
    StartOutcome out_;
};

} // namespace

StartOutcome follow_to(HbmSystem &system, const HbmOptions &options, double from, double to, Watch watch,
                       vector<double> &x) {
    return Follower(system, options, from, to, watch).run(x);
}

void warn_of_other_branch(const HbmSystem &system, const vector<double> &guessed, const vector<double> &x,
                          const BranchPoint &start, double omega, Branch &branch) {
    if (start.force_scale != branch.force_scale()) return; // the start solves another problem
    const double far = distance(x, guessed, static_cast<std::size_t>(system.static_size())),
                 size = std::max(size_of(system, x), size_of(system, guessed));
    if (!(far > (omega == start.omega ? much_the_same : beside_the_start) * size)) return;
    branch.warnings.add(
        reason::other_branch,
        format("the branch of the start was not followed to %.6g Hz, where it may have turned back before; "
               "the solution found there differs from the start by %.2g of the motion and may be on another "
               "branch; use a sweep to follow the branch round its folds",
               omega / (2 * M_PI), far / size));
}

} // namespace plm
