// The window that a sampler gives to a basis: what the host has set stays, and nothing else is left open.
#include "reduction/basis_kinds.hpp"
#include "sampling/small_models.hpp"
#include "study/recipe.hpp"
#include "support/test.hpp"

namespace {

plm::BasisOptions windowed(double min_hz, double max_hz) {
    const exact::Structure s = test::two_chains(8, 3, 5, true);
    plm::Recipe recipe;
    recipe.sampler = plm::SamplerOptions();
    recipe.basis.kind = &plm::basis_kinds::lelsm;
    recipe.basis.frequency_min_hz = min_hz, recipe.basis.frequency_max_hz = max_hz;
    plm::KnownSpace space;
    return plm::with_window(test::make_model(s), recipe, plm::Watch(), space).basis;
}

void a_half_set_window_is_completed(void **) {
    const plm::BasisOptions none = windowed(0, 0);
    assert_true(none.frequency_min_hz > 0 && none.frequency_max_hz > none.frequency_min_hz);
    const double high = 2 * none.frequency_max_hz, low = 0.5 * none.frequency_min_hz;
    const plm::BasisOptions with_max = windowed(0, high), with_min = windowed(low, 0),
                            both = windowed(low, high);
    assert_true(with_max.frequency_min_hz == none.frequency_min_hz && with_max.frequency_max_hz == high);
    assert_true(with_min.frequency_min_hz == low && with_min.frequency_max_hz == none.frequency_max_hz);
    assert_true(both.frequency_min_hz == low && both.frequency_max_hz == high);
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(a_half_set_window_is_completed),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
