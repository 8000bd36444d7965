// Bases of modes at rest and static contact snapshots against dense eigenproblems and dense static solutions.
#include "reduction/basis.hpp"
#include "sampling/small_models.hpp"
#include "support/test.hpp"
#include <algorithm>

using plm::Basis;
namespace basis_kinds = plm::basis_kinds;
using plm::BasisOptions;
using plm::Matrix;
using plm::Sampler;

namespace {

struct Case {
    exact::Structure structure;
    std::shared_ptr<const plm::Model> model;
    std::shared_ptr<const Sampler> sampler;
};

Case chains(bool pressed) {
    Case c;
    c.structure = test::two_chains(40, 9, 300, true);
    if (pressed) {
        c.structure.preload.assign(c.structure.n, 0.0);
        c.structure.preload[39] = 2;
        c.structure.preload[79] = -2;
    }
    c.model = test::make_model(c.structure);
    plm::SamplerOptions o;
    o.system = plm::LinearSystem::sliding;
    o.mode = 3;
    c.sampler = std::make_shared<Sampler>(c.model, o, plm::Watch());
    return c;
}

BasisOptions snapshots(std::int64_t n = 12) {
    BasisOptions o;
    o.kind = &basis_kinds::snapshots;
    o.n_snapshots = n;
    o.snapshot_tolerance = 1e-9;
    o.svd_tolerance = 1e-12;
    return o;
}

std::shared_ptr<const Basis> build(const Case &c, const BasisOptions &o) {
    return std::make_shared<Basis>(c.model, c.sampler, nullptr, o, plm::Watch());
}

// Static equilibrium over all DOFs: the closed set that its own solution confirms.
plm::vector<double> dense_static(const exact::Structure &s, const plm::vector<double> &load) {
    plm::PairStates states = plm::PairStates::all_closed(s.z);
    plm::vector<double> q;
    for (int iteration = 0; iteration < 100; ++iteration) {
        Matrix k = test::dense_stiffness(s, states);
        q = load;
        for (int p = 0; p < s.z; ++p)
            for (int i = 0; i < s.n && states.is_closed(p); ++i)
                q[i] += s.gap_rows[p * s.n + i] * s.contact_stiffness[p] * s.gap[p];
        plm::DenseCholesky cholesky;
        if (!cholesky.factor(k)) return {};
        cholesky.solve(q.data(), 1, s.n);
        plm::vector<double> penetration(s.z);
        for (int p = 0; p < s.z; ++p) {
            double u = -s.gap[p];
            for (int i = 0; i < s.n; ++i) u += s.gap_rows[p * s.n + i] * q[i];
            penetration[p] = u;
        }
        const plm::PairStates now = plm::states_at(penetration);
        if (now == states) return q;
        states = now;
    }
    return {};
}

// The largest part outside the basis (norm of M) of the modes of a contact set up to `highest` Hz.
double modes_outside(const Case &c, const Basis &basis, const plm::PairStates &states, double highest) {
    const plm::SymmetricEigen modes = test::dense_modes(c.structure, states);
    double worst = 0;
    std::int64_t n = 0;
    for (; n < modes.vectors.cols() && std::sqrt(modes.values[n]) <= 2 * M_PI * highest; ++n)
        worst = std::max(
            worst, plm::projection_residual(basis, false, true, plm::Field(modes.vectors.columns(n, 1))));
    return n > 0 ? worst : 1;
}

// The contact space is the structure to 1e-7 in its receptances; shapes follow to its root.
constexpr double space_error = 1e-4;

void modes_at_rest_lie_in_the_basis(void **) {
    const Case c = chains(true);
    const auto basis = build(c, snapshots());
    assert_true(
        below(modes_outside(c, *basis, c.sampler->rest().states, 5.5 * basis->window_max_hz()), space_error));
    assert_true(basis->report().n_rest_modes > 3);
    assert_true(basis->report().warnings.empty());
}

void static_contact_solutions_lie_in_the_basis(void **) {
    const Case c = chains(true);
    const auto basis = build(c, snapshots());
    plm::vector<double> size;
    for (double t : c.sampler->sweeps()[0].thresholds) size.push_back(std::abs(t));
    std::sort(size.begin(), size.end());
    const plm::DominantMode &d = c.sampler->dominant()[0];
    const double omega = 2 * M_PI * d.frequency_hz;
    const plm::Field shape = combine(c.sampler->space()->vectors, d.coordinates);
    BasisOptions modal;
    modal.kind = &basis_kinds::snapshots;
    modal.snapshot_tolerance = 0.49; // next to no snapshot is left: the solutions are not there then
    const auto without = build(c, modal);
    double outside = 0;
    for (double alpha : {-30.0, -0.3, 0.3, 30.0}) {
        plm::vector<double> load(c.structure.n);
        for (int i = 0; i < c.structure.n; ++i)
            load[i] = c.structure.preload[i] +
                      alpha * size[size.size() / 2] * omega * omega * c.structure.mass[i] * shape.at(i);
        const plm::vector<double> q = dense_static(c.structure, load);
        assert_int_equal(q.size(), c.structure.n);
        assert_true(below(plm::projection_residual(*basis, true, true, plm::Field(q)), space_error));
        if (std::abs(alpha) == 30.0)
            outside = std::max(outside, plm::projection_residual(*without, true, true, plm::Field(q)));
    }
    assert_true(outside > space_error);
}

// Without pre-load and gap only the sign of alpha counts: further snapshots would repeat the two there are.
void a_homogeneous_problem_has_two_snapshots(void **) {
    const Case c = chains(false);
    const auto few = build(c, snapshots(2)), many = build(c, snapshots(30));
    assert_int_equal(few->report().n_collected, many->report().n_collected);
    const double highest = 5.5 * few->window_max_hz();
    assert_true(below(modes_outside(c, *few, plm::PairStates::all_open(9), highest), space_error));
    assert_true(below(modes_outside(c, *few, plm::PairStates::all_closed(9), highest), space_error));
    const Case pressed = chains(true);
    assert_true(build(pressed, snapshots(2))->report().n_collected <
                build(pressed, snapshots(30))->report().n_collected);
}

void tolerance_and_rest_factor_set_the_size(void **) {
    const Case c = chains(true);
    BasisOptions o = snapshots(), coarse = o, low = o;
    coarse.snapshot_tolerance = 1e-2;
    low.rest_factor = 2;
    const auto fine = build(c, o);
    assert_true(build(c, coarse)->reduced()->size() < fine->reduced()->size());
    assert_true(build(c, low)->report().n_rest_modes < fine->report().n_rest_modes);
    assert_true(close_to(build(c, low)->report().highest_frequency_hz, 2 * fine->window_max_hz(), 1e-12));
}

// Two masses on a spring that lie on a stop by their weight: pulled up harder, they fly.
Case lying_masses() {
    Case c;
    exact::Structure &s = c.structure;
    s.n = 2, s.z = 1;
    s.mass = {1, 1};
    s.stiffness = {1, -1, -1, 1};
    s.damping.assign(4, 0.0);
    s.gap_rows = {-1, 0};
    s.contact_stiffness = {2};
    s.gap = {0};
    s.preload = {-1, -1};
    s.force = {0, 1};
    c.model = test::make_model(s);
    plm::SamplerOptions o;
    o.system = plm::LinearSystem::sliding;
    o.mode = 1;
    o.window_min_hz = 0.05, o.window_max_hz = 0.2;
    c.sampler = std::make_shared<Sampler>(c.model, o, plm::Watch());
    return c;
}

void solutions_that_do_not_exist_are_told(void **) {
    const auto basis = build(lying_masses(), snapshots());
    assert_true(basis->report().warnings.text().find("static contact solutions do not exist") !=
                std::string::npos);
    assert_int_equal(basis->reduced()->size(), 2);
}

void it_needs_a_sampler(void **) {
    const Case c = chains(true);
    const test::Failure f =
        test::failure_of([&] { Basis(c.model, nullptr, nullptr, snapshots(), plm::Watch()); });
    assert_int_equal(f.status, plm::status::state);
    assert_string_equal(f.argument.c_str(), "sampler");
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(modes_at_rest_lie_in_the_basis),
        cmocka_unit_test(static_contact_solutions_lie_in_the_basis),
        cmocka_unit_test(a_homogeneous_problem_has_two_snapshots),
        cmocka_unit_test(tolerance_and_rest_factor_set_the_size),
        cmocka_unit_test(solutions_that_do_not_exist_are_told),
        cmocka_unit_test(it_needs_a_sampler),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
