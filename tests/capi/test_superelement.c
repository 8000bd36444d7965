/* Structures that the host has reduced itself: a rod of masses, clamped at its left and with a stop beyond
 * its right end, handed over whole, by Craig and Bampton's method with closed-form modes, and in dense
 * coordinates. */
#include "check.h"

enum { WHOLE = 80, MODES = 40, SMALL = 1 + MODES, END = WHOLE - 1, INSIDE = 30 };
static const double mass = 1, spring = 4e6, gap = 2e-4, k_n = 1e5, force = 2;

static plm_context *ctx;

static int set_up(void **state) {
    (void)state;
    return plm_context_create(PLM_API_VERSION, &ctx);
}
static int tear_down(void **state) {
    (void)state;
    return plm_context_destroy(&ctx);
}

/* entry (i, j) of the rod's matrices */
static double m_of(int i, int j) {
    return i != j ? 0 : i == END ? mass / 2 : mass;
}
static double k_of(int i, int j) {
    if (i == j) return i == END ? spring : 2 * spring;
    return abs(i - j) == 1 ? -spring : 0;
}

/* T: WHOLE x SMALL, column 0 the constraint mode of the end, then the modes with the end held */
static double craig_bampton(int i, int column) {
    if (column == 0) return (i + 1.0) / WHOLE;
    return i == END ? 0 : sqrt(2.0 / WHOLE) * sin(acos(-1.0) * column * (i + 1.0) / WHOLE);
}
/* T: WHOLE x WHOLE, a reflection: every entry of what it transforms is taken */
static double reflection(int i, int column) {
    return (i == column) - 2.0 / WHOLE;
}

typedef double (*entry_fn)(int, int);

/* T^T A T for a tridiagonal A, n x n */
static void reduce(entry_fn a, entry_fn t, int n, double *out) {
    int i, j, p, q;
    for (i = 0; i < n * n; ++i) out[i] = 0;
    for (j = 0; j < n; ++j)
        for (p = 0; p < WHOLE; ++p) {
            double at = 0;
            for (q = p > 0 ? p - 1 : 0; q < WHOLE && q <= p + 1; ++q) at += a(p, q) * t(q, j);
            for (i = 0; i < n; ++i) out[i + j * n] += t(p, i) * at;
        }
}

typedef struct recovery {
    entry_fn t;
    int fail, calls; /* fail > 0: that code; < 0: NaN in column -1 - fail */
} recovery;

static int32_t recover(plm_context *c, int64_t n_dof, int64_t n_columns, const double *reduced,
                       int64_t n_full, double *full, void *user) {
    recovery *r = user;
    int64_t i, j, k;
    if (c != ctx || n_full != WHOLE) return 99;
    ++r->calls;
    for (k = 0; k < n_columns; ++k)
        for (i = 0; i < n_full; ++i) {
            double q = 0;
            for (j = 0; j < n_dof; ++j) q += r->t((int)i, (int)j) * reduced[j + k * n_dof];
            full[i + k * n_full] = r->fail == -1 - k ? NAN : q;
        }
    return r->fail > 0 ? r->fail : 0;
}

static plm_status finish_model(plm_model *m, int n, entry_fn t) {
    static double load[WHOLE], row[WHOLE];
    int j;
    for (j = 0; j < n; ++j) row[j] = t(END, j), load[j] = force * row[j];
    plm_status s = plm_model_set_rayleigh_damping(m, 0, 1e-3);
    if (!s) s = plm_model_add_dense_gap_rows(m, 1, row, 1, &k_n, &gap);
    if (!s) s = plm_model_set_excitation(m, 1, n, load, NULL);
    if (!s) s = plm_model_build(m);
    return s;
}

/* n coordinates by T; r: its recovery, or NULL */
static plm_status superelement(entry_fn t, int n, recovery *r, double error, plm_model **model) {
    static double m[WHOLE * WHOLE], k[WHOLE * WHOLE];
    reduce(m_of, t, n, m);
    reduce(k_of, t, n, k);
    plm_status s = plm_model_create(ctx, n, model);
    if (!s) s = plm_model_set_dense_matrix(*model, PLM_MASS, PLM_FULL, m, n);
    if (!s) s = plm_model_set_dense_matrix(*model, PLM_STIFFNESS, PLM_UPPER, k, n);
    if (!s && r) s = plm_model_set_recovery(*model, WHOLE, recover, r);
    if (!s) s = plm_model_set_double(*model, "reduction_error", error);
    if (!s) s = finish_model(*model, n, t);
    return s;
}

