// The exact motion of a point of a curve, where more of it is known than the Fourier coefficients that the
// point carries.
#pragma once
#include "contact/trig_polynomial.hpp"
#include "linalg/memory.hpp"

namespace plm {

class PointMotion {
  public:
    virtual ~PointMotion() = default;
    /// Extrema over a period of the response of a DOF of the full model (base 0; zeros when fixed).
    virtual ValueRange range(std::int64_t dof) const = 0;
    /// The same of row . static coordinates.
    virtual ValueRange range_of(const vector<double> &row) const = 0;
    /// Static coordinates (r_0) at t = fraction x period of the response.
    virtual vector<double> displacement(double fraction) const = 0;
    /// row . static coordinates at n equidistant instants of a period of the response, from its beginning.
    virtual vector<double> history(const vector<double> &row, std::int64_t n) const = 0;
    /// Fourier coefficients of the forces of the pairs in the equations: Z x (2H + 1), a_0, a_1, b_1, ...
    virtual Matrix contact_forces(std::int64_t n_harmonics) const = 0;
    /// Share of the period during which each pair in the equations is closed.
    virtual const vector<double> &closed_shares() const = 0;
};

} // namespace plm
