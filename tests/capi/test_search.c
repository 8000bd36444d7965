/* What there is beside a response curve: isolated branches by three independent ways, backbones, folds over
 * the force, curves that leave at a bifurcation, nonlinear modes; against closed forms and against each
 * other. */
#include "carrier.h"
#include "check.h"
#include "oscillator.h"

#define PI 3.14159265358979323846
enum { MANY = 4000, H = 9 };
static const double low_omega = 0.9, high_omega = 1.6, force = 0.006;

static plm_context *ctx;
static plm_model *model;
static plm_basis *basis;
static plm_hbm *hbm;

static plm_hbm *new_hbm(double low, double high, int64_t harmonics, double scale) {
    plm_hbm *h = NULL;
    const int ok = done(ctx, plm_hbm_create(basis, &h)) &&
                   done(ctx, plm_hbm_set_double(h, "frequency_min_hz", low / (2 * PI))) &&
                   done(ctx, plm_hbm_set_double(h, "frequency_max_hz", high / (2 * PI))) &&
                   done(ctx, plm_hbm_set_int(h, "n_harmonics", harmonics)) &&
                   done(ctx, plm_hbm_set_double(h, "force_scale", scale)) &&
                   done(ctx, plm_hbm_set_double(h, "tolerance", 1e-11));
    return ok ? h : NULL;
}

static int set_up(void **state) {
    (void)state;
    if (plm_context_create(PLM_API_VERSION, &ctx)) return 1;
    if (!done(ctx, carrier_built(ctx, 0.004, &model, &basis))) return 1;
    hbm = new_hbm(low_omega, high_omega, H, force);
    return hbm == NULL;
}
static int set_up_without_scene(void **state) {
    (void)state;
    return plm_context_create(PLM_API_VERSION, &ctx);
}
static int tear_down(void **state) {
    (void)state;
    return plm_context_destroy(&ctx);
}

static plm_branch *curve_at(double scale) {
    plm_branch *curve = NULL;
    assert_true(done(ctx, plm_hbm_set_double(hbm, "force_scale", scale)));
    assert_true(done(ctx, plm_hbm_sweep(hbm, &curve)));
    return curve;
}
static int64_t isolated_at(double scale) {
    int64_t count = -1;
    assert_true(done(ctx, plm_hbm_find_isolated(hbm, curve_at(scale), 0, &count)));
    return count;
}
static plm_branch *found(int64_t index, double *range) {
    plm_branch *branch = NULL;
    assert_true(done(ctx, plm_hbm_get_found(hbm, index, range, &branch)));
    return branch;
}

static int64_t points_of(plm_branch *branch) {
    int64_t n = -1;
    assert_int_equal(plm_branch_get_int(branch, "n_points", &n), PLM_OK);
    assert_true(n > 0 && n <= MANY);
    return n;
}
static int64_t integer(plm_branch *branch, const char *key) {
    int64_t value = -99;
    assert_int_equal(plm_branch_get_int(branch, key, &value), PLM_OK);
    return value;
}
static double at(plm_branch *branch, const char *key, int64_t point) {
    static double values[MANY];
    int64_t n = 0;
    assert_int_equal(plm_branch_get_array(branch, key, MANY, values, &n), PLM_OK);
    assert_true(point < n);
    return values[point];
}
static double measured(plm_branch *branch, int32_t measure, int64_t point) {
    static double values[MANY];
    int64_t n = 0;
    assert_int_equal(plm_branch_get_amplitude(branch, 0, measure, 1, MANY, values, &n), PLM_OK);
    assert_true(point < n);
    return values[point];
}
static double highest(plm_branch *branch) {
    static double peak[MANY];
    double most = 0;
    int64_t n = 0, k;
    assert_int_equal(plm_branch_get_amplitude(branch, 0, PLM_PEAK, 0, MANY, peak, &n), PLM_OK);
    for (k = 0; k < n; ++k) most = larger(most, peak[k]);
    return most;
}
/* positions of the bifurcations of a kind: how many, and the first `capacity` of them */
static int64_t of_kind(plm_branch *branch, int32_t kind, int64_t capacity, int64_t *where) {
    static int64_t bifurcation[MANY];
    int64_t n = 0, k, count = 0;
    assert_int_equal(plm_branch_get_int_array(branch, "bifurcation", MANY, bifurcation, &n), PLM_OK);
    for (k = 0; k < n; ++k)
        if (bifurcation[k] == kind && count++ < capacity) where[count - 1] = k;
    return count;
}

