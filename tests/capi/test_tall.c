/* Tall operations of the host in place of matrices: a rod with loose joints, handed over as matrices and
 * behind operations in plain C (tall_host.c), must come to the same numbers; what fails or does not fit is
 * said. */
#include "check.h"
#include "tall_host.h"

enum { N = 120, JOINTS = 3, MODES = 10, MOST_POINTS = 2000 };
static double mass[N * N], stiffness[N * N], damping[N * N], load[N], preload[N];

static plm_context *ctx;
static tall_host host;

typedef struct variant {
    int n;        /* DOFs of it, <= N */
    int clamped;  /* or free */
    int dashpot;  /* a matrix C, else Rayleigh's alone */
    int massless; /* every so many DOFs have no mass, 0: none */
    int held;     /* this many DOFs at the left end are the host's to hold */
} variant;
static const variant clamped = {N, 1, 0, 0, 0}, free_rod = {N, 0, 1, 0, 0}, massless = {N, 1, 0, 7, 0},
                     held = {N, 0, 0, 0, 2}, small = {24, 1, 1, 0, 0}, small_free = {20, 0, 0, 0, 0};

static void spring(int n, int a, int b, double k, double *matrix) {
    matrix[a + n * a] += k;
    if (b < 0) return;
    matrix[b + n * b] += k, matrix[a + n * b] -= k, matrix[b + n * a] -= k;
}

static void fill_matrices(const variant *v) {
    const int n = v->n;
    int i;
    memset(mass, 0, sizeof mass), memset(stiffness, 0, sizeof stiffness), memset(damping, 0, sizeof damping);
    memset(load, 0, sizeof load), memset(preload, 0, sizeof preload);
    for (i = 0; i < n; ++i) {
        mass[i + n * i] = v->massless && i % v->massless == 3 ? 0 : 1 + 0.3 * sin(i);
        spring(n, i, i + 1 < n ? i + 1 : -1, i + 1 < n ? 4e4 * (1 + 0.1 * cos(i)) : 0, stiffness);
    }
    if (v->clamped) spring(n, 0, -1, 5e4, stiffness);
    if (v->dashpot) spring(n, n / 2, n / 2 + 1, 0.8, damping);
    load[n / 3] = 3, load[n - 2] = -3;           /* balanced, as a free rod must be */
    preload[n - 1] = 0.2, preload[n / 4] = -0.2; /* apart, which closes the joints */
}

/* Rows and columns that are held, taken out as matrices have it. */
static plm_status take_matrices(plm_model *m, const variant *v) {
    static int32_t dof[N];
    plm_status s = plm_model_set_dense_matrix(m, PLM_MASS, PLM_FULL, mass, v->n);
    int i;
    if (!s) s = plm_model_set_dense_matrix(m, PLM_STIFFNESS, PLM_FULL, stiffness, v->n);
    if (!s && v->dashpot) s = plm_model_set_dense_matrix(m, PLM_DAMPING, PLM_FULL, damping, v->n);
    for (i = 0; i < v->held; ++i) dof[i] = i;
    if (!s && v->held) s = plm_model_fix_dofs_i32(m, 0, v->held, dof);
    return s;
}

static plm_status take_operations(plm_model *m, const variant *v) {
    static char which[N];
    int i;
    memset(&host, 0, sizeof host);
    for (i = 0; i < N; ++i) which[i] = (char)(i < v->held);
    host.n = v->n, host.m = mass, host.k = stiffness, host.c = v->dashpot ? damping : NULL;
    host.held = v->held ? which : NULL, host.ctx = ctx;
    return plm_model_set_tall_operations(m, tall_operation, &host);
}

