// Periodic motions by their events, against shooting with the exact flow: from instants that are a thousandth
// of the period off, and from a sequence that misses some.
#include "flows.hpp"
#include "orbits/event_motion.hpp"

using namespace test;

namespace {

plm::PeriodicOrbit orbit_of(plm::ExactFlow &flow) {
    plm::ShootingOptions o;
    o.transient_periods = 60;
    return plm::periodic_orbit(flow, {plm::vector<double>(4), plm::vector<double>(4), 0}, o);
}

plm::EventSequence events_of(const plm::PeriodicOrbit &orbit, double off) {
    plm::EventSequence sequence;
    sequence.first = orbit.contact_history.front().states;
    double time = 0;
    for (std::size_t k = 1; k < orbit.contact_history.size(); ++k) {
        const auto &before = orbit.contact_history[k - 1], &after = orbit.contact_history[k];
        time += before.duration;
        for (std::int64_t p = 0; p < after.states.size(); ++p)
            if (before.states.is_closed(p) != after.states.is_closed(p))
                sequence.events.push_back({time + (k % 2 ? off : -off), p});
    }
    return sequence;
}

struct Agreement {
    std::size_t n_events = 0;
    std::vector<double> shift; // of each step
    double state = 1e300, monodromy = 1e300;
    bool consistent = false;
};
Agreement against_shooting(double omega, const plm::GapMotion &walls = {}) {
    const auto model = flow_model(damped_chain(), walls);
    plm::ExactFlow flow(model, omega, 1);
    const plm::PeriodicOrbit orbit = orbit_of(flow);
    plm::EventSequence sequence = events_of(orbit, 1e-3 * flow.period());
    const Matrix everything;
    plm::EventMotion motion(*model, omega, 1, 1, everything);
    Agreement a;
    a.n_events = sequence.events.size();
    for (int k = 0; k < 5; ++k) {
        if (!motion.solve(sequence)) return a;
        a.shift.push_back(motion.shift());
        sequence = motion.moved(sequence);
    }
    a.state = 0;
    for (int j = 0; j < 4; ++j)
        a.state = std::max({a.state, std::abs(motion.start().y[j] - orbit.state.y[j]),
                            std::abs(motion.start().v[j] - orbit.state.v[j])});
    a.monodromy = max_difference(motion.monodromy(), plm::monodromy(*model, orbit.contact_history));
    a.consistent = motion.is_consistent();
    return a;
}
void events_lead_to_the_orbit(void **) {
    for (const auto &[omega, walls] : {std::pair(0.2, plm::GapMotion()), std::pair(0.4, plm::GapMotion()),
                                       std::pair(1.5, plm::GapMotion()), std::pair(0.4, moving_walls())}) {
        const Agreement a = against_shooting(omega, walls);
        std::printf("    omega %.1f, %zu events: %.0e %.0e %.0e; state %.0e, monodromy %.0e\n", omega,
                    a.n_events, a.shift.at(0), a.shift.at(1), a.shift.at(2), a.state, a.monodromy);
        assert_true(a.n_events >= 2);
        assert_true(a.shift[2] < a.shift[0] * a.shift[0]); // Newton's method
        assert_true(below(a.state, 1e-8) && below(a.monodromy, 1e-8));
        assert_true(a.consistent);
    }
}

bool agrees_without_a_pair(double omega) {
    const auto model = flow_model(damped_chain());
    plm::ExactFlow flow(model, omega, 1);
    plm::EventSequence sequence = events_of(orbit_of(flow), 0);
    auto &events = sequence.events;
    const std::int64_t left_out = events.front().pair;
    events.erase(std::remove_if(events.begin(), events.end(), [=](auto &e) { return e.pair == left_out; }),
                 events.end());
    const Matrix everything;
    plm::EventMotion motion(*model, omega, 1, 1, everything);
    return motion.solve(sequence) && motion.is_consistent();
}
void events_that_are_missing_are_seen(void **) {
    assert_false(agrees_without_a_pair(0.2));
    assert_false(agrees_without_a_pair(0.4));
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(events_lead_to_the_orbit),
        cmocka_unit_test(events_that_are_missing_are_seen),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
