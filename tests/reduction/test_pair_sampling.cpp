// Node sampling: which pairs are carried, against determinants and explicit Guyan reduction, and what becomes
// of the others.
#include "reduction/basis.hpp"
#include "reduction/pair_sampling.hpp"
#include "sampling/small_models.hpp"
#include "support/test.hpp"
#include <algorithm>
#include <numeric>

using plm::Basis;
using plm::BasisOptions;
using plm::Matrix;
using Pairs = plm::vector<std::int64_t>;

namespace {

// Numbers in [-1, 1) that are the same everywhere.
struct Numbers {
    std::uint64_t state;
    double operator()() {
        state = state * 6364136223846793005ULL + 1442695040888963407ULL;
        return static_cast<double>(state >> 11) / 4503599627370496.0 - 1;
    }
};

Matrix random_matrix(std::int64_t rows, std::int64_t cols, std::uint64_t seed) {
    Numbers next{seed};
    Matrix a(rows, cols);
    for (std::int64_t k = 0; k < rows * cols; ++k) a.data()[k] = next();
    return a;
}

Matrix rows_of(const Matrix &a, const Pairs &rows) {
    Matrix b(static_cast<std::int64_t>(rows.size()), a.cols());
    for (std::int64_t j = 0; j < b.cols(); ++j)
        for (std::int64_t i = 0; i < b.rows(); ++i) b(i, j) = a(rows[i], j);
    return b;
}

// det of the Fisher information A^T A.
double information(const Matrix &a) {
    double det = 1;
    for (double v : plm::symmetric_eigen(product('T', 'N', a, a)).values) det *= v;
    return det;
}

Pairs without(Pairs pairs, std::size_t k) {
    pairs.erase(pairs.begin() + static_cast<std::ptrdiff_t>(k));
    return pairs;
}

// Kammer: what is taken out is always the row whose loss costs the determinant least.
void effective_independence_keeps_the_information(void **) {
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
        const Matrix a = random_matrix(9, 3, seed);
        Pairs left(9);
        std::iota(left.begin(), left.end(), 0);
        while (left.size() > 3) {
            Pairs best;
            double most = -1;
            for (std::size_t k = 0; k < left.size(); ++k) {
                const double det = information(rows_of(a, without(left, k)));
                if (det > most) most = det, best = without(left, k);
            }
            left = best;
            assert_true(plm::pairs_by_effective_independence(a, static_cast<std::int64_t>(left.size())) ==
                        left);
        }
    }
}

void repeated_rows_go_first(void **) {
    Matrix a = random_matrix(4, 2, 5), twice(8, 2);
    for (std::int64_t j = 0; j < 2; ++j)
        for (std::int64_t i = 0; i < 8; ++i) twice(i, j) = a(i % 4, j) * (i % 4 == 3 ? 1e-3 : 1);
    const Pairs kept = plm::pairs_by_effective_independence(twice, 2),
                expected = plm::pairs_by_effective_independence(rows_of(twice, {0, 1, 2, 3}), 2);
    assert_true(kept == expected); // the first of equals, never both
}

void pairs_that_do_not_move_leave_the_first(void **) {
    assert_true(plm::pairs_by_effective_independence(Matrix(5, 3), 2) == (Pairs{0, 1}));
}

// Springs from mass to mass and to ground, every mass a "pair".
struct SpringMass {
    Matrix k, m;
};
SpringMass spring_mass(std::int64_t n, std::uint64_t seed) {
    Numbers next{seed};
    SpringMass s{Matrix(n, n), Matrix(n, n)};
    for (std::int64_t i = 0; i < n; ++i) {
        s.m(i, i) = 2 + next();
        s.k(i, i) += 2 + next();
        if (i + 1 == n) continue;
        const double c = 3 + 2 * next();
        s.k(i, i) += c, s.k(i + 1, i + 1) += c, s.k(i, i + 1) -= c, s.k(i + 1, i) -= c;
    }
    return s;
}

// Guyan: one DOF follows the others statically, by the transformation matrix itself.
SpringMass condensed(const SpringMass &s, std::int64_t gone) {
    const std::int64_t n = s.k.rows();
    Matrix t(n, n - 1);
    for (std::int64_t j = 0, c = 0; j < n; ++j) {
        if (j == gone) continue;
        t(j, c) = 1;
        t(gone, c++) = -s.k(gone, j) / s.k(gone, gone);
    }
    return {product('T', 'N', t, product('N', 'N', s.k, t)), product('T', 'N', t, product('N', 'N', s.m, t))};
}

Matrix solved(const Matrix &k, Matrix x) {
    Matrix copy = k;
    plm::DenseCholesky cholesky;
    if (!cholesky.factor(copy)) return Matrix();
    cholesky.solve(x.data(), x.cols(), x.rows());
    return x;
}

void masters_are_those_of_henshell_and_ong(void **) {
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
        SpringMass s = spring_mass(8, seed);
        Matrix one(8, 8);
        for (std::int64_t i = 0; i < 8; ++i) one(i, i) = 1;
        const Matrix flexibility = solved(s.k, one),
                     inertia = solved(s.k, product('N', 'N', s.m, flexibility));
        Pairs left(8);
        std::iota(left.begin(), left.end(), 0);
        while (left.size() > 1) {
            std::int64_t gone = 0;
            for (std::int64_t i = 0; i < s.k.rows(); ++i)
                if (s.k(i, i) / s.m(i, i) > s.k(gone, gone) / s.m(gone, gone)) gone = i;
            s = condensed(s, gone);
            left = without(left, static_cast<std::size_t>(gone));
            assert_true(plm::pairs_by_master_dof(flexibility, inertia,
                                                 static_cast<std::int64_t>(left.size())) == left);
        }
    }
}

