// Modes of one frequency, of which an eigensolver returns whatever rounding picks: what is taken from them
// follows from the structure. And what else is taken for the dominant mode where several could be.
#include "sampling/mode_clusters.hpp"
#include "sampling/sampler.hpp"
#include "support/spring_models.hpp"
#include "support/test.hpp"
#include <algorithm>
#include <cmath>

using plm::LinearSystem;
using plm::Sampler;
using plm::SamplerOptions;

namespace {

std::shared_ptr<const Sampler> run(const plm::ModelInput &in, const SamplerOptions &o = {}) {
    return std::make_shared<const Sampler>(test::build(in), o, plm::Watch());
}

void load(plm::ModelInput &in, const std::vector<double> &force, int harmonic = 1) {
    in.excitation[harmonic].real.assign(force.begin(), force.end());
}

void the_first_of_a_cluster_has_all_that_is_seen(void **) {
    plm::SpaceModes modes;
    modes.values = {1, 4, 4 * (1 + 1e-9), 4 * (1 + 2e-9), 9};
    modes.vectors.reset(5, 5);
    for (int j = 0; j < 5; ++j) modes.vectors(j, j) = 1;
    plm::Matrix row(1, 5), further(1, 5);
    row(0, 0) = 7, row(0, 1) = 3, row(0, 2) = 4; // of the cluster: 3, 4, 0
    further(0, 3) = 2;
    plm::align_clusters({&row, &further}, modes);
    const plm::Matrix seen = product('N', 'N', row, modes.vectors),
                      then = product('N', 'N', further, modes.vectors);
    const double want[] = {7, 5, 0, 0, 0}, left[] = {0, 0, 2, 0, 0};
    for (int j = 0; j < 5; ++j) {
        assert_true(near(std::abs(seen(0, j)), want[j], 1e-14));
        assert_true(near(std::abs(then(0, j)), left[j], 1e-14));
    }
    assert_int_equal(plm::cluster_end(modes.values, 1), 4);
    const plm::vector<double> free = {-6e-13, -1e-38, 0, 800}; // rounding leaves them on either side of zero
    std::int64_t clusters = 0;
    for (std::int64_t first = 0; first < 4; first = plm::cluster_end(free, first))
        assert_true(++clusters <= 4);
}

// Two planes of one chain of three masses, axes turned by `axes`; the force at 45 degrees to the stop.
plm::ModelInput shaft(double axes) {
    const int n = 3;
    test::Dense k = test::diagonal(2 * n, 0);
    for (int plane = 0; plane < 2; ++plane)
        for (int i = 0; i < n; ++i) {
            const int a = 2 * i + plane;
            k[a][a] += 1e4;
            if (i > 0) k[a - 2][a - 2] += 1e4, k[a][a - 2] -= 1e4, k[a - 2][a] -= 1e4;
        }
    plm::ModelInput in = test::input(test::diagonal(2 * n, 1), k); // the same in any axes
    in.damping.modal_ratio = {0.01};
    test::add_pair(in, {0, 0, 0, 0, std::cos(axes), -std::sin(axes)}, 5e4, 1e-3);
    load(in, {0, 0, 0, 0, std::cos(axes + M_PI / 4), -std::sin(axes + M_PI / 4)});
    return in;
}

// phi of the tip of a fixed-free chain of n unit masses, mode j = 1, 2, ...
double tip_of_chain(int n, int j) {
    const double theta = (2 * j - 1) * M_PI / (2 * n + 1);
    double norm = 0;
    for (int i = 1; i <= n; ++i) norm += std::pow(std::sin(i * theta), 2);
    return std::sin(n * theta) / std::sqrt(norm);
}

// The mode along the force moves the stop by cos 45 degrees of the tip's motion, whatever the axes.
void the_dominant_mode_of_a_shaft_lies_along_its_force(void **) {
    for (double axes : {0.0, 0.3, 1.0, 2.5}) {
        const auto s = run(shaft(axes));
        assert_true(near(s->dominant()[0].mode_penetration[0], tip_of_chain(3, 1) * std::sqrt(0.5), 1e-9));
        assert_int_equal(s->dominant()[0].mode, 1);
        assert_true(
            close_to(s->dominant()[0].frequency_hz, 100 * 2 * std::sin(M_PI / 14) / (2 * M_PI), 1e-9));
        const plm::MacRow &open = s->window().mac[1]; // the half cycle without contact
        assert_true(near(open.mac[0], 1, 1e-9) && near(open.mac[1], 0, 1e-9));
        assert_false(s->warnings().has(plm::reason::lost_mode));
    }
}

// A rotating force has no direction: still a vector, and one of unit length.
void a_rotating_force_is_no_trouble(void **) {
    plm::ModelInput in = shaft(0);
    load(in, {0, 0, 0, 0, 1, 0});
    in.excitation[1].imag = {0, 0, 0, 0, 0, 1};
    const auto s = run(in);
    assert_true(near(plm::norm2(s->space()->size(), s->dominant()[0].coordinates.data()), 1, 1e-9));
}

// Two masses on springs of their own, each beside a stop, driven so that their responses are 1 to `ratio`.
plm::ModelInput two_alike(double ratio) {
    plm::ModelInput in = test::input(test::diagonal(2, 1), test::diagonal(2, 1e4));
    in.stiffness = test::matrix({{1e4, 0}, {0, 4e4}});
    in.damping.modal_ratio = {0.01};
    test::add_pair(in, {1, 0}, 1e5, 1e-4);
    test::add_pair(in, {0, 1}, 4e5, 1e-4);
    load(in, {1, 4 * ratio});
    return in;
}

void resonances_driven_alike_are_both_named(void **) {
    const double low = 100 / (2 * M_PI), high = 200 / (2 * M_PI);
    for (double ratio : {0.97, 1.0, 1 + 1e-9, 1.02}) {
        const auto s = run(two_alike(ratio));
        assert_true(s->warnings().has(plm::reason::tie));
        const std::string text = s->warnings().text();
        assert_true(text.find(plm::format("%.6g Hz", low)) != std::string::npos &&
                    text.find(plm::format("%.6g Hz", high)) != std::string::npos);
        const double want = ratio > 1.01 ? high : low; // of equal ones the lower
        assert_true(close_to(s->dominant()[0].frequency_hz, want, 1e-9));
    }
    assert_false(run(two_alike(0.9))->warnings().has(plm::reason::tie));
    SamplerOptions o; // who names one has no choice to make
    o.mode_frequency_hz = high;
    assert_false(run(two_alike(1), o)->warnings().has(plm::reason::tie));
}

// A structure of 100 rad/s within, on a soft spring: it moves most at 5 rad/s, and its contact does not.
void soft_supports_are_not_proposed(void **) {
    test::Dense k = test::free_chain(2, 5e3);
    k[0][0] += 2 * 1.5 * 1.5;
    plm::ModelInput in = test::input(test::diagonal(2, 1), k);
    in.damping.modal_ratio = {0.01};
    test::add_pair(in, {1, -1}, 1e5, 1e-4);
    load(in, {1, 0});
    const auto s = run(in);
    assert_int_equal(s->dominant()[0].mode, 2);
    assert_false(s->warnings().has(plm::reason::lost_mode));
    load(in, {1, 1 + 1e-4}); // driven alone, as good as, it is taken all the same
    SamplerOptions o;
    o.mode = 1;
    assert_int_equal(run(in, o)->dominant()[0].mode, 1);
}

// Half of the rows closed at rest hold the gears together; open, they only turn.
void backlash_under_torque_vibrates_on_the_flank_that_carries(void **) {
    const double r = 0.1, inertia = 0.01, k_n = 1e7;
    plm::ModelInput in = test::input(test::diagonal(2, inertia), test::diagonal(2, 0));
    in.damping.alpha = 100;
    test::add_pair(in, {r, -r}, k_n, 5e-5);
    test::add_pair(in, {-r, r}, k_n, 5e-5);
    in.preload = {20, -20};
    load(in, {10, -10});
    const auto s = run(in);
    const double mesh = std::sqrt(2 * k_n * r * r / inertia) / (2 * M_PI);
    assert_true(s->dominant()[0].system == LinearSystem::rest);
    assert_true(close_to(s->dominant()[0].frequency_hz, mesh, 1e-6));
    SamplerOptions o;
    o.system = LinearSystem::rest;
    assert_true(close_to(run(in, o)->dominant()[0].frequency_hz, mesh, 1e-6));
}

// Excited at twice the frequency of the period alone, the resonance comes at half of its frequency.
void the_window_is_that_of_the_harmonic_that_drives(void **) {
    plm::ModelInput once = test::input({{1}}, {{1e4}});
    once.damping.modal_ratio = {0.01};
    test::add_pair(once, {1}, 1e4, 1e-3);
    plm::ModelInput twice = once;
    load(once, {1});
    load(twice, {0}, 1);
    load(twice, {1}, 2);
    const auto one = run(once), two = run(twice);
    assert_int_equal(two->dominant()[0].harmonic, 2);
    assert_true(close_to(2 * two->window().min_hz, one->window().min_hz, 1e-12));
    assert_true(close_to(2 * two->window().max_hz, one->window().max_hz, 1e-12));
    assert_int_equal(two->n_harmonics(), 2 * one->n_harmonics());
}

// Of a fixed-free chain of three, 2 % off each of its frequencies.
void a_frequency_names_the_nearest_mode(void **) {
    test::Dense k = test::free_chain(3, 1e4);
    k[0][0] += 1e4;
    plm::ModelInput in = test::input(test::diagonal(3, 1), k);
    in.damping.modal_ratio = {0.01};
    test::add_pair(in, {0, 0, 1}, 5e4, 1e-3);
    load(in, {0, 0, 1});
    for (int mode : {1, 2, 3})
        for (double off : {0.98, 1.02}) {
            SamplerOptions o;
            o.system = LinearSystem::open;
            o.mode_frequency_hz = off * 2 * 100 * std::sin((2 * mode - 1) * M_PI / 14) / (2 * M_PI);
            assert_int_equal(run(in, o)->dominant()[0].mode, mode);
        }
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(the_first_of_a_cluster_has_all_that_is_seen),
        cmocka_unit_test(the_dominant_mode_of_a_shaft_lies_along_its_force),
        cmocka_unit_test(a_rotating_force_is_no_trouble),
        cmocka_unit_test(resonances_driven_alike_are_both_named),
        cmocka_unit_test(soft_supports_are_not_proposed),
        cmocka_unit_test(backlash_under_torque_vibrates_on_the_flank_that_carries),
        cmocka_unit_test(the_window_is_that_of_the_harmonic_that_drives),
        cmocka_unit_test(a_frequency_names_the_nearest_mode),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
