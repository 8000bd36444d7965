// The model that a curve of exact motions is followed on where each step on the basis itself would cost too
// much: the basis compressed to what its motions need. They come from a curve of few harmonics, and are
// enriched by what the whole basis answers to the contact forces of the exact motions beside it, until that
// changes these no more.
#pragma once
#include "hbm/options.hpp"
#include "linalg/monitor.hpp"
#include "motions/branch.hpp"
#include "motions/error_budget.hpp"
#include "orbits/orbit_points.hpp"
#include "searches/basis_error.hpp"

namespace plm {

/// Of its size: a motion farther away than this, on another model, is another one.
constexpr double same_motion = 0.1;

/// Whether a curve of exact motions on this model (P_0 = P) is to be followed on a compressed one.
bool compresses(const ReducedModel &whole, const HbmOptions &options);

/// Whether a model is so small that it saves time: what is followed on it needs more of the basis on its way.
bool is_much_smaller(const ReducedModel &model, const ReducedModel &whole);

/// Where the model is a compressed one and each step on it takes long, motions are exact to a few hundredths
/// of the accuracy: the model has no more of it.
HbmOptions options_on(const ReducedModel &model, HbmOptions options);

/// What a compressed model's motions may be off by: the basis takes its share of the accuracy, too.
double compression_tolerance(const ReducedModel &whole, const HbmOptions &options);

class CurveCompression {
  public:
    /// highest: angular frequency where the range ends.
    CurveCompression(std::shared_ptr<const ReducedModel> whole, const HbmOptions &options, double highest,
                     Watch watch);

    /// Takes motions of that curve, solved on the whole basis, and the exact ones beside some of them. False:
    /// these do not settle on a model that is much smaller.
    bool begin_with(const Branch &look);
    /// From a curve that was confirmed to that of another force level, whose motions are much like it.
    void go_on(const HbmOptions &options, const Branch &curve);
    /// To follow the curve on, and how.
    const std::shared_ptr<const ReducedModel> &model() const { return model_; }
    const HbmOptions &options() const { return options_; }
    /// Whether the highest motion of the curve on that model is as the whole basis has it; if not, model() is
    /// a better one.
    bool confirms(const Branch &curve);
    /// Of the highest motion, relative, after that: infinite where it was not found on a better model.
    double error() const;
    /// After that: to follow a curve on a better model would take minutes.
    bool is_spent() const;
    /// Says what the last confirms() found, where that is more than the accuracy, and what the last
    /// confirms_stability() did not.
    void warn(Branch &curve) const;
    /// Whether the curve is stable on the whole basis (where a step on that takes too long: on the better
    /// model of the last confirms(), and if not, that is left to warn()) where it is on that model: at its
    /// highest motion, and between the points where it becomes stable or unstable. If not, model() is a
    /// better one.
    bool confirms_stability(const Branch &curve);

  private:
    /// What the model is made from.
    struct Needs {
        Matrix motions; // of the whole basis, mean parts among them, as shares of the largest
        std::vector<vector<double>> springs; // in the place of the pairs, at their mean over a period
        void append(const Needs &other);
    };

    struct Point {
        BranchPoint motion; // in the coordinates of the whole basis, without the motion itself
        BranchPoint exact;  // on the last model that it was solved on
        double amplitude = -1;
        double change = INFINITY; // of the amplitude, by that model, over the peak
        Needs needs;              // what its exact motion and the correction of that ask of a model
    };

    /// Points spread over a curve, among them the highest one; all its motions go to needs_.
    std::vector<Point> points_of(const Branch &look);
    /// Whether a model is so much smaller than the whole one that a curve on it is worth its making.
    bool saves(const ReducedModel &smaller) const;
    double tolerance() const;
    double tolerance_predicted() const;
    bool is_dear(const ReducedModel &model) const;
    bool is_last_not_dear(const ReducedModel &model) const;
    /// last: the one that this one grows from; null: none.
    std::shared_ptr<const ReducedModel> compressed_after(const ReducedModel *last) const;
    std::shared_ptr<const ReducedModel> compressed_to(double most) const;
    /// Solves the exact motions beside the points on this model, but for those that have settled: only the
    /// last one, the highest, is never left out. Returns the largest change of an amplitude over the peak;
    /// infinite where none can be compared.
    double settle(const std::shared_ptr<const ReducedModel> &model, std::vector<Point> &points) const;
    bool settle(const std::shared_ptr<const ReducedModel> &model, Point &point, ElseMarching otherwise) const;
    void grow_beside(std::vector<Point> &highest);
    bool make_exact_on(const std::shared_ptr<const ReducedModel> &model, BranchPoint &point,
                       ElseMarching otherwise) const;
    void take(const BranchPoint &point, Matrix &motions) const;
    bool agrees(const BranchPoint &on_curve, const std::shared_ptr<const ReducedModel> &model,
                const BranchPoint &there, double amplitude_on_curve, double error) const;
    void compare_with_whole(const Branch &curve);
    Needs needs_at(const ReducedModel &model, const BranchPoint &exact) const;
    Needs needs_beside(const ReducedModel &model, const BranchPoint &exact,
                       const BranchPoint &corrected) const;
    bool grow_to(double enough, const Branch &curve);
    bool grow_at(const ReducedModel &model, const BranchPoint &point);
    bool find_on_whole(const Branch &curve, std::int64_t point, BranchPoint &found);
    bool agrees_on_whole(const Branch &curve, std::int64_t point);
    bool agrees_on_better(const Branch &curve, std::int64_t point);
    double amplitude(const std::shared_ptr<const ReducedModel> &model, const BranchPoint &point) const;

    std::shared_ptr<const ReducedModel> whole_;  // what the basis spans
    std::shared_ptr<const ReducedModel> model_;  // the compressed one that the curve is followed on
    std::shared_ptr<const ReducedModel> better_; // a larger one that its highest motion is compared with
    HbmOptions options_;
    double highest_;   // angular frequency where the range ends
    double left_out_;  // share of the motions that the compression may drop
    double omega_ = 0; // of the highest motion of the first look
    Watch watch_;
    Needs needs_;
    double scale_ = 0; // norm of the largest motion: others are taken as shares of it
    Output output_;    // the DOF that the curve is judged by, and its highest amplitude
    double peak_ = 0;
    double change_ = INFINITY; // of the highest motion, from the curve to better_, relative
    std::int64_t top_ = 0;     // which of the curve's points that is
    BranchPoint top_on_better_;
    // They know the contact sets of the curves before.
    std::shared_ptr<const OrbitEquations> on_whole_;
    ErrorAtForce last_;     // of a curve that was confirmed; none: the model has changed since
    bool outgrown_ = false; // no model that is much smaller than the whole one is nearer to it
    std::string doubtful_;  // where stability is not as on the curve; empty: nowhere
};

} // namespace plm
