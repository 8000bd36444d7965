/* Kinds of basis that compete with piecewise-linear modes: each one is built and gives a curve, and what is
 * refused, argument by argument. */
#include "chain.h"
#include "check.h"

enum { PAIRS = 2, WATCHED = 12 /* node 4, x */ };

static const char *const rivals[] = {"bilinear", "lelsm", "lelsm_updated", "discontinuity"};
enum { N_RIVALS = 4 };

static plm_context *ctx;
static plm_model *model;
static plm_sampler *sampler;

static int set_up(void **state) {
    plm_status s = plm_context_create(PLM_API_VERSION, &ctx);
    (void)state;
    if (!s) s = chain_built(ctx, 1, &model);
    if (!s) s = plm_sampler_create(model, &sampler);
    if (!s) s = plm_sampler_set_string(sampler, "system", "open");
    if (!s) s = plm_sampler_set_int(sampler, "mode", 1);
    if (!s) s = plm_sampler_run(sampler);
    return s ? !done(ctx, s) : 0;
}
static int tear_down(void **state) {
    (void)state;
    return plm_context_destroy(&ctx);
}

/* NULL when it failed, with the error printed */
static plm_basis *built(const char *kind) {
    plm_basis *basis = NULL;
    if (!done(ctx, plm_basis_create(model, &basis)) ||
        !done(ctx, plm_basis_set_string(basis, "kind", kind)) ||
        !done(ctx, plm_basis_set_sampler(basis, sampler)) || !done(ctx, plm_basis_build(basis)))
        return NULL;
    return basis;
}

static double peak_of(plm_basis *basis, double *hz) {
    plm_hbm *hbm = NULL;
    plm_branch *curve = NULL, *point = NULL;
    double amplitude = 0;
    if (!basis || !done(ctx, plm_hbm_create(basis, &hbm)) ||
        !done(ctx, plm_hbm_set_int(hbm, "n_harmonics", 5)) ||
        !done(ctx, plm_hbm_set_string(hbm, "stability", "off")) || !done(ctx, plm_hbm_sweep(hbm, &curve)) ||
        !done(ctx, plm_hbm_find_peak(hbm, curve, WATCHED, PLM_HALF_PEAK_TO_PEAK, 0, hz, &amplitude, &point)))
        return -1;
    return amplitude;
}

/* The chain has eight masses that move along x, all of them needed below the limit: every kind holds the
 * motion. */
static void every_rival_gives_the_curve(void **state) {
    double want_hz = 0, want, hz = 0;
    int64_t size = 0;
    int i;
    (void)state;
    want = peak_of(built("full"), &want_hz);
    assert_true(want > 0);
    for (i = 0; i < N_RIVALS; ++i) {
        plm_basis *basis = built(rivals[i]);
        const double got = peak_of(basis, &hz);
        plm_basis_get_int(basis, "size", &size);
        printf("    %-13s %d columns, %.1e in frequency, %.1e in amplitude\n", rivals[i], (int)size,
               fabs(hz / want_hz - 1), fabs(got / want - 1));
        assert_true(close_to(hz, want_hz, 1e-8) && close_to(got, want, 1e-8));
    }
}

