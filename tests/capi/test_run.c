/* From model to branch: every function on a small structure, checked against what must hold. */
#include "chain.h"
#include "check.h"

enum { H = 9, PAIRS = 2, WATCHED = 12 /* node 4, x */ };

static plm_context *ctx;
static plm_model *model;
static plm_sampler *sampler;
static plm_basis *basis, *full;
static plm_hbm *hbm;
static plm_branch *curve;
static double low_hz, high_hz;

static int run(int with_preload) {
    plm_status s;
    if (plm_context_create(PLM_API_VERSION, &ctx)) return 1;
    s = chain_built(ctx, with_preload, &model);
    if (!s) s = plm_sampler_create(model, &sampler);
    if (!s) s = plm_sampler_set_string(sampler, "system", "open");
    if (!s) s = plm_sampler_set_int(sampler, "mode", 1);
    if (!s) s = plm_sampler_run(sampler);
    if (!s) s = plm_basis_create(model, &full);
    if (!s) s = plm_basis_set_string(full, "kind", "full");
    if (!s) s = plm_basis_set_sampler(full, sampler);
    if (!s) s = plm_basis_build(full);
    if (!s) s = plm_basis_create(model, &basis);
    if (!s) s = plm_basis_set_sampler(basis, sampler);
    if (!s) s = plm_basis_set_parent(basis, full);
    if (!s) s = plm_basis_build(basis);
    if (!s) s = plm_hbm_create(basis, &hbm);
    if (!s) s = plm_hbm_set_int(hbm, "n_harmonics", H);
    if (!s) s = plm_hbm_sweep(hbm, &curve);
    plm_sampler_get_double(sampler, "window_low_hz", &low_hz);
    plm_sampler_get_double(sampler, "window_high_hz", &high_hz);
    return !done(ctx, s);
}
static int set_up(void **state) {
    (void)state;
    return run(0);
}
static int set_up_preloaded(void **state) {
    (void)state;
    return run(1);
}
static int tear_down(void **state) {
    (void)state;
    return plm_context_destroy(&ctx);
}

static double exact_hz(int k) { /* clamped-free chain of 8 masses 1 on springs 1e4 */
    const double pi = 3.14159265358979323846;
    return 2 * 100 * sin((2 * k - 1) * pi / (2 * (2 * CHAIN_NODES + 1))) / (2 * pi);
}

static void modes_of_every_system(void **state) {
    const int32_t none[PAIRS] = {0, 0}, all[PAIRS] = {1, 1};
    double open[4], given[4], sliding[4], closed[4], rest[4], shape[4 * CHAIN_DOFS];
    double mass = 0;
    int j;
    (void)state;
    assert_true(done(ctx, plm_model_get_modes(model, PLM_SYSTEM_OPEN, NULL, 4, open, shape)));
    assert_true(done(ctx, plm_model_get_modes(model, PLM_SYSTEM_GIVEN, none, 4, given, NULL)));
    assert_true(done(ctx, plm_model_get_modes(model, PLM_SYSTEM_SLIDING, NULL, 4, sliding, NULL)));
    assert_true(done(ctx, plm_model_get_modes(model, PLM_SYSTEM_GIVEN, all, 4, closed, NULL)));
    assert_true(done(ctx, plm_model_get_modes(model, PLM_SYSTEM_REST, NULL, 4, rest, NULL)));
    for (j = 0; j < 4; ++j) {
        assert_true(close_to(open[j], exact_hz(j + 1), 1e-10));
        assert_true(close_to(given[j], open[j], 1e-12));
        assert_true(close_to(closed[j], sliding[j], 1e-7));
        assert_true(close_to(rest[j], open[j], 1e-7)); /* no pre-load: nothing is closed */
        assert_true(sliding[j] > open[j]);
    }
    for (j = 0; j < CHAIN_DOFS; ++j) mass += shape[j] * shape[j];
    assert_true(close_to(mass, 1, 1e-10));
}

