// When each pair changes its state in a period: all zeros of its penetration, a trigonometric polynomial.
// A coarse grid brackets them; cells in which the curve turns towards zero and back are searched for a pair
// of zeros (grazing: without it the force would jump when a pair opens and closes inside one cell), and cells
// that may hold more are halved.
#pragma once
#include "contact/pair_states.hpp"
#include "contact/trig_lanes.hpp"
#include "contact/trig_polynomial.hpp"

namespace plm {

class PenetrationZeros {
  public:
    PenetrationZeros(std::int64_t n_harmonics, std::int64_t n_pairs);

    /// u: Z x (2H + 1) coefficients of the penetration, column c is coefficient c.
    void find(const Matrix &u);
    bool closed_first(std::int64_t pair) const { return ContactLaw::closed(values_(pair, 0)); } // at t = 0
    /// Zeros of a pair, ascending.
    std::int64_t count(std::int64_t pair) const { return first_[pair + 1] - first_[pair]; }
    const TrigInstant *of(std::int64_t pair) const { return zeros_.data() + first_[pair]; }

  private:
    struct Cell {
        std::int64_t pair, instant;
    };
    void bound_derivatives(const Matrix &u);
    void collect_cells();
    void search_cells(const Matrix &u, std::int64_t first);
    void search_cell(const Matrix &u, const Cell &cell);
    void search(const TrigEnd &left, const TrigEnd &right, int halvings);
    void search_turn(const TrigEnd &left, const TrigEnd &right);
    double sagitta(double width) const { return 0.125 * width * width * bend_[pair_]; }
    bool clears(const TrigEnd &left, const TrigEnd &right) const;
    bool simple(const TrigEnd &left, const TrigEnd &right) const;
    std::int64_t after(std::int64_t instant) const { return instant + 1 < n_grid_ ? instant + 1 : 0; }

    std::int64_t h_, n_grid_;
    double width_;                        // of a grid cell, rad
    Matrix grid_, values_;                // grid: trig_grid(); values: Z x grid
    vector<double> bound_, bend_, twist_; // of each pair: see bound_derivatives()
    vector<std::int64_t> unclear_;        // pairs, of one cell after the other
    vector<std::int64_t> n_unclear_;      // per cell
    vector<Cell> cells_;
    vector<double> lanes_;  // coefficients of n_lanes cells' pairs
    std::int64_t pair_ = 0; // that is searched by itself, and its coefficients
    vector<double> x_;
    vector<TrigInstant> zeros_;
    vector<std::int64_t> first_; // of each pair in zeros_
};

/// The instants in radian, ascending.
struct SwitchingInstants {
    PairStates first; // at t = 0
    std::vector<vector<double>> instants;
};
/// u: Z x (2H + 1) coefficients.
SwitchingInstants switching_instants(const Matrix &u);

} // namespace plm