static double identity(int i, int j) {
    return i == j;
}

/* the rod as it is, by triplets */
static plm_status whole_rod(plm_model **model) {
    static int32_t row[2 * WHOLE], col[2 * WHOLE];
    static double m[2 * WHOLE], k[2 * WHOLE];
    int i, n = 0;
    for (i = 0; i < WHOLE; ++i) {
        row[n] = col[n] = i, m[n] = m_of(i, i), k[n++] = k_of(i, i);
        if (i > 0) row[n] = i, col[n] = i - 1, m[n] = 0, k[n++] = k_of(i, i - 1);
    }
    plm_status s = plm_model_create(ctx, WHOLE, model);
    if (!s)
        s = plm_model_set_matrix_i32(*model, PLM_MASS, PLM_TRIPLETS, PLM_LOWER, 0, PLM_COPY, n, row, col, m);
    if (!s)
        s = plm_model_set_matrix_i32(*model, PLM_STIFFNESS, PLM_TRIPLETS, PLM_LOWER, 0, PLM_COPY, n, row, col,
                                     k);
    if (!s) s = finish_model(*model, WHOLE, identity);
    return s;
}

/* The basis has one size in both, so that what differs is the superelement's. */
static plm_status first_resonance(plm_model *m, plm_branch **curve) {
    plm_basis *basis = NULL;
    plm_hbm *hbm = NULL;
    plm_status s = plm_basis_create(m, &basis);
    if (!s) s = plm_basis_set_string(basis, "kind", "full");
    if (!s) s = plm_basis_set_double(basis, "frequency_max_hz", 80);
    if (!s) s = plm_basis_build(basis);
    if (!s) s = plm_hbm_create(basis, &hbm);
    if (!s) s = plm_hbm_set_string(hbm, "motion", "harmonics");
    if (!s) s = plm_hbm_set_int(hbm, "n_harmonics", 5);
    if (!s) s = plm_hbm_set_double(hbm, "frequency_min_hz", 5);
    if (!s) s = plm_hbm_set_double(hbm, "frequency_max_hz", 12);
    if (!s) s = plm_hbm_sweep(hbm, curve);
    plm_hbm_destroy(&hbm);
    plm_basis_destroy(&basis);
    return s;
}

static double highest(const double *a, int64_t n) {
    double most = 0;
    while (n-- > 0)
        if (a[n] > most) most = a[n];
    return most;
}

/* With 40 of 79 modes the first resonance is that of the rod, and with all coordinates, mixed by a reflection
 * into matrices without a zero, to rounding. Both recover what the rod does inside. */
static void superelements_move_as_the_structure_does(void **state) {
    static double of_rod[4000], found[4000], full[WHOLE], q[WHOLE], whole_q[WHOLE];
    recovery r[] = {{craig_bampton, 0, 0}, {reflection, 0, 0}};
    const int size[] = {SMALL, WHOLE};
    plm_model *rod = NULL;
    plm_branch *curve = NULL;
    int64_t n, n_found, open;
    int way, i;
    (void)state;
    assert_true(done(ctx, whole_rod(&rod)));
    assert_true(done(ctx, first_resonance(rod, &curve)));
    assert_int_equal(plm_branch_get_amplitude(curve, INSIDE, PLM_PEAK, 0, 4000, of_rod, &n), PLM_OK);
    assert_int_equal(plm_branch_get_field(curve, n / 2, 0.1, WHOLE, whole_q), PLM_OK);
    for (way = 0; way < 2; ++way) {
        const double tolerance = way == 0 ? 1e-5 : 1e-8; /* the points of the curves differ a little */
        plm_model *m = NULL;
        plm_branch *b = NULL;
        assert_true(done(ctx, superelement(r[way].t, size[way], &r[way], 0, &m)));
        assert_true(done(ctx, first_resonance(m, &b)));
        assert_int_equal(plm_model_get_int(m, "n_full", &open), PLM_OK);
        assert_int_equal(open, WHOLE);
        assert_true(done(ctx, plm_model_recover_amplitude(m, b, INSIDE, PLM_PEAK, 0, 4000, found, &n_found)));
        assert_in_range(r[way].calls, 1, 3); /* 80 columns in blocks */
        assert_true(close_to(highest(found, n_found), highest(of_rod, n), tolerance));
        assert_int_equal(plm_branch_get_field(b, n_found / 2, 0.1, size[way], q), PLM_OK);
        assert_true(done(ctx, plm_model_recover(m, 1, q, WHOLE, full)));
        if (way == 1 && n_found == n)
            for (i = 0; i < WHOLE; ++i) assert_true(fabs(full[i] - whole_q[i]) < 1e-6 * highest(of_rod, n));
        plm_branch_destroy(&b);
        plm_model_destroy(&m);
    }
    plm_branch_destroy(&curve);
    plm_model_destroy(&rod);
}

