#include "lattice.h"
#include <math.h>
#include <stdlib.h>

/* half of the 26 neighbours of a mass; the others see it as theirs */
static const int step[13][3] = {{1, 0, 0},  {0, 1, 0},  {0, 0, 1},  {1, 1, 0},  {1, -1, 0},
                                {1, 0, 1},  {1, 0, -1}, {0, 1, 1},  {0, 1, -1}, {1, 1, 1},
                                {1, 1, -1}, {1, -1, 1}, {1, -1, -1}};

typedef struct {
    int64_t count;
    int32_t *row, *column;
    double *value;
} triplets;

static void put(triplets *t, int32_t row, int32_t column, double value) {
    if (row < column || value == 0) return; /* the lower triangle */
    t->row[t->count] = row, t->column[t->count] = column, t->value[t->count++] = value;
}

/* a spring of 1e5 N/m over the distance between masses p and q */
static void join(triplets *t, int32_t p, int32_t q, const int *s) {
    const double square = s[0] * s[0] + s[1] * s[1] + s[2] * s[2];
    int a, b;
    for (a = 0; a < 3; ++a)
        for (b = 0; b < 3; ++b) {
            const double k = 1e5 * s[a] * s[b] / (square * sqrt(square));
            put(t, 3 * p + a, 3 * p + b, k), put(t, 3 * q + a, 3 * q + b, k);
            put(t, 3 * p + a, 3 * q + b, -k), put(t, 3 * q + a, 3 * p + b, -k);
        }
}

static void fill(triplets *t, int n) {
    int x, y, z, k;
    for (z = 0; z < n; ++z)
        for (y = 0; y < n; ++y)
            for (x = 0; x < n; ++x)
                for (k = 0; k < 13; ++k) {
                    const int u = x + step[k][0], v = y + step[k][1], w = z + step[k][2];
                    if (u < n && v >= 0 && v < n && w >= 0 && w < n)
                        join(t, (z * n + y) * n + x, (w * n + v) * n + u, step[k]);
                }
}

static plm_status matrices(plm_model *model, int n, triplets *t) {
    const int32_t dofs = 3 * n * n * n;
    int32_t j;
    plm_status s;
    t->count = 0;
    fill(t, n);
    s = plm_model_set_matrix_i32(model, PLM_STIFFNESS, PLM_TRIPLETS, PLM_LOWER, 0, PLM_COPY, t->count, t->row,
                                 t->column, t->value);
    for (j = 0; j < dofs; ++j) t->row[j] = t->column[j] = j, t->value[j] = 1e-3;
    return s ? s
             : plm_model_set_matrix_i32(model, PLM_MASS, PLM_TRIPLETS, PLM_LOWER, 0, PLM_COPY, dofs, t->row,
                                        t->column, t->value);
}

static plm_status supports_and_contact(plm_model *model, int n, triplets *t) {
    const int32_t corner = 3 * n * n * n - 2;
    int64_t fixed = 0;
    const int32_t row_ptr[2] = {0, 1};
    const double one[1] = {1}, stop[1] = {1e5};
    int k, c;
    plm_status s;
    for (k = 0; k < n * n; ++k)
        for (c = 0; c < 3; ++c) t->row[fixed++] = 3 * k * n + c;
    s = plm_model_fix_dofs_i32(model, 0, fixed, t->row);
    return s ? s : plm_model_add_gap_rows_i32(model, 0, 1, row_ptr, &corner, one, stop, NULL);
}

plm_status lattice_built(plm_context *ctx, int side, plm_model **model) {
    const int64_t masses = (int64_t)side * side * side, room = masses * 13 * 21;
    triplets t;
    plm_status s = plm_model_create(ctx, 3 * masses, model);
    t.row = (int32_t *)malloc((size_t)room * sizeof *t.row);
    t.column = (int32_t *)malloc((size_t)room * sizeof *t.column);
    t.value = (double *)malloc((size_t)room * sizeof *t.value);
    if (!s) s = t.row && t.column && t.value ? PLM_OK : PLM_ERR_MEMORY;
    if (!s) s = matrices(*model, side, &t);
    if (!s) s = supports_and_contact(*model, side, &t);
    if (!s) s = plm_model_build(*model);
    free(t.row), free(t.column), free(t.value);
    return s;
}

plm_status lattice_modes(plm_context *ctx, int side, double *hz) {
    plm_model *model = NULL;
    plm_status s = lattice_built(ctx, side, &model);
    if (!s) s = plm_model_get_modes(model, PLM_SYSTEM_OPEN, NULL, 3, hz, NULL);
    plm_model_destroy(&model);
    return s;
}
