// Constraints are eliminated as they say, with few terms and none that is large without need.
#include "linalg/support.hpp"
#include "structure/dof_map.hpp"
#include "support/caught.hpp"
#include "support/test.hpp"

using plm::ConstraintRows;
using plm::DofMap;
using plm::DofTerms;
using plm::Matrix;
using Ints = plm::vector<std::int64_t>;

namespace {

void add(ConstraintRows &rows, const DofTerms &terms) {
    for (const plm::DofTerm &t : terms) rows.dof.push_back(t.dof), rows.coefficient.push_back(t.coefficient);
    rows.ptr.push_back(static_cast<std::int64_t>(rows.dof.size()));
}

// T, written down by unit motions of the free DOFs.
Matrix dense_map(const DofMap &map) {
    Matrix t(map.n_dof(), map.n_free());
    for (std::int64_t j = 0; j < map.n_free(); ++j) {
        plm::vector<double> unit(map.n_free(), 0.0);
        unit[j] = 1;
        map.expand(unit.data(), t.col(j));
    }
    return t;
}

double largest_violation(const ConstraintRows &rows, const Matrix &t) {
    double most = 0;
    for (std::int64_t i = 0; i < rows.n_rows(); ++i)
        for (std::int64_t j = 0; j < t.cols(); ++j) {
            double sum = 0, size = 1;
            for (std::int64_t p = rows.ptr[i]; p < rows.ptr[i + 1]; ++p) {
                const double term = rows.coefficient[p] * t(rows.dof[p], j);
                sum += term, size += std::abs(term);
            }
            most = std::max(most, std::abs(sum) / size);
        }
    return most;
}

double largest_entry(const Matrix &t) {
    double most = 0;
    for (std::int64_t k = 0; k < t.rows() * t.cols(); ++k) most = std::max(most, std::abs(t.data()[k]));
    return most;
}

// Row i holds its own DOF and later ones, so that the rows are independent; sums of two of them say nothing
// new.
ConstraintRows random_rows(std::int64_t n_rows, std::int64_t n_dof, std::uint64_t seed) {
    test::Random random(seed);
    std::vector<plm::vector<double>> dense;
    ConstraintRows rows;
    const auto put = [&](const plm::vector<double> &row) {
        DofTerms terms;
        for (std::int64_t j = 0; j < n_dof; ++j)
            if (row[j] != 0) terms.push_back({j, row[j]});
        add(rows, terms);
    };
    for (std::int64_t i = 0; i < n_rows; ++i) {
        plm::vector<double> row(n_dof, 0.0);
        row[i] = 2 + random();
        for (std::int64_t j = i + 1; j < n_dof; ++j)
            if (random() > 0.8) row[j] = random();
        dense.push_back(row);
        put(row);
        for (std::int64_t j = 0; j < n_dof; ++j) row[j] += 0.7 * dense[static_cast<std::size_t>(i / 2)][j];
        if (i > 0) put(row);
    }
    return rows;
}

void motions_that_satisfy_random_constraints_and_all_of_them(void **) {
    constexpr std::int64_t n_dof = 60, n_rows = 20;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        const ConstraintRows rows = random_rows(n_rows, n_dof, seed);
        const DofMap map(n_dof, {}, rows);
        assert_int_equal(map.n_free(), n_dof - n_rows);
        assert_int_equal(map.elimination().n_redundant, n_rows - 1);
        assert_true(below(largest_violation(rows, dense_map(map)), 1e-12));
        assert_true(below(map.elimination().largest_miss, plm::cancelled_exactly));
    }
}

// Each link is given by the one before it, in an order that mixes them, and each is said twice.
void a_chain_of_constraints_on_constraints(void **) {
    constexpr std::int64_t n = 1001;
    ConstraintRows rows;
    for (std::int64_t k = 0; k + 1 < n; ++k) {
        const std::int64_t i = 7 * k % (n - 1);
        add(rows, {{i, 3.0}, {i + 1, -3.0}});
        add(rows, {{i + 1, 0.1}, {i, -0.1}});
    }
    const DofMap map(n, {}, rows);
    assert_int_equal(map.n_free(), 1);
    assert_int_equal(map.elimination().n_redundant, n - 1);
    for (std::int64_t i = 0; i < n; ++i) assert_true(near(map.terms(i).at(0).coefficient, 1, 1e-13));
}