/* Static answer of the recovered field, against a closed form: an end load stretches the rod evenly. */
static void many_columns_are_recovered_in_blocks(void **state) {
    static double q[SMALL * 100], full[WHOLE * 100];
    recovery r = {craig_bampton, 0, 0};
    plm_model *m = NULL;
    double worst = 0;
    int j, i;
    (void)state;
    for (j = 0; j < 100; ++j) q[j * SMALL] = j;
    assert_true(done(ctx, superelement(craig_bampton, SMALL, &r, 0, &m)));
    assert_true(done(ctx, plm_model_recover(m, 100, q, WHOLE, full)));
    for (j = 0; j < 100; ++j)
        for (i = 0; i < WHOLE; ++i) worst = larger(worst, fabs(full[i + j * WHOLE] - j * (i + 1.0) / WHOLE));
    assert_true(worst < 1e-12);
    assert_in_range(r.calls, 2, 50);
    assert_true(done(ctx, plm_model_recover(m, 0, NULL, WHOLE, NULL)));
    plm_model_destroy(&m);
}

/* What the host says of its own reduction is added, and said aloud where it is too much. */
static void the_hosts_error_is_passed_on(void **state) {
    const double stated[] = {0, 2e-4, 5e-2}, accuracy = 1e-3;
    double error[3], hz, amplitude;
    int k;
    (void)state;
    for (k = 0; k < 3; ++k) {
        plm_model *m = NULL;
        int32_t reason = 0;
        plm_status got;
        assert_true(done(ctx, superelement(craig_bampton, SMALL, NULL, stated[k], &m)));
        got = plm_model_compute_response(m, 0, PLM_PEAK, accuracy, &hz, &amplitude, &error[k], NULL, NULL);
        if (k < 2) {
            assert_true(done(ctx, got));
            assert_true(error[k] <= accuracy);
        } else {
            assert_int_equal(got, PLM_WARNING);
            assert_int_equal(plm_context_get_error_info(ctx, NULL, &reason, NULL, NULL), PLM_OK);
            assert_int_equal(reason, PLM_REASON_HOST_REDUCTION);
        }
        assert_true(error[k] >= stated[k] && error[k] <= stated[k] + accuracy);
        plm_model_destroy(&m);
    }
    assert_true(error[1] >= 2e-4 && error[1] < 1e-3);
}

