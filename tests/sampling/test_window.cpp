// MAC, bilinear frequency and the two cases of the frequency window (paper, 2.3.2).
#include "sampling/frequency_window.hpp"
#include "sampling/mode_match.hpp"
#include "sampling/sampler.hpp"
#include "small_models.hpp"
#include "support/small_reduced.hpp"
#include "support/test.hpp"
#include <limits>

using plm::FrequencyWindow;
using plm::SamplerOptions;

namespace {

const double hz = 1 / (2 * M_PI);

FrequencyWindow window_of(const exact::Structure &s, const SamplerOptions &o,
                          test::Recorder *recorder = nullptr) {
    return plm::Sampler(test::make_model(s), o, plm::Watch(recorder)).window();
}

exact::Structure chain_with_preload() {
    return test::chain(8, 0.01, 40, 0, 1, -0.5, {1, 4, 7});
}

// Frequency of the system closed as at rest whose mode resembles the dominant one best, over all DOFs.
double dense_rest_frequency(const plm::Sampler &sampler, const exact::Structure &s) {
    const plm::SymmetricEigen modes = test::dense_modes(s, sampler.rest().states);
    const plm::Field shape = combine(sampler.space()->vectors, sampler.dominant()[0].coordinates);
    plm::vector<double> weighted(s.n);
    for (int i = 0; i < s.n; ++i) weighted[i] = s.mass[i] * shape.at(i);
    int best = 0;
    for (int j = 1; j < s.n; ++j)
        if (std::abs(plm::dot(s.n, modes.vectors.col(j), weighted.data())) >
            std::abs(plm::dot(s.n, modes.vectors.col(best), weighted.data())))
            best = j;
    return plm::to_hz(modes.values[best]);
}

struct MacCheck {
    double diagonal_error = 0, off_diagonal = 0;
};
MacCheck mac_of_modes_with_themselves() {
    const exact::Structure s = test::two_chains(20, 6, 500, true);
    const auto space = plm::make_contact_space(test::make_model(s), 5.0, 10, plm::Watch());
    const auto modes = plm::modes_of_contact_set(*space, plm::PairStates::all_closed(6),
                                                 std::numeric_limits<double>::infinity());
    MacCheck c;
    for (int i = 0; i < 8; ++i)
        for (int j = 0; j < 8; ++j) {
            const double mac = plm::mac(space->size(), modes.vectors.col(i), modes.vectors.col(j));
            if (i == j) c.diagonal_error = std::max(c.diagonal_error, std::abs(mac - 1));
            if (i != j) c.off_diagonal = std::max(c.off_diagonal, mac);
        }
    return c;
}

void mac_of_a_mode_is_one_with_itself_and_zero_with_others(void **) {
    const MacCheck c = mac_of_modes_with_themselves();
    assert_true(below(c.diagonal_error, 1e-13) && below(c.off_diagonal, 1e-20));
    const double zero[2] = {0, 0}, one[2] = {3, 4}, huge[2] = {3e200, 4e200};
    assert_true(plm::mac(2, zero, one) == 0);
    assert_true(near(plm::mac(2, huge, one), 1, 1e-14));
}

void bilinear_frequency_has_its_closed_form(void **) {
    assert_true(near(plm::bilinear_frequency(3, 1), 1.5, 1e-15));
    assert_true(plm::bilinear_frequency(0, 1) == 0);
}

// m = 1, k = 1, k_n = 8: closed 3 rad/s, open 1 rad/s, BLF = 2 f1 f2 / (f1 + f2) = 1.5 rad/s.
void case_a_surrounds_the_bilinear_frequency(void **) {
    SamplerOptions o;
    o.window_half_width = 0.1;
    const FrequencyWindow w = window_of(test::bilinear_oscillator(0.01, 8, 0, 1, 0), o);
    assert_false(w.preload_case);
    assert_true(close_to(std::max(w.f1_hz, w.f2_hz), 3 * hz, 1e-12));
    assert_true(close_to(std::min(w.f1_hz, w.f2_hz), 1 * hz, 1e-12));
    assert_true(close_to(w.blf_hz, 1.5 * hz, 1e-12));
    assert_true(close_to(w.min_hz, 1.35 * hz, 1e-12) && close_to(w.max_hz, 1.65 * hz, 1e-12));
    assert_int_equal(w.mac.size(), 2);
    assert_true(w.why.find("bilinear") != std::string::npos);
}

void very_stiff_contact_is_matched_beyond_the_first_search(void **) {
    const FrequencyWindow w = window_of(test::bilinear_oscillator(0.01, 1e8, 0, 1, 0), SamplerOptions());
    assert_true(close_to(w.blf_hz, 2 / (1 + 1 / std::sqrt(1 + 1e8)) * hz, 1e-10));
}

void case_b_covers_rest_and_bilinear_frequency(void **) {
    // pressed into contact: at rest closed, 3 rad/s; BLF 1.5 rad/s
    const FrequencyWindow w = window_of(test::bilinear_oscillator(0.01, 8, 0, 1, 5), SamplerOptions());
    assert_true(w.preload_case);
    assert_true(close_to(w.rest_hz, 3 * hz, 1e-12) && close_to(w.blf_hz, 1.5 * hz, 1e-12));
    assert_true(close_to(w.min_hz, 0.95 * 1.5 * hz, 1e-12) && close_to(w.max_hz, 1.05 * 3 * hz, 1e-12));
    assert_string_equal(w.mac[2].system.c_str(), "rest");
    // with a gap only, the rest state is open
    const FrequencyWindow g = window_of(test::bilinear_oscillator(0.01, 8, 0.3, 1, 0), SamplerOptions());
    assert_true(g.preload_case && close_to(g.rest_hz, 1 * hz, 1e-12));
}

void rest_frequency_equals_the_dense_one(void **) {
    const exact::Structure s = chain_with_preload();
    const plm::Sampler sampler(test::make_model(s), SamplerOptions(), plm::Watch());
    assert_true(close_to(sampler.window().rest_hz, dense_rest_frequency(sampler, s), 1e-9));
    const plm::MacRow &row = sampler.window().mac[2];
    assert_true(row.mac[row.best] > 0.5 &&
                close_to(row.frequency_hz[row.best], sampler.window().rest_hz, 1e-15));
}

void the_callers_window_takes_precedence(void **) {
    SamplerOptions o;
    o.window_min_hz = 0.1;
    o.window_max_hz = 0.2;
    const FrequencyWindow w = window_of(test::bilinear_oscillator(0.01, 8, 0, 1, 0), o);
    assert_true(w.min_hz == 0.1 && w.max_hz == 0.2);
    assert_true(close_to(w.blf_hz, 1.5 * hz, 1e-12));
}

void a_window_in_rad_s_is_told(void **) {
    const exact::Structure s = test::bilinear_oscillator(0.01, 8, 0, 1, 0);
    const auto said = [&](double low, double high) {
        SamplerOptions o;
        o.window_min_hz = low, o.window_max_hz = high;
        return plm::Sampler(test::make_model(s), o, plm::Watch()).warnings();
    };
    const double resonance = 2 * M_PI * 1.5 * hz; // rad/s
    assert_true(said(0.9 * resonance, 1.1 * resonance).has(plm::reason::outside_basis));
    assert_true(said(0.9 * 1.5 * hz, 1.1 * 1.5 * hz).empty());
    assert_true(said(0.9 * 1.5 * hz, 1.1 * resonance).empty());  // wide, with the resonance inside
    assert_true(said(0.5 * resonance, 0.7 * resonance).empty()); // elsewhere, as a host may ask for
}

void a_mode_in_rad_s_is_told(void **) {
    const exact::Structure s = test::bilinear_oscillator(0.01, 8, 0, 1, 0); // open: 1 rad/s
    const auto said = [&](double mode_hz) {
        SamplerOptions o;
        o.mode_frequency_hz = mode_hz;
        return plm::Sampler(test::make_model(s), o, plm::Watch()).warnings();
    };
    assert_true(said(1 * hz).empty());
    assert_true(said(1.5 * hz).empty()); // where the response is largest
    assert_true(said(1).has(plm::reason::outside_basis));
}

// A mass held by nothing but its contact, pressed by a weight: the open half cycle has no frequency.
void a_rigid_half_cycle_leaves_the_frequency_at_rest(void **) {
    exact::Structure s = test::bilinear_oscillator(0, 9, 0, 1, 2);
    s.stiffness[0] = 0;
    const FrequencyWindow w = window_of(s, SamplerOptions());
    assert_true(w.blf_hz == 0 && close_to(w.rest_hz, 3 * hz, 1e-9));
    assert_true(close_to(w.max_hz, 1.05 * 3 * hz, 1e-9));
}

} // namespace

int main() {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(mac_of_a_mode_is_one_with_itself_and_zero_with_others),
        cmocka_unit_test(bilinear_frequency_has_its_closed_form),
        cmocka_unit_test(case_a_surrounds_the_bilinear_frequency),
        cmocka_unit_test(very_stiff_contact_is_matched_beyond_the_first_search),
        cmocka_unit_test(case_b_covers_rest_and_bilinear_frequency),
        cmocka_unit_test(rest_frequency_equals_the_dense_one),
        cmocka_unit_test(the_callers_window_takes_precedence),
        cmocka_unit_test(a_window_in_rad_s_is_told),
        cmocka_unit_test(a_mode_in_rad_s_is_told),
        cmocka_unit_test(a_rigid_half_cycle_leaves_the_frequency_at_rest),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
