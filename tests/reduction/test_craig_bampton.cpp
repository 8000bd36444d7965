// Craig-Bampton against dense eigenproblems: exact with all fixed-interface modes, an upper bound with few.
#include "reduction/basis.hpp"
#include "reduction/craig_bampton.hpp"
#include "sampling/small_models.hpp"
#include "support/small_reduced.hpp"
#include "support/test.hpp"
#include <algorithm>

using plm::Matrix;

namespace {

using SpacePtr = std::shared_ptr<const plm::Space>;

SpacePtr space_of(const exact::Structure &s, std::int64_t n_fixed, double highest = 1.0,
                  plm::Monitor *monitor = nullptr) {
    return plm::make_craig_bampton_space(test::make_model(s), {n_fixed, highest, false}, plm::Watch(monitor));
}

plm::vector<double> exact_values(const exact::Structure &s) {
    return test::dense_modes(s, plm::PairStates::all_open(s.z)).values;
}

// Largest relative excess and shortfall of the space's eigenvalues over the exact ones, the first `count`.
struct Deviation {
    double above = 0, below = 0;
};
Deviation deviation(const SpacePtr &space, const exact::Structure &s, std::int64_t count,
                    std::int64_t n_rigid = 0) {
    const plm::vector<double> want = exact_values(s);
    Deviation d;
    for (std::int64_t j = n_rigid; j < count; ++j) {
        d.above = std::max(d.above, space->lambda[j] / want[j] - 1);
        d.below = std::max(d.below, 1 - space->lambda[j] / want[j]);
    }
    return d;
}

// V^T M V - I and V^T K V - diag(lambda), relative.
double defect(const SpacePtr &space, const exact::Structure &s) {
    double worst = 0;
    const Matrix v = all_columns(space->vectors).in_core();
    const Matrix kv = plm::product('N', 'N', test::dense_stiffness(s, plm::PairStates::all_open(s.z)), v);
    for (std::int64_t i = 0; i < v.cols(); ++i)
        for (std::int64_t j = 0; j < v.cols(); ++j) {
            double m = i == j ? -space->mass(i) : 0;
            for (int a = 0; a < s.n; ++a) m += v(a, i) * s.mass[a] * v(a, j);
            const double k = plm::dot(s.n, v.col(i), kv.col(j)) - (i == j ? space->lambda[i] : 0);
            worst = std::max({worst, std::abs(m), std::abs(k) / space->lambda.back()});
        }
    return worst;
}

// A free two-mass body beside the chains, touched by no contact: the interior is singular.
exact::Structure with_free_body() {
    exact::Structure a = test::two_chains(20, 4, 300, true), s = a;
    s.n = a.n + 2;
    s.mass.push_back(2), s.mass.push_back(3);
    s.stiffness.assign(s.n * s.n, 0.0);
    s.damping = s.stiffness;
    s.gap_rows.assign(s.z * s.n, 0.0);
    for (int i = 0; i < a.n; ++i)
        for (int j = 0; j < a.n; ++j) s.stiffness[i * s.n + j] = a.stiffness[i * a.n + j];
    for (int p = 0; p < s.z; ++p)
        for (int j = 0; j < a.n; ++j) s.gap_rows[p * s.n + j] = a.gap_rows[p * a.n + j];
    const int x = a.n, y = a.n + 1;
    s.stiffness[x * s.n + x] = s.stiffness[y * s.n + y] = 7;
    s.stiffness[x * s.n + y] = s.stiffness[y * s.n + x] = -7;
    s.force.resize(s.n), s.preload.resize(s.n);
    return s;
}

void all_fixed_modes_give_the_exact_frequencies(void **) {
    const exact::Structure s = test::two_chains(40, 9, 300, true);
    const SpacePtr space = space_of(s, 1000);
    assert_int_equal(space->size(), 80);
    const Deviation d = deviation(space, s, 80);
    assert_true(below(std::max(d.above, d.below), 1e-9));
    assert_true(below(defect(space, s), 1e-12));
}

void few_fixed_modes_bound_the_frequencies_from_above(void **) {
    const exact::Structure s = test::two_chains(40, 9, 300, true);
    const Deviation few = deviation(space_of(s, 6), s, 10), more = deviation(space_of(s, 20), s, 10);
    assert_true(few.below < 1e-10 && more.below < 1e-10); // Rayleigh
    assert_true(few.above > more.above && more.above < 1e-2);
    assert_int_equal(space_of(s, 6)->size(), 18 + 6);
}

void the_frequency_limit_counts_the_fixed_modes(void **) {
    const exact::Structure s = test::two_chains(40, 9, 300, true);
    // the interior: two fixed-fixed chains of 31 masses, their dense eigenproblem
    exact::Structure interior = test::two_chains(40, 9, 300, true);
    for (int i = 0; i < s.n; ++i)
        if (i % 40 >= 31) interior.stiffness[i * s.n + i] += 1e12; // held
    const plm::vector<double> fixed = exact_values(interior);
    const std::int64_t want = std::count_if(fixed.begin(), fixed.end(), [](double v) { return v < 64; });
    assert_int_equal(space_of(s, 0, 8.0)->size(), 18 + want);
}

void retaining_every_dof_is_the_model_itself(void **) {
    exact::Structure s = test::chain(6, 0.01, 10, 0, 1, 0, {0, 1, 2, 3, 4, 5});
    const SpacePtr space = space_of(s, 3);
    assert_int_equal(space->size(), 6);
    const Deviation d = deviation(space, s, 6);
    assert_true(below(std::max(d.above, d.below), 1e-12));
}

void a_free_structure_has_exact_zeros(void **) {
    const exact::Structure s = test::two_chains(40, 9, 300, false);
    const SpacePtr space = space_of(s, 62);
    assert_true(space->lambda[0] == 0 && space->lambda[1] > 0);
    const Deviation d = deviation(space, s, 10, 1);
    assert_true(below(std::max(d.above, d.below), 1e-9));
    assert_true(below(defect(space, s), 1e-10));
}

void a_singular_interior_is_handled(void **) {
    const exact::Structure s = with_free_body();
    const SpacePtr space = space_of(s, 1000);
    assert_true(space->lambda[0] == 0 && space->lambda[1] > 0);
    const Deviation d = deviation(space, s, s.n, 1);
    assert_true(below(std::max(d.above, d.below), 1e-8));
    const Deviation few = deviation(space_of(s, 12), s, 8, 1); // rigid, elastic and ten of the chains
    assert_true(few.below < 1e-8 && few.above < 0.02);
}

// K^-1 of the space: V diag(1 / lambda) V^T, in DOF i under a unit force on it.
double flexibility(const SpacePtr &space, std::int64_t i) {
    const plm::vector<double> v = all_columns(space->vectors).row({{i, 1.0}});
    double sum = 0;
    for (std::int64_t j = 0; j < space->size(); ++j) sum += v[j] * v[j] / space->lambda[j];
    return sum;
}
double exact_flexibility(const exact::Structure &s, std::int64_t i) {
    Matrix k = test::dense_stiffness(s, plm::PairStates::all_open(s.z)), x(s.n, 1);
    x(i, 0) = 1;
    plm::RealLu lu;
    lu.factor(k);
    lu.solve(x.data(), 1, s.n);
    return x(i, 0);
}

// No frequency for what has none, and nothing lost of what it lets the contact forces do.
void massless_contact_dofs_are_a_flexibility(void **) {
    exact::Structure s = test::two_chains(20, 4, 300, true);
    for (double mass : {0.0, 1e-14}) { // "numerically mass-less" goes the same way
        s.mass[19] = mass;
        test::Recorder recorder;
        const SpacePtr space = space_of(s, 1000, 1.0, &recorder);
        assert_int_equal(space->size(), 40);
        assert_int_equal(space->n_massless, 1);
        assert_int_equal(recorder.warnings.size(), 0);
        assert_true(below(defect(space, s), 1e-10));
        assert_true(near(flexibility(space, 19), exact_flexibility(s, 19), 1e-12));
    }
}

} // namespace

int main() {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_fixed_modes_give_the_exact_frequencies),
        cmocka_unit_test(few_fixed_modes_bound_the_frequencies_from_above),
        cmocka_unit_test(the_frequency_limit_counts_the_fixed_modes),
        cmocka_unit_test(retaining_every_dof_is_the_model_itself),
        cmocka_unit_test(a_free_structure_has_exact_zeros),
        cmocka_unit_test(a_singular_interior_is_handled),
        cmocka_unit_test(massless_contact_dofs_are_a_flexibility),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
