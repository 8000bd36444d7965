/* Couplings from coordinates: misuse of every kind is refused with argument, index and what to do, and
 * changes nothing; what is right has as many constraints as it should. */
#include "check.h"
#include <math.h>

static plm_context *ctx;
static plm_model *model;

static int set_up(void **state) {
    (void)state;
    return plm_context_create(PLM_API_VERSION, &ctx) || plm_model_create(ctx, 24, &model);
}
static int tear_down(void **state) {
    (void)state;
    return plm_context_destroy(&ctx);
}

#define BAD(call, function, argument, index, words)                                                          \
    assert_true(refused(ctx, call, PLM_ERR_ARGUMENT, function, argument, index, words))

static const int32_t hub[] = {0, 1, 2, 3, 4, 5}, rim[] = {6, 7, 8, 9, 10, 11, 12, 13, 14},
                     none[] = {-1, -1, -1}, outside[] = {6, 7, 8, 9, 10, 24},
                     repeated[] = {6, 7, 8, 9, 10, 6}, of_hub[] = {6, 7, 8, 9, 10, 5},
                     gone[] = {6, 7, 8, -1, -1, -1};
static const int64_t hub64[] = {1, 2, 3, 4, 5, 6}, rim64[] = {7, 8, 9, 10, 11, 25};
static const double origin[3], at[] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, nan_at[] = {1, 0, 0, 0, NAN, 0},
                               on_line[] = {1, 0, 0, 3, 0, 0, 5, 0, 0}, nan_origin[] = {0, 0, INFINITY};

/* a chain of masses on springs; how many DOFs the constraints leave */
static int64_t n_free_of(void) {
    int32_t row[47], column[47];
    double mass[24], stiffness[47];
    int64_t n = -1;
    for (int32_t k = 0; k < 47; k++) row[k] = k < 24 ? k : k - 23, column[k] = k < 24 ? k : k - 24;
    for (int32_t k = 0; k < 47; k++) stiffness[k] = k < 24 ? 3 : -1;
    for (int32_t k = 0; k < 24; k++) mass[k] = 1;
    assert_int_equal(plm_model_set_matrix_i32(model, PLM_MASS, PLM_TRIPLETS, PLM_LOWER, 0, PLM_COPY, 24, row,
                                              column, mass),
                     PLM_OK);
    assert_int_equal(plm_model_set_matrix_i32(model, PLM_STIFFNESS, PLM_TRIPLETS, PLM_LOWER, 0, PLM_COPY, 47,
                                              row, column, stiffness),
                     PLM_OK);
    assert_int_equal(plm_model_build(model), PLM_OK);
    assert_int_equal(plm_model_get_int(model, "n_free", &n), PLM_OK);
    return n;
}

