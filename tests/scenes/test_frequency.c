/* test_frequency.c: natural frequencies of a beam of bricks against beam theory. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "assembly.h"
#include "groups.h"

static const double pi = 3.14159265358979323846;
static const double length = 100, width = 4, height = 2; /* mm */
enum { BRICKS = 20, NODES = 4 * (BRICKS + 1), FREE = 3 * (NODES - 4) };

static void make_beam(const brick_material *mat, scene *s) {
    static const int step[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                   {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
    brick_mesh mesh;
    assert_int_equal(brick_mesh_create(NODES, BRICKS, &mesh), SCENE_OK);
    for (int n = 0; n < NODES; n++) {
        mesh.xyz[3 * n] = length * (n / 4) / BRICKS;
        mesh.xyz[3 * n + 1] = width * (n % 4 / 2);
        mesh.xyz[3 * n + 2] = height * (n % 2);
    }
    for (int e = 0; e < BRICKS; e++)
        for (int a = 0; a < 8; a++)
            mesh.brick[8 * e + a] = 4 * (e + step[a][0]) + 2 * step[a][1] + step[a][2];
    assert_int_equal(assemble_bricks(&mesh, mat, s), SCENE_OK);
    brick_mesh_free(&mesh);
}

/* All natural frequencies of the cantilever in Hz, ascending. */
static void beam_frequencies(const brick_material *mat, double *hz) {
    scene *s = calloc(1, sizeof *s);
    double *k = calloc(FREE * FREE, sizeof *k), *m = calloc(FREE * FREE, sizeof *m);
    double *work = malloc(40 * FREE * sizeof *work);
    assert_true(s && k && m && work);
    make_beam(mat, s);
    for (int col = 12; col < 12 + FREE; col++) /* the first four nodes are clamped */
        for (int64_t at = s->col_ptr[col]; at < s->col_ptr[col + 1]; at++)
            if (s->row[at] >= 12) {
                k[(col - 12) * FREE + s->row[at] - 12] = s->k[at];
                m[(col - 12) * FREE + s->row[at] - 12] = s->m[at];
            }
    const int type = 1, n = FREE, lwork = 40 * FREE;
    int info;
    dsygv_(&type, "N", "U", &n, k, &n, m, &n, hz, work, &lwork, &info);
    assert_int_equal(info, 0); /* also: the mass is positive definite */
    for (int i = 0; i < FREE; i++) hz[i] = sqrt(hz[i]) / (2 * pi);
    free(k);
    free(m);
    free(work);
    scene_destroy(&s);
}

/* Euler-Bernoulli frequency of a cantilever; `root` is 1.8751 for the first mode, 4.6941 for the second. */
static double beam_theory(const brick_material *mat, double root, double h) {
    return root * root / (2 * pi * length * length) * sqrt(mat->young * h * h / 12 / mat->density);
}

static void cantilever_bends_at_the_frequencies_of_beam_theory(void **state) {
    (void)state;
    const brick_material mat = {2e5, 0.3, 7.8e-9};
    double hz[FREE];
    beam_frequencies(&mat, hz);
    /* flat, then edgewise, then the second flat mode: 20 bricks of aspect ratio 5 : 4 : 2 */
    assert_true(fabs(hz[0] / beam_theory(&mat, 1.875104, height) - 1) < 0.01);
    assert_true(fabs(hz[1] / beam_theory(&mat, 1.875104, width) - 1) < 0.01);
    assert_true(fabs(hz[2] / beam_theory(&mat, 4.694091, height) - 1) < 0.01);
}

static void other_units_give_the_same_frequencies(void **state) {
    (void)state;
    /* the same beam with the modulus in another unit of force, and the density in the matching unit of mass
     */
    const brick_material steel = {2e5, 0.3, 7.8e-9}, scaled = {2e5 * 1e-3, 0.3, 7.8e-9 * 1e-3};
    double hz[FREE], other[FREE];
    beam_frequencies(&steel, hz);
    beam_frequencies(&scaled, other);
    for (int i = 0; i < 10; i++)
        assert_true(fabs(other[i] / hz[i] - 1) <
                    1e-5); /* a dense solver loses 1e-16 of the highest squared */
}

int run_frequency(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cantilever_bends_at_the_frequencies_of_beam_theory),
        cmocka_unit_test(other_units_give_the_same_frequencies),
    };
    return cmocka_run_group_tests_name("frequency", tests, NULL, NULL);
}
