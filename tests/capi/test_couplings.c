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

int main(void) {
#define TEST(f) cmocka_unit_test_setup_teardown(f, set_up, tear_down)
    const struct CMUnitTest tests[] = {TEST(rigid_links), TEST(distributing_couplings)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