static void model_results(void **state) {
    int64_t n = 0, count = 0, k, severe = 0;
    double local = 0, stiffness[PAIRS], gap[PAIRS], value, shift = 1;
    char text[300];
    int32_t severity;
    (void)state;
    assert_int_equal(plm_model_get_int(model, "n_free", &n), PLM_OK);
    assert_int_equal(n, CHAIN_DOFS);
    assert_int_equal(plm_model_get_int(model, "n_rigid_modes", &n), PLM_OK);
    assert_int_equal(n, 0);
    assert_int_equal(plm_model_get_double(model, "shift", &shift), PLM_OK);
    assert_true(shift == 0);
    assert_int_equal(plm_model_get_double(model, "local_stiffness", &local), PLM_OK);
    assert_int_equal(plm_model_get_array(model, "contact_stiffness", 0, NULL, &n), PLM_OK);
    assert_int_equal(n, PAIRS);
    assert_int_equal(plm_model_get_array(model, "contact_stiffness", PAIRS, stiffness, &n), PLM_OK);
    assert_true(close_to(stiffness[0], 10 * local, 1e-12) && stiffness[1] == 2e4);
    /* flexibilities in closed form: three springs between nodes 2 and 5, eight to the end */
    assert_true(close_to(local, 1 / ((3e-4 + 8e-4) / 2), 1e-10));
    assert_int_equal(plm_model_get_array(model, "initial_gap", PAIRS, gap, &n), PLM_OK);
    assert_true(gap[0] == 0 && gap[1] == 0);
    assert_int_equal(plm_model_audit(model, &count), PLM_OK);
    assert_true(count > 5);
    for (k = 0; k < count; ++k) {
        assert_int_equal(plm_model_get_finding(model, k, &severity, &value, 300, text, NULL), PLM_OK);
        severe += severity == 2;
        assert_true(strlen(text) > 10);
    }
    assert_int_equal(severe, 0);
    assert_true(refused(ctx, plm_model_get_finding(model, count, &severity, &value, 300, text, NULL),
                        PLM_ERR_ARGUMENT, "plm_model_get_finding", "index", -1, "must lie in"));
}

static void rest_state(void **state) {
    double q[CHAIN_DOFS], force[PAIRS], u[PAIRS], k[PAIRS];
    int64_t n, closed[PAIRS], n_closed = -1;
    int j;
    (void)state;
    assert_true(done(ctx, plm_model_solve_rest(model)));
    assert_int_equal(plm_model_get_array(model, "rest_displacement", CHAIN_DOFS, q, &n), PLM_OK);
    assert_int_equal(n, CHAIN_DOFS);
    assert_int_equal(plm_model_get_array(model, "rest_force", PAIRS, force, &n), PLM_OK);
    assert_int_equal(plm_model_get_array(model, "rest_penetration", PAIRS, u, &n), PLM_OK);
    assert_int_equal(plm_model_get_array(model, "contact_stiffness", PAIRS, k, &n), PLM_OK);
    assert_int_equal(plm_model_get_int_array(model, "rest_closed", PAIRS, closed, &n), PLM_OK);
    assert_int_equal(plm_model_get_int(model, "rest_n_closed", &n_closed), PLM_OK);
    /* 5 pushes the end into the ground spring 2e4 beside the chain of 8 springs 1e4; the nodes 2 and 5 part
     */
    assert_true(close_to(q[21], 5 / (2e4 + 1e4 / 8), 1e-9));
    for (j = 0; j < PAIRS; ++j) assert_true(force[j] == (u[j] > 0 ? k[j] * u[j] : 0));
    assert_true(closed[0] == 0 && closed[1] == 1 && n_closed == 1);
    assert_true(close_to(u[0], q[6] - q[15], 1e-9));
}

static int read_string(const char *key) {
    char text[400] = "";
    return plm_sampler_get_string(sampler, key, 400, text, NULL) == 0 && text[0] != 0;
}

