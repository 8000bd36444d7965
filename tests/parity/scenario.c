/* scenario.c: the scene that every language runs. All of them print the same lines, to the last digit:
 *
 *     name                        a heading: the numbers that follow belong to it
 *     %.17g                       one number per line (integers without a point)
 *
 * The scene: ten masses of 1 kg in a chain, the first one fixed; springs of 1e4 N/m; two pairs (masses 3 and
 * 6; mass 9 against a stop 1 mm away), a static pre-load, a harmonic force, and the
 * support of the first mass moves. Every input is a short decimal,
 * so that all languages hold the same doubles. Nothing printed depends on time. */
#include <plm/plm.h>
#include <stdio.h>
#include <stdlib.h>

enum { N = 10, H = 5, PAIRS = 2, TIMES = 8, WATCHED = 7 };

static plm_context *ctx;

static void must(plm_status status) {
    char text[512] = "";
    if (status >= 0) return;
    plm_context_get_error_text(ctx, sizeof text, text, NULL);
    fprintf(stderr, "%s\n", text);
    exit(1);
}

static void heading(const char *name) {
    printf("%s\n", name);
}
static void real(double x) {
    printf("%.17g\n", x);
}
static void whole(int64_t i) {
    printf("%lld\n", (long long)i);
}
static void reals(const char *name, int64_t n, const double *x) {
    heading(name);
    for (int64_t i = 0; i < n; i++) real(x[i]);
}

static int64_t relative; /* output */

static plm_model *make_model(void) {
    int32_t diagonal[N], row[2 * N - 1], column[2 * N - 1];
    double mass[N], stiffness[2 * N - 1], force[N] = {0}, preload[N] = {0}, grows[N] = {0},
                                          grows_later[N] = {0}, base[N] = {1e-4}, base_later[N] = {5e-5};
    /* pair 0: u = q_2 - q_5, pair 1: u = q_8 - 0.001 */
    const int32_t row_start[] = {0, 2, 3}, dof[] = {2, 5, 8};
    const double coefficient[] = {1, -1, 1}, contact_stiffness[] = {PLM_AUTO_STIFFNESS, 20000},
                 gap[] = {0, 0.001}, shaken[] = {0, 2e-5}, later[] = {0, 1e-5};
    /* q_6 = (q_5 + q_7) / 2 */
    const int32_t middle_row[] = {0, 3}, middle_dof[] = {6, 5, 7};
    const double middle[] = {1, -0.5, -0.5};
    int32_t k = 0;
    plm_model *model = NULL;
    for (int32_t i = 0; i < N; i++) {
        diagonal[i] = i, mass[i] = 1;
        row[k] = i, column[k] = i, stiffness[k++] = i < N - 1 ? 20000 : 10000;
        if (i > 0) row[k] = i, column[k] = i - 1, stiffness[k++] = -10000; /* lower triangle */
    }
    force[4] = 10;
    preload[8] = 5;
    grows[8] = 4e-4, grows_later[7] = 2e-4; /* an unbalance */
    must(plm_model_create(ctx, N, &model));
    must(plm_model_set_matrix_i32(model, PLM_MASS, PLM_TRIPLETS, PLM_LOWER, 0, PLM_COPY, N, diagonal,
                                  diagonal, mass));
    must(plm_model_set_matrix_i32(model, PLM_STIFFNESS, PLM_TRIPLETS, PLM_LOWER, 0, PLM_COPY, k, row, column,
                                  stiffness));
    must(plm_model_set_rayleigh_damping(model, 0.5, 0.0002));
    must(plm_model_fix_dofs_i32(model, 0, 1, diagonal));
    must(plm_model_add_constraints_i32(model, 0, 1, middle_row, middle_dof, middle));
    must(plm_model_add_gap_rows_i32(model, 0, PAIRS, row_start, dof, coefficient, contact_stiffness, gap));
    must(plm_model_set_preload(model, N, preload));
    must(plm_model_set_excitation(model, 1, N, force, NULL));
    must(plm_model_set_growing_excitation(model, 1, 2, N, grows, grows_later));
    must(plm_model_set_gap_motion(model, 2, PAIRS, shaken, later));
    must(plm_model_set_base_motion(model, PLM_DISPLACEMENT, 1, N, base, base_later));
    must(plm_model_build(model));
    /* the motion of pair 0, as DOF N */
    must(plm_model_add_outputs_i32(model, 0, 1, row_start, dof, coefficient, &relative));
    return model;
}

