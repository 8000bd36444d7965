// What forces on the contact pairs make of the contact gaps in a linear structure, harmonic by harmonic:
// B D(omega) B' - slack, D the receptance of the open structure in the reduced model's coordinates, and of
// its static reference for the mean (static_reference.hpp); slack is that of the law's form (law_form.hpp).
#pragma once
#include "hbm/receptance.hpp"
#include "hbm/static_reference.hpp"

namespace plm {

/// Harmonic coefficients are c - i s. h = 0: real.
class GapResponse {
  public:
    using Complex = std::complex<double>;

    GapResponse(std::shared_ptr<const ReducedModel> reduced, const LawForm &form, std::int64_t n_harmonics);

    void set_frequency(double omega);
    /// From the next set_frequency() on: with the damping -2 xi omega M added.
    void set_self_excitation(double xi);

    StaticReference &mean() { return mean_; }
    const StaticReference &mean() const { return mean_; }
    const Receptance &harmonic(std::int64_t h) const { return harmonic_[h]; } // h >= 1

    /// v (r) = factor B' (c - i s).
    void gather(const double *c, const double *s, double factor, vector<Complex> &v);
    /// out (2 Z: c, then s) = factor B v.
    void write_gaps(const vector<Complex> &v, double factor, double *out);

    /// Of these pairs among themselves.
    void receptance_of(std::int64_t h, const vector<std::int64_t> &pairs, Matrix &real, Matrix &imag);
    /// Takes the answer to the forces c - i s of all pairs in harmonic h from b (Z x (2H + 1)).
    void subtract(std::int64_t h, const vector<double> &c, const vector<double> &s, double *b);

  private:
    std::shared_ptr<const ReducedModel> m_;
    vector<double> slack_;
    StaticReference mean_;
    std::vector<Receptance> harmonic_; // the first is not used
    double omega_ = -1, self_excitation_ = 0;
    // of one call to the next: no iteration allocates
    vector<double> real_, imag_, mean_response_, gaps_;
    vector<Complex> response_;
    Matrix rows_;
};

} // namespace plm
