// Folds, period doublings, branch points and Neimark-Sacker points of small oscillators against the exact
// piecewise-linear flow, whose code is independent of the library; the curves that leave there; loops that
// close.
#include "contact/trig_polynomial.hpp"
#include "linalg/work.hpp"
#include "orbits/exact_motion.hpp"
#include "orbits/stability.hpp"
#include "reduction/basis.hpp"
#include "sampling/small_models.hpp"
#include "support/small_solver.hpp"
#include "support/test.hpp"
#include <algorithm>
#include <vector>

using plm::Branch;
using plm::HbmOptions;
using Vec = std::vector<double>;
using test::solver;

namespace {

using Model = std::shared_ptr<const plm::ReducedModel>;
using BranchPtr = std::shared_ptr<const Branch>;

std::vector<std::int64_t> of_kind(const Branch &b, std::int32_t kind) {
    std::vector<std::int64_t> found;
    for (std::size_t i = 0; i < b.points().size(); ++i)
        if (b.points()[i].bifurcation == kind) found.push_back(static_cast<std::int64_t>(i));
    return found;
}

// q, q' of every DOF at t = 0
Vec state_of(const plm::ReducedModel &m, const plm::BranchPoint &p, double response_omega) {
    Vec s;
    const std::int64_t n = m.vectors.rows();
    for (int part = 0; part < 2; ++part)
        for (std::int64_t dof = 0; dof < n; ++dof) {
            const auto q = test::displacement(m, p.eta_0, p.eta, dof);
            const plm::TrigValue v = plm::evaluate_trig(q.data(), p.eta.cols() / 2, 0.0);
            s.push_back(part == 0 ? v.value : response_omega * v.slope);
        }
    return s;
}

// One degree of freedom: 1 -+ trace + det of the monodromy matrix vanishes with a multiplier at +-1.
struct Exact {
    double omega = 0;
    Vec state;
};
double characteristic(const Vec &monodromy, double sign) {
    return 1 - sign * (monodromy[0] + monodromy[3]) + monodromy[0] * monodromy[3] -
           monodromy[1] * monodromy[2];
}

// Residuals of "periodic, with a multiplier at `sign`" in the unknowns q, q', omega.
Vec residuals(const exact::Structure &s, double sign, const Vec &x) {
    Vec monodromy;
    const Vec end = exact::period_map(s, x[2], {x[0], x[1]}, &monodromy);
    return {end[0] - x[0], end[1] - x[1], characteristic(monodromy, sign)};
}

Vec solve3(std::vector<Vec> a, Vec b) {
    for (int k = 0; k < 3; ++k) {
        int p = k;
        for (int i = k + 1; i < 3; ++i)
            if (std::abs(a[i][k]) > std::abs(a[p][k])) p = i;
        std::swap(a[k], a[p]);
        std::swap(b[k], b[p]);
        for (int i = k + 1; i < 3; ++i) {
            const double f = a[i][k] / a[k][k];
            for (int j = k; j < 3; ++j) a[i][j] -= f * a[k][j];
            b[i] -= f * b[k];
        }
    }
    for (int i = 2; i >= 0; --i) {
        for (int j = i + 1; j < 3; ++j) b[i] -= a[i][j] * b[j];
        b[i] /= a[i][i];
    }
    return b;
}

// Newton with central differences; NaN when it does not converge.
double exact_bifurcation(const exact::Structure &s, double sign, const Vec &state, double omega) {
    Vec x = {state[0], state[1], omega};
    for (int k = 0; k < 12; ++k) {
        const Vec r = residuals(s, sign, x);
        std::vector<Vec> a(3, Vec(3));
        for (int j = 0; j < 3; ++j) {
            const double h = 1e-6 * std::max(std::abs(x[j]), 1e-2);
            Vec up = x, down = x;
            up[j] += h;
            down[j] -= h;
            const Vec ru = residuals(s, sign, up), rd = residuals(s, sign, down);
            for (int i = 0; i < 3; ++i) a[i][j] = (ru[i] - rd[i]) / (2 * h);
        }
        const Vec step = solve3(a, r);
        for (int j = 0; j < 3; ++j) x[j] -= step[j];
        if (std::abs(step[2]) < 1e-12 * omega && std::abs(step[0]) < 1e-10) return x[2];
    }
    return NAN;
}

// Largest relative error of the frequencies of all points of a kind.
struct Located {
    int n = 0;
    double error = 0;
};
Located errors_of(const exact::Structure &s, std::int32_t kind, double sign, double low, double high,
                  int harmonics) {
    const Model m = test::reduce_exactly(s);
    HbmOptions o;
    o.n_harmonics = harmonics;
    const BranchPtr branch = solver(m, o, low, high).sweep();
    Located found;
    for (std::int64_t i : of_kind(*branch, kind)) {
        const plm::BranchPoint &p = branch->points()[i];
        const double truth = exact_bifurcation(s, sign, state_of(*m, p, p.omega), p.omega);
        const double error = std::abs(p.omega / truth - 1);
        std::printf("    kind %d at %.9f, exact %.9f\n", kind, p.omega, truth);
        found.error = std::isfinite(error) ? std::max(found.error, error) : 1e300;
        ++found.n;
    }
    return found;
}

void period_doublings_of_the_bilinear_oscillator_are_exact(void **) {
    const Located f = errors_of(test::bilinear_oscillator(0.02, 3, 0, 1, 0),
                                plm::bifurcation::period_doubling, -1, 2.0, 3.8, 60);
    assert_int_equal(f.n, 2);
    assert_true(below(f.error, 1e-6));
}

void folds_of_the_bilinear_oscillator_are_exact(void **) {
    const Located f =
        errors_of(test::bilinear_oscillator(0.01, 3, 1.0, 0.1, 0), plm::bifurcation::fold, 1, 0.9, 1.5, 60);
    assert_true(f.n >= 2);
    assert_true(below(f.error, 1e-6));
}

// Between two stops the response loses its symmetry. The exact value: the characteristic along the symmetric
// orbits changes sign; interpolated between exact orbits on both sides.
exact::Structure two_stops() {
    exact::Structure s = test::bilinear_oscillator(0.05, 10, 0.2, 1, 0);
    s.z = 2;
    s.gap_rows = {1, -1};
    s.gap = {0.2, 0.2};
    s.contact_stiffness = {10, 10};
    return s;
}
double exact_symmetry_breaking(const exact::Structure &s, const Vec &state, double omega) {
    double x[3], y[3];
    for (int k = 0; k < 3; ++k) {
        x[k] = omega + (k - 1) * 3e-4;
        const exact::Orbit orbit = exact::periodic_orbit(s, x[k], state, 0, 400);
        if (!orbit.converged) return NAN;
        Vec monodromy;
        exact::period_map(s, x[k], orbit.start, &monodromy);
        y[k] = characteristic(monodromy, 1);
    }
    double zero = 0; // inverse quadratic interpolation
    for (int k = 0; k < 3; ++k) {
        double l = x[k];
        for (int j = 0; j < 3; ++j)
            if (j != k) l *= y[j] / (y[j] - y[k]);
        zero += l;
    }
    return zero;
}
struct Symmetry {
    double error = 1e300, asymmetry = 0, mirrored = 0, orbit_defect = 1e300;
    std::int32_t reason = 0;
};
Symmetry symmetry_breaking() {
    const exact::Structure s = two_stops();
    const Model m = test::reduce_exactly(s);
    HbmOptions o;
    o.n_harmonics = 60;
    const plm::Hbm hbm = solver(m, o, 1.2, 2.0);
    const BranchPtr branch = hbm.sweep();
    Symmetry found;
    const auto points = of_kind(*branch, plm::bifurcation::branch_point);
    if (points.size() != 1) return found;
    const plm::BranchPoint &p = branch->points()[points[0]];
    const double truth = exact_symmetry_breaking(s, state_of(*m, p, p.omega), p.omega);
    std::printf("    branch point at %.9f, exact %.9f\n", p.omega, truth);
    found.error = std::abs(p.omega / truth - 1);
    // The asymmetric curve, both sides, and one of its points followed exactly.
    const BranchPtr left = hbm.switch_branch(*branch, points[0], false),
                    right = hbm.switch_branch(*branch, points[0], true);
    found.reason = left->end_reason;
    const auto mean = [&](const plm::BranchPoint &q) { return q.eta_0[0] * m->vectors.formed().at(0, 0); };
    for (const auto &q : left->points()) found.asymmetry = std::max(found.asymmetry, std::abs(mean(q)));
    found.mirrored = mean(left->points()[1]) * mean(right->points()[1]);
    const plm::BranchPoint &q = left->points()[left->points().size() / 4];
    const Vec start = state_of(*m, q, q.omega), end = exact::period_map(s, q.omega, start, nullptr);
    found.orbit_defect = std::hypot(end[0] - start[0], (end[1] - start[1]) / q.omega) / std::abs(start[0]);
    return found;
}
void symmetry_breaking_is_exact_and_both_sides_are_found(void **) {
    const Symmetry f = symmetry_breaking();
    assert_true(below(f.error, 1e-6));
    assert_true(f.asymmetry > 0.01);
    assert_true(f.mirrored < 0);
    assert_true(below(f.orbit_defect, 1e-3)); // the truncation at H = 60, carried over one period
}

// The doubled orbit repeats after two periods of the excitation and not after one, by the exact flow.
struct Doubled {
    double after_one = 0, after_two = 1e300;
    std::int64_t multiple = 0;
    std::int32_t reason = 0;
};
Doubled doubled_orbit() {
    const exact::Structure s = test::bilinear_oscillator(0.02, 3, 0, 1, 0);
    const Model m = test::reduce_exactly(s);
    HbmOptions o;
    o.n_harmonics = 20;
    const plm::Hbm hbm = solver(m, o, 2.0, 3.8);
    const BranchPtr branch = hbm.sweep();
    Doubled d;
    const auto points = of_kind(*branch, plm::bifurcation::period_doubling);
    if (points.empty()) return d;
    const BranchPtr doubled = hbm.switch_branch(*branch, points.back(), false);
    d.multiple = doubled->period_multiple();
    d.reason = doubled->end_reason;
    const plm::BranchPoint &p = doubled->points()[doubled->points().size() / 4];
    const Vec start = state_of(*m, p, p.omega / 2), once = exact::period_map(s, p.omega, start, nullptr),
              twice = exact::period_map(s, p.omega, once, nullptr);
    const auto distance = [&](const Vec &a) {
        return std::hypot(a[0] - start[0], (a[1] - start[1]) / p.omega) /
               std::hypot(start[0], start[1] / p.omega);
    };
    d.after_one = distance(once);
    d.after_two = distance(twice);
    return d;
}
void the_doubled_response_repeats_after_two_periods(void **) {
    const Doubled d = doubled_orbit();
    assert_int_equal(d.multiple, 2);
    assert_int_equal(d.reason, plm::reason::loop_closed); // back through the other period doubling
    assert_true(d.after_one > 0.1);
    assert_true(below(d.after_two, 1e-4)); // the truncation at 20 harmonics
}

// Eigenvalues of the exact monodromy matrix of a 2-DOF orbit: |mu|^2 of the complex pair from its
// characteristic polynomial, by the largest modulus of powers of the matrix.
double spectral_radius(Vec a, int n) {
    double log_scale = 0;
    int power = 1;
    for (int k = 0; k < 30; ++k) { // a^(2^30), scaled
        Vec b(a.size(), 0.0);
        double size = 0;
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < n; ++j) {
                for (int l = 0; l < n; ++l) b[i * n + j] += a[i * n + l] * a[l * n + j];
                size = std::max(size, std::abs(b[i * n + j]));
            }
        for (double &v : b) v /= size;
        log_scale = 2 * log_scale + std::log(size);
        a = b;
        power *= 2;
    }
    return std::exp(log_scale / power);
}
// Largest modulus of the exact orbit's multipliers; `state` is the first guess and becomes the orbit's.
double exact_radius(const exact::Structure &s, double omega, Vec &state) {
    const exact::Orbit orbit = exact::periodic_orbit(s, omega, state, 0, 400);
    if (!orbit.converged) return NAN;
    state = orbit.start;
    Vec monodromy;
    exact::period_map(s, omega, state, &monodromy);
    return spectral_radius(monodromy, 2 * s.n);
}
// Where it passes 1, by secants; beside a grazing touch it does so within 1e-6 of the frequency.
double exact_torus(const exact::Structure &s, double omega, Vec state) {
    double a = omega, b = omega * (1 + 1e-8), fa = exact_radius(s, a, state) - 1,
           fb = exact_radius(s, b, state) - 1;
    for (int k = 0; k < 20 && std::abs(b - a) > 1e-10; ++k) {
        const double c = b - fb * (b - a) / (fb - fa);
        a = b, fa = fb;
        b = c, fb = exact_radius(s, b, state) - 1;
    }
    return std::abs(fb) < 1e-8 ? b : NAN;
}
// And how far the largest modulus of the points' multipliers is off, by its distance from 1.
struct Torus {
    std::size_t n = 0, n_grazing = 0;
    double error = 0, modulus_error = 0;
};
Torus neimark_sacker() {
    exact::Structure s; // two unit masses, unit springs, a stop of stiffness 100 at distance 1
    s.n = 2;
    s.z = 1;
    s.mass = {1, 1};
    s.stiffness = {2, -1, -1, 1};
    s.damping = {0.06, -0.03, -0.03, 0.03};
    s.gap_rows = {1, 0};
    s.contact_stiffness = {100};
    s.gap = {1};
    s.force = {0, 0.1};
    s.preload = {0, 0};
    const Model m = test::reduce_exactly(s);
    HbmOptions o;
    o.n_harmonics = 60;
    const BranchPtr branch = solver(m, o, 0.575, 0.72).sweep();
    Torus t;
    for (std::int64_t i : of_kind(*branch, plm::bifurcation::neimark_sacker)) {
        const plm::BranchPoint &p = branch->points()[i];
        const double truth = exact_torus(s, p.omega, state_of(*m, p, p.omega));
        std::printf("    Neimark-Sacker at %.8f, exact %.8f\n", p.omega, truth);
        t.error = std::isfinite(truth) ? std::max(t.error, std::abs(p.omega / truth - 1)) : 1e300;
        ++t.n;
    }
    for (const plm::BranchPoint &p : branch->points()) {
        if (std::abs(p.omega - 0.58195) > 7e-5) continue; // a first touch of the stop
        Vec state = state_of(*m, p, p.omega);
        const double truth = exact_radius(s, p.omega, state), modulus = std::abs(p.multipliers[0]);
        const double off = std::abs(modulus - truth);
        if (off > 1e-6) t.modulus_error = std::max(t.modulus_error, off / std::abs(truth - 1));
        ++t.n_grazing;
    }
    return t;
}
void neimark_sacker_points_agree_with_the_exact_flow(void **) {
    const Torus t = neimark_sacker();
    assert_true(t.n >= 1);
    assert_true(below(
        t.error, 1e-3)); // hits at a stiff stop converge slowly in H; the flow is exact for their instants
    // beside a touch multipliers change with the root of its depth: 5e-2 where motions are so exact only as
    // their distance from 1 asks for in proportion
    assert_true(t.n_grazing >= 5);
    assert_true(below(t.modulus_error, 2e-2));
}

