// The equations of the pairs that switch, of which the largest are solved by iteration: as by the whole
// matrix, with its sign; where the iteration does not converge the whole matrix takes over.
#include "contact/contact_force.hpp"
#include "hbm/make_system.hpp"
#include "hbm/moving_pairs.hpp"
#include "searches/hbm.hpp"
#include "support/small_reduced.hpp"
#include "support/test.hpp"
#include <cmath>
#include <random>

using plm::MovingPairs;

namespace {

// Pairs on a structure of 30 modes between 0.3 and 30 times the excitation, in random motion.
class Equations {
  public:
    Equations(std::int64_t n_harmonics, std::int64_t n_pairs, double stiffness, unsigned seed)
        : h_(n_harmonics), s_(n_pairs), random_(seed) {
        gap_.reset(s_, 30);
        for (std::int64_t k = 0; k < 30 * s_; ++k) gap_.data()[k] = normal_(random_);
        plm::Matrix u(s_, 2 * h_ + 1);
        for (std::int64_t p = 0; p < s_; ++p)
            for (std::int64_t c = 0; c <= 2 * h_; ++c)
                u(p, c) = normal_(random_) / (1 + static_cast<double>(c * c));
        plm::make_event_force(h_, s_)->indicator(u, indicator_);
        stiffness_ = stiffness;
    }
    void fill(MovingPairs &pairs) const {
        const std::int64_t n = 2 * h_ + 1;
        for (std::int64_t h = 0; h <= h_; ++h) {
            plm::Matrix real(s_, s_), imag(s_, s_);
            for (std::int64_t j = 0; j < 30; ++j) {
                const double w = 0.3 + static_cast<double>(j), k = static_cast<double>(h);
                const std::complex<double> d = 1.0 / std::complex<double>(w * w - k * k, 0.02 * w * k);
                for (std::int64_t q = 0; q < s_; ++q)
                    for (std::int64_t p = 0; p < s_; ++p) {
                        real(p, q) += gap_(p, j) * d.real() * gap_(q, j);
                        imag(p, q) += gap_(p, j) * d.imag() * gap_(q, j);
                    }
            }
            pairs.elimination(h).build(real, imag, s_, {});
        }
        pairs.tangent().reset(n * n, s_);
        for (std::int64_t p = 0; p < s_; ++p)
            for (std::int64_t c = 0; c < n; ++c)
                for (std::int64_t r = 0; r < n; ++r)
                    pairs.tangent()(r + c * n, p) =
                        stiffness_ * plm::indicator_entry(indicator_.averages.col(p), r, c);
    }
    plm::vector<double> right_hand_side() {
        plm::vector<double> b(s_ * (2 * h_ + 1));
        for (double &v : b) v = normal_(random_);
        return b;
    }

