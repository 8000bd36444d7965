// Which pair changes its state first on a piece of a flow, where penetrations are polynomials of s in [0, 1]
// (polynomial.hpp), and which states such a piece confirms.
#pragma once
#include "contact/contact.hpp"
#include "linalg/dense.hpp"

namespace plm {

class PieceEvents {
  public:
    /// contact is borrowed; gap: Z x n, the rows by which a state moves the pairs.
    PieceEvents(const Contact &contact, const Matrix &gap);

    const PairStates &states() const { return states_; }
    /// By the penetrations alone; pairs at zero get their side from correct().
    void guess(const vector<double> &penetration);
    /// No pair's zero has just been located.
    void forget_zeros();

    /// The states that the motion itself confirms: each pair on the side to which it first moves away from
    /// zero. Continuity of the force makes this well defined: a pair that leaves zero by its j-th derivative
    /// has no influence on derivatives up to j + 1. penetration: Z x n_terms coefficients with the states as
    /// they are; reach: bound of how far the coordinates go. True when a pair changed sides.
    bool correct(const Matrix &penetration, double reach);
    /// Share of the piece after which the first pair leaves its side, 1 and pair -1 when none does. A zero at
    /// the beginning is divided out, so that it is not found again. penetration: as last handed to correct().
    double first(const Matrix &penetration, std::int64_t &pair);
    /// The pair changes its state, its penetration being zero there.
    void pass(std::int64_t pair);

  private:
    /// Where a pair's penetration first differs from zero: power of s and side; -1 where it never does.
    struct Side {
        std::int64_t power = 0;
        bool closed = false;
    };
    Side side_of(const Matrix &penetration, std::int64_t pair) const;

    const Contact &contact_;
    PairStates states_;
    vector<char> at_zero_; // its zero was just located
    vector<double> row_norm_, noise_, polynomial_;
    std::vector<Side> sides_;
};

} // namespace plm
