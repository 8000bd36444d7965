/* What is read of a branch, against the closed form of an oscillator whose stop is out of reach. */
#include "check.h"
#include "oscillator.h"

enum { MOST = 500, H = 3 };

static plm_context *ctx;
static plm_hbm *hbm;
static const oscillator o = {1, 0.04, 3, 100, 1};

static int set_up(void **state) {
    plm_model *model;
    plm_basis *basis;
    (void)state;
    return plm_context_create(PLM_API_VERSION, &ctx) || oscillator_built(ctx, &o, 0.7, &model, &basis) ||
           plm_hbm_create(basis, &hbm) || plm_hbm_set_int(hbm, "n_harmonics", H) ||
           plm_hbm_set_double(hbm, "frequency_min_hz", 0.1) ||
           plm_hbm_set_double(hbm, "frequency_max_hz", 0.3);
}
static int tear_down(void **state) {
    (void)state;
    return plm_context_destroy(&ctx);
}

/* q = (F / D) at the frequency of the point; D = k - w^2 + i w c. Rows a0, a1, b1, ...: nothing beyond. */
static void points_are_those_of_the_closed_form(void **state) {
    plm_branch *curve = NULL;
    double hz[MOST], c[2 * H + 2];
    int64_t n = MOST, k, i;
    (void)state;
    assert_true(done(ctx, plm_hbm_sweep(hbm, &curve)));
    assert_int_equal(plm_branch_get_array(curve, "frequency_hz", MOST, hz, &n), PLM_OK);
    assert_true(n > 5 && close_to(hz[0], 0.3, 1e-12) && close_to(hz[n - 1], 0.1, 1e-9));
    for (k = 0; k < n; ++k) {
        const double w = 2 * 3.141592653589793 * hz[k], re = o.k - w * w, im = w * o.c,
                     square = re * re + im * im;
        for (i = 0; i < 2 * H + 2; ++i) c[i] = 777;
        assert_int_equal(plm_branch_get_coefficients(curve, k, 0, 1, c), PLM_OK);
        assert_true(fabs(c[1] - o.force * re / square) < 1e-6 * hypot(c[1], c[2]));
        assert_true(fabs(c[2] - o.force * im / square) < 1e-6 * hypot(c[1], c[2]));
        for (i = 3; i < 2 * H + 1; ++i) assert_true(fabs(c[i]) < 1e-9);
        assert_true(c[2 * H + 1] == 777);
    }
}

/* One harmonic of a mass that meets its stop in every period: the call says so, and so does the solver. */
static void what_a_sweep_warns_of_is_kept_by_its_solver(void **state) {
    const oscillator struck = {1, 0.04, 3, 0, 1};
    plm_branch *curve = NULL;
    plm_model *other;
    plm_basis *its;
    char text[1000] = "";
    (void)state;
    assert_true(done(ctx, oscillator_built(ctx, &struck, 0.7, &other, &its)));
    assert_true(done(ctx, plm_hbm_create(its, &hbm)));
    assert_true(done(ctx, plm_hbm_set_int(hbm, "n_harmonics", 1)));
    assert_true(done(ctx, plm_hbm_set_double(hbm, "frequency_min_hz", 0.1)));
    assert_true(done(ctx, plm_hbm_set_double(hbm, "frequency_max_hz", 0.3)));
    assert_int_equal(plm_hbm_sweep(hbm, &curve), PLM_WARNING);
    assert_int_equal(plm_hbm_get_string(hbm, "warning", sizeof text, text, NULL), PLM_OK);
    assert_non_null(strstr(text, "harmonic"));
}

int main(void) {
#define TEST(f) cmocka_unit_test_setup_teardown(f, set_up, tear_down)
    const struct CMUnitTest tests[] = {
        TEST(points_are_those_of_the_closed_form),
        TEST(what_a_sweep_warns_of_is_kept_by_its_solver),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
