// Gap rows between surfaces whose meshes need not match: points of the one, the slave, against the faces of
// the other, the master.
#pragma once
#include "structure/mesh_surface.hpp"

namespace plm {

struct SurfaceContactChoice {
    double search = 0;         // a length: points farther from all faces have no partner
    bool at_points = false;    // pairs at the points that integrate over the slave's faces, not at its nodes
    bool is_smooth = false;    // normals and gaps of surfaces smooth across their edges, not of their faces
    bool is_two_sided = false; // the master has no inside: each point stands on the side that it is on
};

/// Of a node, or of a point of a face: a partner on the master, or none.
struct SurfacePair {
    // face: too far or beside; looking the same way; nothing there moves
    static constexpr std::int64_t none = -1, opposed = -2, held = -3;
    std::int64_t face = none;
    std::int64_t point =
        0;           // the node, or the number of the point; nodes without faces are none where there are any
    double area = 0; // that the point stands for; 0 where the slave has no faces
    double distance = 0; // from the closest point of the master
    double gap = 0;      // along the normal, < 0: interference
    Point normal{};      // from the slave into the master
    DofTerms row;        // of its penetration: normal . (q - sum N_i q_i)
    bool has_partner() const { return face >= 0; }
};

/// One for each node on its faces (for each, where it has none), or each point, of the slave. A row is zero
/// along every rigid motion of both, whatever the gap: what is not along the normal between the point and its
/// projection is taken off the weights.
std::vector<SurfacePair> surface_contact(const MeshSurface &slave, const MeshSurface &master,
                                         const SurfaceContactChoice &choice);

} // namespace plm
