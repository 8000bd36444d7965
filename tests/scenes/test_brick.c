/* test_brick.c: the element alone and in a patch. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "assembly.h"
#include "groups.h"

static const brick_material steel = {2e5, 0.3, 7.8e-9};

static const double cube[24] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 0, 1, 1, 0, 1, 1, 1, 1, 0, 1, 1};

/* A repeatable number between -1 and 1. */
static double jitter(int seed) {
    return sin(12.9898 * seed + 78.233 * cos(3.7 * seed));
}

static void distorted_brick(double xyz[24]) {
    for (int i = 0; i < 24; i++) xyz[i] = cube[i] + 0.15 * jitter(i + 1);
}

static void free_distorted_brick_has_exactly_six_rigid_modes(void **state) {
    (void)state;
    double xyz[24], k[24 * 24], m[64], w[24], work[200];
    const int n = 24, lwork = 200;
    int info;
    distorted_brick(xyz);
    assert_int_equal(brick_matrices(xyz, &steel, k, m), SCENE_OK);
    dsyev_("N", "U", &n, k, &n, w, work, &lwork, &info);
    assert_int_equal(info, 0);
    for (int i = 0; i < 6; i++) assert_true(fabs(w[i]) < 1e-13 * w[23]);
    assert_true(w[6] > 1e-3 * w[23]); /* rank 18: no zero-energy mode besides */
}

static void rigid_motions_cause_no_force(void **state) {
    (void)state;
    double xyz[24], k[24 * 24], m[64];
    distorted_brick(xyz);
    assert_int_equal(brick_matrices(xyz, &steel, k, m), SCENE_OK);
    for (int mode = 0; mode < 6; mode++) {
        double q[24] = {0};
        for (int a = 0; a < 8; a++) {
            const int i = mode % 3, j = (mode + 1) % 3;
            if (mode < 3) {
                q[3 * a + i] = 1;
            } else { /* rotation in the plane i, j */
                q[3 * a + i] = -xyz[3 * a + j];
                q[3 * a + j] = xyz[3 * a + i];
            }
        }
        for (int i = 0; i < 24; i++) {
            double f = 0;
            for (int j = 0; j < 24; j++) f += k[24 * i + j] * q[j];
            assert_true(fabs(f) < 1e-13 * 24 * k[0]);
        }
    }
}

static void mass_of_a_frustum_is_density_times_volume(void **state) {
    (void)state;
    double xyz[24], k[24 * 24], m[64], total = 0;
    for (int a = 0; a < 8; a++) { /* square frustum: sides 2 and 1, height 3 */
        const double side = a < 4 ? 2 : 1;
        xyz[3 * a] = side * (cube[3 * a] - 0.5);
        xyz[3 * a + 1] = side * (cube[3 * a + 1] - 0.5);
        xyz[3 * a + 2] = 3 * cube[3 * a + 2];
    }
    assert_int_equal(brick_matrices(xyz, &steel, k, m), SCENE_OK);
    for (int i = 0; i < 64; i++) total += m[i];
    assert_true(fabs(total / steel.density - 3.0 / 3 * (4 + 1 + 2)) < 1e-13);
}

static void matrices_are_symmetric_to_the_last_bit(void **state) {
    (void)state;
    double xyz[24], k[24 * 24], m[64];
    distorted_brick(xyz);
    assert_int_equal(brick_matrices(xyz, &steel, k, m), SCENE_OK);
    for (int i = 0; i < 24; i++)
        for (int j = 0; j < 24; j++) assert_true(k[24 * i + j] == k[24 * j + i]);
    for (int i = 0; i < 8; i++)
        for (int j = 0; j < 8; j++) assert_true(m[8 * i + j] == m[8 * j + i]);
}

/* Pure bending of a rectangular brick is answered with the beam's stiffness: what the incompatible modes are
 * for. */
static void pure_bending_does_not_lock(void **state) {
    (void)state;
    const brick_material mat = {1, 0, 1}; /* without Poisson's ratio beam theory is exact */
    const double length = 10, height = 1, width = 1, curvature = 1;
    double xyz[24], k[24 * 24], m[64], q[24] = {0}, energy = 0;
    for (int a = 0; a < 8; a++) {
        xyz[3 * a] = length * (cube[3 * a] - 0.5);
        xyz[3 * a + 1] = width * cube[3 * a + 1];
        xyz[3 * a + 2] = height * (cube[3 * a + 2] - 0.5);
        q[3 * a] = curvature * xyz[3 * a] *
                   xyz[3 * a + 2]; /* u = kappa x z; w = -kappa x^2 / 2 is the same at all corners */
    }
    assert_int_equal(brick_matrices(xyz, &mat, k, m), SCENE_OK);
    for (int i = 0; i < 24; i++)
        for (int j = 0; j < 24; j++) energy += 0.5 * q[i] * k[24 * i + j] * q[j];
    const double inertia = width * height * height * height / 12;
    assert_true(fabs(energy / (0.5 * inertia * curvature * curvature * length) - 1) < 1e-12);
}

enum { SIDE = 4, PATCH_NODES = SIDE * SIDE * SIDE };

static int patch_node(int i, int j, int k) {
    return (i * SIDE + j) * SIDE + k;
}

static int is_inner(int node) {
    const int i = node / (SIDE * SIDE), j = node / SIDE % SIDE, k = node % SIDE;
    return i > 0 && i < SIDE - 1 && j > 0 && j < SIDE - 1 && k > 0 && k < SIDE - 1;
}