/* a hub (DOFs 0 to 5) by three nodes of a face (6 to 14), a node linked to it (15 to 17), one tied to the
 * face (18 to 20), and a multiplier (21) between two DOFs (22, 23) */
static void print_coupled(void) {
    const int32_t hub[] = {0, 1, 2, 3, 4, 5}, face[] = {6, 7, 8, 9, 10, 11, 12, 13, 14},
                  linked[] = {15, 16, 17}, tied[] = {18, 19, 20}, face_ptr[] = {0, 3},
                  face_node[] = {0, 1, 2}, no_dof[] = {-1, -1, -1, -1, -1, -1, -1, -1, -1},
                  multiplier[] = {21}, tail[] = {22, 23, 22, 23}, head[] = {22, 23, 21, 21};
    const double origin[] = {0, 0, 0}, corners[] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, weight[] = {1, 2, 3},
                 aside[] = {1, 1, 0}, above[] = {0.4, 0.4, 0.5};
    int32_t row[25], column[25];
    double mass[25], stiffness[25], distance[3], hz[4];
    const double wall[] = {1.5, 0.5, 0.5, 0.5, 0.5, 1.5, 0.5, 1.5, 0.5}, press[] = {3, PLM_KEEP_GAP, 0};
    int64_t n = 0, slave = -1, master = -1;
    plm_model *model = NULL;
    for (int32_t i = 0; i < 25; i++) {
        row[i] = i < 21 ? i : tail[i - 21], column[i] = i < 21 ? i : head[i - 21];
        mass[i] = 1, stiffness[i] = i < 23 ? 1000 * (1 + row[i]) : 2 * i - 47; /* at the end -1 and 1 */
    }
    must(plm_model_create(ctx, 24, &model));
    must(plm_model_set_matrix_i32(model, PLM_MASS, PLM_TRIPLETS, PLM_LOWER, 0, PLM_COPY, 23, row, column,
                                  mass));
    must(plm_model_set_matrix_i32(model, PLM_STIFFNESS, PLM_TRIPLETS, PLM_LOWER, 0, PLM_COPY, 25, row, column,
                                  stiffness));
    must(plm_model_add_distributing_coupling_i32(model, 0, 6, hub, origin, 3, face, corners, weight));
    must(plm_model_add_rigid_link_i32(model, 0, 6, hub, origin, 1, 3, linked, aside));
    must(plm_model_add_tie_i32(model, 0, 1, tied, above, 3, face, corners, 1, face_ptr, face_node, 1,
                               distance));
    must(plm_model_set_multipliers_i32(model, 0, 1, multiplier));
    must(plm_model_add_surface_i32(model, 0, 3, face, corners, NULL, 1, face_ptr, face_node, &slave));
    must(plm_model_add_surface_i32(model, 0, 3, no_dof, wall, NULL, 1, face_ptr, face_node, &master));
    must(plm_model_add_surface_contact(model, slave, master, PLM_SURFACE_SMOOTH, 50, 2, 0.1));
    must(plm_model_set_rest_force(model, 3, press));
    must(plm_model_set_coordinates_i32(model, 0, 3, 3, face, corners));
    must(plm_model_build(model));
    must(plm_model_get_int(model, "n_free", &n));
    heading("coupled_n_free"), whole(n);
    must(plm_model_audit(model, &n)), heading("coupled_findings"), whole(n);
    reals("tie_distance", 1, distance);
    must(plm_model_get_modes(model, PLM_SYSTEM_OPEN, NULL, 4, hz, NULL));
    reals("coupled_hz", 4, hz);
    must(plm_model_solve_rest(model));
    must(plm_model_get_array(model, "surface_gap", 3, distance, &n)), reals("surface_gap", n, distance);
    must(plm_model_get_array(model, "rest_force", 3, distance, &n)), reals("surface_force", n, distance);
    must(plm_model_get_array(model, "initial_gap", 3, distance, &n)), reals("surface_rest_gap", n, distance);
    must(plm_model_destroy(&model));
}