static void an_isolated_branch_is_found_without_a_hint(void **state) {
    plm_branch *curve, *loop;
    double range[2] = {0, 0};
    int64_t count = -1, n;
    (void)state;
    curve = curve_at(force);
    assert_true(done(ctx, plm_hbm_find_isolated(hbm, curve, 0, &count)));
    assert_int_equal(count, 1);
    loop = found(0, range);
    printf("    main peak %.4f, isola %.4f, exists for %.6f < F < %.6f\n", highest(curve), highest(loop),
           range[0], range[1]);
    assert_true(close_to(range[0], 0.004045, 1e-3) && close_to(range[1], 0.008706, 1e-3));
    assert_true(highest(loop) > 1.5 * highest(curve));
    assert_int_equal(integer(loop, "end_reason"), PLM_REASON_LOOP_CLOSED);
    assert_int_equal(of_kind(loop, PLM_BIFURCATION_FOLD, 0, NULL), 2);
    n = points_of(loop);
    assert_true(at(loop, "frequency_hz", 0) == at(loop, "frequency_hz", n - 1));
    assert_true(points_of(found(0, NULL)) == n); /* a second handle of the same branch */
    assert_true(done(ctx, plm_hbm_find_isolated(hbm, curve, 1.01 * force, &count)));
    assert_int_equal(count, 0); /* it merges above that force */
    /* the ends of the range: by searches around the birth, by plain sweeps around the merger */
    assert_int_equal(isolated_at(0.004045 * 0.99), 0);
    assert_true(refused(ctx, plm_hbm_get_found(hbm, 0, NULL, &loop), PLM_ERR_STATE, "plm_hbm_get_found",
                        "index", -1, "has found no branch"));
    assert_int_equal(isolated_at(0.004045 * 1.01), 1);
    assert_true(highest(curve_at(0.008706 * 1.01)) > 2 * highest(curve_at(0.008706 * 0.99)));
}

/* On a backbone the displacement is in quadrature to the force, its points are solutions at their own force,
 * and between birth and merger of the isola the force falls with growing amplitude. */
static void backbones_are_in_quadrature(void **state) {
    plm_branch *backbone, *same = NULL;
    double range[2] = {0, 0}, c[2 * H + 1], scale = 0, most = 0, largest = 0, worst = 0;
    int64_t count = -1, n, k, falls = 0;
    (void)state;
    assert_true(done(ctx, plm_hbm_find_backbones(hbm, 0.02, &count)));
    assert_int_equal(count, 1);
    backbone = found(0, range);
    assert_true(isnan(range[0]) && isnan(range[1]));
    n = points_of(backbone);
    for (k = 0; k < n; ++k) {
        const double before = scale;
        scale = at(backbone, "point_force_scale", k);
        falls += k > 0 && scale < before;
        largest = larger(largest, scale);
        assert_int_equal(plm_branch_get_coefficients(backbone, k, 0, 1, c), PLM_OK);
        worst = larger(worst, fabs(c[1] / c[2]));
    }
    printf("    %d points, %d with falling force; cosine over sine part %.1e\n", (int)n, (int)falls, worst);
    assert_true(n > 10 && falls > 0 && falls < n - 1 && worst < 1e-8);
    assert_true(largest <= 0.02 * (1 + 1e-9) && largest > 0.015);
    for (k = 1; k < n; k += n / 5) {
        assert_true(done(ctx, plm_hbm_set_double(hbm, "force_scale", at(backbone, "point_force_scale", k))));
        /* a warning where few harmonics leave the stability open */
        assert_true(plm_hbm_solve(hbm, at(backbone, "frequency_hz", k), backbone, k, &same) >= PLM_OK);
        most = larger(most, fabs(measured(same, PLM_PEAK, 0) / measured(backbone, PLM_PEAK, k) - 1));
    }
    printf("    solved at the points' own forces: off by %.1e\n", most);
    assert_true(most < 1e-7);
}