// The curve of folds through one fold of the response meets the other one at the same force, and passes the
// cusp below; sweeps know nothing of it.
exact::Structure folding_oscillator() {
    return test::bilinear_oscillator(0.03, 4, 1, 0.1, 0);
}
struct FoldCurve {
    double first = 0, last = 0, ends = 0, lowest = 0; // omega at both ends, their force, the smallest force
    std::int32_t reason = 0;
};
FoldCurve fold_curve(std::size_t from, std::vector<double> &folds) {
    HbmOptions o;
    o.n_harmonics = 21;
    const plm::Hbm hbm = solver(test::reduce_exactly(folding_oscillator()), o, 0.6, 1.9);
    const BranchPtr curve = hbm.sweep();
    const auto at = of_kind(*curve, plm::bifurcation::fold);
    for (std::int64_t i : at) folds.push_back(curve->points()[i].omega);
    const auto tracked = hbm.track_fold(*curve, at.at(from), 0.3, 1.0);
    FoldCurve f;
    f.first = tracked->points().front().omega;
    f.last = tracked->points().back().omega;
    f.ends = std::min(tracked->points().front().force_scale, tracked->points().back().force_scale);
    f.lowest = 1;
    for (const plm::BranchPoint &p : tracked->points()) f.lowest = std::min(f.lowest, p.force_scale);
    f.reason = tracked->end_reason;
    return f;
}
// Two complex pairs that leave the unit circle in one step are not overlooked; a real multiplier is no pair.
void a_second_pair_does_not_hide_the_first(void **) {
    const auto test_of = [](const std::vector<std::complex<double>> &upper, double real) {
        plm::vector<std::complex<double>> all = {real};
        for (const std::complex<double> &m : upper) all.insert(all.end(), {m, std::conj(m)});
        return plm::bifurcation_tests(all);
    };
    const auto pair = [](double size, double angle) { return std::polar(size, angle); };
    const auto inside = test_of({pair(0.98, 1), pair(0.97, 2)}, 0.5),
               first = test_of({pair(1.01, 1), pair(0.97, 2)}, 0.5),
               both = test_of({pair(1.02, 1), pair(1.01, 2)}, 0.5),
               saddle = test_of({pair(0.98, 1), pair(0.97, 2)}, 1.5),
               doubled = test_of({pair(0.98, 1), pair(0.97, 2)}, -1.5);
    assert_true(inside[1] * first[1] < 0 && inside[1] * both[1] < 0 && first[1] * both[1] > 0);
    assert_true(inside[1] * saddle[1] > 0 && inside[0] * saddle[0] > 0);
    assert_true(inside[1] * doubled[1] > 0 && inside[0] * doubled[0] < 0);
}

