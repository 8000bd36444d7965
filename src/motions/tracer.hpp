// From paths of periodic motions to the points of a branch: whoever follows one keeps its points here.
#pragma once
#include "motions/branch_path.hpp"
#include "motions/curve_recorder.hpp"
#include "motions/periodic_equations.hpp"
#include "paths/path_guide.hpp"
#include <functional>
#include <memory>

namespace plm {

class Tracer : public PathOwner {
  public:
    /// stage: what the host is told of.
    Tracer(const char *stage, Watch watch, Branch &branch) : watch_(watch), branch_(branch), stage_(stage) {}
    bool cancelled(double fraction) override { return watch_.cancelled(stage_, fraction); }
    bool rescue(double, vector<double> &) override { return false; }

  protected:
    /// The path's outcome is the branch's.
    void follow(Residual &system, const PathOptions &options, const PathStart &start);
    /// Where it is stopped in the middle of a point, by the host or by a spent effort, those found so far
    /// stay.
    void keep_points(const std::function<void()> &follow);

    Watch watch_;
    Branch &branch_;

  private:
    const char *stage_;
};

/// Where a response curve begins.
struct CurveStart {
    BranchPoint point;
    /// Not empty: a second point beside the first, on the side to which the curve is followed; otherwise
    /// options.upward decides.
    std::vector<BranchPoint> towards;
    bool away = false; // the curve leaves on the other side: on past `point`, as one comes from towards[0]
    std::shared_ptr<const Branch> beside = nullptr; // the curve of a force level near by, or null
};

/// Of a response curve over the frequency, with its folds and bifurcations. At every tenth step all begins
/// anew from where it stands, whether it is recorded or not, so that one that goes on from there later takes
/// the same points.
class CurveTracer : public Tracer {
  public:
    /// recorder: or null; where it knows how far the curve is, it goes on from there.
    CurveTracer(PeriodicEquations *equations, const MotionOptions &options, Watch watch, Branch &branch,
                CurveRecorder *recorder)
        : Tracer("sweep", watch, branch), equations_(equations), recorder_(recorder), limits_(options) {}
    /// Appends the curve's points to the branch and sets its ending and its cost.
    void run(const CurveStart &start);

    void record(const PathPoint &point) override;
    bool rescue(double omega, vector<double> &x) override;
    vector<std::int32_t> test_kinds() const override;
    void test(const vector<double> &x, double omega, vector<double> &values) override;
    bool interrupt() override;

  protected:
    virtual void follow_on(const PathOptions &range, const PathStart &start);
    /// Where the curve goes on; null: at its start.
    const CurveProgress *known() const { return recorder_ ? recorder_->progress() : nullptr; }
    /// All begins anew, and what goes on from here is recorded; choices: where harmonics are chosen.
    void stand(const PathProgress &at, const HarmonicChoices &choices = {});
    /// At `point`, in the direction of `next`.
    PathStart leaving(const BranchPoint &point, const BranchPoint &next) const;
    BranchPoint point_of(const PathPoint &at);

    PeriodicEquations *equations_; // of now
    CurveRecorder *recorder_;

  private:
    PathState state_of(const BranchPoint &point) const { return {equations_->unknowns(point), point.omega}; }

    /// Along the curve of another force level, from the end that is nearer to omega; null: it is of another
    /// model.
    std::unique_ptr<PathGuide> guide_by(const Branch *known, double omega) const;

    const MotionOptions limits_;
    std::unique_ptr<PathGuide> guide_; // or null
    std::int64_t since_stand_ = 0;     // steps
};

} // namespace plm