  private:
    std::int64_t h_, s_;
    std::mt19937 random_;
    std::normal_distribution<double> normal_;
    plm::Matrix gap_;
    plm::ContactIndicator indicator_;
    double stiffness_;
};

double relative_difference(const plm::vector<double> &a, const plm::vector<double> &b) {
    double off = 0, size = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        off = std::max(off, std::abs(a[i] - b[i])), size = std::max(size, std::abs(b[i]));
    return off / size;
}

struct Comparison {
    int n_iterated = 0, n_negative = 0, n_same_sign = 0, n = 0;
    double worst = 0;
};
Comparison compare(double stiffness) {
    constexpr std::int64_t n_pairs = 12;
    Comparison all;
    for (unsigned seed = 1; seed <= 30; ++seed) {
        Equations equations(16, n_pairs, stiffness, seed);
        MovingPairs iterated(16), whole(16);
        equations.fill(iterated), equations.fill(whole);
        iterated.factor(MovingPairs::Method::iterated);
        whole.factor(MovingPairs::Method::whole);
        const plm::vector<double> b = equations.right_hand_side();
        plm::vector<double> x = b, y = b;
        iterated.solve(x.data()), whole.solve(y.data());
        all.worst = std::max(all.worst, relative_difference(x, y));
        all.n_same_sign += iterated.determinant_sign() == whole.determinant_sign();
        all.n_negative += whole.determinant_sign() < 0;
        all.n_iterated += iterated.is_iterated();
        ++all.n;
    }
    return all;
}

// Of either sign: with a negative stiffness half of the determinants are negative.
void iterated_solutions_are_those_of_the_whole_matrix(void **) {
    for (double stiffness : {0.3, -0.3, 3.0}) {
        const Comparison soft = compare(stiffness);
        assert_int_equal(soft.n_iterated, soft.n);
        assert_int_equal(soft.n_same_sign, soft.n);
        assert_true(stiffness > 0 || (soft.n_negative > 5 && soft.n_negative < soft.n - 5));
        assert_true(below(soft.worst, 1e-9)); // residual 1e-11 of the right-hand side, condition about 10
    }
}

// Contact so stiff that its mean over the period says little of it.
void the_whole_matrix_takes_over_where_iteration_fails(void **) {
    const Comparison stiff = compare(100);
    assert_true(stiff.n_iterated < stiff.n / 2);
    assert_int_equal(stiff.n_same_sign, stiff.n);
    assert_true(below(stiff.worst, 1e-8)); // condition up to 1e3
}

// Only where it pays: few pairs or few harmonics are factored at once.
bool is_iterated(std::int64_t n_harmonics, std::int64_t n_pairs) {
    Equations equations(n_harmonics, n_pairs, 0.03, 1);
    MovingPairs pairs(n_harmonics);
    equations.fill(pairs);
    pairs.factor();
    return pairs.is_iterated();
}
void large_equations_are_iterated(void **) {
    assert_false(is_iterated(5, 40));
    assert_false(is_iterated(20, 3));
    assert_true(is_iterated(40, 40));
}

// After a failure the whole matrix is factored without a trial for a while.
void a_failure_is_remembered(void **) {
    Equations soft(40, 30, 0.03, 1), stiff(40, 30, 1e6, 1);
    MovingPairs pairs(40);
    stiff.fill(pairs);
    pairs.factor();
    assert_true(pairs.is_iterated());
    plm::vector<double> b = stiff.right_hand_side();
    pairs.solve(b.data());
    assert_false(pairs.is_iterated());
    soft.fill(pairs);
    pairs.factor();
    assert_false(pairs.is_iterated());
}

// 16 pairs without pre-load, so that all of them switch: at 40 harmonics their equations are iterated
// (large_equations_are_iterated). The points of a curve are solutions of the equations in reduced
// coordinates, which have another Jacobian.
struct Curve {
    std::size_t n_points = 0;
    std::int64_t fewest_switching = 1000;
    double worst = 0; // residual over the excitation
};
Curve curve_in_gaps() {
    std::vector<int> pairs;
    for (int i = 1; i < 32; i += 2) pairs.push_back(i);
    const auto m = test::reduce_exactly(test::chain(32, 0.02, 1, 0, 0.4, 0, pairs));
    plm::HbmOptions o;
    o.n_harmonics = 40;
    o.motion = plm::MotionKind::harmonics;
    o.unknowns = plm::NonlinearUnknowns::gaps;
    o.stability = plm::StabilityKind::off;
    o.frequency_min_hz = 0.035 / (2 * M_PI);
    o.frequency_max_hz = 0.07 / (2 * M_PI);
    o.max_points = 25;
    const auto branch = plm::Hbm(m, 0, 0, o, plm::Watch()).sweep();
    const auto modal = plm::make_modal_system(m, o);
    plm::vector<double> x(modal->size()), r(x.size());
    Curve all;
    for (const plm::BranchPoint &point : branch->points()) {
        modal->from_point(point, x.data());
        modal->residual(x.data(), point.omega, r.data());
        all.worst = std::max(all.worst, plm::norm2(modal->size(), r.data()) / modal->residual_scale());
        all.fewest_switching = std::min(all.fewest_switching, modal->indicator().n_switching);
        ++all.n_points;
    }
    return all;
}
void curves_by_iteration_solve_the_equations(void **) {
    const Curve all = curve_in_gaps();
    assert_int_equal(all.n_points, 25);
    assert_int_equal(all.fewest_switching, 16);
    assert_true(is_iterated(40, 16));
    assert_true(below(all.worst, 1e-8)); // tolerance 1e-9 of the motion, whose stiffness is larger here
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(iterated_solutions_are_those_of_the_whole_matrix),
        cmocka_unit_test(the_whole_matrix_takes_over_where_iteration_fails),
        cmocka_unit_test(large_equations_are_iterated),
        cmocka_unit_test(a_failure_is_remembered),
        cmocka_unit_test(curves_by_iteration_solve_the_equations),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
