/* plm_hbm_estimate_error against the differences it estimates, plm_basis_set_responses and bases of kind
 * "pod"; what both refuse, argument by argument, and that nothing has changed then. */
#include "carrier.h"
#include "check.h"
#include "cracked_plate.h"
#include "oscillator.h"
#include "scene_model.h"

static plm_context *ctx;

#define REFUSED(call, status, function, argument, index, words)                                              \
    assert_true(refused(ctx, call, status, function, argument, index, words))
#define BAD(call, function, argument, words) REFUSED(call, PLM_ERR_ARGUMENT, function, argument, -1, words)
#define DEAD(call, function, argument) REFUSED(call, PLM_ERR_HANDLE, function, argument, -1, "no live handle")
#define DONE(call) assert_true(done(ctx, call))

static int open_context(void **state) {
    (void)state;
    return plm_context_create(PLM_API_VERSION, &ctx) != PLM_OK;
}
static int close_context(void **state) {
    (void)state;
    return plm_context_destroy(&ctx);
}

/* ---- the cracked plate ---- */

typedef struct plate {
    scene *host;
    plm_model *model;
    plm_basis *full;
    double low_hz, high_hz;
} plate;

static plm_sampler *sampler_of(const plate *p, int64_t n_samples) {
    plm_sampler *s = NULL;
    DONE(plm_sampler_create(p->model, &s));
    DONE(plm_sampler_set_int(s, "mode", p->host->dominant_mode));
    DONE(plm_sampler_set_string(s, "system", "open"));
    DONE(plm_sampler_set_int(s, "n_samples", n_samples));
    DONE(plm_sampler_set_int(s, "n_harmonics", 5)); /* the paper's: a small basis */
    DONE(plm_sampler_run(s));
    return s;
}

static plm_basis *basis_of(const plate *p, const char *kind, const char *selection, int64_t n_samples) {
    plm_basis *b = NULL;
    DONE(plm_basis_create(p->model, &b));
    DONE(plm_basis_set_string(b, "kind", kind));
    DONE(plm_basis_set_string(b, "selection", selection));
    DONE(plm_basis_set_sampler(b, sampler_of(p, n_samples)));
    assert_true(plm_basis_build(b) >= 0); /* selection by bands may warn */
    return b;
}

static void make_plate(plate *p, int with_preload) {
    cracked_plate_params params;
    cracked_plate_quick(&params);
    params.with_preload = with_preload;
    assert_int_equal(cracked_plate_create(&params, &p->host), SCENE_OK);
    DONE(scene_to_model(ctx, p->host, &p->model));
    p->full = basis_of(p, "full", "below", 4);
    DONE(plm_basis_get_double(p->full, "window_low_hz", &p->low_hz));
    DONE(plm_basis_get_double(p->full, "window_high_hz", &p->high_hz));
}

typedef struct peak_of {
    plm_hbm *hbm;
    plm_branch *curve, *point;
    double hz, amplitude;
} peak_of;

static peak_of find_peak(const plate *p, plm_basis *basis, int64_t n_harmonics) {
    peak_of top = {NULL, NULL, NULL, 0, 0};
    DONE(plm_hbm_create(basis, &top.hbm));
    DONE(plm_hbm_set_int(top.hbm, "n_harmonics", n_harmonics));
    DONE(plm_hbm_set_double(top.hbm, "frequency_min_hz", p->low_hz));
    DONE(plm_hbm_set_double(top.hbm, "frequency_max_hz", p->high_hz));
    DONE(plm_hbm_set_string(top.hbm, "stability", "off"));
    DONE(plm_hbm_set_string(top.hbm, "bifurcations", "off"));
    /* bases of all sizes are compared here, too small ones among them */
    assert_true(done_but_for(ctx, plm_hbm_sweep(top.hbm, &top.curve), PLM_REASON_BASIS_TOO_SMALL));
    assert_true(plm_hbm_find_peak(top.hbm, top.curve, p->host->output_dof, PLM_HALF_PEAK_TO_PEAK, 0, &top.hz,
                                  &top.amplitude,
                                  &top.point) >= 0); /* where bases are that small, more is said */
    return top;
}