void a_curve_of_folds_goes_to_both_sides(void **) {
    for (std::size_t from : {0, 1}) {
        std::vector<double> folds;
        const FoldCurve f = fold_curve(from, folds);
        assert_int_equal(folds.size(), 2);
        assert_int_equal(f.reason, plm::reason::range_end);
        assert_true(f.ends == 1 && f.lowest < 0.7 && f.lowest > 0.3);
        assert_true(close_to(std::min(f.first, f.last), std::min(folds[0], folds[1]), 1e-6));
        assert_true(close_to(std::max(f.first, f.last), std::max(folds[0], folds[1]), 1e-6));
    }
}

// With sampled forces the curve has a corner wherever a sample switches, and most folds are such corners.
std::vector<double> outer_folds(plm::AftKind aft) {
    HbmOptions o;
    o.n_harmonics = 7;
    o.aft = aft;
    o.time_samples = 1024; // with 256 the upper fold is 1.006e-3 beside the exact one
    o.stability = plm::StabilityKind::off;
    const BranchPtr curve = solver(test::reduce_exactly(folding_oscillator()), o, 0.6, 1.9).sweep();
    std::vector<double> folds;
    for (std::int64_t i : of_kind(*curve, plm::bifurcation::fold)) folds.push_back(curve->points()[i].omega);
    if (folds.empty()) return {0, 0};
    return {*std::min_element(folds.begin(), folds.end()), *std::max_element(folds.begin(), folds.end())};
}
void folds_are_found_with_sampled_forces(void **) {
    const std::vector<double> exact = outer_folds(plm::AftKind::event),
                              sampled = outer_folds(plm::AftKind::sampled);
    assert_true(close_to(sampled[0], exact[0], 1e-3)); // one sample of 1024 is 1e-3 of the period
    assert_true(close_to(sampled[1], exact[1], 1e-3));
}

