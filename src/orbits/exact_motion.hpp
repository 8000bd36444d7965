// The exact piecewise-linear motion beside a point of harmonic balance: a few steps of Newton's method on the
// map over one period. What is said of stability is said of that motion.
#pragma once
#include "motions/branch.hpp"
#include "orbits/event_motion.hpp"
#include "orbits/exact_flow.hpp"
#include <cmath>
#include <functional>

namespace plm {

/// The contact events of a point over its period, from the zeros of its penetrations.
EventSequence contact_events(const ReducedModel &reduced, const BranchPoint &point,
                             std::int64_t period_multiple);

class MotionBeside {
  public:
    /// affordable: what one run of the flow may cost (flops), INFINITY: it is run whatever it costs.
    MotionBeside(std::int64_t period_multiple, double affordable)
        : periods_(period_multiple), affordable_(affordable) {}
    /// Where points of a whole curve ask: above, that would take minutes.
    static constexpr double of_curve = 3e7;
    /// Multipliers of a monodromy matrix.
    using OfMonodromy = std::function<vector<std::complex<double>>(const Matrix &)>;
    /// Those of the exact motion beside `point`; empty when a few steps of Newton's method do not lead to a
    /// motion that the point describes, or when the flow would take longer than allowed.
    /// sequence: contact_events() of the point; within: see period_step(). What lay between the last point
    /// and its motion is the first guess for the next one, and how its multipliers differ tells whether that
    /// guess is good enough for those of the next one; contact sets that come back are known by their modes.
    vector<std::complex<double>> multipliers(std::shared_ptr<const FlowModel> model, const BranchPoint &point,
                                             const EventSequence &sequence, const Matrix &within,
                                             const OfMonodromy &of);

    /// Forgets the points before, but for what lay between the last one and its motion: that is returned.
    const vector<double> &settle();
    void take(vector<double> correction) { correction_ = std::move(correction); }

  private:
    vector<std::complex<double>> by_events(const ExactFlow &flow, const FlowState &start,
                                           EventSequence sequence, const Matrix &within,
                                           const OfMonodromy &of);
    vector<std::complex<double>> newton(ExactFlow &flow, const FlowState &start, FlowState now,
                                        const Matrix &within, const OfMonodromy &of);
    void keep_correction(const FlowModel &model, const FlowState &start, const FlowState &found);

    std::int64_t periods_;
    double affordable_;
    std::shared_ptr<const FlowModel> model_;  // of the last point
    std::shared_ptr<ContactModesKept> modes_; // of that model
    vector<double> correction_;               // FlowModel::state_size(); empty: none is known
    FlowState found_;                         // the last motion, and its multipliers (empty: there is none)
    vector<std::complex<double>> found_multipliers_;
};

} // namespace plm