void rows_that_only_zero_satisfies_hold_what_they_name(void **) {
    ConstraintRows rows;
    add(rows, {{0, 1}, {1, -1}});
    add(rows, {{0, 1}, {1, -2}});
    add(rows, {{2, 5}});
    add(rows, {{3, 1}, {4, -2}});
    add(rows, {{4, 1}, {5, 1}}); // 5 is fixed
    add(rows, {{5, 1}});
    const DofMap map(7, {5, 5}, rows);
    for (std::int64_t i = 0; i < 6; ++i) assert_true(map.is_held(i) && map.terms(i).empty());
    assert_true(map.n_free() == 1 && !map.is_held(6));
    assert_int_equal(map.elimination().n_redundant, 1);
}

// Up to where printed digits end, and not beyond.
void rows_that_repeat_others_as_printed(void **) {
    for (const double miss : {0.0, 1e-8, 1e-4}) {
        ConstraintRows rows;
        add(rows, {{0, 1}, {1, -1}});
        add(rows, {{0, 1}, {1, -1 - miss}});
        const DofMap map(3, {}, rows);
        assert_int_equal(map.n_free(), miss < 1e-6 ? 2 : 1);
        assert_int_equal(map.elimination().n_redundant, miss < 1e-6 ? 1 : 0);
        assert_true(near(map.elimination().largest_miss, miss < 1e-6 ? miss : 0, 1e-15));
        assert_int_equal(map.elimination().missing_row, miss == 1e-8 ? 1 : -1);
    }
}

// Nodes on arms of up to 1,000 mm, two of them tied on to others: the nodes follow, and no rotation does,
// which would take factors of the arms into what stays.
void a_rotation_stays_though_its_coefficients_are_large(void **) {
    constexpr std::int64_t nodes = 50; // DOF 0 moves, 1 turns
    ConstraintRows rows;
    for (std::int64_t i = 0; i < nodes; ++i)
        add(rows, {{2 + i, 1}, {0, -1}, {1, -20.0 * static_cast<double>(i)}});
    add(rows, {{2, 1}, {2 + nodes, -1}});
    add(rows, {{3, 1}, {3 + nodes, -1}});
    const DofMap map(nodes + 4, {}, rows);
    assert_int_equal(map.n_free(), 2);
    assert_true(map.free_index(1) >= 0);
    assert_true(below(largest_entry(dense_map(map)), 20.0 * nodes));
}

struct Coupling {
    std::int64_t n;
    ConstraintRows rows; // the last DOF is the mean of the others
};
Coupling mean_of(std::int64_t n) {
    Coupling c{n, {}};
    DofTerms terms{{n, 1}};
    for (std::int64_t i = 0; i < n; ++i) terms.push_back({i, -1.0 / static_cast<double>(n)});
    add(c.rows, terms);
    return c;
}
plm::SparseMatrix springs(std::int64_t n, double at_reference) {
    Ints i;
    plm::vector<double> v(n, 2.0);
    v.push_back(at_reference);
    for (std::int64_t j = 0; j <= n; ++j) i.push_back(j);
    return plm::from_triplets(n + 1, n + 1, i, i, v);
}

// The mean of 20,000 nodes fills nothing as long as it has no stiffness of its own. Where it has, sums over
// groups keep the matrix sparse, and it is the same: its energy in motions that the constraint allows, of
// which there are as many.
void a_wide_coupling_fills_nothing(void **) {
    constexpr std::int64_t n = 20'000;
    const Coupling c = mean_of(n);
    const DofMap whole(n + 1, {}, c.rows), groups(n + 1, {}, c.rows, {}, plm::WideRows::in_groups);
    assert_int_equal(whole.free_index(n), -1);
    assert_int_equal(whole.reduced("stiffness", springs(n, 0)).value().nnz(), n);
    const plm::SparseMatrix a = springs(n, 3);
    assert_false(whole.reduced("stiffness", a).has_value());
    const plm::SparseMatrix reduced = groups.reduced("stiffness", a).value();
    assert_int_equal(groups.n_free(), n);
    assert_true(reduced.nnz() < 100 * n);
    test::Random random(3);
    plm::vector<double> q(n + 1), back(n + 1), f(static_cast<std::size_t>(n));
    for (std::int64_t i = 0; i < n; ++i) q[i] = random(), q[n] += q[i] / static_cast<double>(n);
    const plm::vector<double> free = groups.free_part(q.data());
    groups.expand(free.data(), back.data());
    double want = 0, got = 0;
    for (std::int64_t i = 0; i <= n; ++i) {
        assert_true(near(back[i], q[i], 1e-12));
        want += 0.5 * q[i] * (i < n ? 2.0 : 3.0) * q[i];
    }
    plm::multiply(reduced, free.data(), f.data());
    for (std::int64_t i = 0; i < n; ++i) got += 0.5 * free[i] * f[i];
    assert_true(near(got, want, 1e-12 * want));
}