static void print_model(plm_model *model) {
    double x[N], hz[3];
    int64_t n = 0, count = 0;
    must(plm_model_get_int(model, "n_free", &n));
    heading("n_free"), whole(n);
    must(plm_model_get_array(model, "contact_stiffness", N, x, &count));
    reals("contact_stiffness", count, x);
    must(plm_model_solve_rest(model));
    must(plm_model_get_array(model, "rest_displacement", N, x, &count));
    reals("rest_displacement", count, x);
    must(plm_model_get_modes(model, PLM_SYSTEM_OPEN, NULL, 3, hz, NULL));
    reals("open_hz", 3, hz);
    must(plm_model_get_modes(model, PLM_SYSTEM_SLIDING, NULL, 3, hz, NULL));
    reals("sliding_hz", 3, hz);
}

static plm_basis *make_basis(plm_model *model) {
    double x[64];
    int64_t integer[64], n = 0;
    plm_sampler *sampler = NULL;
    plm_basis *basis = NULL;
    must(plm_sampler_create(model, &sampler));
    must(plm_sampler_set_string(sampler, "system", "open"));
    must(plm_sampler_set_int(sampler, "mode", 1));
    must(plm_sampler_set_int(sampler, "n_samples", 3));
    must(plm_sampler_run(sampler));
    must(plm_sampler_get_double(sampler, "blf_hz", x));
    reals("blf_hz", 1, x);
    must(plm_sampler_get_array(sampler, "sweep_alpha", 64, x, &n));
    reals("sweep_alpha", n, x);
    must(plm_sampler_get_int_array(sampler, "selected_samples", 64, integer, &n));
    heading("selected_samples");
    for (int64_t i = 0; i < n; i++) whole(integer[i]);

    must(plm_basis_create(model, &basis));
    must(plm_basis_set_sampler(basis, sampler));
    must(plm_basis_set_int(basis, "n_harmonics", H));
    must(plm_basis_build(basis));
    must(plm_basis_get_array(basis, "singular_values", 64, x, &n));
    reals("singular_values", n, x);
    must(plm_sampler_destroy(&sampler));
    return basis;
}

static void print_point(plm_branch *branch, int64_t point) {
    double x[2 * H + 1 + N], penetration[PAIRS * TIMES], force[PAIRS * TIMES];
    int32_t closed[PAIRS * TIMES];
    must(plm_branch_get_coefficients(branch, point, WATCHED, 1, x));
    reals("coefficients", 2 * H + 1, x);
    must(plm_branch_get_coefficients(branch, point, relative, 1, x));
    reals("relative", 2 * H + 1, x);
    must(plm_branch_get_history(branch, point, relative, TIMES, x));
    reals("relative_history", TIMES, x);
    must(plm_branch_get_field(branch, point, 0.25, N, x));
    reals("field", N, x);
    must(plm_branch_get_contact(branch, point, TIMES, penetration, force, closed));
    reals("penetration", PAIRS * TIMES, penetration);
    reals("force", PAIRS * TIMES, force);
    heading("closed");
    for (int i = 0; i < PAIRS * TIMES; i++) whole(closed[i]);
    must(plm_branch_get_closed_share(branch, point, PAIRS, x));
    reals("closed_share", PAIRS, x);
    must(plm_branch_get_full_residual(branch, point, x));
    reals("full_residual", 1, x);
}

static void wholes(const char *name, int64_t n, const int64_t *x) {
    heading(name);
    for (int64_t i = 0; i < n; i++) whole(x[i]);
}