static void estimate(const plate *p, const peak_of *top, double *amplitude, double *hz) {
    const plm_status status = plm_hbm_estimate_error(top->hbm, top->point, 0, p->host->output_dof,
                                                     PLM_HALF_PEAK_TO_PEAK, 0, amplitude, hz);
    if (status != PLM_WARNING)
        DONE(status); /* a warning: some parts are NaN, since their steps do not contract */
}

/* a[0] + a[1] against the true difference of the peaks */
static void basis_errors_are_right(const plate *p) {
    static const char *const selections[] = {"bands", "below"};
    const peak_of truth = find_peak(p, p->full, 5);
    int compared = 0, i, n;
    for (i = 0; i < 2; ++i)
        for (n = 1; n <= 4; n *= 2) {
            const peak_of top = find_peak(p, basis_of(p, "plm", selections[i], n), 5);
            const double missing = truth.amplitude - top.amplitude,
                         relative = fabs(missing) / truth.amplitude;
            double a[3], f[3], estimated;
            estimate(p, &top, a, f);
            estimated = a[0] + a[1];
            print_message("%s, %d samples: amplitude %.3e, estimated %.3e; frequency %.3e, estimated %.3e\n",
                          selections[i], n, missing / truth.amplitude, estimated / truth.amplitude,
                          truth.hz / top.hz - 1, (f[0] + f[1]) / top.hz);
            if (relative < 0.01 && relative > 1e-8) {
                assert_true(close_to(estimated, missing, 0.2));
                ++compared;
            } else if (relative >=
                       0.01) { /* far off: the estimate must not say it is well (NaN: it says nothing) */
                assert_true(!(fabs(estimated) <= 0.003 * truth.amplitude));
            }
        }
    assert_true(compared >= 2);
}

static void the_error_of_the_basis(void **state) {
    int with_preload;
    (void)state;
    for (with_preload = 0; with_preload < 2; ++with_preload) {
        plate p;
        make_plate(&p, with_preload);
        basis_errors_are_right(&p);
        scene_destroy(&p.host);
    }
}

/* of the unreduced structure: only the harmonics are missing */
static void the_error_of_the_harmonics(void **state) {
    plate p;
    peak_of coarse, fine;
    double a[3] = {7, 7, 7}, f[3] = {7, 7, 7}, alone[3], missing, shift;
    int64_t n;
    (void)state;
    make_plate(&p, 1);
    fine = find_peak(&p, p.full, 40);
    for (n = 3; n <= 9; n += 3) {
        coarse = find_peak(&p, p.full, n);
        estimate(&p, &coarse, a, f);
        missing = fine.amplitude - coarse.amplitude, shift = fine.hz - coarse.hz;
        print_message("%d harmonics: amplitude %.3e, estimated %.3e; frequency %.3e, estimated %.3e\n",
                      (int)n, missing / fine.amplitude, a[2] / fine.amplitude, shift / fine.hz,
                      f[2] / fine.hz);
        assert_true(fabs(a[0]) < 1e-7 * fine.amplitude && fabs(a[1]) < 1e-7 * fine.amplitude);
        assert_true(fabs(f[0]) < 1e-8 * fine.hz && fabs(f[1]) < 1e-8 * fine.hz);
        assert_true(a[2] / missing > 0.25 && a[2] / missing < 4);
    }
    /* each output alone, and none */
    DONE(plm_hbm_estimate_error(coarse.hbm, coarse.point, 0, p.host->output_dof, PLM_HALF_PEAK_TO_PEAK, 0,
                                alone, NULL));
    assert_memory_equal(alone, a, sizeof a);
    DONE(plm_hbm_estimate_error(coarse.hbm, coarse.point, 0, p.host->output_dof, PLM_HALF_PEAK_TO_PEAK, 0,
                                NULL, alone));
    assert_memory_equal(alone, f, sizeof f);
    DONE(plm_hbm_estimate_error(coarse.hbm, coarse.point, 0, p.host->output_dof, PLM_RMS, 0, NULL, NULL));
    scene_destroy(&p.host);
}

