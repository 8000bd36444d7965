// Curves of exact motions on a compressed basis: the same curve as on the whole one, and what starts from it
// goes on on the whole one.
#include "host_case.hpp"
#include "reduction/compression.hpp"
#include "reduction/widened_model.hpp"
#include "searches/compressed_curve.hpp"
#include "searches/orbit_points.hpp"
#include "searches/responses.hpp"
#include "support/test.hpp"
#include <algorithm>
#include <array>
#include <cmath>

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
        assert_int_equal(c.end, PLM_REASON_RANGE_END);
        assert_true(below(c.size, 0.5));
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
        cmocka_unit_test(what_starts_from_the_curve_goes_on_on_the_whole_basis),
        cmocka_unit_test(responses_are_of_the_whole_basis),
        cmocka_unit_test(a_small_basis_is_not_compressed),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
