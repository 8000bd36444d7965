/* Every bad input is refused with the status, argument, index and a text that says what to do, and changes
 * nothing. */
#include "chain.h"
#include "check.h"

static plm_context *ctx;
static plm_model *model;

static int set_up(void **state) {
    (void)state;
    return plm_context_create(PLM_API_VERSION, &ctx) || plm_model_create(ctx, 6, &model);
}
static int tear_down(void **state) {
    (void)state;
    return plm_context_destroy(&ctx);
}

#define REFUSED(call, status, function, argument, index, words)                                              \
    assert_true(refused(ctx, call, status, function, argument, index, words))
#define BAD(call, function, argument, index, words)                                                          \
    REFUSED(call, PLM_ERR_ARGUMENT, function, argument, index, words)

static int64_t count(const char *key) {
    int64_t n = -1;
    plm_model_get_int(model, key, &n);
    return n;
}

static void creation(void **state) {
    plm_context *c = NULL;
    plm_model *m = NULL;
    (void)state;
    assert_int_equal(plm_context_create(99, &c), PLM_ERR_ARGUMENT);
    assert_null(c);
    assert_int_equal(plm_context_create(PLM_API_VERSION, NULL), PLM_ERR_ARGUMENT);
    assert_int_equal(plm_context_create_with_allocator(PLM_API_VERSION, NULL, NULL, NULL, &c),
                     PLM_ERR_ARGUMENT);
    BAD(plm_model_create(ctx, 0, &m), "plm_model_create", "n_dof", -1, "n_dof is 0");
    BAD(plm_model_create(ctx, 6, NULL), "plm_model_create", "model", -1, "NULL");
    assert_null(m);
    BAD(plm_sampler_create(model, NULL), "plm_sampler_create", "sampler", -1, "NULL");
    BAD(plm_basis_create(model, NULL), "plm_basis_create", "basis", -1, "NULL");
}

static void matrices(void **state) {
    const char *f = "plm_model_set_matrix_i32";
    const int32_t diag_ptr[] = {1, 2, 3, 4, 5, 6, 7}, diag_row[] = {1, 2, 3, 4, 5, 6},
                  wrong_row[] = {1, 2, 3, 4, 5, 7};
    const int64_t bad_ptr[] = {0, 1, 2, 3, 4, 5, 7}, row64[] = {0, 1, 2, 3, 4, 5};
    double v[] = {1, 2, 3, 4, 5, 6};
    (void)state;
#define SET(which, storage, part, base, own, nnz, a, b, val)                                                 \
    plm_model_set_matrix_i32(model, which, storage, part, base, own, nnz, a, b, val)
    BAD(SET(9, PLM_CSC, PLM_FULL, 1, PLM_COPY, 6, diag_ptr, diag_row, v), f, "which", -1, "1..3");
    BAD(SET(PLM_MASS, 0, PLM_FULL, 1, PLM_COPY, 6, diag_ptr, diag_row, v), f, "storage", -1, "storage is 0");
    BAD(SET(PLM_MASS, PLM_CSC, 4, 1, PLM_COPY, 6, diag_ptr, diag_row, v), f, "part", -1, "part is 4");
    BAD(SET(PLM_MASS, PLM_CSC, PLM_FULL, 2, PLM_COPY, 6, diag_ptr, diag_row, v), f, "index_base", -1,
        "0 (C) or 1");
    BAD(SET(PLM_MASS, PLM_CSC, PLM_FULL, 1, 0, 6, diag_ptr, diag_row, v), f, "ownership", -1,
        "ownership is 0");
    BAD(SET(PLM_MASS, PLM_CSC, PLM_FULL, 1, PLM_COPY, -1, diag_ptr, diag_row, v), f, "nnz", -1, "nnz is -1");
    BAD(SET(PLM_MASS, PLM_CSC, PLM_FULL, 1, PLM_COPY, 6, NULL, diag_row, v), f, "a", -1, "NULL");
    BAD(SET(PLM_MASS, PLM_CSC, PLM_FULL, 1, PLM_COPY, 6, diag_ptr, NULL, v), f, "b", -1, "NULL");
    BAD(SET(PLM_MASS, PLM_CSC, PLM_FULL, 1, PLM_COPY, 6, diag_ptr, diag_row, NULL), f, "value", -1, "NULL");
    REFUSED(SET(PLM_MASS, PLM_CSC, PLM_FULL, 1, PLM_COPY, 6, diag_ptr, wrong_row, v), PLM_ERR_MATRIX, f, "b",
            5, "b[5] = 7");
    REFUSED(plm_model_set_matrix_i64(model, PLM_MASS, PLM_CSC, PLM_FULL, 0, PLM_COPY, 6, bad_ptr, row64, v),
            PLM_ERR_MATRIX, "plm_model_set_matrix_i64", "a", 6, "a[6] = 7");
    v[2] = NAN;
    REFUSED(SET(PLM_MASS, PLM_CSC, PLM_FULL, 1, PLM_COPY, 6, diag_ptr, diag_row, v), PLM_ERR_MATRIX, f,
            "value", 2, "row 3, column 3");
    v[2] = -3;
    REFUSED(SET(PLM_STIFFNESS, PLM_CSC, PLM_FULL, 1, PLM_COPY, 6, diag_ptr, diag_row, v), PLM_ERR_MATRIX, f,
            "value", 2, "negative");
    assert_int_equal(SET(PLM_DAMPING, PLM_CSC, PLM_FULL, 1, PLM_COPY, 6, diag_ptr, diag_row, v), PLM_OK);
    REFUSED(plm_model_build(model), PLM_ERR_STATE, "plm_model_build", "", -1, "mass matrix is missing");
#undef SET
}

