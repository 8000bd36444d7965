/* What a run of a transient and a search leave, cancelling, and the life of the handle. */
#include "check.h"
#include "oscillator.h"

enum { MANY = 4000 };
static const oscillator swing = {40, 0.5, 0, 0, 3};
static const double hz = 0.7, two_pi = 6.28318530717958647692;

static plm_context *ctx;
static plm_model *model;
static plm_basis *basis;
static plm_transient *reduced, *full;
static double values[MANY], times[MANY];

static int set_up(void **state) {
    const oscillator o = {40, 0.5, 1e3, 0.1, 3};
    (void)state;
    return plm_context_create(PLM_API_VERSION, &ctx) ||
           !done(ctx, oscillator_built(ctx, &o, 5, &model, &basis)) ||
           !done(ctx, plm_transient_create(model, basis, &reduced)) ||
           !done(ctx, plm_transient_create(model, NULL, &full));
}
static int tear_down(void **state) {
    (void)state;
    return plm_context_destroy(&ctx);
}

#define BAD(call, function, argument, index, words)                                                          \
    assert_true(refused(ctx, call, PLM_ERR_ARGUMENT, function, argument, index, words))
#define EARLY(call, function, argument, words)                                                               \
    assert_true(refused(ctx, call, PLM_ERR_STATE, function, argument, -1, words))

static void a_run_leaves_its_results(plm_transient *t) {
    static const int32_t twice[2] = {1, 1};
    int64_t n = 0, i = -1, dofs[2] = {-1, -1};
    double x = 0, last = 0, q = 0;
    char word[20];
    plm_transient_set_double(t, "frequency_hz", hz);
    plm_transient_set_int(t, "periods", 3);
    plm_transient_set_int(t, "steps_per_period", 40);
    assert_true(done(ctx, plm_transient_run(t))); /* nothing is observed */
    EARLY(plm_transient_get_history(t, 0, 0, NULL, &n), "plm_transient_get_history", "observed", "observe");
    assert_int_equal(plm_transient_get_array(t, "time", 0, NULL, &n), PLM_OK);
    assert_int_equal(n, 0);
    assert_true(done(ctx, plm_transient_observe_i32(t, 1, 2, twice)));
    plm_transient_set_int(t, "periods", 2);
    assert_true(done(ctx, plm_transient_run(t)));
    assert_true(done(ctx, plm_transient_observe_i32(t, 0, 0, NULL))); /* for the next run */
    assert_int_equal(plm_transient_get_int(t, "n_observed", &n), PLM_OK);
    assert_int_equal(n, 2);
    assert_int_equal(plm_transient_get_int_array(t, "observed", 2, dofs, &n), PLM_OK);
    assert_true(n == 2 && dofs[0] == 0 && dofs[1] == 0);
    assert_int_equal(plm_transient_get_array(t, "time", MANY, times, &n), PLM_OK);
    assert_int_equal(n, 80);
    assert_true(close_to(times[0], (3 + 1.0 / 40) / hz, 1e-12) && close_to(times[79], 5 / hz, 1e-12));
    assert_int_equal(plm_transient_get_history(t, 1, MANY, values, &n), PLM_OK);
    assert_int_equal(n, 80);
    BAD(plm_transient_get_history(t, 2, MANY, values, &n), "plm_transient_get_history", "observed", -1,
        "0..1");
    BAD(plm_transient_get_history(t, 0, 79, values, &n), "plm_transient_get_history", "capacity", -1,
        "80 values");
    BAD(plm_transient_get_history(t, 0, 80, NULL, &n), "plm_transient_get_history", "values", -1, "NULL");
    BAD(plm_transient_get_history(t, 0, 80, values, NULL), "plm_transient_get_history", "count", -1, "NULL");
    last = values[79];
    assert_int_equal(plm_transient_get_state(t, 1, &q, NULL), PLM_OK);
    assert_int_equal(plm_transient_get_state(t, 1, NULL, &x), PLM_OK);
    assert_true(fabs(q - last) < 1e-12);
    assert_int_equal(plm_transient_get_int(t, "periods_done", &i), PLM_OK);
    assert_int_equal(i, 2);
    assert_int_equal(plm_transient_get_double(t, "change", &x), PLM_OK);
    assert_true(x > 0);
    assert_int_equal(plm_transient_get_int(t, "is_settled", &i), PLM_OK);
    assert_int_equal(i, 0);
    assert_int_equal(plm_transient_get_double(t, "present_time", &x), PLM_OK);
    assert_true(close_to(x, 5 / hz, 1e-12));
    assert_int_equal(plm_transient_get_string(t, "motion", 20, word, NULL), PLM_OK);
    assert_string_equal(word, t == full ? "full" : "reduced");
    plm_transient_set_double(t, "settled", 1e-3);
    plm_transient_set_int(t, "periods", 1000);
    assert_true(done(ctx, plm_transient_run(t)));
    plm_transient_get_int(t, "is_settled", &i);
    plm_transient_get_double(t, "change", &x);
    plm_transient_get_int(t, "periods_done", &n);
    assert_true(i == 1 && x < 1e-3 && n < 1000);
    assert_int_equal(plm_transient_get_int(t, "n_events", &n), PLM_OK);
    assert_int_equal(plm_transient_get_int(t, "contact_iterations", &i), PLM_OK);
    assert_true(n > 0 && (i > 0) == (t == full));
}
static void runs_leave_their_results(void **state) {
    (void)state;
    a_run_leaves_its_results(reduced);
    a_run_leaves_its_results(full);
}

