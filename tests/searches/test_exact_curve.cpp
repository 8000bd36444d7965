// Curves of exact motions, with nothing set: every point, its stability, its peak and its bifurcations
// against the tests' own orbits; harmonic balance comes to them as its harmonics grow.
#include "linalg/lapack.hpp"
#include "orbits/orbit_point.hpp"
#include "orbits/stability.hpp"
#include "support/caught.hpp"
#include "support/small_solver.hpp"
#include "support/test.hpp"
#include <algorithm>

using plm::HbmOptions;
using Vec = std::vector<double>;
using test::solver;

namespace {

// q and q' over the DOFs at the beginning of the period of a point.
Vec state_over_dofs(std::shared_ptr<const plm::ReducedModel> m, const plm::BranchPoint &p) {
    const plm::FlowModel flow(m, p.omega);
    const plm::FlowState start = plm::start_of(flow, p, 1);
    Vec x;
    for (const plm::vector<double> &y : {start.y, start.v}) {
        const plm::Field q = flow.field(y);
        for (std::int64_t i = 0; i < q.rows(); ++i) x.push_back(q.at(i));
    }
    return x;
}

double largest_multiplier(const Vec &phi, int order) {
    plm::Matrix m(order, order);
    for (int i = 0; i < order; ++i)
        for (int j = 0; j < order; ++j) m(i, j) = phi[static_cast<std::size_t>(i * order + j)];
    return std::abs(plm::general_eigenvalues(m)[0]);
}

double largest(const Vec &x) {
    double size = 0;
    for (double v : x) size = std::max(size, std::abs(v));
    return size;
}

double difference(const Vec &a, const Vec &b) {
    double far = 0;
    for (std::size_t k = 0; k < a.size(); ++k) far = std::max(far, std::abs(a[k] - b[k]));
    return far;
}

struct Comparison {
    std::size_t n_points = 0, n_exact = 0;
    int peaks = 0, wrong_flags = 0;
    double defect = 0, amplitude = 0; // shares of the state; of the peak
    std::int32_t end = -1;
};
// Each fifth point: what the tests' own flow makes of its state after a period.
Comparison compare(const exact::Structure &s, double low, double high, int n_samples) {
    const auto m = test::reduce_exactly(s);
    const auto curve = solver(m, HbmOptions(), low, high).sweep();
    Comparison c;
    c.n_points = curve->points().size();
    c.end = curve->end_reason;
    const std::size_t stride = std::max<std::size_t>(5, c.n_points / 16);
    for (std::size_t i = 0; i < c.n_points; ++i) {
        const plm::BranchPoint &p = curve->points()[i];
        c.n_exact += p.motion != nullptr;
        if (i % stride != 0 || !p.motion) continue;
        const Vec start = state_over_dofs(m, p);
        Vec phi;
        const Vec end = exact::period_map(s, p.omega, start, &phi, n_samples);
        c.defect = std::max(c.defect, difference(end, start) / largest(start));
        const double mu = largest_multiplier(phi, 2 * s.n);
        if (std::abs(mu - 1) > 1e-4) c.wrong_flags += plm::stability_of(p) != (mu < 1);
        const exact::Orbit orbit = exact::periodic_orbit(s, p.omega, start, 0, n_samples);
        if (!orbit.converged || difference(orbit.start, start) > 1e-6 * largest(start)) continue;
        const plm::ValueRange range = p.motion->range(s.n - 1);
        const double got = std::max(std::abs(range.maximum), std::abs(range.minimum));
        c.amplitude = std::max(c.amplitude, std::abs(got / orbit.peak(s.n - 1) - 1));
        ++c.peaks;
    }
    return c;
}
void expect_exact(const Comparison &c, double defect, double amplitude) {
    assert_int_equal(c.end, plm::reason::range_end);
    assert_int_equal(c.n_exact, c.n_points);
    assert_true(c.peaks > 2);
    assert_int_equal(c.wrong_flags, 0);
    assert_true(below(c.defect, defect));
    assert_true(below(c.amplitude, amplitude)); // of parabolas through the samples
}
void every_point_is_an_orbit(void **) {
    expect_exact(compare(test::bilinear_oscillator(0.03, 3, 0.2, 0.3, 0), 0.5, 2.5, 800), 1e-8, 1e-5);
    expect_exact(compare(test::bilinear_oscillator(0.03, 3, 0.1, 0.3, 0.4), 0.5, 2.5, 800), 1e-8, 1e-5);
    expect_exact(compare(test::chain(4, 0.03, 3, 0.05, 0.3, 0.02, {1, 3}), 0.25, 0.6, 800), 1e-8, 1e-5);
    expect_exact(compare(test::chain(3, 0.03, 5, -0.05, 0.3, 0, {0, 1, 2}), 0.3, 1.2, 800), 1e-8, 1e-5);
}
// Impacts: 60 harmonics leave 5 to 14 % of them out.
void hard_stops_are_no_exception(void **) {
    expect_exact(compare(test::bilinear_oscillator(0.05, 1e4, 0.5, 0.5, 0), 0.6, 1.3, 8000), 1e-7, 1e-4);
    expect_exact(compare(test::bilinear_oscillator(0.05, 1e6, 0.5, 0.5, 0), 0.6, 1.3, 8000), 1e-6, 1e-4);
    expect_exact(compare(test::chain(2, 0.03, 100, 1, 0.1, 0, {1}), 0.5, 0.75, 8000), 1e-7, 1e-4);
}

// Contact so stiff that it is an impact: where the motion begins to touch the stop, the curve turns a corner
// that no step resolves. Up to 4e11 times the stiffness of the structure; at ten times that, rounding decides
// whether the corner is passed.
void curves_turn_where_impacts_begin(void **) {
    for (double stiffness : {2.5e6, 2.5e7, 2.5e8, 2.5e9, 1e11})
        for (const auto &[gap, preload] : {std::pair(1.0, 0.0), std::pair(0.0, 0.1), std::pair(0.0, 0.0)}) {
            const auto m = test::reduce_exactly(test::chain(4, 0.1, stiffness, gap, 1, preload, {3}));
            const auto curve = solver(m, HbmOptions(), 0.5, 0.9).sweep();
            assert_int_equal(curve->end_reason, plm::reason::range_end);
            for (const plm::BranchPoint &p : curve->points()) assert_non_null(p.motion.get());
        }
}

// Amplitude at one frequency by ever more harmonics, against the exact motion's.
Vec errors_of_harmonics(std::initializer_list<int> harmonics) {
    const exact::Structure s = test::bilinear_oscillator(0.05, 0.5, 0.3, 0.2, 0);
    const auto m = test::reduce_exactly(s);
    const double hz = 1.02 / (2 * M_PI);
    HbmOptions exactly;
    exactly.motion = plm::MotionKind::exact;
    const auto truth = solver(m, exactly, 0.5, 2).solve(hz, nullptr, 0);
    const plm::ValueRange range = truth->points()[0].motion->range(0);
    Vec errors;
    for (int h : harmonics) {
        HbmOptions o;
        o.n_harmonics = h;
        const auto by_harmonics = solver(m, o, 0.5, 2).solve(hz, nullptr, 0);
        const double peak = test::peak_at(*m, by_harmonics->points()[0], 0);
        errors.push_back(std::abs(peak / std::max(std::abs(range.maximum), std::abs(range.minimum)) - 1));
    }
    return errors;
}
// A light mass on a stiff spring behind the contact, 1 % of modal damping: at the resonance the contact
// closes where the period begins, and the state there turns with what rings for a moment.
std::size_t points_with_ringing(double light) {
    exact::Structure s = test::chain(4, 0.01, 10, 0, 0.01, 0, {3});
    s.mass[3] = light;
    for (int i : {2, 3})
        for (int j : {2, 3}) s.stiffness[static_cast<std::size_t>(i * s.n + j)] += i == j ? 9.0 : -9.0;
    const auto m = test::reduce_exactly(s);
    m->damping = plm::Matrix();
    m->damping_diagonal.clear();
    for (double l : m->lambda) m->damping_diagonal.push_back(2 * 0.01 * std::sqrt(l));
    const auto curve = solver(m, HbmOptions(), 0.44, 0.56).sweep();
    return curve->end_reason == plm::reason::range_end ? curve->points().size() : 99999;
}
void what_rings_does_not_dictate_the_steps(void **) {
    for (double light : {1e-2, 1e-4, 1e-6}) assert_true(points_with_ringing(light) < 200);
}

void harmonics_come_to_the_exact_motion(void **) {
    const Vec e = errors_of_harmonics({5, 10, 20, 40, 80});
    assert_true(e[0] < 1e-2 && e[1] < 0.5 * e[0]);
    assert_true(e[4] < 1e-3 * e[0]);
    assert_true(below(e[4], 1e-8));
}

// Coefficients are of the motion itself; what is left out is told.
struct Content {
    double error = 1e300, left_out = -1, tail = 1e300, coefficients = 0;
};
Content content() {
    const exact::Structure s = test::bilinear_oscillator(0.05, 3, 0.3, 0.2, 0);
    const auto m = test::reduce_exactly(s);
    HbmOptions o;
    const double hz = 1.1 / (2 * M_PI);
    const auto point = solver(m, o, 0.5, 2).solve(hz, nullptr, 0);
    o.n_harmonics = 100;
    const auto truth = solver(m, o, 0.5, 2).solve(hz, nullptr, 0);
    const plm::BranchPoint &p = point->points()[0], &t = truth->points()[0];
    const std::int64_t handed = p.eta.cols(), all = t.eta.cols();
    Content c{p.harmonic_error, plm::norm2(all - handed, t.eta.col(handed)) / plm::norm2(all, t.eta.data()),
              p.harmonic_tail, 0};
    for (std::int64_t k = 0; k < p.eta.cols(); ++k)
        c.coefficients = std::max(c.coefficients, std::abs(std::abs(p.eta(0, k)) - std::abs(t.eta(0, k))));
    return c;
}
void coefficients_are_those_of_the_motion(void **) {
    const Content c = content();
    assert_true(c.error > 0 && close_to(c.error, c.left_out, 0.01)); // of one coordinate, its gap's
    assert_true(below(c.tail, 1e-3));
    assert_true(below(c.coefficients, 1e-7));
}

std::int32_t refusal(const HbmOptions &o, double structural) {
    const auto m = test::reduce_exactly(test::bilinear_oscillator(0.05, 3, 0.3, 0.2, 0));
    m->structural = structural;
    return caught([&] { solver(m, o, 0.5, 2).solve(0.15, nullptr, 0); }).status;
}
void what_has_no_exact_motion_is_refused(void **) {
    HbmOptions o;
    o.motion = plm::MotionKind::exact;
    assert_int_equal(refusal(o, 0.02), plm::status::argument);
    HbmOptions sampled = o, hill = o;
    sampled.aft = plm::AftKind::sampled;
    hill.stability = plm::StabilityKind::hill;
    assert_int_equal(refusal(sampled, 0), plm::status::argument);
    assert_int_equal(refusal(hill, 0), plm::status::argument);
    o.motion = plm::MotionKind::automatic;
    assert_int_equal(refusal(o, 0.02), plm::status::ok); // harmonics, then
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(every_point_is_an_orbit),
        cmocka_unit_test(hard_stops_are_no_exception),
        cmocka_unit_test(curves_turn_where_impacts_begin),
        cmocka_unit_test(what_rings_does_not_dictate_the_steps),
        cmocka_unit_test(harmonics_come_to_the_exact_motion),
        cmocka_unit_test(coefficients_are_those_of_the_motion),
        cmocka_unit_test(what_has_no_exact_motion_is_refused),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