struct Chains {
    exact::Structure structure;
    std::shared_ptr<const plm::Model> model;
    std::shared_ptr<const plm::Sampler> sampler;
    std::shared_ptr<const Basis> basis(const BasisOptions &o, std::shared_ptr<const Basis> parent = nullptr,
                                       const plm::Responses *responses = nullptr) const {
        return std::make_shared<Basis>(model, sampler, parent, o, plm::Watch(), responses);
    }
};

Chains chains() {
    Chains c;
    c.structure = test::two_chains(40, 9, 300, true);
    c.structure.preload.assign(c.structure.n, 0.0);
    c.structure.preload[39] = 2;
    c.structure.preload[79] = -2;
    c.model = test::make_model(c.structure);
    plm::SamplerOptions o;
    o.system = plm::LinearSystem::sliding;
    o.mode = 3;
    c.sampler = std::make_shared<plm::Sampler>(c.model, o, plm::Watch());
    return c;
}

BasisOptions sampled(const plm::BasisKind *kind, std::int64_t n, plm::PairRule rule) {
    BasisOptions o;
    o.kind = kind;
    o.n_pairs_carried = n;
    o.pair_rule = rule;
    return o;
}

double sum(const plm::vector<double> &x) {
    return std::accumulate(x.begin(), x.end(), 0.0);
}

void the_stiffness_left_out_is_carried_by_the_others(void **) {
    const Chains c = chains();
    const double total = sum(c.model->contact_stiffness());
    for (const plm::BasisKind *kind : {&plm::basis_kinds::plm, &plm::basis_kinds::snapshots,
                                       &plm::basis_kinds::full, &plm::basis_kinds::craig_bampton})
        for (plm::PairRule rule : {plm::PairRule::effective_independence, plm::PairRule::mdof})
            for (std::int64_t n : {1, 4, 8}) {
                const auto basis = c.basis(sampled(kind, n, rule));
                const plm::ReducedModel &r = *basis->reduced();
                assert_int_equal(r.n_pairs(), n);
                assert_int_equal(r.gap_0.rows(), n);
                assert_int_equal(r.n_whole_pairs(), 9);
                assert_true(std::is_sorted(r.carried.begin(), r.carried.end()));
                assert_true(close_to(sum(r.contact.stiffness), total, 1e-14));
                for (std::int64_t i = 0; i < n; ++i) {
                    const std::int64_t pair = r.carried[i];
                    assert_true(r.contact.stiffness[i] >= c.model->contact_stiffness()[pair]);
                    for (std::int64_t j = 0; j < r.size(); ++j)
                        assert_true(r.gap(i, j) == r.whole_gap()(pair, j));
                }
            }
}

void all_pairs_carried_is_no_sampling(void **) {
    const Chains c = chains();
    const auto all = c.basis(sampled(&plm::basis_kinds::plm, 9, plm::PairRule::mdof));
    assert_true(all->reduced()->all_pairs == nullptr);
    assert_true(all->reduced()->contact.stiffness == c.model->contact_stiffness());
    const test::Failure f = test::failure_of(
        [&] { c.basis(sampled(&plm::basis_kinds::plm, 10, plm::PairRule::effective_independence)); });
    assert_int_equal(f.status, plm::status::argument);
    assert_string_equal(f.argument.c_str(), "n_pairs_carried");
}

// What is compressed is the motion: the pairs are chosen again, or all carried.
void compressing_a_sampled_basis_knows_all_pairs(void **) {
    const Chains c = chains();
    const auto parent = c.basis(sampled(&plm::basis_kinds::plm, 4, plm::PairRule::effective_independence));
    plm::Responses responses{parent->reduced(), Matrix(parent->reduced()->size(), 4),
                             Matrix(parent->reduced()->static_size(), 1), 1.0};
    for (std::int64_t j = 0; j < 4; ++j) responses.dynamic(j, j) = 1;
    BasisOptions o;
    o.kind = &plm::basis_kinds::pod;
    const auto pod = c.basis(o, parent, &responses);
    assert_int_equal(pod->reduced()->n_pairs(), 9);
    assert_true(pod->reduced()->contact.stiffness == c.model->contact_stiffness());
    o.n_pairs_carried = 2;
    assert_int_equal(c.basis(o, parent, &responses)->reduced()->n_pairs(), 2);
    assert_int_equal(unreduced_basis(parent, plm::Watch())->reduced()->n_pairs(), 9);
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(effective_independence_keeps_the_information),
        cmocka_unit_test(repeated_rows_go_first),
        cmocka_unit_test(pairs_that_do_not_move_leave_the_first),
        cmocka_unit_test(masters_are_those_of_henshell_and_ong),
        cmocka_unit_test(the_stiffness_left_out_is_carried_by_the_others),
        cmocka_unit_test(all_pairs_carried_is_no_sampling),
        cmocka_unit_test(compressing_a_sampled_basis_knows_all_pairs),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
