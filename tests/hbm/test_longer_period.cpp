// Equations on several periods of the excitation: what solves them on one period solves them on more.
#include "hbm/make_system.hpp"
#include "hbm/solved_point.hpp"
#include "support/small_solver.hpp"
#include "support/test.hpp"

namespace {

using plm::NonlinearUnknowns;

plm::HbmOptions with(NonlinearUnknowns unknowns) {
    plm::HbmOptions o;
    o.n_harmonics = 5;
    o.unknowns = unknowns;
    return o;
}

// |R| over its scale, of the motion of one period on the longer one.
double residual_on(std::int64_t multiple, NonlinearUnknowns unknowns) {
    const auto m = test::reduce_exactly(test::chain(3, 0.02, 2, 0.1, 0.1, 0, {2}));
    plm::HbmOptions o = with(unknowns);
    const double omega = 0.5;
    const plm::BranchPoint p =
        test::solver(m, o, 0.3, 0.7).solve(omega / (2 * M_PI), nullptr, 0)->points()[0];
    o.period_multiple = multiple;
    const auto system = plm::make_system(m, o);
    const plm::vector<double> x =
        plm::unknowns_of(*system, multiple == 1 ? p : plm::on_longer_period(p, multiple));
    plm::vector<double> r(x.size());
    system->residual(x.data(), p.omega, r.data());
    return plm::norm2(static_cast<std::int64_t>(r.size()), r.data()) / system->residual_scale();
}

void a_motion_of_one_period_is_one_of_several(void **) {
    for (NonlinearUnknowns unknowns : {NonlinearUnknowns::modal, NonlinearUnknowns::gaps})
        for (std::int64_t multiple : {1, 2, 3})
            assert_true(below(residual_on(multiple, unknowns), 1e-8)); // Newton's tolerance is 1e-9
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(a_motion_of_one_period_is_one_of_several),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