// A solution from a start stays on the start's branch while that goes on, and says so when it does not.
struct FromStart {
    double kept = 0;     // largest difference from the branch, whose amplitude is above 1
    bool quiet = true;   // without a warning there
    bool warned = false; // beyond the fold at which the branch ends
};
FromStart solve_from_the_upper_branch() {
    HbmOptions o;
    o.n_harmonics = 21;
    o.stability = plm::StabilityKind::off;
    const plm::Hbm hbm = solver(test::reduce_exactly(folding_oscillator()), o, 0.6, 1.9);
    const BranchPtr curve = hbm.sweep();
    const auto omega = [&](std::int64_t i) { return curve->points()[i].omega; };
    auto folds = of_kind(*curve, plm::bifurcation::fold);
    std::sort(folds.begin(), folds.end(), [&](auto a, auto b) { return omega(a) < omega(b); });
    // beyond the upper fold, coming down: the branch of large amplitudes
    const std::int64_t first = folds.back() + 1, last = first + 12;
    FromStart f;
    for (std::int64_t i = first; i < last; i += 3)
        for (std::int64_t k = first; k < last; k += 3) {
            const BranchPtr one = hbm.solve(omega(k) / (2 * M_PI), curve.get(), i);
            const plm::Matrix &want = curve->points()[k].eta, &is = one->points()[0].eta;
            for (std::int64_t j = 0; j < want.cols(); ++j)
                f.kept = std::max(f.kept, std::abs(is(0, j) - want(0, j)));
            f.quiet = f.quiet && one->warnings.empty();
        }
    const BranchPtr beyond = hbm.solve(1.02 * omega(folds.back()) / (2 * M_PI), curve.get(), first);
    f.warned = beyond->warnings.has(plm::reason::other_branch);
    return f;
}
void a_solution_from_a_start_keeps_to_its_branch_or_says_so(void **) {
    const FromStart f = solve_from_the_upper_branch();
    assert_true(below(f.kept, 1e-6)); // two corrections by Newton's method to 1e-9, near a fold
    assert_true(f.quiet);
    assert_true(f.warned);
}

