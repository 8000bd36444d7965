// Verdicts on a curve: a sweep over an estimated range goes on until its peak is inside, a highest point at
// an end is not called a peak, and what lies outside the basis is said. Truths: the bilinear frequency, and
// the same curve over a range that is wide from the start.
#include "motions/curve_verdicts.hpp"
#include "reduction/basis.hpp"
#include "sampling/sampler.hpp"
#include "sampling/small_models.hpp"
#include "searches/hbm.hpp"
#include "support/small_reduced.hpp"
#include "support/test.hpp"
#include <algorithm>
#include <cmath>

namespace {

constexpr double blf = 4.0 / 3.0; // rad/s, of stiffness 1 open and 4 closed (paper, eq. (6))

struct Case {
    std::shared_ptr<const plm::Model> model;
    std::shared_ptr<const plm::Basis> basis;
};

Case unreduced(const exact::Structure &s, double max_hz) {
    Case c;
    c.model = test::make_model(s, {{0.01}});
    plm::BasisOptions o;
    o.kind = &plm::basis_kinds::full;
    o.frequency_min_hz = 0.5 * max_hz;
    o.frequency_max_hz = max_hz;
    c.basis = std::make_shared<plm::Basis>(c.model, nullptr, nullptr, o, plm::Watch());
    return c;
}

Case oscillator() {
    return unreduced(test::bilinear_oscillator(0, 3, 0, 1e-3, 0), 3 * blf / (2 * M_PI));
}

plm::HbmOptions five(bool upward = false) {
    plm::HbmOptions o;
    o.n_harmonics = 5;
    o.upward = upward;
    return o;
}

// Window [low, high] x BLF, both ends estimated within a reach of 1.5.
plm::Hbm estimated(const Case &c, double low, double high, const plm::HbmOptions &o) {
    const double hz = blf / (2 * M_PI);
    return plm::Hbm(c.basis->reduced(), {low * hz, high * hz, low * hz / 1.5, high * hz * 1.5}, o,
                    plm::Watch());
}

plm::Hbm fixed(const Case &c, double low, double high, const plm::HbmOptions &o) {
    const double hz = blf / (2 * M_PI);
    return plm::Hbm(c.basis->reduced(), low * hz, high * hz, o, plm::Watch());
}

plm::Peak peak_of(const plm::Hbm &hbm, const plm::Branch &curve) {
    return hbm.find_peak(curve, 0, plm::Measure::peak, 0);
}

bool is_one_curve(const plm::Branch &b) { // no jump where pieces meet, arc lengths ascending from zero
    const auto &p = b.points();
    if (p.front().arclength != 0) return false;
    for (std::size_t i = 1; i < p.size(); ++i) {
        if (!(p[i].arclength > p[i - 1].arclength)) return false;
        if (std::abs(p[i].omega - p[i - 1].omega) > 0.05 * blf) return false;
    }
    return true;
}

// The resonance lies below, above or far beyond the end where the sweep begins or ends.
void the_peak_is_brought_inside(void **) {
    const Case c = oscillator();
    const plm::Hbm wide = fixed(c, 0.6, 1.6, five());
    const plm::Peak want = peak_of(wide, *wide.sweep());
    assert_true(close_to(want.frequency_hz * 2 * M_PI, blf, 1e-3)); // damping 1 %, five harmonics
    const double windows[][2] = {{1.03, 1.13}, {1.2, 1.3}, {0.88, 0.98}, {0.75, 0.85}};
    for (const auto &w : windows)
        for (bool upward : {false, true}) {
            const plm::Hbm hbm = estimated(c, w[0], w[1], five(upward));
            const auto curve = hbm.sweep();
            const plm::Peak got = peak_of(hbm, *curve);
            assert_true(curve->warnings.empty() && got.branch->warnings.empty());
            assert_int_equal(curve->end_reason, plm::reason::range_end);
            assert_true(is_one_curve(*curve));
            // both stand on the exact curve at the vertex of the amplitude: Newton's tolerance and the
            // parabola
            assert_true(close_to(got.frequency_hz, want.frequency_hz, 1e-5));
            assert_true(close_to(got.amplitude, want.amplitude, 1e-7));
            double least = 1e9, most = 0; // what was asked for is still on the curve
            for (const auto &p : curve->points())
                least = std::min(least, p.omega / blf), most = std::max(most, p.omega / blf);
            assert_true(least < w[0] + 1e-9 && most > w[1] - 1e-9);
        }
}

// A window that has its peak is left alone, to the last point.
void a_peak_inside_costs_nothing(void **) {
    const Case c = oscillator();
    const auto free = estimated(c, 0.95, 1.05, five()).sweep(), held = fixed(c, 0.95, 1.05, five()).sweep();
    assert_int_equal(free->points().size(), held->points().size());
    assert_int_equal(free->newton_work.factorizations, held->newton_work.factorizations);
}

void what_cannot_be_brought_inside_is_said(void **) {
    const Case c = oscillator();
    const plm::Hbm hbm = estimated(c, 1.7, 1.9, five());
    const auto curve = hbm.sweep();
    assert_true(curve->warnings.has(plm::reason::no_peak));
    assert_true(close_to(curve->points().back().omega, 1.7 * blf / 1.5, 1e-12)); // as far as it may
    assert_true(peak_of(hbm, *curve).branch->warnings.has(plm::reason::no_peak));
}

// The host's own frequencies stay, and its flank is no fault of the sweep.
void a_range_of_the_host_stays(void **) {
    const Case c = oscillator();
    plm::HbmOptions o = five();
    o.frequency_min_hz = 1.03 * blf / (2 * M_PI);
    const plm::Hbm hbm = estimated(c, 0.9, 1.13, o);
    const auto curve = hbm.sweep();
    assert_true(curve->warnings.empty());
    double least = 1e9;
    for (const auto &p : curve->points()) least = std::min(least, p.omega / (2 * M_PI));
    assert_true(close_to(least, o.frequency_min_hz, 1e-12));
    const plm::Peak p = peak_of(hbm, *curve);
    assert_true(p.branch->warnings.has(plm::reason::no_peak));
    assert_true(close_to(p.frequency_hz, least, 1e-12) && p.amplitude > 0); // still delivered
}

void a_cut_off_curve_has_no_peak(void **) {
    const Case c = oscillator();
    plm::HbmOptions o = five();
    o.max_points = 6;
    const plm::Hbm hbm = fixed(c, 0.9, 1.1, o);
    const auto curve = hbm.sweep();
    assert_int_equal(curve->end_reason, plm::reason::point_limit);
    const plm::Warnings said = peak_of(hbm, *curve).branch->warnings;
    assert_true(said.has(plm::reason::no_peak) && said.text().find("max_points") != std::string::npos);
}

// A chain of four on the modes of its first resonance only: fine there, of no use at its third.
void responses_outside_the_basis_are_said(void **) {
    const Case whole = unreduced(test::two_chains(4, 1, 300, true), 2.0);
    plm::SamplerOptions so;
    so.mode = 1;
    so.n_harmonics = 1;
    const auto sampler = std::make_shared<plm::Sampler>(whole.model, so, plm::Watch());
    plm::BasisOptions o;
    o.n_harmonics = 1;
    o.below_factor = 1.05;
    o.load_vectors = false;
    const auto basis = std::make_shared<plm::Basis>(whole.model, sampler, nullptr, o, plm::Watch());
    const auto solve = [&](double hz) {
        return plm::Hbm(basis->reduced(), basis->sweep_range(), five(), plm::Watch()).solve(hz, nullptr, 0);
    };
    assert_true(solve(0.5 * (basis->window_min_hz() + basis->window_max_hz()))->warnings.empty());
    const auto far = solve(3 * basis->window_max_hz());
    assert_true(far->full_residual(0) > 0.1);
    assert_true(far->warnings.has(plm::reason::outside_basis));
    assert_true(far->warnings.text().find("rad/s") == std::string::npos);
    const auto angular = solve(M_PI * (basis->window_min_hz() + basis->window_max_hz()));
    assert_true(angular->warnings.text().find("rad/s") != std::string::npos);
    // the unreduced structure serves anywhere: outside its window nothing is cried
    const auto fine = plm::Hbm(whole.basis->reduced(), whole.basis->sweep_range(), five(), plm::Watch())
                          .solve(2.2, nullptr, 0);
    assert_true(fine->full_residual(0) < 1e-6 && fine->warnings.empty());
}

// A chain that strikes a stop ten times as stiff as its springs, on the modes of two harmonics and on all of
// them.
struct Struck {
    plm::Peak peak;
    bool said = false; // by the curve
};
Struck struck_chain(bool all) {
    const auto model = test::make_model(test::chain(8, 0.02, 10, 0, 0.1, 0, {7}), {{0.02}});
    const auto sampler = std::make_shared<plm::Sampler>(model, plm::SamplerOptions(), plm::Watch());
    plm::BasisOptions o;
    o.n_harmonics = 2;
    if (all) o.kind = &plm::basis_kinds::full;
    const plm::Basis basis(model, sampler, nullptr, o, plm::Watch());
    const plm::Hbm hbm(basis.reduced(), basis.sweep_range(), plm::HbmOptions(), plm::Watch());
    const auto curve = hbm.sweep();
    return {hbm.find_peak(*curve, 7, plm::Measure::peak, 0),
            curve->warnings.has(plm::reason::basis_too_small)};
}

void a_basis_too_small_for_the_contact_is_said(void **) {
    const Struck small = struck_chain(false), whole = struck_chain(true);
    const double wrong = std::abs(small.peak.amplitude / whole.peak.amplitude - 1);
    assert_true(wrong > 0.01);
    assert_true(small.said && small.peak.branch->warnings.has(plm::reason::basis_too_small));
    // the number said is the size of the error
    const double number = small.peak.branch->full_residual(0);
    assert_true(number > 0.3 * wrong && number < 3 * wrong);
    assert_true(!whole.said && !whole.peak.branch->warnings.has(plm::reason::basis_too_small));
}

// Gap 1: at resonance the mass moves by force / (2 zeta) = 50 force, so a force of 1e-5 stays 2,000 times
// below the stop, one of 1e-3 twenty times, and a force of 0.05 strikes it.
void a_linear_response_is_said_where_contact_is_out_of_reach(void **) {
    const auto said = [](double force) {
        const Case c = unreduced(test::bilinear_oscillator(0, 3, 1, force, 0), 1.2 / (2 * M_PI));
        const auto curve =
            plm::Hbm(c.basis->reduced(), 0.9 / (2 * M_PI), 1.1 / (2 * M_PI), five(), plm::Watch()).sweep();
        return curve->warnings;
    };
    assert_true(said(1e-5).has(plm::reason::no_switching));
    assert_true(said(1e-5).text().find("2e+03") != std::string::npos);
    assert_true(said(1e-3).empty() && said(0).empty());
    assert_true(!said(0.05).has(plm::reason::no_switching));
}

// The resonance of the struck mass leaves the range above: the curve from there folds and goes back, that
// from below leads across, whatever direction is asked for.
void a_curve_that_comes_back_is_followed_from_the_other_end(void **) {
    const Case c = unreduced(test::bilinear_oscillator(0, 3, 1, 0.05, 0), 1.2 / (2 * M_PI));
    const plm::Hbm up(c.basis->reduced(), 0.9 / (2 * M_PI), 1.1 / (2 * M_PI), five(true), plm::Watch()),
        down(c.basis->reduced(), 0.9 / (2 * M_PI), 1.1 / (2 * M_PI), five(false), plm::Watch());
    const auto rising = up.sweep(), falling = down.sweep();
    assert_true(plm::spans(*rising) && plm::spans(*falling));
    assert_int_equal(rising->points().size(), falling->points().size());
    const plm::BranchPoint &last = falling->points().back();
    assert_true(close_to(last.omega, 1.1, 1e-9) && last.omega == rising->points().back().omega);
    // near the top end of its hardening branch, far above the stop
    assert_true(falling->amplitude(static_cast<std::int64_t>(falling->points().size()) - 1, 0,
                                   plm::Measure::peak, 0) > 1.2);
}

plm::Branch followed(const Case &c, std::int32_t reason, const std::vector<double> &through) {
    plm::Branch curve(c.basis->reduced(), 1);
    for (double omega : through) {
        plm::BranchPoint p;
        p.omega = omega;
        curve.append(p);
    }
    curve.end_reason = reason;
    plm::check_span(true, plm::Watch(), curve);
    return curve;
}

// What no other end helps against is an outcome of its own, though the curve is complete in itself.
void a_sweep_that_does_not_lead_across_says_so(void **) {
    const Case c = oscillator();
    const plm::Branch loop = followed(c, plm::reason::loop_closed, {1.0, 1.1, 1.2, 1.0}),
                      back = followed(c, plm::reason::range_end, {1.0, 1.1, 1.2, 1.0}),
                      from_inside = followed(c, plm::reason::range_end, {1.02, 1.1, 1.2, 1.0}),
                      across = followed(c, plm::reason::range_end, {1.02, 1.2, 1.0, 1.3});
    assert_true(loop.warnings.has(plm::reason::loop_closed) && !plm::spans(loop));
    assert_true(back.warnings.has(plm::reason::turned_back) && !plm::spans(back));
    assert_true(from_inside.warnings.has(plm::reason::turned_back) && !plm::spans(from_inside));
    assert_true(across.warnings.empty() && plm::spans(across));
}

// Two unit masses on unit springs to the ground and one between them; the first strikes a stop of stiffness
// `stop` as it passes its rest.
exact::Structure struck_pair(double stop) {
    exact::Structure s;
    s.n = 2, s.z = 1;
    s.mass = {1, 1};
    s.stiffness = {2, -1, -1, 2};
    s.damping.assign(4, 0.0);
    for (int i = 0; i < 4; ++i) s.damping[i] = 0.02 * s.stiffness[i];
    s.gap_rows = {1, 0};
    s.contact_stiffness = {stop};
    s.gap = {0};
    s.force = {0.1, 0};
    s.preload = {0, 0};
    return s;
}

// How far the state at the beginning of a period still changes after five hundred of them, of its size.
double unrest(const exact::Structure &s, double omega) {
    std::vector<double> state(4, 0.0), before;
    for (int k = 0; k < 500; ++k) {
        before = state;
        state = exact::period_map(s, omega, before, nullptr);
    }
    double change = 0, size = 0;
    for (int i = 0; i < 4; ++i)
        change = std::hypot(change, state[i] - before[i]), size = std::hypot(size, state[i]);
    return change / size;
}

void a_peak_that_does_not_last_is_said(void **) {
    for (double stop : {10.0, 3.0}) {
        const exact::Structure s = struck_pair(stop);
        Case c;
        test::ModelExtras damped;
        damped.explicit_damping = true;
        c.model = test::make_model(s, damped);
        c.basis = std::make_shared<plm::Basis>(
            c.model, std::make_shared<plm::Sampler>(c.model, plm::SamplerOptions(), plm::Watch(), nullptr),
            nullptr, plm::BasisOptions(), plm::Watch());
        const plm::Hbm hbm(c.basis, plm::HbmOptions(), plm::Watch());
        const auto curve = hbm.sweep();
        const plm::Peak peak = peak_of(hbm, *curve);
        const plm::Warnings &said = peak.branch->warnings;
        const double moving = unrest(s, 2 * M_PI * peak.frequency_hz);
        assert_true(said.has(plm::reason::unstable_peak) == (moving > 0.1));
        assert_true(said.empty() == (moving < 1e-3));
        assert_true((stop > 5) == (moving > 0.1)); // both cases occur
    }
}

// The chain of above with a softer stop on the modes of three harmonics, which make its peak unstable: as its
// motion is compared with that of the whole structure, its stability is that motion's, too.
void a_peak_is_as_stable_as_the_whole_structure(void **) {
    const auto model = test::make_model(test::chain(8, 0.02, 3, 0, 0.1, 0, {7}), {{0.02}});
    const auto sampler = std::make_shared<plm::Sampler>(model, plm::SamplerOptions(), plm::Watch());
    const auto solver = [&](const plm::BasisKind &kind) {
        plm::BasisOptions o;
        o.n_harmonics = 3;
        o.kind = &kind;
        return plm::Hbm(std::make_shared<plm::Basis>(model, sampler, nullptr, o, plm::Watch()),
                        plm::HbmOptions(), plm::Watch());
    };
    const plm::Hbm small = solver(plm::basis_kinds::plm), whole = solver(plm::basis_kinds::full);
    const auto curve = small.sweep();
    const plm::Peak peak = small.find_peak(*curve, 7, plm::Measure::peak, 0);
    const plm::BranchPoint &found = peak.branch->points()[0];
    const auto top = static_cast<std::size_t>(curve->highest_point(7, plm::Measure::peak, 0));
    const plm::Peak true_peak = whole.find_peak(*whole.sweep(), 7, plm::Measure::peak, 0);
    const auto largest = [](const plm::BranchPoint &p) { return std::abs(p.multipliers.front()); };
    const double truth = largest(true_peak.branch->points()[0]);
    assert_true(largest(curve->points()[top]) > 1.1 && truth < 0.9);
    assert_int_equal(plm::stability_of(found), 1);
    assert_true(std::abs(largest(found) - truth) < 0.01); // the peaks are 1.6 % apart
    assert_true(!peak.branch->warnings.has(plm::reason::unstable_peak));
}

} // namespace

int main() {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_peak_is_brought_inside),
        cmocka_unit_test(a_peak_inside_costs_nothing),
        cmocka_unit_test(what_cannot_be_brought_inside_is_said),
        cmocka_unit_test(a_range_of_the_host_stays),
        cmocka_unit_test(a_cut_off_curve_has_no_peak),
        cmocka_unit_test(responses_outside_the_basis_are_said),
        cmocka_unit_test(a_basis_too_small_for_the_contact_is_said),
        cmocka_unit_test(a_linear_response_is_said_where_contact_is_out_of_reach),
        cmocka_unit_test(a_curve_that_comes_back_is_followed_from_the_other_end),
        cmocka_unit_test(a_sweep_that_does_not_lead_across_says_so),
        cmocka_unit_test(a_peak_that_does_not_last_is_said),
        cmocka_unit_test(a_peak_is_as_stable_as_the_whole_structure),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
