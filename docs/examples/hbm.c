/* hbm.c: the periodic response: a curve, its peak, one frequency, and what there is beside the curve. */
#include "example.h"
#include <math.h>
#include <stdio.h>

static int sweep(plm_basis *basis) {
    /* [plm_hbm_create] [plm_hbm_destroy] */
    plm_hbm *hbm = NULL;
    TRY(plm_hbm_create(basis, &hbm));
    TRY(plm_hbm_destroy(&hbm));
    /* [plm_hbm_create] [plm_hbm_destroy] */
    TRY(plm_hbm_create(basis, &hbm));

    /* [plm_hbm_set_int] [plm_hbm_set_double] [plm_hbm_set_string] */
    TRY(plm_hbm_set_int(hbm, "n_harmonics", 7));
    TRY(plm_hbm_set_double(hbm, "frequency_min_hz", 10));
    TRY(plm_hbm_set_double(hbm, "frequency_max_hz", 13));
    TRY(plm_hbm_set_string(hbm, "unknowns", "modal"));
    /* [plm_hbm_set_int] [plm_hbm_set_double] [plm_hbm_set_string] */

    /* [plm_hbm_get_int] [plm_hbm_get_double] [plm_hbm_get_string] */
    int64_t harmonics;
    double from;
    char direction[8];
    TRY(plm_hbm_get_int(hbm, "n_harmonics", &harmonics));
    TRY(plm_hbm_get_double(hbm, "frequency_min_hz", &from));
    TRY(plm_hbm_get_string(hbm, "direction", sizeof direction, direction, NULL));
    printf("H = %d, from %g Hz on, %s\n", (int)harmonics, from, direction);
    /* [plm_hbm_get_int] [plm_hbm_get_double] [plm_hbm_get_string] */

    /* [plm_hbm_sweep] */
    plm_branch *curve = NULL;
    const plm_status ended = plm_hbm_sweep(hbm, &curve);
    if (ended < 0) return __LINE__;
    if (ended > 0) printf("the curve ends early, see its \"end_text\"\n");
    /* [plm_hbm_sweep] */
    EXPECT(ended == 0 && harmonics == 7);

    /* [plm_hbm_save_every] */
    TRY(plm_hbm_save_every(hbm, 10, "example_curve.plm")); /* a process that is killed leaves that */
    /* [plm_hbm_save_every] */
    TRY(plm_hbm_save_every(hbm, 0, NULL));

    plm_branch *part = NULL, *whole = NULL;
    TRY(plm_hbm_set_int(hbm, "max_points", 12));
    EXPECT(plm_hbm_sweep(hbm, &part) == PLM_TRUNCATED);
    TRY(plm_hbm_set_int(hbm, "max_points", 1000));
    /* [plm_hbm_resume] */
    const plm_status on = plm_hbm_resume(hbm, part, &whole); /* the points that it would have had */
    if (on < 0) return __LINE__;
    /* [plm_hbm_resume] */
    EXPECT(on == ended);

    /* [plm_hbm_sweep_levels] */
    const double level[] = {0.25, 0.5, 0.75}; /* times the excitation */
    int64_t n_levels;
    TRY(plm_hbm_sweep_levels(hbm, 3, level, &n_levels));
    for (int64_t i = 0; i < n_levels; i++) {
        plm_branch *lower = NULL;
        double hz, amplitude;
        TRY(plm_hbm_get_found(hbm, i, NULL, &lower));
        TRY(plm_hbm_find_peak(hbm, lower, 1, PLM_PEAK, 0, &hz, &amplitude, NULL));
        printf("%g of the force: %.4g mm at %.4f Hz\n", level[i], 1e3 * amplitude, hz);
        TRY(plm_branch_destroy(&lower));
    }
    /* [plm_hbm_sweep_levels] */
    EXPECT(n_levels == 3);

    /* [plm_hbm_find_peak] */
    double hz, amplitude;
    plm_branch *peak = NULL; /* that point; NULL instead of &peak if it is not wanted */
    TRY(plm_hbm_find_peak(hbm, curve, 1, PLM_HALF_PEAK_TO_PEAK, 0, &hz, &amplitude, &peak));
    printf("peak: %.4g mm at %.4f Hz\n", 1e3 * amplitude, hz);
    /* [plm_hbm_find_peak] */

    /* [plm_hbm_estimate_error] */
    double error[3], shift[3]; /* by basis, contact sets, harmonics: corrected less computed */
    TRY(plm_hbm_estimate_error(hbm, peak, 0, 1, PLM_HALF_PEAK_TO_PEAK, 0, error, shift));
    printf("the peak is about %.2g mm and %.2g Hz too low\n", 1e3 * (error[0] + error[1] + error[2]),
           shift[0] + shift[1] + shift[2]);
    /* [plm_hbm_estimate_error] */
    EXPECT(fabs(error[0]) < 1e-3 * amplitude && fabs(error[2]) < 0.1 * amplitude);

    /* [plm_hbm_refine_basis] */
    double left;
    plm_basis *refined = NULL; /* small, and good for 1e-4 of the peak; 1: the DOF looked at */
    TRY(plm_hbm_refine_basis(hbm, 1, PLM_HALF_PEAK_TO_PEAK, 0, 1e-4, &refined, &left));
    plm_basis_destroy(&refined); /* after the curves on it: plm_hbm_create(refined, ...) */
    /* [plm_hbm_refine_basis] */
    EXPECT(left < 1e-4);

    /* [plm_hbm_solve] */
    plm_branch *cold = NULL, *warm = NULL;
    TRY(plm_hbm_solve(hbm, 11, NULL, 0, &cold));        /* from nothing */
    TRY(plm_hbm_solve(hbm, 0.99 * hz, peak, 0, &warm)); /* from the solution at the peak */
    /* [plm_hbm_solve] */
    EXPECT(amplitude > 0.005 && amplitude < 0.02);
    return 0;
}