/* the folds of the loop at one force, tracked to a second one, are those of the loop found there; further up
 * they turn where it merges */
static void folds_are_followed_over_the_force(void **state) {
    const double second = 0.007;
    plm_branch *loop, *there, *folds = NULL;
    double range[2] = {0, 0}, turn = 0;
    int64_t from[2] = {-1, -1}, to[2] = {-1, -1}, ends[8], k, j, n;
    (void)state;
    assert_int_equal(isolated_at(second), 1);
    there = found(0, NULL);
    assert_int_equal(of_kind(there, PLM_BIFURCATION_FOLD, 2, to), 2);
    assert_int_equal(isolated_at(force), 1);
    loop = found(0, range);
    assert_int_equal(of_kind(loop, PLM_BIFURCATION_FOLD, 2, from), 2);
    for (k = 0; k < 2; ++k) {
        double hz, nearest = 1;
        assert_true(done(ctx, plm_hbm_track_fold(hbm, loop, from[k], 0.002, second, &folds)));
        assert_int_equal(integer(folds, "end_reason"), PLM_REASON_RANGE_END);
        n = points_of(folds); /* through the fold it began at, from one side to the other */
        for (j = 0; j < n; ++j)
            if (close_to(at(folds, "point_force_scale", j), force, 1e-12) &&
                close_to(at(folds, "frequency_hz", j), at(loop, "frequency_hz", from[k]), 1e-7))
                break;
        assert_true(j < n);
        n = close_to(at(folds, "point_force_scale", 0), second, 1e-9) ? 1 : n;
        assert_true(close_to(at(folds, "point_force_scale", n - 1), second, 1e-9));
        hz = at(folds, "frequency_hz", n - 1);
        for (j = 0; j < 2; ++j) nearest = fmin(nearest, fabs(at(there, "frequency_hz", to[j]) / hz - 1));
        printf("    fold %d at the second force: off by %.1e\n", (int)k, nearest);
        assert_true(nearest < 1e-6);
    }
    for (k = 0; k < 2; ++k) { /* one of their extrema is the one that merges, others are births */
        assert_true(done(ctx, plm_hbm_track_fold(hbm, loop, from[k], 0.002, 0.01, &folds)));
        n = of_kind(folds, PLM_BIFURCATION_FOLD, 8, ends);
        for (j = 0; j < n && j < 8; ++j) {
            const double force_there = at(folds, "point_force_scale", ends[j]);
            if (fabs(force_there - range[1]) < fabs(turn - range[1])) turn = force_there;
        }
    }
    assert_true(close_to(turn, range[1], 1e-6));
}

static void marching_comes_upon_the_same_curves(void **state) {
    plm_branch *known[2], *by_search;
    int64_t count = -1;
    (void)state;
    assert_int_equal(isolated_at(force), 1);
    by_search = found(0, NULL);
    known[0] = curve_at(force);
    /* at rest everywhere: the main curve itself, when none is known */
    assert_true(done(ctx, plm_hbm_find_by_marching(hbm, 0, NULL, 3, 2, &count)));
    assert_true(count >= 1);
    assert_true(close_to(highest(found(0, NULL)), highest(known[0]), 1e-2));
    assert_true(done(ctx, plm_hbm_find_by_marching(hbm, 1, known, 3, 0, &count)));
    assert_int_equal(count, 0);
    /* from 1, or 1, 2 and 4 times the largest response, around the isola: it, and nothing more when it is
     * known */
    plm_hbm_set_double(hbm, "frequency_min_hz", 1.1 / (2 * PI));
    plm_hbm_set_double(hbm, "frequency_max_hz", 1.25 / (2 * PI));
    assert_true(done(ctx, plm_hbm_find_by_marching(hbm, 1, known, 12, 1, &count)));
    assert_int_equal(count, 1);
    assert_true(done(ctx, plm_hbm_find_by_marching(hbm, 1, known, 12, 3, &count)));
    assert_int_equal(count, 1);
    known[1] = found(0, NULL);
    assert_int_equal(integer(known[1], "end_reason"), PLM_REASON_LOOP_CLOSED);
    printf("    top %.4f, by the search for isolas %.4f\n", highest(known[1]), highest(by_search));
    assert_true(close_to(highest(known[1]), highest(by_search), 1e-2)); /* discrete points of two loops */
    assert_true(done(ctx, plm_hbm_find_by_marching(hbm, 2, known, 12, 3, &count)));
    assert_int_equal(count, 0);
}

