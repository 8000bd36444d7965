// What has no mass, or so little that it follows statically. A direction without mass has no frequency: given
// one by a small mass or a large eigenvalue it would bury the modes that matter under its rounding, and make
// every motion in time a stiff one. It is kept as a coordinate with a stiffness, its damping and mass 0,
// which is what static condensation makes of it.
#pragma once
#include "structure/structure.hpp"
#include <functional>

namespace plm {

/// A direction follows statically when its inertia is below this share of its stiffness at the highest
/// frequency of interest: a thousand times slower than its own frequency.
constexpr double negligible_inertia = 1e-6;

/// Coordinates in which M and K are diagonal.
struct RitzVectors {
    vector<double> lambda; // those with mass ascending, >= 0; then those without: reach^2 each
    Matrix vectors;        // combinations of the basis: mass 1, or mass 0 and stiffness reach^2
    std::int64_t n_massless = 0;
};

/// From a (K + sigma M)-orthonormal basis, described by the eigenpairs (mu, y) of M in it, mu ascending.
/// Compliances, 1 / (lambda + sigma), are exact where frequencies are lost: for the slow ones to eps of
/// themselves, and 0 for no mass at all. reach (rad/s): of the highest frequency of interest; 0: all have
/// mass.
RitzVectors ritz_vectors(const vector<double> &mu, const Matrix &y, double sigma, double reach);

/// Of motions in a basis with M = diag(1, ..., 0), K = diag(lambda): by their momentum where there is mass,
/// by their elastic forces where there is none.
/// works: V^T F for forces F.
Matrix coordinates_of(const Structure &structure, const Field &motions,
                      const std::function<Matrix(const Field &)> &works, const vector<double> &lambda,
                      std::int64_t n_massless);

/// A Euclidean orthonormal basis of the span of independent columns; the columns themselves when the last
/// n_massless of the rows of their space are none, since then mass-orthonormal ones are that already.
Matrix orthonormal_span(const Matrix &columns, std::int64_t n_massless);

} // namespace plm
