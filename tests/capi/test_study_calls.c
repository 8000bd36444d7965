/* What the functions of a study refuse, one by one. */
#include "study_case.h"

static plm_context *ctx;
static study_case c;

static int set_up(void **state) {
    (void)state;
    return plm_context_create(PLM_API_VERSION, &ctx) || !done(ctx, study_case_make(ctx, &c));
}
static int tear_down(void **state) {
    (void)state;
    return plm_context_destroy(&ctx);
}

#define BAD(call, function, argument, index, words)                                                          \
    assert_true(refused(ctx, call, PLM_ERR_ARGUMENT, function, argument, index, words))
#define EARLY(call, function, argument, words)                                                               \
    assert_true(refused(ctx, call, PLM_ERR_STATE, function, argument, -1, words))
#define DEAD(call, function, argument, words)                                                                \
    assert_true(refused(ctx, call, PLM_ERR_HANDLE, function, argument, -1, words))
#define DONE(call) assert_true(done(ctx, call))

static void options_of_the_study_are_checked(void **state) {
    const double nan_level[] = {1, NAN}, negative[] = {0.5, 1, -1}, zero = 0;
    (void)state;
    BAD(plm_study_create(c.model, NULL), "plm_study_create", "study", -1, "NULL");
    BAD(plm_study_set_int(c.study, "repeats", -1), "plm_study_set_int", "value", -1, "repeats");
    BAD(plm_study_set_int(c.study, "curve_samples", 1), "plm_study_set_int", "value", -1, "curve_samples");
    BAD(plm_study_set_double(c.study, "curve_tolerance", NAN), "plm_study_set_double", "value", -1,
        "curve_tolerance");
    BAD(plm_study_set_int(c.study, "n_points", 1), "plm_study_set_int", "key", -1, "is a result");
    assert_true(refused(ctx, plm_study_set_int(c.study, "repeat", 1), PLM_ERR_KEY, "plm_study_set_int", "key",
                        -1, "did you mean \"repeats\"?"));
    BAD(plm_study_set_output(c.study, 1, PLM_RMS, 0), "plm_study_set_output", "dof", -1, "0..0");
    BAD(plm_study_set_output(c.study, -1, PLM_RMS, 0), "plm_study_set_output", "dof", -1, "0..0");
    BAD(plm_study_set_output(c.study, 0, 5, 0), "plm_study_set_output", "measure", -1, "1..4");
    BAD(plm_study_set_output(c.study, 0, PLM_HARMONIC, -1), "plm_study_set_output", "harmonic", -1,
        "harmonic is -1");
    BAD(plm_study_set_force_levels(c.study, 0, nan_level), "plm_study_set_force_levels", "n", -1, "n is 0");
    BAD(plm_study_set_force_levels(c.study, 2, NULL), "plm_study_set_force_levels", "scale", -1, "NULL");
    BAD(plm_study_set_force_levels(c.study, 2, nan_level), "plm_study_set_force_levels", "scale", 1, "NaN");
    BAD(plm_study_set_force_levels(c.study, 3, negative), "plm_study_set_force_levels", "scale", 2,
        "must be > 0");
    BAD(plm_study_set_force_levels(c.study, 1, &zero), "plm_study_set_force_levels", "scale", 0,
        "must be > 0");
    assert_true(study_scalar(c.study, "n_levels") == 1); /* nothing has changed */
}