// Stability flags of the curve against the exact motion at the same frequency, where shooting from the point
// finds one nearby.
struct Flags {
    int looked_at = 0, wrong = 0, unknown = 0;
};
Flags flags_against_exact_motions(const exact::Structure &s, double low, double high, int harmonics,
                                  int every) {
    const Model m = test::reduce_exactly(s);
    HbmOptions o;
    o.n_harmonics = harmonics;
    const BranchPtr branch = solver(m, o, low, high).sweep();
    Flags f;
    for (std::size_t i = 0; i < branch->points().size(); i += every) {
        const plm::BranchPoint &p = branch->points()[i];
        const Vec start = state_of(*m, p, p.omega);
        Vec state = start;
        const double radius = exact_radius(s, p.omega, state);
        double far = 0, size = 0;
        for (std::size_t k = 0; k < state.size(); ++k)
            far = std::max(far, std::abs(state[k] - start[k])), size = std::max(size, std::abs(start[k]));
        if (!(std::isfinite(radius) && far < 0.1 * size && std::abs(radius - 1) > 1e-3)) continue;
        bool changes = false; // at a grazing touch the multipliers jump, and the points beside it are many
        for (double beside : {1 - 1e-5, 1 + 1e-5}) {
            Vec there = state;
            changes = changes || (exact_radius(s, beside * p.omega, there) < 1) != (radius < 1);
        }
        if (changes) continue;
        ++f.looked_at;
        const std::int64_t flag = plm::stability_of(p);
        f.unknown += flag < 0;
        f.wrong += flag >= 0 && flag != (radius < 1);
    }
    std::printf("    H = %d: %d points looked at, %d wrong, %d unknown\n", harmonics, f.looked_at, f.wrong,
                f.unknown);
    return f;
}
exact::Structure two_masses_and_a_stop() { // the oscillator of the literature
    exact::Structure s;
    s.n = 2;
    s.z = 1;
    s.mass = {1, 1};
    s.stiffness = {1, -1, -1, 2};
    s.damping = {0.03, -0.03, -0.03, 0.06};
    s.gap_rows = {1, 0};
    s.contact_stiffness = {100};
    s.gap = {1};
    s.force = {0, 0.1};
    s.preload = {0, 0};
    return s;
}
void stability_is_that_of_the_exact_motion(void **) {
    for (int harmonics : {9, 21}) {
        const Flags f = flags_against_exact_motions(two_masses_and_a_stop(), 0.5, 0.8, harmonics, 2);
        assert_true(f.looked_at >= 30);
        assert_int_equal(f.wrong, 0);
        assert_true(10 * f.unknown <= f.looked_at); // beside folds, of which this curve has four
    }
}