/* Oscillator of 1 kg and 1 N/m between two stops at 0.2 m, from the model to a solver of the unreduced
 * structure. */
static int between_stops(plm_context *ctx, plm_hbm **hbm) {
    const int32_t zero[] = {0}, row_ptr[] = {0, 1, 2}, dof[] = {0, 0};
    const double one[] = {1}, damping[] = {0.1}, coefficient[] = {1, -1}, stop[] = {10, 10},
                 gap[] = {0.2, 0.2};
    plm_model *model = NULL;
    plm_basis *basis = NULL;
    TRY(plm_model_create(ctx, 1, &model));
    TRY(plm_model_set_matrix_i32(model, PLM_MASS, PLM_TRIPLETS, PLM_FULL, 0, PLM_COPY, 1, zero, zero, one));
    TRY(plm_model_set_matrix_i32(model, PLM_STIFFNESS, PLM_TRIPLETS, PLM_FULL, 0, PLM_COPY, 1, zero, zero,
                                 one));
    TRY(plm_model_set_matrix_i32(model, PLM_DAMPING, PLM_TRIPLETS, PLM_FULL, 0, PLM_COPY, 1, zero, zero,
                                 damping));
    TRY(plm_model_add_gap_rows_i32(model, 0, 2, row_ptr, dof, coefficient, stop, gap));
    TRY(plm_model_set_excitation(model, 1, 1, one, NULL));
    TRY(plm_model_build(model));
    TRY(plm_basis_create(model, &basis));
    TRY(plm_basis_set_string(basis, "kind", "full"));
    TRY(plm_basis_set_double(basis, "frequency_min_hz", 0.19));
    TRY(plm_basis_set_double(basis, "frequency_max_hz", 0.32));
    TRY(plm_basis_build(basis));
    TRY(plm_hbm_create(basis, hbm));
    return 0;
}

/* A pre-loaded oscillator that opens at large amplitude and carries a light second one, about three times as
 * fast. */
static int carrier(plm_context *ctx, plm_hbm **hbm) {
    const int32_t row[] = {0, 1, 1}, column[] = {0, 0, 1}, row_ptr[] = {0, 1}, dof[] = {0};
    const double mass[] = {1, 0, 0.2}, stiffness[] = {3.048, -2.048, 2.048}, one[] = {1}, force[] = {1, 0},
                 preload[] = {0.5, 0};
    plm_model *model = NULL;
    plm_basis *basis = NULL;
    TRY(plm_model_create(ctx, 2, &model));
    TRY(plm_model_set_matrix_i32(model, PLM_MASS, PLM_TRIPLETS, PLM_LOWER, 0, PLM_COPY, 3, row, column,
                                 mass));
    TRY(plm_model_set_matrix_i32(model, PLM_STIFFNESS, PLM_TRIPLETS, PLM_LOWER, 0, PLM_COPY, 3, row, column,
                                 stiffness));
    TRY(plm_model_set_rayleigh_damping(model, 0, 0.004));
    TRY(plm_model_add_gap_rows_i32(model, 0, 1, row_ptr, dof, one, one, NULL));
    TRY(plm_model_set_preload(model, 2, preload));
    TRY(plm_model_set_excitation(model, 1, 2, force, NULL));
    TRY(plm_model_build(model));
    TRY(plm_basis_create(model, &basis));
    TRY(plm_basis_set_string(basis, "kind", "full"));
    TRY(plm_basis_set_double(basis, "frequency_min_hz", 0.14));
    TRY(plm_basis_set_double(basis, "frequency_max_hz", 0.26));
    TRY(plm_basis_build(basis));
    TRY(plm_hbm_create(basis, hbm));
    TRY(plm_hbm_set_double(*hbm, "force_scale", 0.006));
    return 0;
}

enum { MAX_POINTS = 2000 };

/* The first point of a branch that is a PLM_BIFURCATION_..., or -1. */
static int64_t first_of(plm_branch *branch, int32_t kind) {
    static int64_t bifurcation[MAX_POINTS];
    int64_t n = 0;
    if (plm_branch_get_int_array(branch, "bifurcation", MAX_POINTS, bifurcation, &n)) return -1;
    for (int64_t i = 0; i < n; i++)
        if (bifurcation[i] == kind) return i;
    return -1;
}

