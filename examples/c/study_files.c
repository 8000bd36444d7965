/* study_files.c: the CSV files, for plot_study.py or a spreadsheet. */
#define _POSIX_C_SOURCE 200809L /* mkdir */
#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "study.h"

enum { path_size = 4096, n_times = 256 };

int study_make_folder(const char *path) {
    if (mkdir(path, 0777) == 0 || errno == EEXIST) return 0;
    fprintf(stderr, "%s: %s\n", path, strerror(errno));
    return 1;
}

static FILE *open_file(const study_options *o, const char *start, const char *name) {
    char path[path_size];
    snprintf(path, sizeof path, "%s/%s%s.csv", o->output, start, name);
    FILE *file = fopen(path, "w");
    if (!file) fprintf(stderr, "%s: %s\n", path, strerror(errno));
    return file;
}

static int close_file(FILE *file) {
    const int failed = ferror(file) != 0;
    return (fclose(file) != 0) | failed;
}

/* Closed pairs over the period: their number at each of n_times instants, and its mean from the switching
 * instants. */
typedef struct cycle {
    int64_t at[n_times], least, most;
    double mean;
} cycle;

static int read_cycle(plm_branch *branch, int64_t point, int64_t n_pairs, cycle *c) {
    int32_t *closed = malloc((size_t)(n_pairs * n_times) * sizeof *closed);
    double *share = malloc((size_t)n_pairs * sizeof *share);
    const int bad = !closed || !share || plm_branch_get_contact(branch, point, n_times, NULL, NULL, closed) ||
                    plm_branch_get_closed_share(branch, point, n_pairs, share);
    memset(c, 0, sizeof *c);
    c->least = n_pairs;
    for (int64_t t = 0; t < n_times && !bad; t++) {
        for (int64_t p = 0; p < n_pairs; p++) c->at[t] += closed[t * n_pairs + p];
        if (c->at[t] < c->least) c->least = c->at[t];
        if (c->at[t] > c->most) c->most = c->at[t];
    }
    for (int64_t p = 0; p < n_pairs && !bad; p++) c->mean += share[p];
    free(closed);
    free(share);
    return bad;
}

/* Columns of a curve, one value per point. */
typedef struct columns {
    int64_t n, *iterations;
    double *hz, *amplitude, *arclength, *residual;
} columns;

static int read_columns(plm_branch *b, int64_t dof, columns *c) {
    int64_t n = 0, count;
    if (plm_branch_get_int(b, "n_points", &n)) return 1;
    const size_t bytes = (size_t)n * sizeof(double);
    c->n = n;
    c->iterations = malloc((size_t)n * sizeof *c->iterations);
    c->hz = malloc(bytes);
    c->amplitude = malloc(bytes);
    c->arclength = malloc(bytes);
    c->residual = malloc(bytes);
    return !c->iterations || !c->hz || !c->amplitude || !c->arclength || !c->residual ||
           plm_branch_get_array(b, "frequency_hz", n, c->hz, &count) ||
           plm_branch_get_array(b, "arclength", n, c->arclength, &count) ||
           plm_branch_get_array(b, "residual", n, c->residual, &count) ||
           plm_branch_get_int_array(b, "iterations", n, c->iterations, &count) ||
           plm_branch_get_amplitude(b, dof, PLM_HALF_PEAK_TO_PEAK, 0, n, c->amplitude, &count);
}

static int write_points(FILE *file, plm_branch *curve, int64_t n_pairs, const columns *c) {
    fprintf(
        file,
        "frequency_hz,amplitude,arclength,closed_mean,closed_min,closed_max,newton_iterations,residual\n");
    for (int64_t i = 0; i < c->n; i++) {
        cycle contact;
        if (read_cycle(curve, i, n_pairs, &contact)) return 1;
        fprintf(file, "%.15g,%.15g,%.15g,%.6f,%" PRId64 ",%" PRId64 ",%" PRId64 ",%.3e\n", c->hz[i],
                c->amplitude[i], c->arclength[i], contact.mean, contact.least, contact.most, c->iterations[i],
                c->residual[i]);
    }
    return 0;
}