static void a_basis_of_responses(void **state) {
    plate p;
    plm_basis *basis, *pod = NULL;
    peak_of parent, small;
    double a[3], f[3], value = 0, setup = -1, values[500];
    int64_t count = 0, r = 0, parent_size = 0, r_0 = 0;
    char text[300], parent_text[300];
    (void)state;
    make_plate(&p, 1);
    basis = basis_of(&p, "plm", "below", 4);
    parent = find_peak(&p, basis, 5);
    DONE(plm_basis_create(p.model, &pod));
    DONE(plm_basis_set_string(pod, "kind", "pod"));
    DONE(plm_basis_set_int(pod, "pod_size", 8));
    DONE(plm_basis_set_parent(pod, basis));
    DONE(plm_basis_set_responses(pod, 1, &parent.curve));
    DONE(plm_branch_destroy(&parent.curve)); /* it has been read */
    DONE(plm_basis_build(pod));
    small = find_peak(&p, pod, 5);
    estimate(&p, &small, a, f);
    print_message("8 columns: amplitude %.2e, estimated %.2e + %.2e; frequency %.2e, estimated %.2e\n",
                  parent.amplitude / small.amplitude - 1, a[0] / small.amplitude, a[1] / small.amplitude,
                  parent.hz / small.hz - 1, (f[0] + f[1]) / small.hz);
    assert_true(close_to(small.amplitude, parent.amplitude, 5e-4) && close_to(small.hz, parent.hz, 1e-5));
    assert_true(fabs(a[0] + a[1]) < 5e-4 * small.amplitude);

    /* the results by key */
    DONE(plm_basis_get_int(pod, "size", &r));
    DONE(plm_basis_get_int(pod, "static_size", &r_0));
    DONE(plm_basis_get_int(basis, "size", &parent_size));
    DONE(plm_basis_get_int(pod, "n_collected", &count));
    assert_true(r == 8 && r_0 >= 1 && count == parent_size);
    DONE(plm_basis_get_array(pod, "singular_values", 500, values, &count));
    assert_true(count >= 8 && values[0] == 1 && values[7] < 1 && values[7] > 0 &&
                values[count - 1] <= values[7]);
    DONE(plm_basis_get_array(pod, "lambda", 500, values, &count));
    assert_true(count == 8 && values[0] > 0);
    DONE(plm_basis_get_double(pod, "window_low_hz", &value));
    assert_true(value == p.low_hz);
    DONE(plm_basis_get_double(pod, "window_high_hz", &value));
    assert_true(value == p.high_hz);
    DONE(plm_basis_get_double(pod, "setup_seconds", &setup));
    assert_true(setup >= 0);
    DONE(plm_basis_get_string(pod, "space_description", sizeof text, text, NULL));
    DONE(plm_basis_get_string(basis, "space_description", sizeof parent_text, parent_text, NULL));
    assert_string_equal(text, parent_text);
    DONE(plm_basis_get_string(pod, "warning", sizeof text, text, NULL));
    assert_string_equal(text, "");
    DONE(plm_basis_get_array(pod, "sample_matched_mac", 0, NULL, &count));
    assert_int_equal(count, 0);

    /* by the tolerance: the smaller, the more columns; and of itself as the parent again */
    DONE(plm_basis_set_int(pod, "pod_size", 0));
    DONE(plm_basis_set_double(pod, "pod_tolerance", 1e-2));
    DONE(plm_basis_build(pod));
    DONE(plm_basis_get_int(pod, "size", &r));
    DONE(plm_basis_set_double(pod, "pod_tolerance", 1e-6));
    DONE(plm_basis_build(pod));
    DONE(plm_basis_get_int(pod, "size", &count));
    assert_true(r >= 1 && r < count && count <= parent_size);
    scene_destroy(&p.host);
}