static void damping_and_supports(void **state) {
    const double ratio[] = {0.01, 1.0};
    const int32_t dof32[] = {1, 6, 7};
    const int64_t dof64[] = {5, -1};
    (void)state;
    BAD(plm_model_set_rayleigh_damping(model, -1, 0), "plm_model_set_rayleigh_damping", "alpha", -1, ">= 0");
    BAD(plm_model_set_rayleigh_damping(model, 0, NAN), "plm_model_set_rayleigh_damping", "beta", -1, ">= 0");
    BAD(plm_model_set_modal_damping(model, 2, ratio), "plm_model_set_modal_damping", "ratio", 1, "[0, 1)");
    BAD(plm_model_set_modal_damping(model, 2, NULL), "plm_model_set_modal_damping", "ratio", -1, "NULL");
    assert_int_equal(plm_model_set_modal_damping(model, 1, ratio), PLM_OK);
    assert_int_equal(plm_model_set_modal_damping(model, 0, NULL), PLM_OK);
    BAD(plm_model_set_structural_damping(model, INFINITY), "plm_model_set_structural_damping", "eta", -1,
        "eta");
    BAD(plm_model_fix_dofs_i32(model, 1, 3, dof32), "plm_model_fix_dofs_i32", "dof", 2, "dof[2] = 7");
    BAD(plm_model_fix_dofs_i64(model, 0, 2, dof64), "plm_model_fix_dofs_i64", "dof", 1, "0..5");
    BAD(plm_model_fix_dofs_i32(model, 0, 1, NULL), "plm_model_fix_dofs_i32", "dof", -1, "NULL");
    BAD(plm_model_fix_dofs_i32(model, 3, 1, dof32), "plm_model_fix_dofs_i32", "index_base", -1, "0 (C)");
    BAD(plm_model_fix_dofs_i32(model, 0, -1, dof32), "plm_model_fix_dofs_i32", "n", -1, "n is -1");
}

