/* What is stated of an error, against what it is. A beam that strikes a hard stop under one damping ratio for
 * all its modes, so that impacts ring in modes far above the excitation; a membrane with a stop at every
 * mass, of whose DOFs some move much less than others. Nothing is set that a user would not set. */
#include "check.h"

static plm_context *ctx;

#define DONE(call) assert_true(done(ctx, call))

static int open_context(void **state) {
    (void)state;
    return plm_context_create(PLM_API_VERSION, &ctx) != PLM_OK;
}
static int close_context(void **state) {
    (void)state;
    return plm_context_destroy(&ctx);
}

enum { ELEMENTS = 7, BEAM = 2 * ELEMENTS, SIDE = 8, STOPS = 30, MEMBRANE = SIDE * SIDE };

/* Clamped; two DOFs a node, deflection and rotation; length 1, bending stiffness 100, mass 1. */
static void assemble_beam(double *k, double *m) {
    const double h = 1.0 / ELEMENTS, a = 100 / (h * h * h), b = h / 420;
    const double ke[4][4] = {{12 * a, 6 * h * a, -12 * a, 6 * h * a},
                             {6 * h * a, 4 * h * h * a, -6 * h * a, 2 * h * h * a},
                             {-12 * a, -6 * h * a, 12 * a, -6 * h * a},
                             {6 * h * a, 2 * h * h * a, -6 * h * a, 4 * h * h * a}};
    const double me[4][4] = {{156 * b, 22 * h * b, 54 * b, -13 * h * b},
                             {22 * h * b, 4 * h * h * b, 13 * h * b, -3 * h * h * b},
                             {54 * b, 13 * h * b, 156 * b, -22 * h * b},
                             {-13 * h * b, -3 * h * h * b, -22 * h * b, 4 * h * h * b}};
    memset(k, 0, BEAM * BEAM * sizeof *k);
    memset(m, 0, BEAM * BEAM * sizeof *m);
    for (int e = 0; e < ELEMENTS; ++e)
        for (int j = 0; j < 4; ++j)
            for (int i = 0; i < 4; ++i) {
                const int row = 2 * e + i - 2, column = 2 * e + j - 2;
                if (row < 0 || column < 0) continue;
                k[row + BEAM * column] += ke[i][j];
                m[row + BEAM * column] += me[i][j];
            }
}

static plm_model *model_of(int64_t n, const double *m, const double *k) {
    int32_t *i = malloc((size_t)(n * n) * sizeof *i), *j = malloc((size_t)(n * n) * sizeof *j);
    plm_model *model = NULL;
    assert_true(i && j);
    for (int64_t c = 0; c < n * n; ++c) i[c] = (int32_t)(c % n), j[c] = (int32_t)(c / n);
    DONE(plm_model_create(ctx, n, &model));
    DONE(plm_model_set_matrix_i32(model, PLM_MASS, PLM_TRIPLETS, PLM_FULL, 0, PLM_COPY, n * n, i, j, m));
    DONE(plm_model_set_matrix_i32(model, PLM_STIFFNESS, PLM_TRIPLETS, PLM_FULL, 0, PLM_COPY, n * n, i, j, k));
    free(i);
    free(j);
    return model;
}

/* A stop without gap beside the deflection of the fifth node, pushed at the tip. */
static plm_model *beam_at_a_stop(double stiffness, double ratio) {
    double k[BEAM * BEAM], m[BEAM * BEAM], ratios[BEAM], force[BEAM] = {0};
    const int32_t row[] = {0, 1}, dof[] = {8};
    const double one[] = {1}, gap[] = {0};
    assemble_beam(k, m);
    plm_model *model = model_of(BEAM, m, k);
    for (int j = 0; j < BEAM; ++j) ratios[j] = ratio;
    force[BEAM - 2] = 1;
    DONE(plm_model_set_modal_damping(model, BEAM, ratios));
    DONE(plm_model_add_gap_rows_i32(model, 0, 1, row, dof, one, &stiffness, gap));
    DONE(plm_model_set_excitation(model, 1, BEAM, force, NULL));
    DONE(plm_model_build(model));
    return model;
}

/* Masses of 1 on a grid of springs of 1e4, clamped all around; half of them have a stop at a gap of their
 * own. */
static plm_model *membrane_with_stops(void) {
    double k[MEMBRANE * MEMBRANE] = {0}, m[MEMBRANE * MEMBRANE] = {0}, force[MEMBRANE] = {0};
    double one[STOPS], stiffness[STOPS], gap[STOPS];
    int32_t row[STOPS + 1], dof[STOPS];
    for (int a = 0; a < MEMBRANE; ++a) {
        m[a * (MEMBRANE + 1)] = 1, k[a * (MEMBRANE + 1)] = 4e4;
        const int x = a % SIDE, y = a / SIDE;
        if (x + 1 < SIDE) k[a + MEMBRANE * (a + 1)] = k[a + 1 + MEMBRANE * a] = -1e4;
        if (y + 1 < SIDE) k[a + MEMBRANE * (a + SIDE)] = k[a + SIDE + MEMBRANE * a] = -1e4;
    }
    for (int i = 0; i < STOPS; ++i) {
        row[i] = i, dof[i] = i, one[i] = 1, stiffness[i] = 2e4;
        gap[i] = 2e-4 * (1 + 0.5 * sin(1.0 + 7.0 * i)); /* all different */
    }
    row[STOPS] = STOPS;
    force[SIDE * (SIDE / 2) + SIDE / 2] = 0.1;
    plm_model *model = model_of(MEMBRANE, m, k);
    DONE(plm_model_set_rayleigh_damping(model, 0.4, 4e-4));
    DONE(plm_model_add_gap_rows_i32(model, 0, STOPS, row, dof, one, stiffness, gap));
    DONE(plm_model_set_excitation(model, 1, MEMBRANE, force, NULL));
    DONE(plm_model_build(model));
    return model;
}

