// Couplings of nodes as rows of constraints, from coordinates. Rotations are small.
#pragma once
#include "structure/constraints.hpp"
#include "structure/point.hpp"

namespace plm {

/// DOFs: three translations and the rotations about the same axes; no_dof: it does not move that way.
constexpr std::int64_t no_dof = -1;
struct CoupledNode {
    std::array<std::int64_t, 6> dof;
    Point at;
};

/// The dependent nodes move with the reference node as one rigid body.
ConstraintRows rigid_link(const CoupledNode &reference, const vector<CoupledNode> &dependent);

/// The reference node moves as the rigid body that fits the translations of the nodes best, by least squares
/// with these weights. PLM_ERR_ARGUMENT where they do not tell a rotation that one of its DOFs needs.
ConstraintRows distributing_coupling(const CoupledNode &reference, const vector<CoupledNode> &nodes,
                                     const vector<double> &weight);

/// A row with these terms behind the others; nothing where no DOF is in it.
void add_row(ConstraintRows &rows, const DofTerms &terms);
/// All or nothing.
void append(ConstraintRows &to, const ConstraintRows &rows);

} // namespace plm