static void rigid_links(void **state) {
    const char *f = "plm_model_add_rigid_link_i32";
    (void)state;
#define LINK(base, per_r, rd, rx, n, per_d, dd, dx)                                                          \
    plm_model_add_rigid_link_i32(model, base, per_r, rd, rx, n, per_d, dd, dx)
    BAD(LINK(2, 6, hub, origin, 2, 3, rim, at), f, "index_base", -1, "0 (C)");
    BAD(LINK(0, 4, hub, origin, 2, 3, rim, at), f, "per_reference", -1, "3 DOFs (translations), or 6");
    BAD(LINK(0, 6, hub, origin, 2, 2, rim, at), f, "per_dependent", -1, "per_dependent is 2");
    BAD(LINK(0, 6, hub, origin, 0, 3, rim, at), f, "n", -1, "n is 0");
    BAD(LINK(0, 6, NULL, origin, 2, 3, rim, at), f, "reference_dof", -1, "NULL");
    BAD(LINK(0, 6, hub, NULL, 2, 3, rim, at), f, "reference_xyz", -1, "NULL");
    BAD(LINK(0, 6, hub, nan_origin, 2, 3, rim, at), f, "reference_xyz", 2, "infinite");
    BAD(LINK(0, 6, hub, origin, 2, 3, NULL, at), f, "dependent_dof", -1, "NULL");
    BAD(LINK(0, 6, hub, origin, 2, 3, rim, NULL), f, "dependent_xyz", -1, "NULL");
    BAD(LINK(0, 6, hub, origin, 2, 3, rim, nan_at), f, "dependent_xyz", 4, "NaN");
    BAD(LINK(0, 6, hub, origin, 2, 3, outside, at), f, "dependent_dof", 5, "0..23");
    BAD(LINK(0, 6, hub, origin, 2, 3, repeated, at), f, "dependent_dof", 5,
        "stands at dependent_dof[0] already");
    BAD(LINK(0, 6, hub, origin, 2, 3, of_hub, at), f, "dependent_dof", 5,
        "stands at reference_dof[5] already");
    BAD(LINK(0, 6, hub, origin, 2, 3, gone, at), f, "dependent_dof", 3, "node 1 of dependent_dof has no DOF");
    BAD(LINK(0, 3, none, origin, 2, 3, rim, at), f, "reference_dof", 0, "no DOF at all");
    BAD(plm_model_add_rigid_link_i64(model, 1, 6, hub64, origin, 2, 3, rim64, at),
        "plm_model_add_rigid_link_i64", "dependent_dof", 5, "1..24");
    assert_int_equal(LINK(0, 6, hub, origin, 2, 3, rim, at), PLM_OK);
    assert_int_equal(n_free_of(), 24 - 6);
    assert_true(
        refused(ctx, LINK(0, 6, hub, origin, 2, 3, rim, at), PLM_ERR_STATE, f, "", -1, "make a new one"));
}

static void coordinates(void **state) {
    const char *f = "plm_model_set_coordinates_i32";
    const int32_t twice[] = {0, 1, 2, 3, 4, 0};
    (void)state;
#define PLACE(base, n, per_node, d, x) plm_model_set_coordinates_i32(model, base, n, per_node, d, x)
    BAD(PLACE(2, 3, 3, rim, at), f, "index_base", -1, "0 (C)");
    BAD(PLACE(0, -1, 3, rim, at), f, "n", -1, "n is -1");
    BAD(PLACE(0, 3, 2, rim, at), f, "per_node", -1, "per_node is 2");
    BAD(PLACE(0, 3, 3, NULL, at), f, "dof", -1, "NULL");
    BAD(PLACE(0, 3, 3, rim, NULL), f, "xyz", -1, "NULL");
    BAD(PLACE(0, 1, 3, rim, nan_origin), f, "xyz", 2, "infinite");
    BAD(PLACE(0, 2, 3, outside, at), f, "dof", 5, "0..23");
    BAD(PLACE(0, 2, 3, twice, at), f, "dof", 5, "stands at dof[0] already");
    BAD(plm_model_set_coordinates_i64(model, 1, 2, 3, rim64, at), "plm_model_set_coordinates_i64", "dof", 5,
        "1..24");
    assert_int_equal(PLACE(0, 3, 3, rim, at), PLM_OK);
    assert_int_equal(PLACE(0, 0, 3, NULL, NULL), PLM_OK);
    assert_int_equal(n_free_of(), 24);
    assert_true(refused(ctx, PLACE(0, 3, 3, rim, at), PLM_ERR_STATE, f, "", -1, "make a new one"));
}

