// The motion of a point's pairs.
#pragma once
#include "motions/branch_point.hpp"
#include "reduction/reduced_model.hpp"

namespace plm {

/// The polynomials (Z x (2H + 1)) whose positive part times a stiffness is the contact force of a point: its
/// penetration and k_n, or v and e.
struct ContactMotion {
    Matrix u;
    const vector<double> *stiffness;
};
/// Z x (2H + 1) coefficients of the penetration, the gap and its motion taken off.
Matrix penetration_of(const ReducedModel &reduced, const BranchPoint &point, std::int64_t n_harmonics);
ContactMotion contact_motion(const ReducedModel &reduced, const BranchPoint &point);

/// The same of all pairs of the model, carried in the equations or not (node sampling): the penetration
/// follows from the recovered field, u = B (P_0 eta_0 + P eta) - g. Where pairs are left out, the motion is
/// the penetration of every pair with its own k_n, in whatever form the point was solved.
Matrix whole_penetration_of(const ReducedModel &reduced, const BranchPoint &point, std::int64_t n_harmonics);
ContactMotion whole_contact_motion(const ReducedModel &reduced, const BranchPoint &point);

} // namespace plm
