/* What the functions of a transient refuse, one by one. */
#include "check.h"
#include "oscillator.h"

static const oscillator swing = {40, 0.5, 0, 0, 3};
static const double hz = 0.7;

static plm_context *ctx;
static plm_model *model;
static plm_basis *basis;
static plm_transient *reduced, *full;

static int set_up(void **state) {
    const oscillator o = {40, 0.5, 1e3, 0.1, 3};
    (void)state;
    return plm_context_create(PLM_API_VERSION, &ctx) ||
           !done(ctx, oscillator_built(ctx, &o, 5, &model, &basis)) ||
           !done(ctx, plm_transient_create(model, basis, &reduced)) ||
           !done(ctx, plm_transient_create(model, NULL, &full));
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

static void arguments_are_checked(void **state) {
    const int32_t dof[2] = {0, 1};
    const int64_t dof64[2] = {1, -3};
    const double q = 1, not_a_number = NAN;
    plm_basis *other_basis = NULL;
    plm_model *other_model = NULL;
    plm_transient *none = NULL;
    double x = 7;
    (void)state;
    assert_true(done(ctx, oscillator_built(ctx, &swing, 5, &other_model, &other_basis)));
    BAD(plm_transient_create(model, NULL, NULL), "plm_transient_create", "transient", -1, "NULL");
    BAD(plm_transient_create(model, other_basis, &none), "plm_transient_create", "basis", -1,
        "another model");
    DEAD(plm_transient_create(model, (plm_basis *)(void *)model, &none), "plm_transient_create", "basis",
         "no live handle");
    assert_null(none);
    BAD(plm_transient_observe_i32(reduced, 0, 2, dof), "plm_transient_observe_i32", "dof", 1, "0..0");
    BAD(plm_transient_observe_i32(reduced, 2, 1, dof), "plm_transient_observe_i32", "index_base", -1,
        "0 (C)");
    BAD(plm_transient_observe_i32(reduced, 0, -1, dof), "plm_transient_observe_i32", "n", -1, "n is -1");
    BAD(plm_transient_observe_i32(reduced, 0, 1, NULL), "plm_transient_observe_i32", "dof", -1, "NULL");
    BAD(plm_transient_observe_i64(reduced, 1, 2, dof64), "plm_transient_observe_i64", "dof", 1, "1..1");
    BAD(plm_transient_set_state(reduced, 2, &q, NULL), "plm_transient_set_state", "n", -1, "n is 2");
    BAD(plm_transient_set_state(reduced, 1, &not_a_number, NULL), "plm_transient_set_state", "q", 0, "NaN");
    BAD(plm_transient_set_state(full, 1, &q, &not_a_number), "plm_transient_set_state", "v", 0, "NaN");
    BAD(plm_transient_get_state(full, 0, &x, NULL), "plm_transient_get_state", "n", -1, "n is 0");
    BAD(plm_transient_set_double(full, "hht_alpha", 0.5), "plm_transient_set_double", "value", -1,
        "hht_alpha");
    BAD(plm_transient_set_double(full, "settled", NAN), "plm_transient_set_double", "value", -1, "settled");
    BAD(plm_transient_set_int(full, "periods", 0), "plm_transient_set_int", "value", -1, "periods");
    BAD(plm_transient_set_int(full, "n_events", 1), "plm_transient_set_int", "key", -1, "is a result");
    BAD(plm_transient_set_string(full, "march_when_stuck", "maybe"), "plm_transient_set_string", "value", -1,
        "off,on");
    assert_true(refused(ctx, plm_transient_set_int(full, "period", 1), PLM_ERR_KEY, "plm_transient_set_int",
                        "key", -1, "did you mean \"periods\"?"));
    assert_true(x == 7);
}

static void branches_of_others_are_refused(void **state) {
    plm_hbm *hbm = NULL;
    plm_branch *point = NULL, *foreign = NULL;
    plm_model *other_model = NULL;
    plm_basis *other_basis = NULL;
    double before = 0, after = 0;
    (void)state;
    assert_true(done(ctx, plm_hbm_create(basis, &hbm)));
    assert_true(done(ctx, plm_hbm_solve(hbm, hz, NULL, 0, &point)));
    plm_hbm_destroy(&hbm);
    assert_true(done(ctx, oscillator_built(ctx, &swing, 5, &other_model, &other_basis)));
    assert_true(done(ctx, plm_hbm_create(other_basis, &hbm)));
    assert_true(done(ctx, plm_hbm_solve(hbm, hz, NULL, 0, &foreign)));
    BAD(plm_transient_start_at(reduced, point, 1), "plm_transient_start_at", "point", -1, "point is 1");
    BAD(plm_transient_start_at(reduced, foreign, 0), "plm_transient_start_at", "branch", -1, "another basis");
    BAD(plm_transient_start_at(full, foreign, 0), "plm_transient_start_at", "branch", -1, "another model");
    DEAD(plm_transient_start_at(full, NULL, 0), "plm_transient_start_at", "branch", "no live handle");
    plm_transient_get_double(reduced, "frequency_hz", &before);
    assert_true(before == 0); /* nothing has changed */
    assert_true(done(ctx, plm_transient_start_at(reduced, point, 0)));
    assert_true(done(ctx, plm_transient_start_at(full, point, 0)));
    plm_transient_get_state(reduced, 1, &before, NULL);
    plm_transient_get_state(full, 1, &after, NULL);
    assert_true(close_to(after, before, 1e-12));
    assert_true(done(ctx, plm_basis_build(basis))); /* a transient keeps the basis it began with */
    assert_true(done(ctx, plm_transient_start_at(reduced, point, 0)));
}

static void too_early(void **state) {
    plm_model *raw = NULL;
    plm_basis *not_built = NULL;
    plm_transient *t = NULL, *u = NULL;
    const double q = 0;
    int64_t n = 7;
    double x = 7;
    (void)state;
    EARLY(plm_transient_run(reduced), "plm_transient_run", "frequency_hz", "not set");
    EARLY(plm_transient_run(full), "plm_transient_run", "frequency_hz", "not set");
    EARLY(plm_transient_find_periodic(reduced), "plm_transient_find_periodic", "frequency_hz", "not set");
    EARLY(plm_transient_get_history(full, 0, 1, &x, &n), "plm_transient_get_history", "transient",
          "has not run");
    EARLY(plm_transient_get_multipliers(reduced, 1, &x, &x, &n), "plm_transient_get_multipliers", "transient",
          "look for one first");
    EARLY(plm_transient_get_array(full, "time", 0, NULL, &n), "plm_transient_get_array", "transient",
          "has not run");
    EARLY(plm_transient_get_int(full, "stable", &n), "plm_transient_get_int", "transient",
          "look for one first");
    assert_true(done(ctx, plm_model_create(ctx, 1, &raw)));
    assert_true(done(ctx, plm_basis_create(raw, &not_built)));
    assert_true(done(ctx, plm_transient_create(raw, NULL, &t)));
    assert_true(done(ctx, plm_transient_create(raw, not_built, &u)));
    EARLY(plm_transient_set_state(t, 1, &q, NULL), "plm_transient_set_state", "model", "build it first");
    EARLY(plm_transient_get_state(u, 1, &x, NULL), "plm_transient_get_state", "model", "build it first");
    plm_basis_destroy(&not_built);
    assert_true(done(ctx, plm_basis_create(model, &not_built)));
    plm_transient_destroy(&u);
    assert_true(done(ctx, plm_transient_create(model, not_built, &u)));
    EARLY(plm_transient_run(u), "plm_transient_run", "basis", "build it first");
    BAD(plm_transient_find_periodic(full), "plm_transient_find_periodic", "transient", -1,
        "reduced models only");
    assert_true(x == 7 && n == 7);
}

static void modal_damping_of_a_full_model_is_refused(void **state) {
    static const int64_t ptr[] = {0, 1}, row[] = {0};
    static const double one[] = {1}, ratio[] = {0.02};
    plm_model *m = NULL;
    plm_transient *t = NULL;
    (void)state;
    assert_true(done(ctx, plm_model_create(ctx, 1, &m)));
    plm_model_set_matrix_i64(m, PLM_MASS, PLM_CSC, PLM_FULL, 0, PLM_COPY, 1, ptr, row, one);
    plm_model_set_matrix_i64(m, PLM_STIFFNESS, PLM_CSC, PLM_FULL, 0, PLM_COPY, 1, ptr, row, one);
    plm_model_set_modal_damping(m, 1, ratio);
    assert_true(done(ctx, plm_model_build(m)));
    assert_true(done(ctx, plm_transient_create(m, NULL, &t)));
    assert_true(done(ctx, plm_transient_set_double(t, "frequency_hz", 1)));
    BAD(plm_transient_run(t), "plm_transient_run", "modal_ratio", -1, "modal damping");
}

/* Supports left in the matrices as a number on the diagonal stay where they are, and no state moves them. */
static void what_is_held_has_no_state(void **state) {
    const int32_t i[] = {0, 1, 2}, row[] = {0, 1}, dof[] = {0};
    const double m[] = {1, 1, 1}, k[] = {40, 666, 666}, one[] = {1}, k_n[] = {1e3}, gap[] = {0.1},
                 force[] = {3, 0, 0}, q[] = {1, 0, 0.5}, v[] = {1, 0, 0};
    plm_model *held = NULL;
    plm_transient *t = NULL;
    (void)state;
    assert_true(done(ctx, plm_model_create(ctx, 3, &held)));
    assert_true(done(
        ctx, plm_model_set_matrix_i32(held, PLM_MASS, PLM_TRIPLETS, PLM_LOWER, 0, PLM_COPY, 3, i, i, m)));
    assert_true(done(ctx, plm_model_set_matrix_i32(held, PLM_STIFFNESS, PLM_TRIPLETS, PLM_LOWER, 0, PLM_COPY,
                                                   3, i, i, k)));
    assert_true(done(ctx, plm_model_add_gap_rows_i32(held, 0, 1, row, dof, one, k_n, gap)));
    assert_true(done(ctx, plm_model_set_excitation(held, 1, 3, force, NULL)));
    assert_true(done(ctx, plm_model_build(held)));
    assert_true(done(ctx, plm_transient_create(held, NULL, &t)));
    BAD(plm_transient_set_state(t, 3, q, v), "plm_transient_set_state", "q", 2, "held at zero");
    BAD(plm_transient_set_state(t, 3, NULL, q), "plm_transient_set_state", "v", 2, "held at zero");
    assert_true(done(ctx, plm_transient_set_state(t, 3, v, v)));
}

int main(void) {
#define TEST(f) cmocka_unit_test_setup_teardown(f, set_up, tear_down)
    const struct CMUnitTest tests[] = {
        TEST(arguments_are_checked),
        TEST(branches_of_others_are_refused),
        TEST(too_early),
        TEST(modal_damping_of_a_full_model_is_refused),
        TEST(what_is_held_has_no_state),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