static void node_pairs(void **state) {
    const char *f = "plm_model_add_node_pairs_i32";
    const int32_t a[] = {1, 2, 3, 1, 2, 3}, b[] = {4, 5, 6, 4, 5, 6}, outside[] = {4, 5, 6, 4, 5, 7},
                  none[] = {4, 5, 6, 0, 0, -3};
    const int64_t a64[] = {0, 1, 2}, b64[] = {3, 4, 6};
    double n[] = {1, 0, 0, 0, 0.5, 0};
    double k[] = {1, 0}, gap[] = {0, INFINITY};
    (void)state;
    BAD(plm_model_add_node_pairs_i32(model, 1, 2, a, b, n, k, NULL), f, "normal", 1, "|n| = 0.5");
    n[4] = 1;
    BAD(plm_model_add_node_pairs_i32(model, 1, 2, a, b, n, k, NULL), f, "stiffness", 1, "PLM_AUTO_STIFFNESS");
    k[1] = NAN;
    BAD(plm_model_add_node_pairs_i32(model, 1, 2, a, b, n, k, NULL), f, "stiffness", 1, "stiffness[1]");
    k[1] = 5;
    BAD(plm_model_add_node_pairs_i32(model, 1, 2, a, b, n, k, gap), f, "gap", 1, "gap[1]");
    BAD(plm_model_add_node_pairs_i32(model, 1, 2, a, outside, n, k, NULL), f, "dof_b", 5, "dof_b[5] = 7");
    BAD(plm_model_add_node_pairs_i32(model, 1, 2, none, b, n, k, NULL), f, "dof_a", 3, "no DOF at all");
    BAD(plm_model_add_node_pairs_i32(model, 1, 2, NULL, b, n, k, NULL), f, "dof_a", -1, "NULL");
    BAD(plm_model_add_node_pairs_i32(model, 1, 2, a, NULL, n, k, NULL), f, "dof_b", -1, "NULL");
    BAD(plm_model_add_node_pairs_i32(model, 1, 2, a, b, NULL, k, NULL), f, "normal", -1, "NULL");
    BAD(plm_model_add_node_pairs_i32(model, 1, 2, a, b, n, NULL, NULL), f, "stiffness", -1, "NULL");
    BAD(plm_model_add_node_pairs_i32(model, 1, -2, a, b, n, k, NULL), f, "n", -1, "n is -2");
    BAD(plm_model_add_node_pairs_i32(model, -1, 2, a, b, n, k, NULL), f, "index_base", -1,
        "index_base is -1");
    n[2] = NAN;
    BAD(plm_model_add_node_pairs_i32(model, 1, 2, a, b, n, k, NULL), f, "normal", 2, "NaN");
    n[2] = 0;
    BAD(plm_model_add_node_pairs_i64(model, 0, 1, a64, b64, n, k, NULL), "plm_model_add_node_pairs_i64",
        "dof_b", 2, "dof_b[2] = 6");
    BAD(plm_model_add_ground_contacts_i32(model, 0, 1, b + 3, n, k, gap + 1),
        "plm_model_add_ground_contacts_i32", "dof", 2, "dof[2] = 6");
    BAD(plm_model_add_ground_contacts_i64(model, 0, 1, a64, n, k, gap + 1),
        "plm_model_add_ground_contacts_i64", "gap", 0, "gap[0]");
    assert_int_equal(count("n_pairs"), 0);
    assert_int_equal(plm_model_add_node_pairs_i32(model, 1, 2, a, b, n, k, NULL), PLM_OK);
    assert_int_equal(plm_model_add_ground_contacts_i32(model, 1, 1, none + 3, n, k, NULL), PLM_ERR_ARGUMENT);
    assert_int_equal(count("n_pairs"), 2);
}

static void gap_rows(void **state) {
    const char *f = "plm_model_add_gap_rows_i32";
    const int32_t ptr[] = {0, 2, 3}, empty_row[] = {0, 2, 2}, from_one[] = {1, 2, 3}, dof[] = {0, 3, 5},
                  twice[] = {3, 3, 5}, outside[] = {0, 3, 6};
    const int64_t ptr64[] = {1, 2}, dof64[] = {0};
    const double c[] = {1, -1, 1}, nan[] = {1, NAN, 1}, zero[] = {1, -1, 0}, k[] = {1, PLM_AUTO_STIFFNESS},
                 soft[] = {1, -2};
    (void)state;
    BAD(plm_model_add_gap_rows_i32(model, 0, 2, empty_row, dof, c, k, NULL), f, "row_ptr", 2,
        "must increase");
    BAD(plm_model_add_gap_rows_i32(model, 0, 2, from_one, dof, c, k, NULL), f, "row_ptr", 0, "index base 0");
    BAD(plm_model_add_gap_rows_i32(model, 0, 2, NULL, dof, c, k, NULL), f, "row_ptr", -1, "NULL");
    BAD(plm_model_add_gap_rows_i32(model, 0, 2, ptr, twice, c, k, NULL), f, "dof", 1, "twice");
    BAD(plm_model_add_gap_rows_i32(model, 0, 2, ptr, outside, c, k, NULL), f, "dof", 2, "dof[2] = 6");
    BAD(plm_model_add_gap_rows_i32(model, 0, 2, ptr, NULL, c, k, NULL), f, "dof", -1, "NULL");
    BAD(plm_model_add_gap_rows_i32(model, 0, 2, ptr, dof, NULL, k, NULL), f, "coefficient", -1, "NULL");
    BAD(plm_model_add_gap_rows_i32(model, 0, 2, ptr, dof, nan, k, NULL), f, "coefficient", 1, "NaN");
    BAD(plm_model_add_gap_rows_i32(model, 0, 2, ptr, dof, zero, k, NULL), f, "coefficient", 2,
        "gap row 1 is zero");
    BAD(plm_model_add_gap_rows_i32(model, 0, 2, ptr, dof, c, soft, NULL), f, "stiffness", 1, "> 0");
    BAD(plm_model_add_gap_rows_i64(model, 1, 1, ptr64, dof64, c, k, NULL), "plm_model_add_gap_rows_i64",
        "dof", 0, "1..6");
    assert_int_equal(count("n_pairs"), 0);
    assert_int_equal(plm_model_add_gap_rows_i32(model, 0, 2, ptr, dof, c, k, NULL), PLM_OK);
    assert_int_equal(count("n_pairs"), 2);
}

