// Dynamic receptance D(omega) of one harmonic of the open reduced structure: (k - (h w)^2 m + i h w c)^-1.
#pragma once
#include "linalg/lapack.hpp"
#include "reduction/reduced_model.hpp"

namespace plm {

/// Diagonal in the reduced coordinates, or a dense factorization when the damping is not diagonal.
class Receptance {
  public:
    /// h >= 1; self_excitation xi: with the damping -2 xi omega M added (not in derivative()).
    void update(const ReducedModel &m, std::int64_t h, double omega, double self_excitation = 0);
    /// v = D v
    void apply(std::complex<double> *v) const;
    /// out = d(D^-1)/d omega v
    void derivative(const std::complex<double> *v, std::complex<double> *out) const;
    /// Real and imaginary part of rows D rows'; rows is n x r.
    void contact_receptance(const Matrix &rows, Matrix &real, Matrix &imag);

  private:
    const ReducedModel *model_ = nullptr;
    double harmonic_ = 0;
    vector<std::complex<double>> diagonal_, derivative_;
    ComplexLu lu_;
    vector<std::complex<double>> full_, solved_; // no iteration allocates
    Matrix scaled_real_, scaled_imag_;
};

} // namespace plm
