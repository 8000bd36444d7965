// Constraint rows over very many DOFs by way of sums over groups of these: what stands at a DOF that such a
// row gives would couple all of them, and by way of the sums it couples few.
#pragma once
#include "structure/constraints.hpp"

namespace plm {

/// The same constraints with further DOFs, the sums, numbered on from n_dof: the last rows say what they are
/// of DOFs and sums before them, one for each, with itself (-1) as the last term.
struct GroupedRows {
    ConstraintRows rows;
    vector<std::int64_t> given;  // of each row: the one it comes from
    vector<std::int64_t> within; // of each sum: one of the n_dof DOFs that it is taken over, to tell it by
};

GroupedRows in_groups(const ConstraintRows &rows, std::int64_t n_dof);

} // namespace plm