static void a_basis_for_a_tolerance(void **state) {
    plate p;
    plm_basis *refined = NULL;
    plm_hbm *hbm = NULL;
    peak_of truth, poor, good;
    double error = 1;
    char kind[16];
    (void)state;
    make_plate(&p, 1);
    truth = find_peak(&p, basis_of(&p, "full", "below", 2), 5);
    poor = find_peak(&p, basis_of(&p, "plm", "bands", 1), 5);
    DONE(
        plm_hbm_refine_basis(poor.hbm, p.host->output_dof, PLM_HALF_PEAK_TO_PEAK, 0, 1e-3, &refined, &error));
    good = find_peak(&p, refined, 5);
    print_message("error of the peak %.1e before, %.1e after, %.1e estimated\n",
                  fabs(poor.amplitude / truth.amplitude - 1), fabs(good.amplitude / truth.amplitude - 1),
                  error);
    assert_true(!close_to(poor.amplitude, truth.amplitude, 0.05));
    assert_true(close_to(good.amplitude, truth.amplitude, 1e-3) && close_to(good.hz, truth.hz, 1e-3));
    assert_true(error >= 0 && error < 1e-3);
    DONE(plm_basis_get_string(refined, "kind", sizeof kind, kind, NULL));
    assert_string_equal(kind, "pod");

    refined = (plm_basis *)(void *)&p;
    error = 7;
    hbm = poor.hbm;
#define REFINE(dof, measure, harmonic, tolerance)                                                            \
    plm_hbm_refine_basis(hbm, dof, measure, harmonic, tolerance, &refined, &error)
    assert_int_equal(plm_hbm_refine_basis(NULL, 0, PLM_PEAK, 0, 1e-3, &refined, &error), PLM_ERR_HANDLE);
    BAD(REFINE(-1, PLM_PEAK, 0, 1e-3), "plm_hbm_refine_basis", "dof", "dof is -1");
    BAD(REFINE(0, 77, 0, 1e-3), "plm_hbm_refine_basis", "measure", "77");
    BAD(REFINE(0, PLM_HARMONIC, 6, 1e-3), "plm_hbm_refine_basis", "harmonic", "6");
    BAD(REFINE(0, PLM_PEAK, 0, 0), "plm_hbm_refine_basis", "tolerance", "tolerance is 0");
    BAD(REFINE(0, PLM_PEAK, 0, 2), "plm_hbm_refine_basis", "tolerance", "tolerance is 2");
    BAD(REFINE(0, PLM_PEAK, 0, NAN), "plm_hbm_refine_basis", "tolerance", "NaN or infinite");
    BAD(plm_hbm_refine_basis(hbm, 0, PLM_PEAK, 0, 1e-3, NULL, &error), "plm_hbm_refine_basis", "refined",
        "NULL");
    assert_true(refined == (plm_basis *)(void *)&p && error == 7);
    scene_destroy(&p.host);
}

/* ---- refusals ---- */

