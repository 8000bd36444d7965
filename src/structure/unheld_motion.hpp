// Rigid-body motion that no gap row holds, whatever closes: the one notion of it. Rows and loads that miss it
// by what printed coordinates or weights are rounded to are taken to mean it, for along it even the least
// force has nothing to rest on.
#pragma once
#include "structure/gap_rows.hpp"

namespace plm {

/// Of what counts as none, relative to its terms before they cancel: what double precision leaves (of
/// rigid-body modes of a solid of thousands of DOFs, 2e-10), and what may still be meant as zero. Beyond that
/// the model means what it says.
constexpr double exactly_zero = 2e-9, meant_as_zero = 1e-3;

/// Its directions R_0 among the rigid-body modes R, M-orthonormal as they are.
Field unheld_motion(const GapRows &rows, const Field &rigid_modes);

/// The row that changes most along the motions, relative to its terms in the rigid-body modes.
struct RowMiss {
    std::int64_t row = -1;
    double size = 0;
};
RowMiss largest_miss(const GapRows &rows, const Field &motions, const Field &rigid_modes);

/// Of a load (one column) along the motions: relative to its terms there, or, where it is but rounding of its
/// terms in all rigid-body modes, to those (a load across a motion has no terms along it but rounding); and
/// as a force or moment about the motion of its own in which the DOF (free index) that moves most moves by
/// one.
struct Resultant {
    double relative = 0, force = 0;
    std::int64_t dof = 0;
};
Resultant resultant(const Field &load, const Field &motions, const Field &rigid_modes);

} // namespace plm
