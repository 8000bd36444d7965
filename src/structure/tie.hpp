// Nodes tied to the faces of a surface that does not match them.
#pragma once
#include "structure/mesh_surface.hpp"

namespace plm {

struct Tie {
    ConstraintRows rows;
    vector<double> distance; // of every node from the surface
    std::int64_t n_untied = 0;
    /// Of the nodes that are tied, of those that are not, and of all: -1 where there is none.
    std::int64_t farthest_tied = -1, farthest_untied = -1, nearest = -1;
};

/// Every node within the tolerance moves, in translation, as the point of the surface that is closest to it.
Tie tie_nodes(const vector<CoupledNode> &dependent, const MeshSurface &surface, double tolerance);

} // namespace plm
