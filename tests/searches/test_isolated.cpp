// Isolated branches of a small pre-loaded structure: found without a hint, closed, the range of forces
// against plain sweeps, stable points against the exact flow, folds tracked against folds located.
#include "contact/trig_polynomial.hpp"
#include "motions/motion_measures.hpp"
#include "reduction/compression.hpp"
#include "sampling/small_models.hpp"
#include "searches/fold_tracking.hpp"
#include "searches/isolated.hpp"
#include "searches/marching_search.hpp"
#include "support/small_solver.hpp"
#include "support/test.hpp"
#include <algorithm>
#include <cmath>

using plm::Branch;
using plm::BranchPoint;
using Model = std::shared_ptr<plm::ReducedModel>;
using test::peak_at;

namespace {

// A pre-loaded oscillator that opens at large amplitude (w = 1.27, falling) carries a second mass whose mode,
// 3.2 times as fast, is in 3:1 resonance with it on the way: the force needed falls with the amplitude there.
exact::Structure carrier(double second_mass, double ratio) {
    exact::Structure s;
    const double k = ratio * ratio * second_mass;
    s.n = 2, s.z = 1;
    s.mass = {1, second_mass};
    s.stiffness = {1 + k, -k, -k, k};
    s.damping = s.stiffness;
    for (double &c : s.damping) c *= 0.004;
    s.gap_rows = {1, 0};
    s.contact_stiffness = {1};
    s.gap = {0};
    s.force = {1, 0};
    s.preload = {0.5, 0};
    return s;
}
Model with_isola() {
    return test::reduce_exactly(carrier(0.2, 3.2));
}
Model without_isola() {
    return test::reduce_exactly(carrier(0.05, 3.0));
}

constexpr int exact_motions = 0; // harmonics: none are cut off

plm::HbmOptions options(double force, int harmonics = 9) {
    plm::HbmOptions o;
    o.n_harmonics = harmonics;
    o.frequency_min_hz = 0.9 / (2 * M_PI);
    o.frequency_max_hz = 1.6 / (2 * M_PI);
    o.force_scale = force;
    o.tolerance = 1e-11;
    return o;
}

std::shared_ptr<const Branch> sweep(const Model &m, const plm::HbmOptions &o) {
    return plm::Hbm(m, 0, 0, o, plm::Watch()).sweep();
}

plm::IsolatedSearch search(const Model &m, const plm::HbmOptions &o) {
    return plm::find_isolated(m, o, *sweep(m, o), 0, plm::Watch());
}

double highest(const plm::ReducedModel &m, const Branch &b) {
    double best = 0;
    for (const BranchPoint &p : b.points()) best = std::max(best, peak_at(m, p, 0));
    return best;
}

std::vector<BranchPoint> folds_of(const Branch &b) {
    std::vector<BranchPoint> folds;
    for (const BranchPoint &p : b.points())
        if (p.bifurcation == plm::bifurcation::fold) folds.push_back(p);
    std::sort(folds.begin(), folds.end(),
              [](const BranchPoint &a, const BranchPoint &b) { return a.omega < b.omega; });
    return folds;
}

// --- backbone

// Two modes with stiffness-proportional damping: Re(F' D F) = 0 in closed form, by bisection.
double phase_resonance_of(const plm::ReducedModel &m, double low, double high) {
    const auto phase = [&](double w) {
        double sum = 0;
        for (int j = 0; j < m.size(); ++j) {
            const double f = m.excitation.at(1).real[j], d = m.lambda[j] - w * w,
                         c = w * m.damping_diagonal[j];
            sum += f * f * d / (d * d + c * c);
        }
        return sum;
    };
    for (int i = 0; i < 200; ++i) {
        const double middle = 0.5 * (low + high);
        (phase(middle) > 0 ? low : high) = middle;
    }
    return low;
}
struct LinearBackbone {
    std::size_t count = 0, points = 0;
    double frequency_error = 0, amplitude_error = 0;
};
LinearBackbone linear_backbone() {
    exact::Structure s = carrier(0.2, 1.6);
    s.gap = {1e9};
    s.preload = {0, 0};
    for (double &c : s.damping) c *= 10;
    const Model m = test::reduce_exactly(s);
    plm::BackboneOptions o;
    o.hbm = options(0.5);
    o.hbm.frequency_min_hz = 0.5 / (2 * M_PI);
    o.hbm.frequency_max_hz = 1.2 / (2 * M_PI);
    const auto backbones = plm::PhaseResonance(m, o, plm::Watch()).backbones();
    LinearBackbone out;
    out.count = backbones.size();
    if (backbones.empty()) return out;
    const double w = phase_resonance_of(*m, 0.5, 1.2);
    const auto &points = backbones[0].branch->points();
    out.points = points.size();
    const double ratio = peak_at(*m, points[0], 0) / points[0].force_scale;
    for (const BranchPoint &p : points) {
        out.frequency_error = std::max(out.frequency_error, std::abs(p.omega / w - 1));
        out.amplitude_error =
            std::max(out.amplitude_error, std::abs(peak_at(*m, p, 0) / p.force_scale / ratio - 1));
    }
    return out;
}
void linear_backbone_is_a_straight_line_at_the_phase_resonance(void **) {
    const LinearBackbone b = linear_backbone();
    std::printf("    %zu points, errors %.1e in frequency, %.1e in proportionality\n", b.points,
                b.frequency_error, b.amplitude_error);
    assert_int_equal(b.count, 1);
    assert_true(b.points > 3);
    assert_true(below(b.frequency_error, 1e-10));
    assert_true(below(b.amplitude_error, 1e-9));
}

// --- isola

struct Found {
    std::size_t count = 0, points = 0, folds = 0;
    bool closed = false, tracked = false, ends_on_start = false;
    double main = 0, top = 0, birth = 0, merge = 0, seconds = 0;
};
Found find(const Model &m, const plm::HbmOptions &o) {
    const auto main = sweep(m, o);
    const auto all = plm::find_isolated(m, o, *main, 0, plm::Watch());
    Found f;
    f.count = all.branches.size();
    f.main = highest(*m, *main);
    f.seconds = all.seconds;
    if (f.count == 0) return f;
    const plm::IsolatedBranch &i = all.branches[0];
    f.points = i.branch->points().size();
    f.closed = i.closed;
    f.tracked = i.tracked;
    f.folds = folds_of(*i.branch).size();
    f.top = highest(*m, *i.branch);
    f.birth = i.birth_force;
    f.merge = i.merge_force;
    f.ends_on_start = i.branch->points().front().omega == i.branch->points().back().omega;
    return f;
}
void isola_is_found_without_a_hint(void **) {
    const Found f = find(with_isola(), options(0.006));
    std::printf(
        "    main peak %.4f, isola %.4f (%zu points, %zu folds), exists for %.6f < F < %.6f, %.3f s\n",
        f.main, f.top, f.points, f.folds, f.birth, f.merge, f.seconds);
    assert_int_equal(f.count, 1);
    assert_true(f.closed && f.ends_on_start && f.tracked);
    assert_int_equal(f.folds, 2);
    assert_true(f.top > 1.5 * f.main);
}

// Births by searches on both sides, merging by plain sweeps alone: the main peak jumps to the isola's height.
struct Range {
    Found at;
    std::size_t before_birth = 9, after_birth = 9;
    double before_merge = 0, after_merge = 0;
};
Range check_range(int harmonics) {
    const Model m = with_isola();
    Range r;
    r.at = find(m, options(0.006, harmonics));
    r.before_birth = search(m, options(r.at.birth * (1 - 1e-3), harmonics)).branches.size();
    r.after_birth = search(m, options(r.at.birth * (1 + 1e-3), harmonics)).branches.size();
    r.before_merge = highest(*m, *sweep(m, options(r.at.merge * (1 - 1e-3), harmonics)));
    r.after_merge = highest(*m, *sweep(m, options(r.at.merge * (1 + 1e-3), harmonics)));
    return r;
}
void agrees_with_plain_sweeps(const Range &r) {
    assert_true(r.at.tracked);
    std::printf("    around the birth %zu and %zu loops; main peak around the merger %.4f and %.4f\n",
                r.before_birth, r.after_birth, r.before_merge, r.after_merge);
    assert_int_equal(r.before_birth, 0);
    assert_int_equal(r.after_birth, 1);
    assert_true(r.after_merge > 2 * r.before_merge);
}
void range_of_forces_agrees_with_plain_sweeps(void **) {
    agrees_with_plain_sweeps(check_range(9));
}
void range_of_forces_of_exact_motions_agrees_with_plain_sweeps(void **) {
    agrees_with_plain_sweeps(check_range(exact_motions));
}

// The carrier with four small masses in a row on stiff springs, which hardly move against it.
Model with_fast_coordinates() {
    const exact::Structure two = carrier(0.2, 3.2);
    exact::Structure s = two;
    s.n = 6;
    const auto n = static_cast<std::size_t>(s.n);
    s.mass.assign(n, 1e-3);
    s.stiffness.assign(n * n, 0.0);
    s.gap_rows.resize(n), s.force.resize(n), s.preload.resize(n);
    std::copy(two.mass.begin(), two.mass.end(), s.mass.begin());
    for (std::size_t i = 0; i < 2; ++i)
        for (std::size_t j = 0; j < 2; ++j) s.stiffness[i + n * j] = two.stiffness[i + 2 * j];
    for (std::size_t i = 2; i < n; ++i) {
        const std::size_t before = i == 2 ? 0 : i - 1;
        const double k = 50;
        s.stiffness[before + n * before] += k, s.stiffness[i + n * i] += k;
        s.stiffness[before + n * i] -= k, s.stiffness[i + n * before] -= k;
    }
    s.damping = s.stiffness;
    test::ModelExtras extras;
    extras.beta = 0.004;
    for (double &c : s.damping) c *= extras.beta;
    const Model m = test::reduce_exactly(s);
    m->model = test::make_model(s, extras);
    return m;
}

// Compressed to the motions of the main curve; to another one; to all of them.
std::shared_ptr<const plm::ReducedModel> compressed(const Model &m, const Branch &main) {
    plm::Matrix motions(m->size(), 0);
    for (const BranchPoint &p : main.points()) motions.append(p.eta);
    return plm::compress_beside_modes(m, motions, {}, 1, 1e-7, 4, m->size());
}
std::shared_ptr<const plm::ReducedModel> compressed_poorly(const Model &m) {
    plm::Matrix motions(m->size(), 1);
    motions(m->size() - 1, 0) = 1;
    return plm::compress_beside_modes(m, motions, {}, 1, 1e-3, 0, m->size());
}
std::shared_ptr<const plm::ReducedModel> compressed_to_nothing_less(const Model &m) {
    plm::Matrix motions(m->size(), m->size());
    for (std::int64_t j = 0; j < m->size(); ++j) motions(j, j) = 1;
    return plm::compress_beside_modes(m, motions, {}, 1, 0, 0, m->size());
}

struct OnSmaller {
    bool on_whole = false, on_smaller = false, poor_enlarged = false, large_on_whole = false, closed = false;
    double birth = 1, merge = 1, top = 1, enlarged_top = 1, size = 1;
};
OnSmaller trace_on_smaller() {
    const Model m = with_fast_coordinates();
    const plm::HbmOptions o = options(0.006, exact_motions);
    const auto main = sweep(m, o);
    const auto good = compressed(m, *main), poor = compressed_poorly(m),
               large = compressed_to_nothing_less(m);
    const auto whole = plm::find_isolated(m, o, *main, 0, plm::Watch()),
               small = plm::find_isolated(m, o, *main, 0, plm::Watch(), good),
               other = plm::find_isolated(m, o, *main, 0, plm::Watch(), poor),
               same = plm::find_isolated(m, o, *main, 0, plm::Watch(), large);
    OnSmaller out;
    for (const auto *found : {&whole, &small, &other, &same})
        if (found->branches.size() != 1) return out;
    const plm::IsolatedBranch &a = whole.branches[0], &b = small.branches[0], &c = other.branches[0];
    out.on_whole = !a.branch->reduced().from;
    out.on_smaller = b.branch->reduced_model() == good;
    out.poor_enlarged = c.branch->reduced().from && c.branch->reduced().size() > poor->size() &&
                        c.branch->reduced().size() < m->size();
    out.large_on_whole = !same.branches[0].branch->reduced().from;
    out.closed = a.closed && b.closed && c.closed;
    out.birth = std::abs(b.birth_force / a.birth_force - 1);
    out.merge = std::abs(b.merge_force / a.merge_force - 1);
    const auto fold = [](const plm::IsolatedBranch &i) { return folds_of(*i.branch).front().omega; };
    out.top = std::abs(fold(b) / fold(a) - 1);
    out.enlarged_top = std::abs(fold(c) / fold(a) - 1);
    out.size = static_cast<double>(good->size()) / static_cast<double>(m->size());
    return out;
}
// Its ends are those of the whole basis; the loop is as exact as the accuracy, 1e-3, leaves to compression.
void a_loop_is_traced_on_a_compressed_model_that_has_it(void **) {
    const OnSmaller s = trace_on_smaller();
    std::printf("    %.2f of the coordinates: ends of the loop's range differ by %.1e and %.1e, a fold by "
                "%.1e; by %.1e on a poor model with the loop's first motion\n",
                s.size, s.birth, s.merge, s.top, s.enlarged_top);
    assert_true(s.on_whole && s.on_smaller && s.poor_enlarged && s.large_on_whole && s.closed);
    assert_true(below(s.enlarged_top, 3e-4));
    assert_true(s.size < 0.9);
    assert_true(below(s.birth, 1e-12));
    assert_true(below(s.merge, 1e-12));
    assert_true(below(s.top, 3e-4));
}

std::size_t isolas(const Model &m, const plm::HbmOptions &o) {
    return search(m, o).branches.size();
}
void scenes_without_isola_yield_none(void **) {
    assert_int_equal(isolas(without_isola(), options(0.01)), 0);
    assert_int_equal(isolas(with_isola(), options(0.0095)), 0); // merged
    assert_int_equal(isolas(with_isola(), options(0.0035)), 0); // not born yet
    const Model homogeneous = test::reduce_exactly(test::bilinear_oscillator(0.01, 3, 0, 1, 0));
    assert_int_equal(isolas(homogeneous, options(0.1)), 0);
    const Model stop = test::reduce_exactly(test::bilinear_oscillator(0.01, 3, 1.0, 1, 0)); // folds, no isola
    assert_int_equal(isolas(stop, options(0.1)), 0);
    const Model unloaded =
        test::reduce_exactly(test::bilinear_oscillator(0.01, 3, 1.0, 0, 0)); // no excitation
    assert_int_equal(isolas(unloaded, options(0.1)), 0);
    assert_int_equal(isolas(with_isola(), options(0.0)), 0);
}

// Every stable point of the loop (a few of them) is a periodic orbit of the exact flow.
struct Orbits {
    int checked = 0, unconverged = 0;
    double worst = 0;
};
Orbits orbits_on_isola(int harmonics) {
    const exact::Structure s = carrier(0.2, 3.2);
    const Model m = test::reduce_exactly(s);
    const double force = 0.006;
    exact::Structure driven = s;
    driven.force[0] *= force;
    const auto all = search(m, options(force, harmonics));
    Orbits out;
    if (all.branches.empty()) return out;
    int stable = 0;
    for (const BranchPoint &p : all.branches[0].branch->points()) {
        if (plm::stability_of(p) != 1 || stable++ % 4 != 0) continue;
        std::vector<double> state(4);
        for (int dof = 0; dof < 2; ++dof) {
            const auto q = test::displacement(*m, p.eta_0, p.eta, dof);
            const plm::TrigValue v = plm::evaluate_trig(q.data(), p.eta.cols() / 2, 0.0);
            state[dof] = v.value;
            state[2 + dof] = p.omega * v.slope;
        }
        const exact::Orbit orbit = exact::periodic_orbit(driven, p.omega, state, 0, 400);
        ++out.checked;
        out.unconverged += !orbit.converged;
        out.worst = std::max(out.worst, std::abs(peak_at(*m, p, 0) / orbit.peak(0) - 1));
    }
    return out;
}
void are_orbits(const Orbits &o, double bound) {
    std::printf("    %d stable points, worst amplitude error %.1e\n", o.checked, o.worst);
    assert_true(o.checked >= 3);
    assert_int_equal(o.unconverged, 0);
    assert_true(below(o.worst, bound));
}
void stable_points_are_orbits_of_the_exact_flow(void **) {
    are_orbits(orbits_on_isola(25), 1e-3);
}
// The peak is read from the harmonics handed out, which leave out 1e-2 of harmonic_tolerance.
void stable_points_of_exact_motions_are_orbits_of_the_exact_flow(void **) {
    are_orbits(orbits_on_isola(exact_motions), 1e-5);
}

// --- second way: marching

struct Marched {
    std::size_t branches = 0, again = 9, without = 9;
    bool closed = false;
    double top = 0, top_of_search = 0;
    std::int64_t starts = 0, periodic = 0, known = 0;
};
Marched march() {
    const Model m = with_isola();
    plm::MarchingOptions o;
    o.hbm = options(0.006);
    o.hbm.frequency_min_hz = 1.1 / (2 * M_PI); // round the isola: 12 frequencies
    o.hbm.frequency_max_hz = 1.25 / (2 * M_PI);
    const auto main = sweep(m, options(0.006));
    const auto all = plm::search_by_marching(m, o, {main}, plm::Watch());
    Marched out;
    out.starts = all.n_starts, out.periodic = all.n_periodic, out.known = all.n_known;
    out.branches = all.branches.size();
    if (out.branches != 1) return out;
    out.closed = all.branches[0]->end_reason == plm::reason::loop_closed;
    out.top = highest(*m, *all.branches[0]);
    out.top_of_search = find(m, options(0.006)).top;
    out.again = plm::search_by_marching(m, o, {main, all.branches[0]}, plm::Watch()).branches.size();
    return out;
}
void marching_comes_upon_the_same_isola(void **) {
    const Marched f = march();
    std::printf("    %d starts, %d periodic, %d on known branches; top %.4f\n", static_cast<int>(f.starts),
                static_cast<int>(f.periodic), static_cast<int>(f.known), f.top);
    assert_int_equal(f.branches, 1);
    assert_true(f.closed);
    assert_true(close_to(f.top, f.top_of_search, 1e-2)); // discrete points of two loops
    assert_int_equal(f.again, 0);
}

// --- fold tracking

struct Tracked {
    bool started = false, corrected = true;
    double at_second_force = 1, turn = 0, birth = 0;
};
Tracked track(int harmonics) {
    const Model m = with_isola();
    const auto first = search(m, options(0.006, harmonics)), second = search(m, options(0.007, harmonics));
    Tracked t;
    if (first.branches.empty() || second.branches.empty()) return t;
    t.birth = first.branches[0].birth_force;
    const auto from = folds_of(*first.branches[0].branch), to = folds_of(*second.branches[0].branch);
    plm::FoldOptions o;
    o.hbm = options(0.006, harmonics);
    o.force_min = 0.002;
    o.force_max = 0.007;
    o.upward = true;
    t.at_second_force = 0;
    for (std::size_t i = 0; i < from.size(); ++i) { // left and right fold, to the end of the range
        const auto folds = plm::follow_folds(m, o, from[i], plm::Watch());
        if (!folds) return t;
        t.at_second_force =
            std::max(t.at_second_force, std::abs(folds->points().back().omega / to.at(i).omega - 1));
        BranchPoint jump = from[i];
        t.corrected =
            t.corrected && plm::correct_fold(m, o.hbm, 0.00605, from[i], jump) && jump.force_scale == 0.00605;
    }
    t.started = true;
    o.upward = false;
    o.stop_at_turn = true;
    const auto down = plm::follow_folds(m, o, from[0], plm::Watch());
    for (const BranchPoint &p : folds_of(*down)) t.turn = p.force_scale;
    return t;
}
void are_those_of_the_curves(const Tracked &t) {
    std::printf("    folds at a second force: relative difference %.1e; turning point %.9f, birth %.9f\n",
                t.at_second_force, t.turn, t.birth);
    assert_true(t.started && t.corrected);
    assert_true(below(t.at_second_force, 1e-6));
    assert_true(close_to(t.turn, t.birth, 1e-7));
}
void tracked_folds_are_those_of_the_curves(void **) {
    are_those_of_the_curves(track(9));
}
void tracked_folds_of_exact_motions_are_those_of_the_curves(void **) {
    are_those_of_the_curves(track(exact_motions));
}

// --- backbones of exact motions

// Where the backbone comes by the force for the last time, by harmonic balance or exactly; and what is in
// phase with the force there.
struct Crossing {
    double omega = 0, amplitude = 0, phase = 1;
    bool exact = false, with_multipliers = false;
};
Crossing crossing_of(const Model &m, const std::vector<plm::Backbone> &backbones) {
    if (backbones.size() != 1 || backbones[0].crossings.empty()) return {};
    const BranchPoint &p = backbones[0].branch->points()[backbones[0].crossings.back()];
    const double amplitude = peak_at(*m, p, 0); // the force acts there
    return {p.omega, amplitude, std::abs(plm::phase_of(*m, p, 1)) / amplitude, p.motion != nullptr,
            !p.multipliers.empty()};
}
struct Backbones {
    Crossing exact, by_hbm, by_harmonics;
    bool said = false, said_of_given = true; // that few harmonics were chosen, and were asked for
    std::vector<double> distances;           // of the frequency with 9, 27, 81 harmonics from the exact one
};
Backbones compare_backbones() {
    const Model m = with_isola();
    const double force = 0.006;
    plm::BackboneOptions o;
    o.hbm = options(force);
    Backbones out;
    o.exact = true;
    out.exact = crossing_of(m, plm::PhaseResonance(m, o, plm::Watch()).backbones());
    o.exact = false;
    for (int harmonics : {9, 27, 81}) {
        o.hbm.n_harmonics = harmonics;
        const Crossing c = crossing_of(m, plm::PhaseResonance(m, o, plm::Watch()).backbones());
        out.distances.push_back(std::abs(c.omega / out.exact.omega - 1));
    }
    out.by_hbm =
        crossing_of(m, plm::Hbm(m, 0, 0, options(force, exact_motions), plm::Watch()).find_backbones(0));
    plm::HbmOptions few = options(force, 0);
    few.motion = plm::MotionKind::harmonics;
    few.accuracy = 1e-9;
    const auto said = [&m](const plm::HbmOptions &asked) {
        return !plm::Hbm(m, 0, 0, asked, plm::Watch())
                    .find_backbones(0)
                    .at(0)
                    .branch->warnings.list()
                    .empty();
    };
    out.said = said(few), out.said_of_given = said(options(force));
    out.by_harmonics = crossing_of(m, plm::Hbm(m, 0, 0, options(force), plm::Watch()).find_backbones(0));
    return out;
}
void an_exact_backbone_is_the_limit_of_many_harmonics(void **) {
    const Backbones b = compare_backbones();
    std::printf("    9, 27, 81 harmonics off by %.1e, %.1e, %.1e\n", b.distances[0], b.distances[1],
                b.distances[2]);
    assert_true(b.exact.exact && b.exact.with_multipliers && below(b.exact.phase, 1e-9));
    // the motion has a bend in its acceleration's slope: coefficients fall with the fourth power, as far as
    // a crossing is located, to the tolerance of the motions
    assert_true(b.distances[1] < 0.1 * b.distances[0] && below(b.distances[2], 1e-9));
    assert_true(b.by_hbm.exact && !b.by_harmonics.exact);
    assert_true(b.said && !b.said_of_given);
    assert_true(close_to(b.by_hbm.omega, b.exact.omega, 1e-9));
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(linear_backbone_is_a_straight_line_at_the_phase_resonance),
        cmocka_unit_test(an_exact_backbone_is_the_limit_of_many_harmonics),
        cmocka_unit_test(isola_is_found_without_a_hint),
        cmocka_unit_test(range_of_forces_agrees_with_plain_sweeps),
        cmocka_unit_test(range_of_forces_of_exact_motions_agrees_with_plain_sweeps),
        cmocka_unit_test(a_loop_is_traced_on_a_compressed_model_that_has_it),
        cmocka_unit_test(scenes_without_isola_yield_none),
        cmocka_unit_test(stable_points_are_orbits_of_the_exact_flow),
        cmocka_unit_test(stable_points_of_exact_motions_are_orbits_of_the_exact_flow),
        cmocka_unit_test(marching_comes_upon_the_same_isola),
        cmocka_unit_test(tracked_folds_are_those_of_the_curves),
        cmocka_unit_test(tracked_folds_of_exact_motions_are_those_of_the_curves),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
