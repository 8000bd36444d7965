// Orders of elimination by nested dissection, found on the graph of nodes (node_graph.hpp).
#pragma once
#include "structure/sparse.hpp"
#include <mutex>
#include <string>

namespace plm {

/// The row of `a` (both triangles stored) for each one in the new order; empty where SCOTCH was left out of
/// the build, or could not serve. Deterministic.
vector<std::int64_t> nested_dissection(const SparseMatrix &a);

/// " with SCOTCH 7.0.3", or nothing.
std::string ordering_backend();

/// Orders found for patterns met before: the matrices K, K + sigma M and K - w^2 M share one or two. Threads
/// may share it.
class KeptOrders {
  public:
    /// Empty: not met.
    vector<std::int64_t> find(const SparseMatrix &a) const;
    void keep(const SparseMatrix &a, const std::int64_t *order);

  private:
    struct Kept {
        std::uint64_t pattern;
        vector<std::int64_t> order;
    };
    mutable std::mutex mutex_;
    vector<Kept> kept_;
};

} // namespace plm