static void constraints(void **state) {
    const char *f = "plm_model_add_constraints_i32";
    const int32_t ptr[] = {0, 2, 3}, empty_row[] = {0, 2, 2}, from_one[] = {1, 2, 3}, dof[] = {0, 3, 5},
                  twice[] = {3, 3, 5}, outside[] = {0, 3, 6};
    const int64_t ptr64[] = {1, 2}, dof64[] = {0};
    const double c[] = {1, -1, 1}, nan[] = {1, NAN, 1}, zero[] = {1, -1, 0};
    (void)state;
    BAD(plm_model_add_constraints_i32(model, 0, 2, empty_row, dof, c), f, "row_ptr", 2,
        "every constraint row");
    BAD(plm_model_add_constraints_i32(model, 0, 2, from_one, dof, c), f, "row_ptr", 0, "index base 0");
    BAD(plm_model_add_constraints_i32(model, 0, 2, NULL, dof, c), f, "row_ptr", -1, "NULL");
    BAD(plm_model_add_constraints_i32(model, 0, -1, ptr, dof, c), f, "n", -1, "n is -1");
    BAD(plm_model_add_constraints_i32(model, 2, 2, ptr, dof, c), f, "index_base", -1, "0 (C)");
    BAD(plm_model_add_constraints_i32(model, 0, 2, ptr, twice, c), f, "dof", 1, "twice");
    BAD(plm_model_add_constraints_i32(model, 0, 2, ptr, outside, c), f, "dof", 2, "dof[2] = 6");
    BAD(plm_model_add_constraints_i32(model, 0, 2, ptr, NULL, c), f, "dof", -1, "NULL");
    BAD(plm_model_add_constraints_i32(model, 0, 2, ptr, dof, NULL), f, "coefficient", -1, "NULL");
    BAD(plm_model_add_constraints_i32(model, 0, 2, ptr, dof, nan), f, "coefficient", 1, "NaN");
    BAD(plm_model_add_constraints_i32(model, 0, 2, ptr, dof, zero), f, "coefficient", 2,
        "constraint row 1 is zero");
    BAD(plm_model_add_constraints_i64(model, 1, 1, ptr64, dof64, c), "plm_model_add_constraints_i64", "dof",
        0, "1..6");
    assert_int_equal(plm_model_add_constraints_i32(model, 0, 2, ptr, dof, c), PLM_OK);
}

static void loads(void **state) {
    const double f[] = {1, 2, 3, 4, 5, 6}, bad[] = {1, 2, 3, 4, INFINITY, 6};
    (void)state;
    BAD(plm_model_set_preload(model, 5, f), "plm_model_set_preload", "n", -1, "6 DOFs");
    BAD(plm_model_set_preload(model, 6, bad), "plm_model_set_preload", "force", 4, "force[4]");
    assert_int_equal(plm_model_set_preload(model, 6, NULL), PLM_OK);
    BAD(plm_model_set_excitation(model, -1, 6, f, NULL), "plm_model_set_excitation", "harmonic", -1,
        "harmonic is -1");
    BAD(plm_model_set_excitation(model, 1, 7, f, NULL), "plm_model_set_excitation", "n", -1, "n is 7");
    BAD(plm_model_set_excitation(model, 1, 6, f, bad), "plm_model_set_excitation", "imag", 4, "imag[4]");
    BAD(plm_model_set_excitation(model, 0, 6, f, f), "plm_model_set_excitation", "imag", -1, "harmonic 0");
    BAD(plm_model_set_excitation(model, 1, 6, NULL, f), "plm_model_set_excitation", "real", -1,
        "real is NULL");
    assert_int_equal(plm_model_set_excitation(model, 1, 6, NULL, NULL), PLM_OK);
}

