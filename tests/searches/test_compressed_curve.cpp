// Curves of exact motions on a compressed basis: the same curve as on the whole one, and what starts from it
// goes on on the whole one.
#include "host_case.hpp"
#include "linalg/work.hpp"
#include "motions/compressed_motion.hpp"
#include "motions/motion_measures.hpp"
#include "motions/responses.hpp"
#include "orbits/orbit_point.hpp"
#include "reduction/compression.hpp"
#include "reduction/widened_model.hpp"
#include "searches/compressed_curve.hpp"
#include "searches/phase_resonance.hpp"
#include "space/linear_contact.hpp"
#include "support/test.hpp"
#include <algorithm>
#include <array>
#include <cmath>

extern "C" {
#include "cracked_plate.h"
}

namespace {

using CurvePtr = std::shared_ptr<const plm::Branch>;

// The small plate with nothing set: 49 coordinates.
struct Plate {
    explicit Plate(bool with_preload) : host("cracked_plate", with_preload, 8) {
        basis = host.basis(plm::BasisOptions());
        whole = plm::widened(basis->reduced());
        curve = solver(plm::MotionKind::automatic).sweep();
    }
    plm::Hbm solver(plm::MotionKind motion) const {
        plm::HbmOptions o;
        o.motion = motion;
        return plm::Hbm(basis, o, plm::Watch());
    }
    plm::Peak peak(const plm::Hbm &hbm, const CurvePtr &of) const {
        return hbm.find_peak(*of, host.output_dof(), plm::Measure::peak, 0);
    }