// Hill's method against the exact flow, for the multipliers that matter (the largest).
double hill_error(const Model &m, double omega, int harmonics) {
    HbmOptions o;
    o.n_harmonics = harmonics;
    std::complex<double> largest[2];
    for (int k = 0; k < 2; ++k) {
        o.stability = k == 0 ? plm::StabilityKind::floquet : plm::StabilityKind::hill;
        largest[k] = solver(m, o, 0.5 * omega, 2 * omega)
                         .solve(omega / (2 * M_PI), nullptr, 0)
                         ->points()[0]
                         .multipliers[0];
    }
    return std::abs(std::abs(largest[0]) / std::abs(largest[1]) - 1);
}
void hills_method_converges_to_the_multipliers_of_the_flow(void **) {
    const Model m = test::reduce_exactly(test::chain(3, 0.02, 5, 0.1, 0.3, 0.2, {0, 2}));
    const double few = hill_error(m, 0.7, 5), many = hill_error(m, 0.7, 30);
    std::printf("    largest multiplier, Hill against flow: H 5 %.1e, H 30 %.1e\n", few, many);
    assert_true(below(many, 1e-3)); // the stiffness jumps in time: its Fourier series converges slowly
    assert_true(many < few);
}

// Under a pre-load the mean has a direction of its own (P_0), in which the flow lets motions go, too.
void hills_method_bears_a_preload(void **) {
    constexpr int n = 6;
    exact::Structure s = test::two_chains(n, 2, 3, true);
    s.force.assign(s.n, 0.0), s.preload.assign(s.n, 0.0);
    s.force[n - 1] = 0.05;
    s.preload[n - 1] = 0.02, s.preload[2 * n - 1] = -0.02;
    const auto model = test::make_model(s, {{}, 0, 0.3, false, 0, {}});
    const auto sampler = std::make_shared<const plm::Sampler>(model, plm::SamplerOptions(), plm::Watch());
    plm::BasisOptions few_modes;
    few_modes.n_harmonics = 1;
    const plm::Basis basis(model, sampler, nullptr, few_modes, plm::Watch());
    assert_true(basis.reduced()->static_size() > basis.reduced()->size()); // else this shows nothing
    const double omega = M_PI * (basis.window_min_hz() + basis.window_max_hz());
    assert_true(below(hill_error(basis.reduced(), omega, 12), 1e-2)); // as above
}

