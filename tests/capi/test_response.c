/* plm_model_compute_response: the whole way in one call agrees with the steps it stands for, meets the
 * accuracy asked for or says what of it was missed; what it refuses, argument by argument. */
#include "check.h"
#include "oscillator.h"

static plm_context *ctx;

static int open_context(void **state) {
    (void)state;
    return plm_context_create(PLM_API_VERSION, &ctx) != PLM_OK;
}
static int close_context(void **state) {
    (void)state;
    return plm_context_destroy(&ctx);
}

/* A row of `n` masses of 1 on springs of 1e4, the last one beside a stop of `k_n` at `gap`, pushed by 1 at
 * it. */
static plm_model *damped_row(int32_t n, double k_n, double gap, double beta) {
    int32_t i[200], j[200], m = 0, row[] = {0, 1};
    double k[200], one[100], force[100] = {0};
    const double along[] = {1};
    plm_model *model = NULL;
    for (int32_t a = 0; a < n; ++a) {
        i[m] = j[m] = a, k[m++] = a < n - 1 ? 2e4 : 1e4;
        if (a > 0) i[m] = a, j[m] = a - 1, k[m++] = -1e4;
        one[a] = 1;
    }
    force[n - 1] = 1;
    int32_t diagonal[100], last[] = {n - 1};
    for (int32_t a = 0; a < n; ++a) diagonal[a] = a;
    assert_true(done(ctx, plm_model_create(ctx, n, &model)));
    assert_true(done(ctx, plm_model_set_matrix_i32(model, PLM_MASS, PLM_TRIPLETS, PLM_LOWER, 0, PLM_COPY, n,
                                                   diagonal, diagonal, one)));
    assert_true(done(ctx, plm_model_set_matrix_i32(model, PLM_STIFFNESS, PLM_TRIPLETS, PLM_LOWER, 0, PLM_COPY,
                                                   m, i, j, k)));
    assert_true(done(ctx, plm_model_set_rayleigh_damping(model, 0, beta)));
    assert_true(done(ctx, plm_model_add_gap_rows_i32(model, 0, 1, row, last, along, &k_n, &gap)));
    assert_true(done(ctx, plm_model_set_excitation(model, 1, n, force, NULL)));
    assert_true(done(ctx, plm_model_build(model)));
    return model;
}

static plm_model *row_of_masses(int32_t n, double k_n, double gap) {
    return damped_row(n, k_n, gap, 2e-4);
}

/* The same in steps, on a basis of the kind, by exact motions: what there is to be compared with. */
static plm_hbm *solver_of(plm_model *model, const char *kind, int64_t harmonics) {
    plm_sampler *sampler = NULL;
    plm_basis *basis = NULL;
    plm_hbm *hbm = NULL;
    assert_true(done(ctx, plm_sampler_create(model, &sampler)));
    assert_true(done(ctx, plm_sampler_set_int(sampler, "n_harmonics", harmonics)));
    assert_true(done(ctx, plm_sampler_run(sampler)));
    assert_true(done(ctx, plm_basis_create(model, &basis)));
    assert_true(done(ctx, plm_basis_set_string(basis, "kind", kind)));
    assert_true(done(ctx, plm_basis_set_int(basis, "n_harmonics", harmonics)));
    assert_true(done(ctx, plm_basis_set_sampler(basis, sampler)));
    assert_true(done(ctx, plm_basis_build(basis)));
    assert_true(done(ctx, plm_hbm_create(basis, &hbm)));
    return hbm;
}
static double peak_of(plm_hbm *hbm, int64_t dof, plm_status *status) {
    plm_branch *curve = NULL;
    double hz = 0, amplitude = 0;
    assert_true(plm_hbm_sweep(hbm, &curve) >= 0);
    *status = plm_hbm_find_peak(hbm, curve, dof, PLM_PEAK, 0, &hz, &amplitude, NULL);
    assert_true(*status >= 0);
    return amplitude;
}

/* Where a basis is too small the steps say so, with the error that it has, and the one call takes a larger
 * one. Truth: the exact motion of the unreduced row, in a space for 60 harmonics. */
