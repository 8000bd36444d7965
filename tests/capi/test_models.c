/* Models of every kind: all forms of input make the same one; loose bodies; no contact at all. */
#include "chain.h"
#include "check.h"
#include <string.h>

static plm_context *ctx;

static int set_up(void **state) {
    (void)state;
    return plm_context_create(PLM_API_VERSION, &ctx);
}
static int tear_down(void **state) {
    (void)state;
    return plm_context_destroy(&ctx);
}

static void all_kinds_of_input_make_one_model(void **state) {
    static const int64_t a[] = {7, 8, 9}, b[] = {16, 17, 18}, g[] = {22, 0, 0}, fixed[] = {2, 3, 2};
    static const int64_t row_ptr[] = {0, 2, 3}, dof[] = {6, 15, 21};
    static const int32_t row_ptr32[] = {0, 2, 3}, dof32[] = {6, 15, 21}, fixed32[] = {1, 2};
    static const double normal[] = {1, 0, 0}, k[] = {1e4, 2e4}, coefficient[] = {1, -1, 1}, loss[] = {0.01};
    double hz[3][4];
    chain c;
    int way, j;
    (void)state;
    chain_fill(&c);
    for (way = 0; way < 3; ++way) {
        plm_model *m = NULL;
        plm_status s = plm_model_create(ctx, CHAIN_DOFS, &m);
        if (!s)
            s = plm_model_set_matrix_i64(m, PLM_MASS, PLM_CSR, PLM_FULL, 0, PLM_BORROW, CHAIN_NNZ_FULL,
                                         c.col_ptr, c.row, c.m);
        if (!s)
            s = plm_model_set_matrix_i64(m, PLM_STIFFNESS, PLM_CSC, PLM_FULL, 0, PLM_COPY, CHAIN_NNZ_FULL,
                                         c.col_ptr, c.row, c.k);
        if (!s && way == 0) s = plm_model_add_node_pairs_i64(m, 1, 1, a, b, normal, k, NULL);
        if (!s && way == 0) s = plm_model_add_ground_contacts_i64(m, 1, 1, g, normal, k + 1, NULL);
        if (!s && way == 1) s = plm_model_add_gap_rows_i64(m, 0, 2, row_ptr, dof, coefficient, k, NULL);
        if (!s && way == 2) s = plm_model_add_gap_rows_i32(m, 0, 2, row_ptr32, dof32, coefficient, k, NULL);
        if (!s)
            s = way == 2 ? plm_model_fix_dofs_i32(m, 0, 2, fixed32) : plm_model_fix_dofs_i64(m, 1, 3, fixed);
        if (!s) s = plm_model_set_modal_damping(m, 1, loss);
        if (!s) s = plm_model_set_structural_damping(m, 0.001);
        if (!s) s = plm_model_set_double(m, "space_tolerance", 1e-9);
        if (!s) s = plm_model_build(m);
        if (!s) s = plm_model_get_modes(m, PLM_SYSTEM_SLIDING, NULL, 4, hz[way], NULL);
        assert_true(done(ctx, s));
        plm_model_destroy(&m);
    }
    for (j = 0; j < 4; ++j) {
        assert_true(close_to(hz[1][j], hz[0][j], 1e-12));
        assert_true(close_to(hz[2][j], hz[0][j], 1e-12));
    }
}

static const char *solver; /* NULL: the default */