// One call of LAPACK cannot be stopped: where it would take seconds, Hill's method leaves stability unknown.
void hills_method_ends_where_it_would_not_be_heard_of(void **) {
    const Model m = test::reduce_exactly(test::chain(3, 0.02, 5, 0.1, 0.3, 0.2, {0, 2}));
    HbmOptions o;
    o.stability = plm::StabilityKind::hill;
    for (int harmonics : {49, 50}) { // 6 (2 H + 1) = 594, 606
        o.n_harmonics = harmonics;
        const auto one = solver(m, o, 0.2, 1.5).solve(0.7 / (2 * M_PI), nullptr, 0);
        assert_int_equal(one->points()[0].multipliers.empty(), harmonics == 50);
        assert_int_equal(one->warnings.has(plm::reason::unverified), harmonics == 50);
    }
}

// "auto" goes up to 24 coordinates of the basis; the static response to a pre-load beside them is none of
// them. (With structural damping no flow is made before a point is known, so that the model needs no masses
// here.)
bool stability_by_default(int n, bool preloaded) {
    auto m = test::reduce_exactly(test::chain(n, 0.01, 10, 0.1, 1, 0, {3}));
    m->structural = 0.01;
    if (preloaded) {
        m->same_static = false;
        m->lambda_0.push_back(1.0);
        m->gap_0.append(plm::Matrix(m->gap.rows(), 1));
        m->preload_0.push_back(1.0);
    }
    return plm::Stability(m, HbmOptions()).wanted();
}