static void what_estimate_error_refuses(void **state) {
    const char *f = "plm_hbm_estimate_error";
    const oscillator o = {1, 0.04, 3, 0, 1};
    plm_model *model = NULL;
    plm_basis *basis = NULL, *other_basis = NULL;
    plm_hbm *hbm = NULL, *other = NULL;
    plm_branch *curve = NULL, *foreign = NULL, *mode = NULL;
    double a[3] = {7, 7, 7}, hz[3] = {7, 7, 7};
    int64_t n = 0;
    int i;
    (void)state;
    DONE(carrier_built(ctx, 0.004, &model, &basis));
    DONE(oscillator_built(ctx, &o, 0.7, &model, &other_basis));
    DONE(plm_hbm_create(basis, &hbm));
    DONE(plm_hbm_create(other_basis, &other));
    DONE(plm_hbm_set_int(hbm, "n_harmonics", 5));
    DONE(plm_hbm_set_double(hbm, "force_scale", 0.02));
    DONE(plm_hbm_sweep(hbm, &curve));
    DONE(plm_hbm_solve(other, 0.3, NULL, 0, &foreign));
    DONE(plm_branch_get_int(curve, "n_points", &n));
#define ESTIMATE(branch, point, dof, measure, harmonic)                                                      \
    plm_hbm_estimate_error(hbm, branch, point, dof, measure, harmonic, a, hz)
    assert_int_equal(plm_hbm_estimate_error(NULL, curve, 0, 0, PLM_PEAK, 0, a, hz), PLM_ERR_HANDLE);
    DEAD(ESTIMATE(NULL, 0, 0, PLM_PEAK, 0), f, "branch");
    DEAD(ESTIMATE((plm_branch *)(void *)hbm, 0, 0, PLM_PEAK, 0), f, "branch");
    BAD(ESTIMATE(foreign, 0, 0, PLM_PEAK, 0), f, "branch", "another basis");
    BAD(ESTIMATE(curve, -1, 0, PLM_PEAK, 0), f, "point", "point is -1");
    BAD(ESTIMATE(curve, n, 0, PLM_PEAK, 0), f, "point", "must lie in 0..");
    BAD(ESTIMATE(curve, 0, -1, PLM_PEAK, 0), f, "dof", "dof is -1");
    BAD(ESTIMATE(curve, 0, 2, PLM_PEAK, 0), f, "dof", "dof is 2");
    BAD(ESTIMATE(curve, 0, 0, 77, 0), f, "measure", "77");
    BAD(ESTIMATE(curve, 0, 0, PLM_HARMONIC, 6), f, "harmonic", "6");
    BAD(ESTIMATE(curve, 0, 0, PLM_HARMONIC, -1), f, "harmonic", "-1");
    DONE(plm_hbm_find_nonlinear_mode(hbm, 1, 0, 1.0, &mode));
    REFUSED(ESTIMATE(mode, 3, 0, PLM_PEAK, 0), PLM_ERR_ARGUMENT, f, "point", 3, "without excitation");
    for (i = 0; i < 3; ++i) assert_true(a[i] == 7 && hz[i] == 7);
    DONE(ESTIMATE(curve, n / 2, 0, PLM_PEAK, 0));
    DONE(plm_basis_build(basis));
    BAD(ESTIMATE(curve, 0, 0, PLM_PEAK, 0), f, "branch", "built anew");
}

/* An oscillator free along its second DOF, which no pair holds: on its unreduced basis nothing is wrong.
 * Without the pair there is nothing to estimate in. */
static void a_structure_that_its_contacts_do_not_hold(void **state) {
    static const int64_t dof[] = {0, 1}, zero[] = {0}, ptr[] = {0, 1};
    static const double mass[] = {1, 1}, one[] = {1}, force[] = {1, 0};
    int with_pair;
    (void)state;
    for (with_pair = 0; with_pair < 2; ++with_pair) {
        plm_model *model = NULL;
        plm_basis *basis = NULL;
        plm_hbm *hbm = NULL;
        plm_branch *point = NULL;
        double a[3] = {7, 7, 7}, hz[3] = {7, 7, 7};
        DONE(plm_model_create(ctx, 2, &model));
        DONE(plm_model_set_matrix_i64(model, PLM_MASS, PLM_TRIPLETS, PLM_FULL, 0, PLM_COPY, 2, dof, dof,
                                      mass));
        DONE(plm_model_set_matrix_i64(model, PLM_STIFFNESS, PLM_TRIPLETS, PLM_FULL, 0, PLM_COPY, 1, zero,
                                      zero, one));
        DONE(plm_model_set_rayleigh_damping(model, 0.02, 0));
        if (with_pair) DONE(plm_model_add_gap_rows_i64(model, 0, 1, ptr, zero, one, one, NULL));
        DONE(plm_model_set_excitation(model, 1, 2, force, NULL));
        /* one mass of the two floats, as is meant here */
        assert_true(done_but_for(ctx, plm_model_build(model), PLM_REASON_MODEL));
        DONE(plm_basis_create(model, &basis));
        DONE(plm_basis_set_string(basis, "kind", "full"));
        DONE(plm_basis_set_double(basis, "frequency_min_hz", 0.1));
        DONE(plm_basis_set_double(basis, "frequency_max_hz", 0.3));
        DONE(plm_basis_build(basis));
        DONE(plm_hbm_create(basis, &hbm));
        DONE(plm_hbm_set_string(hbm, "unknowns", "modal"));
        DONE(plm_hbm_solve(hbm, 0.1, NULL, 0, &point));
        if (with_pair) {
            DONE(plm_hbm_estimate_error(hbm, point, 0, 0, PLM_PEAK, 0, a, hz));
            assert_true(fabs(a[0]) < 1e-9 && fabs(a[1]) < 1e-9 && fabs(hz[0]) < 1e-9);
        } else {
            REFUSED(plm_hbm_estimate_error(hbm, point, 0, 0, PLM_PEAK, 0, a, hz), PLM_ERR_STATE,
                    "plm_hbm_estimate_error", "", -1, "contact pairs");
            assert_true(a[0] == 7 && hz[2] == 7);
        }
    }
}

