// From collected, possibly repeated modes to well-conditioned reduced coordinates (paper, 2.3.3).
#pragma once
#include "space/space.hpp"

namespace plm {

/// Coordinates Y in a space, P = V Y, with diagonal m = P^T M P and k = P^T K P.
struct Coordinates {
    Matrix y;                    // space size x r
    vector<double> lambda;       // r, >= 0, ascending but for the last ones
    std::int64_t n_massless = 0; // without mass; m = 1 for all others
};

/// The same span in coordinates that diagonalise both. columns: independent, of comparable size.
Coordinates diagonalise(const Space &space, const Matrix &columns);

/// Of vectors V Y (Y: space size x k) in a basis that holds them: as coordinates_of(), in small matrices.
Matrix coordinates_among(const Space &space, const Matrix &y, const Coordinates &basis);

/// An orthonormal basis of the columns, rigid-body motion by itself: mixed with others, it would have the
/// stiffness of what is dropped, and a free body an equilibrium far away. Directions whose singular value is
/// not above `least` are dropped.
Matrix rigid_apart(const Space &space, const Matrix &columns, double least);

struct Conditioned {
    Coordinates coordinates;
    vector<double> singular_values; // of the columns in the M-inner product, scaled by the largest
};
/// SVD of mass-normalised columns, in which coordinates without mass count by their stiffness; directions
/// whose scaled singular value is not above `tolerance` are dropped. Rigid-body motion stands by itself.
Conditioned condition_columns(const Space &space, const Matrix &columns, double tolerance);

} // namespace plm
