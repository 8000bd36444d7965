// Pairs side by side against each alone, with vectors of any processor and with wide ones where there are
// any.
#include "contact/contact_force.hpp"
#include "contact/trig_lanes.hpp"
#include "contact/trig_polynomial.hpp"
#include "support/test.hpp"
#include <algorithm>
#include <random>
#include <vector>

using plm::n_lanes;

namespace {

std::vector<bool> widths() {
    if (plm::has_wide_lanes()) return {false, true};
    return {false};
}

struct Waves { // lane by lane
    std::vector<double> x;
    plm::vector<double> of(int lane) const {
        plm::vector<double> one;
        for (std::size_t k = lane; k < x.size(); k += n_lanes) one.push_back(x[k]);
        return one;
    }
};
Waves random_waves(std::mt19937 &random, int harmonics) {
    std::normal_distribution<double> normal;
    Waves w;
    for (int c = 0; c <= 2 * harmonics; ++c)
        for (int l = 0; l < n_lanes; ++l) w.x.push_back(normal(random) / (1 + (c + 1) / 2));
    return w;
}

double twist_of(const plm::vector<double> &x) {
    double twist = 0;
    for (std::size_t h = 1; 2 * h < x.size(); ++h)
        twist += static_cast<double>(h * h * h) * (std::abs(x[2 * h - 1]) + std::abs(x[2 * h]));
    return twist;
}

struct ZeroErrors {
    double value = 0, angle = 0; // x at the zero over its slope there; cosine and sine against the instant's
    int found = 0, crossing = 0, false_zeros = 0;
};
// Each cell of a grid in each lane.
ZeroErrors errors_of_zeros(int harmonics, bool wide) {
    std::mt19937 random(5);
    const int n = std::max(24, 6 * harmonics);
    ZeroErrors errors;
    for (int sample = 0; sample < 10; ++sample) {
        const Waves waves = random_waves(random, harmonics);
        for (int i = 0; i < n; ++i) {
            plm::TrigCells cells;
            cells.width = 2 * M_PI / n;
            const double t = cells.width * i, end = t + cells.width;
            for (int l = 0; l < n_lanes; ++l) {
                const auto x = waves.of(l);
                cells.cosine_low[l] = std::cos(t), cells.sine_low[l] = std::sin(t);
                cells.cosine_high[l] = std::cos(end), cells.sine_high[l] = std::sin(end);
                cells.low[l] = plm::evaluate_trig(x.data(), harmonics, t).value;
                cells.high[l] = plm::evaluate_trig(x.data(), harmonics, end).value;
                cells.twist[l] = twist_of(x);
            }
            plm::TrigZeros zeros;
            plm::zeros_in_cells(harmonics, waves.x.data(), cells, zeros, wide);
            for (int l = 0; l < n_lanes; ++l) {
                const bool crosses = (cells.low[l] > 0) != (cells.high[l] > 0);
                errors.crossing += crosses;
                if (!zeros.found[l]) continue;
                ++errors.found;
                const double at = t + zeros.after_low[l];
                errors.false_zeros += !crosses || !(zeros.after_low[l] >= 0 && at <= end);
                const plm::TrigValue v = plm::evaluate_trig(waves.of(l).data(), harmonics, at);
                errors.value = std::max(errors.value, std::abs(v.value / v.slope));
                errors.angle = std::max({errors.angle, std::abs(zeros.cosine[l] - std::cos(at)),
                                         std::abs(zeros.sine[l] - std::sin(at))});
            }
        }
    }
    return errors;
}

void zeros_are_exact(void **) {
    for (bool wide : widths())
        for (int harmonics : {1, 5, 20}) {
            const ZeroErrors e = errors_of_zeros(harmonics, wide);
            std::printf("    H = %d, %s: %d of %d crossings found, within %.1e\n", harmonics,
                        wide ? "wide" : "any", e.found, e.crossing, e.value);
            assert_true(below(e.value, 1e-13)); // rounding of x over slopes down to some 0.01
            assert_true(below(e.angle, 4e-15)); // rounding of an angle up to 2 pi
            assert_int_equal(e.false_zeros, 0);
            // The rest, in cells that may hold more than one, are for the search of each alone.
            assert_true(4 * e.found > 3 * e.crossing);
        }
}

double error_of_integrals(bool wide) {
    const int harmonics = 4;
    plm::TrigEnds ends;
    double first[n_lanes], second[n_lanes], worst = 0;
    for (int l = 0; l < n_lanes; ++l) {
        first[l] = 0.3 * l, second[l] = 0.5 + 0.7 * l;
        ends.cosine_first[l] = std::cos(first[l]), ends.sine_first[l] = std::sin(first[l]);
        ends.cosine_second[l] = std::cos(second[l]), ends.sine_second[l] = std::sin(second[l]);
    }
    std::vector<double> out((4 * harmonics + 1) * n_lanes);
    plm::integrals_between(harmonics, ends, out.data(), wide);
    for (int l = 0; l < n_lanes; ++l)
        for (int k = 1; k <= 2 * harmonics; ++k) {
            const double cosine = (std::sin(k * second[l]) - std::sin(k * first[l])) / k,
                         sine = (std::cos(k * first[l]) - std::cos(k * second[l])) / k;
            worst = std::max({worst, std::abs(out[(2 * k - 1) * n_lanes + l] - cosine),
                              std::abs(out[2 * k * n_lanes + l] - sine)});
        }
    return worst;
}
void integrals_are_exact(void **) {
    for (bool wide : widths()) assert_true(below(error_of_integrals(wide), 2e-15)); // eight turns of rounding
}

// Lanes and one pair alone against the entries of J(s), with the columns of two more pairs between.
double error_of_products(bool wide) {
    std::mt19937 random(8);
    const int harmonics = 3, n = 2 * harmonics + 1, stride = n_lanes + 2;
    std::normal_distribution<double> normal;
    std::vector<double> s((4 * harmonics + 1) * n_lanes), k(n_lanes), x(n * stride), f(n * stride),
        g(n * stride);
    for (auto *v : {&s, &k, &x})
        for (double &value : *v) value = normal(random);
    plm::apply_averages(harmonics, s.data(), k.data(), x.data(), stride, f.data(), wide);
    double worst = 0;
    for (int l = 0; l < n_lanes; ++l) {
        std::vector<double> average;
        for (int i = 0; i <= 4 * harmonics; ++i) average.push_back(s[i * n_lanes + l]);
        plm::apply_averages_of_one(harmonics, average.data(), k[l], x.data() + l, stride, g.data() + l);
        for (int c = 0; c < n; ++c) {
            double want = 0;
            for (int d = 0; d < n; ++d)
                want += k[l] * plm::indicator_entry(average.data(), c, d) * x[d * stride + l];
            worst = std::max({worst, std::abs(f[c * stride + l] - want), std::abs(g[c * stride + l] - want)});
        }
    }
    for (int c = 0; c < n; ++c) // what belongs to others is left alone
        for (int l = n_lanes; l < stride; ++l) worst += std::abs(f[c * stride + l]);
    return worst;
}
void products_are_those_of_the_entries(void **) {
    for (bool wide : widths())
        assert_true(below(error_of_products(wide), 2e-14)); // sums of 14 terms up to 10
}

int wrong_cells(bool wide) {
    const std::vector<double> low = {1, -1, 1, 2, -2, 0, 1, -3, 5, 1, -1, 0},
                              high = {2, -2, -1, 2, -2, 0, 0, -3, 5, 2, 1, 0};
    std::vector<double> bound(low.size(), 0.5);
    bound[3] = 2, bound[4] = 2, bound[5] = -HUGE_VAL, bound[11] = 0;
    std::vector<std::int64_t> got(low.size());
    got.resize(plm::indices_unclear(static_cast<std::int64_t>(low.size()), low.data(), high.data(),
                                    bound.data(), got.data(), wide));
    return got == std::vector<std::int64_t>{2, 3, 4, 6, 10, 11} ? 0 : 1;
}
void cells_that_are_not_clear_are_told(void **) {
    for (bool wide : widths()) assert_int_equal(wrong_cells(wide), 0);
}

// Pairs of all kinds together, each against itself alone: another place among the lanes is another rounding.
double error_of_many() {
    std::mt19937 random(21);
    std::uniform_real_distribution<double> mean(-2, 2);
    const int harmonics = 6, z = 37, n = 2 * harmonics + 1;
    plm::Matrix u(z, n), force, alone;
    for (int i = 0; i < z; ++i) {
        const auto x = random_waves(random, harmonics).of(0);
        for (int c = 0; c < n; ++c) u(i, c) = x[c];
        u(i, 0) = mean(random);
        if (i % 9 == 0) u(i, 0) = 10; // closed
        if (i % 9 == 1) u(i, 0) = -10;
        if (i >= 16 && i < 26) u(i, 0) = -20;                           // lanes that are open, all
        for (int c = 1; i % 9 == 2 && c < n; ++c) u(i, c) = c == n - 1; // touches and crosses 12 times
        if (i % 9 == 2) u(i, 0) = i > 10 ? 0.999 : -1.001;
    }
    const plm::vector<double> stiffness(z, 2.0);
    plm::ContactIndicator s, one;
    plm::make_event_force(harmonics, z)->indicator(u, s);
    plm::apply_indicator(s, stiffness, u, force);
    const auto law = plm::make_event_force(harmonics, 1);
    double worst = 0;
    for (int i = 0; i < z; ++i) {
        plm::Matrix x(1, n);
        for (int c = 0; c < n; ++c) x(0, c) = u(i, c);
        law->indicator(x, one);
        plm::apply_indicator(one, {2.0}, x, alone);
        if (one.state[0] != s.state[i]) return HUGE_VAL;
        for (int c = 0; c < n; ++c) worst = std::max(worst, std::abs(alone(0, c) - force(i, c)));
    }
    return worst;
}
void many_pairs_are_as_each_alone(void **) {
    assert_true(below(error_of_many(), 1e-12)); // rounding of penetrations up to 20
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(zeros_are_exact),
        cmocka_unit_test(integrals_are_exact),
        cmocka_unit_test(products_are_those_of_the_entries),
        cmocka_unit_test(cells_that_are_not_clear_are_told),
        cmocka_unit_test(many_pairs_are_as_each_alone),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