static void growing_loads(void **state) {
    const char *f = "plm_model_set_growing_excitation";
    const double one[6] = {1, 1, 1, 1, 1, 1}, bad[6] = {1, 1, 1, 1, NAN, 1};
    (void)state;
    BAD(plm_model_set_growing_excitation(model, -1, 2, 6, one, NULL), f, "harmonic", -1, "harmonic is -1");
    BAD(plm_model_set_growing_excitation(model, 1, 3, 6, one, NULL), f, "power", -1, "power is 3");
    BAD(plm_model_set_growing_excitation(model, 1, -1, 6, one, NULL), f, "power", -1, "power is -1");
    BAD(plm_model_set_growing_excitation(model, 1, 2, 7, one, NULL), f, "n", -1, "n is 7");
    BAD(plm_model_set_growing_excitation(model, 1, 2, 6, bad, NULL), f, "real", 4, "real[4]");
    BAD(plm_model_set_growing_excitation(model, 0, 2, 6, one, one), f, "imag", -1, "harmonic 0");
    BAD(plm_model_set_growing_excitation(model, 1, 2, 6, NULL, one), f, "real", -1, "real is NULL");
    assert_int_equal(plm_model_set_growing_excitation(model, 1, 2, 6, one, one), PLM_OK);
    assert_int_equal(plm_model_set_growing_excitation(model, 1, 2, 6, NULL, NULL), PLM_OK);
}

static void base_motion(void **state) {
    const char *f = "plm_model_set_base_motion";
    const double one[6] = {1, 1, 1, 1, 1, 1}, bad[6] = {1, 1, 1, 1, NAN, 1};
    (void)state;
    BAD(plm_model_set_base_motion(model, 3, 1, 6, one, NULL), f, "quantity", -1, "quantity is 3");
    BAD(plm_model_set_base_motion(model, PLM_VELOCITY, 0, 6, one, NULL), f, "harmonic", -1, "harmonic is 0");
    BAD(plm_model_set_base_motion(model, PLM_VELOCITY, 1, 7, one, NULL), f, "n", -1, "n is 7");
    BAD(plm_model_set_base_motion(model, PLM_VELOCITY, 1, 6, one, bad), f, "imag", 4, "imag[4]");
    BAD(plm_model_set_base_motion(model, PLM_VELOCITY, 1, 6, NULL, one), f, "real", -1, "real is NULL");
    assert_int_equal(plm_model_set_base_motion(model, PLM_ACCELERATION, 1, 6, one, one), PLM_OK);
    assert_int_equal(plm_model_set_base_motion(model, PLM_DISPLACEMENT, 1, 6, NULL, NULL), PLM_OK);
}

static void gap_motion(void **state) {
    const char *f = "plm_model_set_gap_motion";
    const int32_t ptr[] = {0, 1, 2}, dof[] = {0, 1};
    const double one[] = {1, 1}, bad[] = {1, NAN};
    (void)state;
    BAD(plm_model_set_gap_motion(model, 1, 2, one, NULL), f, "n", -1,
        "0 contact pairs so far; add all pairs");
    assert_int_equal(plm_model_add_gap_rows_i32(model, 0, 2, ptr, dof, one, one, NULL), PLM_OK);
    BAD(plm_model_set_gap_motion(model, -1, 2, one, NULL), f, "harmonic", -1, "harmonic is -1");
    BAD(plm_model_set_gap_motion(model, 1, 3, one, NULL), f, "n", -1, "n is 3");
    BAD(plm_model_set_gap_motion(model, 1, 2, bad, NULL), f, "real", 1, "real[1]");
    BAD(plm_model_set_gap_motion(model, 1, 2, one, bad), f, "imag", 1, "imag[1]");
    BAD(plm_model_set_gap_motion(model, 0, 2, one, one), f, "imag", -1, "harmonic 0");
    BAD(plm_model_set_gap_motion(model, 1, 2, NULL, one), f, "real", -1, "real is NULL");
    assert_int_equal(plm_model_set_gap_motion(model, 1, 2, one, one), PLM_OK);
    assert_int_equal(plm_model_set_gap_motion(model, 1, 0, NULL, NULL), PLM_OK);
}

static void text_outputs(void **state) {
    char buffer[8] = "before";
    int64_t needed = 77;
    (void)state;
    assert_int_equal(plm_status_text(PLM_ERR_KEY, 0, NULL, &needed), PLM_OK);
    assert_true(needed > 20);
    assert_int_equal(plm_status_text(PLM_OK, 8, buffer, NULL), PLM_OK);
    assert_string_equal(buffer, "done");
    assert_int_equal(plm_status_text(12345, 8, buffer, &needed), PLM_OK);
    assert_string_equal(buffer, "unknown");
    assert_int_equal(plm_status_text(0, 8, NULL, &needed), PLM_ERR_ARGUMENT);
    assert_int_equal(plm_status_text(0, -1, buffer, &needed), PLM_ERR_ARGUMENT);
    assert_int_equal(plm_build_info(8, buffer, &needed), PLM_OK);
    assert_string_equal(buffer, "libplm ");
    assert_true(needed > 40);
}