static void results_by_kind(void **state) {
    double share[64], frequencies[64];
    int64_t count = 0, samples[8], size = 0, fewer = 0;
    int i;
    plm_basis *basis = built("bilinear");
    (void)state;
    assert_non_null(basis);
    assert_int_equal(plm_basis_get_array(basis, "equivalent_share", 64, share, &count), PLM_OK);
    assert_int_equal(count, 0);
    assert_int_equal(plm_basis_get_int_array(basis, "sample_n_modes", 8, samples, &count), PLM_OK);
    assert_int_equal(count, 2); /* open, sliding */
    basis = built("lelsm");
    assert_non_null(basis);
    assert_int_equal(plm_basis_get_array(basis, "equivalent_share", 64, share, &count), PLM_OK);
    assert_true(count > 0);
    for (i = 0; i < count; ++i) assert_true(share[i] >= 0 && share[i] <= 1);
    assert_int_equal(plm_basis_get_array(basis, "frequencies_hz", 64, frequencies, &count), PLM_OK);
    basis = built("lelsm_updated");
    assert_non_null(basis);
    assert_int_equal(plm_basis_get_array(basis, "equivalent_share", 64, share, &count), PLM_OK);
    assert_int_equal(count, PAIRS);
    basis = built("discontinuity");
    assert_non_null(basis);
    assert_int_equal(plm_basis_get_int(basis, "size", &size), PLM_OK);
    assert_int_equal(plm_basis_set_int(basis, "n_discontinuities", 1), PLM_OK);
    assert_int_equal(plm_basis_set_double(basis, "below_factor", 0.3), PLM_OK); /* few modes: jumps count */
    assert_true(done(ctx, plm_basis_build(basis)));
    assert_int_equal(plm_basis_get_int(basis, "size", &fewer), PLM_OK);
    assert_true(fewer < size);
    assert_int_equal(plm_basis_set_int(basis, "n_discontinuities", 2), PLM_OK);
    assert_true(done(ctx, plm_basis_build(basis)));
    assert_int_equal(plm_basis_get_int(basis, "size", &size), PLM_OK);
    assert_int_equal(size, fewer + 1);
}

static void a_window_serves_without_a_sampler(void **state) {
    int64_t with = 0, without = 0, n_harmonics = 0;
    double low = 0, high = 0;
    int i;
    (void)state;
    plm_sampler_get_double(sampler, "window_low_hz", &low);
    plm_sampler_get_double(sampler, "window_high_hz", &high);
    plm_sampler_get_int(sampler, "n_harmonics_used", &n_harmonics);
    for (i = 0; i < N_RIVALS; ++i) {
        plm_basis *basis = NULL;
        assert_int_equal(plm_basis_get_int(built(rivals[i]), "size", &with), PLM_OK);
        assert_int_equal(plm_basis_create(model, &basis), PLM_OK);
        assert_int_equal(plm_basis_set_string(basis, "kind", rivals[i]), PLM_OK);
        assert_true(refused(ctx, plm_basis_build(basis), PLM_ERR_ARGUMENT, "plm_basis_build",
                            "frequency_max_hz", -1, "no sampler"));
        assert_int_equal(plm_basis_set_double(basis, "frequency_min_hz", low), PLM_OK);
        assert_int_equal(plm_basis_set_double(basis, "frequency_max_hz", high), PLM_OK);
        assert_int_equal(plm_basis_set_int(basis, "n_harmonics", n_harmonics), PLM_OK);
        assert_true(done(ctx, plm_basis_build(basis)));
        assert_int_equal(plm_basis_get_int(basis, "size", &without), PLM_OK);
        assert_int_equal(with, without);
    }
}

#define BAD(call, function, argument, words)                                                                 \
    assert_true(refused(ctx, call, PLM_ERR_ARGUMENT, function, argument, -1, words))

static void wrong_options_are_refused(void **state) {
    plm_basis *basis = built("discontinuity"), *child = NULL;
    int64_t before = 0, after = 0;
    (void)state;
    assert_non_null(basis);
    assert_int_equal(plm_basis_get_int(basis, "size", &before), PLM_OK);
    BAD(plm_basis_set_int(basis, "n_discontinuities", -1), "plm_basis_set_int", "value", "-1");
    BAD(plm_basis_set_double(basis, "equivalent_amplitude", -1), "plm_basis_set_double", "value", "-1");
    BAD(plm_basis_set_string(basis, "kind", "segalman"), "plm_basis_set_string", "value", "discontinuity");
    assert_int_equal(plm_basis_set_int(basis, "n_discontinuities", PAIRS + 1), PLM_OK);
    BAD(plm_basis_build(basis), "plm_basis_build", "n_discontinuities", "the model has 2 contact pairs");
    assert_int_equal(plm_basis_get_int(basis, "size", &after),
                     PLM_OK); /* the last one built is still there */
    assert_int_equal(before, after);
    assert_int_equal(plm_basis_create(model, &child), PLM_OK);
    assert_int_equal(plm_basis_set_sampler(child, sampler), PLM_OK);
    assert_int_equal(plm_basis_set_parent(child, basis), PLM_OK);
    BAD(plm_basis_build(child), "plm_basis_build", "parent", "\"craig_bampton\" or \"full\"");
    assert_int_equal(plm_basis_set_string(child, "kind", "bilinear"), PLM_OK);
    BAD(plm_basis_build(child), "plm_basis_build", "parent", "\"craig_bampton\" or \"full\"");
    assert_int_equal(plm_basis_set_parent(child, built("craig_bampton")), PLM_OK);
    assert_true(done(ctx, plm_basis_build(child)));
}