/* two loose bodies of two masses each, and a pair between them if `contact` */
static plm_status loose_bodies(int contact, plm_model **model) {
    const int32_t mass_ptr[] = {0, 1, 2, 3, 4}, mass_row[] = {0, 1, 2, 3};
    const int32_t row[] = {0, 1, 1, 2, 3, 3}, col[] = {0, 0, 1, 2, 2, 3}, gap_ptr[] = {0, 2},
                  gap_dof[] = {1, 2};
    const double m[] = {1, 1, 1, 1}, k[] = {1e4, -1e4, 1e4, 1e4, -1e4, 1e4}, coefficient[] = {1, -1};
    const double stiffness[] = {2e4}, force[] = {1, 0, 0, 0}, squeeze[] = {1, 0, 0, -1};
    plm_model *p = NULL;
    plm_status s = plm_model_create(ctx, 4, &p);
    if (!s)
        s = plm_model_set_matrix_i32(p, PLM_MASS, PLM_CSC, PLM_UPPER, 0, PLM_COPY, 4, mass_ptr, mass_row, m);
    if (!s)
        s = plm_model_set_matrix_i32(p, PLM_STIFFNESS, PLM_TRIPLETS, PLM_LOWER, 0, PLM_COPY, 6, row, col, k);
    if (!s && contact)
        s = plm_model_add_gap_rows_i32(p, 0, 1, gap_ptr, gap_dof, coefficient, stiffness, NULL);
    if (!s) s = plm_model_set_excitation(p, 1, 4, force, NULL);
    if (!s && contact) s = plm_model_set_preload(p, 4, squeeze);
    if (!s && solver) s = plm_model_set_string(p, "solver", solver);
    if (!s) s = plm_model_build(p);
    *model = p;
    return s;
}

static void loose_bodies_held_by_contact(void **state) {
    plm_model *m = NULL;
    double hz[4], shift = 0, u = 0, want;
    int64_t n = 0;
    (void)state;
    assert_true(done(ctx, loose_bodies(1, &m)));
    assert_int_equal(plm_model_get_int(m, "n_rigid_modes", &n), PLM_OK);
    assert_int_equal(n, 2);
    assert_int_equal(plm_model_get_double(m, "shift", &shift), PLM_OK);
    assert_true(close_to(shift, 200, 1e-6)); /* 1 % of the first elastic eigenvalue 2 k / m */
    assert_true(done(ctx, plm_model_get_modes(m, PLM_SYSTEM_OPEN, NULL, 4, hz, NULL)));
    want = sqrt(2e4) / (2 * 3.14159265358979323846);
    assert_true(hz[0] == 0 && hz[1] == 0 && close_to(hz[2], want, 1e-10) && close_to(hz[3], want, 1e-10));
    assert_true(done(ctx, plm_model_get_modes(m, PLM_SYSTEM_SLIDING, NULL, 4, hz, NULL)));
    assert_true(hz[0] < 1e-4 && hz[1] > 1 && close_to(hz[2], want, 1e-10)); /* one rigid motion is left */
    assert_true(done(ctx, plm_model_solve_rest(m)));
    assert_int_equal(plm_model_get_array(m, "rest_penetration", 1, &u, &n), PLM_OK);
    assert_true(close_to(u, 1 / 2e4, 1e-9));
}

/* Results of a model that is not built, or not at rest yet. */
static void results_wait_for_their_computation(void **state) {
    double q[4];
    int64_t n = 0;
    plm_model *m = NULL;
    (void)state;
    assert_int_equal(plm_model_create(ctx, 4, &m), PLM_OK);
    assert_true(refused(ctx, plm_model_get_array(m, "rest_displacement", 4, q, &n), PLM_ERR_STATE,
                        "plm_model_get_array", "key", -1, "not known yet"));
    assert_true(done(ctx, loose_bodies(1, &m)));
    assert_true(refused(ctx, plm_model_get_array(m, "rest_displacement", 4, q, &n), PLM_ERR_STATE,
                        "plm_model_get_array", "key", -1, "not known yet"));
}

static void no_contact_is_a_linear_model(void **state) {
    plm_model *m = NULL;
    plm_sampler *sampler = NULL;
    double hz[4], local = 1;
    int64_t n = 7;
    (void)state;
    assert_true(done(ctx, loose_bodies(0, &m)));
    assert_int_equal(plm_model_get_int(m, "n_pairs", &n), PLM_OK);
    assert_int_equal(n, 0);
    assert_int_equal(plm_model_get_double(m, "local_stiffness", &local), PLM_OK);
    assert_true(local == 0);
    assert_true(done(ctx, plm_model_get_modes(m, PLM_SYSTEM_SLIDING, NULL, 4, hz, NULL)));
    assert_true(done(ctx, plm_model_solve_rest(m)));
    assert_int_equal(plm_model_get_array(m, "rest_force", 0, NULL, &n), PLM_OK);
    assert_int_equal(n, 0);
    assert_true(done(ctx, plm_model_audit(m, &n)));
    assert_int_equal(plm_sampler_create(m, &sampler), PLM_OK);
    assert_true(refused(ctx, plm_sampler_run(sampler), PLM_ERR_STATE, "plm_sampler_run", "sampler", -1,
                        "no contact pair"));
}

