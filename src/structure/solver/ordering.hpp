// Orders of elimination by nested dissection, found on the graph of nodes: rows of one pattern, such as the
// DOFs of one node of a finite-element mesh, are one vertex of their number's weight.
#pragma once
#include "structure/sparse.hpp"
#include <string>

namespace plm {

/// Vertices of a symmetric matrix's graph, without loops.
struct NodeGraph {
    vector<std::int64_t> first_neighbour, neighbour; // compressed rows, vertices + 1 and edges, each twice
    vector<std::int64_t> first_row, row;             // the rows of the matrix in each vertex
    std::int64_t size() const { return static_cast<std::int64_t>(first_row.size()) - 1; }
};
NodeGraph node_graph(const SparseMatrix &a);

/// The row of `a` (both triangles stored) for each one in the new order; empty where SCOTCH was left out of
/// the build, or could not serve. Deterministic.
vector<std::int64_t> nested_dissection(const SparseMatrix &a);

/// " with SCOTCH 7.0.3", or nothing.
std::string ordering_backend();

/// Orders found for patterns met before: the matrices K, K + sigma M and K - w^2 M share one or two.
class KeptOrders {
  public:
    /// Null: not met.
    const vector<std::int64_t> *find(const SparseMatrix &a) const;
    void keep(const SparseMatrix &a, const std::int64_t *order);

  private:
    struct Kept {
        std::uint64_t pattern;
        vector<std::int64_t> order;
    };
    vector<Kept> kept_;
};

} // namespace plm
