// Tables of nodes and faces as hosts hand them over, read and checked.
#pragma once
#include "capi/sparse_rows.hpp"
#include "structure/mesh_surface.hpp"
#include <algorithm>

namespace plm::capi {

using Int = long long; // for printf

/// Nodes as they are handed over: `per_node` DOFs each, and their coordinates.
template <class Index> struct NodeArrays {
    const char *dof_name, *xyz_name, *per_node_name;
    std::int64_t n;
    std::int32_t per_node;
    const Index *dof;
    const double *xyz;
};

struct NamedDof {
    std::int64_t dof;
    const char *name;
    std::int64_t index;
};

/// Nodes of one coupling, and that no DOF comes twice among them.
template <class Index> class NodeReader {
  public:
    NodeReader(std::int64_t base, std::int64_t n_dof) : base_(base), n_dof_(n_dof) {}

    vector<CoupledNode> take(const NodeArrays<Index> &x, bool may_be_held = false) {
        if (x.per_node != 3 && x.per_node != 6)
            bad_argument(x.per_node_name, -1,
                         format("%s is %d; a node has 3 DOFs (translations), or 6 (and the rotations)",
                                x.per_node_name, x.per_node));
        if (x.n > 0) require_pointer(x.dof, x.dof_name);
        require_finite_array(x.xyz, 3 * x.n, x.xyz_name);
        vector<CoupledNode> nodes(static_cast<std::size_t>(x.n));
        for (std::int64_t i = 0; i < x.n; ++i) {
            CoupledNode &node = nodes[i];
            std::copy(x.xyz + 3 * i, x.xyz + 3 * i + 3, node.at.begin());
            node.dof.fill(no_dof);
            for (std::int32_t k = 0; k < x.per_node; ++k)
                node.dof[static_cast<std::size_t>(k)] = dof(x, x.per_node * i + k);
            if (!may_be_held &&
                std::all_of(node.dof.begin(), node.dof.end(), [](std::int64_t d) { return d == no_dof; }))
                bad_argument(x.dof_name, x.per_node * i,
                             format("node %lld of %s has no DOF at all; leave it out, or check its DOFs",
                                    Int(i), x.dof_name));
        }
        return nodes;
    }

    void refuse_repeated_dofs() {
        std::stable_sort(seen_.begin(), seen_.end(),
                         [](const NamedDof &a, const NamedDof &b) { return a.dof < b.dof; });
        const auto same = std::adjacent_find(
            seen_.begin(), seen_.end(), [](const NamedDof &a, const NamedDof &b) { return a.dof == b.dof; });
        if (same != seen_.end())
            bad_argument(same[1].name, same[1].index,
                         format("%s[%lld] = %lld stands at %s[%lld] already; a DOF belongs to one node of a "
                                "coupling",
                                same[1].name, Int(same[1].index), Int(same->dof + base_), same->name,
                                Int(same->index)));
    }

    bool has_no_dof() const { return seen_.empty(); }

  private:
    std::int64_t dof(const NodeArrays<Index> &x, std::int64_t k) {
        if (x.dof[k] < base_) return no_dof;
        require_dof(x.dof[k], base_, n_dof_, x.dof_name, k);
        seen_.push_back({x.dof[k] - base_, x.dof_name, k});
        return seen_.back().dof;
    }

    std::int64_t base_, n_dof_;
    std::vector<NamedDof> seen_;
};

/// Compressed rows of places in a table of nodes.
template <class Index> struct FaceArrays {
    std::int64_t n;
    const Index *face_ptr, *face_node;
};

/// Behind the nodes of the surface.
template <class Index> void take_faces(MeshSurface &surface, const FaceArrays<Index> &x, std::int64_t base) {
    const auto n_nodes = static_cast<std::int64_t>(surface.node.size());
    check_pointers(x.face_ptr, "face_ptr", x.n, base, "face");
    for (std::int64_t i = 0; i < x.n; ++i) {
        const std::int64_t size = static_cast<std::int64_t>(x.face_ptr[i + 1]) - x.face_ptr[i];
        if (!is_face(size))
            bad_argument(
                "face_ptr", i + 1,
                format("face %lld has %lld nodes (face_ptr[%lld] = %lld, the one before %lld); a face has "
                       "3, 4, 6 or 8",
                       Int(i), Int(size), Int(i + 1), Int(x.face_ptr[i + 1]), Int(x.face_ptr[i])));
        surface.face_ptr.push_back(x.face_ptr[i + 1] - base);
    }
    require_pointer(x.face_node, "face_node");
    for (std::int64_t p = 0; p < surface.face_ptr.back(); ++p) {
        if (x.face_node[p] < base || x.face_node[p] - base >= n_nodes)
            bad_argument("face_node", p,
                         format("face_node[%lld] = %lld is no node of the surface; it must lie in %lld..%lld",
                                Int(p), Int(x.face_node[p]), Int(base), Int(base + n_nodes - 1)));
        surface.face_node.push_back(x.face_node[p] - base);
    }
}

} // namespace plm::capi
