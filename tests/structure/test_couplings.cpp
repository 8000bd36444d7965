// Couplings from coordinates: what they say is true of rigid motions, and of all others what they are
// defined by.
#include "linalg/lapack.hpp"
#include "linalg/support.hpp"
#include "structure/couplings.hpp"
#include "structure/dof_map.hpp"
#include "support/caught.hpp"
#include "support/test.hpp"

using plm::ConstraintRows;
using plm::CoupledNode;
using plm::cross;
using plm::difference;
using plm::Point;
using Motion = plm::vector<double>;
using Nodes = plm::vector<CoupledNode>;

namespace {

// Node i has DOFs 6 i to 6 i + 5.
CoupledNode node(std::int64_t i, Point at, int n_dofs = 6) {
    CoupledNode n;
    for (int k = 0; k < 6; ++k) n.dof[static_cast<std::size_t>(k)] = k < n_dofs ? 6 * i + k : plm::no_dof;
    n.at = at;
    return n;
}

Nodes scattered(std::int64_t n, double unit, std::uint64_t seed, int n_dofs) {
    test::Random random(seed);
    Nodes nodes;
    for (std::int64_t i = 1; i <= n; ++i) {
        const double x = random(), y = random(), z = random();
        nodes.push_back(node(i, {unit * (20 + x), unit * (y - 7), unit * 0.3 * z}, n_dofs));
    }
    return nodes;
}

double value_of(const ConstraintRows &rows, std::int64_t i, const Motion &q) {
    double sum = 0;
    for (std::int64_t p = rows.ptr[i]; p < rows.ptr[i + 1]; ++p) sum += rows.coefficient[p] * q[rows.dof[p]];
    return sum;
}

double largest_value(const ConstraintRows &rows, const Motion &q) {
    double most = 0;
    for (std::int64_t i = 0; i < rows.n_rows(); ++i) most = std::max(most, std::abs(value_of(rows, i, q)));
    return most;
}

Motion random_motion(std::int64_t n_nodes, std::uint64_t seed) {
    test::Random random(seed);
    Motion q(6 * n_nodes);
    for (double &x : q) x = random();
    return q;
}

// All nodes move by t, and turn by w about the origin.
void move_rigidly(Motion &q, const CoupledNode &n, const Point &t, const Point &w) {
    const Point turn = cross(w, n.at);
    for (std::size_t k = 0; k < 3; ++k) {
        if (n.dof[k] != plm::no_dof) q[n.dof[k]] = t[k] + turn[k];
        if (n.dof[3 + k] != plm::no_dof) q[n.dof[3 + k]] = w[k];
    }
}

void both_are_true_of_rigid_motions(void **) {
    for (const double unit : {1.0, 1e3}) // m, mm
        for (std::uint64_t seed = 1; seed <= 10; ++seed) {
            const CoupledNode reference = node(0, {unit * 20.5, unit * -6, unit * 4});
            const Nodes all = scattered(7, unit, seed, 6), moved = scattered(7, unit, seed, 3);
            plm::vector<double> weight;
            for (std::size_t i = 0; i < all.size(); ++i) weight.push_back(1.0 + double(i));
            const Point t{unit, -2 * unit, 0.5 * unit}, w{0.3, 0.9, -0.4};
            Motion q(48, 0.0);
            move_rigidly(q, reference, t, w);
            for (const CoupledNode &n : all) move_rigidly(q, n, t, w);
            const ConstraintRows link = rigid_link(reference, all),
                                 mean = distributing_coupling(reference, moved, weight);
            assert_int_equal(link.n_rows(), 42);
            assert_int_equal(mean.n_rows(), 6);
            assert_true(below(largest_value(link, q), 1e-13 * 20 * unit));
            assert_true(below(largest_value(mean, q), 1e-13 * 20 * unit));
        }
}

// Weighted least squares, of all six unknowns at once.
void the_reference_moves_as_least_squares_say(void **) {
    for (const double unit : {1.0, 1e3})
        for (std::uint64_t seed = 1; seed <= 10; ++seed) {
            const CoupledNode reference = node(0, {unit * 20.5, unit * -6, unit * 4});
            const Nodes nodes = scattered(7, unit, seed, 3);
            test::Random random(seed + 100);
            plm::vector<double> weight;
            for (std::size_t i = 0; i < nodes.size(); ++i) weight.push_back(1.1 + random());
            Motion q = random_motion(8, seed);
            plm::Matrix a(21, 6), b(21, 1);
            for (std::size_t i = 0; i < nodes.size(); ++i)
                for (int k = 0; k < 3; ++k) {
                    const double root = std::sqrt(weight[i]);
                    const auto row = static_cast<std::int64_t>(3 * i) + k;
                    const Point r = difference(nodes[i].at, reference.at);
                    a(row, k) = root;
                    a(row, 3 + (k + 1) % 3) = root * r[(k + 2) % 3] / unit; // rotations times the unit
                    a(row, 3 + (k + 2) % 3) = -root * r[(k + 1) % 3] / unit;
                    b(row, 0) = root * q[nodes[i].dof[k]];
                }
            const plm::Matrix fit = plm::least_squares(a, b);
            for (int k = 0; k < 6; ++k) q[k] = fit(k, 0) / (k < 3 ? 1 : unit);
            const ConstraintRows rows = distributing_coupling(reference, nodes, weight);
            for (std::int64_t i = 0; i < 6; ++i) {
                assert_true(below(std::abs(value_of(rows, i, q)) * (i < 3 ? 1 : unit), 1e-12 * 20));
            }
        }
}

// What leaves a rotation open is refused where a DOF needs it, and nowhere else.
void rotations_that_nodes_do_not_tell(void **) {
    const Nodes line{node(1, {0, 0, 0}, 3), node(2, {1000, 0, 1e-4}, 3), node(3, {300, 0, 0}, 3)},
        point{line[0]};
    const plm::vector<double> three(3, 1.0), one(1, 1.0);
    const auto status = [](const CoupledNode &reference, const Nodes &nodes, const plm::vector<double> &w,
                           const char *words) {
        const Caught c = caught([&] { distributing_coupling(reference, nodes, w); });
        return c.status == plm::status::argument && c.argument == "xyz" && c.says(words);
    };
    assert_true(status(node(0, {500, 0, 0}), line, three, "on a line, along ("));
    assert_true(status(node(0, {500, 0, 0}), line, three, "3 DOFs"));
    assert_true(status(node(0, {500, 20, 0}, 3), line, three, "20 beside them"));
    assert_true(status(node(0, {0, 0, 0}), point, one, "at one point"));
    assert_true(status(node(0, {5, 0, 0}, 3), point, one, "at one point"));

    const ConstraintRows on = distributing_coupling(node(0, {500, 0, 0}, 3), line, three),
                         at = distributing_coupling(node(0, {0, 0, 0}, 3), point, one);
    assert_int_equal(on.n_rows(), 3);
    Motion q(24, 0.0); // the line turns about its end
    for (const CoupledNode &n : line) move_rigidly(q, n, {1, 2, 3}, {0, 0.2, -0.1});
    move_rigidly(q, node(0, {500, 0, 0}, 3), {1, 2, 3}, {0, 0.2, -0.1});
    assert_true(below(largest_value(on, q), 1e-3)); // of 1e-4 beside the line, times a rotation of 0.2
    assert_int_equal(at.n_rows(), 3);
    assert_int_equal(at.ptr.back(), 6); // each the DOF of the node itself

    CoupledNode without = node(0, {500, 0, 0}); // of all rotations but that about the line
    without.dof[3] = plm::no_dof;
    assert_int_equal(distributing_coupling(without, line, three).n_rows(), 5);
}

// A node of the reference without rotations does not turn; what is missing at a dependent node is left out.
void links_of_nodes_with_fewer_dofs(void **) {
    CoupledNode flat = node(2, {5, 6, 7});
    flat.dof = {12, plm::no_dof, 14, 15, plm::no_dof, plm::no_dof};
    const ConstraintRows rows = rigid_link(node(0, {0, 0, 0}, 3), {node(1, {1, 2, 3}, 3), flat});
    assert_int_equal(rows.n_rows(), 6);
    Motion q(18, 0.0);
    q[0] = 1, q[1] = 2, q[2] = 3, q[6] = 1, q[7] = 2, q[8] = 3, q[12] = 1, q[14] = 3;
    assert_true(largest_value(rows, q) == 0);
    q[15] = 1; // it turns, which the reference does not
    assert_true(value_of(rows, 5, q) == 1);
}

// Links on links on the mean of nodes: everything follows rigidly from what is left.
void a_chain_of_couplings(void **) {
    const Nodes nodes = scattered(6, 1e3, 4, 3);
    ConstraintRows rows = rigid_link(node(9, {0, 0, 0}), {node(10, {50, 80, -300})});
    append(rows, distributing_coupling(node(7, {100, 200, 300}), nodes, plm::vector<double>(6, 1.0)));
    append(rows, rigid_link(node(8, {500, 0, 0}), {node(9, {0, 0, 0})}));
    append(rows, rigid_link(node(7, {100, 200, 300}), {node(8, {500, 0, 0})}));
    plm::vector<std::int64_t> fixed{0, 1, 2, 3, 4, 5};
    for (std::int64_t i = 1; i <= 6; ++i)
        for (std::int64_t k = 3; k < 6; ++k) fixed.push_back(6 * i + k);
    const plm::DofMap map(66, fixed, rows);
    assert_int_equal(map.n_free(), 18);
    Motion q(66, 0.0);
    for (const CoupledNode &n : nodes) move_rigidly(q, n, {1, 2, 3}, {0.2, -0.3, 0.4});
    for (const CoupledNode &n : {node(7, {100, 200, 300}), node(8, {500, 0, 0}), node(9, {0, 0, 0}),
                                 node(10, {50, 80, -300})}) // whichever of them is free
        move_rigidly(q, n, {1, 2, 3}, {0.2, -0.3, 0.4});
    const Motion moved = map.free_part(q.data());
    Motion got(66);
    map.expand(moved.data(), got.data());
    for (std::int64_t i = 0; i < 66; ++i)
        assert_true(below(std::abs(got[i] - q[i]), 1e-13 * 8e3)); // of what turns
}

// 10,000 nodes with a spring from each to a neighbour of its own: with a link all neighbours are joined to
// six DOFs, with a mean nothing is joined at all.
void wide_couplings_stay_sparse(void **) {
    constexpr std::int64_t n = 10'000;
    const Nodes nodes = scattered(n, 1.0, 11, 3);
    const std::int64_t n_dof = 12 * n + 12; // 6 n + 6 of the nodes, and a neighbour of each
    plm::vector<std::int64_t> row, column, fixed;
    plm::vector<double> value;
    const auto put = [&](std::int64_t i, std::int64_t j, double v) {
        row.push_back(i), column.push_back(j), value.push_back(v);
    };
    for (const CoupledNode &node : nodes)
        for (std::size_t k = 0; k < 6; ++k) {
            if (k >= 3) {
                for (std::int64_t half : {0, 1})
                    fixed.push_back(node.dof[0] + half * (6 * n + 6) + static_cast<std::int64_t>(k));
                continue;
            }
            const std::int64_t i = node.dof[k], j = i + 6 * n + 6;
            put(i, i, 2), put(j, j, 1), put(i, j, -1), put(j, i, -1);
        }
    for (std::int64_t k = 0; k < 6; ++k) fixed.push_back(6 * n + 6 + k);
    const plm::SparseMatrix springs = plm::from_triplets(n_dof, n_dof, row, column, value);
    const CoupledNode reference = node(0, {20, -7, 0});
    const plm::DofMap link(n_dof, fixed, rigid_link(reference, nodes)),
        mean(n_dof, fixed, distributing_coupling(reference, nodes, plm::vector<double>(n, 1.0)));
    assert_int_equal(link.n_free(), 3 * n + 6);
    assert_true(link.reduced("stiffness", springs).value().nnz() <= 3 * n + 2 * 3 * 3 * n + 36);
    assert_int_equal(mean.n_free(), 6 * n);
    assert_int_equal(mean.reduced("stiffness", springs).value().nnz(), 12 * n);
}

// A mean of 361 nodes of a grid by way of sums over some twenty, as far as these go: in a row of the grid the
// six of a coupling are not independent, and one node alone has fewer DOFs than there are sums. Whatever is
// left free, all DOFs together are what the rows ask.
void a_mean_by_sums_over_few_nodes(void **) {
    constexpr std::int64_t side = 19, n = 3 * side * side;
    const auto with_dofs = [](std::int64_t first, std::size_t count, Point at) {
        CoupledNode with = node(0, at);
        for (std::size_t k = 0; k < 6; ++k)
            with.dof[k] = k < count ? first + static_cast<std::int64_t>(k) : plm::no_dof;
        return with;
    };
    Nodes nodes;
    for (std::int64_t i = 0; i < side; ++i)
        for (std::int64_t j = 0; j < side; ++j)
            nodes.push_back(
                with_dofs(3 * (i * side + j), 3, {static_cast<double>(i), static_cast<double>(j), 2}));
    const plm::vector<double> weight(nodes.size(), 1.0);
    const ConstraintRows rows = distributing_coupling(with_dofs(n, 6, {7, 11, 4}), nodes, weight);
    for (const plm::vector<std::int64_t> &fixed :
         {plm::vector<std::int64_t>(), {n, n + 1, n + 2, n + 3, n + 4, n + 5}}) {
        const plm::DofMap map(n + 6, fixed, rows, {}, plm::WideRows::in_groups);
        assert_int_equal(map.n_free(), n - static_cast<std::int64_t>(fixed.size()));
        test::Random random(3);
        plm::vector<double> free(static_cast<std::size_t>(map.n_free()));
        Motion q(n + 6);
        for (double &f : free) f = random();
        map.expand(free.data(), q.data());
        assert_true(largest_value(rows, q) < 1e-14); // of means of random numbers
        const Motion again = map.free_part(q.data());
        for (std::size_t i = 0; i < free.size(); ++i) assert_true(below(std::abs(again[i] - free[i]), 1e-12));
    }
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(both_are_true_of_rigid_motions),
        cmocka_unit_test(the_reference_moves_as_least_squares_say),
        cmocka_unit_test(rotations_that_nodes_do_not_tell),
        cmocka_unit_test(links_of_nodes_with_fewer_dofs),
        cmocka_unit_test(a_chain_of_couplings),
        cmocka_unit_test(wide_couplings_stay_sparse),
        cmocka_unit_test(a_mean_by_sums_over_few_nodes),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
