// Orders of elimination: nodes are found from the pattern, nested dissection beats minimum degree on solids,
// every run gives the same, and what is known of a factor beforehand is what the factor then is.
#include "linalg/memory_count.hpp"
#include "solids.hpp"
#include "structure/solver/make_factor.hpp"
#include "structure/solver/node_graph.hpp"
#include "structure/solver/ordering.hpp"
#include <cfenv>
#include <numeric>

using namespace test;

namespace {

bool is_permutation(const vector<std::int64_t> &order, std::int64_t n) {
    vector<char> seen(n, 0);
    for (std::int64_t i : order) {
        if (i < 0 || i >= n || seen[i]) return false;
        seen[i] = 1;
    }
    return static_cast<std::int64_t>(order.size()) == n;
}

void dofs_of_a_node_are_one_vertex(void **) {
    const plm::NodeGraph graph = plm::node_graph(solid(5, 4, 3));
    assert_int_equal(graph.size(), 60);
    std::int64_t edges = 0;
    for (std::int64_t v = 0; v < graph.size(); ++v) {
        assert_int_equal(graph.first_row[v + 1] - graph.first_row[v], 3);
        for (std::int64_t k = graph.first_row[v]; k < graph.first_row[v + 1]; ++k)
            assert_int_equal(graph.row[k] / 3, graph.row[graph.first_row[v]] / 3);
        edges += graph.first_neighbour[v + 1] - graph.first_neighbour[v];
    }
    assert_int_equal(edges, 13 * 10 * 7 - 60); // (3 n - 2) neighbours with oneself along each direction
    assert_int_equal(plm::node_graph(membrane(6, 5)).size(), 30); // no two rows alike
}

#ifdef PLM_WITH_SCOTCH
void nested_dissection_saves_flops_and_is_the_same_in_every_run(void **) {
    const SparseMatrix a = solid(14, 14, 14);
    const vector<std::int64_t> order = plm::nested_dissection(a);
    assert_true(is_permutation(order, a.cols));
    assert_true(order == plm::nested_dissection(a));
    plm::Solver natural, dissected;
    natural.order.resize(a.cols);
    std::iota(natural.order.begin(), natural.order.end(), std::int64_t(0));
    dissected.order = order;
    const double flops = plm::estimate_factor(a, dissected)->flops;
    assert_true(flops < 0.5 * plm::estimate_factor(a, natural)->flops);
    assert_true(plm::estimate_factor(a)->nonzeros <= plm::estimate_factor(a, dissected)->nonzeros);
}

// Parts that hang on nothing, single rows, and a matrix of no row.
void graphs_of_any_kind_are_ordered(void **) {
    assert_true(is_permutation(plm::nested_dissection(diagonal(vector<double>(50, 1.0))), 50));
    assert_true(is_permutation(plm::nested_dissection(random_definite(3000, 5)), 3000));
    assert_true(plm::nested_dissection(diagonal({})).empty());
}

void the_host_is_left_alone(void **) {
    const SparseMatrix a = solid(12, 12, 12);
    std::srand(11);
    const int expected = std::rand();
    std::srand(11);
    std::fesetround(FE_UPWARD);
    std::feclearexcept(FE_ALL_EXCEPT);
    setenv("SCOTCH_PTHREAD_NUMBER", "no number", 1);
    const vector<std::int64_t> order = plm::nested_dissection(a);
    unsetenv("SCOTCH_PTHREAD_NUMBER");
    const int rounding = std::fegetround();
    std::fesetround(FE_TONEAREST);
    assert_int_equal(rounding, FE_UPWARD);
    assert_int_equal(std::rand(), expected);
    assert_true(is_permutation(order, a.cols));
}
#endif

// A host that drops its explicit zeros, and with them the likeness of the rows of a node, loses little.
void dropped_zeros_do_no_harm(void **) {
    SparseMatrix a = solid(13, 13, 13), sparser = a;
    sparser.idx.clear();
    sparser.val.clear();
    for (std::int64_t j = 0; j < a.cols; ++j) {
        sparser.ptr[j] = sparser.nnz();
        for (std::int64_t p = a.ptr[j]; p < a.ptr[j + 1]; ++p) {
            const bool coupled = a.idx[p] / 3 == j / 3 || (a.idx[p] + j) % 3 != 0;
            if (!coupled) continue;
            sparser.idx.push_back(a.idx[p]);
            sparser.val.push_back(a.val[p]);
        }
    }
    sparser.ptr[a.cols] = sparser.nnz();
    assert_true(plm::estimate_factor(sparser)->flops < 1.3 * plm::estimate_factor(a)->flops);
}

void orders_are_found_once_for_a_pattern(void **) {
    const SparseMatrix a = solid(12, 12, 12);
    plm::Solver solver;
    solver.orders = std::make_shared<plm::KeptOrders>();
    assert_true(solver.orders->find(a).empty());
    const double first = plm::estimate_factor(a, solver)->nonzeros;
    const SparseMatrix b = plm::add(1, a, 3, diagonal(vector<double>(a.cols, 1.0)));
    assert_true(is_permutation(solver.orders->find(b), a.cols));
    assert_true(plm::estimate_factor(b, solver)->nonzeros == first);
    assert_true(solver.orders->find(membrane(6, 5)).empty());
}

// Of the entries exactly; of the bytes within what small arrays and malloc take.
void what_is_estimated_is_what_is_taken(void **) {
    const SparseMatrix a = solid(14, 14, 14);
    for (auto precision : {plm::FactorPrecision::full, plm::FactorPrecision::single}) {
        plm::Solver solver;
        solver.orders = std::make_shared<plm::KeptOrders>();
        solver.precision = precision;
        const bool full = precision == plm::FactorPrecision::full;
        const plm::FactorEstimate e = *plm::estimate_factor(a, solver);
        const plm::CountingScope scope;
        const auto factor = plm::make_factor(a, solver);
        const double peak = static_cast<double>(scope.peak()), held = static_cast<double>(scope.held());
        const double expected_peak = full ? e.peak_full : e.peak_single,
                     kept = full ? e.kept_full : e.kept_single;
        if (full) assert_true(static_cast<double>(factor->factor_nonzeros()) == e.nonzeros);
        assert_true(held < 1.1 * kept && held > 0.7 * kept);
        assert_true(peak < 1.1 * expected_peak && peak > 0.6 * expected_peak);
    }
}

} // namespace

int main() {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(dofs_of_a_node_are_one_vertex),
#ifdef PLM_WITH_SCOTCH
        cmocka_unit_test(nested_dissection_saves_flops_and_is_the_same_in_every_run),
        cmocka_unit_test(graphs_of_any_kind_are_ordered),
        cmocka_unit_test(the_host_is_left_alone),
#endif
        cmocka_unit_test(dropped_zeros_do_no_harm),
        cmocka_unit_test(orders_are_found_once_for_a_pattern),
        cmocka_unit_test(what_is_estimated_is_what_is_taken),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
