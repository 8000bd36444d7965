// What some periods of the exact flow say of a solution of harmonic balance, against the exact motion's peak.
#include "reduction/widened_model.hpp"
#include "searches/chains.hpp"
#include "searches/hbm.hpp"
#include "searches/motion_in_time.hpp"
#include "support/test.hpp"

using plm::HbmOptions;
using plm::Measure;
using test::Chains;
using test::chains;
using test::watched;

namespace {

constexpr Measure measure = Measure::half_peak_to_peak;

HbmOptions with_harmonics(std::int64_t n) {
    HbmOptions o;
    o.n_harmonics = n;
    o.stability = plm::StabilityKind::off;
    return o;
}

plm::Peak peak_of(const Chains &c, const HbmOptions &o) {
    const plm::Hbm hbm(plm::widened(c.full->reduced()), c.low_hz, c.high_hz, o, plm::Watch());
    return hbm.find_peak(*hbm.sweep(), watched, measure, 0);
}

// No less than a third of the truth, as every stated error, and no more than some times as much; where the
// truth is below what the harmonics of one solution leave out elsewhere, no bound from below.
void the_flow_knows_what_harmonics_miss(void **) {
    for (double stiffness : {1.0, 10.0, 100.0}) {
        const Chains c = chains(stiffness, true, 0);
        const auto whole = plm::widened(c.full->reduced());
        HbmOptions exactly;
        exactly.motion = plm::MotionKind::exact;
        const plm::Peak truth = peak_of(c, exactly);
        assert_non_null(truth.branch->points()[0].motion.get());
        for (std::int64_t n : {1, 2, 3}) {
            const HbmOptions o = with_harmonics(n);
            const plm::Peak peak = peak_of(c, o);
            const auto change = plm::change_in_time(whole, o, peak.branch->points()[0], plm::Watch());
            const double told = plm::harmonic_error_at(*whole, peak.branch->points()[0], change, watched,
                                                       measure, 0),
                         off = std::max(std::abs(peak.amplitude / truth.amplitude - 1),
                                        std::abs(peak.frequency_hz / truth.frequency_hz - 1));
            print_message("k_n %g, %lld harmonics: off by %.3g, told %.3g\n", stiffness,
                          static_cast<long long>(n), off, told);
            assert_true(told > off / 3);
            assert_true(told < 10 * off + 0.01);
        }
    }
}

} // namespace

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(the_flow_knows_what_harmonics_miss)};
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
