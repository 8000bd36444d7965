// What a flow hands to those who watch it: states, pieces, and what a motion may be differentiated by.
#pragma once
#include "orbits/flow_model.hpp"
#include <complex>

namespace plm {

/// What a motion may be differentiated by.
enum class FlowParameter { none, frequency, force_scale };

/// Free motion of fast modes on a piece, too small to matter to its contact events: y(t) = Re sum_k (cosine_k
/// + i sine_k) exp(rate_k t), t from the beginning of the piece.
struct FastMotion {
    vector<std::complex<double>> rate;
    Matrix cosine, sine; // n x modes
};

/// One piece of the motion: y(start + s duration) = sum_k coefficient(:, k) s^k for s in [0, 1], and `fast`
/// beside it, with one contact set. Valid during the call of the recorder only.
struct FlowPiece {
    double start, duration;
    const Matrix &coefficient; // n x (degree + 1)
    const PairStates &states;
    const FastMotion *fast = nullptr;
};

class FlowRecorder {
  public:
    virtual ~FlowRecorder() = default;
    virtual void record(const FlowPiece &piece) = 0;
    /// Whether it needs polynomials alone: pieces are then as short as the fastest motion.
    virtual bool only_polynomials() const { return true; }
    /// Whether it looks at the displacements at all.
    virtual bool needs_motion() const { return true; }
};

} // namespace plm
