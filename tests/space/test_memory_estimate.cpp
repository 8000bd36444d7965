// With what precision a factor is kept under a limit of memory: the better one that fits, and what the host
// asks for in any case.
#include "space/memory_estimate.hpp"
#include "support/caught.hpp"
#include "support/spring_models.hpp"
#include "support/test.hpp"

namespace {

using plm::FactorPrecision;
using plm::PrecisionChoice;

plm::ModelInput chain() {
    constexpr int n = 300;
    return test::input(test::diagonal(n, 1), test::free_chain(n, 1));
}

double peak(PrecisionChoice precision) {
    plm::SpaceOptions options;
    options.precision = precision;
    return plm::estimate_memory(chain(), options, nullptr).peak();
}

FactorPrecision kept(PrecisionChoice precision, double limit_in_bytes) {
    plm::SpaceOptions options;
    options.precision = precision;
    options.memory_limit = limit_in_bytes / (1 << 20);
    return plm::fitting_solver(chain(), options, nullptr, plm::Watch()).precision;
}
bool fits(PrecisionChoice precision, double limit_in_bytes) {
    try {
        kept(precision, limit_in_bytes);
        return true;
    } catch (const plm::Error &e) {
        if (e.status() != plm::status::memory) throw;
        return false;
    }
}

void the_better_precision_that_fits_is_kept(void **) {
    const double full = peak(PrecisionChoice::full), single = peak(PrecisionChoice::single);
    std::printf("    %.0f bytes, in single precision %.0f\n", full, single);
    assert_true(single < full);
    const double between = 0.5 * (single + full);
    assert_true(kept(PrecisionChoice::automatic, 2 * full) == FactorPrecision::full);
    assert_true(kept(PrecisionChoice::automatic, between) == FactorPrecision::single);
    assert_true(kept(PrecisionChoice::single, 2 * full) == FactorPrecision::single);
    assert_true(kept(PrecisionChoice::full, 2 * full) == FactorPrecision::full);
    assert_false(fits(PrecisionChoice::full, between));
    for (PrecisionChoice p : {PrecisionChoice::automatic, PrecisionChoice::single, PrecisionChoice::full})
        assert_false(fits(p, 0.9 * single));
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(the_better_precision_that_fits_is_kept),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