static void contact_pairs_are_needed(void **state) {
    const double m[1] = {1}, k[1] = {4};
    const int64_t ptr[2] = {0, 1}, row[1] = {0};
    plm_model *single = NULL;
    plm_basis *basis = NULL;
    int i;
    (void)state;
    assert_int_equal(plm_model_create(ctx, 1, &single), PLM_OK);
    assert_true(done(
        ctx, plm_model_set_matrix_i64(single, PLM_MASS, PLM_CSC, PLM_FULL, 0, PLM_COPY, 1, ptr, row, m)));
    assert_true(done(ctx, plm_model_set_matrix_i64(single, PLM_STIFFNESS, PLM_CSC, PLM_FULL, 0, PLM_COPY, 1,
                                                   ptr, row, k)));
    assert_true(done(ctx, plm_model_build(single)));
    assert_int_equal(plm_basis_create(single, &basis), PLM_OK);
    assert_int_equal(plm_basis_set_double(basis, "frequency_max_hz", 1), PLM_OK);
    for (i = 0; i < N_RIVALS; ++i) {
        assert_int_equal(plm_basis_set_string(basis, "kind", rivals[i]), PLM_OK);
        BAD(plm_basis_build(basis), "plm_basis_build", "kind", "no contact pair");
    }
    assert_int_equal(plm_basis_set_string(basis, "kind", "full"), PLM_OK);
    assert_true(done(ctx, plm_basis_build(basis)));
}

/* Without an excitation the caller must say how large the motion is. */
static void an_amplitude_is_needed(void **state) {
    chain c;
    plm_model *still = NULL;
    plm_basis *basis = NULL;
    int i;
    (void)state;
    chain_fill(&c);
    for (i = 0; i < CHAIN_DOFS; ++i) c.force[i] = 0;
    assert_true(done(ctx, chain_model(ctx, &c, 1, &still)));
    assert_true(done(ctx, plm_model_build(still)));
    assert_int_equal(plm_basis_create(still, &basis), PLM_OK);
    assert_int_equal(plm_basis_set_string(basis, "kind", "lelsm_updated"), PLM_OK);
    assert_int_equal(plm_basis_set_double(basis, "frequency_min_hz", 2), PLM_OK);
    assert_int_equal(plm_basis_set_double(basis, "frequency_max_hz", 4), PLM_OK);
    BAD(plm_basis_build(basis), "plm_basis_build", "equivalent_amplitude", "without an excitation");
    assert_int_equal(plm_basis_set_double(basis, "equivalent_amplitude", 1e-3), PLM_OK);
    assert_true(done(ctx, plm_basis_build(basis)));
}

int main(void) {
#define TEST(f) cmocka_unit_test_setup_teardown(f, set_up, tear_down)
    const struct CMUnitTest tests[] = {
        TEST(every_rival_gives_the_curve),       TEST(results_by_kind),
        TEST(a_window_serves_without_a_sampler), TEST(wrong_options_are_refused),
        TEST(contact_pairs_are_needed),          TEST(an_amplitude_is_needed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
