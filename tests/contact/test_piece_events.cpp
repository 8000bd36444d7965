// What the ends of a piece say of the pairs within it, against dense samples of quartics whose values, rates
// and fourth derivatives are known.
#include "contact/piece_events.hpp"
#include "support/test.hpp"
#include <cmath>
#include <random>

namespace {

// u(t) = sum c_k t^k.
struct Quartic {
    double c[5];
    double at(double t) const { return c[0] + t * (c[1] + t * (c[2] + t * (c[3] + t * c[4]))); }
    double rate(double t) const { return c[1] + t * (2 * c[2] + t * (3 * c[3] + t * 4 * c[4])); }
    bool is_positive(double from, double to) const {
        for (int k = 0; k <= 2000; ++k)
            if (!(at(from + (to - from) * k / 2000) > 0)) return false;
        return true;
    }
};

plm::Matrix end_of(const Quartic &u, double t, double side) {
    plm::Matrix end(1, 2);
    end(0, 0) = side * u.at(t), end(0, 1) = side * u.rate(t);
    return end;
}

// One pair, closed (side 1) or open (-1).
bool stays(const Quartic &u, double duration, double side, bool leaves = false) {
    plm::Contact contact;
    contact.stiffness = {1}, contact.initial_gap = {0};
    plm::Matrix gap(1, 1);
    gap(0, 0) = 1;
    plm::PieceEvents events(contact, gap);
    events.guess({side});
    return events.not_staying(end_of(u, 0, side), end_of(u, duration, side), {24 * std::abs(u.c[4])}, {1e-16},
                              duration, leaves ? 0 : -1) < 0;
}

void no_pair_that_comes_to_zero_is_said_to_stay(void **) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> number(-1, 1);
    int n_staying = 0, n_dips = 0;
    for (int k = 0; k < 20000; ++k) {
        const Quartic u{{std::abs(number(random)), number(random), 2 * number(random), 3 * number(random),
                         3 * number(random)}};
        const double side = k % 2 ? 1 : -1;
        const bool positive = u.is_positive(0, 1), said = stays(u, 1, side);
        assert_true(positive || !said);
        n_staying += said;
        n_dips += !positive && u.at(1) > 0;
    }
    assert_true(n_staying > 4000); // of 20,000: the bound is of use
    assert_true(n_dips > 300);     // and is put to the test between ends that are on their side
}

void a_known_zero_at_the_end_is_no_other(void **) {
    const Quartic falls{{1, -0.5, 0, 0, -0.5}}, grazes{{1, -2, 1, 0, 0}}, dips{{0.02, -0.5, 1.4, -0.92, 0}};
    assert_true(stays(falls, 1, 1, true) && stays(falls, 1, -1, true));
    assert_false(stays(falls, 1, 1));        // it would have to be clear of zero
    assert_false(stays(grazes, 1, 1, true)); // it comes back to the side it was on
    assert_false(stays(dips, 1, 1, true));   // there was a zero before
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(no_pair_that_comes_to_zero_is_said_to_stay),
        cmocka_unit_test(a_known_zero_at_the_end_is_no_other),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