static plm_status prepared(const variant *v, int behind, plm_model **m) {
    const int n = v->n;
    const int64_t row_ptr[JOINTS + 1] = {0, 2, 4, 6},
                                   dof[2 * JOINTS] = {n / 4 + 1, n / 4, n / 2 + 1, n / 2, n - 3, n - 4};
    const double coefficient[2 * JOINTS] = {1, -1, 1, -1, 1, -1},
                                 k_n[JOINTS] = {3e4, PLM_AUTO_STIFFNESS, 5e4}, gap[JOINTS] = {0, 1e-5, 0};
    plm_status s = plm_model_create(ctx, n, m);
    if (s) return s;
    fill_matrices(v);
    s = behind ? take_operations(*m, v) : take_matrices(*m, v);
    if (!s) s = plm_model_set_rayleigh_damping(*m, 0, 2e-4);
    if (!s)
        s = plm_model_set_double(*m, "space_tolerance", 1e-10); /* what is cut off is not the same in both */
    if (!s) s = plm_model_add_gap_rows_i64(*m, 0, JOINTS, row_ptr, dof, coefficient, k_n, gap);
    if (!s) s = plm_model_set_excitation(*m, 1, n, load, NULL);
    if (!s) s = plm_model_set_preload(*m, n, preload);
    return s;
}

static plm_model *built(const variant *v, int behind) {
    plm_model *m = NULL;
    assert_true(done(ctx, prepared(v, behind, &m)));
    assert_true(done_but_for(ctx, plm_model_build(m), PLM_REASON_ROUNDED));
    return m;
}

static int set_up(void **state) {
    (void)state;
    return plm_context_create(PLM_API_VERSION, &ctx);
}
static int tear_down(void **state) {
    (void)state;
    return plm_context_destroy(&ctx);
}

/* The end comes once, behind everything else, and nobody broke the contract. */
static void assert_ended(plm_model **behind) {
    assert_int_equal(host.ends, 0);
    assert_int_equal(plm_model_destroy(behind), PLM_OK);
    assert_int_equal(host.ends, 1);
    assert_int_equal(host.wrong, 0);
}

static void assert_same_modes(plm_model *a, plm_model *b, int32_t system, int n_dof, double tolerance) {
    static double hz[2][MODES], shape[2][N * MODES];
    int j, i;
    assert_true(done(ctx, plm_model_get_modes(a, system, NULL, MODES, hz[0], shape[0])));
    assert_true(done(ctx, plm_model_get_modes(b, system, NULL, MODES, hz[1], shape[1])));
    for (j = 0; j < MODES; ++j) {
        double same = 0, size = 0;
        if (hz[0][j] == 0) /* rigid, exactly so in both */
            assert_true(hz[1][j] == 0);
        else
            assert_true(close_to(hz[1][j], hz[0][j], tolerance));
        for (i = 0; i < n_dof; ++i) {
            same += shape[0][i + n_dof * j] * shape[1][i + n_dof * j];
            size += shape[0][i + n_dof * j] * shape[0][i + n_dof * j];
        }
        assert_true(close_to(fabs(same), size, 10 * tolerance)); /* single modes: the same but for the sign */
    }
}

static void modes_and_rest_are_those_of_the_matrices(void **state) {
    const variant *const variants[] = {&clamped, &free_rod, &massless, &held};
    size_t which;
    (void)state;
    for (which = 0; which < sizeof variants / sizeof variants[0]; ++which) {
        const variant *v = variants[which];
        plm_model *a = built(v, 0), *b = built(v, 1);
        /* a free rod has the digits that its static responses have beside a soft shift */
        const double tolerance = v->clamped || v->held ? 1e-9 : 1e-7;
        double q[2][N], largest = 0;
        int64_t n;
        int i;
        assert_same_modes(a, b, PLM_SYSTEM_OPEN, v->n, 1e-9);
        assert_true(done(ctx, plm_model_solve_rest(a)));
        assert_true(done(ctx, plm_model_solve_rest(b)));
        assert_int_equal(plm_model_get_array(a, "rest_displacement", N, q[0], &n), PLM_OK);
        assert_int_equal(plm_model_get_array(b, "rest_displacement", N, q[1], &n), PLM_OK);
        for (i = 0; i < v->n; ++i) largest = fmax(largest, fabs(q[0][i]));
        for (i = 0; i < v->n; ++i) assert_true(fabs(q[1][i] - q[0][i]) <= tolerance * largest);
        assert_same_modes(a, b, PLM_SYSTEM_REST, v->n, tolerance);
        assert_int_equal(plm_model_destroy(&a), PLM_OK);
        assert_ended(&b);
    }
}

