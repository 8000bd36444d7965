// The harmonic-balance equations R(x, omega) = 0. Two forms, exact for the same reduced model: unknown
// reduced coordinates (modal_system.cpp), or unknown contact gaps through the receptances of the open
// structure (gap_system.cpp). Which is cheaper depends on the number of coordinates and of moving pairs.
#pragma once
#include "contact/contact_force.hpp"
#include "linalg/error.hpp"
#include "motions/branch_point.hpp"
#include "paths/residual.hpp"

namespace plm {

struct Border; // motions/periodic_equations.hpp
class ModalFactor;

class HbmSystem : public Residual {
  public:
    /// Factors dR/dx at the last residual() with rows and columns beside it: what systems with more equations
    /// are built from. This and the next: reduced coordinates only.
    virtual void factor_bordered(const Border &, ModalFactor &) { throw_not_modal(); }
    /// r = dR/dx v at the last residual()
    virtual void jacobian_product(const double * /*v*/, double * /*r*/) { throw_not_modal(); }
    /// Adds the force 2 xi omega M q' from the next residual() or linear_response() on: nonlinear modes and,
    /// with xi < 0, first solutions. parameter_derivative() knows of it in reduced coordinates only.
    virtual void set_self_excitation(double xi) = 0;
    /// Solution x of the linear equations with every pair coupled by coupling[i] k_n at all times.
    virtual void linear_response(const vector<double> &coupling, double omega, double *x) = 0;

    /// Motion, frequency, force scale and contact motion of a point; leaves the rest.
    virtual void to_point(const double *x, double omega, BranchPoint &point) = 0;
    virtual void from_point(const BranchPoint &point, double *x) = 0;

    /// Scale of the excitation: options.force_scale in the problem asked for, others on the path from rest.
    virtual void set_force_scale(double scale) = 0;
    /// dR/d(force scale) at the omega of the last residual().
    virtual void force_derivative(double *r) = 0;
    /// Factor on the stiffness of every contact: 1 in the problem asked for, smaller on the path from soft
    /// contact.
    virtual void set_stiffness_factor(double factor) = 0;
    /// Change of R by a change `force` (Z x (2H + 1)) of the contact forces, at the omega of the last
    /// residual().
    virtual void contact_force_change(const Matrix &force, double *r) = 0;
    /// The contact forces of the last residual().
    virtual const Matrix &contact_force() const = 0;
    /// dR/d log(factor) at the last residual().
    void stiffness_derivative(double *r) { contact_force_change(contact_force(), r); }
    /// What a change x of the unknowns is in the contact motion (see ContactMotion): Z x (2H + 1).
    virtual void contact_motion_change(const double *x, Matrix &u) = 0;
    /// Gap added to every pair: 0 in the problem asked for, others on the path from open contact.
    virtual void set_extra_gap(double gap) = 0;
    /// dR/d(extra gap) at the last residual().
    virtual void gap_derivative(double *r) = 0;
    /// parameter_derivative() without what it has by the motion of walls: linear in x but for the loads.
    /// Reduced coordinates only.
    virtual void parameter_derivative_of_structure(double * /*r*/) { throw_not_modal(); }

    virtual const ContactIndicator &indicator() const { return indicator_; }
    std::int64_t piece() const override { return indicator().n_switching; }

  protected:
    [[noreturn]] static void throw_not_modal() {
        throw Error(status::internal, "only equations in reduced coordinates can do this");
    }
    ContactIndicator indicator_;
};

} // namespace plm