static void print_stability(plm_branch *branch, int64_t n_points, int64_t point) {
    double real[64], imag[64], x[2];
    int64_t n = 0, *flags = malloc((size_t)n_points * sizeof *flags);
    if (!flags) exit(1);
    must(plm_branch_get_int_array(branch, "bifurcation", n_points, flags, &n));
    wholes("bifurcation", n, flags);
    must(plm_branch_get_int_array(branch, "stable", n_points, flags, &n));
    wholes("stable", n, flags);
    free(flags);
    must(plm_branch_get_multipliers(branch, point, 64, real, imag, &n));
    reals("multipliers_real", n, real);
    reals("multipliers_imag", n, imag);
    must(plm_branch_get_periodicity_defect(branch, point, x));
    reals("periodicity_defect", 1, x);
    must(plm_branch_get_energy(branch, point, &x[0], &x[1]));
    reals("energy", 2, x);
}

static void print_motion(plm_model *model, plm_basis *basis, plm_branch *branch, int64_t point) {
    const int32_t observed[] = {2, WATCHED};
    double x[64], v[64];
    int64_t n = 0;
    plm_transient *motion = NULL;
    must(plm_transient_create(model, basis, &motion));
    must(plm_transient_set_int(motion, "periods", 2));
    must(plm_transient_set_int(motion, "steps_per_period", 16));
    must(plm_transient_observe_i32(motion, 0, 2, observed));
    must(plm_transient_start_at(motion, branch, point));
    must(plm_transient_run(motion));
    must(plm_transient_get_array(motion, "time", 64, x, &n));
    reals("time", n, x);
    must(plm_transient_get_history(motion, 1, 64, x, &n));
    reals("history", n, x);
    must(plm_transient_get_state(motion, N, x, v));
    reals("state_q", N, x);
    reals("state_v", N, v);
    must(plm_transient_set_state(motion, N, x, NULL)); /* let go */
    must(plm_transient_run(motion));
    must(plm_transient_get_history(motion, 0, 64, x, &n));
    reals("let_go", n, x);
    must(plm_transient_start_at(motion, branch, point));
    must(plm_transient_find_periodic(motion));
    must(plm_transient_get_multipliers(motion, 64, x, v, &n));
    reals("periodic_multipliers_real", n, x);
    reals("periodic_multipliers_imag", n, v);
}

/* the error of the peak, and the basis that the curve leaves of the parent */
static void print_estimate(plm_model *model, plm_basis *basis, plm_hbm *hbm, plm_branch *curve,
                           plm_branch *top) {
    double x[64];
    int64_t n = 0;
    plm_basis *small = NULL;
    must(plm_hbm_estimate_error(hbm, top, 0, WATCHED, PLM_HALF_PEAK_TO_PEAK, 0, x, x + 3));
    reals("error", 6, x);
    must(plm_basis_create(model, &small));
    must(plm_basis_set_string(small, "kind", "pod"));
    must(plm_basis_set_double(small, "pod_tolerance", 1e-3));
    must(plm_basis_set_parent(small, basis));
    must(plm_basis_set_responses(small, 1, &curve));
    must(plm_basis_build(small));
    must(plm_basis_get_array(small, "lambda", 64, x, &n));
    reals("pod_lambda", n, x);
    must(plm_hbm_refine_basis(hbm, WATCHED, PLM_HALF_PEAK_TO_PEAK, 0, 1e-2, &small, x));
    reals("refined_error", 1, x);
    must(plm_basis_get_array(small, "lambda", 64, x, &n));
    reals("refined_lambda", n, x);
}

