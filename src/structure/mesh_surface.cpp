#include "structure/mesh_surface.hpp"
#include <algorithm>

namespace plm {
namespace {

void add_term(DofTerms &row, const DofTerm &t) {
    const auto same = std::find_if(row.begin(), row.end(), [&](const DofTerm &u) { return u.dof == t.dof; });
    if (same == row.end())
        row.push_back(t);
    else
        same->coefficient += t.coefficient;
}

} // namespace

SurfaceMesh places(const MeshSurface &surface) {
    SurfaceMesh mesh;
    for (const CoupledNode &n : surface.node) mesh.node.push_back(n.at);
    mesh.face_ptr = surface.face_ptr, mesh.face_node = surface.face_node;
    return mesh;
}

void add_motion(DofTerms &row, const CoupledNode &node, const Point &direction) {
    for (std::size_t k = 0; k < 3; ++k)
        if (direction[k] != 0 && node.dof[k] != no_dof) add_term(row, {node.dof[k], direction[k]});
}

void add_motion(DofTerms &row, const MeshSurface &surface, std::int64_t face, const FaceWeights &weight,
                const Point &direction) {
    for (std::int64_t p = surface.face_ptr[face]; p < surface.face_ptr[face + 1]; ++p) {
        const double w = weight[static_cast<std::size_t>(p - surface.face_ptr[face])];
        add_motion(row, surface.node[surface.face_node[p]],
                   {w * direction[0], w * direction[1], w * direction[2]});
    }
}

void clear_rounding(DofTerms &row) {
    constexpr double rounding = 1e-13;
    for (DofTerm &t : row)
        if (std::abs(t.coefficient) <= rounding) t.coefficient = 0;
}

} // namespace plm