static void the_search_ends_where_it_is_told_to(void **state) {
    const double q = 5, v = 3;
    double before = 1, defect = 0, re[2], im[2];
    int64_t n = 0, i = -1, k;
    (void)state;
    plm_transient_set_double(reduced, "frequency_hz", hz);
    plm_transient_set_int(reduced, "max_iterations", 0);
    assert_true(done(ctx, plm_transient_set_state(reduced, 1, &q, &v)));
    assert_int_equal(plm_transient_find_periodic(reduced), PLM_NOT_CONVERGED);
    plm_transient_get_double(reduced, "periodicity_defect", &before);
    assert_int_equal(plm_transient_get_int(reduced, "is_periodic", &i), PLM_OK);
    assert_true(before > 1e-3 && i == 0);
    plm_transient_set_int(reduced, "max_iterations", 100);
    plm_transient_set_string(reduced, "march_when_stuck", "on");
    for (k = 1; k <= 2; ++k) { /* also over twice the period: the same motion, squared multipliers */
        double previous = n ? hypot(re[0], im[0]) : 0;
        plm_transient_set_int(reduced, "period_multiple", k);
        assert_true(done(ctx, plm_transient_find_periodic(reduced)));
        plm_transient_get_double(reduced, "periodicity_defect", &defect);
        plm_transient_get_int(reduced, "iterations", &i);
        assert_true(defect < 1e-11 && (k == 2 || i > 0));
        assert_true(done(ctx, plm_transient_get_multipliers(reduced, 2, re, im, &n)));
        assert_int_equal(n, 2);
        if (k == 2) assert_true(close_to(hypot(re[0], im[0]), previous * previous, 1e-6));
    }
    BAD(plm_transient_get_multipliers(reduced, 2, re, NULL, &n), "plm_transient_get_multipliers", "imag", -1,
        "NULL");
    BAD(plm_transient_get_multipliers(reduced, 1, re, im, &n), "plm_transient_get_multipliers", "capacity",
        -1, "2 values");
    n = 7;
    BAD(plm_transient_get_multipliers(reduced, 0, NULL, im, &n), "plm_transient_get_multipliers", "real", -1,
        "NULL");
    assert_int_equal(n, 7);
    assert_true(done(ctx, plm_transient_set_state(reduced, 1, NULL, NULL)));
    EARLY(plm_transient_get_multipliers(reduced, 0, NULL, NULL, &n), "plm_transient_get_multipliers",
          "transient", "since the start was set");
}

static int calls_left;
static int32_t stop(plm_context *c, const char *stage, double fraction, void *user) {
    (void)c, (void)stage, (void)user;
    return !(fraction >= 0 && fraction <= 1) || --calls_left < 0;
}

