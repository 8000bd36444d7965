// Nodes tied to faces that do not match them.
#include "structure/dof_map.hpp"
#include "structure/tie.hpp"
#include "support/test.hpp"

using plm::CoupledNode;
using plm::MeshSurface;
using plm::Point;
using plm::Tie;
using Nodes = plm::vector<CoupledNode>;

namespace {

CoupledNode node(std::int64_t i, const Point &at) {
    return {{3 * i, 3 * i + 1, 3 * i + 2, plm::no_dof, plm::no_dof, plm::no_dof}, at};
}

double height(double x, double y) {
    return 0.1 * x * x - 0.05 * y * y + 0.02 * x * y;
}

// 8-node faces, n x n over a square of n x n, bent: nodes 0, 1, ... as they come, shared by the faces.
MeshSurface bent(int n) {
    MeshSurface s;
    plm::vector<std::int64_t> at((2 * n + 1) * (2 * n + 1), -1);
    const auto number = [&](int i, int j) {
        std::int64_t &k = at[i * (2 * n + 1) + j];
        if (k < 0) {
            k = static_cast<std::int64_t>(s.node.size());
            const double x = i / 2.0, y = j / 2.0;
            s.node.push_back(node(k, {x, y, height(x, y)}));
        }
        return k;
    };
    for (int i = 0; i < 2 * n; i += 2)
        for (int j = 0; j < 2 * n; j += 2) {
            for (const auto &c :
                 {std::pair<int, int>{0, 0}, {2, 0}, {2, 2}, {0, 2}, {1, 0}, {2, 1}, {1, 2}, {0, 1}})
                s.face_node.push_back(number(i + c.first, j + c.second));
            s.face_ptr.push_back(static_cast<std::int64_t>(s.face_node.size()));
        }
    return s;
}

Point bend(const Point &x) { // a field that the faces hold exactly: quadratic in x and y
    return {1 + x[0] - 2 * x[1] + x[0] * x[1], 0.5 * x[0] * x[0] - x[1], 3 + x[1] * x[1]};
}

// Of nodes on the faces the motion is the field that the nodes of the faces have.
void nodes_on_faces_move_with_them(void **) {
    const MeshSurface surface = bent(4);
    const auto first = static_cast<std::int64_t>(surface.node.size());
    Nodes nodes;
    for (int i = 0; i < 7; ++i)
        for (int j = 0; j < 7; ++j) {
            const double x = 4 * i / 6.0, y = 4 * j / 6.0;
            nodes.push_back(node(first + 7 * i + j, {x, y, height(x, y)}));
        }
    const Tie t = tie_nodes(nodes, surface, 1e-6);
    assert_int_equal(t.n_untied, 0);
    assert_int_equal(t.farthest_untied, -1);
    const std::int64_t n = 3 * (first + 49);
    const plm::DofMap map(n, {}, t.rows);
    assert_int_equal(map.n_free(), 3 * first);
    plm::vector<double> q(n, 0.0);
    for (const CoupledNode &s : surface.node)
        for (std::size_t k = 0; k < 3; ++k) q[s.dof[k]] = bend(s.at)[k];
    const plm::vector<double> free = map.free_part(q.data());
    map.expand(free.data(), q.data());
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        assert_true(t.distance[static_cast<std::int64_t>(i)] < 1e-13);
        for (std::size_t k = 0; k < 3; ++k)
            assert_true(near(q[nodes[i].dof[k]], bend(nodes[i].at)[k], 1e-12));
    }
}

// On a node a node follows that one alone; one of the faces themselves, not at all.
void nodes_on_nodes(void **) {
    const MeshSurface surface = bent(2);
    const auto first = static_cast<std::int64_t>(surface.node.size());
    const Tie t = tie_nodes({node(first, surface.node[5].at), surface.node[7]}, surface, 1e-6);
    assert_int_equal(t.n_untied, 0);
    assert_int_equal(t.rows.n_rows(), 3);
    for (std::int64_t k = 0; k < 3; ++k) {
        assert_int_equal(t.rows.ptr[k + 1] - t.rows.ptr[k], 2);
        assert_int_equal(t.rows.dof[2 * k] + t.rows.dof[2 * k + 1], 3 * first + k + 15 + k);
    }
}

// Beyond the tolerance they stay free, and are told.
void what_stays_untied(void **) {
    MeshSurface surface = bent(2);
    surface.node[0].dof.fill(plm::no_dof); // held where it is
    CoupledNode partly = node(100, {1, 1, height(1, 1) + 0.3});
    partly.dof[1] = plm::no_dof;
    const Tie t = tie_nodes(
        {node(101, {0.1, 0.1, 2}), partly, node(102, {-3, 0, 0}), node(103, {0, 0, -0.2})}, surface, 0.5);
    assert_int_equal(t.n_untied, 2);
    assert_int_equal(t.farthest_untied, 2);
    assert_int_equal(t.farthest_tied, 1);
    assert_int_equal(t.nearest, 3);
    assert_true(near(t.distance[2], 3, 1e-12));
    assert_int_equal(t.rows.n_rows(), 2 + 3);
    const std::int64_t last = t.rows.n_rows() - 1; // over the held node, on the faces' outer corner
    assert_int_equal(t.rows.dof[t.rows.ptr[last]], 3 * 103 + 2);
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(nodes_on_faces_move_with_them),
        cmocka_unit_test(nodes_on_nodes),
        cmocka_unit_test(what_stays_untied),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
