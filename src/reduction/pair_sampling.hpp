// Node sampling of the contact surface (Saito, Epureanu, Castanier & Pierre 2010, "Node sampling for
// nonlinear vibration analysis of structures with intermittent contact"): the reduced model has contact
// equations at some of the pairs only, chosen before any response is known.
#pragma once
#include "reduction/basis_options.hpp"
#include "reduction/reduced_model.hpp"

namespace plm {

/// Effective independence (Kammer 1991), from all pairs down to n. motions: Z x r, the pairs' motion in
/// coordinates of equal energy. The target is the span of its t = min(n, rank) leading left singular vectors
/// T (singular values above 1e-6 of the largest count); at each step the pair with the least E_i = t_i (T^T
/// T)^-1 t_i^T, its contribution to the rank of what is left, goes, the last one of equals. Ascending
/// indices.
vector<std::int64_t> pairs_by_effective_independence(const Matrix &motions, std::int64_t n);

/// Master degrees of freedom (Henshell & Ong 1975), from all pairs down to n: the pair with the largest ratio
/// of stiffness to mass follows the others statically and goes, the last one of equals; Guyan's reduction to
/// the rest gives the next ratios. flexibility F = B K^-1 B^T + diag(1 / k_n) and inertia D = B K^-1 M K^-1
/// B^T (Z x Z) stand for the structure as its pairs see it: stiffness F_SS^-1 and mass F_SS^-1 D_SS F_SS^-1
/// on any set S of pairs, Guyan's reduction being the choice of rows of F and D. Ascending indices.
vector<std::int64_t> pairs_by_master_dof(const Matrix &flexibility, const Matrix &inertia, std::int64_t n);

/// The model with n of its pairs carried, chosen by the rule; the same model when n is the number of pairs.
/// omega (rad/s) weighs kinetic against elastic energy. Every pair left out gives its contact stiffness to
/// the carried pair whose row of motions (B P in coordinates of equal energy) lies nearest to its own, the
/// first of equals: the sum of k_n is unchanged, and where pairs left out move as the carried one they joined
/// the contact forces, those under pre-load too, are unchanged. This lumping is the library's own, and what
/// is chosen is pairs by their relative motion, not nodes. Pairs with another initial gap than that of their
/// carried pair are taken to have the latter's. PLM_ERR_ARGUMENT when n exceeds the number of pairs.
std::shared_ptr<const ReducedModel> sample_pairs(const std::shared_ptr<const ReducedModel> &reduced,
                                                 const Space &space, PairRule rule, std::int64_t n,
                                                 double omega);

} // namespace plm