static void what_set_responses_refuses(void **state) {
    const char *f = "plm_basis_set_responses", *build = "plm_basis_build";
    const oscillator o = {1, 0.04, 3, 0, 1};
    plm_context *elsewhere = NULL;
    plm_model *model = NULL, *other_model = NULL;
    plm_basis *basis = NULL, *other_basis = NULL, *pod = NULL, *upper = NULL;
    plm_hbm *hbm = NULL, *other = NULL;
    plm_branch *curve = NULL, *foreign = NULL, *nothing = NULL, *far = NULL, *stale, *list[3];
    int64_t size = 0;
    (void)state;
    DONE(carrier_built(ctx, 0.004, &model, &basis));
    DONE(oscillator_built(ctx, &o, 0.7, &other_model, &other_basis));
    DONE(plm_hbm_create(basis, &hbm));
    DONE(plm_hbm_create(other_basis, &other));
    DONE(plm_hbm_set_int(hbm, "n_harmonics", 5));
    DONE(plm_hbm_set_double(hbm, "force_scale", 0));
    DONE(plm_hbm_solve(hbm, 0.2, NULL, 0, &nothing));
    DONE(plm_hbm_set_double(hbm, "force_scale", 0.02));
    DONE(plm_hbm_sweep(hbm, &curve));
    DONE(plm_hbm_solve(other, 0.3, NULL, 0, &foreign));
    DONE(plm_hbm_solve(hbm, 0.2, NULL, 0, &list[0]));
    stale = list[0];
    DONE(plm_branch_destroy(&list[0]));
    {
        plm_model *m = NULL;
        plm_basis *b = NULL;
        plm_hbm *h = NULL;
        assert_int_equal(plm_context_create(PLM_API_VERSION, &elsewhere), PLM_OK);
        assert_true(done(elsewhere, oscillator_built(elsewhere, &o, 0.7, &m, &b)));
        assert_true(done(elsewhere, plm_hbm_create(b, &h)));
        assert_true(done(elsewhere, plm_hbm_solve(h, 0.3, NULL, 0, &far)));
    }
    DONE(plm_basis_create(model, &pod));
    DONE(plm_basis_set_string(pod, "kind", "pod"));

    REFUSED(plm_basis_build(pod), PLM_ERR_STATE, build, "parent", -1, "set that as its parent");
    DONE(plm_basis_set_parent(pod, basis));
    REFUSED(plm_basis_build(pod), PLM_ERR_STATE, build, "responses", -1, "set those of its parent");

    list[0] = list[1] = list[2] = curve;
    assert_int_equal(plm_basis_set_responses(NULL, 1, list), PLM_ERR_HANDLE);
    BAD(plm_basis_set_responses(pod, -1, list), f, "n", "n is -1");
    BAD(plm_basis_set_responses(pod, 1, NULL), f, "branch", "NULL");
    DONE(plm_basis_set_responses(pod, 1, list)); /* these stay through all that follows */
    list[2] = NULL;
    REFUSED(plm_basis_set_responses(pod, 3, list), PLM_ERR_HANDLE, f, "branch", 2, "no live handle");
    list[2] = stale;
    REFUSED(plm_basis_set_responses(pod, 3, list), PLM_ERR_HANDLE, f, "branch", 2, "no live handle");
    list[2] = (plm_branch *)(void *)hbm;
    REFUSED(plm_basis_set_responses(pod, 3, list), PLM_ERR_HANDLE, f, "branch", 2, "no live handle");
    list[2] = far;
    REFUSED(plm_basis_set_responses(pod, 3, list), PLM_ERR_HANDLE, f, "branch", 2, "another context");
    list[2] = foreign;
    REFUSED(plm_basis_set_responses(pod, 3, list), PLM_ERR_ARGUMENT, f, "branch", 2, "on one basis");
    list[0] = NULL;
    REFUSED(plm_basis_set_responses(pod, 1, list), PLM_ERR_HANDLE, f, "branch", 0, "no live handle");
    DONE(plm_basis_build(pod));
    DONE(plm_basis_get_int(pod, "size", &size));
    assert_int_equal(size, 2);

    /* refused at the build, which leaves the last one as it is */
    DONE(plm_basis_set_responses(pod, 1, &foreign));
    BAD(plm_basis_build(pod), build, "responses", "another basis than the parent");
    DONE(plm_basis_set_responses(pod, 1, &nothing));
    REFUSED(plm_basis_build(pod), PLM_ERR_STATE, build, "responses", -1, "nothing moves");
    DONE(plm_basis_set_responses(pod, 0, NULL));
    REFUSED(plm_basis_build(pod), PLM_ERR_STATE, build, "responses", -1, "set those of its parent");
    DONE(plm_basis_set_responses(pod, 1, &curve));
    DONE(plm_basis_set_double(pod, "frequency_min_hz", 7));
    BAD(plm_basis_build(pod), build, "frequency_min_hz", "must be below");
    DONE(plm_basis_set_double(pod, "frequency_min_hz", 0));
    BAD(plm_basis_set_double(pod, "pod_tolerance", -0.1), "plm_basis_set_double", "value", "-0.1");
    BAD(plm_basis_set_double(pod, "pod_tolerance", 0.6), "plm_basis_set_double", "value", "0.6");
    BAD(plm_basis_set_int(pod, "pod_size", -1), "plm_basis_set_int", "value", "-1");
    DONE(plm_basis_get_int(pod, "size", &size));
    assert_int_equal(size, 2);
    DONE(plm_basis_build(pod));

    /* a pod is no parent of piecewise-linear modes, but one of another pod */
    {
        plm_sampler *sampler = NULL;
        DONE(plm_sampler_create(model, &sampler));
        DONE(plm_sampler_run(sampler));
        DONE(plm_basis_create(model, &upper));
        DONE(plm_basis_set_sampler(upper, sampler));
        DONE(plm_basis_set_parent(upper, pod));
        BAD(plm_basis_build(upper), build, "parent", "\"craig_bampton\" or \"full\"");
        BAD(plm_basis_set_parent(upper, other_basis), "plm_basis_set_parent", "parent", "another model");
    }
    DONE(plm_hbm_create(pod, &hbm));
    DONE(plm_hbm_set_double(hbm, "force_scale", 0.02));
    DONE(plm_hbm_solve(hbm, 0.2, NULL, 0, &list[1]));
    DONE(plm_basis_set_string(upper, "kind", "pod"));
    DONE(plm_basis_set_responses(upper, 1, &list[1]));
    DONE(plm_basis_build(upper));

    /* the parent as it was when it was set */
    DONE(plm_basis_build(basis));
    DONE(plm_basis_build(pod));
    DONE(plm_basis_set_parent(pod, basis));
    BAD(plm_basis_build(pod), build, "responses", "built anew");
    assert_int_equal(plm_context_destroy(&elsewhere), PLM_OK);
}

int main(void) {
#define TEST(f) cmocka_unit_test_setup_teardown(f, open_context, close_context)
    const struct CMUnitTest tests[] = {
        TEST(the_error_of_the_basis),      TEST(the_error_of_the_harmonics),
        TEST(a_basis_of_responses),        TEST(a_basis_for_a_tolerance),
        TEST(what_estimate_error_refuses), TEST(a_structure_that_its_contacts_do_not_hold),
        TEST(what_set_responses_refuses),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
