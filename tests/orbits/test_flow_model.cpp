// One set of coordinates for what harmonic balance keeps in two: against the same quantities over the DOFs.
#include "flows.hpp"
#include "orbits/recorded_motion.hpp"
#include "reduction/projection.hpp"
#include "space/rest.hpp"

using namespace test;

namespace {

// Two chains under pre-load, few dynamic coordinates, so that the rest displacement is a direction of its
// own.
std::shared_ptr<const plm::ReducedModel> reduced_with_static(const ModelExtras &extras) {
    exact::Structure s = two_chains(8, 3, 5, true);
    s.preload[7] = 0.7;
    s.preload[3] = -0.4;
    const auto model = make_model(s, extras);
    const auto space = plm::make_contact_space(model, 3.0, 10, plm::Watch());
    Matrix first(space->size(), 4);
    for (int j = 0; j < 4; ++j) first(j, j) = 1;
    const plm::Coordinates dynamic = plm::diagonalise(*space, first);
    return plm::project(*space, dynamic,
                        plm::make_static_basis(*space, dynamic, plm::rest_of(*space)->coordinates));
}

// q and q' over the DOFs from P_0 and P themselves.
double state_error() {
    const auto r = reduced_with_static({});
    if (r->same_static) return 1e300;
    const plm::FlowModel m(r);
    const double omega = 1.7, fraction = 0.3;
    plm::vector<double> eta_0(r->static_size());
    Matrix eta(r->size(), 4);
    for (std::size_t j = 0; j < eta_0.size(); ++j) eta_0[j] = std::cos(1.0 + j);
    for (std::int64_t k = 0; k < 4 * r->size(); ++k) eta.data()[k] = std::sin(0.7 * k + 0.2);
    const FlowState x = m.state(eta_0, eta, omega, fraction);
    const plm::Field q = m.field(x.y), v = m.field(x.v);
    double worst = std::abs(x.time - fraction * 2 * M_PI / omega);
    for (std::int64_t i = 0; i < r->vectors.rows(); ++i) {
        double want_q = 0, want_v = 0;
        for (std::size_t j = 0; j < eta_0.size(); ++j) want_q += r->vectors_0.formed().at(i, j) * eta_0[j];
        for (int h = 1; h <= 2; ++h)
            for (std::int64_t j = 0; j < r->size(); ++j) {
                const double t = 2 * M_PI * h * fraction, a = eta(j, 2 * h - 2), b = eta(j, 2 * h - 1);
                want_q += r->vectors.formed().at(i, j) * (a * std::cos(t) + b * std::sin(t));
                want_v += r->vectors.formed().at(i, j) * h * omega * (b * std::cos(t) - a * std::sin(t));
            }
        worst = std::max({worst, std::abs(q.at(i) - want_q), std::abs(v.at(i) - want_v)});
        worst = std::max(worst, std::abs(plm::dot(m.size(), m.dof_row(i).data(), x.y.data()) - want_q));
    }
    return worst;
}
void a_harmonic_solution_becomes_a_state(void **) {
    assert_true(below(state_error(), 1e-12));
}

// Loads and explicit damping are those of the model on P_0, whatever P carries.
double projection_error(const ModelExtras &extras) {
    const auto r = reduced_with_static(extras);
    if (r->same_static) return 1e300;
    const plm::FlowModel m(r);
    const plm::Model &model = *r->model;
    double worst = 0;
    plm::vector<double> load(m.size());
    plm::gemv('T', 1.0, r->vectors_0.formed().in_core(), model.excitation().at(1).real.in_core().data(), 0.0,
              load.data());
    for (std::int64_t j = 0; j < m.size(); ++j)
        worst = std::max(worst, std::abs(load[j] - m.excitation().at(1).real[j]));
    plm::SparseMatrix c =
        plm::add(extras.alpha, model.matrices().mass, extras.beta, model.matrices().stiffness);
    if (extras.explicit_damping) c = plm::add(1.0, c, 1.0, model.matrices().damping);
    const Matrix want = plm::product('T', 'N', r->vectors_0.formed().in_core(),
                                     plm::multiply(c, r->vectors_0.formed().in_core()));
    for (std::int64_t j = 0; j < m.size(); ++j)
        for (std::int64_t i = 0; i < m.size(); ++i) {
            const double got =
                m.has_diagonal_damping() ? (i == j ? m.damping_diagonal()[i] : 0) : m.damping()(i, j);
            worst = std::max(worst, std::abs(got - want(i, j)));
        }
    return worst;
}
void loads_and_damping_are_projected(void **) {
    ModelExtras rayleigh, matrix;
    rayleigh.alpha = matrix.alpha = 0.1;
    rayleigh.beta = matrix.beta = 0.02;
    matrix.explicit_damping = true;
    assert_true(below(projection_error(rayleigh), 1e-10));
    assert_true(below(projection_error(matrix), 1e-10));
}

// C = sum 2 zeta omega (M phi)(M phi)^T over all modes of the structure, by their eigenvectors.
Matrix modal_damping_matrix(const plm::Model &model, const std::vector<double> &ratio) {
    const std::int64_t n = model.n_free();
    Matrix one(n, n);
    for (std::int64_t i = 0; i < n; ++i) one(i, i) = 1;
    const Matrix m = plm::multiply(model.matrices().mass, one); // diagonal
    Matrix k = plm::multiply(model.matrices().stiffness, one);
    for (std::int64_t j = 0; j < n; ++j)
        for (std::int64_t i = 0; i < n; ++i) k(i, j) /= std::sqrt(m(i, i) * m(j, j));
    const plm::SymmetricEigen e = plm::symmetric_eigen(k);
    Matrix scaled = e.vectors;
    for (std::int64_t j = 0; j < n; ++j) {
        const double zeta = ratio[std::min<std::size_t>(static_cast<std::size_t>(j), ratio.size() - 1)];
        for (std::int64_t i = 0; i < n; ++i) scaled(i, j) *= 2 * zeta * std::sqrt(e.values[j]);
    }
    Matrix c = plm::product('N', 'T', scaled, e.vectors);
    for (std::int64_t j = 0; j < n; ++j)
        for (std::int64_t i = 0; i < n; ++i) c(i, j) *= std::sqrt(m(i, i) * m(j, j));
    return c;
}

// Ratios of the structure's modes damp the static directions as they damp the structure.
double modal_damping_error() {
    ModelExtras extras;
    extras.modal_ratio = {0.01, 0.02, 0.03};
    const auto r = reduced_with_static(extras);
    if (r->same_static) return 1e300;
    const plm::FlowModel m(r);
    const Matrix c = modal_damping_matrix(*r->model, extras.modal_ratio);
    const auto &p_0 = r->vectors_0.formed().in_core();
    const Matrix want = plm::product('T', 'N', p_0, plm::product('N', 'N', c, p_0));
    double worst = 0, size = 0;
    for (std::int64_t j = 0; j < m.size(); ++j)
        for (std::int64_t i = 0; i < m.size(); ++i) {
            const double got =
                m.has_diagonal_damping() ? (i == j ? m.damping_diagonal()[i] : 0) : m.damping()(i, j);
            worst = std::max(worst, std::abs(got - want(i, j)));
            size = std::max(size, std::abs(want(i, j)));
        }
    return worst / size;
}
void modal_damping_is_that_of_the_structure(void **) {
    assert_true(below(modal_damping_error(), 1e-10));
}

// Structural damping by its equivalent: at resonance the amplitude is the same, F / (eta k).
double structural_amplitude_error() {
    auto r = std::const_pointer_cast<plm::ReducedModel>(
        std::shared_ptr<const plm::ReducedModel>(reduce_exactly(bilinear_oscillator(0, 1, 1e30, 1, 0))));
    r->structural = 0.04;
    const auto m = std::make_shared<plm::FlowModel>(r, 1.0);
    plm::ExactFlow flow(m, 1.0, 1);
    const plm::PeriodicOrbit orbit = plm::periodic_orbit(flow, {{0}, {0}, 0});
    Matrix row(1, 1);
    row(0, 0) = 1;
    return std::abs(plm::orbit_peaks(flow, orbit.state, orbit.period_multiple, row)[0] * 0.04 - 1);
}
void structural_damping_loses_the_same_energy(void **) {
    assert_true(below(structural_amplitude_error(), 1e-12));
    const Failure f = failure_of([] {
        auto r = reduce_exactly(bilinear_oscillator(0, 1, 1e30, 1, 0));
        r->structural = 0.04;
        plm::FlowModel m(r);
    });
    assert_int_equal(f.status, plm::status::argument);
    assert_string_equal(f.argument.c_str(), "omega");
}

// Static equilibrium of P_0 is a fixed point of the flow: nothing moves under the pre-load alone.
double motion_at_rest() {
    ModelExtras extras;
    extras.beta = 0.02;
    const auto r = reduced_with_static(extras);
    const auto m = std::make_shared<plm::FlowModel>(r);
    const plm::StaticState rest = plm::solve_static({r->lambda_0, r->gap_0, r->preload_0, r->contact});
    plm::ExactFlow flow(m, 1.7, 0);
    FlowState x{rest.coordinates, plm::vector<double>(m->size()), 0};
    flow.advance(x, 3 * flow.period());
    double worst = 0;
    for (std::int64_t j = 0; j < m->size(); ++j)
        worst = std::max({worst, std::abs(x.y[j] - rest.coordinates[j]), std::abs(x.v[j])});
    return worst;
}
void rest_stays_at_rest(void **) {
    assert_true(below(motion_at_rest(), 1e-12));
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(a_harmonic_solution_becomes_a_state),
        cmocka_unit_test(loads_and_damping_are_projected),
        cmocka_unit_test(modal_damping_is_that_of_the_structure),
        cmocka_unit_test(structural_damping_loses_the_same_energy),
        cmocka_unit_test(rest_stays_at_rest),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
