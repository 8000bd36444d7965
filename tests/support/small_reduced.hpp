// Small structures as reduced models without any reduction: what the HBM tests compute on and compare
// exactly.
#pragma once
#include "exact_flow.hpp"
#include "reduction/reduced_model.hpp"

namespace test {

/// All modes of the structure; damping C is taken as a full matrix when it is not diagonal in them.
std::shared_ptr<plm::ReducedModel> reduce_exactly(const exact::Structure &s);

/// Displacement coefficients (2H + 1) of a DOF from reduced coordinates.
plm::vector<double> displacement(const plm::ReducedModel &m, const plm::vector<double> &eta_0,
                                 const plm::Matrix &eta, std::int64_t dof);

/// m q'' + c q' + k q + max(kc (q - g), 0) = f cos
exact::Structure bilinear_oscillator(double damping_ratio, double contact_stiffness, double gap, double force,
                                     double preload);
/// n unit masses in a chain of unit springs fixed at the left; pairs of neighbours in `pairs` (mass i against
/// i + 1, or against the ground when i is the last), C = 2 zeta / w1 K.
exact::Structure chain(int n, double damping_ratio, double contact_stiffness, double gap, double force,
                       double preload, const std::vector<int> &pairs);

} // namespace test