static void version(void **state) {
    int32_t major = -1, minor = -1, patch = -1;
    (void)state;
    assert_int_equal(plm_version(&major, &minor, NULL), PLM_ERR_ARGUMENT);
    assert_int_equal(major, -1);
    assert_int_equal(plm_version(&major, &minor, &patch), PLM_OK);
    assert_true(major == 0 && minor >= 1 && patch >= 0);
}

static void too_early(void **state) {
    double hz = 5;
    int64_t n = 5;
    int32_t severity = 5;
    plm_sampler *sampler = NULL;
    plm_basis *basis = NULL, *parent = NULL;
    plm_hbm *hbm = NULL;
    plm_branch *branch = NULL;
    (void)state;
    REFUSED(plm_model_solve_rest(model), PLM_ERR_STATE, "plm_model_solve_rest", "model", -1,
            "not built; build it first");
    REFUSED(plm_model_get_modes(model, PLM_SYSTEM_OPEN, NULL, 1, &hz, NULL), PLM_ERR_STATE,
            "plm_model_get_modes", "model", -1, "not built");
    REFUSED(plm_model_audit(model, &n), PLM_ERR_STATE, "plm_model_audit", "model", -1, "not built");
    REFUSED(plm_model_get_finding(model, 0, &severity, &hz, 0, NULL, NULL), PLM_ERR_STATE,
            "plm_model_get_finding", "", -1, "audit the model first");
    REFUSED(plm_model_get_array(model, "rest_force", 0, NULL, &n), PLM_ERR_STATE, "plm_model_get_array",
            "key", -1, "solve for it first");
    REFUSED(plm_model_get_int(model, "n_free", &n), PLM_ERR_STATE, "plm_model_get_int", "model", -1,
            "not built");
    assert_int_equal(plm_sampler_create(model, &sampler), PLM_OK);
    assert_int_equal(plm_basis_create(model, &basis), PLM_OK);
    assert_int_equal(plm_basis_create(model, &parent), PLM_OK);
    assert_int_equal(plm_hbm_create(basis, &hbm), PLM_OK);
    REFUSED(plm_sampler_run(sampler), PLM_ERR_STATE, "plm_sampler_run", "model", -1, "not built");
    REFUSED(plm_sampler_get_double(sampler, "blf_hz", &hz), PLM_ERR_STATE, "plm_sampler_get_double",
            "sampler", -1, "not run; run it first");
    REFUSED(plm_basis_build(basis), PLM_ERR_STATE, "plm_basis_build", "model", -1, "not built");
    REFUSED(plm_basis_set_parent(basis, parent), PLM_ERR_STATE, "plm_basis_set_parent", "basis", -1,
            "not built; build it first");
    REFUSED(plm_basis_get_int(basis, "size", &n), PLM_ERR_STATE, "plm_basis_get_int", "basis", -1,
            "not built; build it first");
    REFUSED(plm_hbm_sweep(hbm, &branch), PLM_ERR_STATE, "plm_hbm_sweep", "basis", -1, "build it first");
    BAD(plm_hbm_solve(hbm, 0, NULL, 0, &branch), "plm_hbm_solve", "frequency_hz", -1, "> 0");
    BAD(plm_sampler_add_dominant_mode(sampler, 3, 1), "plm_sampler_add_dominant_mode", "system", -1, "0..2");
    BAD(plm_sampler_add_dominant_mode(sampler, 0, 0), "plm_sampler_add_dominant_mode", "mode", -1,
        "mode is 0");
    assert_true(hz == 5 && n == 5 && severity == 5 && branch == NULL);
}