static int64_t curve_of(plm_model *m, double *hz, double *amplitude, double *peak) {
    plm_branch *curve = NULL;
    int64_t n = 0;
    assert_true(plm_model_compute_response(m, N / 3, PLM_HALF_PEAK_TO_PEAK, 1e-3, peak, peak + 1, NULL,
                                           &curve, NULL) >= 0);
    assert_true(done(
        ctx, plm_branch_get_amplitude(curve, N / 3, PLM_HALF_PEAK_TO_PEAK, 0, MOST_POINTS, amplitude, &n)));
    assert_int_equal(plm_branch_get_array(curve, "frequency_hz", MOST_POINTS, hz, &n), PLM_OK);
    assert_int_equal(plm_branch_destroy(&curve), PLM_OK); /* it lives on the model */
    return n;
}

/* With what is "cannot" of the operations that may say so, and without. */
static void the_curve_is_that_of_the_matrices(void **state) {
    static double hz[2][MOST_POINTS], amplitude[2][MOST_POINTS];
    double peak[2][2];
    int says_nothing;
    plm_model *a = built(&clamped, 0), *b = NULL;
    const int64_t n = curve_of(a, hz[0], amplitude[0], peak[0]);
    int64_t i;
    (void)state;
    for (says_nothing = 0; says_nothing < 2; ++says_nothing) {
        assert_true(done(ctx, prepared(&clamped, 1, &b)));
        host.says_nothing = says_nothing;
        assert_true(done(ctx, plm_model_build(b)));
        assert_int_equal(curve_of(b, hz[1], amplitude[1], peak[1]), n);
        for (i = 0; i < n; ++i) {
            assert_true(close_to(hz[1][i], hz[0][i], 1e-7));
            assert_true(close_to(amplitude[1][i], amplitude[0][i], 1e-6)); /* where it is steep */
        }
        assert_true(close_to(peak[1][0], peak[0][0], 1e-8));
        assert_true(close_to(peak[1][1], peak[0][1], 1e-8));
        assert_ended(&b);
    }
    assert_int_equal(plm_model_destroy(&a), PLM_OK);
}

/* Each call in turn fails. The library's call says so with its number, and the next one succeeds. */
static void every_call_may_fail(void **state) {
    const variant *const variants[] = {&small, &small_free};
    size_t which;
    (void)state;
    for (which = 0; which < 2; ++which) {
        double want[4], hz[4];
        int64_t total, k;
        plm_model *m = built(variants[which], 1);
        assert_true(done(ctx, plm_model_get_modes(m, PLM_SYSTEM_SLIDING, NULL, 4, want, NULL)));
        total = host.calls;
        assert_true(total > 20);
        assert_ended(&m);
        for (k = 1; k <= total; k += next_case(7)) {
            int64_t code = 0;
            plm_status s;
            int failures = 0, step;
            assert_true(done(ctx, prepared(variants[which], 1, &m)));
            host.fail_at = k;
            for (step = 0; step < 2; ++step)
                for (;;) {
                    s = step == 0 ? plm_model_build(m)
                                  : plm_model_get_modes(m, PLM_SYSTEM_SLIDING, NULL, 4, hz, NULL);
                    if (s >= 0) break;
                    assert_int_equal(s, PLM_ERR_CALLBACK);
                    assert_int_equal(plm_context_get_error_info(ctx, NULL, NULL, NULL, &code), PLM_OK);
                    assert_int_equal(code, TALL_FAILURE);
                    assert_int_equal(++failures, 1);
                }
            assert_int_equal(failures, 1);
            for (step = 0; step < 4; ++step)
                assert_true(want[step] == 0 ? hz[step] == 0 : close_to(hz[step], want[step], 1e-9));
            assert_ended(&m);
        }
    }
}

/* A motion of the structure, marched from rest, whole or on a basis. */
static void march(plm_model *m, plm_basis *basis, int n_dof, double *q, double *v) {
    plm_transient *t = NULL;
    assert_true(done(ctx, plm_transient_create(m, basis, &t)));
    assert_int_equal(plm_transient_set_double(t, "frequency_hz", 3.0), PLM_OK);
    assert_int_equal(plm_transient_set_int(t, "periods", 3), PLM_OK);
    assert_int_equal(plm_transient_set_int(t, "steps_per_period", 200), PLM_OK);
    assert_true(done(ctx, plm_transient_run(t)));
    assert_true(done(ctx, plm_transient_get_state(t, n_dof, q, v)));
    assert_int_equal(plm_transient_destroy(&t), PLM_OK);
}