static void methods_are_checked(void **state) {
    study_case other;
    plm_hbm *stale = NULL;
    plm_basis *pod = NULL;
    plm_hbm *of_pod = NULL;
    plm_transient *motion = NULL, *foreign = NULL;
    int64_t index = 7;
    (void)state;
    assert_true(done(ctx, study_case_make(ctx, &other)));
    DONE(plm_transient_create(c.model, NULL, &motion));
    DONE(plm_transient_create(other.model, NULL, &foreign));
    BAD(plm_study_add_response(c.study, NULL, c.hbm, &index), "plm_study_add_response", "name", -1, "NULL");
    BAD(plm_study_add_response(c.study, "", c.hbm, &index), "plm_study_add_response", "name", -1, "empty");
    BAD(plm_study_add_response(c.study, "reference", c.hbm, &index), "plm_study_add_response", "name", -1,
        "taken");
    BAD(plm_study_add_response(c.study, "a", other.hbm, &index), "plm_study_add_response", "hbm", -1,
        "another model");
    BAD(plm_study_set_reference(c.study, other.hbm), "plm_study_set_reference", "hbm", -1, "another model");
    BAD(plm_study_add_marching(c.study, "a", foreign, 3, &index), "plm_study_add_marching", "transient", -1,
        "another model");
    DONE(plm_hbm_create(c.basis, &stale));
    {
        plm_hbm *copy = stale;
        DONE(plm_hbm_destroy(&copy));
    }
    DEAD(plm_study_add_response(c.study, "a", stale, &index), "plm_study_add_response", "hbm",
         "no live handle");
    DEAD(plm_study_add_compressed(c.study, "a", NULL, 0, &index), "plm_study_add_compressed", "hbm",
         "no live handle");
    DEAD(plm_study_add_refined(c.study, "a", (plm_hbm *)(void *)c.model, 0.1, &index),
         "plm_study_add_refined", "hbm", "no live handle");
    DEAD(plm_study_set_reference(c.study, stale), "plm_study_set_reference", "hbm", "no live handle");
    DEAD(plm_study_add_marching(c.study, "a", NULL, 3, &index), "plm_study_add_marching", "transient",
         "no live handle");
    BAD(plm_study_add_compressed(c.study, "a", c.hbm, -1, &index), "plm_study_add_compressed", "size", -1,
        "size is -1");
    BAD(plm_study_add_refined(c.study, "a", c.hbm, 0, &index), "plm_study_add_refined", "tolerance", -1,
        "(0, 1)");
    BAD(plm_study_add_refined(c.study, "a", c.hbm, NAN, &index), "plm_study_add_refined", "tolerance", -1,
        "NaN");
    BAD(plm_study_add_marching(c.study, "a", motion, 0, &index), "plm_study_add_marching", "n_frequencies",
        -1, "n_frequencies is 0");
    DONE(plm_basis_create(c.model, &pod));
    DONE(plm_basis_set_string(pod, "kind", "pod"));
    DONE(plm_hbm_create(pod, &of_pod));
    BAD(plm_study_add_response(c.study, "a", of_pod, &index), "plm_study_add_response", "hbm", -1,
        "to be compressed or refined");
    assert_true(index == 7 && study_scalar(c.study, "n_methods") == 0);
    DONE(plm_study_add_response(c.study, "a", c.hbm, &index));
    assert_int_equal(index, 0);
    BAD(plm_study_add_compressed(c.study, "a", c.hbm, 0, &index), "plm_study_add_compressed", "name", -1,
        "taken");
    DONE(plm_study_add_refined(c.study, "b", c.hbm, 0.1, &index));
    assert_int_equal(index, 1);
}

