// The map of a state over one or more periods of the excitation, and a step of Newton's method towards a
// state that it leaves in place.
#pragma once
#include "orbits/exact_flow.hpp"

namespace plm {

/// |y, v|^2 = sum (lambda + omega^2) y^2 + v^2 (omega^2: for rigid-body motion). What follows is no state.
class EnergyNorm {
  public:
    explicit EnergyNorm(const ExactFlow &flow) : EnergyNorm(flow.model(), flow.omega()) {}
    EnergyNorm(const FlowModel &model, double omega) : model_(model), omega_(omega) {}
    double distance(const FlowState &a, const FlowState &b) const;

  private:
    const FlowModel &model_;
    double omega_;
};

/// One run over a number of periods from a state.
struct PeriodRun {
    FlowState end;
    double distance = 0; // of the end from the start, in the energy norm
    double size = 0;     // the largest distance of the motion from its start, looked at four times a period
    std::vector<ContactInterval> intervals;
    double defect() const { return size > 0 ? distance / size : 0.0; }
};

PeriodRun run_periods(ExactFlow &flow, const FlowState &start, std::int64_t periods);

/// step (FlowModel::state_size()) with (I - M) step = end - start, M the monodromy matrix of the run.
/// `within` (state_size x m), unless empty: orthonormal, the step is taken in its span only and the equations
/// are projected on it (a structure in free motion: nothing brings it back along the rest).
vector<double> period_step(const FlowModel &model, const FlowState &start, const PeriodRun &run,
                           const Matrix &monodromy, const Matrix &within = Matrix());

/// state + factor * step
FlowState moved(const FlowModel &model, const FlowState &state, const vector<double> &step, double factor);

} // namespace plm
