/*
 * calculix_response.c: nonlinear forced response of a cracked plate whose finite elements are CalculiX's.
 *
 *     calculix_response FOLDER
 *
 * FOLDER holds the decks of plate.py and what ccx made of them (run.sh does it all). The program hands ccx's
 * matrices, the contact pairs, the pre-load and the tip force to libplm, prints natural frequencies beside
 * ccx's own, and follows the response near the first in-plane bending mode: FOLDER/curve.csv. Exit status 1
 * when anything fails or a frequency differs by more than 1e-6.
 */
#include <inttypes.h>
#include <math.h>
#include <plm/plm.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "ccx_files.h"

enum { n_compared = 10, path_size = 4096 };
static const double agreement = 1e-6; /* ccx prints 7 digits: half a unit of the last one is up to 5e-7 */
static const double quality = 100, quality_hz = 1700, pi = 3.14159265358979323846;

/* ---- what plate.py writes beside the decks ---- */

typedef struct plate {
    int64_t n_dof, n_pairs;
    int32_t *dof_a, *dof_b; /* 3 n_pairs: matrix rows from 1; 0: no such DOF (clamped) */
    double *normal, *stiffness;
    double *preload, *force; /* n_dof */
    int32_t drive_row;       /* the driven and watched DOF, from 1 */
} plate;

static void plate_free(plate *p) {
    free(p->dof_a);
    free(p->dof_b);
    free(p->normal);
    free(p->stiffness);
    free(p->preload);
    free(p->force);
}

static int plate_allocate(plate *p, int64_t n_dof, int64_t most_pairs) {
    const size_t n = (size_t)n_dof, m = (size_t)most_pairs + 1;
    memset(p, 0, sizeof *p);
    p->n_dof = n_dof;
    p->dof_a = malloc(3 * m * sizeof *p->dof_a);
    p->dof_b = malloc(3 * m * sizeof *p->dof_b);
    p->normal = malloc(3 * m * sizeof *p->normal);
    p->stiffness = malloc(m * sizeof *p->stiffness);
    p->preload = calloc(n, sizeof *p->preload);
    p->force = calloc(n, sizeof *p->force);
    return !(p->dof_a && p->dof_b && p->normal && p->stiffness && p->preload && p->force);
}

/* One line of plate.txt; 0 when it was understood. */
static int plate_line(const char *line, const ccx_dofs *dofs, plate *p) {
    int32_t a, b, direction;
    double value, *normal = p->normal + 3 * p->n_pairs;
    if (sscanf(line, "pair %d %d %lf %lf %lf %lf", &a, &b, normal, normal + 1, normal + 2, &value) == 6) {
        for (int32_t d = 0; d < 3; d++) {
            p->dof_a[3 * p->n_pairs + d] = ccx_row(dofs, a, d + 1);
            p->dof_b[3 * p->n_pairs + d] = ccx_row(dofs, b, d + 1);
        }
        p->stiffness[p->n_pairs++] = value;
        return 0;
    }
    const int is_preload = sscanf(line, "preload %d %d %lf", &a, &direction, &value) == 3;
    if (!is_preload && sscanf(line, "force %d %d %lf", &a, &direction, &value) != 3) return 1;
    const int32_t row = ccx_row(dofs, a, direction);
    if (row == 0) return 1;
    (is_preload ? p->preload : p->force)[row - 1] += value;
    if (!is_preload) p->drive_row = row;
    return 0;
}

static int plate_read(const char *path, const ccx_dofs *dofs, plate *p) {
    char line[256];
    int64_t n_lines = 0;
    FILE *file = fopen(path, "r");
    while (file && fgets(line, sizeof line, file)) n_lines++;
    if (file) rewind(file);
    int failed = !file || plate_allocate(p, dofs->n_rows, n_lines);
    while (!failed && fgets(line, sizeof line, file)) failed = plate_line(line, dofs, p);
    if (file) fclose(file);
    if (failed || p->drive_row == 0 || p->n_pairs == 0) {
        fprintf(stderr, "%s: missing, or not as plate.py writes it\n", path);
        return 1;
    }
    return 0;
}

/* ---- libplm ---- */

