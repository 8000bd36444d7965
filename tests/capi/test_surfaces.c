/* Surfaces, contact between them and forces at rest: misuse of every kind is refused with argument, index and
 * what to do, and changes nothing; what is right has as many pairs as it should, and says what it found. */
#include "check.h"

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

/* a square face in the plane z = 0, its normal up, and four nodes over it */
static const int32_t square_dof[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}, square_ptr[] = {0, 4},
                     square_node[] = {0, 1, 2, 3},
                     over_dof[] = {12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23}, turned[] = {3, 2, 1, 0};
static const int32_t no_dof[] = {-1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1}; /* of a wall */
static const double square[] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0},
                    over[] = {0, 0, 0.1, 1, 0, 0.2, 1, 1, 1e-3, 0, 1, -0.05};
static int64_t below = -1, above = -1;

static void add_both(const int32_t *above_node) {
    assert_int_equal(
        plm_model_add_surface_i32(model, 0, 4, square_dof, square, NULL, 1, square_ptr, square_node, &below),
        PLM_OK);
    assert_int_equal(
        plm_model_add_surface_i32(model, 0, 4, over_dof, over, NULL, 1, square_ptr, above_node, &above),
        PLM_OK);
}

static int64_t n_pairs(void) {
    int64_t n = -1;
    assert_int_equal(plm_model_get_int(model, "n_pairs", &n), PLM_OK);
    return n;
}

static void surfaces(void **state) {
    const char *f = "plm_model_add_surface_i32";
    const int32_t outside[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 24},
                  repeated[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 0}, two[] = {0, 2}, from_1[] = {1, 5},
                  no_node[] = {0, 1, 2, 4}, flat[] = {0, 1, 0, 1};
    const int64_t none64[] = {1, 2, 3, 5}, ptr64[] = {1, 5},
                  dof64[] = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
    const double nan_at[] = {0, 0, 0, 1, NAN, 0, 1, 1, 0, 0, 1, 0}, areas[] = {1, 1, -1, 1};
    int64_t s = -7;
    (void)state;
#define SURFACE(base, n, d, x, a, n_f, fp, fn)                                                               \
    plm_model_add_surface_i32(model, base, n, d, x, a, n_f, fp, fn, &s)
    BAD(SURFACE(2, 4, square_dof, square, NULL, 1, square_ptr, square_node), f, "index_base", -1, "0 (C)");
    BAD(SURFACE(0, 0, square_dof, square, NULL, 1, square_ptr, square_node), f, "n", -1, "n is 0");
    BAD(SURFACE(0, 4, NULL, square, NULL, 1, square_ptr, square_node), f, "dof", -1, "NULL");
    BAD(SURFACE(0, 4, square_dof, NULL, NULL, 1, square_ptr, square_node), f, "xyz", -1, "NULL");
    BAD(SURFACE(0, 4, square_dof, nan_at, NULL, 1, square_ptr, square_node), f, "xyz", 4, "NaN");
    BAD(SURFACE(0, 4, outside, square, NULL, 1, square_ptr, square_node), f, "dof", 11, "0..23");
    BAD(SURFACE(0, 4, repeated, square, NULL, 1, square_ptr, square_node), f, "dof", 11, "already");
    BAD(SURFACE(0, 4, square_dof, square, areas, 1, square_ptr, square_node), f, "area", 2, "area[2] is -1");
    BAD(SURFACE(0, 4, square_dof, square, NULL, -1, square_ptr, square_node), f, "n_faces", -1,
        "n_faces is -1");
    BAD(SURFACE(0, 4, square_dof, square, NULL, 1, NULL, square_node), f, "face_ptr", -1, "NULL");
    BAD(SURFACE(0, 4, square_dof, square, NULL, 1, from_1, square_node), f, "face_ptr", 0, "index base 0");
    BAD(SURFACE(0, 4, square_dof, square, NULL, 1, two, square_node), f, "face_ptr", 1, "face 0 has 2 nodes");
    BAD(SURFACE(0, 4, square_dof, square, NULL, 1, square_ptr, NULL), f, "face_node", -1, "NULL");
    BAD(SURFACE(0, 4, square_dof, square, NULL, 1, square_ptr, no_node), f, "face_node", 3, "0..3");
    BAD(SURFACE(0, 4, square_dof, square, NULL, 1, square_ptr, flat), f, "face_node", 0, "has no area");
    BAD(plm_model_add_surface_i32(model, 0, 4, square_dof, square, NULL, 1, square_ptr, square_node, NULL), f,
        "surface", -1, "NULL");
    BAD(plm_model_add_surface_i64(model, 1, 4, dof64, square, NULL, 1, ptr64, none64, &s),
        "plm_model_add_surface_i64", "face_node", 3, "1..4");
    assert_int_equal(s, -7);
    assert_int_equal(SURFACE(0, 4, no_dof, square, NULL, 1, square_ptr, square_node), PLM_OK);
    assert_int_equal(s, 0);
    assert_int_equal(SURFACE(0, 4, over_dof, over, NULL, 0, NULL, NULL), PLM_OK);
    assert_int_equal(s, 1);
}

