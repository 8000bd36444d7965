// Elimination of the pairs whose tangent is constant from one harmonic of the contact equations u + G y = b,
// where y = kappa u for an eliminated pair and y is kept for a moving one. Exact: a tangent constant in time
// does not couple harmonics.
#pragma once
#include "linalg/lapack.hpp"
#include <complex>

namespace plm {

class PairElimination {
  public:
    using Complex = std::complex<double>;

    /// real + i imag: receptance G of the n_moving moving pairs, then of the eliminated ones, in this order.
    void build(const Matrix &real, const Matrix &imag, std::int64_t n_moving, const vector<double> &kappa);

    /// Receptance of the moving pairs with the eliminated ones in place, n_moving x n_moving.
    const Matrix &real() const { return real_; }
    const Matrix &imag() const { return imag_; }

    /// held: right-hand sides of the eliminated pairs, overwritten by (I + G_EE kappa)^-1 b_E; what follows
    /// for the moving pairs is added to `moving`.
    void condense(vector<Complex> &held, Complex *moving) const;
    /// held (from condense) becomes the displacement of the eliminated pairs under the forces y of the moving
    /// ones.
    void expand(const vector<Complex> &y, vector<Complex> &held) const;

  private:
    std::int64_t n_moving_ = 0, n_eliminated_ = 0;
    ComplexLu constant_;              // I + G_EE kappa
    vector<Complex> to_eliminated_;   // G_ES, eliminated x moving
    vector<Complex> from_eliminated_; // G_SE kappa, moving x eliminated
    Matrix real_, imag_;
};

} // namespace plm
