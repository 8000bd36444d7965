/* ccx_files.c: see ccx_files.h. */
#include "ccx_files.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int fail(const char *path, const char *why) {
    fprintf(stderr, "%s: %s\n", path, why);
    return 1;
}

static FILE *open_file(const char *path) {
    FILE *file = fopen(path, "r");
    if (!file) fail(path, "cannot be opened (did ccx run in this folder?)");
    return file;
}

/* Lines of the file, which is left at its beginning. */
static int64_t count_lines(FILE *file) {
    int64_t n = 0;
    for (int c = getc(file); c != EOF; c = getc(file)) n += c == '\n';
    rewind(file);
    return n;
}

int ccx_read_matrix(const char *path, int64_t n_more, ccx_matrix *matrix) {
    FILE *file = open_file(path);
    if (!file) return 1;
    const int64_t n = count_lines(file);
    const size_t room = (size_t)(n + n_more);
    ccx_matrix m = {n, malloc(room * sizeof *m.row), malloc(room * sizeof *m.column),
                    malloc(room * sizeof *m.value)};
    int64_t i = 0;
    if (m.row && m.column && m.value)
        while (i < n && fscanf(file, "%d %d %lf", &m.row[i], &m.column[i], &m.value[i]) == 3) i++;
    fclose(file);
    if (n > 0 && i == n) {
        *matrix = m;
        return 0;
    }
    ccx_free_matrix(&m);
    return fail(path, "is not a list of \"row column value\", or memory is short");
}

void ccx_free_matrix(ccx_matrix *matrix) {
    free(matrix->row);
    free(matrix->column);
    free(matrix->value);
    memset(matrix, 0, sizeof *matrix);
}

int host_read_record(FILE *file, host_record *record, int *end) {
    host_record r = {"", 0, 0, NULL, NULL};
    int64_t i = 0, j = 0;
    host_free_record(record);
    const int found = fscanf(file, "%31s %" SCNd64 " %" SCNd64, r.word, &r.n_integers, &r.n_reals);
    *end = found == EOF;
    if (*end) return 0;
    if (found == 3 && r.n_integers >= 0 && r.n_reals >= 0) {
        r.integer = malloc((size_t)(r.n_integers + 1) * sizeof *r.integer);
        r.real = malloc((size_t)(r.n_reals + 1) * sizeof *r.real);
        if (r.integer && r.real) {
            while (i < r.n_integers && fscanf(file, "%" SCNd64, &r.integer[i]) == 1) i++;
            while (j < r.n_reals && fscanf(file, "%lf", &r.real[j]) == 1) j++;
        }
    }
    *record = r;
    if (found == 3 && i == r.n_integers && j == r.n_reals) return 0;
    host_free_record(record);
    return fail("model.txt", "is not as host_files.py writes it, or memory is short");
}

void host_free_record(host_record *record) {
    free(record->integer);
    free(record->real);
    memset(record, 0, sizeof *record);
}

int ccx_read_frequencies(const char *path, int32_t n, double *frequency_hz) {
    FILE *file = open_file(path);
    if (!file) return 1;
    char line[256];
    int32_t found = 0, mode;
    double eigenvalue, omega, hz;
    while (found < n &&
           fgets(line, sizeof line, file)) /* mode, (rad/time)^2, rad/time, cycles/time, imaginary part */
        if (sscanf(line, "%d %lf %lf %lf", &mode, &eigenvalue, &omega, &hz) == 4 && mode == found + 1)
            frequency_hz[found++] = hz;
    fclose(file);
    return found == n ? 0 : fail(path, "holds too few natural frequencies");
}
