// Keeps the curves of a sweep as they are followed, so that it can be stopped anywhere and go on later: a
// sweep that goes on does again what led to its curves, and has of these what is known.
#pragma once
#include "motions/curve_progress.hpp"
#include <functional>

namespace plm {

class CurveRecorder {
  public:
    /// Of a branch as it is now: to a file, for one.
    using Save = std::function<void(const Branch &)>;

    /// before: a branch whose sweep goes on, or null. options: of the sweep, in words. save: asked after
    /// every so many points, and at the end of the sweep; null: not at all.
    CurveRecorder(std::shared_ptr<const Branch> before, std::string options, std::int64_t every, Save save);

    /// A curve begins in a branch without points. True: it is there now, to its end. False: it is to be
    /// followed, from progress() on.
    bool begin(std::int64_t max_points, Branch &branch);
    /// Null: from its beginning.
    const CurveProgress *progress() const { return resumed_; }
    /// It begins anew, with steps shortened so often.
    void begin_again(std::int64_t attempt);
    /// It has one more point.
    void pass(const Branch &branch);
    /// It stands at a point that it can go on from.
    void stand(CurveProgress at, const Branch &branch);
    void end(const Branch &branch);

    /// The sweep has come to its end or was stopped: `curve`, its answer, takes along what it goes on from.
    void finish(Branch &curve);

  private:
    bool is_over(const FollowedCurve &known, const Branch &curve, std::int64_t max_points) const;
    void go_on(const FollowedCurve &known, const Branch &curve, Branch &branch);
    void save(const Branch &branch);

    std::shared_ptr<const Branch> before_; // null: nothing of it is known any more
    const CurveProgress *resumed_ = nullptr;
    CurveProgress known_; // what that points to
    SweepRecord record_;
    std::int64_t every_, n_saved_ = 0, attempt_ = 0, began_ = 0;
    Save save_;
    std::string failure_; // of the last save
};

/// Whether a curve that ended so can go on.
bool can_go_on(std::int32_t end_reason);

} // namespace plm
