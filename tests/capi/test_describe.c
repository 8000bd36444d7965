/* plm_branch_describe: the page holds the numbers that the other functions give of the same curve, each
 * section says what is not known where nothing has looked for it, and the text is handed out as every other.
 */
#include "chain.h"
#include "check.h"

enum { DOF = 12 }; /* node 4 along x, where the chain is pushed */

static plm_context *ctx;
static plm_model *model;

static int set_up(void **state) {
    (void)state;
    return plm_context_create(PLM_API_VERSION, &ctx) || !done(ctx, chain_built(ctx, 0, &model));
}
static int tear_down(void **state) {
    (void)state;
    return plm_context_destroy(&ctx);
}

static char *page_of(plm_branch *curve) {
    static char page[16384];
    assert_true(done(ctx, plm_branch_describe(curve, sizeof page, page, NULL)));
    return page;
}

static plm_branch *curve_of(plm_hbm **hbm) {
    plm_sampler *sampler = NULL;
    plm_basis *basis = NULL;
    plm_branch *curve = NULL;
    assert_true(done(ctx, plm_sampler_create(model, &sampler)));
    assert_true(done(ctx, plm_sampler_run(sampler)));
    assert_true(done(ctx, plm_basis_create(model, &basis)));
    assert_true(done(ctx, plm_basis_set_sampler(basis, sampler)));
    assert_true(done(ctx, plm_basis_build(basis)));
    assert_true(done(ctx, plm_hbm_create(basis, hbm)));
    assert_true(plm_hbm_sweep(*hbm, &curve) >= 0);
    return curve;
}

static void expect(const char *page, const char *words) {
    if (!strstr(page, words)) fail_msg("\"%s\" is not in\n%s", words, page);
}
static void expect_peak(const char *page, double amplitude, double hz) {
    char words[100];
    snprintf(words, sizeof words, "%.6g at %.6g Hz: half peak-to-peak displacement of DOF 12", amplitude, hz);
    expect(page, words);
}

static void a_response_of_one_call(void **state) {
    static const char *const titles[] = {"Model",         "Basis", "Curve",    "Peak", "Stability",
                                         "Other motions", "Error", "Warnings", "Time"};
    plm_branch *curve = NULL;
    double hz, amplitude, error;
    char words[100];
    int64_t n;
    (void)state;
    assert_true(plm_model_compute_response(model, DOF, PLM_HALF_PEAK_TO_PEAK, 1e-3, &hz, &amplitude, &error,
                                           &curve, NULL) >= 0);
    const char *page = page_of(curve), *at = page;
    for (size_t i = 0; i < sizeof titles / sizeof *titles; ++i) { /* in this order */
        const char *next = strstr(at, titles[i]);
        if (!next) fail_msg("no \"%s\" after the one before in\n%s", titles[i], page);
        at = next;
    }
    expect(page, "24 DOFs, 24 of them free; 2 contact pairs");
    expect_peak(page, amplitude, hz);
    snprintf(words, sizeof words, "may be off by %.2g of itself", error);
    expect(page, words);
    expect(page, "; 0.001 was asked for");
    assert_true(done(ctx, plm_branch_get_int(curve, "n_points", &n)));
    snprintf(words, sizeof words, "  %d points, ", (int)n);
    expect(page, words);
    expect(page, "no larger stable one was found");
}

static void what_was_not_looked_for(void **state) {
    plm_hbm *hbm = NULL;
    plm_branch *curve = curve_of(&hbm), *peak = NULL;
    double hz, amplitude, of_amplitude[3], of_hz[3];
    char words[100];
    (void)state;
    expect(page_of(curve), "not looked for: find_peak");
    expect(page_of(curve), "that of the peak is not known");
    assert_true(plm_hbm_find_peak(hbm, curve, DOF, PLM_HALF_PEAK_TO_PEAK, 0, &hz, &amplitude, &peak) >= 0);
    expect_peak(page_of(curve), amplitude, hz);
    expect(page_of(curve), "of kind plm");
    expect_peak(page_of(peak), amplitude, hz);
    /* another amplitude, or another point, is not the peak's */
    assert_true(plm_hbm_estimate_error(hbm, peak, 0, 0, PLM_PEAK, 0, of_amplitude, of_hz) >= 0);
    assert_true(plm_hbm_estimate_error(hbm, curve, 0, DOF, PLM_HALF_PEAK_TO_PEAK, 0, of_amplitude, of_hz) >=
                0);
    expect(page_of(curve), "that of the peak is not known");
    assert_true(
        done(ctx, plm_hbm_estimate_error(hbm, peak, 0, DOF, PLM_HALF_PEAK_TO_PEAK, 0, of_amplitude, of_hz)));
    const double a = fabs(of_amplitude[0] + of_amplitude[1] + of_amplitude[2]) / amplitude,
                 f = fabs(of_hz[0] + of_hz[1] + of_hz[2]) / hz;
    snprintf(words, sizeof words, "may be off by %.2g of itself", larger(a, f));
    expect(page_of(curve), words);
    expect(page_of(curve), "were not looked for: find_isolated");
    /* the peak of another amplitude takes its place */
    assert_true(plm_hbm_find_peak(hbm, curve, 0, PLM_RMS, 0, &hz, &amplitude, NULL) >= 0);
    expect(page_of(curve), "root mean square of DOF 0");
    expect(page_of(curve), "that of the peak is not known");
}

static void as_other_texts(void **state) {
    plm_hbm *hbm = NULL;
    plm_branch *curve = curve_of(&hbm);
    int64_t needed = 0;
    char few[8] = "xxxxxxx";
    (void)state;
    assert_int_equal(plm_branch_describe(NULL, 0, NULL, &needed), PLM_ERR_HANDLE);
    assert_true(refused(ctx, plm_branch_describe(curve, -1, few, NULL), PLM_ERR_ARGUMENT,
                        "plm_branch_describe", "capacity", -1, "-1"));
    assert_string_equal(few, "xxxxxxx");
    assert_true(done(ctx, plm_branch_describe(curve, 0, NULL, &needed)));
    assert_true(needed == (int64_t)strlen(page_of(curve)) + 1 && needed > 400);
    assert_true(done(ctx, plm_branch_describe(curve, sizeof few, few, NULL)));
    assert_true(strlen(few) == 7 && !strncmp(few, page_of(curve), 7));
    size_t column = 0; /* lines fit a page */
    for (const char *at = page_of(curve); *at; ++at) {
        column = *at == '\n' ? 0 : column + 1;
        assert_true(column <= 100);
    }
}

int main(void) {
#define TEST(f) cmocka_unit_test_setup_teardown(f, set_up, tear_down)
    const struct CMUnitTest tests[] = {TEST(a_response_of_one_call), TEST(what_was_not_looked_for),
                                       TEST(as_other_texts)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