static void too_early(void **state) {
    plm_model *raw = NULL;
    plm_study *study = NULL;
    plm_branch *branch = NULL;
    plm_transient *motion = NULL;
    plm_basis *open = NULL;
    plm_hbm *hbm = NULL;
    int64_t n = 7;
    char text[40] = "kept";
    (void)state;
    EARLY(plm_study_run(c.study), "plm_study_run", "study", "add one first");
    EARLY(plm_study_get_outcome(c.study, -1, 40, text, NULL), "plm_study_get_outcome", "study",
          "has not run");
    EARLY(plm_study_get_curve(c.study, -1, 0, &branch), "plm_study_get_curve", "study", "has not run");
    EARLY(plm_study_get_points(c.study, -1, 0, 0, NULL, NULL, &n), "plm_study_get_points", "study",
          "has not run");
    EARLY(plm_study_get_array(c.study, "peak_hz", 0, NULL, &n), "plm_study_get_array", "study",
          "has not run");
    EARLY(plm_study_get_int_array(c.study, "pareto", 0, NULL, &n), "plm_study_get_int_array", "study",
          "has not run");
    EARLY(plm_study_write(c.study, "."), "plm_study_write", "study", "has not run");
    BAD(plm_study_get_name(c.study, 0, 40, text, NULL), "plm_study_get_name", "index", -1, "index is 0");
    DONE(plm_transient_create(c.model, NULL, &motion));
    DONE(plm_study_add_marching(c.study, "marching", motion, 2, NULL));
    EARLY(plm_study_run(c.study), "plm_study_run", "reference", "set the reference");
    DONE(plm_study_create(c.model, &study));
    DONE(plm_study_add_response(study, "a", c.hbm, NULL));
    EARLY(plm_study_run(study), "plm_study_run", "study", "set its output");
    DONE(plm_basis_create(c.model, &open)); /* no window anywhere */
    DONE(plm_basis_set_string(open, "kind", "full"));
    DONE(plm_hbm_create(open, &hbm));
    DONE(plm_study_set_output(study, 0, PLM_RMS, 0));
    DONE(plm_study_set_reference(study, hbm));
    EARLY(plm_study_run(study), "plm_study_run", "frequency_min_hz", "frequency range");
    DONE(plm_study_destroy(&study));
    DONE(plm_model_create(ctx, 1, &raw));
    DONE(plm_study_create(raw, &study));
    EARLY(plm_study_run(study), "plm_study_run", "model", "build it first");
    assert_true(n == 7 && branch == NULL && strcmp(text, "kept") == 0);
}

static void results_are_read_within_their_bounds(void **state) {
    double x = 7, y = 7;
    int64_t n = 7;
    plm_branch *branch = NULL;
    plm_transient *motion = NULL;
    (void)state;
    DONE(plm_transient_create(c.model, c.basis, &motion));
    DONE(plm_study_add_response(c.study, "a", c.hbm, NULL));
    DONE(plm_study_add_marching(c.study, "b", motion, 1, NULL));
    DONE(plm_study_run(c.study));
    BAD(plm_study_get_curve(c.study, 2, 0, &branch), "plm_study_get_curve", "index", -1, "-1..1");
    BAD(plm_study_get_curve(c.study, -2, 0, &branch), "plm_study_get_curve", "index", -1, "-1..1");
    BAD(plm_study_get_curve(c.study, 0, 1, &branch), "plm_study_get_curve", "level", -1, "0..0");
    BAD(plm_study_get_curve(c.study, 0, 0, NULL), "plm_study_get_curve", "branch", -1, "NULL");
    EARLY(plm_study_get_curve(c.study, 1, 0, &branch), "plm_study_get_curve", "index", "read its points");
    BAD(plm_study_get_points(c.study, 0, 0, 1, &x, &y, &n), "plm_study_get_points", "capacity", -1,
        "capacity is 1");
    BAD(plm_study_get_points(c.study, 0, 0, 9, &x, NULL, &n), "plm_study_get_points", "amplitude", -1,
        "NULL");
    BAD(plm_study_get_points(c.study, 0, 0, 0, NULL, NULL, NULL), "plm_study_get_points", "count", -1,
        "NULL");
    BAD(plm_study_write(c.study, NULL), "plm_study_write", "folder", -1, "NULL");
    assert_true(x == 7 && y == 7 && n == 7 && branch == NULL);
    DONE(plm_study_get_points(c.study, 1, 0, 1, &x, &y, &n));
    assert_true(n == 1 && close_to(x, 0.16, 1e-12) && y > 0); /* the middle of the range */
}

int main(void) {
#define TEST(f) cmocka_unit_test_setup_teardown(f, set_up, tear_down)
    const struct CMUnitTest tests[] = {
        TEST(options_of_the_study_are_checked),
        TEST(methods_are_checked),
        TEST(too_early),
        TEST(results_are_read_within_their_bounds),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
