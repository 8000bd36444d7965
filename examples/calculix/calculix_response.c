/*
 * calculix_response.c: nonlinear forced response of a deck with contact whose finite elements are CalculiX's.
 *
 *     calculix_response FOLDER
 *
 * FOLDER holds what host_files.py and ccx made of a deck (run.sh does it all). The program hands ccx's
 * matrices and all that the deck says beside them to libplm, a record of model.txt for each call, prints
 * natural frequencies beside ccx's own where these are, and finds the response with nothing set:
 * FOLDER/curve.csv. Exit status 1 when anything fails or a frequency differs by more than 1e-6.
 */
#include <inttypes.h>
#include <math.h>
#include <plm/plm.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "ccx_files.h"

enum { n_compared = 10, most_rigid = 6, path_size = 4096 };
static const double agreement = 1e-6; /* ccx prints 7 digits: half a unit of the last one is up to 5e-7 */

typedef struct host {
    plm_context *ctx;
    plm_model *model;
    const char *folder;
    int64_t n_dof, output; /* rows of the model; the one that is looked at */
} host;

/* Prints the library's own words about a failure or an outcome; 1 for a failure. */
static int failed(plm_context *ctx, plm_status status) {
    char text[4096] = "";
    if (status == PLM_OK) return 0;
    if (status < 0 || status == PLM_WARNING) plm_context_get_error_text(ctx, sizeof text, text, NULL);
    if (!text[0]) plm_status_text(status, sizeof text, text, NULL);
    fprintf(stderr, "%s: %s\n", status < 0 ? "error" : "note", text);
    return status < 0;
}
#define TRY(call)                                                                                            \
    do {                                                                                                     \
        if (failed(h->ctx, (call))) return 1;                                                                \
    } while (0)

static const char *in_folder(const host *h, const char *name, char *path) {
    snprintf(path, path_size, "%s/%s", h->folder, name);
    return path;
}

/* ---- the model ---- */

/* ccx's matrix, and masses at nodes, which ccx leaves out of what it writes: entries of a row add up. */
static int set_matrix(const host *h, int32_t which, const char *name, const host_record *mass) {
    char path[path_size];
    ccx_matrix m;
    if (ccx_read_matrix(in_folder(h, name, path), mass ? mass->n_integers : 0, &m)) return 1;
    for (int64_t i = 0; mass && i < mass->n_integers; i++, m.n_entries++) {
        m.row[m.n_entries] = m.column[m.n_entries] = (int32_t)mass->integer[i] + 1;
        m.value[m.n_entries] = mass->real[i];
    }
    const plm_status status = plm_model_set_matrix_i32(h->model, which, PLM_TRIPLETS, PLM_UPPER, 1, PLM_COPY,
                                                       m.n_entries, m.row, m.column, m.value);
    ccx_free_matrix(&m);
    return failed(h->ctx, status);
}

/* Number of a harmonic part, NULL where it is zero. */
static const double *imaginary(const double *value, int64_t n) {
    for (int64_t i = 0; i < n; i++)
        if (value[i] != 0) return value;
    return NULL;
}

static int add_rigid_link(const host *h, const int64_t *i, const double *d) {
    const int32_t per_reference = (int32_t)i[0], per_dependent = (int32_t)i[2];
    const int64_t *reference = i + 3, *dependent = reference + per_reference;
    TRY(plm_model_add_rigid_link_i64(h->model, 0, per_reference, reference, d, i[1], per_dependent, dependent,
                                     d + 3));
    return 0;
}

static int add_distributing(const host *h, const int64_t *i, const double *d) {
    const int32_t per_reference = (int32_t)i[0];
    const int64_t n = i[1], *reference = i + 2;
    TRY(plm_model_add_distributing_coupling_i64(h->model, 0, per_reference, reference, d, n,
                                                reference + per_reference, d + 3, d + 3 + 3 * n));
    return 0;
}

