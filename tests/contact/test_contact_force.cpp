// The contact force in the frequency domain: event-exact against quadrature, grazing, and the sampled AFT's
// limit.
#include "contact/contact_force.hpp"
#include "contact/trig_polynomial.hpp"
#include "linalg/work.hpp"
#include "support/test.hpp"
#include <algorithm>
#include <random>
#include <vector>

using plm::Matrix;

namespace {

double value(const std::vector<double> &x, double t) {
    double v = x[0];
    for (std::size_t h = 1; 2 * h < x.size(); ++h)
        v += x[2 * h - 1] * std::cos(h * t) + x[2 * h] * std::sin(h * t);
    return v;
}

// Force coefficients by 20-point Gauss quadrature on many panels between zeros found by dense scan and
// bisection: an independent way, good to about 1e-14.
std::vector<double> by_quadrature(const std::vector<double> &x, double k) {
    static const double node[10] = {
        0.0765265211334973, 0.2277858511416451, 0.3737060887154195, 0.5108670019508271, 0.6360536807265150,
        0.7463319064601508, 0.8391169718222188, 0.9122344282513259, 0.9639719272779138, 0.9931285991850949};
    static const double weight[10] = {
        0.1527533871307258, 0.1491729864726037, 0.1420961093183820, 0.1316886384491766, 0.1181945319615184,
        0.1019301198172404, 0.0832767415767048, 0.0626720483341091, 0.0406014298003869, 0.0176140071391521};
    std::vector<double> cuts{0};
    const int scan = 20000;
    for (int i = 0; i < scan; ++i) {
        double a = 2 * M_PI * i / scan, b = 2 * M_PI * (i + 1) / scan;
        if ((value(x, a) > 0) == (value(x, b) > 0)) continue;
        const bool positive = value(x, a) > 0;
        for (int j = 0; j < 60; ++j) {
            const double m = 0.5 * (a + b);
            ((value(x, m) > 0) == positive ? a : b) = m;
        }
        cuts.push_back(0.5 * (a + b));
    }
    cuts.push_back(2 * M_PI);
    std::vector<double> f(x.size(), 0.0);
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
        if (value(x, 0.5 * (cuts[i] + cuts[i + 1])) <= 0) continue;
        const int panels = 40;
        for (int p = 0; p < panels; ++p) {
            const double width = (cuts[i + 1] - cuts[i]) / panels, middle = cuts[i] + (p + 0.5) * width;
            for (int g = -10; g < 10; ++g) {
                const int j = g < 0 ? -g - 1 : g;
                const double t = middle + 0.5 * width * (g < 0 ? -node[j] : node[j]);
                const double n = 0.5 * width * weight[j] * k * value(x, t);
                f[0] += n / (2 * M_PI);
                for (std::size_t h = 1; 2 * h < x.size(); ++h) {
                    f[2 * h - 1] += n * std::cos(h * t) / M_PI;
                    f[2 * h] += n * std::sin(h * t) / M_PI;
                }
            }
        }
    }
    return f;
}

std::vector<double> force(plm::ContactForce &law, const std::vector<double> &x, double k,
                          plm::ContactIndicator &s) {
    Matrix u(1, static_cast<std::int64_t>(x.size())), f;
    std::copy(x.begin(), x.end(), u.data());
    law.indicator(u, s);
    plm::apply_indicator(s, plm::vector<double>{k}, u, f);
    return std::vector<double>(f.data(), f.data() + x.size());
}

std::vector<double> random_wave(std::mt19937 &random, int harmonics) {
    std::normal_distribution<double> normal;
    std::vector<double> x(2 * harmonics + 1);
    for (int c = 0; c <= 2 * harmonics; ++c) x[c] = normal(random) / (1 + (c + 1) / 2);
    return x;
}

