// The exact piecewise-linear motion beside a point of harmonic balance: a few steps of Newton's method on the
// map over one period. What is said of stability is said of that motion.
#pragma once
#include "hbm/branch.hpp"
#include "transient/exact_flow.hpp"

namespace plm {

class MotionBeside {
  public:
    MotionBeside(std::int64_t period_multiple, Watch watch) : periods_(period_multiple), watch_(watch) {}
    /// The monodromy matrix of the exact motion beside `point`; empty when a few steps of Newton's method do
    /// not lead to a motion that the point describes, or when running the flow would take far longer than
    /// the point did. `within`: see period_step(). What lay between the last point and its motion is the
    /// first guess for the next one.
    Matrix monodromy(std::shared_ptr<const FlowModel> model, const BranchPoint &point, const Matrix &within);

  private:
    Matrix search(ExactFlow &flow, const FlowState &start, FlowState now, const Matrix &within);
    Matrix newton(ExactFlow &flow, const FlowState &start, FlowState now, const Matrix &within);
    void keep_correction(const FlowModel &model, const FlowState &start, const FlowState &found);

    std::int64_t periods_;
    Watch watch_;
    vector<double> correction_; // FlowModel::state_size(); empty: none is known
};

} // namespace plm
