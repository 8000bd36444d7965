/* ccx_files.c: see ccx_files.h. */
#include "ccx_files.h"

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

int ccx_read_matrix(const char *path, ccx_matrix *matrix) {
    FILE *file = open_file(path);
    if (!file) return 1;
    const int64_t n = count_lines(file);
    ccx_matrix m = {n, malloc((size_t)n * sizeof *m.row), malloc((size_t)n * sizeof *m.column),
                    malloc((size_t)n * sizeof *m.value)};
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

/* Reads "node.direction"; 0 at the end of the file and for anything else. */
static int read_dof(FILE *file, int32_t *node, int32_t *direction) {
    return fscanf(file, "%d.%d", node, direction) == 2 && *node >= 1 && *direction >= 1 && *direction <= 3;
}

int ccx_read_dofs(const char *path, ccx_dofs *dofs) {
    FILE *file = open_file(path);
    if (!file) return 1;
    int32_t node, direction;
    ccx_dofs d = {0, 0, NULL};
    while (read_dof(file, &node, &direction)) {
        d.n_rows++;
        if (node > d.n_nodes) d.n_nodes = node;
    }
    const int read_all = feof(file) && d.n_rows > 0;
    rewind(file);
    if (read_all) d.row = calloc(3 * (size_t)d.n_nodes, sizeof *d.row);
    if (d.row)
        for (int32_t row = 1; read_dof(file, &node, &direction); row++)
            d.row[3 * (node - 1) + direction - 1] = row;
    fclose(file);
    if (!d.row) return fail(path, "is not a list of \"node.direction\", or memory is short");
    *dofs = d;
    return 0;
}

void ccx_free_dofs(ccx_dofs *dofs) {
    free(dofs->row);
    memset(dofs, 0, sizeof *dofs);
}

int32_t ccx_row(const ccx_dofs *dofs, int32_t node, int32_t direction) {
    if (node < 1 || node > dofs->n_nodes || direction < 1 || direction > 3) return 0;
    return dofs->row[3 * (node - 1) + direction - 1];
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