/* of outputs before and after the build */
static void outputs(void **state) {
    const char *f = "plm_model_add_outputs_i32";
    const int32_t ptr[] = {0, 2, 3}, empty_row[] = {0, 2, 2}, dof[] = {0, 3, 5}, twice[] = {3, 3, 5},
                  outside[] = {0, 3, 6};
    const int64_t ptr64[] = {1, 2}, dof64[] = {0}, own[] = {7};
    const double c[] = {1, -1, 1}, nan[] = {1, NAN, 1}, zero[] = {1, -1, 0};
    int64_t first = 7;
    (void)state;
    BAD(plm_model_add_outputs_i32(model, 0, 2, empty_row, dof, c, &first), f, "row_ptr", 2,
        "every output row");
    BAD(plm_model_add_outputs_i32(model, 0, 2, NULL, dof, c, &first), f, "row_ptr", -1, "NULL");
    BAD(plm_model_add_outputs_i32(model, 0, 0, ptr, dof, c, &first), f, "n", -1, "n is 0");
    BAD(plm_model_add_outputs_i32(model, 2, 2, ptr, dof, c, &first), f, "index_base", -1, "0 (C)");
    BAD(plm_model_add_outputs_i32(model, 0, 2, ptr, twice, c, &first), f, "dof", 1, "twice");
    BAD(plm_model_add_outputs_i32(model, 0, 2, ptr, outside, c, &first), f, "dof", 2, "dof[2] = 6");
    BAD(plm_model_add_outputs_i32(model, 0, 2, ptr, NULL, c, &first), f, "dof", -1, "NULL");
    BAD(plm_model_add_outputs_i32(model, 0, 2, ptr, dof, NULL, &first), f, "coefficient", -1, "NULL");
    BAD(plm_model_add_outputs_i32(model, 0, 2, ptr, dof, nan, &first), f, "coefficient", 1, "NaN");
    BAD(plm_model_add_outputs_i32(model, 0, 2, ptr, dof, zero, &first), f, "coefficient", 2,
        "output row 1 is zero");
    BAD(plm_model_add_outputs_i32(model, 0, 2, ptr, dof, c, NULL), f, "first_dof", -1, "NULL");
    BAD(plm_model_add_outputs_i64(model, 1, 1, ptr64, dof64, c, &first), "plm_model_add_outputs_i64", "dof",
        0, "1..6");
    assert_int_equal(first, 7);
    assert_int_equal(plm_model_add_outputs_i32(model, 0, 2, ptr, dof, c, &first), PLM_OK);
    assert_int_equal(first, 6);
    assert_int_equal(plm_model_add_outputs_i32(model, 0, 2, ptr, dof, c, &first), PLM_OK);
    assert_int_equal(first, 8);
    BAD(plm_model_add_outputs_i64(model, 1, 1, ptr64, own, c, &first), "plm_model_add_outputs_i64", "dof", 0,
        "1..6"); /* sums are of DOFs alone */
}

/* What was made before loads change is refused until it is made again; what was computed can still be read.
 */
static void changed_loads(void **state) {
    plm_model *built = NULL;
    plm_sampler *sampler = NULL;
    plm_basis *basis = NULL;
    plm_hbm *hbm = NULL;
    plm_branch *before = NULL, *after = NULL;
    plm_transient *motion = NULL;
    double residual[2] = {0, 0}, amplitude[2] = {0, 0}, q[CHAIN_DOFS];
    int64_t count = 0;
    chain c;
    (void)state;
    chain_fill(&c);
    assert_true(done(ctx, chain_built(ctx, 0, &built)));
    assert_int_equal(plm_sampler_create(built, &sampler), PLM_OK);
    assert_true(plm_sampler_run(sampler) >= 0);
    assert_int_equal(plm_basis_create(built, &basis), PLM_OK);
    assert_int_equal(plm_basis_set_sampler(basis, sampler), PLM_OK);
    assert_true(plm_basis_build(basis) >= 0);
    assert_int_equal(plm_hbm_create(basis, &hbm), PLM_OK);
    assert_int_equal(plm_transient_create(built, basis, &motion), PLM_OK);
    assert_int_equal(plm_transient_get_state(motion, CHAIN_DOFS, q, NULL), PLM_OK);
    assert_true(plm_hbm_solve(hbm, 1.0, NULL, 0, &before) >= 0);
    assert_int_equal(plm_branch_get_full_residual(before, 0, &residual[0]), PLM_OK);
    assert_int_equal(plm_branch_get_amplitude(before, 0, PLM_PEAK, 0, 1, &amplitude[0], &count), PLM_OK);

    BAD(plm_model_set_preload(built, CHAIN_DOFS - 1, c.preload), "plm_model_set_preload", "n", -1, "DOFs");
    assert_true(plm_hbm_solve(hbm, 1.0, NULL, 0, &after) >= 0); /* nothing has changed */
    for (int i = 0; i < CHAIN_DOFS; ++i) c.preload[i] *= 2;
    assert_true(plm_model_set_preload(built, CHAIN_DOFS, c.preload) >= 0);

    REFUSED(plm_hbm_solve(hbm, 1.0, NULL, 0, &after), PLM_ERR_STATE, "plm_hbm_solve", "basis", -1,
            "changed after the basis was made; build it again");
    REFUSED(plm_basis_build(basis), PLM_ERR_STATE, "plm_basis_build", "sampler", -1, "run it again");
    REFUSED(plm_transient_run(motion), PLM_ERR_STATE, "plm_transient_run", "transient", -1, "make a new one");
    assert_int_equal(plm_transient_get_state(motion, CHAIN_DOFS, q, NULL), PLM_OK);
    assert_int_equal(plm_branch_get_full_residual(before, 0, &residual[1]), PLM_OK);
    assert_int_equal(plm_branch_get_amplitude(before, 0, PLM_PEAK, 0, 1, &amplitude[1], &count), PLM_OK);
    assert_true(residual[0] == residual[1] && amplitude[0] == amplitude[1]);

    assert_true(plm_sampler_run(sampler) >= 0);
    REFUSED(plm_hbm_solve(hbm, 1.0, NULL, 0, &after), PLM_ERR_STATE, "plm_hbm_solve", "basis", -1, "again");
    assert_true(plm_basis_build(basis) >= 0);
    assert_true(plm_hbm_solve(hbm, 1.0, NULL, 0, &after) >= 0);
    BAD(plm_hbm_solve(hbm, 1.0, before, 0, &after), "plm_hbm_solve", "start", -1, "another basis");
    assert_int_equal(plm_branch_get_amplitude(after, 0, PLM_PEAK, 0, 1, &amplitude[1], &count), PLM_OK);
    assert_true(amplitude[0] != amplitude[1]);
}

