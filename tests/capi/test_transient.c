/* Motion in time: against closed forms, against harmonic balance, and the full model against its reduced one.
 */
#include "chain.h"
#include "check.h"
#include "oscillator.h"

#define PI 3.14159265358979323846
enum { WATCHED = 12 /* node 4, x */, MANY = 100000 };

static plm_context *ctx;
static plm_model *model;
static plm_basis *basis;
static plm_transient *motion;
static double history[MANY], other[MANY], times[MANY];

static int set_up(void **state) {
    (void)state;
    return plm_context_create(PLM_API_VERSION, &ctx);
}
static int tear_down(void **state) {
    (void)state;
    return plm_context_destroy(&ctx);
}

static int make(const oscillator *o, double highest_hz) {
    return done(ctx, oscillator_built(ctx, o, highest_hz, &model, &basis));
}

/* a transient that records one DOF; of_basis NULL: the full model */
static plm_transient *new_motion(plm_basis *of_basis, double hz, int64_t periods, int64_t steps,
                                 int32_t dof) {
    plm_transient *t = NULL;
    const int ok = done(ctx, plm_transient_create(model, of_basis, &t)) &&
                   done(ctx, plm_transient_set_double(t, "frequency_hz", hz)) &&
                   done(ctx, plm_transient_set_int(t, "periods", periods)) &&
                   done(ctx, plm_transient_set_int(t, "steps_per_period", steps)) &&
                   done(ctx, plm_transient_observe_i32(t, 0, 1, &dof));
    return ok ? t : NULL;
}

static int64_t recorded(plm_transient *t, double *values) {
    int64_t n = -1;
    assert_true(done(ctx, plm_transient_get_history(t, 0, MANY, values, &n)));
    return n;
}

static double largest(const double *x, int64_t n) {
    double m = 0;
    int64_t k;
    for (k = 0; k < n; ++k) m = larger(m, fabs(x[k]));
    return m;
}
static double difference(const double *x, const double *y, int64_t n) {
    double m = 0;
    int64_t k;
    for (k = 0; k < n; ++k) m = larger(m, fabs(x[k] - y[k]));
    return m;
}

/* error of the history and of the last state against the closed form, over two runs in a row */
static double linear_error(const oscillator *o, plm_basis *of_basis, int64_t steps) {
    const double hz = 0.7, omega = 2 * PI * hz, q_0 = 0.3, v_0 = -1;
    double q, v, got_q = 0, got_v = 0, worst = 0;
    int64_t n = 0, k, run;
    motion = new_motion(of_basis, hz, 3, steps, 0);
    assert_true(done(ctx, plm_transient_set_state(motion, 1, &q_0, &v_0)));
    for (run = 0; run < 2; ++run) {
        assert_true(done(ctx, plm_transient_run(motion)));
        assert_int_equal(recorded(motion, history), 3 * steps);
        assert_int_equal(plm_transient_get_array(motion, "time", MANY, times, &n), PLM_OK);
        assert_int_equal(n, 3 * steps);
        for (k = 0; k < n; ++k) {
            oscillator_motion(o, omega, q_0, v_0, times[k], &q, &v);
            worst = larger(worst, fabs(history[k] - q));
        }
        assert_true(close_to(times[n - 1], (double)(run + 1) * 3 / hz, 1e-12));
    }
    assert_int_equal(plm_transient_get_state(motion, 1, &got_q, &got_v), PLM_OK);
    worst = larger(worst, larger(fabs(got_q - q), fabs(got_v - v)));
    plm_transient_destroy(&motion);
    return worst;
}

static void a_linear_oscillator_in_closed_form(void **state) {
    const oscillator o = {40, 0.5, 0, 0, 3};
    double exact, coarse, fine;
    (void)state;
    assert_true(make(&o, 5));
    exact = linear_error(&o, basis, 50);
    coarse = linear_error(&o, NULL, 1000);
    fine = linear_error(&o, NULL, 10000);
    printf("    exact flow %.1e; Newmark %.1e, %.1e with a tenth of the step\n", exact, coarse, fine);
    assert_true(exact < 1e-12);
    assert_true(coarse < 1e-3 && fine < 1.1e-2 * coarse);
}

/* free motion between a spring on one side and two on the other: two half sines, period pi / omega_1 + pi /
 * omega_2 */