double worst_error_against_quadrature() {
    std::mt19937 random(7);
    double worst = 0;
    for (int harmonics : {1, 3, 5, 9, 20})
        for (int sample = 0; sample < 12; ++sample) {
            const std::vector<double> x = random_wave(random, harmonics);
            plm::ContactIndicator s;
            const auto law = plm::make_event_force(harmonics, 1);
            const std::vector<double> got = force(*law, x, 3.0, s), want = by_quadrature(x, 3.0);
            double size = 0;
            for (double v : want) size = std::max(size, std::abs(v));
            for (std::size_t c = 0; c < x.size(); ++c)
                worst = std::max(worst, std::abs(got[c] - want[c]) / (size + 1));
        }
    return worst;
}

void event_exact_coefficients_equal_quadrature(void **) {
    const double worst = worst_error_against_quadrature();
    std::printf("    event-exact against quadrature, H = 1 to 20: %.1e\n", worst);
    assert_true(below(worst, 1e-12)); // rounding of about 1e-14 per panel sum
}

// u = -depth + cos(7 t - phase): seven short contacts, each well inside one cell of the detection grid as
// depth -> 1.
double largest_jump_at_grazing() {
    double worst = 0;
    const int harmonics = 7;
    for (double phase : {0.0, 0.3, 1.1}) {
        std::vector<double> before;
        for (int i = 0; i <= 200; ++i) {
            std::vector<double> x(2 * harmonics + 1, 0.0);
            x[0] = -1.0 + 1e-4 * (i - 100); // from open for good to barely touching
            x[2 * harmonics - 1] = std::cos(phase);
            x[2 * harmonics] = std::sin(phase);
            plm::ContactIndicator s;
            const auto law = plm::make_event_force(harmonics, 1);
            const std::vector<double> f = force(*law, x, 1.0, s);
            // exact mean force of max(cos - d, 0)
            const double d = -x[0], want = d >= 1 ? 0 : (std::sqrt(1 - d * d) - d * std::acos(d)) / M_PI;
            worst = std::max(worst, std::abs(f[0] - want));
        }
    }
    return worst;
}

void grazing_contact_is_never_missed(void **) {
    assert_true(below(largest_jump_at_grazing(), 1e-13));
}

struct States {
    plm::PairState above, below, zero, touching;
};
States constant_waves() {
    States out;
    plm::ContactIndicator s;
    const auto law = plm::make_event_force(2, 1);
    force(*law, {1, 0.3, 0.2, 0.1, 0}, 1, s), out.above = s.state[0];
    force(*law, {-1, 0.3, 0.2, 0.1, 0}, 1, s), out.below = s.state[0];
    force(*law, {0, 0, 0, 0, 0}, 1, s), out.zero = s.state[0];
    force(*law, {-1, 1, 0, 0, 0}, 1, s), out.touching = s.state[0]; // maximum exactly 0
    return out;
}
void pairs_that_do_not_switch_are_recognised(void **) {
    const States s = constant_waves();
    assert_true(s.above == plm::PairState::closed);
    assert_true(s.below == plm::PairState::open);
    assert_true(s.zero == plm::PairState::open);
    assert_true(s.touching == plm::PairState::open);
}

// Derivative of the force by central differences against k J(s).
double worst_derivative_error() {
    std::mt19937 random(3);
    double worst = 0;
    for (int sample = 0; sample < 20; ++sample) {
        const int harmonics = 4;
        std::vector<double> x = random_wave(random, harmonics);
        plm::ContactIndicator s, scratch;
        const auto law = plm::make_event_force(harmonics, 1);
        force(*law, x, 2.0, s);
        for (std::size_t c = 0; c < x.size(); ++c) {
            const double step = 1e-6;
            std::vector<double> up = x, down = x;
            up[c] += step, down[c] -= step;
            const std::vector<double> fu = force(*law, up, 2.0, scratch),
                                      fd = force(*law, down, 2.0, scratch);
            for (std::size_t r = 0; r < x.size(); ++r) {
                const double want = (fu[r] - fd[r]) / (2 * step);
                const double got = 2.0 * plm::indicator_entry(s.averages.col(0), static_cast<std::int64_t>(r),
                                                              static_cast<std::int64_t>(c));
                worst = std::max(worst, std::abs(got - want));
            }
        }
    }
    return worst;
}
void jacobian_is_the_derivative_of_the_force(void **) {
    assert_true(below(worst_derivative_error(), 1e-8)); // central differences: step^2 + rounding / step
}

