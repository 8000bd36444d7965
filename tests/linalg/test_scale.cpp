// Numbers that are not finite are found wherever they stand, and sizes where squares overflow or vanish.
#include "linalg/error.hpp"
#include "linalg/scale.hpp"
#include "support/test.hpp"
#include <limits>
#include <vector>

namespace {

// Index of the number that is refused; -1: none.
std::int64_t refused_at(const std::vector<double> &values) {
    try {
        plm::require_finite_result(values.data(), static_cast<std::int64_t>(values.size()), "result");
    } catch (const plm::Error &e) {
        return e.status() == plm::status::convergence && e.reason() == plm::reason::not_finite ? e.index()
                                                                                               : -2;
    }
    return -1;
}

void a_number_that_is_not_finite_is_named(void **) {
    const double inf = std::numeric_limits<double>::infinity();
    assert_int_equal(refused_at({}), -1);
    assert_int_equal(refused_at({1, -1e300, 0}), -1);
    assert_int_equal(refused_at({NAN, 1, 2}), 0);
    assert_int_equal(refused_at({1, 2, -inf}), 2);
    assert_int_equal(refused_at({1, inf, NAN}), 1);
}

void sizes_at_the_bounds_are_allowed(void **) {
    assert_false(plm::too_large(plm::largest_scale) || plm::too_large(-plm::largest_scale));
    assert_true(plm::too_large(1.01 * plm::largest_scale) && plm::too_large(NAN));
    assert_false(plm::too_small(plm::smallest_scale) || plm::too_small(0));
    assert_true(plm::too_small(-0.99 * plm::smallest_scale));
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(a_number_that_is_not_finite_is_named),
        cmocka_unit_test(sizes_at_the_bounds_are_allowed),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