static void a_bilinear_oscillator_in_closed_form(void **state) {
    const oscillator o = {9, 0, 16, 0, 1};
    const double above = 5, below = 3, first = PI / above, period = first + PI / below, v_0 = 2, zero = 0;
    double worst, q = 1, v = 0;
    int64_t n, k, events = 0;
    int full;
    (void)state;
    assert_true(make(&o, 5));
    for (full = 0; full < 2; ++full) {
        motion = new_motion(full ? NULL : basis, 1 / period, 2, full ? 20000 : 500, 0);
        assert_true(done(ctx, plm_transient_set_double(motion, "force_scale", 0)));
        assert_true(done(ctx, plm_transient_set_state(motion, 1, &zero, &v_0)));
        assert_true(done(ctx, plm_transient_run(motion)));
        n = recorded(motion, history);
        plm_transient_get_array(motion, "time", MANY, times, &n);
        for (k = 0, worst = 0; k < n; ++k) {
            const double t = fmod(times[k], period);
            const double want =
                t < first ? v_0 / above * sin(above * t) : -v_0 / below * sin(below * (t - first));
            worst = larger(worst, fabs(history[k] - want));
        }
        assert_int_equal(plm_transient_get_int(motion, "n_events", &events), PLM_OK);
        assert_int_equal(plm_transient_get_state(motion, 1, &q, &v), PLM_OK);
        printf("    %s: error %.1e, %d events\n", full ? "Newmark" : "exact flow", worst, (int)events);
        assert_true(worst < (full ? 1e-4 : 1e-11) && events >= 3 && events <= 5);
        assert_true(fabs(q) < (full ? 1e-4 : 1e-11) && close_to(v, v_0, full ? 1e-4 : 1e-11));
    }
}

static void the_full_model_agrees_with_its_reduced_one(void **state) {
    double q[CHAIN_DOFS], rest[CHAIN_DOFS], v[CHAIN_DOFS];
    plm_transient *full;
    int64_t n, k;
    (void)state;
    assert_true(done(ctx, chain_built(ctx, 1, &model)));
    assert_true(done(ctx, plm_basis_create(model, &basis)));
    assert_true(done(ctx, plm_basis_set_string(basis, "kind", "full")));
    assert_true(done(ctx, plm_basis_set_double(basis, "frequency_max_hz", 20)));
    assert_true(done(ctx, plm_basis_build(basis)));
    assert_true(done(ctx, plm_model_solve_rest(model)));
    plm_model_get_array(model, "rest_displacement", CHAIN_DOFS, rest, &n);
    motion = new_motion(basis, 3, 4, 5000, WATCHED);
    full = new_motion(NULL, 3, 4, 5000, WATCHED);
    for (k = 0; k < 2; ++k) { /* the first state is at rest under the pre-load */
        assert_true(done(ctx, plm_transient_get_state(k ? full : motion, CHAIN_DOFS, q, v)));
        assert_true(difference(q, rest, CHAIN_DOFS) < 1e-7 * largest(rest, CHAIN_DOFS));
        assert_true(largest(v, CHAIN_DOFS) == 0);
        assert_true(done(ctx, plm_transient_run(k ? full : motion)));
    }
    n = recorded(motion, history);
    assert_int_equal(recorded(full, other), n);
    printf("    largest difference %.1e of %.1e\n", difference(history, other, n), largest(history, n));
    assert_true(difference(history, other, n) < 1e-4 * largest(history, n));
}

/* multipliers of a point and of the motion found from it */
static double multiplier_error(plm_branch *curve, int64_t point, double *first) {
    double re[64], im[64], a[64], b[64], worst = 0;
    int64_t n = 0, m = 0, j, k;
    assert_true(done(ctx, plm_branch_get_multipliers(curve, point, 64, re, im, &n)));
    assert_true(done(ctx, plm_transient_get_multipliers(motion, 64, a, b, &m)));
    assert_true(n == m && n > 0);
    for (j = 0; j < n; ++j) { /* of nearly equal moduli the order is not certain */
        double nearest = 1e300;
        for (k = 0; k < n; ++k) nearest = fmin(nearest, hypot(re[j] - a[k], im[j] - b[k]));
        worst = larger(worst, nearest);
    }
    *first = hypot(a[0], b[0]);
    return worst;
}

