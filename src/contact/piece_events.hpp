// Which pair changes its state first on a piece of a flow, where penetrations are polynomials of s in [0, 1]
// (polynomial.hpp), and which states such a piece confirms.
#pragma once
#include "contact/contact.hpp"
#include "contact/piece_penetrations.hpp"

namespace plm {

class PieceEvents {
  public:
    /// gap: Z x n, the rows by which a state moves the pairs; wall_scale: of the gaps' motion.
    PieceEvents(const Contact &contact, const Matrix &gap, double omega = 1, double wall_scale = 1);

    const PairStates &states() const { return states_; }
    /// By the penetrations alone; pairs at zero get their side from correct().
    void guess(const vector<double> &penetration);
    /// No pair's zero has just been located.
    void forget_zeros();

    /// The states that the motion itself confirms: each pair on the side to which it first moves away from
    /// zero. Continuity of the force makes this well defined: a pair that leaves zero by its j-th derivative
    /// has no influence on derivatives up to j + 1. penetrations: with the states as they are; reach: bound
    /// of how far the coordinates go. True when a pair changed sides.
    bool correct(const PiecePenetrations &penetrations, double reach);
    /// The same with the penetrations' rounding (Z) in the place of that bound.
    bool correct(const PiecePenetrations &penetrations, const vector<double> &rounding);
    /// Whether each pair whose zero was just located leaves it by its velocity, by far more than rounding.
    bool leave_clearly() const;
    /// Share of the piece after which the first pair leaves its side, 1 and pair -1 when none does. A zero at
    /// the beginning is divided out, so that it is not found again. penetrations: as last handed to
    /// correct(). together: pairs that follow within this share of the piece leave with it, the share being
    /// that of the last of them; the force is wrong by what a spring has for so long, the motion by the
    /// square of that.
    double first(const PiecePenetrations &penetrations, std::int64_t &pair, double together = 0);
    /// The same by the penetrations and their rates at both ends of a piece (Z x 2 each) and bounds of their
    /// fourth derivatives on it (Z), with nothing between them looked at. -1: no pair comes to zero, but for
    /// `leaving` (-1: none) at its end; else the first pair that is beyond zero there, or of which it is not
    /// known. A pair whose zero was just located has to leave it clearly, as in leave_clearly().
    std::int64_t not_staying(const Matrix &begin, const Matrix &end, const vector<double> &fourth,
                             const vector<double> &rounding, double duration, std::int64_t leaving);
    /// Whether a pair with this penetration is on the other side of zero than its state says.
    bool is_beyond(std::int64_t pair, double u) const {
        return ContactLaw::closed(u) != states_.is_closed(pair);
    }
    /// The pairs of the last first() or not_staying() change their states, their penetrations being zero
    /// there. Returns how many.
    std::int64_t pass();

  private:
    /// Where a pair's penetration first differs from zero: power of s and side; -1 where it never does.
    struct Side {
        std::int64_t power = 0;
        double size = 0; // of the coefficient
        bool closed = false;
    };
    struct Event {
        double share;
        std::int64_t pair;
    };
    bool confirm(const PiecePenetrations &penetrations);
    // p: the coefficients of one pair.
    double crossing(const double *p, std::int64_t n_terms, std::int64_t pair, double until);
    Side side_of(const double *p, std::int64_t n_terms, std::int64_t pair) const;

    PairStates states_;
    vector<char> at_zero_; // its zero was just located
    vector<double> row_norm_, gap_size_, noise_, polynomial_;
    std::vector<Side> sides_;
    std::vector<Event> leaving_;
};

} // namespace plm
