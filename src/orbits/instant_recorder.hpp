// What a run by the exact flow leaves: the motion of some rows at equidistant instants, from the polynomials
// of the pieces, and the number of contact events.
#pragma once
#include "orbits/exact_flow.hpp"

namespace plm {

class InstantRecorder final : public FlowRecorder {
  public:
    /// rows: k x n (FlowModel::dof_row). Instants interval, 2 interval, ... after the recorder is made.
    InstantRecorder(Matrix rows, double interval) : rows_(std::move(rows)), interval_(interval) {}

    /// The next piece begins `time` after the recorder was made: the flow's own time may be set back.
    void continue_at(double time) { piece_start_ = time; }
    void record(const FlowPiece &piece) override;

    /// One instant after the other, rows.rows() values each.
    vector<double> take_values() { return std::move(values_); }
    std::int64_t n_instants() const { return n_instants_; }
    /// Pairs that changed from one piece to the next. The flow's own count leaves out those that change
    /// exactly where a piece begins.
    std::int64_t n_events() const { return n_events_; }

  private:
    void count_events(const PairStates &states);

    Matrix rows_, polynomials_;
    double interval_, piece_start_ = 0;
    std::int64_t n_instants_ = 0, n_events_ = 0;
    vector<double> values_;
    PairStates before_;
};

} // namespace plm
