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
    const Matrix &real() const { return moving_.real; }
    const Matrix &imag() const { return moving_.imag; }

    /// held: right-hand sides of the eliminated pairs, overwritten by (I + G_EE kappa)^-1 b_E; what follows
    /// for the moving pairs is added to `moving`.
    void condense(vector<Complex> &held, Complex *moving);
    /// held (from condense) becomes the displacement of the eliminated pairs under the forces y of the moving
    /// ones.
    void expand(const vector<Complex> &y, vector<Complex> &held);

  private:
    // Products of complex matrices in parts are those of real ones, which are fast.
    struct Parts {
        Matrix real, imag;
        void reset(std::int64_t rows, std::int64_t cols) {
            real.reset(rows, cols);
            imag.reset(rows, cols);
        }
        void set(std::int64_t i, std::int64_t j, Complex value) {
            real(i, j) = value.real();
            imag(i, j) = value.imag();
        }
    };
    void subtract_product(const Parts &a, const Complex *v, Complex *out);

    std::int64_t n_moving_ = 0, n_eliminated_ = 0;
    ComplexLu constant_; // I + G_EE kappa
    Parts moving_;
    Parts response_; // (I + G_EE kappa)^-1 G_ES, eliminated x moving
    Parts forces_;   // G_SE kappa, moving x eliminated
    vector<Complex> matrix_, solved_;
    Matrix in_, out_; // complex vectors as two columns
};

} // namespace plm