static void a_point_of_harmonic_balance_is_periodic(void **state) {
    plm_hbm *hbm = NULL;
    plm_branch *point = NULL;
    double hz = 0, defect = 1, before = 1, peak = 0, first = 2, error[2] = {1, 1};
    int64_t n = 0, stable = -1, settled = 0, k;
    (void)state;
    assert_true(done(ctx, chain_built(ctx, 1, &model)));
    assert_true(done(ctx, plm_basis_create(model, &basis)));
    assert_true(done(ctx, plm_basis_set_string(basis, "kind", "full")));
    assert_true(done(ctx, plm_basis_set_double(basis, "frequency_min_hz", 2)));
    assert_true(done(ctx, plm_basis_set_double(basis, "frequency_max_hz", 4)));
    assert_true(done(ctx, plm_basis_build(basis)));
    assert_true(done(ctx, plm_hbm_create(basis, &hbm)));
    assert_true(done(ctx, plm_hbm_set_string(hbm, "stability", "floquet")));
    motion = new_motion(basis, 1, 1, 5000, WATCHED);
    for (k = 1; k >= 0; --k) { /* the multipliers hang on the instants of contact: they need more harmonics */
        assert_true(done(ctx, plm_hbm_set_int(hbm, "n_harmonics", k ? 80 : 20)));
        assert_true(done(ctx, plm_hbm_solve(hbm, 3.1, NULL, 0, &point)));
        assert_true(done(ctx, plm_transient_start_at(motion, point, 0)));
        assert_true(done(ctx, plm_transient_find_periodic(motion)));
        error[k] = multiplier_error(point, 0, &first);
    }
    assert_true(done(ctx, plm_branch_get_amplitude(point, WATCHED, PLM_PEAK, 0, 1, &peak, &n)));
    assert_true(done(ctx, plm_branch_get_periodicity_defect(point, 0, &before)));
    plm_transient_get_double(motion, "frequency_hz", &hz);
    assert_true(close_to(hz, 3.1, 1e-14));
    plm_transient_get_double(motion, "periodicity_defect", &defect);
    plm_transient_get_int(motion, "stable", &stable);
    assert_true(done(ctx, plm_transient_run(motion)));
    n = recorded(motion, history);
    printf("    periodicity defect %.1e, then %.1e; peak off by %.1e; multipliers by %.1e, of 80 harmonics "
           "%.1e\n",
           before, defect, largest(history, n) / peak - 1, error[0], error[1]);
    assert_true(before > defect && before < 1e-2 && defect < 1e-11);
    assert_true(close_to(largest(history, n), peak, 1e-4));
    assert_true(stable == 1 && first < 1 && error[0] < 0.1 && error[1] < 1e-3);
    assert_true(done(ctx, plm_transient_set_double(motion, "settled", 1e-6)));
    assert_true(done(ctx, plm_transient_run(motion)));
    assert_int_equal(plm_transient_get_int(motion, "is_settled", &settled), PLM_OK);
    assert_int_equal(settled, 1);
    /* the same point in the full model: marching changes it as little as the time steps allow */
    motion = new_motion(NULL, 1, 2, 5000, WATCHED);
    assert_true(done(ctx, plm_transient_start_at(motion, point, 0)));
    assert_true(done(ctx, plm_transient_run(motion)));
    n = recorded(motion, history);
    assert_true(close_to(largest(history, n), peak, 1e-3));
}

/* hardening by a stop: of three motions the middle one is unstable; disturbed, it leaves for one of the
 * others */