/* errors and sizes of four methods at two force levels; no times */
static void print_study(plm_model *model, plm_basis *basis, plm_hbm *hbm) {
    enum { METHODS = 4 };
    const double levels[] = {0.5, 1};
    const char *const keys[] = {"frequency_error", "amplitude_error", "curve_error_l2", "curve_error_max"};
    double x[METHODS], *hz, *amplitude;
    char text[80];
    int64_t integer[METHODS], n = 0, index = -1;
    plm_study *study = NULL;
    plm_transient *motion = NULL;
    plm_branch *curve = NULL;
    must(plm_transient_create(model, basis, &motion));
    must(plm_transient_set_double(motion, "settled", 1e-4));
    must(plm_transient_set_int(motion, "periods", 2000));
    must(plm_study_create(model, &study));
    must(plm_study_set_int(study, "repeats", 1));
    must(plm_study_set_double(study, "curve_tolerance", 1e-4));
    must(plm_study_set_output(study, WATCHED, PLM_HALF_PEAK_TO_PEAK, 0));
    must(plm_study_set_force_levels(study, 2, levels));
    must(plm_hbm_set_double(hbm, "max_step", 0.25));
    must(plm_hbm_set_string(hbm, "stability", "off"));
    must(plm_hbm_set_int(hbm, "n_harmonics", 3));
    must(plm_study_add_response(study, "three harmonics", hbm, NULL));
    must(plm_hbm_set_int(hbm, "n_harmonics", H));
    must(plm_study_add_compressed(study, "compressed", hbm, 3, NULL));
    must(plm_study_add_refined(study, "refined", hbm, 1e-2, NULL));
    must(plm_study_add_marching(study, "marching", motion, 3, &index));
    must(plm_study_set_reference(study, hbm));
    must(plm_study_run(study));
    for (int k = 0; k < 4; k++) {
        must(plm_study_get_array(study, keys[k], METHODS, x, &n));
        reals(keys[k], n, x);
    }
    must(plm_study_get_int_array(study, "basis_size", METHODS, integer, &n));
    wholes("basis_size", n, integer);
    must(plm_study_get_int(study, "reference_size", &n));
    wholes("reference_size", 1, &n);
    must(plm_study_get_name(study, index, sizeof text, text, NULL));
    heading(text);
    must(plm_study_get_outcome(study, -1, sizeof text, text, NULL));
    heading(text);
    must(plm_study_get_curve(study, 1, 1, &curve));
    must(plm_branch_get_int(curve, "n_points", &n));
    wholes("study_curve", 1, &n);
    must(plm_study_get_points(study, 0, 1, 0, NULL, NULL, &n));
    hz = malloc((size_t)n * sizeof *hz), amplitude = malloc((size_t)n * sizeof *amplitude);
    if (!hz || !amplitude) exit(1);
    must(plm_study_get_points(study, 0, 1, n, hz, amplitude, &n));
    reals("study_hz", n, hz);
    reals("study_amplitude", n, amplitude);
    free(hz), free(amplitude);
    must(plm_study_destroy(&study));
}

static void print_whole_way(plm_model *model) {
    plm_hbm *hbm = NULL;
    plm_branch *curve = NULL;
    double x[3], accuracy = 0;
    int64_t n = 0;
    must(plm_model_compute_response(model, WATCHED, PLM_HALF_PEAK_TO_PEAK, 1e-4, &x[0], &x[1], &x[2], &curve,
                                    &hbm));
    reals("response", 3, x);
    must(plm_hbm_get_double(hbm, "accuracy", &accuracy));
    reals("accuracy", 1, &accuracy);
    must(plm_branch_get_int(curve, "basis_size", &n));
    heading("basis_size"), whole(n);
    must(plm_branch_destroy(&curve));
    must(plm_hbm_destroy(&hbm));
}

/* Bytes, and the sum of their values, of pieces handed over. */
static int32_t count_bytes(plm_context *c, int64_t n, const void *bytes, void *counted) {
    (void)c;
    ((double *)counted)[0] += (double)n;
    for (int64_t i = 0; i < n; i++) ((double *)counted)[1] += ((const unsigned char *)bytes)[i];
    return 0;
}
static void print_written(plm_basis *basis, plm_branch *curve) {
    double b[2] = {0, 0}, c[2] = {0, 0}, t[2] = {0, 0};
    must(plm_basis_write_to(basis, count_bytes, b));
    must(plm_branch_write_to(curve, count_bytes, c));
    must(plm_branch_write_csv_to(curve, WATCHED, PLM_HALF_PEAK_TO_PEAK, 0, count_bytes, t));
    reals("written_basis", 1, b), reals("written_curve", 1, c), reals("written_table", 2, t);
}