static void sampler_results(void **state) {
    int64_t n = 0, n_sweep = 0, n_selected = 0, ints[64], k;
    double f = 0, x[64];
    (void)state;
    assert_int_equal(plm_sampler_get_double(sampler, "dominant_frequency_hz", &f), PLM_OK);
    assert_true(close_to(f, exact_hz(1), 1e-8));
    assert_int_equal(plm_sampler_get_int(sampler, "n_sweep_samples", &n_sweep), PLM_OK);
    assert_int_equal(plm_sampler_get_int(sampler, "n_selected", &n_selected), PLM_OK);
    assert_true(n_sweep >= 2 && n_sweep <= PAIRS + 1 && n_selected >= 1);
    assert_int_equal(plm_sampler_get_int_array(sampler, "sweep_samples", 64, ints, &n), PLM_OK);
    assert_int_equal(n, PAIRS * n_sweep);
    for (k = 0; k < n; ++k) assert_true(ints[k] == 0 || ints[k] == 1);
    assert_int_equal(plm_sampler_get_int_array(sampler, "selected_samples", 64, ints, &n), PLM_OK);
    assert_int_equal(n, PAIRS * n_selected);
    assert_int_equal(plm_sampler_get_array(sampler, "sweep_alpha", 64, x, &n), PLM_OK);
    assert_int_equal(n, n_sweep);
    assert_int_equal(plm_sampler_get_array(sampler, "mode_penetration", 64, x, &n), PLM_OK);
    assert_int_equal(n, PAIRS);
    assert_true(low_hz > 0 && high_hz > low_hz);
    assert_int_equal(plm_sampler_get_double(sampler, "blf_hz", &f), PLM_OK);
    assert_true(f > exact_hz(1));
    assert_true(read_string("window_why") && read_string("dominant_system") &&
                read_string("space_description"));
    assert_int_equal(plm_sampler_set_int(sampler, "n_samples", 2), PLM_OK); /* results stay readable */
    assert_int_equal(plm_sampler_get_int(sampler, "n_selected", &n), PLM_OK);
    assert_int_equal(n, n_selected);
    assert_int_equal(plm_sampler_add_dominant_mode(sampler, PLM_SYSTEM_SLIDING, 1), PLM_OK);
    assert_true(done(ctx, plm_sampler_run(sampler)));
    assert_int_equal(plm_sampler_get_int(sampler, "n_dominant", &n), PLM_OK);
    assert_int_equal(n, 2);
}

