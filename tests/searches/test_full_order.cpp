// The whole chain below the C API - model, contact space, basis "full", harmonic balance, recovery - against
// exact periodic orbits of the same structure.
#include "reduction/basis.hpp"
#include "sampling/small_models.hpp"
#include "searches/hbm.hpp"
#include "support/test.hpp"
#include <algorithm>

namespace {

constexpr int n_chain = 6;

// Two chains of six masses with contacts between their last three; one end driven, both pressed together a
// little.
exact::Structure structure() {
    exact::Structure s = test::two_chains(n_chain, 3, 3.0, true);
    const double first = 0.24; // about the lowest frequency
    s.damping = s.stiffness;
    for (double &c : s.damping) c *= 2 * 0.05 / first;
    s.force.assign(s.n, 0.0);
    s.force[n_chain - 1] = 0.02;
    s.preload.assign(s.n, 0.0);
    s.preload[n_chain - 1] = 0.005;
    return s;
}

struct Solved {
    std::int64_t unknowns = 0;
    double full_residual = 0;
    std::vector<double> errors; // of the amplitude of the driven DOF, one per frequency
};

Solved errors_against_exact_orbits(const plm::BasisKind *kind) {
    const exact::Structure s = structure();
    const auto model = test::make_model(s, {{}, 0, 2 * 0.05 / 0.24, false});
    plm::BasisOptions b;
    b.kind = kind;
    b.frequency_min_hz = 0.015;
    b.frequency_max_hz = 0.18;
    b.n_harmonics = 20;
    const plm::Basis basis(model, nullptr, nullptr, b, plm::Watch());
    plm::HbmOptions o;
    o.n_harmonics = 20;
    const plm::Hbm hbm(basis.reduced(), 0.015, 0.18, o, plm::Watch());
    Solved out;
    out.unknowns = basis.reduced()->size();
    for (double omega : {0.15, 0.24, 0.4, 0.6, 0.9}) {
        const auto branch = hbm.solve(omega / (2 * M_PI), nullptr, 0);
        std::vector<double> state(2 * s.n);
        const plm::Field q = branch->field(0, 0.0);
        const double step = 1e-6; // velocity by central differences of the recovered field
        const plm::Field later = branch->field(0, step), sooner = branch->field(0, -step);
        for (int i = 0; i < s.n; ++i) {
            state[i] = q.at(i);
            state[s.n + i] = (later.at(i) - sooner.at(i)) / (2 * step) * omega / (2 * M_PI);
        }
        const exact::Orbit orbit = exact::periodic_orbit(s, omega, state, 0, 200);
        const double got = branch->amplitude(0, n_chain - 1, plm::Measure::peak, 0);
        out.errors.push_back(orbit.converged ? std::abs(got / orbit.peak(n_chain - 1) - 1) : 1e300);
        out.full_residual = std::max(out.full_residual, branch->full_residual(0));
    }
    return out;
}

void print(const char *what, const Solved &s) {
    std::printf("    %s, %d unknowns per coefficient, residual in the full equations %.1e; errors:", what,
                static_cast<int>(s.unknowns), s.full_residual);
    for (double e : s.errors) std::printf(" %.1e", e);
    std::printf("\n");
}

void full_order_agrees_with_exact_time_marching(void **) {
    const Solved s = errors_against_exact_orbits(&plm::basis_kinds::full);
    print("full order", s);
    for (double e : s.errors) assert_true(below(e, 1e-3));
    assert_true(
        below(s.full_residual, 1e-6)); // the contact space's tolerance of 1e-7, with an amplified part
}

void craig_bampton_agrees_with_exact_time_marching(void **) {
    const Solved s = errors_against_exact_orbits(&plm::basis_kinds::craig_bampton);
    print("Craig-Bampton", s);
    for (double e : s.errors) assert_true(below(e, 1e-2)); // truncated fixed-interface modes
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(full_order_agrees_with_exact_time_marching),
        cmocka_unit_test(craig_bampton_agrees_with_exact_time_marching),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
