/* study_contact.c: how much of the contact is closed, over the cycle at the peak and along the curve. */
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "study.h"

enum { n_times = 256 };

/* Closed pairs over the period: their number at each of n_times instants, and its mean from the switching
 * instants. */
typedef struct cycle {
    int64_t at[n_times], least, most;
    double mean;
} cycle;

static int read_cycle(plm_branch *branch, int64_t point, int64_t n_pairs, cycle *k) {
    int32_t *closed = malloc((size_t)(n_pairs * n_times) * sizeof *closed);
    double *share = malloc((size_t)n_pairs * sizeof *share);
    const int bad = !closed || !share || plm_branch_get_contact(branch, point, n_times, NULL, NULL, closed) ||
                    plm_branch_get_closed_share(branch, point, n_pairs, share);
    memset(k, 0, sizeof *k);
    k->least = n_pairs;
    for (int64_t t = 0; t < n_times && !bad; t++) {
        for (int64_t p = 0; p < n_pairs; p++) k->at[t] += closed[t * n_pairs + p];
        if (k->at[t] < k->least) k->least = k->at[t];
        if (k->at[t] > k->most) k->most = k->at[t];
    }
    for (int64_t p = 0; p < n_pairs && !bad; p++) k->mean += share[p];
    free(closed);
    free(share);
    return bad;
}

static int write_cycle(FILE *file, const cycle *k, int64_t n_pairs) {
    fprintf(file, "time_fraction,closed_share\n");
    for (int64_t t = 0; t < n_times; t++)
        fprintf(file, "%.6f,%.6f\n", (double)t / n_times, (double)k->at[t] / (double)n_pairs);
    return study_close_file(file);
}

static int write_along(FILE *file, plm_branch *curve, int64_t n, int64_t n_pairs, const double *hz) {
    fprintf(file, "frequency_hz,closed_mean,closed_min,closed_max\n");
    for (int64_t i = 0; i < n; i++) {
        cycle k;
        if (read_cycle(curve, i, n_pairs, &k)) break;
        fprintf(file, "%.10g,%.6f,%" PRId64 ",%" PRId64 "\n", hz[i], k.mean, k.least, k.most);
    }
    return study_close_file(file);
}

static FILE *open_file(study_case *c, const char *what, const char *name) {
    char path[2 * STUDY_NAME];
    snprintf(path, sizeof path, "contact_%s_%s.csv", what, name);
    return study_open_file(c->options, path);
}

static int64_t highest(const double *value, int64_t n) {
    int64_t top = 0;
    for (int64_t i = 1; i < n; i++)
        if (value[i] > value[top]) top = i;
    return top;
}

int study_write_contact(study_case *c, plm_branch *curve, const char *name) {
    int64_t n = 0, count = 0;
    cycle peak;
    if (plm_branch_get_int(curve, "n_points", &n)) return 1;
    double *hz = malloc((size_t)n * sizeof *hz), *amplitude = malloc((size_t)n * sizeof *amplitude);
    int failed = !hz || !amplitude || plm_branch_get_array(curve, "frequency_hz", n, hz, &count) ||
                 plm_branch_get_amplitude(curve, c->scene->output_dof, PLM_HALF_PEAK_TO_PEAK, 0, n, amplitude,
                                          &count) ||
                 read_cycle(curve, highest(amplitude, n), c->scene->n_pairs, &peak);
    FILE *cycles = failed ? NULL : open_file(c, "cycle", name),
         *along = failed ? NULL : open_file(c, "curve", name);
    failed |= !cycles || !along;
    if (cycles) failed |= write_cycle(cycles, &peak, c->scene->n_pairs);
    if (along) failed |= write_along(along, curve, n, c->scene->n_pairs, hz);
    free(hz);
    free(amplitude);
    return failed;
}
