// Which form of the contact law (contact/law_form.hpp) the equations in the contact gaps have, and the motion
// of a point's pairs in that form.
#pragma once
#include "contact/law_form.hpp"
#include "hbm/branch_point.hpp"
#include "hbm/options.hpp"
#include "reduction/reduced_model.hpp"

namespace plm {

/// 1 / median static flexibility of the pairs in the open structure; 0 when rigid-body modes leave it without
/// one.
double local_stiffness(const ReducedModel &reduced);

LawForm make_formulation(const ReducedModel &reduced, const HbmOptions &options);

/// The polynomials (Z x (2H + 1)) whose positive part times a stiffness is the contact force of a point: its
/// penetration and k_n, or v and e.
struct ContactMotion {
    Matrix u;
    const vector<double> *stiffness;
};
/// Z x (2H + 1) coefficients of the penetration, the gap included in the first column.
Matrix penetration_of(const ReducedModel &reduced, const BranchPoint &point, std::int64_t n_harmonics);
ContactMotion contact_motion(const ReducedModel &reduced, const BranchPoint &point);

/// The same of all pairs of the model, carried in the equations or not (node sampling): the penetration
/// follows from the recovered field, u = B (P_0 eta_0 + P eta) - g. Where pairs are left out, the motion is
/// the penetration of every pair with its own k_n, in whatever form the point was solved.
Matrix whole_penetration_of(const ReducedModel &reduced, const BranchPoint &point, std::int64_t n_harmonics);
ContactMotion whole_contact_motion(const ReducedModel &reduced, const BranchPoint &point);

} // namespace plm