static int add_tie(const host *h, const int64_t *i, const double *d) {
    const int64_t n = i[0], n_surface = i[1], n_faces = i[2];
    const int64_t *dof = i + 3, *surface_dof = dof + 3 * n, *start = surface_dof + 3 * n_surface;
    TRY(plm_model_add_tie_i64(h->model, 0, n, dof, d + 1, n_surface, surface_dof, d + 1 + 3 * n, n_faces,
                              start, start + n_faces + 1, d[0], NULL));
    return 0;
}

static int add_surface(const host *h, const int64_t *i, const double *d) {
    const int64_t n = i[0], n_faces = i[1], *dof = i + 3, *start = dof + 3 * n;
    int64_t number; /* as host_files.py counted */
    TRY(plm_model_add_surface_i64(h->model, 0, n, dof, d, i[2] ? d + 3 * n : NULL, n_faces,
                                  n_faces ? start : NULL, n_faces ? start + n_faces + 1 : NULL, &number));
    return 0;
}

static int add_contact(const host *h, const int64_t *i, const double *d) {
    const int32_t options = (i[2] ? PLM_SURFACE_POINTS : 0) + (i[3] ? PLM_SURFACE_SYMMETRIC : 0) +
                            (i[4] ? PLM_SURFACE_SMOOTH : 0);
    TRY(plm_model_add_surface_contact(h->model, i[0], i[1], options, i[5] ? PLM_AUTO_STIFFNESS : d[0], d[1],
                                      d[2]));
    return 0;
}

/* One record of model.txt, which is one call. */
static int tell(host *h, const host_record *r) {
    const int64_t *i = r->integer;
    const double *d = r->real;
    const int64_t half = r->n_reals / 2;
#define IS(name) (strcmp(r->word, name) == 0)
    if (IS("rigid_link")) return add_rigid_link(h, i, d);
    if (IS("distributing")) return add_distributing(h, i, d);
    if (IS("tie")) return add_tie(h, i, d);
    if (IS("surface")) return add_surface(h, i, d);
    if (IS("contact")) return add_contact(h, i, d);
    if (IS("output")) {
        h->output = i[0];
        return 0;
    }
    if (IS("rayleigh"))
        TRY(plm_model_set_rayleigh_damping(h->model, d[0], d[1]));
    else if (IS("modal_damping"))
        TRY(plm_model_set_modal_damping(h->model, r->n_reals, d));
    else if (IS("fix"))
        TRY(plm_model_fix_dofs_i64(h->model, 0, r->n_integers, i));
    else if (IS("constraints"))
        TRY(plm_model_add_constraints_i64(h->model, 0, i[0], i + 1, i + 2 + i[0], d));
    else if (IS("coordinates"))
        TRY(plm_model_set_coordinates_i64(h->model, 0, i[0], (int32_t)i[1], i + 2, d));
    else if (IS("base_motion"))
        TRY(plm_model_set_base_motion(h->model, (int32_t)i[0], 1, half, d, imaginary(d + half, half)));
    else if (IS("preload"))
        TRY(plm_model_set_preload(h->model, r->n_reals, d));
    else if (IS("excitation"))
        TRY(plm_model_set_excitation(h->model, 1, half, d, imaginary(d + half, half)));
    else {
        fprintf(stderr, "model.txt: a record \"%s\" is not known\n", r->word);
        return 1;
    }
    return 0;
#undef IS
}

/* The first record says how many rows the model has, masses come before all others. */
static int read_model(host *h, FILE *file, host_record *r) {
    int end = 0, has_matrices = 0;
    if (host_read_record(file, r, &end)) return 1;
    if (end || strcmp(r->word, "size") != 0) {
        fprintf(stderr, "model.txt does not begin with its size\n");
        return 1;
    }
    h->n_dof = r->integer[0];
    TRY(plm_model_create(h->ctx, h->n_dof, &h->model));
    if (set_matrix(h, PLM_STIFFNESS, "matrices.sti", NULL)) return 1;
    while (!host_read_record(file, r, &end)) {
        if (end) return 0;
        const int is_mass = strcmp(r->word, "mass") == 0;
        if (!has_matrices && set_matrix(h, PLM_MASS, "matrices.mas", is_mass ? r : NULL)) return 1;
        has_matrices = 1;
        if (!is_mass && tell(h, r)) return 1;
    }
    return 1;
}

