/* test_preload.c: which pairs the pre-load of the quick scenes closes at rest, by dense unilateral statics.
 */
#include <math.h>
#include <stdlib.h>

#include "cracked_plate.h"
#include "groups.h"

enum { MOST_PAIRS = 40 };

/* The contact flexibility B K^-1 B' (Z x Z) and the penetration B K^-1 p without contact forces. */
typedef struct gaps {
    int n_pairs;
    double flexibility[MOST_PAIRS * MOST_PAIRS], penetration[MOST_PAIRS];
} gaps;

/* Numbers the free DOFs from 0; fixed ones get -1. Returns how many are free; release *place with free(). */
static int number_free(const scene *s, int **place) {
    int n = 0;
    *place = calloc((size_t)s->n_dof, sizeof **place);
    assert_non_null(*place);
    for (int64_t f = 0; f < s->n_fixed; f++) (*place)[s->fixed[f]] = -1;
    for (int64_t dof = 0; dof < s->n_dof; dof++)
        if ((*place)[dof] == 0) (*place)[dof] = n++;
    return n;
}

/* Row p of B as a column of free DOFs: weight +1 on side a, -1 on side b. */
static void gap_row(const scene *s, const int *place, int p, double *column) {
    for (int c = 0; c < 3; c++) {
        const int a = place[s->dof_a[3 * p + c]], b = place[s->dof_b[3 * p + c]];
        if (a >= 0) column[a] += s->normal[3 * p + c];
        if (b >= 0) column[b] -= s->normal[3 * p + c];
    }
}

static void solve_gaps(const scene *s, gaps *g) {
    int *place, info;
    const int n = number_free(s, &place), z = (int)s->n_pairs, nrhs = z + 1;
    const size_t rows = (size_t)n;
    double *k = calloc(rows * rows, sizeof *k), *b = calloc(rows * (size_t)z, sizeof *b);
    double *x = calloc(rows * (size_t)nrhs, sizeof *x);
    assert_true(k && b && x && z <= MOST_PAIRS);
    for (int64_t col = 0; col < s->n_dof; col++)
        for (int64_t at = s->col_ptr[col]; place[col] >= 0 && at < s->col_ptr[col + 1]; at++)
            if (place[s->row[at]] >= 0) k[(size_t)place[col] * rows + (size_t)place[s->row[at]]] = s->k[at];
    for (int p = 0; p < z; p++) {
        gap_row(s, place, p, b + (size_t)p * rows);
        gap_row(s, place, p, x + (size_t)p * rows);
    }
    for (int64_t dof = 0; dof < s->n_dof; dof++)
        if (place[dof] >= 0) x[(size_t)z * rows + (size_t)place[dof]] = s->preload[dof];
    dposv_("L", &n, &nrhs, k, &n, x, &n, &info);
    assert_int_equal(info, 0);

    g->n_pairs = z;
    for (int p = 0; p < z; p++)
        for (int j = 0; j < nrhs; j++) {
            double sum = 0;
            for (size_t i = 0; i < rows; i++) sum += b[(size_t)p * rows + i] * x[(size_t)j * rows + i];
            if (j < z)
                g->flexibility[p * z + j] = sum;
            else
                g->penetration[p] = sum;
        }
    free(place);
    free(k);
    free(b);
    free(x);
}

static int ascending(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double local_stiffness(const gaps *g) {
    double diagonal[MOST_PAIRS];
    for (int p = 0; p < g->n_pairs; p++) diagonal[p] = g->flexibility[p * g->n_pairs + p];
    qsort(diagonal, (size_t)g->n_pairs, sizeof *diagonal, ascending);
    return 1 / diagonal[g->n_pairs / 2];
}

/* Solves u = u_0 - C N, N = max(k_n u, 0) by changing the set of closed pairs until it stays; returns the
 * closed set. */
static int closed_at_rest(const gaps *g, double stiffness, int *closed, double *u) {
    const int z = g->n_pairs, nrhs = 1;
    double a[MOST_PAIRS * MOST_PAIRS];
    int pivots[MOST_PAIRS], info, changed = 1, count = 0;
    for (int p = 0; p < z; p++) closed[p] = g->penetration[p] > 0;
    for (int step = 0; changed && step < 100; step++) {
        for (int j = 0; j < z; j++) {
            u[j] = g->penetration[j];
            for (int i = 0; i < z; i++)
                a[j * z + i] = (i == j) + g->flexibility[i * z + j] * (closed[j] ? stiffness : 0);
        }
        dgesv_(&z, &nrhs, a, &z, pivots, u, &z, &info);
        assert_int_equal(info, 0);
        changed = count = 0;
        for (int p = 0; p < z; p++) {
            changed |= closed[p] != (u[p] > 0);
            closed[p] = u[p] > 0;
            count += closed[p];
        }
    }
    assert_false(changed);
    return count;
}

static void the_plate_rests_on_the_row_next_to_the_front(void **state) {
    (void)state;
    scene *s = NULL;
    gaps g;
    int closed[MOST_PAIRS];
    double u[MOST_PAIRS];
    assert_int_equal(scene_create("cracked_plate", "quick", 1, &s), SCENE_OK);
    solve_gaps(s, &g);
    assert_int_equal(closed_at_rest(&g, s->contact_stiffness[0], closed, u), 3); /* 10 of 90 at paper size */
    for (int64_t p = 0; p < s->n_pairs; p++) assert_int_equal(closed[p], s->xyz[s->dof_a[3 * p] + 1] == 36);
    scene_destroy(&s);
}

static void end_compression_closes_the_whole_crack(void **state) {
    (void)state;
    scene *s = NULL;
    gaps g;
    int closed[MOST_PAIRS];
    double u[MOST_PAIRS];
    cracked_plate_params p;
    cracked_plate_quick(&p);
    p.with_preload = 1;
    p.n_loads = 0;
    p.end_compression = 1000;
    assert_int_equal(cracked_plate_create(&p, &s), SCENE_OK);
    solve_gaps(s, &g);
    assert_int_equal(closed_at_rest(&g, 10 * local_stiffness(&g), closed, u), 15);
    scene_destroy(&s);
}

static void radial_forces_close_all_pairs_of_the_cylinders(void **state) {
    (void)state;
    scene *s = NULL;
    gaps g;
    int closed[MOST_PAIRS];
    double u[MOST_PAIRS];
    assert_int_equal(scene_create("coaxial_cylinders", "quick", 1, &s), SCENE_OK);
    solve_gaps(s, &g);
    assert_int_equal(closed_at_rest(&g, 10 * local_stiffness(&g), closed, u), 32);
    scene_destroy(&s);
}

int run_preload(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_plate_rests_on_the_row_next_to_the_front),
        cmocka_unit_test(end_compression_closes_the_whole_crack),
        cmocka_unit_test(radial_forces_close_all_pairs_of_the_cylinders),
    };
    return cmocka_run_group_tests_name("preload", tests, NULL, NULL);
}