static void distributing_couplings(void **state) {
    const char *f = "plm_model_add_distributing_coupling_i32";
    const double zero[] = {1, 0, 1}, nan_weight[] = {1, NAN, 1}, weight[] = {1, 2, 3};
    (void)state;
#define SPREAD(base, per_r, rd, rx, n, d, x, w)                                                              \
    plm_model_add_distributing_coupling_i32(model, base, per_r, rd, rx, n, d, x, w)
    BAD(SPREAD(-1, 6, hub, origin, 3, rim, at, NULL), f, "index_base", -1, "0 (C)");
    BAD(SPREAD(0, 5, hub, origin, 3, rim, at, NULL), f, "per_reference", -1, "per_reference is 5");
    BAD(SPREAD(0, 6, hub, origin, 0, rim, at, NULL), f, "n", -1, "n is 0");
    BAD(SPREAD(0, 6, NULL, origin, 3, rim, at, NULL), f, "reference_dof", -1, "NULL");
    BAD(SPREAD(0, 6, hub, nan_origin, 3, rim, at, NULL), f, "reference_xyz", 2, "infinite");
    BAD(SPREAD(0, 6, hub, origin, 3, NULL, at, NULL), f, "dof", -1, "NULL");
    BAD(SPREAD(0, 6, hub, origin, 3, rim, NULL, NULL), f, "xyz", -1, "NULL");
    BAD(SPREAD(0, 6, hub, origin, 2, outside, at, NULL), f, "dof", 5, "0..23");
    BAD(SPREAD(0, 6, hub, origin, 2, of_hub, at, NULL), f, "dof", 5, "stands at reference_dof[5] already");
    BAD(SPREAD(0, 6, hub, origin, 3, rim, at, zero), f, "weight", 1, "it must be > 0");
    BAD(SPREAD(0, 6, hub, origin, 3, rim, at, nan_weight), f, "weight", 1, "NaN");
    BAD(SPREAD(0, 6, hub, origin, 3, rim, on_line, NULL), f, "xyz", -1, "give the reference node 3 DOFs");
    BAD(SPREAD(0, 3, hub, at + 3, 3, rim, on_line, NULL), f, "xyz", -1, "1 beside them");
    BAD(plm_model_add_distributing_coupling_i64(model, 1, 6, hub64, origin, 2, rim64, at, NULL),
        "plm_model_add_distributing_coupling_i64", "dof", 5, "1..24");
    assert_int_equal(SPREAD(0, 6, hub, origin, 3, rim, at, weight), PLM_OK);
    assert_int_equal(n_free_of(), 24 - 6);
    assert_true(refused(ctx, SPREAD(0, 6, hub, origin, 3, rim, at, NULL), PLM_ERR_STATE, f, "", -1,
                        "make a new one"));
}