/* After a period doubling the motion repeats after two periods of the excitation, by the exact flow, and not
 * after one; the mirrored curve is the same motion a period later. */
static void a_doubled_response_repeats_after_two_periods(void **state) {
    const oscillator o = {1, 0.04, 3, 0, 1};
    enum { DOUBLED = 40 };
    plm_branch *curve = NULL, *doubled[2] = {NULL, NULL};
    double defect = 1, now = 0, later = 0, c[2][2 * DOUBLED + 1], worst = 0;
    int64_t where[2] = {-1, -1}, n, k, point;
    (void)state;
    assert_true(done(ctx, oscillator_built(ctx, &o, 0.7, &model, &basis)));
    hbm = new_hbm(2, 3.8, 20, 1);
    assert_true(done(ctx, plm_hbm_sweep(hbm, &curve)));
    assert_int_equal(integer(curve, "period_multiple"), 1);
    assert_int_equal(of_kind(curve, PLM_BIFURCATION_PERIOD_DOUBLING, 2, where), 2);
    for (k = 0; k < 2; ++k) {
        assert_true(done(ctx, plm_hbm_switch_branch(hbm, curve, where[1], (int32_t)k, &doubled[k])));
        assert_int_equal(integer(doubled[k], "period_multiple"), 2);
        assert_int_equal(integer(doubled[k], "n_harmonics"), DOUBLED); /* as far up in frequency */
        assert_int_equal(integer(doubled[k], "end_reason"), PLM_REASON_LOOP_CLOSED);
        n = points_of(doubled[k]);
        point = n / 4;
        assert_true(done(ctx, plm_branch_get_periodicity_defect(doubled[k], point, &defect)));
        assert_int_equal(plm_branch_get_field(doubled[k], point, 0, 1, &now), PLM_OK);
        assert_int_equal(plm_branch_get_field(doubled[k], point, 0.5, 1, &later), PLM_OK);
        printf("    %d points; after two periods off by %.1e, after one by %.1e\n", (int)n, defect,
               fabs(later - now) / measured(doubled[k], PLM_PEAK, point));
        assert_true(defect < 1e-4);
        assert_true(fabs(later - now) > 0.05 * measured(doubled[k], PLM_PEAK, point));
        assert_int_equal(plm_branch_get_coefficients(doubled[k], 1, 0, 1, c[k]), PLM_OK);
    }
    assert_true(close_to(at(doubled[0], "frequency_hz", 1), at(doubled[1], "frequency_hz", 1), 1e-9));
    for (k = 1; k <= DOUBLED;
         ++k) { /* a period later: odd harmonics of the longer period change their sign */
        const double sign = k % 2 ? -1 : 1;
        worst = larger(worst, fabs(c[0][2 * k - 1] - sign * c[1][2 * k - 1]));
        worst = larger(worst, fabs(c[0][2 * k] - sign * c[1][2 * k]));
    }
    printf("    mirrored: off by %.1e of %.1e\n", worst, hypot(c[0][1], c[0][2]));
    assert_true(worst < 1e-5 * hypot(c[0][1], c[0][2]));
    /* a peak is judged on the period of its curve, whatever the solver's own is now */
    for (k = 1; k <= 3; ++k) {
        plm_branch *top = NULL;
        char warning[200] = "?";
        assert_true(done(ctx, plm_hbm_set_int(hbm, "period_multiple", k)));
        assert_true(done(ctx, plm_hbm_find_peak(hbm, doubled[0], 0, PLM_PEAK, 0, &now, &later, &top)));
        assert_int_equal(plm_branch_get_string(top, "warning", sizeof warning, warning, NULL), PLM_OK);
        assert_string_equal(warning, "");
    }
}

