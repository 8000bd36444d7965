// Structures whose rigid-body motion neither supports nor contact hold, against the same ones held: a pair of
// masses in free flight moves relative to each other like one of the reduced mass on a support.
#include "contact/trig_polynomial.hpp"
#include "searches/hbm.hpp"
#include "support/small_reduced.hpp"
#include "support/test.hpp"
#include <complex>
#include <cstring>
#include <string>

using plm::NonlinearUnknowns;

namespace {

using Model = std::shared_ptr<plm::ReducedModel>;

constexpr double left = 1, right = 3, spring = 1, damping = 0.03, contact = 0.8, gap = 0.5, force = 1;

// q = (left mass, right mass), pushed on the left; joined by the spring and by a stop.
Model in_free_flight() {
    exact::Structure s;
    s.n = 2, s.z = 1;
    s.mass = {left, right};
    s.stiffness = {spring, -spring, -spring, spring};
    s.damping = {damping * left, 0, 0, damping * right}; // of each mass: the relative motion stays apart
    s.gap_rows = {1, -1};
    s.contact_stiffness = {contact};
    s.gap = {gap};
    s.force = {force, 0};
    Model m = test::reduce_exactly(s);
    m->lambda[0] = m->lambda_0[0] = 0; // rounding of the eigenproblem
    return m;
}

Model on_a_support() {
    const double mass = left * right / (left + right);
    exact::Structure s;
    s.n = s.z = 1;
    s.mass = {mass};
    s.stiffness = {spring};
    s.damping = {damping * mass};
    s.gap_rows = {1};
    s.contact_stiffness = {contact};
    s.gap = {gap};
    s.force = {force * mass / left};
    return test::reduce_exactly(s);
}

plm::Hbm solver(Model m, NonlinearUnknowns unknowns) {
    plm::HbmOptions o;
    o.n_harmonics = 9;
    o.unknowns = unknowns;
    return plm::Hbm(std::move(m), 1.0 / (2 * M_PI), 1.6 / (2 * M_PI), o, plm::Watch());
}

double stroke(const plm::ReducedModel &m, const plm::BranchPoint &p) {
    const std::int64_t n = p.eta.cols();
    plm::vector<double> u(n + 1, 0.0);
    for (std::int64_t j = 0; j < m.size(); ++j) {
        u[0] += m.gap_0(0, j) * p.eta_0[j];
        for (std::int64_t c = 0; c < n; ++c) u[c + 1] += m.gap(0, j) * p.eta(j, c);
    }
    const plm::ValueRange r = plm::trig_range(u.data(), n / 2);
    return r.maximum - r.minimum;
}

void free_flight_is_the_motion_of_the_reduced_mass(void **) {
    const Model free = in_free_flight(), held = on_a_support();
    for (NonlinearUnknowns unknowns : {NonlinearUnknowns::modal, NonlinearUnknowns::gaps})
        for (double omega : {1.05, 1.2, 1.3, 1.4, 1.55}) {
            const double hz = omega / (2 * M_PI);
            const auto a = solver(free, unknowns).solve(hz, nullptr, 0),
                       b = solver(held, NonlinearUnknowns::modal).solve(hz, nullptr, 0);
            const double want = stroke(*held, b->points()[0]);
            assert_true(want > 2 * gap);                                      // the stop is met
            assert_true(close_to(stroke(*free, a->points()[0]), want, 1e-8)); // Newton's tolerance is 1e-9
            // the common motion: of both masses under the force, about the mean position zero
            assert_true(std::abs(a->points()[0].eta_0[0]) < 1e-12);
            const std::complex<double> drag(-omega * omega, omega * damping),
                common = force / (left + right) / drag;
            double centre[2] = {0, 0};
            for (int c = 0; c < 2; ++c)
                for (std::int64_t j = 0; j < free->size(); ++j)
                    centre[c] +=
                        (left * free->vectors.formed().at(0, j) + right * free->vectors.formed().at(1, j)) /
                        (left + right) * a->points()[0].eta(j, c);
            assert_true(close_to(std::hypot(centre[0], centre[1]), std::abs(common), 1e-8));
        }
}

void its_sweep_is_stable_and_whole(void **) {
    for (NonlinearUnknowns unknowns :
         {NonlinearUnknowns::automatic, NonlinearUnknowns::modal, NonlinearUnknowns::gaps}) {
        const auto curve = solver(in_free_flight(), unknowns).sweep();
        assert_int_equal(curve->end_reason, plm::reason::range_end);
        for (const plm::BranchPoint &p : curve->points())
            assert_true(plm::stability_of(p) == 1 && p.bifurcation == plm::bifurcation::none);
    }
}

void refused(const Model &m) {
    for (NonlinearUnknowns unknowns : {NonlinearUnknowns::automatic, NonlinearUnknowns::gaps}) {
        bool thrown = false;
        try {
            solver(m, unknowns).sweep();
        } catch (const plm::Error &e) {
            thrown = e.reason() == plm::reason::no_equilibrium && std::strstr(e.what(), "rigid-body motion");
        }
        assert_true(thrown);
    }
}

void loads_that_would_carry_it_away_are_refused(void **) {
    const Model pushed = in_free_flight(), blown = in_free_flight();
    pushed->preload_0[0] = 1e-3;
    refused(pushed);
    blown->excitation[0].real = {1e-3, 0};
    refused(blown);
    // a balanced pre-load only presses the masses on each other
    const Model pressed = in_free_flight();
    pressed->preload_0[1] = 0.2;
    assert_int_equal(solver(pressed, NonlinearUnknowns::automatic).sweep()->end_reason,
                     plm::reason::range_end);
}

// The pair of masses beside a wall: no spring but the stop would ever hold it.
Model beside_a_wall(double wall) {
    Model m = in_free_flight();
    for (std::int64_t j = 0; j < m->size(); ++j) m->gap(0, j) = m->gap_0(0, j) = m->vectors.formed().at(1, j);
    m->contact.initial_gap[0] = wall;
    return m;
}

// Out of reach: the linear motion about the place where the model stands, wherever the sweep begins.
// X = F / (m1 + m2) / (-w^2 + i w c) for the centre, and for the right mass less what the spring makes of it.
double right_mass_without_wall(double omega) {
    const std::complex<double> d1(spring - left * omega * omega, omega * damping * left),
        d2(spring - right * omega * omega, omega * damping * right);
    return std::abs(force * spring / (d1 * d2 - spring * spring)); // Cramer's rule
}
struct Wall {
    double mean = 0, amplitude = 0, stable = 1;
    std::int32_t reason = 0;
};
Wall swept_beside_a_wall(NonlinearUnknowns unknowns) {
    const Model m = beside_a_wall(20);
    const auto curve = solver(m, unknowns).sweep();
    Wall w;
    w.reason = curve->end_reason;
    for (const plm::BranchPoint &p : curve->points()) {
        const auto q = test::displacement(*m, p.eta_0, p.eta, 1);
        w.mean = std::max(w.mean, std::abs(q[0]));
        w.amplitude =
            std::max(w.amplitude, std::abs(std::hypot(q[1], q[2]) / right_mass_without_wall(p.omega) - 1));
        if (plm::stability_of(p) != 1) w.stable = 0;
    }
    return w;
}
void a_stop_out_of_reach_leaves_the_mean_position_at_zero(void **) {
    for (NonlinearUnknowns unknowns :
         {NonlinearUnknowns::automatic, NonlinearUnknowns::modal, NonlinearUnknowns::gaps}) {
        const Wall w = swept_beside_a_wall(unknowns);
        assert_int_equal(w.reason, plm::reason::range_end);
        assert_true(below(w.mean, 1e-9));      // of amplitudes near 1
        assert_true(below(w.amplitude, 1e-7)); // Newton's tolerance is 1e-9 of the force
        assert_true(w.stable == 1);
    }
}

// Within reach: the wall pushes, and nothing pushes back, until it is touched no more. The linear motion
// again, as far away as it has to be.
double reach_beside_a_near_wall(NonlinearUnknowns unknowns, double omega) {
    const Model m = beside_a_wall(0.1);
    const auto alone = solver(m, unknowns).solve(omega / (2 * M_PI), nullptr, 0);
    const auto q = test::displacement(*m, alone->points()[0].eta_0, alone->points()[0].eta, 1);
    return q[0] + right_mass_without_wall(omega); // the furthest place
}
void a_wall_pushes_it_out_of_its_reach(void **) {
    for (NonlinearUnknowns unknowns : {NonlinearUnknowns::modal, NonlinearUnknowns::gaps})
        for (double omega : {1.05, 1.3, 1.5})
            assert_true(close_to(reach_beside_a_near_wall(unknowns, omega), 0.1, 1e-6));
}

// A mean force away from the wall: nothing ever holds it.
std::string said_of_a_mean_force_away(NonlinearUnknowns unknowns) {
    const Model m = beside_a_wall(0.1);
    m->excitation[0].real = {m->vectors.formed().at(1, 0) > 0 ? -0.1 : 0.1, 0};
    try {
        solver(m, unknowns).solve(1.3 / (2 * M_PI), nullptr, 0);
    } catch (const plm::Error &e) {
        return e.what();
    }
    return "";
}
void a_mean_force_away_from_the_wall_is_told_of(void **) {
    for (NonlinearUnknowns unknowns : {NonlinearUnknowns::modal, NonlinearUnknowns::gaps}) {
        const std::string said = said_of_a_mean_force_away(unknowns);
        assert_true(said.find("nothing but its contacts holds") != std::string::npos);
    }
}

// A mean force towards the wall holds it there: nothing is held at zero then, whichever way the search goes.
void a_mean_force_presses_it_against_the_wall(void **) {
    const Model m = beside_a_wall(0.1);
    m->preload_0[0] =
        2 / std::sqrt(left + right) * (m->vectors.formed().at(1, 0) > 0 ? 1 : -1); // 2 on the centre of mass
    for (NonlinearUnknowns unknowns : {NonlinearUnknowns::modal, NonlinearUnknowns::gaps}) {
        const auto one = solver(m, unknowns).solve(1.6 / (2 * M_PI), nullptr, 0);
        const auto q = test::displacement(*m, one->points()[0].eta_0, one->points()[0].eta, 1);
        assert_true(close_to(contact * (q[0] - 0.1), 2, 0.2)); // closed for most of the time
    }
}

} // namespace

int main() {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(free_flight_is_the_motion_of_the_reduced_mass),
        cmocka_unit_test(its_sweep_is_stable_and_whole),
        cmocka_unit_test(loads_that_would_carry_it_away_are_refused),
        cmocka_unit_test(a_stop_out_of_reach_leaves_the_mean_position_at_zero),
        cmocka_unit_test(a_wall_pushes_it_out_of_its_reach),
        cmocka_unit_test(a_mean_force_away_from_the_wall_is_told_of),
        cmocka_unit_test(a_mean_force_presses_it_against_the_wall),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
