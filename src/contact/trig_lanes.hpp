// Trigonometric polynomials of n_lanes pairs side by side: their zeros in one cell of a grid each, and the
// averages of the indicator between two of them. Coefficients and averages lie lane by lane: number k of lane
// l at k * n_lanes + l.
#pragma once
#include "linalg/lanes.hpp"

namespace plm {

/// A cell of each lane, at whose ends x has the values `low` and `high`; `twist` bounds x'''.
struct TrigCells {
    double width; // rad, at most 0.27
    double cosine_low[n_lanes], sine_low[n_lanes], cosine_high[n_lanes], sine_high[n_lanes];
    double low[n_lanes], high[n_lanes], twist[n_lanes];
};
/// Of each lane the zero's distance from the low end, its cosine and sine; `found` is false where the cell
/// may hold none or several, or where a few evaluations leave an error above rounding.
struct TrigZeros {
    double after_low[n_lanes], cosine[n_lanes], sine[n_lanes];
    bool found[n_lanes];
};
void zeros_in_cells(std::int64_t n_harmonics, const double *x, const TrigCells &cells, TrigZeros &out,
                    bool wide = has_wide_lanes());

/// Integrals of cos k t and sin k t, k = 1 ... 2H, from the instants `first` to `second`, by their cosines
/// and sines: out[2k - 1] and out[2k], lane by lane.
struct TrigEnds {
    double cosine_first[n_lanes], sine_first[n_lanes], cosine_second[n_lanes], sine_second[n_lanes];
};
void integrals_between(std::int64_t n_harmonics, const TrigEnds &ends, double *out,
                       bool wide = has_wide_lanes());

/// Those of n pairs whose penetration, low and high at the ends of a cell, may be zero inside: it is not
/// beyond `bound` on one side at both. Returns how many, by index into `out`.
std::int64_t indices_unclear(std::int64_t n, const double *low, const double *high, const double *bound,
                             std::int64_t *out, bool wide = has_wide_lanes());

/// force = k J(s) x of n_lanes pairs, whose coefficients and forces lie beside each other, the next ones
/// `stride` further; of one pair, whose averages lie one after the other.
void apply_averages(std::int64_t n_harmonics, const double *averages, const double *stiffness,
                    const double *x, std::int64_t stride, double *force, bool wide = has_wide_lanes());
void apply_averages_of_one(std::int64_t n_harmonics, const double *averages, double stiffness,
                           const double *x, std::int64_t stride, double *force);

} // namespace plm