/* never in contact: exp((-c / 2 +- i omega_d) T) */
static void multipliers_of_a_linear_motion_in_closed_form(void **state) {
    const oscillator o = {40, 0.5, 1e3, 100, 3};
    const double period = 1 / 0.7, decay = exp(-0.25 * period), angle = sqrt(40 - 0.0625) * period;
    plm_branch *point = NULL;
    double re[2] = {7, 7}, im[2] = {7, 7}, defect = 1, energy = -1, area = -1, amplitude;
    int64_t n = 0;
    (void)state;
    assert_true(done(ctx, oscillator_built(ctx, &o, 5, &model, &basis)));
    hbm = new_hbm(1, 10, 3, 1);
    assert_true(done(ctx, plm_hbm_set_string(hbm, "stability", "floquet")));
    assert_true(done(ctx, plm_hbm_solve(hbm, 0.7, NULL, 0, &point)));
    assert_true(done(ctx, plm_branch_get_multipliers(point, 0, 0, NULL, NULL, &n)));
    assert_int_equal(n, 2);
    assert_true(done(ctx, plm_branch_get_multipliers(point, 0, 2, re, im, &n)));
    assert_true(close_to(re[0], decay * cos(angle), 1e-9) && close_to(re[1], re[0], 1e-9));
    assert_true(close_to(fabs(im[0]), fabs(decay * sin(angle)), 1e-9) && close_to(im[1], -im[0], 1e-9));
    assert_true(done(ctx, plm_branch_get_periodicity_defect(point, 0, &defect)));
    assert_true(defect < 1e-10);
    /* mean of k q^2 / 2 and m q'^2 / 2 */
    amplitude = measured(point, PLM_HARMONIC, 0);
    assert_true(done(ctx, plm_branch_get_energy(point, 0, &energy, &area)));
    assert_true(close_to(energy, (40 + pow(2 * PI * 0.7, 2)) * amplitude * amplitude / 4, 1e-9));
    assert_true(area == 0);
    assert_true(done(ctx, plm_hbm_set_string(hbm, "stability", "off")));
    assert_true(done(ctx, plm_hbm_solve(hbm, 0.7, NULL, 0, &point)));
    assert_true(done(ctx, plm_branch_get_multipliers(point, 0, 2, re, im, &n)));
    assert_int_equal(n, 0);
}

/* q'' + q + 3 max(q - g, 0) = 0 with amplitude a > g on the open side: 1 there, 2 about 3 g / 4 on the other
 */
static void exact_mode(double gap, double a, double *omega, double *closed) {
    const double speed = sqrt(a * a - gap * gap), b = hypot(gap / 4, speed / 2);
    const double open_time = PI + 2 * asin(gap / a), closed_time = acos(gap / 4 / b);
    *omega = 2 * PI / (open_time + closed_time);
    *closed = closed_time / (open_time + closed_time);
}