/* The library's own solvers by name are those of the default; one that was not built, or the host's where the
 * host has none, is refused by the build with its name, and nothing is lost: another is chosen and the model
 * is built. */
static void solvers_are_chosen_by_name(void **state) {
    const char *const own[] = {"cholmod", "eigen"};
    double want[4], hz[4];
    plm_model *m = NULL;
    int k, j, served = 0;
    (void)state;
    assert_true(done(ctx, loose_bodies(1, &m)));
    assert_true(done(ctx, plm_model_get_modes(m, PLM_SYSTEM_SLIDING, NULL, 4, want, NULL)));
    for (k = 0; k < 2; ++k) {
        plm_status s;
        solver = own[k];
        s = loose_bodies(1, &m);
        assert_true(s == PLM_OK || s == PLM_ERR_NOT_BUILT);
        if (s) continue;
        ++served;
        assert_true(done(ctx, plm_model_get_modes(m, PLM_SYSTEM_SLIDING, NULL, 4, hz, NULL)));
        for (j = 1; j < 4; ++j) assert_true(close_to(hz[j], want[j], 1e-10));
    }
    assert_in_range(served, 1, 2);
    solver = "host";
    assert_true(
        refused(ctx, loose_bodies(1, &m), PLM_ERR_STATE, "plm_model_build", "solver", -1, "no solver"));
    assert_true(done(ctx, plm_model_set_string(m, "solver", "auto")));
    assert_true(done(ctx, plm_model_build(m)));
    solver = NULL;
}

/* Two free bodies of two masses: 0, 0, and twice sqrt(2 k / m). */
static void modes_are_counted(void **state) {
    const double elastic = sqrt(2e4) / (2 * 3.14159265358979323846);
    const struct {
        double hz;
        int64_t count;
    } want[] = {{1e-3 * elastic, 2}, {0.999 * elastic, 2}, {1.001 * elastic, 4}, {1e6, 4}};
    plm_model *m = NULL;
    int64_t n = -7;
    size_t k;
    (void)state;
    assert_int_equal(plm_model_count_modes(NULL, 1, &n), PLM_ERR_HANDLE);
    assert_true(done(ctx, loose_bodies(1, &m)));
    for (k = 0; k < sizeof want / sizeof *want; ++k) {
        assert_true(done(ctx, plm_model_count_modes(m, want[k].hz, &n)));
        assert_int_equal(n, want[k].count);
    }
    n = -7;
    assert_true(refused(ctx, plm_model_count_modes(m, 0, &n), PLM_ERR_ARGUMENT, "plm_model_count_modes",
                        "frequency_hz", -1, "positive"));
    assert_true(refused(ctx, plm_model_count_modes(m, NAN, &n), PLM_ERR_ARGUMENT, "plm_model_count_modes",
                        "frequency_hz", -1, "finite"));
    assert_true(refused(ctx, plm_model_count_modes(m, 1, NULL), PLM_ERR_ARGUMENT, "plm_model_count_modes",
                        "count", -1, "NULL"));
    assert_int_equal(n, -7);
}