static void contacts(void **state) {
    const char *f = "plm_model_add_surface_contact";
    int64_t wall = -1, cloud = -1;
    (void)state;
    add_both(turned);
    assert_int_equal(
        plm_model_add_surface_i32(model, 0, 4, no_dof, square, NULL, 1, square_ptr, square_node, &wall),
        PLM_OK);
    assert_int_equal(plm_model_add_surface_i32(model, 0, 4, over_dof, over, NULL, 0, NULL, NULL, &cloud),
                     PLM_OK);
#define TOUCH(slave, master, options, k, search, closed)                                                     \
    plm_model_add_surface_contact(model, slave, master, options, k, search, closed)
    BAD(TOUCH(4, below, 0, 1, 1, 0), f, "slave", -1, "the model has 4 surfaces");
    BAD(TOUCH(above, -1, 0, 1, 1, 0), f, "master", -1, "master is -1");
    BAD(TOUCH(above, above, 0, 1, 1, 0), f, "master", -1, "between two surfaces");
    BAD(TOUCH(above, below, 16, 1, 1, 0), f, "options", -1, "options is 16");
    BAD(TOUCH(wall, below, 0, 1, 1, 0), f, "slave", -1, "a wall is the master");
    BAD(TOUCH(below, cloud, 0, 1, 1, 0), f, "master", -1, "which a master needs");
    BAD(TOUCH(cloud, below, PLM_SURFACE_POINTS, 1, 1, 0), f, "slave", -1, "PLM_SURFACE_POINTS needs");
    BAD(TOUCH(cloud, below, PLM_SURFACE_SYMMETRIC, 1, 1, 0), f, "slave", -1, "PLM_SURFACE_SYMMETRIC needs");
    BAD(TOUCH(above, below, 0, 0, 1, 0), f, "stiffness", -1, "stiffness is 0");
    BAD(TOUCH(above, below, 0, NAN, 1, 0), f, "stiffness", -1, "it must be > 0");
    BAD(TOUCH(above, below, 0, 1, 0, 0), f, "search", -1, "a length > 0");
    BAD(TOUCH(above, below, 0, 1, NAN, 0), f, "search", -1, "NaN");
    BAD(TOUCH(above, below, 0, 1, 1, -1), f, "closed", -1, "a length >= 0");
    BAD(TOUCH(above, below, 0, 1, 1e-6, 0), f, "search", -1,
        "the nearest, point 2 (counted from 0), is 0.001");
    assert_int_equal(n_pairs(), 0);
    assert_int_equal(TOUCH(above, below, 0, 1, 1, 0.01), PLM_OK);
    assert_int_equal(n_pairs(), 4);
    assert_int_equal(TOUCH(cloud, wall, 0, 1, 0.15, 0), PLM_OK); /* one is too far */
    assert_int_equal(n_pairs(), 7);
    assert_int_equal(TOUCH(above, below, PLM_SURFACE_SYMMETRIC | PLM_SURFACE_POINTS, 1, 1, 0), PLM_OK);
    assert_int_equal(n_pairs(), 15);
}

