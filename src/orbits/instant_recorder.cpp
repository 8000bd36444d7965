#include "orbits/instant_recorder.hpp"
#include "contact/polynomial.hpp"
#include <algorithm>

namespace plm {
namespace {

constexpr double at_the_end = 1e-9; // of an interval: an instant at the end of a piece belongs to it

} // namespace

void InstantRecorder::count_events(const PairStates &states) {
    if (before_.empty()) before_ = states;
    n_events_ += states.n_different(before_);
    before_ = states;
}

void InstantRecorder::record(const FlowPiece &piece) {
    count_events(piece.states);
    const double start = piece_start_;
    piece_start_ += piece.duration;
    const auto instant = [&] { return static_cast<double>(n_instants_ + 1) * interval_; };
    if (rows_.rows() == 0 || instant() > piece_start_ + at_the_end * interval_) return;
    polynomials_.reset(piece.coefficient.cols(), rows_.rows());
    gemm('T', 'T', 1.0, piece.coefficient, rows_, 0.0, polynomials_);
    for (; instant() <= piece_start_ + at_the_end * interval_; ++n_instants_) {
        const double fraction = std::clamp((instant() - start) / piece.duration, 0.0, 1.0);
        for (std::int64_t i = 0; i < rows_.rows(); ++i)
            values_.push_back(evaluate_polynomial(polynomials_.col(i), polynomials_.rows() - 1, fraction));
    }
}

} // namespace plm