/* every result of every kind is readable after the run */
static int readable(int32_t kind, int32_t index) {
    char name[64], text[400];
    int32_t type = 0, is_option = 0;
    double low, high, d;
    int64_t i, n;
    plm_status s = PLM_ERR_INTERNAL;
    void *h = kind == PLM_KIND_MODEL     ? (void *)model
              : kind == PLM_KIND_SAMPLER ? (void *)sampler
              : kind == PLM_KIND_BASIS   ? (void *)basis
              : kind == PLM_KIND_HBM     ? (void *)hbm
                                         : (void *)curve;
    plm_key_info(kind, index, &type, &is_option, &low, &high);
    plm_key_text(kind, index, PLM_KEY_NAME, 64, name, NULL);
#define READ(noun)                                                                                           \
    (type == PLM_TYPE_INT      ? plm_##noun##_get_int((plm_##noun *)h, name, &i)                             \
     : type == PLM_TYPE_DOUBLE ? plm_##noun##_get_double((plm_##noun *)h, name, &d)                          \
     : type == PLM_TYPE_STRING ? plm_##noun##_get_string((plm_##noun *)h, name, 400, text, NULL)             \
     : type == PLM_TYPE_ARRAY  ? plm_##noun##_get_array((plm_##noun *)h, name, 0, NULL, &n)                  \
                               : plm_##noun##_get_int_array((plm_##noun *)h, name, 0, NULL, &n))
    if (kind == PLM_KIND_MODEL) s = READ(model);
    if (kind == PLM_KIND_SAMPLER) s = READ(sampler);
    if (kind == PLM_KIND_BASIS) s = READ(basis);
    if (kind == PLM_KIND_BRANCH) s = READ(branch);
    if (kind == PLM_KIND_HBM) s = PLM_OK; /* options only */
#undef READ
    if (s) printf("    kind %d, %s: status %d\n", (int)kind, name, (int)s);
    return s == PLM_OK;
}

static void every_result_is_readable(void **state) {
    int32_t kind, index, n;
    int ok = 1;
    (void)state;
    assert_true(done(ctx, plm_model_solve_rest(model)));
    for (kind = PLM_KIND_MODEL; kind <= PLM_KIND_BRANCH; ++kind) {
        plm_key_count(kind, &n);
        for (index = 0; index < n; ++index) ok &= readable(kind, index);
    }
    assert_true(ok);
}

static void basis_vectors_reproduce_the_mode(void **state) {
    plm_basis *child = NULL;
    int64_t r = 0, k;
    double frequencies[CHAIN_DOFS], v[64 * CHAIN_DOFS], shape[CHAIN_DOFS], hz, residual = 1,
                                                                               mass_residual = 1, mass = 0;
    (void)state;
    assert_int_equal(plm_basis_get_int(basis, "size", &r), PLM_OK);
    assert_true(r > 0 && r <= CHAIN_DOFS);
    assert_int_equal(plm_basis_get_array(basis, "frequencies_hz", CHAIN_DOFS, frequencies, &k), PLM_OK);
    assert_true(k == r && frequencies[0] > 0);
    assert_int_equal(plm_basis_get_vectors(basis, 0, 0, r, v, CHAIN_DOFS), PLM_OK);
    for (k = 0; k < CHAIN_DOFS; ++k) mass += v[k] * v[k];
    assert_true(close_to(mass, 1, 1e-8));
    assert_int_equal(plm_basis_get_vectors(basis, 1, 0, 1, v, CHAIN_DOFS), PLM_OK);
    assert_true(done(ctx, plm_model_get_modes(model, PLM_SYSTEM_OPEN, NULL, 1, &hz, shape)));
    assert_int_equal(plm_basis_get_residual(full, 0, 0, CHAIN_DOFS, shape, &residual), PLM_OK);
    assert_int_equal(plm_basis_get_residual(full, 0, 1, CHAIN_DOFS, shape, &mass_residual), PLM_OK);
    assert_true(residual < 1e-6 && mass_residual < 1e-6);
#define BAD(call, function, argument, words)                                                                 \
    assert_true(refused(ctx, call, PLM_ERR_ARGUMENT, function, argument, -1, words))
    BAD(plm_basis_get_vectors(basis, 2, 0, 1, v, CHAIN_DOFS), "plm_basis_get_vectors", "is_static", "0..1");
    BAD(plm_basis_get_vectors(basis, 0, r + 1, 1, v, CHAIN_DOFS), "plm_basis_get_vectors", "first", "first");
    BAD(plm_basis_get_vectors(basis, 0, 0, r + 1, v, CHAIN_DOFS), "plm_basis_get_vectors", "n", "n is");
    BAD(plm_basis_get_vectors(basis, 0, 0, 1, v, CHAIN_DOFS - 1), "plm_basis_get_vectors", "ld", "ld is 23");
    BAD(plm_basis_get_residual(basis, 0, 0, 3, shape, &residual), "plm_basis_get_residual", "n", "n is 3");
    BAD(plm_basis_get_residual(basis, 0, 3, CHAIN_DOFS, shape, &residual), "plm_basis_get_residual",
        "use_mass", "0..1");
    assert_int_equal(plm_basis_create(model, &child), PLM_OK);
    assert_int_equal(plm_basis_set_sampler(child, sampler), PLM_OK);
    assert_int_equal(plm_basis_set_parent(child, basis), PLM_OK);
    BAD(plm_basis_build(child), "plm_basis_build", "parent", "\"craig_bampton\" or \"full\"");
    assert_int_equal(plm_basis_set_parent(basis, NULL), PLM_OK);
    assert_true(done(ctx, plm_basis_build(basis)));
}

static void branch_results_agree(void **state) {
    int64_t n = 0, count = 0, k, best = 0, reason = 0, iterations[2000];
    double seconds = 0;
    double hz[2000], peak[2000], half[2000], rms[2000], first[2000], c[2 * H + 1], q[CHAIN_DOFS],
        share[PAIRS];
    double u[PAIRS * 64], force[PAIRS * 64], sum = 0, at_zero = 0, residual = 1;
    int32_t closed[PAIRS * 64];
    char why[100];
    (void)state;
    assert_int_equal(plm_branch_get_int(curve, "n_points", &n), PLM_OK);
    assert_int_equal(plm_branch_get_array(curve, "frequency_hz", 2000, hz, &count), PLM_OK);
    assert_true(n > 5 && count == n);
    assert_int_equal(plm_branch_get_int_array(curve, "iterations", 2000, iterations, &count), PLM_OK);
    assert_true(count == n && iterations[n - 1] >= 1);
    assert_int_equal(plm_branch_get_double(curve, "seconds", &seconds), PLM_OK);
    assert_true(seconds > 0);
    assert_int_equal(plm_branch_get_int(curve, "end_reason", &reason), PLM_OK);
    assert_int_equal(reason, PLM_REASON_RANGE_END);
    assert_int_equal(plm_branch_get_string(curve, "end_text", 100, why, NULL), PLM_OK);
    assert_string_equal(why, "reached the end of its range");
    assert_int_equal(plm_branch_get_amplitude(curve, WATCHED, PLM_PEAK, 0, 2000, peak, &count), PLM_OK);
    assert_int_equal(count, n);
    assert_int_equal(plm_branch_get_amplitude(curve, WATCHED, PLM_HALF_PEAK_TO_PEAK, 0, 2000, half, &count),
                     PLM_OK);
    assert_int_equal(plm_branch_get_amplitude(curve, WATCHED, PLM_RMS, 0, 2000, rms, &count), PLM_OK);
    assert_int_equal(plm_branch_get_amplitude(curve, WATCHED, PLM_HARMONIC, 1, 2000, first, &count), PLM_OK);
    for (k = 0; k < n; ++k) {
        assert_true(half[k] <= peak[k] * (1 + 1e-9) && rms[k] <= peak[k] * (1 + 1e-9));
        if (peak[k] > peak[best]) best = k;
    }
    assert_int_equal(plm_branch_get_coefficients(curve, best, WATCHED, 1, c), PLM_OK);
    assert_true(close_to(hypot(c[1], c[2]), first[best], 1e-10));
    assert_int_equal(plm_branch_get_field(curve, best, 0.0, CHAIN_DOFS, q), PLM_OK);
    for (k = 0, at_zero = c[0]; k < H; ++k) at_zero += c[2 * k + 1];
    assert_true(close_to(q[WATCHED], at_zero, 1e-8));
    assert_int_equal(plm_branch_get_contact(curve, best, 64, u, force, closed), PLM_OK);
    assert_int_equal(plm_branch_get_contact(curve, best, 64, NULL, NULL, closed), PLM_OK);
    for (k = 0; k < PAIRS * 64; ++k) {
        assert_true(closed[k] == (u[k] > 0) && force[k] >= 0);
        sum += closed[k];
    }
    assert_true(close_to(u[0], q[6] - q[15], 1e-8) && close_to(u[1], q[21], 1e-8));
    assert_int_equal(plm_branch_get_closed_share(curve, best, PAIRS, share), PLM_OK);
    assert_true(fabs((share[0] + share[1]) * 64 - sum) <= 4);
    assert_true(done(ctx, plm_branch_get_full_residual(curve, best, &residual)));
    assert_true(residual >= 0 && residual < 0.2);
}

static void branch_arguments_are_checked(void **state) {
    double x[64] = {7};
    int64_t n = 7;
    (void)state;
    BAD(plm_branch_get_amplitude(curve, -1, PLM_PEAK, 0, 64, x, &n), "plm_branch_get_amplitude", "dof",
        "dof is -1");
    BAD(plm_branch_get_amplitude(curve, 0, 5, 0, 64, x, &n), "plm_branch_get_amplitude", "measure", "1..4");
    BAD(plm_branch_get_amplitude(curve, 0, PLM_HARMONIC, H + 1, 64, x, &n), "plm_branch_get_amplitude",
        "harmonic", "0..9");
    BAD(plm_branch_get_amplitude(curve, 0, PLM_PEAK, 0, 1, x, &n), "plm_branch_get_amplitude", "capacity",
        "length");
    BAD(plm_branch_get_coefficients(curve, 100000, 0, 1, x), "plm_branch_get_coefficients", "point", "point");
    BAD(plm_branch_get_coefficients(curve, 0, CHAIN_DOFS, 1, x), "plm_branch_get_coefficients", "first_dof",
        "0..23");
    BAD(plm_branch_get_coefficients(curve, 0, 1, CHAIN_DOFS, x), "plm_branch_get_coefficients", "n", "1..23");
    BAD(plm_branch_get_history(curve, 0, CHAIN_DOFS, 8, x), "plm_branch_get_history", "dof", "0..23");
    BAD(plm_branch_get_history(curve, 0, 0, 0, x), "plm_branch_get_history", "n_times", "n_times is 0");
    BAD(plm_branch_get_history(curve, 0, 0, 8, NULL), "plm_branch_get_history", "q", "NULL");
    BAD(plm_branch_get_history(curve, 100000, 0, 8, x), "plm_branch_get_history", "point", "point");
    BAD(plm_branch_get_field(curve, 0, NAN, CHAIN_DOFS, x), "plm_branch_get_field", "time_fraction", "NaN");
    BAD(plm_branch_get_field(curve, 0, 0, 3, x), "plm_branch_get_field", "n", "n is 3");
    BAD(plm_branch_get_contact(curve, 0, 0, x, NULL, NULL), "plm_branch_get_contact", "n_times",
        "n_times is 0");
    BAD(plm_branch_get_closed_share(curve, 0, 3, x), "plm_branch_get_closed_share", "n", "n is 3");
    BAD(plm_branch_get_full_residual(curve, -1, x), "plm_branch_get_full_residual", "point", "point is -1");
    BAD(plm_branch_get_full_residual(curve, 0, NULL), "plm_branch_get_full_residual", "relative_residual",
        "NULL");
    assert_true(x[0] == 7 && n == 7);
}

static void single_solutions_lie_on_the_curve(void **state) {
    plm_branch *cold = NULL, *warm = NULL, *peak = NULL;
    double hz = 0.5 * (low_hz + high_hz), one = 0, two = 0, peak_hz = 0, peak_value = 0, on_curve[2000],
           again = 0;
    int64_t n = 0, k;
    (void)state;
    assert_true(done(ctx, plm_hbm_solve(hbm, hz, NULL, 0, &cold)));
    assert_true(done(ctx, plm_hbm_solve(hbm, hz, cold, 0, &warm)));
    assert_int_equal(plm_branch_get_amplitude(cold, WATCHED, PLM_PEAK, 0, 1, &one, &n), PLM_OK);
    assert_int_equal(plm_branch_get_amplitude(warm, WATCHED, PLM_PEAK, 0, 1, &two, &n), PLM_OK);
    assert_true(close_to(two, one, 1e-6));
    assert_true(done(ctx, plm_hbm_find_peak(hbm, curve, WATCHED, PLM_PEAK, 0, &peak_hz, &peak_value, &peak)));
    assert_true(peak_hz >= low_hz * 0.99 && peak_hz <= high_hz * 1.01);
    assert_int_equal(plm_branch_get_amplitude(curve, WATCHED, PLM_PEAK, 0, 2000, on_curve, &n), PLM_OK);
    for (k = 0; k < n; ++k) assert_true(on_curve[k] <= peak_value * (1 + 1e-6));
    assert_int_equal(plm_branch_get_amplitude(peak, WATCHED, PLM_PEAK, 0, 1, &again, &n), PLM_OK);
    assert_true(close_to(again, peak_value, 1e-6));
    assert_true(done(ctx, plm_hbm_find_peak(hbm, curve, WATCHED, PLM_PEAK, 0, &peak_hz, &peak_value, NULL)));
    BAD(plm_hbm_find_peak(hbm, curve, CHAIN_DOFS, PLM_PEAK, 0, &hz, &hz, NULL), "plm_hbm_find_peak", "dof",
        "0..23");
    BAD(plm_hbm_solve(hbm, hz, curve, 100000, &warm), "plm_hbm_solve", "point", "point is 100000");
    BAD(plm_hbm_solve(hbm, hz, curve, -1, &warm), "plm_hbm_solve", "point", "point is -1");
    assert_true(done(ctx, plm_basis_build(basis))); /* a new basis: the old branch speaks another language */
    BAD(plm_hbm_find_peak(hbm, curve, 0, PLM_PEAK, 0, &hz, &hz, NULL), "plm_hbm_find_peak", "branch",
        "another basis");
    assert_int_equal(plm_branch_destroy(&cold), PLM_OK);
    assert_null(cold);
}

/* a start may have any number of harmonics: it is padded with zeros, or cut */
static void starts_with_other_harmonics_lead_to_the_same_solution(void **state) {
    static const int64_t harmonics[] = {3, 5, H};
    plm_branch *cold[3] = {NULL, NULL, NULL}, *warm = NULL;
    double hz = 0.5 * (low_hz + high_hz), want[19], got[19], least = 1e300;
    int64_t n = 0;
    int i, j, k;
    (void)state;
    for (i = 0; i < 3; ++i) {
        assert_int_equal(plm_hbm_set_int(hbm, "n_harmonics", harmonics[i]), PLM_OK);
        assert_true(done(ctx, plm_hbm_solve(hbm, hz, NULL, 0, &cold[i])));
    }
    for (i = 0; i < 3; ++i) {
        assert_int_equal(plm_hbm_set_int(hbm, "n_harmonics", harmonics[i]), PLM_OK);
        assert_int_equal(plm_branch_get_coefficients(cold[i], 0, WATCHED, 1, want), PLM_OK);
        for (j = 0; j < 3; ++j) {
            assert_true(done(ctx, plm_hbm_solve(hbm, hz, cold[j], 0, &warm)));
            assert_int_equal(plm_branch_get_int(warm, "n_harmonics", &n), PLM_OK);
            assert_int_equal(n, harmonics[i]);
            assert_int_equal(plm_branch_get_coefficients(warm, 0, WATCHED, 1, got), PLM_OK);
            for (k = 0; k < 2 * harmonics[i] + 1; ++k)
                assert_true(fabs(got[k] - want[k]) <= 1e-6 * hypot(want[1], want[2]));
            BAD(plm_hbm_solve(hbm, hz, cold[j], 1, &warm), "plm_hbm_solve", "point", "point is 1");
        }
        if (i > 0) { /* the solutions of 3, 5 and 9 harmonics differ: the last start did not just stay */
            double apart = 0;
            assert_int_equal(plm_branch_get_coefficients(cold[i - 1], 0, WATCHED, 1, got), PLM_OK);
            for (k = 0; k < 7; ++k) apart = larger(apart, fabs(got[k] - want[k]));
            least = fmin(least, apart / hypot(want[1], want[2]));
        }
    }
    printf("    solutions of 3, 5 and 9 harmonics are at least %.1e apart\n", least);
    assert_true(least > 1e-5);
}

static void few_points_truncate(void **state) {
    plm_branch *short_one = NULL;
    int64_t n = 0, reason = 0;
    int32_t why = 0;
    (void)state;
    assert_int_equal(plm_hbm_set_int(hbm, "max_points", 3), PLM_OK);
    assert_int_equal(plm_hbm_sweep(hbm, &short_one), PLM_TRUNCATED);
    assert_true(
        refused(ctx, PLM_TRUNCATED, PLM_TRUNCATED, "plm_hbm_sweep", "", -1, "max_points reached; raise it"));
    assert_int_equal(plm_context_get_error_info(ctx, NULL, &why, NULL, NULL), PLM_OK);
    assert_int_equal(why, PLM_REASON_POINT_LIMIT);
    assert_int_equal(plm_branch_get_int(short_one, "n_points", &n), PLM_OK);
    assert_int_equal(plm_branch_get_int(short_one, "end_reason", &reason), PLM_OK);
    assert_true(n == 3 && reason == PLM_REASON_POINT_LIMIT);
}

static void children_outlive_their_parents(void **state) {
    double peak[2000], again[2000], residual = 0;
    int64_t n = 0, m = 0;
    (void)state;
    assert_int_equal(plm_branch_get_amplitude(curve, WATCHED, PLM_PEAK, 0, 2000, peak, &n), PLM_OK);
    plm_model_destroy(&model);
    plm_sampler_destroy(&sampler);
    plm_basis_destroy(&basis);
    plm_basis_destroy(&full);
    plm_hbm_destroy(&hbm);
    assert_int_equal(plm_branch_get_amplitude(curve, WATCHED, PLM_PEAK, 0, 2000, again, &m), PLM_OK);
    assert_true(n == m);
    assert_memory_equal(peak, again, (size_t)n * sizeof *peak);
    assert_true(done(ctx, plm_branch_get_full_residual(curve, 0, &residual)));
}

/* An iteration is a part of the run: all of them take less than the whole, and a fair share of it. */
static void an_iteration_takes_its_share_of_the_run(void **state) {
    double seconds = 0, each = 0;
    int64_t iterations = 0;
    (void)state;
    assert_int_equal(plm_branch_get_double(curve, "seconds", &seconds), PLM_OK);
    assert_int_equal(plm_branch_get_double(curve, "seconds_per_iteration", &each), PLM_OK);
    assert_int_equal(plm_branch_get_int(curve, "newton_iterations", &iterations), PLM_OK);
    assert_true(each > 0 && (double)iterations * each < seconds);
}

/* The sampler has solved for rest; the model knows it without another call. */
static void rest_is_known_after_the_sampler(void **state) {
    plm_context *own = NULL;
    plm_model *m = NULL;
    plm_sampler *s = NULL;
    int64_t before = -1, after = -1;
    (void)state;
    assert_int_equal(plm_context_create(PLM_API_VERSION, &own), PLM_OK);
    assert_true(done(own, chain_built(own, 1, &m)));
    assert_int_equal(plm_model_get_int(m, "rest_n_closed", &before), PLM_ERR_STATE);
    assert_int_equal(plm_sampler_create(m, &s), PLM_OK);
    assert_true(done(own, plm_sampler_run(s)));
    assert_int_equal(plm_model_get_int(m, "rest_n_closed", &before), PLM_OK);
    plm_context_destroy(&own);
    assert_int_equal(plm_context_create(PLM_API_VERSION, &own), PLM_OK);
    assert_true(done(own, chain_built(own, 1, &m)));
    assert_true(done(own, plm_model_solve_rest(m)));
    assert_int_equal(plm_model_get_int(m, "rest_n_closed", &after), PLM_OK);
    assert_int_equal(before, after);
    plm_context_destroy(&own);
}

int main(void) {
#define TEST(f) cmocka_unit_test_setup_teardown(f, set_up, tear_down)
    const struct CMUnitTest tests[] = {
        TEST(an_iteration_takes_its_share_of_the_run),
        TEST(rest_is_known_after_the_sampler),
        TEST(modes_of_every_system),
        TEST(model_results),
        cmocka_unit_test_setup_teardown(rest_state, set_up_preloaded, tear_down),
        TEST(sampler_results),
        TEST(every_result_is_readable),
        TEST(basis_vectors_reproduce_the_mode),
        TEST(branch_results_agree),
        TEST(branch_arguments_are_checked),
        TEST(single_solutions_lie_on_the_curve),
        TEST(starts_with_other_harmonics_lead_to_the_same_solution),
        TEST(few_points_truncate),
        TEST(children_outlive_their_parents),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
