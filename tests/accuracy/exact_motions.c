/* Exact motions against two other ways to the same motion: harmonic balance as its harmonics grow, on a soft
 * oscillator, and marching of the unreduced structure by Newmark's method as its step is halved, on the
 * cracked plate. Prints docs/exact-motions.md; with --quick the first table alone, and fails where that does
 * not converge. */
#include "cracked_plate.h"
#include "scene_model.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* --- harmonics: two masses, a pair half as stiff as their springs */

static const double harmonics_agree_to = 1e-8; /* of the peak */

static void soft_basis(plm_context *context, plm_basis **basis) {
    const int32_t i[] = {0, 1, 1}, j[] = {0, 0, 1}, row[] = {0, 1}, dof[] = {1};
    const double m[] = {1, 0, 1}, k[] = {20000, -10000, 10000}, one[] = {1}, pair[] = {5000},
                 force[] = {0, 1};
    plm_model *model = NULL;
    must(context, plm_model_create(context, 2, &model), "model");
    must(context, plm_model_set_matrix_i32(model, PLM_MASS, PLM_TRIPLETS, PLM_LOWER, 0, PLM_COPY, 3, i, j, m),
         "mass");
    must(context,
         plm_model_set_matrix_i32(model, PLM_STIFFNESS, PLM_TRIPLETS, PLM_LOWER, 0, PLM_COPY, 3, i, j, k),
         "stiffness");
    must(context, plm_model_set_rayleigh_damping(model, 0, 2e-4), "damping");
    must(context, plm_model_set_excitation(model, 1, 2, force, NULL), "excitation");
    must(context, plm_model_add_gap_rows_i32(model, 0, 1, row, dof, one, pair, NULL), "pair");
    must(context, plm_model_build(model), "build");
    must(context, plm_basis_create(model, basis), "basis");
    must(context, plm_basis_set_string(*basis, "kind", "full"), "kind");
    must(context, plm_basis_set_double(*basis, "frequency_min_hz", 8), "window");
    must(context, plm_basis_set_double(*basis, "frequency_max_hz", 14), "window");
    must(context, plm_basis_build(*basis), "basis");
}

/* n_harmonics 0: an exact motion. */
static double amplitude_at(plm_context *context, plm_basis *basis, double hz, int64_t n_harmonics) {
    plm_hbm *hbm = NULL;
    plm_branch *point = NULL;
    double amplitude = 0;
    int64_t count = 0;
    must(context, plm_hbm_create(basis, &hbm), "hbm");
    must(context, plm_hbm_set_string(hbm, "motion", n_harmonics ? "harmonics" : "exact"), "motion");
    must(context, plm_hbm_set_int(hbm, "n_harmonics", n_harmonics), "n_harmonics");
    must(context, plm_hbm_set_double(hbm, "tolerance", 1e-13), "tolerance");
    must(context, plm_hbm_solve(hbm, hz, NULL, 0, &point), "solve");
    must(context, plm_branch_get_amplitude(point, 1, PLM_PEAK, 0, 1, &amplitude, &count), "amplitude");
    plm_branch_destroy(&point);
    plm_hbm_destroy(&hbm);
    return amplitude;
}

static double table_of_harmonics(plm_context *context) {
    enum { fewest = 5, most = 320 };
    plm_basis *basis = NULL;
    soft_basis(context, &basis);
    const double hz = 10.8, exact = amplitude_at(context, basis, hz, 0);
    double error = 1;
    printf("## Harmonic balance as its harmonics grow\n\n"
           "Two masses of 1 kg on springs of 10 N/mm, the second one in contact through a pair of 5 N/mm, "
           "zero gap;\n"
           "motion at %.4g Hz, where the linear systems of the open and of the closed pair resonate on both "
           "sides. The\n"
           "force of the pair has a kink where it opens, so that harmonics fall off as 1 / H^4.\n\n",
           hz);
    printf("| harmonics | distance of the peak displacement |\n|--:|--:|\n");
    for (int64_t n = fewest; n <= most; n *= 2) {
        error = fabs(amplitude_at(context, basis, hz, n) / exact - 1);
        printf("| %lld | %.1e |\n", (long long)n, error);
    }
    return error;
}

/* --- marching: the cracked plate on 12 x 10 x 2 bricks with all defaults */

enum { FIRST_STEPS = 200, MARCHES = 3, POINTS = 3, MOST_PERIODS = 3000 };

/* Largest displacement of the record, by the parabola through the sample on top and its neighbours. */
static double largest(int64_t n, const double *q) {
    double most = 0;
    for (int64_t i = 1; i + 1 < n; i++) {
        if (fabs(q[i]) < fabs(q[i - 1]) || fabs(q[i]) < fabs(q[i + 1])) continue;
        const double slope = 0.5 * (q[i + 1] - q[i - 1]), bend = q[i + 1] - 2 * q[i] + q[i - 1];
        const double top = fabs(bend != 0 ? q[i] - 0.5 * slope * slope / bend : q[i]);
        if (top > most) most = top;
    }
    return most;
}