// DOFs far apart in their numbers have no groups in common: what fills is said before anything is formed.
void what_groups_do_not_help_is_refused(void **) {
    constexpr std::int64_t n = 10'000;
    ConstraintRows rows;
    for (std::int64_t i = 0; i < 70; ++i) { // row i: every 70th DOF
        DofTerms terms{{70 * n + i, 1}};
        for (std::int64_t k = 0; k < n; ++k) terms.push_back({70 * k + i, -1.0 / static_cast<double>(n)});
        add(rows, terms);
    }
    const DofMap groups(70 * n + 70, {}, rows, {}, plm::WideRows::in_groups);
    plm::vector<std::int64_t> i;
    for (std::int64_t j = 0; j < 70 * n + 70; ++j) i.push_back(j);
    const plm::vector<double> ones(i.size(), 1.0);
    const plm::SparseMatrix a = plm::from_triplets(70 * n + 70, 70 * n + 70, i, i, ones);
    const Caught refused = caught([&] { groups.reduced("stiffness", a); });
    assert_int_equal(refused.status, plm::status::memory);
    assert_true(refused.says("stiffness matrix") && refused.says("10000 others"));
}

// T^T A T against the dense product, symmetric to the last bit, and zero where it is.
void matrices_are_reduced(void **) {
    constexpr std::int64_t n_dof = 40, n_rows = 12;
    const ConstraintRows rows = random_rows(n_rows, n_dof, 5);
    const DofMap map(n_dof, {39}, rows);
    Matrix all = test::random_matrix(n_dof, n_dof, 3);
    Ints i, j;
    plm::vector<double> v;
    for (std::int64_t r = 0; r < n_dof; ++r)
        for (std::int64_t c = 0; c < n_dof; ++c)
            if ((7 * (r + c) + r * c) % 3 == 0)
                i.push_back(r), j.push_back(c), v.push_back(all(std::min(r, c), std::max(r, c)));
    const plm::SparseMatrix a = plm::from_triplets(n_dof, n_dof, i, j, v);
    const Matrix t = dense_map(map), got = plm::to_dense(map.reduced("test", a).value()),
                 want = product('T', 'N', t, multiply(a, t));
    for (std::int64_t r = 0; r < got.rows(); ++r)
        for (std::int64_t c = 0; c < got.cols(); ++c) {
            assert_true(got(r, c) == got(c, r));
            assert_true(near(got(r, c), want(r, c), 1e-12));
        }
}

// Sums over free, dependent and fixed DOFs are those of the rows of T; what cancels is left out.
void sums_of_dofs_by_the_free_ones(void **) {
    constexpr std::int64_t n_dof = 40, n_rows = 12;
    const DofMap map(n_dof, {39}, random_rows(n_rows, n_dof, 5));
    const Matrix t = dense_map(map);
    test::Random random(9);
    DofTerms sum;
    for (std::int64_t i = n_dof; i-- > 0;) sum.push_back({i, random()});
    plm::vector<double> got(map.n_free(), 0.0);
    std::int64_t before = -1;
    for (const plm::DofTerm &term : map.terms(sum)) {
        assert_true(term.dof > before);
        before = term.dof, got[term.dof] = term.coefficient;
    }
    for (std::int64_t j = 0; j < map.n_free(); ++j) {
        double want = 0;
        for (const plm::DofTerm &term : sum) want += term.coefficient * t(term.dof, j);
        assert_true(near(got[j], want, 1e-12));
    }
    assert_true(map.terms(DofTerms{{39, 3.0}}).empty());
    ConstraintRows tie;
    add(tie, {{0, 1}, {1, -1}});
    assert_true(DofMap(3, {}, tie).terms(DofTerms{{0, 2.0}, {1, -2.0}}).empty());
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(motions_that_satisfy_random_constraints_and_all_of_them),
        cmocka_unit_test(a_chain_of_constraints_on_constraints),
        cmocka_unit_test(rows_that_only_zero_satisfies_hold_what_they_name),
        cmocka_unit_test(rows_that_repeat_others_as_printed),
        cmocka_unit_test(a_rotation_stays_though_its_coefficients_are_large),
        cmocka_unit_test(a_wide_coupling_fills_nothing),
        cmocka_unit_test(what_groups_do_not_help_is_refused),
        cmocka_unit_test(matrices_are_reduced),
        cmocka_unit_test(sums_of_dofs_by_the_free_ones),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