/* Prints the library's own words about a failure or an outcome; 1 for a failure. */
static int failed(plm_context *ctx, plm_status status) {
    char text[1024] = "";
    if (status == PLM_OK) return 0;
    if (status < 0) plm_context_get_error_text(ctx, sizeof text, text, NULL);
    if (!text[0]) plm_status_text(status, sizeof text, text, NULL);
    fprintf(stderr, "%s: %s\n", status < 0 ? "error" : "note", text);
    return status < 0;
}
#define TRY(call)                                                                                            \
    do {                                                                                                     \
        if (failed(ctx, (call))) return 1;                                                                   \
    } while (0)

static int set_matrix(plm_context *ctx, plm_model *model, int32_t which, const char *path) {
    ccx_matrix m;
    if (ccx_read_matrix(path, &m)) return 1;
    const plm_status status = plm_model_set_matrix_i32(model, which, PLM_TRIPLETS, PLM_UPPER, 1, PLM_COPY,
                                                       m.n_entries, m.row, m.column, m.value);
    ccx_free_matrix(&m);
    return failed(ctx, status);
}

static int build_model(plm_context *ctx, plm_model *model, const plate *p) {
    TRY(plm_model_set_rayleigh_damping(model, 0, 1 / (quality * 2 * pi * quality_hz)));
    TRY(plm_model_add_node_pairs_i32(model, 1, p->n_pairs, p->dof_a, p->dof_b, p->normal, p->stiffness,
                                     NULL));
    TRY(plm_model_set_preload(model, p->n_dof, p->preload));
    TRY(plm_model_set_excitation(model, 1, p->n_dof, p->force, NULL));
    TRY(plm_model_build(model));
    TRY(plm_model_solve_rest(model));
    double local_stiffness;
    int64_t n_closed;
    TRY(plm_model_get_double(model, "local_stiffness", &local_stiffness));
    TRY(plm_model_get_int(model, "rest_n_closed", &n_closed));
    printf("%" PRId64 " DOFs, %" PRId64 " contact pairs, k_n = %.3g N/mm (local stiffness %.3g), %" PRId64
           " pairs closed at rest\n",
           p->n_dof, p->n_pairs, p->stiffness[0], local_stiffness, n_closed);
    return 0;
}

static int compare(plm_context *ctx, plm_model *model, int32_t system, const char *name,
                   const char *dat_path) {
    double ccx[n_compared], plm[n_compared], largest = 0;
    if (ccx_read_frequencies(dat_path, n_compared, ccx)) return 1;
    TRY(plm_model_get_modes(model, system, NULL, n_compared, plm, NULL));
    printf("\n%-8s mode       ccx (Hz)    libplm (Hz)  relative difference\n", name);
    for (int i = 0; i < n_compared; i++) {
        const double difference = fabs(plm[i] / ccx[i] - 1);
        printf("%-8s %4d %14.7g %14.9g  %.1e\n", name, i + 1, ccx[i], plm[i], difference);
        if (!(difference <= largest)) largest = difference;
    }
    if (largest <= agreement) return 0;
    fprintf(stderr, "%s: frequencies differ by %.1e, more than %.0e\n", name, largest, agreement);
    return 1;
}

static int write_curve(plm_context *ctx, plm_branch *branch, int64_t dof, const char *path) {
    enum { most = 5000 };
    static double hz[most], peak[most], first[most];
    static int64_t switching[most];
    int64_t n;
    TRY(plm_branch_get_array(branch, "frequency_hz", most, hz, &n));
    TRY(plm_branch_get_amplitude(branch, dof, PLM_HALF_PEAK_TO_PEAK, 0, most, peak, &n));
    TRY(plm_branch_get_amplitude(branch, dof, PLM_HARMONIC, 1, most, first, &n));
    TRY(plm_branch_get_int_array(branch, "n_switching", most, switching, &n));
    FILE *file = fopen(path, "w");
    if (!file) {
        perror(path);
        return 1;
    }
    fprintf(file, "frequency_hz,half_peak_to_peak_mm,first_harmonic_mm,switching_pairs\n");
    for (int64_t i = 0; i < n; i++)
        fprintf(file, "%.10g,%.10g,%.10g,%" PRId64 "\n", hz[i], peak[i], first[i], switching[i]);
    if (fclose(file)) {
        perror(path);
        return 1;
    }
    return 0;
}