/* 3 x 3 x 3 bricks whose nodes are all shifted, so that no face is plane. */
static void make_patch(brick_mesh *mesh) {
    assert_int_equal(brick_mesh_create(PATCH_NODES, 27, mesh), SCENE_OK);
    for (int node = 0; node < PATCH_NODES; node++) {
        const int at[3] = {node / (SIDE * SIDE), node / SIDE % SIDE, node % SIDE};
        for (int c = 0; c < 3; c++) mesh->xyz[3 * node + c] = at[c] + 0.2 * jitter(3 * node + c + 1);
    }
    int64_t *brick = mesh->brick;
    for (int e = 0; e < 27; e++)
        for (int a = 0; a < 8; a++)
            *brick++ = patch_node(e / 9 + (int)cube[3 * a], e / 3 % 3 + (int)cube[3 * a + 1],
                                  e % 3 + (int)cube[3 * a + 2]);
}

static void distorted_patch_reproduces_a_linear_field(void **state) {
    (void)state;
    brick_mesh mesh;
    scene s;
    memset(&s, 0, sizeof s);
    make_patch(&mesh);
    assert_int_equal(assemble_bricks(&mesh, &steel, &s), SCENE_OK);

    double q[3 * PATCH_NODES], a[24 * 24] = {0}, b[24] = {0};
    int place[3 * PATCH_NODES], n = 0;
    for (int node = 0; node < PATCH_NODES; node++)
        for (int c = 0; c < 3; c++) {
            const double *x = s.xyz + 3 * node;
            q[3 * node + c] =
                0.1 * (c + 1) + (0.3 - 0.2 * c) * x[0] + (0.1 + 0.3 * c) * x[1] + (0.2 * c * c - 0.4) * x[2];
            place[3 * node + c] = is_inner(node) ? n++ : -1;
        }
    assert_int_equal(n, 24);
    for (int col = 0; col < 3 * PATCH_NODES; col++)
        for (int64_t at = s.col_ptr[col]; at < s.col_ptr[col + 1]; at++) {
            const int row = place[s.row[at]];
            if (row >= 0 && place[col] >= 0)
                a[24 * place[col] + row] = s.k[at];
            else if (row >= 0)
                b[row] -= s.k[at] * q[col];
        }
    const int nrhs = 1;
    int info;
    dposv_("L", &n, &nrhs, a, &n, b, &n, &info);
    assert_int_equal(info, 0);
    for (int dof = 0; dof < 3 * PATCH_NODES; dof++)
        if (place[dof] >= 0) assert_true(fabs(b[place[dof]] - q[dof]) < 1e-12);

    brick_mesh_free(&mesh);
    scene *copy = malloc(sizeof *copy); /* scene_destroy() wants a scene from the heap */
    assert_non_null(copy);
    *copy = s;
    scene_destroy(&copy);
}

static void bad_bricks_are_refused(void **state) {
    (void)state;
    double xyz[24], k[24 * 24], m[64];
    memcpy(xyz, cube, sizeof xyz);
    for (int a = 0; a < 8; a++) xyz[3 * a] = -xyz[3 * a];
    assert_int_equal(brick_matrices(xyz, &steel, k, m), SCENE_ERR_ELEMENT);
    memset(xyz, 0, sizeof xyz);
    assert_int_equal(brick_matrices(xyz, &steel, k, m), SCENE_ERR_ELEMENT);

    const brick_material bad[] = {{0, 0.3, 1},   {1, 0.5, 1}, {1, -1, 1},      {1, 0.3, 0},
                                  {NAN, 0.3, 1}, {1, NAN, 1}, {INFINITY, 0, 1}};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        assert_int_equal(brick_material_check(&bad[i]), SCENE_ERR_ARGUMENT);
    assert_int_equal(brick_material_check(NULL), SCENE_ERR_ARGUMENT);
}

static void bad_meshes_are_refused(void **state) {
    (void)state;
    brick_mesh mesh;
    scene s;
    memset(&s, 0, sizeof s);
    assert_int_equal(brick_mesh_create(0, 1, &mesh), SCENE_ERR_ARGUMENT);
    assert_int_equal(brick_mesh_create(8, 0, &mesh), SCENE_ERR_ARGUMENT);
    assert_int_equal(brick_mesh_create(INT64_MAX, 1, &mesh), SCENE_ERR_ARGUMENT);
    assert_int_equal(brick_mesh_create(8, 1, NULL), SCENE_ERR_ARGUMENT);
    assert_int_equal(brick_mesh_create(8, 1, &mesh), SCENE_OK);
    mesh.brick[3] = 8;
    assert_int_equal(assemble_bricks(&mesh, &steel, &s), SCENE_ERR_ARGUMENT);
    mesh.brick[3] = -1;
    assert_int_equal(assemble_bricks(&mesh, &steel, &s), SCENE_ERR_ARGUMENT);
    assert_int_equal(assemble_bricks(NULL, &steel, &s), SCENE_ERR_ARGUMENT);
    assert_int_equal(assemble_bricks(&mesh, NULL, &s), SCENE_ERR_ARGUMENT);
    assert_int_equal(assemble_bricks(&mesh, &steel, NULL), SCENE_ERR_ARGUMENT);
    brick_mesh_free(&mesh);
    brick_mesh_free(NULL);
}

int run_brick(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(free_distorted_brick_has_exactly_six_rigid_modes),
        cmocka_unit_test(rigid_motions_cause_no_force),
        cmocka_unit_test(mass_of_a_frustum_is_density_times_volume),
        cmocka_unit_test(matrices_are_symmetric_to_the_last_bit),
        cmocka_unit_test(pure_bending_does_not_lock),
        cmocka_unit_test(distorted_patch_reproduces_a_linear_field),
        cmocka_unit_test(bad_bricks_are_refused),
        cmocka_unit_test(bad_meshes_are_refused),
    };
    return cmocka_run_group_tests_name("brick", tests, NULL, NULL);
}