void twenty_four_coordinates_are_those_of_the_basis(void **) {
    assert_true(stability_by_default(24, false) && stability_by_default(24, true));
    assert_true(!stability_by_default(25, false) && !stability_by_default(25, true));
}

struct Listener final : plm::WorkListener {
    int heard = 0;
    bool goes_on() override { return ++heard < 0; }
};
// A block that rocks on 1000 springs, in a motion that is none of its own: no events of it help, and a run of
// the flow passes 2000, in seconds. Stability is not worth that unless it is asked for.
void events_count_in_the_price_of_a_flow(void **) {
    constexpr int z = 1000;
    exact::Structure s = test::chain(3, 0.05, 0.005, 0, 0.3, 0, {0});
    s.z = z;
    s.gap_rows.assign(3 * z, 0.0);
    s.contact_stiffness.assign(z, 0.005);
    s.gap.assign(z, 0.0);
    for (int p = 0; p < z; ++p) {
        s.gap_rows[3 * p] = 1;
        s.gap_rows[3 * p + 1] = p / 500.0 - 1;
        s.gap_rows[3 * p + 2] = std::sin(37.0 * p);
        s.gap[p] = 1e-3 * std::cos(37.0 * p);
    }
    const auto m = test::reduce_exactly(s);
    plm::BranchPoint point;
    point.omega = 1, point.force_scale = 1, point.n_harmonics = 1;
    point.eta_0.assign(3, 0.0);
    point.eta = plm::Matrix(3, 2);
    point.eta(0, 0) = point.eta(1, 1) = 1;
    Listener listener;
    const plm::WorkScope scope(&listener);
    const plm::EventSequence sequence = plm::contact_events(*m, point, 1);
    assert_true(sequence.events.size() >= z);
    plm::MotionBeside beside(1, plm::MotionBeside::of_curve);
    const auto none = beside.multipliers(std::make_shared<const plm::FlowModel>(m, 1.0), point, sequence,
                                         plm::Matrix(), plm::multipliers);
    printf("    %zu events, %d pieces of work\n", sequence.events.size(), listener.heard);
    assert_true(none.empty());
    assert_true(listener.heard < 3); // one run takes 19
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(twenty_four_coordinates_are_those_of_the_basis),
        cmocka_unit_test(period_doublings_of_the_bilinear_oscillator_are_exact),
        cmocka_unit_test(folds_of_the_bilinear_oscillator_are_exact),
        cmocka_unit_test(symmetry_breaking_is_exact_and_both_sides_are_found),
        cmocka_unit_test(the_doubled_response_repeats_after_two_periods),
        cmocka_unit_test(neimark_sacker_points_agree_with_the_exact_flow),
        cmocka_unit_test(a_second_pair_does_not_hide_the_first),
        cmocka_unit_test(a_curve_of_folds_goes_to_both_sides),
        cmocka_unit_test(folds_are_found_with_sampled_forces),
        cmocka_unit_test(a_solution_from_a_start_keeps_to_its_branch_or_says_so),
        cmocka_unit_test(stability_is_that_of_the_exact_motion),
        cmocka_unit_test(events_count_in_the_price_of_a_flow),
        cmocka_unit_test(hills_method_converges_to_the_multipliers_of_the_flow),
        cmocka_unit_test(hills_method_bears_a_preload),
        cmocka_unit_test(hills_method_ends_where_it_would_not_be_heard_of),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
