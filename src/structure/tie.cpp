#include "structure/tie.hpp"
#include <algorithm>

namespace plm {
namespace {

// Shape functions at a node of a face are zero to rounding, and 1 where a node is tied to itself.
constexpr double rounding = 1e-13;

void add_term(DofTerms &terms, const DofTerm &t) {
    const auto same =
        std::find_if(terms.begin(), terms.end(), [&](const DofTerm &u) { return u.dof == t.dof; });
    if (same == terms.end())
        terms.push_back(t);
    else
        same->coefficient += t.coefficient;
}

// q = sum N_i q_i, in one direction.
void add_tie_row(ConstraintRows &rows, std::int64_t dof, const TieSurface &surface, const Projection &on,
                 std::size_t direction) {
    DofTerms terms{{dof, 1}};
    for (std::int64_t p = surface.face_ptr[on.face]; p < surface.face_ptr[on.face + 1]; ++p) {
        const double weight = on.point.weight[static_cast<std::size_t>(p - surface.face_ptr[on.face])];
        add_term(terms, {surface.node[surface.face_node[p]].dof[direction], -weight});
    }
    for (DofTerm &t : terms)
        if (std::abs(t.coefficient) <= rounding) t.coefficient = 0;
    add_row(rows, terms);
}

} // namespace

Tie tie_nodes(const vector<CoupledNode> &dependent, const TieSurface &surface, double tolerance) {
    SurfaceMesh mesh;
    for (const CoupledNode &n : surface.node) mesh.node.push_back(n.at);
    mesh.face_ptr = surface.face_ptr, mesh.face_node = surface.face_node;
    const Surface faces(std::move(mesh));
    Tie t;
    const auto farther = [&](std::int64_t i, std::int64_t than) {
        return than < 0 || t.distance[i] > t.distance[than];
    };
    for (std::int64_t i = 0; i < static_cast<std::int64_t>(dependent.size()); ++i) {
        const Projection on = faces.closest(dependent[i].at);
        t.distance.push_back(on.point.distance);
        if (t.nearest < 0 || farther(t.nearest, i)) t.nearest = i;
        const bool is_tied = on.point.distance <= tolerance;
        std::int64_t &farthest = is_tied ? t.farthest_tied : t.farthest_untied;
        if (farther(i, farthest)) farthest = i;
        t.n_untied += !is_tied;
        for (std::size_t k = 0; is_tied && k < 3; ++k)
            if (dependent[i].dof[k] != no_dof) add_tie_row(t.rows, dependent[i].dof[k], surface, on, k);
    }
    return t;
}

} // namespace plm
