// Private to structure/solver: SCOTCH (Pellegrini and Roman, 1996), as it is carried:
// linalg/carried/scotch_parts.cpp.
#pragma once
#include "structure/solver/node_graph.hpp"
#include <string>

namespace plm {

/// The vertices in an order of few entries in L; empty where SCOTCH fails or the graph is too large for its
/// integers.
vector<std::int64_t> order_by_scotch(const NodeGraph &graph);
std::string scotch_version();

} // namespace plm