/* a run is stopped, and the next one goes on from there: the motion stays the one of the closed form */
static void a_cancelled_run_keeps_what_it_marched(void **state) {
    const double q_0 = 0.3, v_0 = -1;
    const int32_t dof = 0;
    plm_model *m = NULL;
    plm_basis *b = NULL;
    plm_transient *t = NULL;
    double q, v, now = 0, before = 0, state_q, state_v;
    int64_t n = 0, k, i, is_full, periods = 0;
    (void)state;
    assert_true(done(ctx, oscillator_built(ctx, &swing, 5, &m, &b)));
    for (is_full = 0; is_full < 2; ++is_full) {
        const double tolerance = is_full ? 2e-3 : 1e-12;
        assert_true(done(ctx, plm_transient_create(m, is_full ? NULL : b, &t)));
        plm_transient_set_double(t, "frequency_hz", hz);
        plm_transient_set_int(t, "periods", 12);
        plm_transient_set_int(t, "steps_per_period", 300);
        assert_true(done(ctx, plm_transient_observe_i32(t, 0, 1, &dof)));
        assert_true(done(ctx, plm_transient_set_state(t, 1, &q_0, &v_0)));
        plm_context_set_progress(ctx, stop, NULL);
        calls_left = 0;
        assert_int_equal(plm_transient_run(t), PLM_CANCELLED); /* before the first step */
        assert_int_equal(plm_transient_get_int(t, "periods_done", &periods), PLM_OK);
        assert_int_equal(periods, 0);
        for (i = 0, before = 0; i < 2; ++i) {
            calls_left = is_full ? 1000 : 21;
            assert_int_equal(plm_transient_run(t), PLM_CANCELLED);
            plm_transient_get_int(t, "periods_done", &periods);
            assert_true(periods >= 1 && periods < 12);
            plm_transient_get_double(t, "present_time", &now);
            assert_true(done(ctx, plm_transient_get_history(t, 0, MANY, values, &n)));
            plm_transient_get_array(t, "time", MANY, times, &k);
            assert_true(k == n && n >= 300 * periods &&
                        n == (int64_t)floor((now - before) * hz * 300 + 1e-6));
            assert_int_equal(plm_transient_get_state(t, 1, &state_q, &state_v), PLM_OK);
            oscillator_motion(&swing, two_pi * hz, q_0, v_0, now, &q, &v);
            assert_true(fabs(state_q - q) < tolerance && fabs(state_v - v) < 10 * tolerance);
            for (k = 0; k < n; ++k) {
                oscillator_motion(&swing, two_pi * hz, q_0, v_0, times[k], &q, &v);
                assert_true(fabs(values[k] - q) < tolerance);
            }
            before = now;
        }
        plm_context_set_progress(ctx, NULL, NULL);
        assert_true(done(ctx, plm_transient_run(t)));
        plm_transient_get_double(t, "present_time", &now);
        assert_true(close_to(now, before + 12 / hz, 1e-12));
        assert_int_equal(plm_transient_get_state(t, 1, &state_q, NULL), PLM_OK);
        oscillator_motion(&swing, two_pi * hz, q_0, v_0, now, &q, &v);
        assert_true(fabs(state_q - q) < tolerance);
    }
    plm_context_set_progress(ctx, stop, NULL);
    calls_left = 0;
    plm_transient_set_double(reduced, "frequency_hz", hz);
    assert_int_equal(plm_transient_find_periodic(reduced), PLM_CANCELLED);
    plm_context_set_progress(ctx, NULL, NULL);
}

static void a_transient_outlives_its_parents(void **state) {
    plm_transient *copy = reduced, *none = NULL;
    (void)state;
    plm_transient_set_double(reduced, "frequency_hz", hz);
    plm_transient_set_double(full, "frequency_hz", hz);
    plm_transient_set_int(full, "periods", 2);
    assert_int_equal(plm_model_destroy(&model), PLM_OK);
    assert_int_equal(plm_basis_destroy(&basis), PLM_OK);
    assert_true(done(ctx, plm_transient_run(reduced)));
    assert_true(done(ctx, plm_transient_find_periodic(reduced)));
    assert_true(done(ctx, plm_transient_run(full)));
    assert_int_equal(plm_transient_destroy(&reduced), PLM_OK);
    assert_null(reduced);
    assert_int_equal(plm_transient_destroy(&reduced), PLM_OK);
    assert_int_equal(plm_transient_destroy(NULL), PLM_OK);
    assert_int_equal(plm_transient_destroy(&none), PLM_OK);
    assert_int_equal(plm_transient_run(copy), PLM_ERR_HANDLE);
    assert_int_equal(plm_transient_destroy(&copy), PLM_OK); /* gone already: nothing to do */
    copy = full;                                            /* the context takes the rest with it */
    assert_int_equal(plm_context_destroy(&ctx), PLM_OK);
    assert_int_equal(plm_transient_run(copy), PLM_ERR_HANDLE);
}

int main(void) {
#define TEST(f) cmocka_unit_test_setup_teardown(f, set_up, tear_down)
    const struct CMUnitTest tests[] = {
        TEST(runs_leave_their_results),
        TEST(the_search_ends_where_it_is_told_to),
        TEST(a_cancelled_run_keeps_what_it_marched),
        TEST(a_transient_outlives_its_parents),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