static void ties(void **state) {
    const char *f = "plm_model_add_tie_i32";
    const int32_t over[] = {18, 19, 20, 21, 22, 23}, table[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11},
                  ptr[] = {0, 4}, two[] = {0, 2}, from_1[] = {1, 5}, quad[] = {0, 1, 2, 3},
                  no_node[] = {0, 1, 2, 4};
    const int64_t over64[] = {19, 20, 21, 22, 23, 24}, table64[] = {1, 2, 3, 4, 5, 6, 7, 8, 9},
                  ptr64[] = {1, 4}, none64[] = {1, 2, 0};
    const double xyz[] = {0.5, 0.5, 0.01, 0.5, 0.5, 3}, square[] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
    double distance[2] = {-1, -1}, far = -1;
    int64_t n = -1;
    (void)state;
#define TIE(base, n, d, x, n_s, sd, sx, n_f, fp, fn, tol)                                                    \
    plm_model_add_tie_i32(model, base, n, d, x, n_s, sd, sx, n_f, fp, fn, tol, distance)
    BAD(TIE(3, 2, over, xyz, 4, table, square, 1, ptr, quad, 0.1), f, "index_base", -1, "0 (C)");
    BAD(TIE(0, 0, over, xyz, 4, table, square, 1, ptr, quad, 0.1), f, "n", -1, "n is 0");
    BAD(TIE(0, 2, NULL, xyz, 4, table, square, 1, ptr, quad, 0.1), f, "dependent_dof", -1, "NULL");
    BAD(TIE(0, 2, over, NULL, 4, table, square, 1, ptr, quad, 0.1), f, "dependent_xyz", -1, "NULL");
    BAD(TIE(0, 2, none, xyz, 4, table, square, 1, ptr, quad, 0.1), f, "dependent_dof", 0, "no DOF at all");
    BAD(TIE(0, 2, repeated, xyz, 4, table, square, 1, ptr, quad, 0.1), f, "dependent_dof", 5, "already");
    BAD(TIE(0, 2, outside, xyz, 4, table, square, 1, ptr, quad, 0.1), f, "dependent_dof", 5, "0..23");
    BAD(TIE(0, 2, over, xyz, 0, table, square, 1, ptr, quad, 0.1), f, "n_surface", -1, "n_surface is 0");
    BAD(TIE(0, 2, over, xyz, 4, NULL, square, 1, ptr, quad, 0.1), f, "surface_dof", -1, "NULL");
    BAD(TIE(0, 2, over, xyz, 4, table, NULL, 1, ptr, quad, 0.1), f, "surface_xyz", -1, "NULL");
    BAD(TIE(0, 2, over, xyz, 2, table, nan_at, 1, ptr, quad, 0.1), f, "surface_xyz", 4, "NaN");
    BAD(TIE(0, 2, over, xyz, 2, repeated, square, 1, ptr, quad, 0.1), f, "surface_dof", 5, "already");
    BAD(TIE(0, 2, over, xyz, 4, table, square, 0, ptr, quad, 0.1), f, "n_faces", -1, "n_faces is 0");
    BAD(TIE(0, 2, over, xyz, 4, table, square, 1, NULL, quad, 0.1), f, "face_ptr", -1, "NULL");
    BAD(TIE(0, 2, over, xyz, 4, table, square, 1, from_1, quad, 0.1), f, "face_ptr", 0, "index base 0");
    BAD(TIE(0, 2, over, xyz, 4, table, square, 1, two, quad, 0.1), f, "face_ptr", 1, "face 0 has 2 nodes");
    BAD(TIE(0, 2, over, xyz, 4, table, square, 1, ptr, NULL, 0.1), f, "face_node", -1, "NULL");
    BAD(TIE(0, 2, over, xyz, 4, table, square, 1, ptr, no_node, 0.1), f, "face_node", 3, "0..3");
    BAD(TIE(0, 2, over, xyz, 4, table, square, 1, ptr, quad, 0), f, "tolerance", -1, "a length > 0");
    BAD(TIE(0, 2, over, xyz, 4, table, square, 1, ptr, quad, NAN), f, "tolerance", -1, "NaN");
    BAD(TIE(0, 2, over, xyz, 4, table, square, 1, ptr, quad, 1e-3), f, "tolerance", -1,
        "node 0 (counted from 0), is 0.01");
    BAD(plm_model_add_tie_i64(model, 1, 2, over64, xyz, 3, table64, square, 1, ptr64, none64, 0.1, NULL),
        "plm_model_add_tie_i64", "face_node", 2, "1..3");
    assert_true(distance[0] == -1 && distance[1] == -1);
    assert_int_equal(plm_model_get_int(model, "n_untied_nodes", &n), PLM_OK);
    assert_int_equal(n, 0);
    assert_true(
        refused(ctx, TIE(0, 2, over, xyz, 4, table, square, 1, ptr, quad, 0.1), PLM_WARNING, f, "", -1,
                "1 of 2 nodes stay free, farther from the surface than the tolerance 0.1: the farthest "
                "is node 1"));
    assert_true(fabs(distance[0] - 0.01) < 1e-14 && fabs(distance[1] - 3) < 1e-14);
    assert_int_equal(plm_model_get_int(model, "n_untied_nodes", &n), PLM_OK);
    assert_int_equal(plm_model_get_double(model, "tie_distance", &far), PLM_OK);
    assert_true(n == 1 && fabs(far - 0.01) < 1e-14);
    assert_int_equal(n_free_of(), 24 - 3);
}