double sampled_error(int samples) {
    std::mt19937 random(11);
    double worst = 0;
    for (int k = 0; k < 10; ++k) {
        const std::vector<double> x = random_wave(random, 5);
        plm::ContactIndicator a, b;
        const std::vector<double> exact = force(*plm::make_event_force(5, 1), x, 1.0, a),
                                  sampled = force(*plm::make_sampled_force(5, samples, 1), x, 1.0, b);
        for (std::size_t c = 0; c < x.size(); ++c) worst = std::max(worst, std::abs(exact[c] - sampled[c]));
    }
    return worst;
}
void sampled_force_converges_to_the_exact_one(void **) {
    const double coarse = sampled_error(64), fine = sampled_error(2048);
    std::printf("    sampled AFT error: %.1e at 64 samples, %.1e at 2048\n", coarse, fine);
    assert_true(
        below(fine, coarse / 200)); // second order in the sample distance: 32^2 / 1000, with a margin of five
    assert_true(below(fine, 2e-5));
}

double worst_extremum_error() {
    std::mt19937 random(5);
    double worst = 0;
    for (int k = 0; k < 20; ++k) {
        const std::vector<double> x = random_wave(random, 8);
        const plm::ValueRange range = plm::trig_range(x.data(), 8);
        double high = -1e300, low = 1e300;
        for (int i = 0; i < 200000; ++i) {
            const double v = value(x, 2 * M_PI * i / 200000);
            high = std::max(high, v), low = std::min(low, v);
        }
        worst = std::max({worst, std::abs(range.maximum - high), std::abs(range.minimum - low)});
    }
    return worst;
}
void extrema_of_trigonometric_polynomials_are_exact(void **) {
    assert_true(below(worst_extremum_error(), 1e-7)); // the scan misses the top by x'' step^2 / 8
}

} // namespace

// A gap that stays at zero has no instants to look for, however many harmonics it might have.
struct Ear : plm::WorkListener {
    int heard = 0;
    bool goes_on() override { return ++heard < 0; }
};
void a_gap_that_stays_closed_costs_nothing(void **) {
    constexpr int h = 100;
    const auto force = plm::make_event_force(h, 2);
    Matrix u(2, 2 * h + 1);
    u(1, 0) = 1, u(1, 7) = 1; // 1 + cos 4 t: touches zero
    plm::ContactIndicator indicator;
    Ear ear;
    {
        plm::WorkScope scope(&ear);
        force->indicator(u, indicator);
    }
    assert_int_equal(indicator.n_switching, 0);
    assert_true(indicator.averages(0, 1) == 1); // closed, but for instants
    assert_in_range(ear.heard, 0, 2);           // 1e9 flops otherwise, told of every 0.1 s
}

// Closed, open, and twice to and fro.
std::int64_t n_switching(plm::ContactForce &law) {
    Matrix u(4, 3);
    u(0, 0) = 2, u(1, 0) = -2;
    for (std::int64_t i = 0; i < 4; ++i) u(i, 1) = 1;
    plm::ContactIndicator s;
    law.indicator(u, s);
    return s.n_switching;
}
void pairs_that_switch_are_counted_sampled_or_not(void **) {
    assert_int_equal(n_switching(*plm::make_event_force(1, 4)), 2);
    assert_int_equal(n_switching(*plm::make_sampled_force(1, 64, 4)), 2);
}

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(event_exact_coefficients_equal_quadrature),
        cmocka_unit_test(grazing_contact_is_never_missed),
        cmocka_unit_test(pairs_that_do_not_switch_are_recognised),
        cmocka_unit_test(jacobian_is_the_derivative_of_the_force),
        cmocka_unit_test(sampled_force_converges_to_the_exact_one),
        cmocka_unit_test(extrema_of_trigonometric_polynomials_are_exact),
        cmocka_unit_test(a_gap_that_stays_closed_costs_nothing),
        cmocka_unit_test(pairs_that_switch_are_counted_sampled_or_not),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