/* Basis and curve through their bytes. */
static void print_read(plm_model *model, plm_basis *basis, plm_branch *curve) {
    static char bytes[1 << 23];
    static double x[4096];
    plm_basis *again = NULL;
    plm_branch *read = NULL;
    int64_t n = 0;
    must(plm_basis_write(basis, sizeof bytes, bytes, &n));
    print_written(basis, curve);
    must(plm_basis_read(ctx, n, bytes, &again));
    must(plm_basis_attach(again, model));
    must(plm_branch_write(curve, sizeof bytes, bytes, &n));
    must(plm_branch_read(again, n, bytes, &read));
    must(plm_branch_get_amplitude(read, WATCHED, PLM_HALF_PEAK_TO_PEAK, 0, 4096, x, &n));
    reals("read_amplitude", n, x);
    must(plm_branch_get_full_residual(read, 3, x));
    reals("read_residual", 1, x);
}

/* A curve that ends early, and goes on. */
static void print_resumed(plm_hbm *hbm) {
    static double x[4096];
    plm_branch *part = NULL, *whole = NULL;
    int64_t n = 0;
    must(plm_hbm_set_int(hbm, "max_points", 12));
    if (plm_hbm_sweep(hbm, &part) != PLM_TRUNCATED) exit(1);
    must(plm_hbm_set_int(hbm, "max_points", 1000));
    must(plm_hbm_save_every(hbm, 5, "parity_c.plm"));
    must(plm_hbm_resume(hbm, part, &whole));
    must(plm_hbm_save_every(hbm, 0, NULL));
    if (remove("parity_c.plm")) exit(1);
    must(plm_branch_get_amplitude(whole, WATCHED, PLM_HALF_PEAK_TO_PEAK, 0, 4096, x, &n));
    reals("resumed_amplitude", n, x);
    must(plm_branch_destroy(&part));
    must(plm_branch_destroy(&whole));
}

static void print_response(plm_model *model, plm_basis *basis) {
    plm_hbm *hbm = NULL;
    plm_branch *curve = NULL, *top = NULL, *lower = NULL;
    const double level[] = {0.8, 0.5};
    double *x, peak[2];
    int64_t n = 0, n_points = 0;
    must(plm_hbm_create(basis, &hbm));
    must(plm_hbm_set_int(hbm, "n_harmonics", H));
    must(plm_hbm_set_string(hbm, "unknowns", "modal"));
    must(plm_hbm_set_double(hbm, "max_step", 0.05));
    must(plm_hbm_sweep(hbm, &curve));
    must(plm_branch_get_int(curve, "n_points", &n));
    heading("n_points"), whole(n), n_points = n;
    x = malloc((size_t)n * sizeof *x);
    if (!x) exit(1);
    must(plm_branch_get_array(curve, "frequency_hz", n, x, &n));
    reals("frequency_hz", n, x);
    must(plm_branch_get_amplitude(curve, WATCHED, PLM_HALF_PEAK_TO_PEAK, 0, n, x, &n));
    reals("amplitude", n, x);
    must(plm_hbm_sweep_levels(hbm, 2, level, &n));
    must(plm_hbm_get_found(hbm, n - 1, NULL, &lower));
    must(plm_branch_get_int(lower, "n_points", &n));
    heading("level_points"), whole(n);
    must(plm_branch_destroy(&lower));
    free(x);
    print_resumed(hbm);
    must(plm_hbm_find_peak(hbm, curve, WATCHED, PLM_HALF_PEAK_TO_PEAK, 0, &peak[0], &peak[1], &top));
    reals("peak", 2, peak);
    print_read(model, basis, curve);
    print_whole_way(model);
    print_estimate(model, basis, hbm, curve, top);
    print_point(top, 0);
    print_stability(curve, n_points, 5);
    print_motion(model, basis, curve, 5);
    print_study(model, basis, hbm);
}

int main(void) {
    if (plm_context_create(PLM_API_VERSION, &ctx)) return 1;
    plm_model *model = make_model();
    print_model(model);
    print_coupled();
    print_response(model, make_basis(model));
    return plm_context_destroy(&ctx);
}