/* A chain of three DOFs a node, long enough for its factor to be more than a few arrays. */
enum { LONG_CHAIN = 1200 };
static plm_model *long_chain(void) {
    enum { DOFS = LONG_CHAIN };
    static int64_t row[2 * DOFS], col[2 * DOFS];
    static double k[2 * DOFS], m[DOFS];
    plm_model *model = NULL;
    int64_t i, nnz = 0;
    for (i = 0; i < DOFS; ++i) {
        m[i] = 1;
        row[nnz] = col[nnz] = i, k[nnz++] = 2;
        if (i >= 3) row[nnz] = i, col[nnz] = i - 3, k[nnz++] = -1;
    }
    assert_true(done(ctx, plm_model_create(ctx, DOFS, &model)));
    assert_true(done(ctx, plm_model_set_matrix_i64(model, PLM_STIFFNESS, PLM_TRIPLETS, PLM_LOWER, 0, PLM_COPY,
                                                   nnz, row, col, k)));
    for (i = 0; i < DOFS; ++i) row[i] = i;
    assert_true(done(ctx, plm_model_set_matrix_i64(model, PLM_MASS, PLM_TRIPLETS, PLM_LOWER, 0, PLM_COPY,
                                                   DOFS, row, row, m)));
    return model;
}

/* The memory is told before the build, phase by phase; over its limit the build fails before it factors, and
 * says what would fit: as much makes it pass. Estimates end with the input. */
static void memory_is_estimated_and_limited(void **state) {
    const char *const phases[] = {"memory_matrices", "memory_factorization", "memory_factor",
                                  "memory_modes",    "memory_contact_space", "memory_basis"};
    plm_model *m = long_chain();
    double bytes = -1, one = 0, sum = 0, factor = 0;
    size_t k;
    (void)state;
    assert_true(refused(ctx, plm_model_get_double(m, "memory_factor", &one), PLM_ERR_STATE,
                        "plm_model_get_double", "key", -1, "before the build"));
    assert_true(refused(ctx, plm_model_estimate_memory(m, NULL), PLM_ERR_ARGUMENT,
                        "plm_model_estimate_memory", "bytes", -1, "NULL"));
    assert_true(done(ctx, plm_model_estimate_memory(m, &bytes)));
    for (k = 0; k < sizeof phases / sizeof *phases; ++k) {
        assert_true(done(ctx, plm_model_get_double(m, phases[k], &one)));
        assert_true(one > 0 && one < bytes);
        sum += one;
    }
    assert_true(sum > bytes);
    assert_true(done(ctx, plm_model_get_double(m, "memory_factor", &factor)));
    assert_true(factor > 8 * LONG_CHAIN);
    assert_true(done(ctx, plm_model_set_double(m, "memory_limit", 0.5 * bytes / 1048576)));
    assert_true(
        refused(ctx, plm_model_build(m), PLM_ERR_MEMORY, "plm_model_build", "memory_limit", -1, "raise it"));
    assert_true(done(ctx, plm_model_set_double(m, "memory_limit", 1.001 * bytes / 1048576)));
    assert_true(done(ctx, plm_model_build(m)));
    assert_true(refused(ctx, plm_model_estimate_memory(m, &bytes), PLM_ERR_STATE, "plm_model_estimate_memory",
                        "", -1, "built"));
}

/* The host's order of elimination costs what it costs: backwards a chain fills nothing in, odd nodes after
 * even ones do. Results stay. What is no permutation is refused where it is wrong, and changes nothing. */