/* Sampler, basis, harmonic balance: every handle lives until the context is destroyed. */
static int response(plm_context *ctx, plm_model *model, int64_t dof, const char *csv_path) {
    plm_sampler *sampler;
    plm_basis *basis;
    plm_hbm *hbm;
    plm_branch *branch;
    char text[512];
    double dominant_hz, peak_hz, amplitude, seconds;
    int64_t size, n_points, reason;

    TRY(plm_sampler_create(model,
                           &sampler)); /* the mode is proposed by its share in the drive-point response */
    TRY(plm_sampler_run(sampler));
    TRY(plm_sampler_get_double(sampler, "dominant_frequency_hz", &dominant_hz));
    TRY(plm_sampler_get_string(sampler, "window_why", sizeof text, text, NULL));
    printf("\ndominant mode: %.2f Hz; window: %s\n", dominant_hz, text);

    TRY(plm_basis_create(model, &basis));
    TRY(plm_basis_set_string(basis, "kind", "plm"));
    TRY(plm_basis_set_sampler(basis, sampler));
    TRY(plm_basis_build(basis));
    TRY(plm_basis_get_int(basis, "size", &size));

    TRY(plm_hbm_create(basis, &hbm));
    TRY(plm_hbm_set_int(hbm, "n_harmonics", 5));
    TRY(plm_hbm_sweep(hbm, &branch));
    TRY(plm_branch_get_int(branch, "n_points", &n_points));
    TRY(plm_branch_get_int(branch, "end_reason", &reason));
    TRY(plm_branch_get_double(branch, "seconds", &seconds));
    TRY(plm_branch_get_string(branch, "end_text", sizeof text, text, NULL));
    printf("basis: %" PRId64 " vectors; curve: %" PRId64 " points in %.2f s, end: %s\n", size, n_points,
           seconds, text);
    if (write_curve(ctx, branch, dof, csv_path)) return 1;
    TRY(plm_hbm_find_peak(hbm, branch, dof, PLM_HALF_PEAK_TO_PEAK, 0, &peak_hz, &amplitude, NULL));
    printf("peak: %.3f Hz, %.5g mm; curve written to %s\n", peak_hz, amplitude, csv_path);
    return reason != PLM_REASON_RANGE_END;
}

/* ---- */

static int run(plm_context *ctx, const char *folder) {
    char path[path_size];
    ccx_dofs dofs;
    plate p = {0};
    plm_model *model;
#define IN_FOLDER(name) (snprintf(path, sizeof path, "%s/" name, folder), path)
    if (ccx_read_dofs(IN_FOLDER("matrices.dof"), &dofs)) return 1;
    int bad = plate_read(IN_FOLDER("plate.txt"), &dofs, &p);
    bad = bad || failed(ctx, plm_model_create(ctx, dofs.n_rows, &model)) ||
          set_matrix(ctx, model, PLM_STIFFNESS, IN_FOLDER("matrices.sti")) ||
          set_matrix(ctx, model, PLM_MASS, IN_FOLDER("matrices.mas")) || build_model(ctx, model, &p);
    if (!bad) {
        bad = compare(ctx, model, PLM_SYSTEM_OPEN, "open", IN_FOLDER("open.dat"));
        bad |= compare(ctx, model, PLM_SYSTEM_SLIDING, "closed", IN_FOLDER("closed.dat"));
        bad |= response(ctx, model, p.drive_row - 1, IN_FOLDER("curve.csv"));
    }
    ccx_free_dofs(&dofs);
    plate_free(&p);
    return bad;
}

int main(int argc, char **argv) {
    if (argc != 2 || strlen(argv[1]) > path_size - 32) {
        fprintf(stderr, "usage: calculix_response FOLDER (see README.md)\n");
        return 1;
    }
    plm_context *ctx = NULL;
    const int bad = failed(ctx, plm_context_create(PLM_API_VERSION, &ctx)) || run(ctx, argv[1]);
    return failed(ctx, plm_context_destroy(&ctx)) || bad;
}
