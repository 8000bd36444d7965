// The monodromy matrix of a given sequence of contact sets: against finite differences of the flow,
// Liouville's theorem, and what is known of single systems.
#include "flows.hpp"
#include "orbits/orbit_work.hpp"
#include "orbits/recorded_motion.hpp"
#include <chrono>

using namespace test;

namespace {

struct Case {
    exact::Structure s;
    double omega;
    int periods; // marched first
};

Case damped_chain(double k_n) {
    Case c{chain(5, 0.02, k_n, 0.05, 0.3, 0.02, {0, 2, 4}), 0.45, 10};
    c.s.damping[0] += 0.03;
    return c;
}

double determinant_magnitude(Matrix a) { // log |det| by the eigenvalues
    double sum = 0;
    for (const auto &v : plm::general_eigenvalues(a)) sum += std::log(std::abs(v));
    return sum;
}

struct Compared {
    double finite_difference = 0, liouville = 0, size = 0;
    std::size_t intervals = 0;
};
Compared compare(const Case &c) {
    const auto model = flow_model(c.s);
    plm::ExactFlow flow(model, c.omega, 1);
    const std::int64_t n = model->size();
    FlowState start{plm::vector<double>(n), plm::vector<double>(n), 0};
    start.y[0] = 0.3;
    flow.advance(start, c.periods * flow.period());
    start.time = 0;
    plm::ContactHistory history;
    FlowState end = start;
    flow.advance(end, flow.period(), &history);
    const Matrix m = plm::monodromy(*model, history.intervals());
    Matrix difference(2 * n, 2 * n);
    const double step = 1e-6;
    for (std::int64_t j = 0; j < 2 * n; ++j) {
        FlowState plus = start, minus = start;
        (j < n ? plus.y[j] : plus.v[j - n]) += step;
        (j < n ? minus.y[j] : minus.v[j - n]) -= step;
        flow.advance(plus, flow.period());
        flow.advance(minus, flow.period());
        for (std::int64_t i = 0; i < n; ++i) {
            difference(i, j) = (plus.y[i] - minus.y[i]) / (2 * step);
            difference(n + i, j) = (plus.v[i] - minus.v[i]) / (2 * step);
        }
    }
    Compared r;
    r.finite_difference = max_difference(m, difference);
    r.liouville = std::abs(determinant_magnitude(m) + test::damping_trace(*model) * flow.period());
    r.size = plm::norm2(4 * n * n, m.data());
    r.intervals = history.intervals().size();
    return r;
}
void it_is_the_derivative_of_the_flow(void **) {
    for (double k_n : {2.0, 50.0, 1e3}) {
        const Compared r = compare(damped_chain(k_n));
        std::printf("    k_n = %g: %d intervals, differences %.1e, log det %.1e\n", k_n, int(r.intervals),
                    r.finite_difference, r.liouville);
        assert_true(r.intervals > 1);
        assert_true(below(r.finite_difference, 1e-6 * std::max(1.0, std::sqrt(k_n)) * r.size));
        assert_true(below(r.liouville, 1e-9));
    }
}

plm::PairStates set(std::initializer_list<std::int32_t> flags) {
    return plm::PairStates::from_flags(flags.begin(), static_cast<std::int64_t>(flags.size()));
}

// One interval, no damping: cos w t, sin w t / w; through the series and through squaring.
double single_error(double k_n, double t) {
    const auto model = flow_model(bilinear_oscillator(0, k_n, 0, 0, 0));
    const Matrix m = plm::monodromy(*model, {{t, set({1})}});
    const double w = std::sqrt(1 + k_n), c = std::cos(w * t), s = std::sin(w * t);
    return std::max(
        {std::abs(m(0, 0) - c), std::abs(m(1, 1) - c), std::abs(m(0, 1) * w - s), std::abs(m(1, 0) / w + s)});
}
void a_single_interval_is_its_exponential(void **) {
    assert_true(below(single_error(3, 1e-3), 1e-15));
    assert_true(below(single_error(3, 1.4), 1e-14));
    assert_true(below(single_error(3, 100), 1e-12));
    assert_true(below(single_error(1e6, 1), 1e-11));
    assert_true(below(single_error(1e12, 1e-3), 1e-11));
}

// Beyond critical damping z, m = exp(-z w t) (cosh, sinh); a long series of what has died away would be a
// difference of large terms.
double damped_error(double z, double t, double tolerance) {
    const auto model = flow_model(bilinear_oscillator(z, 3, 0, 0, 0));
    const Matrix m = plm::monodromy(*model, {{t, set({1})}}, tolerance);
    const double w = 2, d = z, root = std::sqrt(d * d - w * w), up = std::exp((root - d) * t),
                 down = std::exp((-root - d) * t), c = 0.5 * (up + down), s = 0.5 * (up - down) / root;
    return std::max({std::abs(m(0, 0) - c - d * s), std::abs(m(1, 1) - c + d * s), std::abs(m(0, 1) - s),
                     std::abs(m(1, 0) + w * w * s)}) /
           up;
}
void what_is_damped_hard_keeps_its_digits(void **) {
    for (double t : {0.01, 0.3, 1.0, 3.0, 30.0}) {
        assert_true(below(damped_error(4, t, 1e-15), 1e-12));
        assert_true(below(damped_error(4, t, 1e-7), 1e-5)); // part of it in single precision
    }
}

// A free mass goes on as it goes; and what hardly lasts changes nothing.
void what_nothing_holds_goes_on(void **) {
    exact::Structure s = bilinear_oscillator(0, 3, 0, 0, 0);
    s.stiffness[0] = 0;
    const auto model = flow_model(s);
    for (double tolerance : {1e-15, 1e-7})
        for (double t : {1e-300, 1e-60, 1e-9, 0.5, 300.0}) {
            const Matrix m = plm::monodromy(*model, {{t, set({0})}}, tolerance);
            const double allowed = tolerance > 1e-10 ? 1e-6 : 1e-14;
            assert_true(below(std::abs(m(0, 0) - 1) + std::abs(m(1, 1) - 1), allowed));
            assert_true(below(std::abs(m(0, 1) - t), allowed * t));
            assert_true(below(std::abs(m(1, 0)), 1e-14));
        }
}

// In single precision where pieces are short; unit: of the rates. Long pieces are for double precision.
double single_precision_error(double unit, double longest) {
    Case c = damped_chain(50);
    for (std::vector<double> *k : {&c.s.stiffness, &c.s.contact_stiffness})
        for (double &v : *k) v *= unit * unit;
    for (double &v : c.s.damping) v *= unit;
    const auto model = flow_model(c.s);
    std::vector<plm::ContactInterval> intervals;
    for (int k = 0; k < 30; ++k) {
        intervals.push_back({0.02 / unit, set({1, 0, 1})});
        intervals.push_back({1e-9 / unit, set({0, 1, 1})});
        intervals.push_back({0.1 / unit, set({0, 0, 1})});
        intervals.push_back({longest / unit, set({1, 1, 1})});
    }
    Matrix a = plm::monodromy(*model, intervals), b = plm::monodromy(*model, intervals, 1e-7);
    const std::int64_t n = model->size();
    for (Matrix *m : {&a, &b})
        for (std::int64_t j = 0; j < n; ++j)
            for (std::int64_t i = 0; i < n; ++i) (*m)(i, n + j) *= unit, (*m)(n + i, j) /= unit;
    return max_difference(a, b) / max_difference(a, Matrix(2 * n, 2 * n));
}
void single_precision_has_five_digits(void **) {
    const double error = single_precision_error(1, 0.3);
    assert_true(error > 1e-9 && below(error, 1e-5)); // it is not double precision
    assert_true(below(single_precision_error(1e4, 0.3), 1e-5));
    assert_true(below(single_precision_error(1e24, 0.3), 1e-5));
    assert_true(below(single_precision_error(1, 100), 1e-6)); // the truncation
}

// Cutting intervals changes nothing; intervals of no length neither.
double cut_error() {
    const Case c = damped_chain(50);
    const auto model = flow_model(c.s);
    const std::vector<plm::ContactInterval> whole{
        {3.0, set({1, 0, 1})}, {2.0, set({0, 0, 1})}, {40.0, set({1, 1, 1})}};
    std::vector<plm::ContactInterval> cut;
    for (const auto &interval : whole)
        for (int k = 0; k < 60; ++k) {
            cut.push_back({interval.duration / 60, interval.states});
            cut.push_back({0.0, set({0, 1, 0})});
        }
    const Matrix a = plm::monodromy(*model, whole), b = plm::monodromy(*model, cut);
    return max_difference(a, b);
}
void cutting_intervals_changes_nothing(void **) {
    assert_true(below(cut_error(), 1e-11));
}

// Undamped motion is symplectic: multipliers come in pairs m, 1 / m.
double reciprocal_error() {
    Case c = damped_chain(5);
    std::fill(c.s.damping.begin(), c.s.damping.end(), 0.0);
    const auto model = flow_model(c.s);
    const auto m = plm::multipliers(plm::monodromy(
        *model,
        {{2.0, set({1, 0, 0})}, {1.5, set({1, 1, 0})}, {4.0, set({0, 0, 0})}, {0.7, set({1, 1, 1})}}));
    double worst = 0;
    for (const auto &a : m) {
        double nearest = 1e300;
        for (const auto &b : m) nearest = std::min(nearest, std::abs(a * b - 1.0));
        worst = std::max(worst, nearest);
    }
    return worst;
}
void undamped_multipliers_come_in_reciprocal_pairs(void **) {
    assert_true(below(reciprocal_error(), 1e-9));
}

void wrong_intervals_are_refused(void **) {
    const auto model = flow_model(damped_chain(5).s);
    assert_int_equal(failure_of([&] {
                         plm::monodromy(*model, {{1.0, set({1, 0})}});
                     }).status,
                     plm::status::argument);
    assert_int_equal(failure_of([&] {
                         plm::monodromy(*model, {{-1.0, set({1, 0, 0})}});
                     }).status,
                     plm::status::argument);
}

// The cost of a stability statement; the numbers stand in docs and are printed, not judged.
// A stop of 1e40: 1e21 radian in a period, of which no digit is known.
std::int32_t reason_of_no_digit() {
    const exact::Structure s = bilinear_oscillator(0.05, 1e40, 0, 1, 0);
    try {
        plm::monodromy(*flow_model(s), {{10.0, set({1})}});
    } catch (const plm::Error &e) {
        return e.reason();
    }
    return plm::reason::none;
}
void a_phase_without_a_digit_is_said(void **) {
    assert_int_equal(reason_of_no_digit(), plm::reason::not_finite);
}

void print_times(void **) {
    for (int n : {12, 24, 42}) {
        exact::Structure s = chain(n, 0.01, 10, 0, 0, 0, {});
        s.z = 90;
        s.gap_rows.assign(90 * n, 0.0);
        for (int p = 0; p < 90; ++p)
            for (int j = 0; j < n; ++j) s.gap_rows[p * n + j] = std::cos(0.37 * (p + 1) * (j + 1));
        s.contact_stiffness.assign(90, 0.5);
        s.gap.assign(90, 0.0);
        const auto model = flow_model(s);
        for (double spread : {30.0, 100.0}) { // highest frequency over that of the response
            std::vector<plm::ContactInterval> intervals(180);
            plm::ContactSet all(*model);
            all.assign_stiffest();
            const double period = 2 * M_PI * spread / all.rate();
            for (int i = 0; i < 180; ++i) {
                intervals[i].duration = period / 180;
                intervals[i].states = plm::PairStates::all_open(90);
                for (int p = 0; p < 90; ++p) intervals[i].states.set(p, (i < 90) == (p < i % 90));
            }
            const auto begin = std::chrono::steady_clock::now();
            const Matrix m = plm::monodromy(*model, intervals);
            const auto middle = std::chrono::steady_clock::now();
            const auto values = plm::multipliers(m);
            const auto end = std::chrono::steady_clock::now();
            std::printf("    n = %d, 180 intervals, %g x: %.1f ms + multipliers %.1f ms, largest %.3g\n", n,
                        spread, 1e3 * std::chrono::duration<double>(middle - begin).count(),
                        1e3 * std::chrono::duration<double>(end - middle).count(), std::abs(values[0]));
        }
    }
}

// The mean work against a harmonic load over two periods, by the Fourier coefficients of the motion; and its
// derivative by where that begins.
double work_of(plm::ExactFlow &flow, FlowState state, const plm::HarmonicLoad &load) {
    plm::RecordedMotion motion;
    flow.advance(state, 2 * flow.period(), &motion);
    const Matrix q = motion.harmonics(4, 1);
    double sum = 0;
    for (std::int64_t j = 0; j < q.rows(); ++j) sum += load.real[j] * q(j, 0) - load.imag[j] * q(j, 1);
    return 0.5 * sum;
}
double error_of_work_gradient(double k_n) {
    const Case c = damped_chain(k_n);
    const auto model = flow_model(c.s);
    const auto modes = std::make_shared<plm::ContactModesKept>(model);
    plm::ExactFlow flow(model, c.omega, 1, plm::Watch(), modes);
    const std::int64_t n = model->size();
    plm::HarmonicLoad load;
    for (std::int64_t j = 0; j < n; ++j) {
        load.real.push_back(1 + 0.3 * static_cast<double>(j));
        load.imag.push_back(std::sin(static_cast<double>(j) + 1));
    }
    FlowState start{plm::vector<double>(n), plm::vector<double>(n), 0};
    start.y[0] = 0.3;
    flow.advance(start, c.periods * flow.period());
    start.time = 0;
    plm::ContactHistory history;
    FlowState end = start;
    flow.advance(end, 2 * flow.period(), &history);
    const plm::vector<double> row =
        plm::work_gradient(*model, history.intervals(), load, 2 * c.omega, *modes);
    if (static_cast<std::int64_t>(row.size()) != 2 * n || history.intervals().size() < 4) return 1e300;
    double worst = 0, size = 0;
    const double step = 1e-6, duration = 2 * flow.period();
    for (std::int64_t j = 0; j < 2 * n; ++j) {
        FlowState plus = start, minus = start;
        (j < n ? plus.y[j] : plus.v[j - n]) += step;
        (j < n ? minus.y[j] : minus.v[j - n]) -= step;
        const double difference =
            duration * (work_of(flow, plus, load) - work_of(flow, minus, load)) / (2 * step);
        worst = std::max(worst, std::abs(row[j] - difference));
        size = std::max(size, std::abs(row[j]));
    }
    return worst / size;
}
void work_has_the_derivative_of_differences(void **) {
    for (double k_n : {3.0, 300.0}) assert_true(below(error_of_work_gradient(k_n), 1e-6)); // see compare()
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(it_is_the_derivative_of_the_flow),
        cmocka_unit_test(work_has_the_derivative_of_differences),
        cmocka_unit_test(a_single_interval_is_its_exponential),
        cmocka_unit_test(what_is_damped_hard_keeps_its_digits),
        cmocka_unit_test(what_nothing_holds_goes_on),
        cmocka_unit_test(single_precision_has_five_digits),
        cmocka_unit_test(cutting_intervals_changes_nothing),
        cmocka_unit_test(undamped_multipliers_come_in_reciprocal_pairs),
        cmocka_unit_test(wrong_intervals_are_refused),
        cmocka_unit_test(a_phase_without_a_digit_is_said),
        cmocka_unit_test(print_times),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