static void assert_same_field(const double *a, const double *b, int n, double tolerance) {
    double largest = 0;
    int i;
    for (i = 0; i < n; ++i) largest = fmax(largest, fabs(a[i]));
    assert_true(largest > 0);
    for (i = 0; i < n; ++i) assert_true(fabs(a[i] - b[i]) <= tolerance * largest);
}

static plm_basis *craig_bampton(plm_model *m) {
    plm_basis *basis = NULL;
    assert_true(done(ctx, plm_basis_create(m, &basis)));
    assert_int_equal(plm_basis_set_string(basis, "kind", "craig_bampton"), PLM_OK);
    assert_int_equal(plm_basis_set_int(basis, "n_fixed_modes", 6), PLM_OK);
    assert_int_equal(plm_basis_set_double(basis, "frequency_max_hz", 20), PLM_OK);
    assert_true(done(ctx, plm_basis_build(basis)));
    return basis;
}

/* Newmark's march of the structure, and of its Craig-Bampton basis; the basis itself, by what of a field it
 * does not span. */
static void marches_and_fixed_interfaces_are_those_of_the_matrices(void **state) {
    const variant *const variants[] = {&small, &massless};
    size_t which;
    (void)state;
    for (which = 0; which < 2; ++which) {
        const int n = variants[which]->n;
        plm_model *m[2] = {built(variants[which], 0), built(variants[which], 1)};
        double q[2][N], v[2][N], field[N], left[2];
        plm_basis *basis[2];
        int b, i;
        for (b = 0; b < 2; ++b) march(m[b], NULL, n, q[b], v[b]);
        assert_same_field(q[0], q[1], n, 1e-9), assert_same_field(v[0], v[1], n, 1e-9);
        for (b = 0; b < 2; ++b) basis[b] = craig_bampton(m[b]);
        for (b = 0; b < 2; ++b) march(m[b], basis[b], n, q[b], v[b]);
        assert_same_field(q[0], q[1], n, 1e-9), assert_same_field(v[0], v[1], n, 1e-9);
        for (i = 0; i < n; ++i) field[i] = sin(0.4 * i);
        for (b = 0; b < 2; ++b)
            assert_true(done(ctx, plm_basis_get_residual(basis[b], 0, 1, n, field, &left[b])));
        assert_true(left[0] > 1e-6 && close_to(left[1], left[0], 1e-9));
        for (b = 0; b < 2; ++b) assert_int_equal(plm_basis_destroy(&basis[b]), PLM_OK);
        assert_int_equal(plm_model_destroy(&m[0]), PLM_OK);
        assert_ended(&m[1]);
    }
}

/* A basis of a model behind operations goes to bytes and comes back, and its structure with it: also where
 * the host sums it up in another order, as another number of ranks does. */
static void bytes_go_and_come_back(void **state) {
    static unsigned char bytes[1 << 20];
    plm_model *m = built(&small, 1);
    plm_basis *basis = craig_bampton(m), *read = NULL;
    double q[2][N], v[2][N], field[N], left[2];
    int64_t n = 0;
    int i;
    (void)state;
    for (i = 0; i < small.n; ++i) field[i] = sin(0.4 * i);
    march(m, basis, small.n, q[0], v[0]);
    assert_true(done(ctx, plm_basis_get_residual(basis, 0, 1, small.n, field, &left[0])));
    assert_true(done(ctx, plm_basis_write(basis, 0, NULL, &n)));
    assert_true(n < (int64_t)sizeof bytes);
    assert_true(done(ctx, plm_basis_write(basis, (int64_t)sizeof bytes, bytes, &n)));
    assert_int_equal(plm_basis_destroy(&basis), PLM_OK);
    assert_ended(&m);

    assert_true(done(ctx, plm_basis_read(ctx, n, bytes, &read)));
    assert_true(refused(ctx, plm_basis_get_residual(read, 0, 1, small.n, field, &left[1]), PLM_ERR_STATE,
                        "plm_basis_get_residual", "basis", -1, "attach the model"));
    assert_true(done(ctx, prepared(&small, 1, &m)));
    stiffness[0] *= 1.001;
    assert_true(done(ctx, plm_model_build(m)));
    assert_true(
        refused(ctx, plm_basis_attach(read, m), PLM_ERR_ARGUMENT, "plm_basis_attach", "model", -1, ""));
    assert_ended(&m);
    assert_true(done(ctx, prepared(&small, 1, &m)));
    mass[0] *= 1 + 1e-14;
    assert_true(done(ctx, plm_model_build(m)));
    assert_true(done(ctx, plm_basis_attach(read, m)));
    assert_true(done(ctx, plm_basis_get_residual(read, 0, 1, small.n, field, &left[1])));
    assert_true(close_to(left[1], left[0], 1e-12));
    march(m, read, small.n, q[1], v[1]);
    assert_same_field(q[0], q[1], small.n, 1e-12);
    assert_int_equal(plm_basis_destroy(&read), PLM_OK);
    assert_ended(&m);
}

