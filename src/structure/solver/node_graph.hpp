// The graph of a symmetric matrix's nodes: rows of one pattern, such as the DOFs of one node of a
// finite-element mesh, are one vertex.
#pragma once
#include "structure/sparse.hpp"

namespace plm {

/// Vertices of a symmetric matrix's graph, without loops.
struct NodeGraph {
    vector<std::int64_t> first_neighbour, neighbour; // compressed rows, vertices + 1 and edges, each twice
    vector<std::int64_t> first_row, row;             // the rows of the matrix in each vertex
    std::int64_t size() const { return static_cast<std::int64_t>(first_row.size()) - 1; }
};
NodeGraph node_graph(const SparseMatrix &a);

} // namespace plm
