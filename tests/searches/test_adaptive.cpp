// What the solver leaves out by itself: harmonics by point, pairs that do not move (unknowns by cost). Each
// can be switched off, and the answer then agrees.
#include "contact/trig_polynomial.hpp"
#include "hbm/harmonic_choice.hpp"
#include "searches/curve.hpp"
#include "support/small_solver.hpp"
#include "support/test.hpp"
#include <algorithm>
#include <vector>

using plm::HbmOptions;
using test::peak_at;
using test::solver;

namespace {

using Model = std::shared_ptr<const plm::ReducedModel>;
using BranchPtr = std::shared_ptr<const plm::Branch>;

double peak_of(const plm::ReducedModel &m, const plm::Branch &b, int dof) {
    double top = 0;
    for (const auto &p : b.points()) top = std::max(top, peak_at(m, p, dof));
    return top;
}

// A mass against a stop at a distance: linear on the flanks, hits at the resonance.
struct Chosen {
    std::int64_t fewest = 1000, most = 0, over = 0;
    double error = 1e300, widest = 0;
    std::int32_t reason = 0;
};
Chosen chosen_harmonics() {
    const Model m = test::reduce_exactly(test::bilinear_oscillator(0.01, 3, 1.0, 0.1, 0));
    HbmOptions automatic = test::by_harmonics(), many = automatic;
    many.n_harmonics = 60;
    many.max_step = automatic.max_step = 0.02; // dense points: peaks are compared
    const BranchPtr a = solver(m, automatic, 0.6, 1.8).sweep(), b = solver(m, many, 0.6, 1.8).sweep();
    Chosen c;
    c.reason = a->end_reason;
    for (const auto &p : a->points()) {
        c.fewest = std::min(c.fewest, p.n_harmonics);
        c.most = std::max(c.most, p.n_harmonics);
        c.over += p.harmonic_error > automatic.allowed_harmonic_error();
    }
    c.error = std::abs(peak_of(*m, *a, 0) / peak_of(*m, *b, 0) - 1);
    return c;
}
void harmonics_follow_the_need_of_each_point(void **) {
    const Chosen c = chosen_harmonics();
    std::printf("    H between %d and %d, peak against H = 60: %.1e, points over the tolerance: %d\n",
                static_cast<int>(c.fewest), static_cast<int>(c.most), c.error, static_cast<int>(c.over));
    assert_int_equal(c.reason, plm::reason::range_end);
    assert_true(c.fewest == 3 && c.most > 5 && c.most < 60);
    assert_true(below(c.error, 1e-3));
    assert_int_equal(c.over, 0); // points with too few are solved again with more
}

// One solution: grown until the next ones change next to nothing; nearer to the exact orbit than the number
// it began with.
struct Settled {
    std::int64_t harmonics = 0;
    double error = 1e300, error_5 = 1e300, left = 1;
};
Settled settled_point(bool corrected) {
    const exact::Structure s = test::chain(3, 0.02, 20, 0.1, 0.4, 0.2, {0, 2});
    const Model m = test::reduce_exactly(s);
    const double omega = 0.85;
    Settled r;
    for (int k = 0; k < 2; ++k) {
        HbmOptions o = test::by_harmonics();
        o.tail_correction = corrected;
        if (k == 0) o.n_harmonics = 5;
        const plm::BranchPoint p = solver(m, o, 0.3, 1).solve(omega / (2 * M_PI), nullptr, 0)->points()[0];
        std::vector<double> start;
        for (int part = 0; part < 2; ++part)
            for (int dof = 0; dof < 3; ++dof) {
                const auto q = test::displacement(*m, p.eta_0, p.eta, dof);
                const plm::TrigValue v = plm::evaluate_trig(q.data(), p.eta.cols() / 2, 0.0);
                start.push_back(part == 0 ? v.value : omega * v.slope);
            }
        const exact::Orbit orbit = exact::periodic_orbit(s, omega, start, 0, 2000);
        const double error = orbit.converged ? std::abs(peak_at(*m, p, 2) / orbit.peak(2) - 1) : 1e300;
        (k == 0 ? r.error_5 : r.error) = error;
        if (k == 1) r.harmonics = p.n_harmonics, r.left = p.harmonic_error;
    }
    return r;
}
void a_single_solution_takes_the_harmonics_it_needs(void **) {
    const Settled plain = settled_point(false), corrected = settled_point(true);
    std::printf("    H = %d: %.1e, H = 5: %.1e, with tail %.1e\n", static_cast<int>(plain.harmonics),
                plain.error, plain.error_5, corrected.error_5);
    assert_true(plain.harmonics > 5);
    assert_true(below(plain.left, test::by_harmonics().allowed_harmonic_error()));
    assert_true(below(plain.error, 0.5 * plain.error_5));
    assert_true(
        below(corrected.error_5, plain.error_5)); // the exact force knows more than the harmonics kept
}

// What the next harmonics would change, as estimated, against what 60 harmonics do change in the motion (norm
// of M), away from the resonance, where both have the same frequency.
struct Estimates {
    double least = 1e300, most = 0;
};
Estimates estimates() {
    const exact::Structure s = test::chain(3, 0.02, 20, 0.1, 0.4, 0.2, {0, 2});
    const Model m = test::reduce_exactly(s);
    Estimates e;
    for (const plm::NonlinearUnknowns unknowns :
         {plm::NonlinearUnknowns::modal, plm::NonlinearUnknowns::gaps})
        for (const double omega : {0.62, 0.7, 0.85, 1.0})
            for (const std::int64_t n : {10, 20}) {
                HbmOptions few = test::by_harmonics(), many = few;
                few.n_harmonics = n, many.n_harmonics = 60;
                few.unknowns = many.unknowns = unknowns;
                const BranchPtr coarse = solver(m, few, 0.3, 1.2).solve(omega / (2 * M_PI), nullptr, 0),
                                fine = solver(m, many, 0.3, 1.2).solve(omega / (2 * M_PI), coarse.get(), 0);
                plm::BranchPoint p = coarse->points()[0];
                plm::measure_harmonics(m, few, p);
                plm::Matrix eta = p.eta, change = fine->points()[0].eta;
                const double size = plm::norm2(eta.rows() * eta.cols(), eta.data());
                plm::set_harmonics(eta, 60);
                for (std::int64_t k = 0; k < eta.rows() * eta.cols(); ++k) change.data()[k] -= eta.data()[k];
                const double truth = plm::norm2(change.rows() * change.cols(), change.data()) / size;
                std::printf("    omega %.2f, H = %d: %.1e, true %.1e\n", omega, static_cast<int>(n),
                            p.harmonic_error, truth);
                e.least = std::min(e.least, p.harmonic_error / truth);
                e.most = std::max(e.most, p.harmonic_error / truth);
            }
    return e;
}
void missing_harmonics_are_estimated(void **) {
    const Estimates e = estimates();
    std::printf("    estimate over truth: %.2f to %.2f\n", e.least, e.most);
    assert_true(e.least > 0.2 && e.most < 3); // one step, and only the next H + 2 of the missing harmonics
}

// Eight pairs of which few move: unknowns chosen by cost against both fixed choices.
struct Spaces {
    std::string automatic;
    double modal_error = 1e300, gaps_error = 1e300;
};
Spaces spaces() {
    const exact::Structure s = test::chain(8, 0.02, 30, 0, 0.05, 0.4, {0, 1, 2, 3, 4, 5, 6, 7});
    const Model m = test::reduce_exactly(s);
    BranchPtr found[3];
    for (int k = 0; k < 3; ++k) {
        HbmOptions o = test::by_harmonics();
        o.n_harmonics = 7;
        o.max_step = 0.02;
        o.unknowns = k == 0   ? plm::NonlinearUnknowns::automatic
                     : k == 1 ? plm::NonlinearUnknowns::modal
                              : plm::NonlinearUnknowns::gaps;
        found[k] = solver(m, o, 0.1, 1.2).sweep();
    }
    Spaces r;
    r.automatic = found[0]->unknowns_used;
    const double top = peak_of(*m, *found[0], 7);
    r.modal_error = std::abs(peak_of(*m, *found[1], 7) / top - 1);
    r.gaps_error = std::abs(peak_of(*m, *found[2], 7) / top - 1);
    return r;
}
void unknowns_are_chosen_by_the_moving_pairs(void **) {
    const Spaces s = spaces();
    std::printf("    automatic used %s; peaks differ by %.1e (modal), %.1e (gaps)\n", s.automatic.c_str(),
                s.modal_error, s.gaps_error);
    assert_string_equal(s.automatic.c_str(), "both");
    assert_true(below(s.modal_error, 1e-3) && below(s.gaps_error, 1e-3)); // highest of discrete points
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(harmonics_follow_the_need_of_each_point),
        cmocka_unit_test(a_single_solution_takes_the_harmonics_it_needs),
        cmocka_unit_test(missing_harmonics_are_estimated),
        cmocka_unit_test(unknowns_are_chosen_by_the_moving_pairs),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