static void the_basis_grows_to_the_accuracy(void **state) {
    enum { n = 40, dof = n - 1 };
    const double accuracy = 1e-2;
    plm_model *model = row_of_masses(n, 2e4, 0);
    plm_hbm *whole = solver_of(model, "full", 60), *first = solver_of(model, "plm", 5), *made = NULL;
    plm_branch *curve = NULL;
    double hz, amplitude, error, found;
    int64_t columns, first_columns;
    plm_status status;
    (void)state;
    assert_true(done(ctx, plm_hbm_set_string(whole, "motion", "exact")));
    const double truth = peak_of(whole, dof, &status);
    assert_true(done(ctx, plm_hbm_set_double(first, "accuracy", accuracy)));
    found = peak_of(first, dof, &status);
    assert_true(fabs(found / truth - 1) > accuracy); /* else this model shows nothing */
    assert_int_equal(status, PLM_WARNING);

    assert_true(done(ctx, plm_model_compute_response(model, dof, PLM_PEAK, accuracy, &hz, &amplitude, &error,
                                                     &curve, &made)));
    assert_true(close_to(amplitude, truth, accuracy));
    assert_true(error <= accuracy && hz > 0);
    assert_true(done(ctx, plm_branch_get_int(curve, "basis_size", &columns)));
    assert_true(plm_hbm_sweep(first, &curve) >= 0);
    assert_true(done(ctx, plm_branch_get_int(curve, "basis_size", &first_columns)));
    assert_true(columns > first_columns);
    assert_true(close_to(peak_of(made, dof, &status), amplitude, 1e-9)); /* one goes on where it ended */
    assert_int_equal(status, PLM_OK);
}

/* Each output that may be left out, and what is left when the solver goes before its curve. */
static void outputs_may_be_left_out(void **state) {
    plm_model *model = row_of_masses(2, 5000, 0);
    plm_branch *curve = NULL;
    plm_hbm *hbm = NULL;
    double hz, amplitude, again, error = -7, value[2000];
    int64_t n;
    (void)state;
    assert_true(
        done(ctx, plm_model_compute_response(model, 1, PLM_PEAK, 1e-3, &hz, &amplitude, NULL, NULL, NULL)));
    assert_true(
        done(ctx, plm_model_compute_response(model, 1, PLM_PEAK, 1e-3, &hz, &again, &error, &curve, &hbm)));
    assert_true(again == amplitude && error >= 0 && error < 1e-3);
    assert_true(close_to(hz, 11.3656, 1e-4) && close_to(amplitude, 0.0132829, 1e-4)); /* README.md */
    assert_true(done(ctx, plm_hbm_destroy(&hbm)));
    assert_true(done(ctx, plm_branch_get_int(curve, "n_points", &n)));
    assert_in_range(n, 10, 2000);
    assert_true(done(ctx, plm_branch_get_amplitude(curve, 1, PLM_PEAK, 0, 2000, value, &n)));
    assert_true(value[n / 2] > 0);
    assert_true(done(ctx, plm_model_compute_response(model, 1, PLM_HALF_PEAK_TO_PEAK, 1e-3, &hz, &amplitude,
                                                     NULL, NULL, NULL)));
    assert_true(close_to(amplitude, 0.0108819, 1e-4)); /* README.md */
}

/* A stop that is out of reach: a right answer to a question that was hardly meant. */
static void what_should_be_looked_at_is_said(void **state) {
    plm_model *model = row_of_masses(3, 1e4, 10);
    plm_hbm *hbm = NULL;
    double hz, amplitude;
    int64_t reason;
    (void)state;
    assert_int_equal(plm_model_compute_response(model, 2, PLM_PEAK, 1e-3, &hz, &amplitude, NULL, NULL, &hbm),
                     PLM_WARNING);
    assert_true(done(ctx, plm_hbm_get_int(hbm, "warning_reason", &reason)));
    assert_int_equal(reason, PLM_REASON_NO_SWITCHING);
}

static int32_t stop_at_once(plm_context *c, const char *stage, double fraction, void *user) {
    (void)c, (void)stage, (void)fraction, (void)user;
    return 1;
}