/* Mean displacement of DOF 0 at the second point. */
static double mean_of(plm_branch *branch) {
    static double mean[MAX_POINTS];
    int64_t n = 0;
    return plm_branch_get_amplitude(branch, 0, PLM_HARMONIC, 0, MAX_POINTS, mean, &n) || n < 2 ? 0 : mean[1];
}

/* First harmonic of DOF 0 at the last point. */
static double last_of(plm_branch *branch) {
    static double first[MAX_POINTS];
    int64_t n = 0;
    return plm_branch_get_amplitude(branch, 0, PLM_HARMONIC, 1, MAX_POINTS, first, &n) || n < 1
               ? 0
               : first[n - 1];
}

static int switch_branch(plm_hbm *hbm) {
    plm_branch *curve = NULL;
    TRY(plm_hbm_sweep(hbm, &curve));
    /* [plm_hbm_switch_branch] */
    const int64_t crossing = first_of(curve, PLM_BIFURCATION_BRANCH_POINT); /* in the array "bifurcation" */
    plm_branch *left = NULL, *right = NULL; /* here the motion leans to one stop, or to the other */
    TRY(plm_hbm_switch_branch(hbm, curve, crossing, 0, &left));
    TRY(plm_hbm_switch_branch(hbm, curve, crossing, 1, &right));
    /* [plm_hbm_switch_branch] */
    EXPECT(mean_of(left) * mean_of(right) < 0);
    return 0;
}

static int beside_the_curve(plm_hbm *hbm, plm_branch *curve, plm_branch **isolated) {
    /* [plm_hbm_find_isolated] [plm_hbm_get_found] */
    int64_t count;
    TRY(plm_hbm_find_isolated(hbm, curve, 0, &count)); /* 0: forces up to eight times "force_scale" */
    for (int64_t i = 0; i < count; i++) {
        double force[2];
        TRY(plm_hbm_get_found(hbm, i, force, isolated));
        printf("an isolated branch, it exists for force scales from %.4g to %.4g\n", force[0], force[1]);
    }
    /* [plm_hbm_find_isolated] [plm_hbm_get_found] */
    EXPECT(count == 1);

    /* [plm_hbm_find_backbones] */
    plm_branch *backbone = NULL; /* of each point: "frequency_hz", "point_force_scale", its amplitude */
    TRY(plm_hbm_find_backbones(hbm, 0, &count));
    for (int64_t i = 0; i < count; i++) TRY(plm_hbm_get_found(hbm, i, NULL, &backbone));
    /* [plm_hbm_find_backbones] */
    EXPECT(count == 1 && backbone);

    /* [plm_hbm_track_fold] */
    plm_branch *folds = NULL; /* frequency and force of the fold; its own folds: births and mergers */
    TRY(plm_hbm_track_fold(hbm, *isolated, first_of(*isolated, PLM_BIFURCATION_FOLD), 0.003, 0.01, &folds));
    /* [plm_hbm_track_fold] */
    EXPECT(first_of(folds, PLM_BIFURCATION_FOLD) >= 0);
    return 0;
}

static int other_searches(plm_hbm *hbm, plm_branch *curve) {
    /* [plm_hbm_find_by_marching] */
    int64_t count; /* at 12 frequencies, from rest and from 1, 2 and 4 times the curve's largest response */
    TRY(plm_hbm_find_by_marching(hbm, 1, &curve, 12, 3, &count));
    printf("%d branches beside the known one\n", (int)count); /* read by plm_hbm_get_found */
    /* [plm_hbm_find_by_marching] */
    EXPECT(count >= 1);

    /* [plm_hbm_find_nonlinear_mode] */
    plm_branch *mode = NULL; /* motion without excitation: mode 1, until DOF 0 moves by 1.5 m */
    double damping[2000];    /* share of critical damping over the amplitude */
    TRY(plm_hbm_find_nonlinear_mode(hbm, 1, 0, 1.5, &mode));
    TRY(plm_branch_get_array(mode, "damping_ratio", 2000, damping, &count));
    printf("damping ratio %g at the least amplitude, %g at 1.5 m\n", damping[0], damping[count - 1]);
    /* [plm_hbm_find_nonlinear_mode] */
    EXPECT(fabs(last_of(mode) / 1.5 - 1) < 1e-6);
    return 0;
}

int example(plm_context *ctx) {
    plm_basis *basis = NULL;
    plm_hbm *hbm = NULL;
    plm_branch *curve = NULL, *isolated = NULL;
    int line;
    TRY(start_basis(ctx, &basis));
    line = sweep(basis);
    if (!line) line = between_stops(ctx, &hbm);
    if (!line) line = switch_branch(hbm);
    if (!line) line = carrier(ctx, &hbm);
    if (line) return line;
    TRY(plm_hbm_sweep(hbm, &curve));
    line = beside_the_curve(hbm, curve, &isolated);
    return line ? line : other_searches(hbm, curve);
}