int study_write_curve(study *s, const study_method *m, plm_branch *curve) {
    columns c = {0, NULL, NULL, NULL, NULL, NULL};
    FILE *file = open_file(s->options, "curves_", m->name);
    int failed = !file || read_columns(curve, s->scene->output_dof, &c);
    if (!failed) failed = write_points(file, curve, s->scene->n_pairs, &c);
    if (file) failed |= close_file(file);
    free(c.iterations);
    free(c.hz);
    free(c.amplitude);
    free(c.arclength);
    free(c.residual);
    return failed;
}

int study_write_cycle(study *s, const study_method *m, plm_branch *peak) {
    cycle contact;
    FILE *file = open_file(s->options, "contact_", m->name);
    if (!file) return 1;
    const int failed = read_cycle(peak, 0, s->scene->n_pairs, &contact);
    fprintf(file, "time_fraction,closed_pairs,closed_share\n");
    for (int64_t t = 0; t < n_times && !failed; t++)
        fprintf(file, "%.6f,%" PRId64 ",%.6f\n", (double)t / n_times, contact.at[t],
                (double)contact.at[t] / (double)s->scene->n_pairs);
    return close_file(file) | failed;
}

/* Text as a CSV field: quoted, quotes doubled. */
static void put_text(FILE *file, const char *text) {
    fputc('"', file);
    for (; *text; text++) {
        if (*text == '"') fputc('"', file);
        fputc(*text == '\n' ? ' ' : *text, file);
    }
    fputc('"', file);
}

int study_write_table(const study_options *o, const study_result *result, int32_t n) {
    FILE *file = open_file(o, "table", "");
    if (!file) return 1;
    fprintf(file,
            "method,samples,contact_sets,collected_vectors,basis_size,setup_seconds,seconds_per_iteration,"
            "curve_seconds,points,newton_iterations,peak_hz,peak_amplitude,error_frequency,error_amplitude,"
            "full_residual,unknowns,end,warning,error\n");
    for (int32_t i = 0; i < n; i++) {
        const study_result *r = &result[i];
        fprintf(file,
                "%s,%" PRId64 ",%" PRId64 ",%" PRId64 ",%" PRId64 ",%.6g,%.6g,%.6g,%" PRId64 ",%" PRId64,
                r->method.name, r->method.n_samples, r->contact_sets, r->n_collected, r->basis_size,
                r->setup_seconds, r->iteration_seconds, r->curve_seconds, r->n_points, r->newton_iterations);
        fprintf(file, ",%.15g,%.15g,%.3e,%.3e,%.3e,%s,", r->peak_hz, r->peak_amplitude, r->error_hz,
                r->error_amplitude, r->full_residual, r->unknowns);
        put_text(file, r->end);
        fputc(',', file);
        put_text(file, r->warning);
        fputc(',', file);
        put_text(file, r->error);
        fputc('\n', file);
    }
    return close_file(file);
}

int study_write_facts(study *s) {
    const study_options *o = s->options;
    double low = 0, high = 0;
    FILE *file = open_file(o, "study", "");
    if (!file) return 1;
    plm_sampler_get_double(s->sampler, "window_low_hz", &low);
    plm_sampler_get_double(s->sampler, "window_high_hz", &high);
    fprintf(file, "key,value\nscene,%s\nsize,%s\npreload,%d\nharmonics,%" PRId64 "\n", o->scene, o->size,
            o->with_preload, o->n_harmonics);
    fprintf(file, "n_dof,%" PRId64 "\nn_pairs,%" PRId64 "\n", s->scene->n_dof, s->scene->n_pairs);
    fprintf(file, "window_low_hz,%.15g\nwindow_high_hz,%.15g\ncontact_space_seconds,%.6g\n", low, high,
            s->contact_space);
    return close_file(file);
}