static void dense_matrices_are_checked(void **state) {
    double a[3 * 4] = {2, -1, 0, 7, -1, 2, -1, 7, 0, -1, 2, 7}; /* 3 x 3, ld 4: the padding is not read */
    plm_model *m = NULL;
    const char *name = "plm_model_set_dense_matrix";
    (void)state;
    assert_int_equal(plm_model_create(ctx, 3, &m), PLM_OK);
    a[3] = a[7] = a[11] = NAN;
    assert_true(done(ctx, plm_model_set_dense_matrix(m, PLM_STIFFNESS, PLM_FULL, a, 4)));
    assert_true(refused(ctx, plm_model_set_dense_matrix(m, PLM_STIFFNESS, PLM_FULL, a, 2), PLM_ERR_ARGUMENT,
                        name, "ld", -1, "ld"));
    assert_true(refused(ctx, plm_model_set_dense_matrix(m, PLM_STIFFNESS, 4, a, 4), PLM_ERR_ARGUMENT, name,
                        "part", -1, "part"));
    assert_true(refused(ctx, plm_model_set_dense_matrix(m, 0, PLM_FULL, a, 4), PLM_ERR_ARGUMENT, name,
                        "which", -1, "which"));
    assert_true(refused(ctx, plm_model_set_dense_matrix(m, PLM_MASS, PLM_FULL, NULL, 4), PLM_ERR_ARGUMENT,
                        name, "value", -1, "value"));
    a[5] = INFINITY;
    assert_true(refused(ctx, plm_model_set_dense_matrix(m, PLM_MASS, PLM_LOWER, a, 4), PLM_ERR_MATRIX, name,
                        "value", 5, "row 1 and column 1"));
    a[5] = 2, a[8] = 0.5;
    assert_true(refused(ctx, plm_model_set_dense_matrix(m, PLM_MASS, PLM_FULL, a, 4), PLM_ERR_MATRIX, name,
                        "value", 2, "not symmetric"));
    assert_true(
        done(ctx, plm_model_set_dense_matrix(m, PLM_MASS, PLM_LOWER, a, 4))); /* that triangle is not read */
    a[8] = 0, a[1] = a[4] = 3;
    assert_true(refused(ctx, plm_model_set_dense_matrix(m, PLM_STIFFNESS, PLM_FULL, a, 4),
                        PLM_ERR_NOT_POSITIVE_DEFINITE, name, "value", 1, "indefinite"));
    assert_true(done(ctx, plm_model_set_dense_matrix(m, PLM_DAMPING, PLM_FULL, a, 4))); /* C may be */
    a[10] = -1e-3;
    assert_true(refused(ctx, plm_model_set_dense_matrix(m, PLM_MASS, PLM_UPPER, a, 4),
                        PLM_ERR_NOT_POSITIVE_DEFINITE, name, "value", 2, "indefinite"));
    a[10] = 0; /* a DOF without mass that is coupled to one with mass */
    assert_true(refused(ctx, plm_model_set_dense_matrix(m, PLM_MASS, PLM_UPPER, a, 4),
                        PLM_ERR_NOT_POSITIVE_DEFINITE, name, "value", 2, "indefinite"));
    plm_model_destroy(&m);
}

/* Free and massless: semi-definite by construction, with the rounding of a reduction in it. */
static void semi_definite_matrices_are_taken(void **state) {
    const double m[] = {2, 0, 0, 0}, k[] = {1, -1, -1, 1}, row[] = {1, -1};
    const double rounded[] = {1, -1, -1, 1 - 1e-10};
    plm_model *model = NULL;
    int64_t rigid;
    (void)state;
    assert_int_equal(plm_model_create(ctx, 2, &model), PLM_OK);
    assert_true(done(ctx, plm_model_set_dense_matrix(model, PLM_STIFFNESS, PLM_FULL, rounded, 2)));
    assert_true(done(ctx, plm_model_set_dense_matrix(model, PLM_MASS, PLM_FULL, m, 2)));
    assert_true(done(ctx, plm_model_set_dense_matrix(model, PLM_STIFFNESS, PLM_FULL, k, 2)));
    assert_true(done(ctx, plm_model_add_dense_gap_rows(model, 1, row, 1, &k_n, NULL)));
    assert_true(done(ctx, plm_model_build(model)));
    assert_int_equal(plm_model_get_int(model, "n_rigid_modes", &rigid), PLM_OK);
    assert_int_equal(rigid, 1);
    plm_model_destroy(&model);
}

static void dense_rows_are_checked(void **state) {
    double row[4] = {1, 0, -1, 0}, k[2] = {1, 1};
    const char *name = "plm_model_add_dense_gap_rows";
    plm_model *m = NULL;
    (void)state;
    assert_int_equal(plm_model_create(ctx, 2, &m), PLM_OK);
    assert_true(refused(ctx, plm_model_add_dense_gap_rows(m, 2, row, 2, k, NULL), PLM_ERR_ARGUMENT, name,
                        "row", 1, "gap row 1 is zero"));
    assert_true(refused(ctx, plm_model_add_dense_gap_rows(m, 2, row, 1, k, NULL), PLM_ERR_ARGUMENT, name,
                        "ld", -1, "ld"));
    assert_true(refused(ctx, plm_model_add_dense_gap_rows(m, 1, NULL, 2, k, NULL), PLM_ERR_ARGUMENT, name,
                        "row", -1, "row"));
    row[3] = NAN;
    assert_true(refused(ctx, plm_model_add_dense_gap_rows(m, 2, row, 2, k, NULL), PLM_ERR_ARGUMENT, name,
                        "row", 3, "gap row 1 at DOF 1"));
    assert_true(done(ctx, plm_model_add_dense_gap_rows(m, 1, row, 2, k, NULL)));
    plm_model_destroy(&m);
}