static void too_late(void **state) {
    plm_model *built = NULL;
    plm_sampler *sampler = NULL;
    const int32_t dof[] = {0};
    double hz[3] = {7, 7, 7}, small;
    int64_t n = 7;
    int32_t closed[2] = {1, 0};
    chain c;
    (void)state;
    chain_fill(&c);
    assert_true(done(ctx, chain_built(ctx, 0, &built)));
    REFUSED(plm_model_build(built), PLM_ERR_STATE, "plm_model_build", "", -1, "no longer changes");
    REFUSED(plm_model_add_constraints_i32(built, 0, 1, dof, dof, hz), PLM_ERR_STATE,
            "plm_model_add_constraints_i32", "", -1, "make a new one");
    REFUSED(plm_model_fix_dofs_i32(built, 0, 1, dof), PLM_ERR_STATE, "plm_model_fix_dofs_i32", "", -1,
            "make a new one");
    REFUSED(
        plm_model_set_matrix_i32(built, PLM_DAMPING, PLM_TRIPLETS, PLM_FULL, 0, PLM_COPY, 1, dof, dof, hz),
        PLM_ERR_STATE, "plm_model_set_matrix_i32", "", -1, "make a new one");
    REFUSED(plm_model_set_int(built, "max_blocks", 2), PLM_ERR_STATE, "plm_model_set_int", "", -1, "built");
    BAD(plm_model_get_modes(built, 4, NULL, 1, hz, NULL), "plm_model_get_modes", "system", -1, "0..3");
    BAD(plm_model_get_modes(built, PLM_SYSTEM_OPEN, closed, 1, hz, NULL), "plm_model_get_modes", "closed", -1,
        "NULL");
    BAD(plm_model_get_modes(built, PLM_SYSTEM_GIVEN, NULL, 1, hz, NULL), "plm_model_get_modes", "closed", -1,
        "NULL");
    BAD(plm_model_get_modes(built, PLM_SYSTEM_OPEN, NULL, 1000, hz, NULL), "plm_model_get_modes", "n", -1,
        "1..24");
    BAD(plm_model_get_modes(built, PLM_SYSTEM_OPEN, NULL, 1, NULL, NULL), "plm_model_get_modes",
        "frequency_hz", -1, "NULL");
    BAD(plm_model_get_array(built, "contact_stiffness", 1, &small, &n), "plm_model_get_array", "capacity", -1,
        "2 values");
    BAD(plm_model_get_array(built, "contact_stiffness", 2, NULL, &n), "plm_model_get_array", "values", -1,
        "NULL");
    BAD(plm_model_get_array(built, "contact_stiffness", 0, NULL, NULL), "plm_model_get_array", "count", -1,
        "NULL");
    assert_int_equal(plm_sampler_create(built, &sampler), PLM_OK);
    assert_true(hz[0] == 7 && n == 7);
}

int main(void) {
#define TEST(f) cmocka_unit_test_setup_teardown(f, set_up, tear_down)
    const struct CMUnitTest tests[] = {
        TEST(creation),      TEST(matrices),      TEST(damping_and_supports),
        TEST(node_pairs),    TEST(gap_rows),      TEST(constraints),
        TEST(loads),         TEST(growing_loads), TEST(base_motion),
        TEST(gap_motion),    TEST(text_outputs),  TEST(version),
        TEST(too_early),     TEST(too_late),      TEST(outputs),
        TEST(changed_loads),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