/* Marches from a point of the curve until the motion repeats itself. */
static double marched(plm_context *context, plm_model *model, plm_branch *curve, int64_t point, int32_t dof,
                      int64_t steps, int64_t *periods) {
    plm_transient *march = NULL;
    int64_t n = 0;
    double *q = malloc(sizeof *q * (size_t)(2 * steps + 1));
    if (!q) exit(1);
    must(context, plm_transient_create(model, NULL, &march), "transient");
    must(context, plm_transient_start_at(march, curve, point), "start");
    must(context, plm_transient_set_int(march, "steps_per_period", steps), "steps");
    must(context, plm_transient_set_int(march, "periods", MOST_PERIODS), "periods");
    must(context, plm_transient_set_double(march, "settled", 1e-8), "settled");
    must(context, plm_transient_run(march), "march");
    must(context, plm_transient_get_int(march, "periods_done", periods), "periods");
    must(context, plm_transient_set_int(march, "periods", 2), "periods");
    must(context, plm_transient_observe_i32(march, 0, 1, &dof), "observe");
    must(context, plm_transient_run(march), "record");
    must(context, plm_transient_get_history(march, 0, 2 * steps + 1, q, &n), "history");
    const double amplitude = largest(n, q);
    plm_transient_destroy(&march);
    free(q);
    return amplitude;
}

/* Positions on the curve: the highest point and, to both sides, the ones nearest to 0.6 of it. */
static void choose_points(int64_t n, const double *amplitude, int64_t *at) {
    int64_t top = 0;
    for (int64_t i = 0; i < n; i++)
        if (amplitude[i] > amplitude[top]) top = i;
    at[0] = 0, at[1] = top, at[2] = n - 1;
    const double wanted = 0.6 * amplitude[top];
    for (int64_t i = 0; i < n; i++) {
        int64_t *side = i < top ? &at[0] : &at[2];
        if (i != top && fabs(amplitude[i] - wanted) < fabs(amplitude[*side] - wanted)) *side = i;
    }
}

static void table_of_marches(plm_context *context) {
    enum { most_points = 4000 };
    static double amplitude[most_points], hz[most_points];
    cracked_plate_params params;
    scene *plate = NULL;
    plm_model *model = NULL;
    plm_sampler *sampler = NULL;
    plm_basis *basis = NULL;
    plm_hbm *hbm = NULL;
    plm_branch *curve = NULL;
    int64_t n = 0, at[POINTS], periods = 0;
    cracked_plate_quick(&params);
    if (cracked_plate_create(&params, &plate)) exit(1);
    must(context, scene_to_model(context, plate, &model), "model");
    must(context, plm_sampler_create(model, &sampler), "sampler");
    must(context, plm_sampler_run(sampler), "sampler");
    must(context, plm_basis_create(model, &basis), "basis");
    must(context, plm_basis_set_sampler(basis, sampler), "basis");
    must(context, plm_basis_build(basis), "basis");
    must(context, plm_hbm_create(basis, &hbm), "hbm");
    must(context, plm_hbm_sweep(hbm, &curve), "sweep");
    must(context, plm_branch_get_array(curve, "frequency_hz", most_points, hz, &n), "frequencies");
    must(context, plm_branch_get_amplitude(curve, plate->output_dof, PLM_PEAK, 0, most_points, amplitude, &n),
         "amplitudes");
    choose_points(n, amplitude, at);
    printf("\n## Marching of the unreduced structure\n\n"
           "Cracked plate of the examples, %lld DOFs, %lld pairs; curve with nothing set, of exact motions "
           "on a basis of\n"
           "piecewise-linear modes. From its highest point and from one on each side the unreduced structure "
           "is\n"
           "marched by Newmark's method until the state repeats itself to 1e-8 of the motion; the step is "
           "halved twice.\n"
           "Extrapolated: what the last two leave when the step goes to zero, whose error goes with its "
           "square.\n\n",
           (long long)plate->n_dof, (long long)plate->n_pairs);
    printf("| frequency (Hz) | exact motion (mm) | steps a period | periods | marched (mm) | distance |\n"
           "|--:|--:|--:|--:|--:|--:|\n");
    for (int p = 0; p < POINTS; p++) {
        const double exact = amplitude[at[p]];
        double a = 0, before = 0;
        for (int64_t k = 0, steps = FIRST_STEPS; k < MARCHES; k++, steps *= 2) {
            before = a;
            a = marched(context, model, curve, at[p], (int32_t)plate->output_dof, steps, &periods);
            printf("| %.4f | %.8f | %lld | %lld | %.8f | %.1e |\n", hz[at[p]], exact, (long long)steps,
                   (long long)periods, a, fabs(a / exact - 1));
            fflush(stdout);
        }
        a += (a - before) / 3;
        printf("| %.4f | %.8f | extrapolated | | %.8f | %.1e |\n", hz[at[p]], exact, a, fabs(a / exact - 1));
    }
    scene_destroy(&plate);
}

int main(int count, char **argument) {
    const int quick = count > 1 && !strcmp(argument[1], "--quick");
    plm_context *context = NULL;
    must(NULL, plm_context_create(PLM_API_VERSION, &context), "context");
    printf("# Exact motions against other ways to the same motion\n\n"
           "    OPENBLAS_NUM_THREADS=1 build/release/tests/accuracy/exact_motions > docs/exact-motions.md\n\n"
           "ctest runs the first table (`exact_motions --quick`) and fails where it does not end below "
           "%.0e.\n\n",
           harmonics_agree_to);
    const double left = table_of_harmonics(context);
    if (!quick) table_of_marches(context);
    plm_context_destroy(&context);
    return left < harmonics_agree_to ? 0 : 1;
}