static void recoveries_may_fail(void **state) {
    recovery r = {craig_bampton, 7, 0};
    double q[3 * SMALL] = {1}, full[3 * WHOLE] = {-5}, amplitude[1];
    plm_model *m = NULL, *other = NULL;
    plm_branch *curve = NULL, *stale;
    int64_t n, code;
    (void)state;
    assert_true(done(ctx, superelement(craig_bampton, SMALL, &r, 0, &m)));
    assert_true(done(ctx, superelement(craig_bampton, SMALL, NULL, 0, &other)));
    assert_true(refused(ctx, plm_model_recover(m, 1, q, WHOLE, full), PLM_ERR_CALLBACK, "plm_model_recover",
                        "fn", -1, "code 7"));
    assert_int_equal(plm_context_get_error_info(ctx, NULL, NULL, NULL, &code), PLM_OK);
    assert_int_equal(code, 7);
    r.fail = -1;
    assert_true(refused(ctx, plm_model_recover(m, 1, q, WHOLE, full), PLM_ERR_CALLBACK, "plm_model_recover",
                        "fn", 0, "NaN"));
    r.fail = -3; /* whichever column it is in */
    assert_true(refused(ctx, plm_model_recover(m, 3, q, WHOLE, full), PLM_ERR_CALLBACK, "plm_model_recover",
                        "fn", 2 * WHOLE, "NaN"));
    r.fail = 0;
    assert_true(full[0] == -5);
    assert_true(refused(ctx, plm_model_recover(m, 1, q, WHOLE - 1, full), PLM_ERR_ARGUMENT,
                        "plm_model_recover", "n_full", -1, "n_full"));
    assert_true(refused(ctx, plm_model_recover(other, 1, q, WHOLE, full), PLM_ERR_STATE, "plm_model_recover",
                        "model", -1, "no recovery"));
    assert_true(refused(ctx, plm_model_set_recovery(m, WHOLE, recover, &r), PLM_ERR_STATE,
                        "plm_model_set_recovery", "", -1, "built"));
    assert_true(done(ctx, first_resonance(other, &curve)));
    assert_true(refused(ctx, plm_model_recover_amplitude(m, curve, 0, PLM_PEAK, 0, 1, amplitude, &n),
                        PLM_ERR_ARGUMENT, "plm_model_recover_amplitude", "branch", -1, "another model"));
    stale = curve;
    plm_branch_destroy(&curve);
    assert_true(refused(ctx, plm_model_recover_amplitude(m, stale, 0, PLM_PEAK, 0, 1, amplitude, &n),
                        PLM_ERR_HANDLE, "plm_model_recover_amplitude", "branch", -1, "branch"));
    plm_model_destroy(&m);
    plm_model_destroy(&other);
    assert_int_equal(plm_model_create(ctx, 2, &m), PLM_OK);
    assert_true(refused(ctx, plm_model_set_recovery(m, 0, recover, &r), PLM_ERR_ARGUMENT,
                        "plm_model_set_recovery", "n_full", -1, "n_full"));
    assert_int_equal(plm_model_set_recovery(m, 0, NULL, NULL), PLM_OK);
    plm_model_destroy(&m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(superelements_move_as_the_structure_does, set_up, tear_down),
        cmocka_unit_test_setup_teardown(many_columns_are_recovered_in_blocks, set_up, tear_down),
        cmocka_unit_test_setup_teardown(the_hosts_error_is_passed_on, set_up, tear_down),
        cmocka_unit_test_setup_teardown(dense_matrices_are_checked, set_up, tear_down),
        cmocka_unit_test_setup_teardown(semi_definite_matrices_are_taken, set_up, tear_down),
        cmocka_unit_test_setup_teardown(dense_rows_are_checked, set_up, tear_down),
        cmocka_unit_test_setup_teardown(recoveries_may_fail, set_up, tear_down),
    };
    return cmocka_run_group_tests_name("superelement", tests, NULL, NULL);
}
