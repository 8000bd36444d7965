#include "structure/tie.hpp"

namespace plm {
namespace {

// q = sum N_i q_i, in one direction.
void add_tie_row(ConstraintRows &rows, std::int64_t dof, const MeshSurface &surface, const Projection &on,
                 std::size_t direction) {
    DofTerms terms{{dof, 1}};
    Point back{};
    back[direction] = -1;
    add_motion(terms, surface, on.face, on.point.weight, back);
    clear_rounding(terms); // 1 - 1 where a node is tied to itself
    add_row(rows, terms);
}

} // namespace

Tie tie_nodes(const vector<CoupledNode> &dependent, const MeshSurface &surface, double tolerance) {
    const Surface faces(places(surface));
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
