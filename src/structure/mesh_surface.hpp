// A surface of the mesh: faces, and the nodes that move them.
#pragma once
#include "structure/couplings.hpp"
#include "structure/surface_projection.hpp"

namespace plm {

/// The faces, and the DOFs of their nodes.
struct MeshSurface {
    vector<CoupledNode> node;
    vector<std::int64_t> face_ptr{0}, face_node;
    std::int64_t n_faces() const { return static_cast<std::int64_t>(face_ptr.size()) - 1; }
};
/// Where it is.
SurfaceMesh places(const MeshSurface &surface);

/// Shape functions of a face at a point of it.
using FaceWeights = std::array<double, most_face_nodes>;

/// direction . q of a node, and of the point of a face with these weights, added to the terms of a row.
void add_motion(DofTerms &row, const CoupledNode &node, const Point &direction);
void add_motion(DofTerms &row, const MeshSurface &surface, std::int64_t face, const FaceWeights &weight,
                const Point &direction);
/// What is rounding beside 1, as shape functions at nodes are, becomes zero.
void clear_rounding(DofTerms &row);

} // namespace plm
