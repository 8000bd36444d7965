// One period of an exact motion, kept piece by piece: its extrema, its Fourier coefficients and its contact
// follow from the pieces without sampling.
#pragma once
#include "contact/trig_polynomial.hpp"
#include "orbits/exact_flow.hpp"

namespace plm {

class RecordedMotion final : public FlowRecorder {
  public:
    void record(const FlowPiece &piece) override;
    bool only_polynomials() const override { return false; }

    double duration() const { return duration_; }
    /// Mean of the coordinates, n.
    vector<double> mean() const;
    /// Mean of (y - mean)(y - mean)^T over the motion, n x n.
    Matrix covariance() const;
    /// Harmonics [first, first + count) of the motion as one period: n x 2 count, columns a_h, b_h.
    Matrix harmonics(std::int64_t first, std::int64_t count) const;
    /// The forces of the pairs as a motion of Z coordinates; flow: that which was recorded.
    RecordedMotion contact_forces(const ExactFlow &flow) const;
    /// Extrema of row . y for every row of a matrix (rows x n), with what is known beside the flow's motion
    /// at the excitation's frequency.
    std::vector<ValueRange> ranges(const Matrix &rows, const KnownMotion &known = {}, double omega = 0) const;
    /// Share of the motion during which each pair is closed, and the number of pairs that are not always or
    /// never so.
    vector<double> closed_shares() const;
    std::int64_t n_switching() const;

  private:
    struct Piece {
        double start, duration;
        Matrix coefficient;
        PairStates states;
        FastMotion fast;
    };
    static double work_of(const Piece &piece, double exponentials, double columns);
    void weigh_powers(const Piece &piece, std::int64_t first, Matrix &weight) const;
    void weigh_fast(const Piece &piece, std::int64_t first, Matrix &of_cosine, Matrix &of_sine) const;
    void widen_by_piece(const Piece &piece, const double *row, const KnownMotion &known, double omega,
                        ValueRange &range) const;
    std::vector<Piece> pieces_;
    double begin_ = 0, duration_ = 0; // begin_: the flow's time then
};

/// Z flags of the pairs that act at some time.
vector<char> acting_pairs(const std::vector<ContactInterval> &intervals, std::int64_t n_pairs);

/// max |row . y| over one period of the response for each row of `rows` (k x n; see FlowModel::dof_row).
vector<double> orbit_peaks(ExactFlow &flow, const FlowState &start, std::int64_t period_multiple,
                           const Matrix &rows);

} // namespace plm