static void what_does_not_fit_is_said(void **state) {
    const int32_t dof = 3;
    const double told[16] = {N + 1, 1}, no_mass[16] = {N, 0};
    plm_model *m = NULL;
    double bytes;
    (void)state;
    assert_true(plm_model_set_tall_operations(NULL, tall_operation, NULL) < 0);
    assert_true(done(ctx, prepared(&clamped, 1, &m)));
    assert_true(refused(ctx, plm_model_estimate_memory(m, &bytes), PLM_ERR_STATE, "plm_model_estimate_memory",
                        "model", -1, "known to its host alone"));
    assert_int_equal(plm_model_fix_dofs_i32(m, 0, 1, &dof), PLM_OK);
    assert_true(refused(ctx, plm_model_build(m), PLM_ERR_STATE, "plm_model_build", "model", -1,
                        "fixed DOFs cannot stand beside tall operations"));
    assert_int_equal(plm_model_destroy(&m), PLM_OK);
    assert_int_equal(host.calls, 0); /* nothing was asked, nothing ends */

    assert_true(done(ctx, prepared(&clamped, 1, &m)));
    memcpy(host.told, told, sizeof told);
    assert_true(
        refused(ctx, plm_model_build(m), PLM_ERR_CALLBACK, "plm_model_build", "fn", -1, "FACTS told"));
    memcpy(host.told, no_mass, sizeof no_mass);
    assert_true(refused(ctx, plm_model_build(m), PLM_ERR_MATRIX, "plm_model_build", "value", -1,
                        "no free DOF has mass"));
    assert_int_equal(plm_model_set_tall_operations(m, NULL, NULL), PLM_OK);
    assert_true(refused(ctx, plm_model_build(m), PLM_ERR_STATE, "plm_model_build", "", -1, "mass matrix"));
    assert_int_equal(plm_model_destroy(&m), PLM_OK);

    assert_true(done(ctx, prepared(&clamped, 1, &m)));
    assert_int_equal(plm_model_set_dense_matrix(m, PLM_MASS, PLM_FULL, mass, N), PLM_OK);
    assert_true(refused(ctx, plm_model_build(m), PLM_ERR_STATE, "plm_model_build", "model", -1,
                        "matrices cannot stand beside tall operations"));
    assert_int_equal(plm_model_destroy(&m), PLM_OK);
    assert_true(done(ctx, prepared(&clamped, 1, &m)));
    assert_true(done(ctx, plm_model_build(m)));
    assert_true(refused(ctx, plm_model_set_tall_operations(m, NULL, NULL), PLM_ERR_STATE,
                        "plm_model_set_tall_operations", "", -1, "built"));
    assert_ended(&m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(modes_and_rest_are_those_of_the_matrices, set_up, tear_down),
        cmocka_unit_test_setup_teardown(the_curve_is_that_of_the_matrices, set_up, tear_down),
        cmocka_unit_test_setup_teardown(marches_and_fixed_interfaces_are_those_of_the_matrices, set_up,
                                        tear_down),
        cmocka_unit_test_setup_teardown(bytes_go_and_come_back, set_up, tear_down),
        cmocka_unit_test_setup_teardown(every_call_may_fail, set_up, tear_down),
        cmocka_unit_test_setup_teardown(what_does_not_fit_is_said, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