    test::Host host;
    std::shared_ptr<const plm::Basis> basis;
    std::shared_ptr<const plm::ReducedModel> whole;
    CurvePtr curve;
};

Plate &plate(bool with_preload) {
    static Plate open(false), pressed(true);
    return with_preload ? pressed : open;
}

struct Stability {
    std::int64_t n_unstable = 0;
    double largest_multiplier = 0; // over all points but the unstable ones
};

Stability stability(const plm::Branch &branch) {
    Stability s;
    for (const plm::BranchPoint &p : branch.points()) {
        s.n_unstable += plm::stability_of(p) == 0;
        if (plm::stability_of(p) == 1)
            s.largest_multiplier = std::max(s.largest_multiplier, std::abs(p.multipliers.at(0)));
    }
    return s;
}

struct Comparison {
    bool compressed = false, whole_reference = false, same_stability = false;
    std::int32_t end = -1;
    double size = 1, amplitude = 1, frequency = 1; // shares of the whole basis's
    double multiplier = 1;
};

Comparison compare(const Plate &p) {
    const plm::Hbm exactly = p.solver(plm::MotionKind::exact);
    const CurvePtr reference = exactly.sweep();
    const plm::Peak peak = p.peak(p.solver(plm::MotionKind::automatic), p.curve),
                    right = p.peak(exactly, reference);
    Comparison c;
    c.compressed = p.curve->reduced().from != nullptr;
    c.whole_reference = reference->reduced_model() == p.whole;
    const Stability here = stability(*p.curve), there = stability(*reference);
    c.same_stability = (here.n_unstable > 0) == (there.n_unstable > 0);
    c.multiplier = std::abs(here.largest_multiplier - there.largest_multiplier);
    c.end = p.curve->end_reason;
    c.size = static_cast<double>(p.curve->reduced().size()) / static_cast<double>(p.whole->size());
    c.amplitude = std::abs(peak.amplitude / right.amplitude - 1);
    c.frequency = std::abs(peak.frequency_hz / right.frequency_hz - 1);
    return c;
}

// A third of the accuracy is the share of the compression, and its estimate is good to a third.
constexpr double allowed = 4e-4;

void same_curve_as_on_the_whole_basis(void **) {
    for (bool with_preload : {false, true}) {
        const Comparison c = compare(plate(with_preload));
        assert_true(c.compressed);
        assert_true(c.whole_reference);
        assert_true(c.same_stability);
        assert_int_equal(c.end, plm::reason::range_end);
        assert_true(below(c.size, 0.6));
        assert_true(below(c.amplitude, allowed));
        assert_true(below(c.frequency, 1e-5));
        assert_true(
            below(c.multiplier, 1e-4)); // 3e-4 without the modes with closed contact, and a false flag
    }
}

// Of the whole basis's modes below twice the highest frequency, how many the compressed one has, and has not.
std::array<int, 2> slow_modes(const Plate &p) {
    double highest = 0;
    for (const plm::BranchPoint &point : p.curve->points()) highest = std::max(highest, point.omega);
    const auto &kept = p.curve->reduced().lambda;
    std::array<int, 2> n{};
    for (double lambda : p.whole->lambda)
        if (lambda < 4 * highest * highest)
            ++n[std::none_of(kept.begin(), kept.end(),
                             [lambda](double l) { return std::abs(l - lambda) < 1e-9 * lambda; })];
    return n;
}

void slow_modes_stay_whole(void **) {
    const auto n = slow_modes(plate(false));
    assert_true(n[0] >= 1);
    assert_int_equal(n[1], 0);
}

// Largest relative difference of the modes below `kept` with such springs, between a model compressed to
// nothing but one motion and what it is made from.
double modes_in_contact_differ(const std::shared_ptr<const plm::ReducedModel> &whole, double kept,
                               const plm::vector<double> &spring, bool known) {
    plm::Matrix motion(whole->size(), 1);
    motion(whole->size() / 2, 0) = 1;
    std::vector<plm::vector<double>> springs;
    if (known) springs.push_back(spring);
    const auto smaller = plm::compress_beside_modes(whole, motion, springs, kept, 1e-3, kept, whole->size());
    const auto modes = [&](const plm::ReducedModel &m) {
        return plm::modes_with_springs(m.lambda, m.n_massless, m.gap, spring, kept * kept).values;
    };
    const auto there = modes(*whole), here = modes(*smaller);
    double worst = here.size() == there.size() && !there.empty() ? 0 : 1;
    for (std::size_t j = 0; j < std::min(here.size(), there.size()); ++j)
        worst = std::max(worst, std::abs(here[j] / there[j] - 1));
    return worst;
}

// Motions that change their contact lose their stability by modes that feel it in part.
void slow_modes_with_partly_closed_contact_stay(void **) {
    const Plate &p = plate(false);
    plm::vector<double> spring = p.whole->contact.stiffness;
    for (std::size_t i = 0; i < spring.size(); ++i) spring[i] *= i % 3 == 0 ? 0.05 : 0;
    const double kept = 4 * p.curve->points()[0].omega;
    assert_true(below(modes_in_contact_differ(p.whole, kept, spring, true), 1e-5));
    assert_true(modes_in_contact_differ(p.whole, kept, spring, false) > 1e-3);
}

// Motions with something of every direction: the model takes the best of them, beside the slow modes.
void grows_no_further_than_told(void **) {
    const Plate &p = plate(false);
    const std::int64_t n = p.whole->size();
    plm::Matrix motions(n, n);
    for (std::int64_t j = 0; j < n; ++j) motions(j, j) = 1;
    const double kept = 2 * p.curve->points()[0].omega;
    const auto size = [&](std::int64_t most) {
        return plm::compress_beside_modes(p.whole, motions, {}, kept, 1e-3, kept, most)->size();
    };
    assert_int_equal(size(n), n);
    assert_int_equal(size(n - 3), n - 3);
    assert_true(size(0) >= 1 && size(0) < n - 3); // the slow modes
}

// A lower force level on what the curve of the full one was followed on: no first look, and the peak of the
// level's own curve on the whole basis.
void a_level_goes_on_from_the_one_before(void **) {
    const Plate &p = plate(true);
    plm::HbmOptions o;
    plm::LevelBefore before;
    plm::Hbm(p.basis, o, plm::Watch()).sweep(nullptr, &before);
    assert_true(before.compression != nullptr);
    o.force_scale = 0.5;
    const plm::Hbm half(p.basis, o, plm::Watch());
    const std::int64_t work_before = plm::work_done();
    const CurvePtr alone = half.sweep();
    const std::int64_t work_between = plm::work_done();
    const CurvePtr level = half.sweep(nullptr, &before);
    const double share = static_cast<double>(plm::work_done() - work_between) /
                         static_cast<double>(work_between - work_before);
    o.motion = plm::MotionKind::exact;
    const plm::Hbm exactly(p.basis, o, plm::Watch());
    const double right = p.peak(exactly, exactly.sweep()).amplitude;
    std::printf("    a level takes %.2g of the work of its curve alone\n", share);
    assert_true(before.compression != nullptr && level->reduced().from != nullptr);
    assert_true(below(std::abs(p.peak(half, level).amplitude / right - 1), allowed));
    assert_true(below(share, 0.5)); // by longer steps, on a model and with contact sets that are known
}

struct GoneOn {
    bool on_whole = false, start_on_whole = false, exact_where_asked = false, all_points = false;
    double solved = 1, carried = 1; // differences of amplitudes, as shares
};

GoneOn go_on(const Plate &p) {
    const std::int64_t middle = static_cast<std::int64_t>(p.curve->points().size()) / 2,
                       dof = p.host.output_dof();
    const double hz = p.curve->points()[static_cast<std::size_t>(middle)].omega / (2 * M_PI);
    const auto there = p.solver(plm::MotionKind::automatic).solve(hz, p.curve.get(), middle);
    const auto branch = plm::on_whole_basis(*p.curve, plm::HbmOptions(), middle, middle);
    const auto off = [&](const plm::Branch &b, std::int64_t at, std::int64_t i, plm::Measure m) {
        return std::abs(b.amplitude(at, dof, m, 1) / p.curve->amplitude(i, dof, m, 1) - 1);
    };
    GoneOn g;
    g.on_whole = there->reduced_model() == p.whole && branch->reduced_model() == p.whole;
    g.start_on_whole = plm::start_of(*p.curve, middle).reduced == p.whole;
    g.exact_where_asked = branch->points()[static_cast<std::size_t>(middle)].motion != nullptr &&
                          branch->points()[0].motion == nullptr;
    g.all_points = branch->points().size() == p.curve->points().size();
    g.solved = off(*there, 0, middle, plm::Measure::peak);
    g.carried = std::max(off(*branch, 0, 0, plm::Measure::harmonic),
                         off(*branch, middle, middle, plm::Measure::harmonic));
    return g;
}

void what_starts_from_the_curve_goes_on_on_the_whole_basis(void **) {
    for (bool with_preload : {false, true}) {
        const GoneOn g = go_on(plate(with_preload));
        assert_true(g.on_whole);
        assert_true(g.start_on_whole);
        assert_true(g.exact_where_asked);
        assert_true(g.all_points);
        assert_true(below(g.solved, 1e-3));
        assert_true(below(g.carried, 1e-3));
    }
}

// Curves on models of their own, of one basis, are responses of that basis together.
bool are_responses_of_the_basis(const Plate &p) {
    const auto there =
        p.solver(plm::MotionKind::exact).solve(p.curve->points()[0].omega / (2 * M_PI), nullptr, 0);
    const plm::Responses both = plm::responses_of({p.curve, there});
    return both.of == p.whole && both.dynamic.rows() == p.whole->size() &&
           plm::of_one_basis(p.curve->reduced_model(), p.basis->reduced());
}

void responses_are_of_the_whole_basis(void **) {
    assert_true(are_responses_of_the_basis(plate(false)));
    assert_true(are_responses_of_the_basis(plate(true)));
}

// A crack through seven of eleven rows, in which contact bounces.
const test::Host &bouncing_plate() {
    static const test::Host host(
        [] {
            cracked_plate_params p;
            cracked_plate_quick(&p);
            p.nx = 10, p.ny = 11, p.crack_rows = 7;
            p.crack_position = 0.48 * p.length;
            p.contact_stiffness *= 0.74;
            p.force *= 0.34;
            p.quality_factor = 216;
            p.with_preload = 0;
            scene *made = nullptr;
            cracked_plate_create(&p, &made);
            return made;
        }(),
        8);
    return host;
}

// As where a better model's curve would take minutes: the first one is followed, and a better one told of.
void a_model_that_may_not_grow_says_what_a_better_one_changes(void **) {
    const Plate &p = plate(false);
    const double right = p.peak(p.solver(plm::MotionKind::automatic), p.curve).amplitude;
    for (const double accuracy : {1e-4, 1e-2}) {
        plm::HbmOptions o;
        o.accuracy = accuracy;
        o.dearest_step = 1;
        const plm::Hbm hbm(p.basis, o, plm::Watch());
        const CurvePtr curve = hbm.sweep();
        const double error = std::abs(p.peak(hbm, curve).amplitude / right - 1);
        std::printf("    accuracy %g: %d coordinates, error %.2g\n", accuracy,
                    static_cast<int>(curve->reduced().size()), error);
        assert_true(curve->reduced().from != nullptr && curve->reduced().size() < p.curve->reduced().size());
        assert_true(curve->warnings.has(plm::reason::basis_too_small) == (accuracy < 1e-3));
        assert_true((error > accuracy) == (accuracy < 1e-3));
        assert_int_equal(curve->end_reason, plm::reason::range_end);
    }
}

struct Flags {
    bool compressed = false, unverified = false;
    double unstable = 0; // share of the way along the frequency
    double amplitude = 0;
};

double unstable_share(const plm::Branch &curve) {
    double unstable = 0, all = 0;
    for (std::size_t i = 1; i < curve.points().size(); ++i) {
        const plm::BranchPoint &a = curve.points()[i - 1], &b = curve.points()[i];
        const double way = std::abs(b.omega - a.omega);
        all += way;
        for (const plm::BranchPoint *p : {&a, &b}) unstable += plm::stability_of(*p) == 0 ? 0.5 * way : 0;
    }
    return unstable / all;
}

Flags flags_of(plm::MotionKind motion, double dearest_step = plm::HbmOptions().dearest_step) {
    plm::HbmOptions o;
    o.motion = motion;
    o.dearest_step = dearest_step;
    const plm::Hbm hbm(bouncing_plate().basis(plm::BasisOptions()), o, plm::Watch());
    const CurvePtr curve = hbm.sweep();
    const auto peak = hbm.find_peak(*curve, bouncing_plate().output_dof(), plm::Measure::peak, 0);
    return {curve->reduced().from != nullptr, curve->warnings.has(plm::reason::unverified),
            unstable_share(*curve), peak.amplitude};
}

void a_bouncing_curve_is_as_stable_as_on_the_whole_basis(void **) {
    const Flags here = flags_of(plm::MotionKind::automatic), there = flags_of(plm::MotionKind::exact);
    std::printf("    unstable %.3f of the way, of the whole basis's %.3f; peak %.8g, %.8g mm\n",
                here.unstable, there.unstable, here.amplitude, there.amplitude);
    assert_true(here.compressed && there.unstable > 0.1);
    assert_true(
        below(std::abs(here.unstable - there.unstable), 0.03)); // ends of the pieces fall between points
    assert_true(close_to(here.amplitude, there.amplitude, allowed));
    const Flags first = flags_of(plm::MotionKind::automatic, 1); // no better model is followed
    std::printf("    on the first model unstable %.3f, peak %.8g mm, unverified %d\n", first.unstable,
                first.amplitude, first.unverified);
    assert_true(first.compressed);
    assert_true(first.unverified || below(std::abs(first.unstable - there.unstable), 0.03));
}

// What the model of a curve, and that with one more motion, of three times its force, leaves out of this one.
struct LeftOut {
    double before = 0, after = 1e300;
    std::int64_t size = 0, more = 0;
};
LeftOut left_out_of_another() {
    const Plate &p = plate(true);
    plm::HbmOptions o;
    o.motion = plm::MotionKind::exact;
    o.force_scale = 3;
    const CurvePtr other = plm::Hbm(p.basis, o, plm::Watch()).sweep();
    const plm::BranchPoint &motion = other->points()[static_cast<std::size_t>(plm::largest_response(*other))];
    const auto left_out = [&](const plm::ReducedModel &model) {
        plm::BranchPoint there;
        return plm::compress(model, motion, there)
                   ? plm::solution_distance(plm::uncompressed(model, there), motion)
                   : 1e300;
    };
    const auto larger = plm::compressed_with(p.curve->reduced(), motion, 2 * M_PI * o.frequency_max_hz, 1e-5);
    return {left_out(p.curve->reduced()), left_out(*larger), p.curve->reduced().size(), larger->size()};
}
void a_model_takes_in_one_more_motion(void **) {
    const LeftOut l = left_out_of_another();
    std::printf("    left out %.1e on %d coordinates, %.1e on %d\n", l.before, static_cast<int>(l.size),
                l.after, static_cast<int>(l.more));
    // 1e-5 by energy, most of it elastic at the gaps: less of the displacements
    assert_true(l.before > 1e-5 && below(l.after, 1e-6));
    assert_true(l.more > l.size && l.more < plate(true).whole->size());
}

bool is_compressed(std::int64_t n_harmonics) {
    plm::BasisOptions o;
    o.n_harmonics = n_harmonics;
    const auto few = plate(false).host.basis(o);
    return plm::Hbm(few, plm::HbmOptions(), plm::Watch()).sweep()->reduced().from != nullptr;
}

void a_small_basis_is_not_compressed(void **) {
    assert_false(is_compressed(2));
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(same_curve_as_on_the_whole_basis),
        cmocka_unit_test(slow_modes_stay_whole),
        cmocka_unit_test(slow_modes_with_partly_closed_contact_stay),
        cmocka_unit_test(grows_no_further_than_told),
        cmocka_unit_test(a_level_goes_on_from_the_one_before),
        cmocka_unit_test(what_starts_from_the_curve_goes_on_on_the_whole_basis),
        cmocka_unit_test(responses_are_of_the_whole_basis),
        cmocka_unit_test(a_bouncing_curve_is_as_stable_as_on_the_whole_basis),
        cmocka_unit_test(a_model_that_may_not_grow_says_what_a_better_one_changes),
        cmocka_unit_test(a_small_basis_is_not_compressed),
        cmocka_unit_test(a_model_takes_in_one_more_motion),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