static void an_unstable_motion_is_found_and_left(void **state) {
    const oscillator o = {1, 0.03, 3, 1, 0.2};
    plm_hbm *hbm = NULL;
    plm_branch *curve = NULL;
    double first = 0, error, peak[4000], q = 0, v = 0, change = 1;
    int64_t stable[4000], n = 0, k, middle = -1, is_stable = -1;
    (void)state;
    assert_true(make(&o, 0.3));
    assert_true(done(ctx, plm_hbm_create(basis, &hbm)));
    assert_true(done(ctx, plm_hbm_set_int(hbm, "n_harmonics", 20)));
    assert_true(done(ctx, plm_hbm_set_double(hbm, "frequency_min_hz", 0.1)));
    assert_true(done(ctx, plm_hbm_set_string(hbm, "stability", "floquet")));
    assert_true(done(ctx, plm_hbm_sweep(hbm, &curve)));
    assert_true(done(ctx, plm_branch_get_int_array(curve, "stable", 4000, stable, &n)));
    for (k = 1; k < n - 1; ++k)
        if (stable[k - 1] == 0 && stable[k] == 0 && stable[k + 1] == 0) middle = k;
    assert_true(middle > 0);
    assert_true(done(ctx, plm_branch_get_amplitude(curve, 0, PLM_PEAK, 0, 4000, peak, &n)));
    motion = new_motion(basis, 1, 1, 5000, 0);
    assert_true(done(ctx, plm_transient_start_at(motion, curve, middle)));
    assert_true(done(ctx, plm_transient_find_periodic(motion)));
    plm_transient_get_int(motion, "stable", &is_stable);
    error = multiplier_error(curve, middle, &first);
    assert_true(done(ctx, plm_transient_run(motion)));
    n = recorded(motion, history);
    printf("    first multiplier %.3f, off by %.1e; peak off by %.1e\n", first, error,
           largest(history, n) / peak[middle] - 1);
    assert_true(is_stable == 0 && first > 1 && error < 1e-2 * first);
    assert_true(close_to(largest(history, n), peak[middle], 1e-3));
    plm_transient_get_state(motion, 1, &q, &v);
    v *= 1.05;
    assert_true(done(ctx, plm_transient_set_state(motion, 1, &q, &v)));
    plm_transient_set_int(motion, "periods", 5000);
    plm_transient_set_int(motion, "steps_per_period", 4);
    plm_transient_set_double(motion, "settled", 1e-8);
    assert_true(done(ctx, plm_transient_run(motion)));
    plm_transient_get_double(motion, "change", &change);
    assert_true(change >= 0 && change < 1e-8);
    assert_true(done(ctx, plm_transient_find_periodic(motion)));
    plm_transient_get_int(motion, "stable", &is_stable);
    assert_int_equal(is_stable, 1);
    plm_transient_set_int(motion, "periods", 1);
    plm_transient_set_int(motion, "steps_per_period", 1000);
    assert_true(done(ctx, plm_transient_run(motion)));
    n = recorded(motion, history);
    assert_true(fabs(largest(history, n) - peak[middle]) > 0.05 * peak[middle]);
}

/* a stop so stiff that the velocity jumps: the harmonics of a point are far from where its motion begins */
static void a_point_of_exact_motions_begins_as_it_is(void **state) {
    const oscillator o = {1, 0.05, 1e7, 0.5, 1};
    plm_hbm *hbm = NULL;
    plm_branch *curve = NULL;
    double peak[4000], defect = 1;
    int64_t n = 0, k, iterations = -1;
    (void)state;
    assert_true(make(&o, 0.4));
    assert_true(done(ctx, plm_hbm_create(basis, &hbm)));
    assert_true(done(ctx, plm_hbm_set_double(hbm, "frequency_min_hz", 0.25)));
    assert_true(done(ctx, plm_hbm_set_double(hbm, "frequency_max_hz", 0.35)));
    assert_true(done(ctx, plm_hbm_set_string(hbm, "motion", "exact")));
    assert_true(done(ctx, plm_hbm_sweep(hbm, &curve)));
    assert_true(done(ctx, plm_branch_get_amplitude(curve, 0, PLM_PEAK, 0, 4000, peak, &n)));
    motion = new_motion(basis, 1, 1, 5000, 0);
    for (k = 0; k < n; k += n / 8) {
        assert_true(done(ctx, plm_transient_start_at(motion, curve, k)));
        assert_true(done(ctx, plm_transient_set_double(motion, "tolerance", 1e-8)));
        assert_true(done(ctx, plm_transient_find_periodic(motion)));
        plm_transient_get_double(motion, "periodicity_defect", &defect);
        plm_transient_get_int(motion, "iterations", &iterations);
        printf("    point %d of %d: defect %.1e after %d iterations, peak %.3f\n", (int)k, (int)n, defect,
               (int)iterations, peak[k]);
        assert_true(iterations == 0 && defect < 1e-8);
    }
}

int main(void) {
#define TEST(f) cmocka_unit_test_setup_teardown(f, set_up, tear_down)
    const struct CMUnitTest tests[] = {
        TEST(a_linear_oscillator_in_closed_form),         TEST(a_bilinear_oscillator_in_closed_form),
        TEST(the_full_model_agrees_with_its_reduced_one), TEST(a_point_of_harmonic_balance_is_periodic),
        TEST(an_unstable_motion_is_found_and_left),       TEST(a_point_of_exact_motions_begins_as_it_is),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