static int build_model(host *h) {
    char path[path_size];
    host_record record = {"", 0, 0, NULL, NULL};
    FILE *file = fopen(in_folder(h, "model.txt", path), "r");
    if (!file) {
        perror(path);
        return 1;
    }
    const int bad = read_model(h, file, &record);
    host_free_record(&record);
    fclose(file);
    if (bad) return 1;
    TRY(plm_model_build(h->model));
    TRY(plm_model_solve_rest(h->model));
    int64_t n_pairs, n_closed;
    TRY(plm_model_get_int(h->model, "n_pairs", &n_pairs));
    TRY(plm_model_get_int(h->model, "rest_n_closed", &n_closed));
    printf("%" PRId64 " DOFs, %" PRId64 " contact pairs, %" PRId64 " of them closed at rest\n", h->n_dof,
           n_pairs, n_closed);
    return 0;
}

/* ---- what comes of it ---- */

/* Frequencies beside ccx's; rigid motions, which Lanczos finds anywhere near 0, are passed over. */
static int compare(host *h, int32_t system, const char *name, const char *dat) {
    double ccx[n_compared + most_rigid], plm[n_compared + most_rigid], largest = 0;
    char path[path_size];
    int64_t rigid = 0;
    FILE *there = fopen(in_folder(h, dat, path), "r");
    if (!there) {
        printf("\n%s: no %s, nothing to compare with\n", name, dat);
        return 0;
    }
    fclose(there);
    if (ccx_read_frequencies(path, n_compared + most_rigid, ccx)) return 1;
    TRY(plm_model_get_modes(h->model, system, NULL, n_compared + most_rigid, plm, NULL));
    while (rigid < most_rigid && plm[rigid] < 1e-3 * plm[most_rigid]) rigid++;
    printf("\n%-8s mode       ccx (Hz)    libplm (Hz)  relative difference\n", name);
    for (int64_t i = rigid; i < rigid + n_compared; i++) {
        const double difference = fabs(plm[i] / ccx[i] - 1);
        printf("%-8s %4" PRId64 " %14.7g %14.9g  %.1e\n", name, i + 1, ccx[i], plm[i], difference);
        if (!(difference <= largest)) largest = difference;
    }
    if (largest <= agreement) return 0;
    fprintf(stderr, "%s: frequencies differ by %.1e, more than %.0e\n", name, largest, agreement);
    return 1;
}

static int response(host *h) {
    static char page[16384];
    char path[path_size];
    plm_branch *curve;
    double hz, amplitude, error;
    TRY(plm_model_compute_response(h->model, h->output, PLM_HALF_PEAK_TO_PEAK, 1e-3, &hz, &amplitude, &error,
                                   &curve, NULL));
    TRY(plm_branch_write_csv(curve, h->output, PLM_HALF_PEAK_TO_PEAK, 0, in_folder(h, "curve.csv", path)));
    TRY(plm_branch_describe(curve, sizeof page, page, NULL));
    printf("\n%s\npeak: %.6g Hz, %.6g, within %.1e; curve written to %s\n", page, hz, amplitude, error, path);
    return 0;
}

int main(int argc, char **argv) {
    host h = {NULL, NULL, NULL, 0, 0};
    if (argc != 2 || strlen(argv[1]) > path_size - 32) {
        fprintf(stderr, "usage: calculix_response FOLDER (see README.md)\n");
        return 1;
    }
    h.folder = argv[1];
    int bad = failed(h.ctx, plm_context_create(PLM_API_VERSION, &h.ctx)) || build_model(&h);
    if (!bad) {
        bad = compare(&h, PLM_SYSTEM_OPEN, "open", "open.dat");
        bad |= compare(&h, PLM_SYSTEM_SLIDING, "closed", "closed.dat");
        bad |= response(&h);
    }
    return failed(h.ctx, plm_context_destroy(&h.ctx)) || bad; /* with every handle that is left in it */
}