typedef struct mode_errors {
    double omega, closed, energy;
} mode_errors;
static mode_errors errors_of(plm_branch *mode, double gap) {
    mode_errors e = {0, 0, 0};
    const int64_t n = points_of(mode);
    int64_t k;
    for (k = 0; k < n; ++k) {
        const double a = measured(mode, PLM_PEAK, k); /* on the open side, where the motion is wider */
        double omega = 1, closed = 0, energy = -1, area = -1, alone = -1;
        if (a > gap) exact_mode(gap, a, &omega, &closed);
        assert_true(done(ctx, plm_branch_get_energy(mode, k, &energy, &area)));
        assert_true(done(ctx, plm_branch_get_energy(mode, k, &alone, NULL)));
        assert_true(alone == energy && at(mode, "point_force_scale", k) == 0);
        e.omega = larger(e.omega, fabs(2 * PI * at(mode, "frequency_hz", k) / omega - 1));
        e.closed = larger(e.closed, fabs(area - closed));
        e.energy = larger(e.energy, fabs(2 * energy / (a * a) - 1));
    }
    printf("    %d points; errors: frequency %.1e, contact time %.1e, energy %.1e\n", (int)n, e.omega,
           e.closed, e.energy);
    return e;
}
static int reaches(plm_branch *mode, double amplitude) {
    const int64_t n = points_of(mode);
    return integer(mode, "end_reason") == PLM_REASON_RANGE_END && n > 3 &&
           close_to(measured(mode, PLM_HARMONIC, n - 1), amplitude, 1e-6) &&
           measured(mode, PLM_HARMONIC, n - 2) < amplitude;
}

static void nonlinear_modes_of_bilinear_oscillators_in_closed_form(void **state) {
    const oscillator no_gap = {1, 0, 3, 0, 1}, with_gap = {1, 0, 3, 1, 1};
    plm_branch *mode = NULL;
    mode_errors e;
    (void)state;
    assert_true(done(ctx, oscillator_built(ctx, &no_gap, 0.7, &model, &basis)));
    hbm = new_hbm(1, 2, 40, 1);
    assert_true(done(ctx, plm_hbm_find_nonlinear_mode(hbm, 1, 0, 2.5, &mode)));
    assert_true(reaches(mode, 2.5));
    e = errors_of(mode, 0); /* 4/3 at every amplitude */
    assert_true(e.omega < 1e-6 && e.closed < 1e-4 && e.energy < 1e-4);
    assert_true(close_to(2 * PI * at(mode, "frequency_hz", 0), 4.0 / 3, 1e-6));
    mode = NULL; /* without gap and pre-load no amplitude stands out */
    assert_true(refused(ctx, plm_hbm_find_nonlinear_mode(hbm, 1, 0, 0, &mode), PLM_ERR_ARGUMENT,
                        "plm_hbm_find_nonlinear_mode", "amplitude_max", -1, "up to which amplitude"));
    assert_null(mode);
    assert_true(done(ctx, oscillator_built(ctx, &with_gap, 0.7, &model, &basis)));
    hbm = new_hbm(1, 2, 20, 1);
    assert_true(done(ctx, plm_hbm_find_nonlinear_mode(hbm, 1, 0, 20, &mode)));
    assert_true(reaches(mode, 20));
    e = errors_of(mode, 1);
    assert_true(e.omega < 1e-4 && e.closed < 1e-3 && e.energy < 1e-3);
    /* by itself to a hundred times the amplitude at which the pair closes first */
    assert_true(done(ctx, plm_hbm_find_nonlinear_mode(hbm, 1, 0, 0, &mode)));
    assert_true(close_to(measured(mode, PLM_HARMONIC, points_of(mode) - 1), 100, 1e-6));
    assert_true(at(mode, "frequency_hz", 0) < at(mode, "frequency_hz", points_of(mode) - 1));
}

/* On a single mass 2 xi w M takes the place of C = c M at every instant, whatever the contact does: xi w = c
 * / 2. */
static void the_damping_of_a_single_mass_in_closed_form(void **state) {
    const oscillator damped = {1, 0.02, 3, 1, 1};
    plm_branch *mode = NULL, *curve = NULL;
    double xi[MANY];
    int64_t k, n = -1;
    (void)state;
    assert_true(done(ctx, oscillator_built(ctx, &damped, 0.7, &model, &basis)));
    hbm = new_hbm(1, 2, 20, 1);
    assert_true(done(ctx, plm_hbm_find_nonlinear_mode(hbm, 1, 0, 20, &mode)));
    assert_true(done(ctx, plm_branch_get_array(mode, "damping_ratio", MANY, xi, &n)));
    assert_int_equal(n, points_of(mode));
    for (k = 0; k < n; ++k) assert_true(close_to(xi[k] * 2 * PI * at(mode, "frequency_hz", k), 0.01, 1e-7));
    assert_true(xi[n - 1] < 0.8 * xi[0]); /* the frequency went from 1 to 1.3 */
    assert_true(done(ctx, plm_hbm_sweep(hbm, &curve)));
    assert_true(done(ctx, plm_branch_get_array(curve, "damping_ratio", 0, NULL, &n)));
    assert_int_equal(n, 0); /* a driven motion has none */
}