static void the_host_may_order_the_elimination(void **state) {
    enum { DOFS = LONG_CHAIN };
    static int32_t order[DOFS];
    int64_t wide[DOFS];
    double factor[2], hz[2][4];
    char built_with[512];
    int way, i;
    (void)state;
    for (way = 0; way < 2; ++way) {
        plm_model *m = long_chain();
        double bytes;
        for (i = 0; i < DOFS; ++i) {
            order[i] = way == 0 ? DOFS - 1 - i : i < DOFS / 2 ? i * 2 : 2 * i + 1 - DOFS;
            wide[i] = order[i] + 1;
        }
        if (way == 0) assert_true(done(ctx, plm_model_set_elimination_order_i32(m, 0, DOFS, order)));
        if (way == 1) assert_true(done(ctx, plm_model_set_elimination_order_i64(m, 1, DOFS, wide)));
        assert_true(refused(ctx, plm_model_set_elimination_order_i32(m, 0, 5, order), PLM_ERR_ARGUMENT,
                            "plm_model_set_elimination_order_i32", "n", -1, "1200 DOFs"));
        wide[77] = wide[3];
        assert_true(refused(ctx, plm_model_set_elimination_order_i64(m, 1, DOFS, wide), PLM_ERR_ARGUMENT,
                            "plm_model_set_elimination_order_i64", "dof", 77, "second time"));
        wide[3] = 0;
        assert_true(refused(ctx, plm_model_set_elimination_order_i64(m, 1, DOFS, wide), PLM_ERR_ARGUMENT,
                            "plm_model_set_elimination_order_i64", "dof", 3, "no DOF number"));
        assert_true(done(ctx, plm_model_estimate_memory(m, &bytes)));
        assert_true(done(ctx, plm_model_get_double(m, "memory_factor", &factor[way])));
        assert_true(done(ctx, plm_model_build(m)));
        assert_true(done(ctx, plm_model_get_modes(m, PLM_SYSTEM_OPEN, NULL, 4, hz[way], NULL)));
    }
    for (i = 0; i < 4; ++i) assert_true(close_to(hz[1][i], hz[0][i], 1e-10));
    assert_int_equal(plm_build_info(sizeof built_with, built_with, NULL), PLM_OK);
    if (strstr(built_with, "CHOLMOD")) assert_true(factor[1] != factor[0]);
}

/* A factor kept in single precision gives the modes of one in double (eps times the condition of 6e4 and
 * more), or is refused by a solver that has none. */
static void single_precision_costs_no_digit(void **state) {
    double hz[2][5];
    plm_status s = PLM_OK;
    int single, j;
    (void)state;
    for (single = 0; single < 2 && !s; ++single) {
        plm_model *m = long_chain();
        assert_true(done(ctx, plm_model_set_string(m, "factor_precision", single ? "single" : "double")));
        s = plm_model_build(m);
        if (!s) assert_true(done(ctx, plm_model_get_modes(m, PLM_SYSTEM_OPEN, NULL, 5, hz[single], NULL)));
    }
    if (s) {
        assert_true(refused(ctx, s, PLM_ERR_ARGUMENT, "plm_model_build", "factor_precision", -1, "cholmod"));
        return;
    }
    for (j = 0; j < 5; ++j) assert_true(close_to(hz[1][j], hz[0][j], 1e-10));
}

static void *count_and_allocate(int64_t bytes, void *user) {
    *(int64_t *)user += bytes;
    return malloc((size_t)bytes);
}
static void count_and_release(void *block, void *user) {
    (void)user;
    free(block);
}

/* A number of DOFs costs nothing by itself, however large: arrays of that size come with the matrices. */
static void a_number_of_dofs_takes_no_memory(void **state) {
    const int64_t most = INT64_C(3000000000), far_away[] = {most - 1, 0, most - 1};
    int64_t bytes = 0;
    plm_context *counting = NULL;
    plm_model *m = NULL;
    (void)state;
    assert_int_equal(plm_context_create_with_allocator(PLM_API_VERSION, count_and_allocate, count_and_release,
                                                       &bytes, &counting),
                     PLM_OK);
    assert_int_equal(plm_model_create(counting, most, &m), PLM_OK);
    assert_int_equal(plm_model_fix_dofs_i64(m, 0, 3, far_away), PLM_OK);
    assert_int_equal(plm_context_destroy(&counting), PLM_OK);
    assert_in_range(bytes, 1, 4096); /* what was fixed, three numbers, and at most a page around them */
}

int main(void) {
#define TEST(f) cmocka_unit_test_setup_teardown(f, set_up, tear_down)
    const struct CMUnitTest tests[] = {
        TEST(all_kinds_of_input_make_one_model),  TEST(loose_bodies_held_by_contact),
        TEST(no_contact_is_a_linear_model),       TEST(results_wait_for_their_computation),
        TEST(solvers_are_chosen_by_name),         TEST(modes_are_counted),
        TEST(a_number_of_dofs_takes_no_memory),   TEST(memory_is_estimated_and_limited),
        TEST(the_host_may_order_the_elimination), TEST(single_precision_costs_no_digit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