/* 0 and 1 on springs, and DOF 2: what its row holds; mass: of DOF 2 */
static void set_tied_springs(double diagonal, double c, double mass) {
    const int32_t row[] = {0, 1, 2, 2, 2}, column[] = {0, 1, 2, 0, 1};
    const double k[] = {1000, 3000, diagonal, c, -c}, m[] = {1, 2, mass};
    assert_int_equal(
        plm_model_set_matrix_i32(model, PLM_MASS, PLM_TRIPLETS, PLM_LOWER, 0, PLM_COPY, 3, row, column, m),
        PLM_OK);
    assert_int_equal(plm_model_set_matrix_i32(model, PLM_STIFFNESS, PLM_TRIPLETS, PLM_LOWER, 0, PLM_COPY, 5,
                                              row, column, k),
                     PLM_OK);
}

static void multipliers(void **state) {
    const char *f = "plm_model_set_multipliers_i32", *build = "plm_model_build";
    const int32_t dof[] = {2}, twice[] = {2, 2}, beyond[] = {3}, wrong[] = {1};
    const int64_t from_1[] = {3}, none64[] = {0};
    const double load[] = {1, 0, 0.5}, no_load[] = {1, 0, 0};
    double hz = 0, shape[3] = {7, 7, 7};
    (void)state;
    assert_int_equal(plm_model_destroy(&model), PLM_OK);
    assert_int_equal(plm_model_create(ctx, 3, &model), PLM_OK);
    BAD(plm_model_set_multipliers_i32(model, 2, 1, dof), f, "index_base", -1, "0 (C)");
    BAD(plm_model_set_multipliers_i32(model, 0, -1, dof), f, "n", -1, "n is -1");
    BAD(plm_model_set_multipliers_i32(model, 0, 1, NULL), f, "dof", -1, "NULL");
    BAD(plm_model_set_multipliers_i32(model, 0, 1, beyond), f, "dof", 0, "0..2");
    BAD(plm_model_set_multipliers_i32(model, 0, 2, twice), f, "dof", 1, "a second time");
    BAD(plm_model_set_multipliers_i64(model, 1, 1, none64), "plm_model_set_multipliers_i64", "dof", 0,
        "1..3");
#define REFUSED(words)                                                                                       \
    assert_true(refused(ctx, plm_model_build(model), PLM_ERR_MATRIX, build, "value", 2, words))
    assert_int_equal(plm_model_set_multipliers_i32(model, 0, 1, wrong), PLM_OK);
    assert_int_equal(plm_model_set_multipliers_i64(model, 1, 1, from_1), PLM_OK); /* in its place */
    set_tied_springs(4, 1, 0);
    REFUSED("4 at (2, 2), among multipliers");
    set_tied_springs(0, 0, 0);
    REFUSED("its row of the stiffness matrix is empty");
    set_tied_springs(0, 1, 3);
    REFUSED("the mass matrix has 3 at (2, 2)");
    set_tied_springs(0, 1, 0);
    assert_int_equal(plm_model_set_excitation(model, 1, 3, load, NULL), PLM_OK);
    assert_true(refused(ctx, plm_model_build(model), PLM_ERR_ARGUMENT, build, "force", 2,
                        "the excitation is 0.5 at DOF 2"));
    assert_int_equal(plm_model_set_excitation(model, 1, 3, no_load, NULL), PLM_OK);
    assert_int_equal(plm_model_build(model), PLM_OK);
    assert_int_equal(plm_model_get_modes(model, PLM_SYSTEM_OPEN, NULL, 1, &hz, shape), PLM_OK);
    assert_true(
        close_to(2 * 3.14159265358979323846 * hz, sqrt(4000 / 3.0), 1e-13)); /* both on both springs */
    assert_true(fabs(shape[0] - shape[1]) < 1e-14 && shape[2] == 0);
    assert_true(refused(ctx, plm_model_set_multipliers_i32(model, 0, 1, dof), PLM_ERR_STATE, f, "", -1,
                        "make a new one"));
}

int main(void) {
#define TEST(f) cmocka_unit_test_setup_teardown(f, set_up, tear_down)
    const struct CMUnitTest tests[] = {TEST(rigid_links), TEST(coordinates), TEST(distributing_couplings),
                                       TEST(ties), TEST(multipliers)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
