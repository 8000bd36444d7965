// From collected, possibly repeated modes to well-conditioned reduced coordinates (paper, 2.3.3).
#pragma once
#include "model/space.hpp"

namespace plm {

/// Coordinates Y in a space with Y^T Y = I (so m = P^T M P = I for P = V Y) and Y^T diag(lambda) Y diagonal.
struct Coordinates {
    Matrix y;              // space size x r
    vector<double> lambda; // r, ascending, >= 0
};

/// Rotates orthonormal columns so that the stiffness is diagonal.
Coordinates diagonalise_stiffness(const Space &space, const Matrix &orthonormal);

struct Conditioned {
    Coordinates coordinates;
    vector<double> singular_values; // of the columns in the M-inner product, scaled by the largest
};
/// SVD of mass-normalised columns; directions whose scaled singular value is not above `tolerance` are
/// dropped.
Conditioned condition_columns(const Space &space, const Matrix &columns, double tolerance);

} // namespace plm
