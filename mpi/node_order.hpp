// An order of elimination of few entries, found by SCOTCH on the graph of nodes: rows of one pattern on one
// rank, such as the DOFs of one node of a finite-element mesh, are one vertex of it.
#pragma once
#include "mpi/matrices.hpp"
#include <mumps_c_types.h>

namespace plm::mpi {

/// On the brain; elsewhere empty, and there, too, where SCOTCH was left out of the build or could not serve:
/// then the order is MUMPS's affair. Numbers are those of MUMPS, which count from 1.
struct NodeOrder {
    std::vector<MUMPS_INT> position; // of each DOF
    std::vector<MUMPS_INT> first,
        dofs; // those of each node: DOFs dofs[first[v] - 1] and on, before first[v + 1]
};

/// Entries that a factorization has beside those of the matrices: lower triangle, base 0, on the brain.
struct AddedEntries {
    const std::int64_t *row, *column;
    std::int64_t count;
};

/// Collective, throws on all ranks alike.
NodeOrder order_of_nodes(Team &team, const Rows &rows, const Matrices &matrices, const AddedEntries &added);

} // namespace plm::mpi