/* In steps; motion "exact" follows the curve on every coordinate of the basis. */
typedef struct steps {
    plm_hbm *hbm;
    plm_branch *curve;
} steps;
static steps followed(plm_model *model, const char *kind, const char *motion) {
    plm_sampler *sampler = NULL;
    plm_basis *basis = NULL;
    steps s = {NULL, NULL};
    DONE(plm_sampler_create(model, &sampler));
    assert_true(plm_sampler_run(sampler) >= 0);
    DONE(plm_basis_create(model, &basis));
    DONE(plm_basis_set_string(basis, "kind", kind));
    DONE(plm_basis_set_sampler(basis, sampler));
    assert_true(plm_basis_build(basis) >= 0);
    DONE(plm_hbm_create(basis, &s.hbm));
    DONE(plm_hbm_set_string(s.hbm, "motion", motion));
    assert_true(plm_hbm_sweep(s.hbm, &s.curve) >= 0);
    return s;
}

typedef struct found {
    plm_status status;
    double hz, amplitude;
    plm_branch *peak;
} found;
static found peak_of(steps s, int64_t dof) {
    found f;
    f.status = plm_hbm_find_peak(s.hbm, s.curve, dof, PLM_PEAK, 0, &f.hz, &f.amplitude, &f.peak);
    assert_true(f.status >= 0);
    return f;
}

static double relative(double a, double b) {
    return fabs(a / b - 1);
}

/* The same peak as that of the whole structure, and an error that is no less than a third of what it is. */
static void a_hard_stop_under_one_ratio_is_right(void **state) {
    (void)state;
    const double of_flexibility[] = {1e2, 1e3, 4.4e3};
    for (int i = 0; i < 3; i += next_case(2)) {
        const double k_loc = 1 / (pow(4.0 / ELEMENTS, 3) / 300); /* a force at the fifth node deflects it */
        plm_model *model = beam_at_a_stop(of_flexibility[i] * k_loc, 0.0113);
        const found truth = peak_of(followed(model, "full", "exact"), 8);
        double hz = 0, amplitude = 0, error = 0;
        const plm_status status =
            plm_model_compute_response(model, 8, PLM_PEAK, 1e-3, &hz, &amplitude, &error, NULL, NULL);
        assert_true(status == PLM_OK || status == PLM_WARNING);
        const double wrong = larger(relative(amplitude, truth.amplitude), relative(hz, truth.hz));
        assert_true(wrong < 1e-3);
        assert_true(error >= wrong / 3 || wrong < 1e-6);
        assert_true(error < 1e-2);
    }
}

/* On a basis the estimate is the difference to the whole structure's peak. At a peak the amplitude is level
 * along the curve, so that both agree to a tenth and to the square of the error. */
static void the_estimate_is_what_the_whole_structure_says(void **state) {
    (void)state;
    const double k_loc = 1 / (pow(4.0 / ELEMENTS, 3) / 300);
    plm_model *model = beam_at_a_stop(1e2 * k_loc, 0.0113);
    const found truth = peak_of(followed(model, "full", "exact"), 8);
    const steps s = followed(model, "plm", "auto");
    const found peak = peak_of(s, 8);
    double parts[3], of_frequency[3], sum = 0;
    DONE(plm_hbm_estimate_error(s.hbm, peak.peak, 0, 8, PLM_PEAK, 0, parts, of_frequency));
    for (int k = 0; k < 3; ++k) sum += parts[k];
    const double wrong = truth.amplitude - peak.amplitude;
    assert_true(fabs(wrong) > 1e-5 * truth.amplitude); /* else nothing is shown */
    assert_true(fabs(sum - wrong) < 0.1 * fabs(wrong) + 0.1 * wrong * wrong / truth.amplitude);
}

/* The curve of a large basis is followed on fewer coordinates. What that makes wrong at the DOF asked for is
 * within the accuracy, or the peak says by how much; a DOF that moves less is judged by itself. */
static void every_dof_of_a_curve_on_fewer_coordinates_is_judged(void **state) {
    (void)state;
    plm_model *model = membrane_with_stops();
    const steps whole = followed(model, "full", "exact"), fewer = followed(model, "full", "auto");
    int64_t size = 0;
    DONE(plm_branch_get_int(fewer.curve, "basis_size", &size));
    assert_true(size < MEMBRANE); /* else nothing is shown */
    int quiet = 0;
    for (int64_t dof = 0; dof < MEMBRANE; dof += 9 * next_case(7)) {
        const found truth = peak_of(whole, dof), peak = peak_of(fewer, dof);
        const double wrong = larger(relative(peak.amplitude, truth.amplitude), relative(peak.hz, truth.hz));
        assert_true(wrong < 1e-3 || peak.status == PLM_WARNING);
        quiet += peak.status == PLM_OK;
    }
    assert_true(quiet > 0);
    double hz = 0, amplitude = 0, error = 0;
    DONE(plm_model_compute_response(model, 0, PLM_PEAK, 1e-3, &hz, &amplitude, &error, NULL, NULL));
    const double wrong = relative(amplitude, peak_of(whole, 0).amplitude);
    assert_true(wrong < 1e-3);
    assert_true(error < 1e-3 && (error >= wrong / 3 || wrong < 1e-6));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(a_hard_stop_under_one_ratio_is_right, open_context, close_context),
        cmocka_unit_test_setup_teardown(the_estimate_is_what_the_whole_structure_says, open_context,
                                        close_context),
        cmocka_unit_test_setup_teardown(every_dof_of_a_curve_on_fewer_coordinates_is_judged, open_context,
                                        close_context),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
