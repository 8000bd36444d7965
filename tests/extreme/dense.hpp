// Closed forms of linear answers by a dense complex solve, independent of the library.
#pragma once
#include "support/exact_flow.hpp"
#include <complex>
#include <vector>

namespace extreme {

using Complex = std::complex<double>;

/// x of A x = b, A row-major, Gauss with partial pivoting.
std::vector<Complex> solve_dense(std::vector<Complex> a, std::vector<Complex> b);

/// Of a (n x n, row-major) by elimination with partial pivoting.
double determinant(std::vector<double> a, int n);

/// Peak of |q| of one DOF when every pair stays as `closed` says: static answer plus the amplitude of
/// harmonic 1.
double linear_peak(const exact::Structure &s, const std::vector<bool> &closed, double omega, int dof,
                   const std::vector<double> *full_mass = nullptr);

} // namespace extreme