static void refusals_change_nothing(void **state) {
    enum { n = 3 };
    const char *f = "plm_model_compute_response";
    plm_model *model = row_of_masses(n, 5000, 0), *raw = NULL, *linear = NULL;
    plm_branch *curve = NULL;
    plm_hbm *hbm = NULL;
    double hz = -7, a = -7, e = -7;
    const oscillator free_mass = {1, 0.1, 0, 0, 1};
    (void)state;
#define CALL(m, dof, measure, accuracy, phz)                                                                 \
    plm_model_compute_response(m, dof, measure, accuracy, phz, &a, &e, &curve, &hbm)
#define BAD(call, argument, words) assert_true(refused(ctx, call, PLM_ERR_ARGUMENT, f, argument, -1, words))
    assert_int_equal(CALL(NULL, 0, PLM_PEAK, 1e-3, &hz), PLM_ERR_HANDLE);
    BAD(CALL(model, n, PLM_PEAK, 1e-3, &hz), "dof", "dof");
    BAD(CALL(model, -1, PLM_PEAK, 1e-3, &hz), "dof", "dof");
    BAD(CALL(model, 0, PLM_HARMONIC, 1e-3, &hz), "measure", "measure");
    BAD(CALL(model, 0, PLM_PEAK, NAN, &hz), "accuracy", "finite");
    BAD(CALL(model, 0, PLM_PEAK, 0, &hz), "accuracy", "1e-3");
    BAD(CALL(model, 0, PLM_PEAK, 0.6, &hz), "accuracy", "1e-3");
    BAD(CALL(model, 0, PLM_PEAK, 1e-3, NULL), "frequency_hz", "NULL");
    BAD(plm_model_compute_response(model, 0, PLM_PEAK, 1e-3, &hz, NULL, &e, &curve, &hbm), "amplitude",
        "NULL");
    assert_true(done(ctx, plm_model_create(ctx, n, &raw)));
    assert_int_equal(CALL(raw, 0, PLM_PEAK, 1e-3, &hz), PLM_ERR_STATE); /* not built */
    assert_true(done(ctx, oscillator_built(ctx, &free_mass, 1, &linear, NULL)));
    assert_int_equal(CALL(linear, 0, PLM_PEAK, 1e-3, &hz), PLM_ERR_STATE); /* no contact */
    assert_true(done(ctx, plm_context_set_progress(ctx, stop_at_once, NULL)));
    assert_int_equal(CALL(model, 0, PLM_PEAK, 1e-3, &hz), PLM_CANCELLED);
    assert_true(done(ctx, plm_context_set_progress(ctx, NULL, NULL)));
    assert_true(hz == -7 && a == -7 && e == -7 && !curve && !hbm);
}

/* Nearly undamped, beside a hard stop: its motions bounce without end. */
static void a_curve_that_ends_early_says_where_and_what_the_amplitude_is(void **state) {
    double hz = 0, amplitude = 0;
    char text[1024];
    plm_model *model = damped_row(3, 1e8, 2e-5, 1e-5);
    (void)state;
    assert_true(done(ctx, plm_context_set_effort(ctx, 1)));
    assert_int_equal(plm_model_compute_response(model, 2, PLM_PEAK, 1e-3, &hz, &amplitude, NULL, NULL, NULL),
                     PLM_TRUNCATED);
    assert_int_equal(plm_context_get_error_text(ctx, sizeof text, text, NULL), PLM_OK);
    assert_non_null(strstr(text, "the curve ended early, at "));
    assert_non_null(strstr(text, "the effort allowed is spent"));
    assert_non_null(strstr(text, "a higher one may follow"));
    assert_true(hz > 0 && amplitude > 0);
}

int main(void) {
#define TEST(f) cmocka_unit_test_setup_teardown(f, open_context, close_context)
    const struct CMUnitTest tests[] = {
        TEST(the_basis_grows_to_the_accuracy),
        TEST(outputs_may_be_left_out),
        TEST(what_should_be_looked_at_is_said),
        TEST(a_curve_that_ends_early_says_where_and_what_the_amplitude_is),
        TEST(refusals_change_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