static void what_was_found(void **state) {
    double gap[4], normal[12], initial[4], area[4], x = 0;
    int64_t pair[4], face[4], n = 0;
    char text[500];
    (void)state;
    add_both(turned);
    assert_int_equal(plm_model_add_surface_contact(model, above, below, 0, 1, 0.15, 0.01), PLM_OK);
    assert_int_equal(plm_model_get_array(model, "surface_gap", 4, gap, &n), PLM_OK);
    assert_int_equal(plm_model_get_array(model, "surface_normal", 12, normal, &n), PLM_OK);
    assert_int_equal(plm_model_get_array(model, "surface_area", 4, area, &n), PLM_OK);
    assert_int_equal(plm_model_get_int_array(model, "surface_pair", 4, pair, &n), PLM_OK);
    assert_int_equal(plm_model_get_int_array(model, "surface_face", 4, face, &n), PLM_OK);
    assert_int_equal(plm_model_get_array(model, "initial_gap", 4, initial, &n), PLM_OK);
    assert_int_equal(n, 3);
    assert_true(fabs(gap[0] - 0.1) < 1e-15 && fabs(gap[2] - 1e-3) < 1e-15 && fabs(gap[3] + 0.05) < 1e-15);
    assert_true(initial[0] == gap[0] && initial[1] == 0 && initial[2] == gap[3]); /* the second is closed */
    assert_true(pair[0] == 0 && pair[1] == -1 && pair[2] == 1 && pair[3] == 2);
    assert_true(face[0] == 0 && face[1] == -1 && normal[2] == -1 && normal[5] == 0 && area[3] > 0.2);
    assert_int_equal(plm_model_get_int(model, "n_surface_alone", &n), PLM_OK);
    assert_int_equal(n, 1);
    assert_int_equal(plm_model_get_double(model, "surface_interference", &x), PLM_OK);
    assert_true(fabs(x - 0.05) < 1e-15);
    assert_int_equal(plm_model_get_double(model, "surface_distance", &x), PLM_OK);
    assert_true(fabs(x - 0.1) < 1e-15);
    assert_int_equal(plm_model_get_string(model, "surface_report", sizeof text, text, &n), PLM_OK);
    assert_non_null(strstr(text, "3 pairs, the farthest (point 0) at 0.1; 1 of them closed, 1 with "
                                 "interference, the deepest (point 3) by 0.05"));
}

static void faces_turned_over(void **state) {
    int64_t n = 0;
    (void)state;
    add_both(square_node);
    assert_true(refused(ctx, plm_model_add_surface_contact(model, above, below, 0, 1, 1, 0), PLM_WARNING,
                        "plm_model_add_surface_contact", "", -1,
                        "4 points of surface 1 look the same way as the face of surface 0 nearest to them"));
    assert_int_equal(plm_model_get_int(model, "n_surface_opposed", &n), PLM_OK);
    assert_int_equal(n, 4);
    assert_int_equal(n_pairs(), 0);
    assert_int_equal(plm_model_add_surface_contact(model, above, below, PLM_SURFACE_TWO_SIDED, 1, 1, 0),
                     PLM_OK);
    assert_int_equal(n_pairs(), 4);
}

static void rest_forces(void **state) {
    const char *f = "plm_model_set_rest_force";
    const double force[] = {1, PLM_KEEP_GAP, 0, 2}, pull[] = {1, 1, -2, 1}, nan[] = {1, NAN, 1, 1};
    (void)state;
    BAD(plm_model_set_rest_force(model, 4, force), f, "n", -1, "0 contact pairs so far");
    add_both(turned);
    assert_int_equal(plm_model_add_surface_contact(model, above, below, 0, 1, 1, 0), PLM_OK);
    BAD(plm_model_set_rest_force(model, 3, force), f, "n", -1, "n is 3");
    BAD(plm_model_set_rest_force(model, 4, pull), f, "force", 2, "force[2] is -2; contact presses");
    BAD(plm_model_set_rest_force(model, 4, nan), f, "force", 1, "NaN");
    assert_int_equal(plm_model_set_rest_force(model, 4, force), PLM_OK);
    assert_int_equal(plm_model_set_rest_force(model, 0, NULL), PLM_OK);
}

int main(void) {
#define TEST(f) cmocka_unit_test_setup_teardown(f, set_up, tear_down)
    const struct CMUnitTest tests[] = {TEST(surfaces), TEST(contacts), TEST(what_was_found),
                                       TEST(faces_turned_over), TEST(rest_forces)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