/* Up to the opening the mode is the linear one about rest, its energy that of the amplitude alone: the
 * pre-load is not counted. */
static void a_preloaded_mode_begins_at_rest(void **state) {
    plm_branch *mode = NULL;
    double x[2 * H + 1], y[2 * H + 1], energy = 0, area = 0, kinetic, strain, omega;
    /* det(K - l M) = 0.2 l^2 - b l + c */
    const double b = CARRIER_K_11 + 0.2 * CARRIER_K_00,
                 c = CARRIER_K_00 * CARRIER_K_11 - CARRIER_K_01 * CARRIER_K_01;
    int64_t k;
    (void)state;
    /* undamped: C = 0.004 K does not know the contact and couples the modes, 1e-7 of the frequency */
    assert_true(done(ctx, carrier_built(ctx, 0, &model, &basis)));
    hbm = new_hbm(low_omega, high_omega, H, force);
    for (k = 0; k < 2; ++k) {
        omega = sqrt((b + (k ? 1 : -1) * sqrt(b * b - 0.8 * c)) / 0.4);
        assert_true(done(ctx, plm_hbm_find_nonlinear_mode(hbm, k + 1, 0, 0.3, &mode)));
        assert_true(reaches(mode, 0.3));
        assert_true(close_to(2 * PI * at(mode, "frequency_hz", 0), omega, 1e-8));
        assert_int_equal(plm_branch_get_coefficients(mode, 0, 0, 1, x), PLM_OK);
        assert_int_equal(plm_branch_get_coefficients(mode, 0, 1, 1, y), PLM_OK);
        assert_true(close_to(x[0], 0.25, 1e-8)); /* 0.5 on the spring to the ground and on the contact */
        assert_true(fabs(x[1]) < 0.25);
        kinetic = 0.5 * omega * omega * (x[1] * x[1] + 0.2 * y[1] * y[1]);
        strain =
            0.5 * (CARRIER_K_00 * x[1] * x[1] + 2 * CARRIER_K_01 * x[1] * y[1] + CARRIER_K_11 * y[1] * y[1]);
        assert_true(done(ctx, plm_branch_get_energy(mode, 0, &energy, NULL)));
        assert_true(done(ctx, plm_branch_get_energy(mode, 0, NULL, &area)));
        assert_true(close_to(energy, kinetic, 1e-7) && close_to(energy, strain, 1e-7));
        assert_true(close_to(area, 1, 1e-12));
        assert_true(done(ctx, plm_branch_get_energy(mode, points_of(mode) - 1, NULL, &area)));
        assert_true(area > 0.4 && area < 1); /* it opens at 0.25 */
    }
}

int main(void) {
#define TEST(f) cmocka_unit_test_setup_teardown(f, set_up, tear_down)
#define ALONE(f) cmocka_unit_test_setup_teardown(f, set_up_without_scene, tear_down)
    const struct CMUnitTest tests[] = {
        TEST(an_isolated_branch_is_found_without_a_hint),
        TEST(backbones_are_in_quadrature),
        TEST(folds_are_followed_over_the_force),
        TEST(marching_comes_upon_the_same_curves),
        ALONE(a_doubled_response_repeats_after_two_periods),
        ALONE(multipliers_of_a_linear_motion_in_closed_form),
        ALONE(a_preloaded_mode_begins_at_rest),
        ALONE(nonlinear_modes_of_bilinear_oscillators_in_closed_form),
        ALONE(the_damping_of_a_single_mass_in_closed_form),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
