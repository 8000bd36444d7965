// An iteration of Newton's method on the harmonic-balance equations allocates nothing once the system has
// seen as many pairs switch: nor does an iteration more of the same solution.
#include "hbm/make_system.hpp"
#include "paths/newton.hpp"
#include "reduction/reduced_rest.hpp"
#include "support/count_allocations.hpp"
#include "support/small_reduced.hpp"
#include "support/test.hpp"
#include <random>

using plm::HbmOptions;
using plm::NonlinearUnknowns;
using plm::ReducedModel;

namespace {

// Three pairs, of which one is pressed closed at rest and one open.
std::shared_ptr<ReducedModel> chain_model(bool full_damping) {
    exact::Structure s = test::chain(6, 0.02, 30, 0.05, 0.4, 0.3, {1, 3, 5});
    for (int i = 0; i < s.n && full_damping; ++i) s.damping[i * s.n + i] += 0.01 * (i + 1) * (i + 1);
    return test::reduce_exactly(s);
}

std::shared_ptr<ReducedModel> rigid_when_open() {
    exact::Structure s = test::chain(4, 0.02, 5, 0, 0.4, 0.5, {3});
    s.stiffness[0] = 1; // no spring to the left wall
    for (std::size_t i = 0; i < s.damping.size(); ++i) s.damping[i] = 0.05 * s.stiffness[i];
    auto m = test::reduce_exactly(s);
    m->lambda[0] = m->lambda_0[0] = 0;
    return m;
}

// Motions from hardly moving (all pairs constant) to all pairs switching.
std::vector<plm::vector<double>> motions(plm::HbmSystem &system, const ReducedModel &m) {
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    plm::vector<double> rest(system.size());
    system.linear_response(plm::coupling_at_rest(m), 0.7, rest.data());
    std::vector<plm::vector<double>> all;
    for (double size : {0.0, 0.01, 0.1, 0.3, 1.0, 3.0}) {
        all.push_back(rest);
        for (double &v : all.back()) v += size * normal(random);
    }
    return all;
}

long allocations_of_iterations(std::shared_ptr<ReducedModel> m, NonlinearUnknowns unknowns,
                               plm::AftKind aft) {
    HbmOptions o;
    o.n_harmonics = 4;
    o.unknowns = unknowns;
    o.aft = aft;
    const auto system = plm::make_system(m, o);
    const std::vector<plm::vector<double>> all = motions(*system, *m);
    plm::vector<double> r(system->size());
    const auto iterate = [&](double omega) {
        for (const plm::vector<double> &x : all) {
            system->residual(x.data(), omega, r.data());
            system->linearize();
            system->solve(r.data(), 1);
            system->parameter_derivative(r.data());
            system->solve(r.data(), 1);
        }
    };
    iterate(0.7), iterate(0.71); // a factorization swaps the storage of two matrices
    const test::AllocationCount count;
    iterate(0.72);
    return count.so_far();
}

void an_iteration_allocates_nothing(void **) {
    for (const auto &m : {chain_model(false), chain_model(true), rigid_when_open()})
        for (NonlinearUnknowns unknowns : {NonlinearUnknowns::modal, NonlinearUnknowns::gaps})
            for (plm::AftKind aft : {plm::AftKind::event, plm::AftKind::sampled})
                assert_int_equal(allocations_of_iterations(m, unknowns, aft), 0);
}

struct Work {
    std::int64_t iterations;
    long allocations;
};
Work solve(plm::HbmSystem &system, const plm::vector<double> &start, std::int64_t most_iterations) {
    plm::vector<double> x = start;
    plm::NewtonLimits limits;
    limits.tolerance = 1e-12;
    limits.max_iterations = most_iterations;
    const test::AllocationCount count;
    const plm::NewtonOutcome out = plm::newton_at(system, limits, x, 0.7);
    return {out.iterations, count.so_far()};
}
void more_iterations_allocate_no_more(void **) {
    for (NonlinearUnknowns unknowns : {NonlinearUnknowns::modal, NonlinearUnknowns::gaps}) {
        HbmOptions o;
        o.n_harmonics = 4;
        o.unknowns = unknowns;
        const auto m = chain_model(false);
        const auto system = plm::make_system(m, o);
        const plm::vector<double> start = motions(*system, *m)[3];
        solve(*system, start, 30);
        const Work few = solve(*system, start, 2), many = solve(*system, start, 30);
        assert_true(many.iterations > few.iterations);
        assert_int_equal(many.allocations, few.allocations);
    }
}

// The arrays of the library and what comes from operator new: both are seen.
void allocations_are_counted(void **) {
    const test::AllocationCount count;
    const plm::vector<double> of_the_library(10);
    const std::vector<double> other(10);
    assert_int_equal(count.so_far(), 2);
    assert_true(of_the_library.size() == other.size());
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(allocations_are_counted),
        cmocka_unit_test(an_iteration_allocates_nothing),
        cmocka_unit_test(more_iterations_allocate_no_more),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
