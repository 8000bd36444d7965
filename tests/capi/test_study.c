/* A study on scenes where the errors are known: the reference against itself, a basis that is too small,
 * marching in time against harmonic balance, several force levels; what a method keeps of the handles it was
 * added from; methods that fail; memory, cancelling and files. */
#include "cracked_plate.h"
#include "scene_model.h"
#include "study_case.h"
#include <sys/stat.h>
#include <unistd.h>

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

#define DONE(call) assert_true(done(ctx, call))

static void the_reference_against_itself_is_exact(void **state) {
    (void)state;
    DONE(plm_study_add_response(c.study, "same", c.hbm, NULL));
    DONE(plm_hbm_set_double(c.hbm, "max_step", 0.05));
    DONE(plm_study_add_response(c.study, "other steps", c.hbm, NULL));
    DONE(plm_study_run(c.study));
    /* Newton's tolerance is 1e-9 */
    assert_true(study_real(c.study, "frequency_error", 0) < 1e-8 &&
                study_real(c.study, "amplitude_error", 0) < 1e-8);
    assert_true(study_real(c.study, "curve_error_l2", 0) < 1e-8 &&
                study_real(c.study, "curve_error_max", 0) < 1e-8);
    /* the same curve by other points: to what the interpolation is good for, an estimate to a factor of two
     */
    print_message("other steps: %.1e, resolution %.1e\n", study_real(c.study, "curve_error_max", 1),
                  study_scalar(c.study, "curve_resolution_error"));
    assert_true(study_real(c.study, "frequency_error", 1) < 1e-7 &&
                study_real(c.study, "amplitude_error", 1) < 1e-8);
    assert_true(study_scalar(c.study, "curve_resolution_error") <= 5e-7);
    assert_true(study_real(c.study, "curve_error_max", 1) < 2 * 2 * 5e-7);
    assert_true(study_int(c.study, "n_points", 1) > study_int(c.study, "n_points", 0));
    assert_true(isnan(study_real(c.study, "effectivity", 0)));
    assert_true(study_scalar(c.study, "reference_size") == 1);
    assert_true(study_scalar(c.study, "frequency_low_hz") == 0.12 &&
                study_scalar(c.study, "frequency_high_hz") == 0.2);
    assert_true(study_real(c.study, "setup_seconds", 0) >= 0 && study_real(c.study, "curve_seconds", 0) > 0 &&
                study_real(c.study, "iteration_seconds", 0) > 0 &&
                study_int(c.study, "newton_iterations", 0) > 0 && study_int(c.study, "failed_steps", 0) >= 0);
}

/* the reference has seven harmonics; what fourteen would change, by hand */
static void the_reference_says_how_converged_it_is(void **state) {
    plm_branch *curve = NULL;
    double hz[2], amplitude[2];
    int k;
    (void)state;
    DONE(plm_study_add_response(c.study, "same", c.hbm, NULL));
    DONE(plm_study_run(c.study));
    for (k = 0; k < 2; ++k) {
        DONE(plm_hbm_set_int(c.hbm, "n_harmonics", k == 0 ? 7 : 14));
        DONE(plm_hbm_sweep(c.hbm, &curve));
        DONE(plm_hbm_find_peak(c.hbm, curve, 0, PLM_HALF_PEAK_TO_PEAK, 0, &hz[k], &amplitude[k], NULL));
    }
    assert_true(close_to(study_scalar(c.study, "reference_peak_hz"), hz[0], 1e-8));
    assert_true(close_to(study_scalar(c.study, "reference_peak_amplitude"), amplitude[0], 1e-9));
    /* peaks are known to 1e-9 */
    assert_true(fabs(study_scalar(c.study, "reference_harmonic_error") -
                     fabs(amplitude[1] / amplitude[0] - 1)) < 1e-8);
    assert_true(fabs(study_scalar(c.study, "reference_harmonic_shift") - fabs(hz[1] / hz[0] - 1)) < 1e-7);
    assert_true(study_scalar(c.study, "reference_full_residual") < 1e-8);
    assert_true(study_scalar(c.study, "reference_space_error") < 1e-8);
}

/* Few harmonics against many: amplitudes of the two curves by hand, and twice the force as a level. */
static void several_levels_give_the_worst_error_and_the_whole_time(void **state) {
    const double levels[] = {0.5, 2};
    double error[2], hz[2], amplitude[2];
    int64_t points = 0, n = 0;
    int k, j;
    (void)state;
    DONE(plm_study_set_reference(c.study, c.hbm));
    DONE(plm_study_set_force_levels(c.study, 2, levels));
    DONE(plm_hbm_set_int(c.hbm, "n_harmonics", 1));
    DONE(plm_study_add_response(c.study, "one harmonic", c.hbm, NULL));
    DONE(plm_study_run(c.study));
    DONE(plm_hbm_set_string(c.hbm, "stability",
                            "off")); /* as in a study: near its changes steps are shorter */
    for (k = 0; k < 2; ++k) {
        for (j = 0; j < 2; ++j) {
            plm_branch *curve = NULL;
            DONE(plm_hbm_set_double(c.hbm, "force_scale", levels[k]));
            DONE(plm_hbm_set_int(c.hbm, "n_harmonics", j == 0 ? 7 : 1));
            DONE(plm_hbm_sweep(c.hbm, &curve));
            DONE(plm_hbm_find_peak(c.hbm, curve, 0, PLM_HALF_PEAK_TO_PEAK, 0, &hz[j], &amplitude[j], NULL));
            DONE(plm_branch_get_int(curve, "n_points", &n));
            if (j == 1) points += n;
        }
        error[k] = fabs(amplitude[1] / amplitude[0] - 1);
    }
    assert_true(error[0] != error[1]);
    assert_true(close_to(study_real(c.study, "amplitude_error", 0), larger(error[0], error[1]), 1e-5));
    assert_int_equal(study_int(c.study, "n_points", 0), points);
    /* an error of a single number is no smaller than the curve's at its peak, and the largest no smaller than
     * the mean */
    assert_true(study_real(c.study, "curve_error_max", 0) >= study_real(c.study, "curve_error_l2", 0));
    assert_true(study_real(c.study, "curve_error_max", 0) > 0.1 * larger(error[0], error[1]));
    assert_true(study_scalar(c.study, "n_levels") == 2 && study_scalar(c.study, "n_methods") == 1);
}

static void count_curves(plm_context *context, int32_t level, const char *text, void *user) {
    (void)context, (void)level;
    *(int *)user += strstr(text, "Newton iterations, ") != NULL; /* said at the end of each curve */
}

/* Without a gap the response is proportional to the force, and the parent's curve at one level tells all
 * there is. */
static void one_level_compresses_for_all_where_the_response_is_proportional(void **state) {
    const double levels[] = {0.5, 2};
    int followed[2] = {0, 0}, gap;
    (void)state;
    for (gap = 0; gap < 2; ++gap) {
        double hz[2], peak[2];
        int k;
        DONE(study_case_with_gap(ctx, gap == 0 ? 0 : 5, &c));
        DONE(plm_study_set_int(c.study, "repeats", 0));
        DONE(plm_study_set_force_levels(c.study, 2, levels));
        DONE(plm_study_set_reference(c.study, c.hbm));
        DONE(plm_study_add_compressed(c.study, "compressed", c.hbm, 1, NULL));
        DONE(plm_context_set_log(ctx, count_curves, &followed[gap]));
        DONE(plm_study_run(c.study));
        DONE(plm_context_set_log(ctx, NULL, NULL));
        assert_true(study_real(c.study, "amplitude_error", 0) < 1e-8 &&
                    study_real(c.study, "curve_error_max", 0) < 1e-5);
        for (k = 0; k < 2; ++k) {
            plm_branch *curve = NULL;
            DONE(plm_hbm_set_double(c.hbm, "force_scale", levels[k]));
            DONE(plm_hbm_sweep(c.hbm, &curve));
            DONE(plm_hbm_find_peak(c.hbm, curve, 0, PLM_HALF_PEAK_TO_PEAK, 0, &hz[k], &peak[k], NULL));
        }
        /* peaks are known to 1e-9 */
        assert_int_equal(fabs(peak[1] / (4 * peak[0]) - 1) < 1e-8 && fabs(hz[1] / hz[0] - 1) < 1e-8,
                         gap == 0);
    }
    /* the reference and the method at both levels, the parent at one or both */
    assert_int_equal(followed[0], 2 + 2 + 1);
    assert_int_equal(followed[1], 2 + 2 + 2);
}

static void a_method_keeps_the_options_it_was_added_with(void **state) {
    plm_transient *motion = NULL;
    double first_peak, last_peak;
    int k;
    (void)state;
    DONE(plm_transient_create(c.model, c.basis, &motion));
    DONE(plm_transient_set_double(motion, "settled", 1e-6));
    DONE(plm_transient_set_int(motion, "periods", 1000));
    DONE(plm_study_set_reference(c.study, c.hbm));
    DONE(plm_study_add_response(c.study, "seven", c.hbm, NULL));
    DONE(plm_study_add_marching(c.study, "marching", motion, 3, NULL));
    DONE(plm_study_run(c.study));
    first_peak = study_real(c.study, "peak_amplitude", 0);
    last_peak = study_real(c.study, "peak_amplitude", 1);
    for (k = 0; k < 2; ++k) {
        if (k == 0) { /* changed, and made useless */
            DONE(plm_hbm_set_int(c.hbm, "n_harmonics", 1));
            DONE(plm_hbm_set_double(c.hbm, "force_scale", 3));
            DONE(plm_basis_set_string(c.basis, "kind", "plm"));
            DONE(plm_basis_set_double(c.basis, "frequency_max_hz", 0.5));
            DONE(plm_transient_set_int(motion, "periods", 1));
        } else {
            DONE(plm_transient_destroy(&motion));
            DONE(plm_hbm_destroy(&c.hbm));
            DONE(plm_basis_destroy(&c.basis));
        }
        DONE(plm_study_run(c.study));
        assert_true(study_real(c.study, "peak_amplitude", 0) == first_peak);
        assert_true(study_real(c.study, "peak_amplitude", 1) == last_peak);
    }
}

/* Harmonics and interpolation follow from one number, and the reference is a decade better; a method whose
 * solver has an accuracy of its own keeps it. */
static void one_number_is_the_accuracy(void **state) {
    const double accuracy[] = {1e-3, 1e-6};
    int64_t n[2], of_reference[2], of_own[2];
    int k;
    (void)state;
    DONE(plm_hbm_set_int(c.hbm, "n_harmonics", 0));
    DONE(plm_hbm_set_string(c.hbm, "motion", "harmonics"));
    DONE(plm_study_add_response(c.study, "as the study", c.hbm, NULL));
    DONE(plm_hbm_set_double(c.hbm, "accuracy", 1e-2));
    DONE(plm_study_add_response(c.study, "its own", c.hbm, NULL));
    for (k = 0; k < 2; ++k) {
        plm_branch *curve[3] = {NULL, NULL, NULL};
        DONE(plm_study_set_double(c.study, "accuracy", accuracy[k]));
        DONE(plm_study_run(c.study));
        DONE(plm_study_get_curve(c.study, 0, 0, &curve[0]));
        DONE(plm_study_get_curve(c.study, 1, 0, &curve[1]));
        DONE(plm_study_get_curve(c.study, -1, 0, &curve[2]));
        DONE(plm_branch_get_int(curve[0], "n_harmonics", &n[k]));
        DONE(plm_branch_get_int(curve[1], "n_harmonics", &of_own[k]));
        DONE(plm_branch_get_int(curve[2], "n_harmonics", &of_reference[k]));
        print_message("accuracy %.0e: %d harmonics, %d of the reference, error %.1e, resolution %.1e\n",
                      accuracy[k], (int)n[k], (int)of_reference[k], study_real(c.study, "amplitude_error", 0),
                      study_scalar(c.study, "curve_resolution_error"));
        assert_true(of_reference[k] >= n[k]);
        assert_true(study_real(c.study, "amplitude_error", 0) < accuracy[k]);
        assert_true(study_scalar(c.study, "curve_resolution_error") <= 5e-4 * accuracy[k]);
    }
    assert_true(n[1] > n[0] && of_reference[1] > n[1] && of_own[1] == of_own[0]);
}

/* With nothing set the curves are of exact motions, which lack no harmonic. */
static void exact_motions_are_their_own_reference(void **state) {
    (void)state;
    DONE(plm_hbm_set_int(c.hbm, "n_harmonics", 0));
    DONE(plm_study_add_response(c.study, "same", c.hbm, NULL));
    DONE(plm_study_run(c.study));
    assert_true(study_scalar(c.study, "reference_harmonic_error") == 0);
    assert_true(study_real(c.study, "amplitude_error", 0) < 1e-8 &&
                study_real(c.study, "curve_error_max", 0) < 1e-8);
    assert_true(study_scalar(c.study, "curve_resolution_error") <= 5e-7);
}

/* A reference that is cut off short of the accuracy says so. */
static void a_reference_short_of_harmonics_is_told(void **state) {
    char text[400];
    (void)state;
    DONE(plm_hbm_set_int(c.hbm, "n_harmonics", 0));
    DONE(plm_hbm_set_int(c.hbm, "max_harmonics", 3));
    DONE(plm_hbm_set_string(c.hbm, "motion", "harmonics"));
    DONE(plm_study_add_response(c.study, "cut off", c.hbm, NULL));
    DONE(plm_study_set_double(c.study, "accuracy", 1e-6));
    assert_int_equal(plm_study_run(c.study), PLM_WARNING);
    DONE(plm_study_get_outcome(c.study, -1, sizeof text, text, NULL));
    assert_true(strstr(text, "max_harmonics of the reference") != NULL);
}

/* Steady states by marching against 40 harmonics, at the same frequencies: the exact flow of the reduced
 * model to the truncation of the harmonics, Newmark's steps to their own second order. */
static void marching_finds_what_harmonic_balance_finds(void **state) {
    enum { N = 6, STEPS = 400 };
    plm_transient *exact = NULL, *steps = NULL;
    double hz[N], amplitude[N], worst[2] = {0, 0};
    int64_t n = 0;
    int k, i;
    (void)state;
    DONE(plm_hbm_set_int(c.hbm, "n_harmonics", 40));
    DONE(plm_study_set_reference(c.study, c.hbm));
    DONE(plm_transient_create(c.model, c.basis, &exact));
    DONE(plm_transient_create(c.model, NULL, &steps));
    for (k = 0; k < 2; ++k) {
        plm_transient *motion = k == 0 ? exact : steps;
        DONE(plm_transient_set_double(motion, "settled", 1e-10));
        DONE(plm_transient_set_int(motion, "periods", 5000));
        DONE(plm_transient_set_int(motion, "steps_per_period", STEPS));
        DONE(plm_study_add_marching(c.study, k == 0 ? "exact flow" : "steps", motion, N, NULL));
    }
    DONE(plm_study_run(c.study));
    for (k = 0; k < 2; ++k) {
        DONE(plm_study_get_points(c.study, k, 0, N, hz, amplitude, &n));
        assert_int_equal(n, N);
        assert_true(hz[0] == 0.2 && close_to(hz[N - 1], 0.12, 1e-15));
        for (i = 0; i < N; ++i) {
            plm_branch *point = NULL;
            double want = 0;
            DONE(plm_hbm_solve(c.hbm, hz[i], NULL, 0, &point));
            DONE(plm_branch_get_amplitude(point, 0, PLM_HALF_PEAK_TO_PEAK, 0, 1, &want, &n));
            worst[k] = larger(worst[k], fabs(amplitude[i] / want - 1));
        }
    }
    print_message("marching against harmonic balance: %.1e, %.1e; distance from the curve %.1e, %.1e\n",
                  worst[0], worst[1], study_real(c.study, "curve_error_max", 0),
                  study_real(c.study, "curve_error_max", 1));
    assert_true(worst[0] < 2e-7); /* settled to 1e-10 a period, which decays by 12 %; 40 harmonics */
    assert_true(worst[1] < 5e-3); /* (2 pi / 400)^2 / 12 in frequency, at slopes of the resonance */
    assert_true(study_real(c.study, "curve_error_max", 0) < 1e-6 &&
                study_real(c.study, "curve_error_max", 1) < 5e-3);
    assert_true(study_int(c.study, "failed_steps", 0) == 0 &&
                isnan(study_real(c.study, "iteration_seconds", 0)));
    assert_int_equal(study_int(c.study, "basis_size", 1), 1);
}

static void a_method_that_fails_is_a_row(void **state) {
    char text[400] = "", name[20] = "";
    plm_branch *curve = NULL;
    plm_basis *without = NULL;
    plm_hbm *bad = NULL;
    (void)state;
    DONE(plm_basis_create(c.model, &without)); /* kind plm without a sampler */
    DONE(plm_hbm_create(without, &bad));
    DONE(plm_study_set_reference(c.study, c.hbm));
    DONE(plm_study_add_response(c.study, "bad", bad, NULL));
    DONE(plm_study_add_response(c.study, "good", c.hbm, NULL));
    DONE(plm_hbm_set_int(c.hbm, "max_points", 3));
    DONE(plm_study_add_response(c.study, "short", c.hbm, NULL));
    assert_int_equal(plm_study_run(c.study), PLM_WARNING);
    DONE(plm_study_get_outcome(c.study, 0, sizeof text, text, NULL));
    assert_non_null(strstr(text, "needs a sampler; give the basis one"));
    DONE(plm_study_get_outcome(c.study, 1, sizeof text, text, NULL));
    assert_string_equal(text, "reached the end of its range");
    DONE(plm_study_get_outcome(c.study, 2, sizeof text, text, NULL));
    assert_non_null(strstr(text, "max_points"));
    DONE(plm_study_get_outcome(c.study, -1, sizeof text, text, NULL));
    assert_string_equal(text, "reached the end of its range");
    DONE(plm_study_get_name(c.study, 2, sizeof name, name, NULL));
    assert_string_equal(name, "short");
    DONE(plm_study_get_name(c.study, -1, sizeof name, name, NULL));
    assert_string_equal(name, "reference");
    assert_true(isnan(study_real(c.study, "curve_error_l2", 0)) &&
                isnan(study_real(c.study, "setup_seconds", 0)));
    assert_true(study_int(c.study, "basis_size", 0) == -1 && study_int(c.study, "pareto", 0) == 0);
    assert_true(study_real(c.study, "curve_error_max", 1) < 1e-8);
    assert_true(study_real(c.study, "curve_error_max", 2) > 0.1); /* most of the curve is missing */
    assert_true(refused(ctx, plm_study_get_curve(c.study, 0, 0, &curve), PLM_ERR_STATE, "plm_study_get_curve",
                        "index", -1, "give the basis one"));
    DONE(plm_study_get_curve(c.study, -1, 0, &curve));
    DONE(plm_study_destroy(&c.study)); /* the curve stays */
    {
        double share = -1;
        DONE(plm_branch_get_closed_share(curve, 0, 1, &share));
        assert_true(share >= 0);
    }
}

/* ---- the cracked plate: a basis that is too small ---- */

static void a_small_basis_has_the_error_computed_by_hand(void **state) {
    cracked_plate_params params;
    scene *host = NULL;
    plm_model *model = NULL;
    plm_sampler *sampler = NULL;
    plm_basis *basis = NULL;
    plm_hbm *hbm = NULL;
    plm_study *study = NULL;
    double hz[2], amplitude[2], low, high, value[3];
    int64_t size = 0, n = 0;
    int k;
    (void)state;
    cracked_plate_quick(&params);
    assert_int_equal(cracked_plate_create(&params, &host), SCENE_OK);
    DONE(scene_to_model(ctx, host, &model));
    DONE(plm_sampler_create(model, &sampler));
    DONE(plm_sampler_set_int(sampler, "mode", host->dominant_mode));
    DONE(plm_sampler_set_string(sampler, "system", "open"));
    DONE(plm_sampler_set_int(sampler, "n_samples", 1));
    DONE(plm_basis_create(model, &basis));
    DONE(plm_basis_set_sampler(basis, sampler));
    DONE(plm_hbm_create(basis, &hbm));
    DONE(plm_hbm_set_int(hbm, "n_harmonics", 5));
    DONE(plm_hbm_set_string(hbm, "stability", "off")); /* five harmonics do not tell it, and peaks say so */
    DONE(plm_study_create(model, &study));
    DONE(plm_study_set_int(study, "repeats", 1));
    DONE(plm_study_set_output(study, host->output_dof, PLM_HALF_PEAK_TO_PEAK, 0));
    DONE(plm_study_add_response(study, "one sample", hbm, NULL)); /* nothing has been built or run yet */
    DONE(plm_study_add_compressed(study, "compressed", hbm, 6, NULL));
    DONE(plm_study_add_refined(study, "refined", hbm, 1e-3, NULL));
    DONE(plm_study_run(study));

    DONE(plm_sampler_run(sampler));
    for (k = 0; k < 2; ++k) {
        plm_branch *curve = NULL;
        DONE(plm_basis_set_string(basis, "kind", k == 0 ? "plm" : "full"));
        DONE(plm_basis_build(basis));
        if (k == 0) DONE(plm_basis_get_int(basis, "size", &size));
        if (k == 0) DONE(plm_basis_get_double(basis, "window_low_hz", &low));
        if (k == 0) DONE(plm_basis_get_double(basis, "window_high_hz", &high));
        DONE(plm_hbm_sweep(hbm, &curve));
        DONE(plm_hbm_find_peak(hbm, curve, host->output_dof, PLM_HALF_PEAK_TO_PEAK, 0, &hz[k], &amplitude[k],
                               NULL));
    }
    print_message("one sample: %.2e of the amplitude, %.2e of the frequency, curve %.2e; effectivity %.3f, "
                  "%.3f, %.3f\n",
                  study_real(study, "amplitude_error", 0), study_real(study, "frequency_error", 0),
                  study_real(study, "curve_error_l2", 0), study_real(study, "effectivity", 0),
                  study_real(study, "effectivity", 1), study_real(study, "effectivity", 2));
    /* the unreduced structure by hand and in the study are right to the model's space_tolerance, 1e-8 */
    assert_true(fabs(study_real(study, "amplitude_error", 0) - fabs(amplitude[0] / amplitude[1] - 1)) < 1e-6);
    assert_true(fabs(study_real(study, "frequency_error", 0) - fabs(hz[0] / hz[1] - 1)) < 1e-7);
    assert_int_equal(study_int(study, "basis_size", 0), size);
    assert_int_equal(study_int(study, "basis_size", 1), 6);
    assert_true(study_scalar(study, "frequency_low_hz") == low &&
                study_scalar(study, "frequency_high_hz") == high);
    /* the shift of the resonance moves flanks that are steep: a part of the curve is off by at least the
     * shift */
    assert_true(study_real(study, "curve_error_max", 0) > 0.5 * fabs(hz[0] - hz[1]) / (high - low));
    /* refinement met its tolerance, of the amplitude over the peak */
    assert_true(study_real(study, "amplitude_error", 2) < 1e-3);
    DONE(plm_study_get_array(study, "effectivity", 3, value, &n));
    for (k = 0; k < 3; ++k) assert_true(value[k] > 0.3 && value[k] < 3);
    /* the basis vectors alone are so large */
    for (k = 0; k < 3; ++k)
        assert_true(study_int(study, "peak_bytes", k) >=
                    8 * (host->n_dof - host->n_fixed) * study_int(study, "basis_size", k));
    scene_destroy(&host);
}

/* ---- files ---- */

static int contains(const char *path, const char *words) {
    static char text[20000];
    FILE *f = fopen(path, "r");
    size_t n;
    if (!f) return 0;
    n = fread(text, 1, sizeof text - 1, f);
    text[n] = 0;
    fclose(f);
    if (!strstr(text, words)) printf("    \"%s\" is not in %s\n", words, path);
    return strstr(text, words) != NULL;
}

/* what the test below has made */
static void clean_up(const char *folder) {
    static const char *const names[] = {"new/report.md",
                                        "new/table.csv",
                                        "new/curve_0_a_b_c_0.csv",
                                        "new/curve_reference_0.csv",
                                        "new",
                                        "mine.txt",
                                        "report.md",
                                        "table.csv",
                                        "curve_0_a_b_c_0.csv",
                                        "curve_reference_0.csv"};
    char path[200];
    size_t i;
    for (i = 0; i < sizeof names / sizeof *names; ++i) {
        snprintf(path, sizeof path, "%s/%s", folder, names[i]);
        remove(path);
    }
    assert_int_equal(remove(folder), 0); /* empty: nothing else was written */
}

static void the_report_is_written_and_nothing_else(void **state) {
    char folder[] = "plm_study_XXXXXX", path[200], inside[200];
    FILE *f;
    (void)state;
    DONE(plm_study_add_response(c.study, "A|B, \"C\"", c.hbm, NULL));
    DONE(plm_study_run(c.study));
    assert_non_null(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/mine.txt", folder);
    f = fopen(path, "w");
    fputs("mine", f);
    fclose(f);
    DONE(plm_study_write(c.study, folder));
    DONE(plm_study_write(c.study, folder)); /* over its own files */
    assert_true(contains(path, "mine"));
    snprintf(path, sizeof path, "%s/report.md", folder);
    assert_true(contains(path, "| A\\|B, \"C\" | yes | 1 |") && contains(path, "n_harmonics = 7"));
    snprintf(path, sizeof path, "%s/table.csv", folder);
    assert_true(contains(path, "name,pareto,basis_size") && contains(path, "\"A|B, \"\"C\"\"\",1,1,"));
    snprintf(path, sizeof path, "%s/curve_0_a_b_c_0.csv", folder);
    assert_true(contains(path, "frequency_hz,amplitude\n0.2"));
    snprintf(path, sizeof path, "%s/curve_reference_0.csv", folder);
    assert_true(contains(path, "frequency_hz,amplitude\n0.2"));
    snprintf(inside, sizeof inside, "%s/new", folder); /* made when its parent is there */
    DONE(plm_study_write(c.study, inside));
    snprintf(inside, sizeof inside, "%s/none/new", folder);
    assert_true(refused(ctx, plm_study_write(c.study, inside), PLM_ERR_ARGUMENT, "plm_study_write", "folder",
                        -1, "cannot be made"));
    snprintf(inside, sizeof inside, "%s/mine.txt", folder); /* a file */
    assert_true(refused(ctx, plm_study_write(c.study, inside), PLM_ERR_ARGUMENT, "plm_study_write", "folder",
                        -1, "cannot be made"));
    snprintf(path, sizeof path, "%s/new/report.md", folder);
    assert_int_equal(remove(path), 0);
    assert_int_equal(mkdir(path, 0700), 0); /* in the way, also of root */
    snprintf(inside, sizeof inside, "%s/new", folder);
    assert_true(refused(ctx, plm_study_write(c.study, inside), PLM_ERR_ARGUMENT, "plm_study_write", "folder",
                        -1, "cannot be written"));
    clean_up(folder);
}

/* ---- hosts ---- */

typedef struct watcher {
    int calls, stop_at, in_study;
    double begun[3]; /* told as the reference and the first two methods begin */
} watcher;

static int32_t watch(plm_context *context, const char *stage, double fraction, void *user) {
    watcher *w = (watcher *)user;
    (void)context;
    if (strcmp(stage, "study") == 0 && w->in_study++ < 3) w->begun[w->in_study - 1] = fraction;
    return ++w->calls == w->stop_at;
}

static void cancelled_anywhere_it_keeps_what_is_done(void **state) {
    watcher w = {0, -1, 0, {-1, -1, -1}};
    int64_t n = 0;
    int whole, step, before = 0, after = 0;
    (void)state;
    DONE(plm_study_add_response(c.study, "one", c.hbm, NULL));
    DONE(plm_study_add_response(c.study, "two", c.hbm, NULL));
    DONE(plm_study_run(c.study)); /* the later ones have its contact space */
    DONE(plm_context_set_progress(ctx, watch, &w));
    DONE(plm_study_run(c.study));
    assert_true(w.in_study >= 3);
    printf("    %g, %g, %g\n", w.begun[0], w.begun[1], w.begun[2]);
    assert_true(w.begun[0] < 0.3 && w.begun[1] >= w.begun[0] && w.begun[1] < 0.5 && w.begun[2] < 0.8);
    whole = w.calls;
    DONE(plm_study_destroy(&c.study));
    for (step = 1; step <= whole; step += 1 + whole / 40) {
        plm_study *study = NULL;
        char text[100] = "";
        DONE(plm_study_create(c.model, &study));
        DONE(plm_study_set_output(study, 0, PLM_RMS, 0));
        DONE(plm_study_set_int(study, "repeats", 1));
        DONE(plm_study_add_response(study, "one", c.hbm, NULL));
        DONE(plm_study_add_response(study, "two", c.hbm, NULL));
        w.calls = 0, w.stop_at = step;
        assert_int_equal(plm_study_run(study), PLM_CANCELLED);
        if (plm_study_get_array(study, "peak_hz", 0, NULL, &n) == PLM_ERR_STATE) {
            ++before; /* no reference yet */
        } else {
            ++after;
            DONE(plm_study_get_outcome(study, 1, sizeof text, text, NULL));
            assert_non_null(strstr(text, "cancelled"));
            assert_true(study_scalar(study, "reference_peak_hz") > 0.12);
        }
        DONE(plm_study_destroy(&study));
    }
    assert_true(before > 0 && after > 0);
}

typedef struct host {
    long made, freed;
} host;

static void *take(int64_t bytes, void *user) {
    ++((host *)user)->made;
    return malloc((size_t)bytes);
}
static void give_back(void *block, void *user) {
    ++((host *)user)->freed;
    free(block);
}

static void arrays_come_from_the_hosts_allocator(void **state) {
    plm_context *own = NULL;
    plm_branch *curve = NULL;
    study_case d;
    host h = {0, 0};
    long before;
    (void)state;
    assert_int_equal(plm_context_create_with_allocator(PLM_API_VERSION, take, give_back, &h, &own), PLM_OK);
    assert_true(done(own, study_case_make(own, &d)));
    assert_true(done(own, plm_study_add_response(d.study, "one", d.hbm, NULL)));
    before = h.made;
    assert_true(done(own, plm_study_run(d.study)));
    assert_true(h.made > before + 100);
    assert_true(study_int(d.study, "peak_bytes", 0) > 1000);
    assert_true(done(own, plm_study_get_curve(d.study, 0, 0, &curve))); /* counted blocks outlive the study */
    assert_true(done(own, plm_study_destroy(&d.study)));
    assert_int_equal(plm_context_destroy(&own), PLM_OK);
    assert_int_equal(h.made, h.freed);
}

int main(void) {
#define TEST(f) cmocka_unit_test_setup_teardown(f, set_up, tear_down)
    const struct CMUnitTest tests[] = {
        TEST(the_reference_against_itself_is_exact),
        TEST(the_reference_says_how_converged_it_is),
        TEST(several_levels_give_the_worst_error_and_the_whole_time),
        TEST(one_level_compresses_for_all_where_the_response_is_proportional),
        TEST(a_method_keeps_the_options_it_was_added_with),
        TEST(one_number_is_the_accuracy),
        TEST(exact_motions_are_their_own_reference),
        TEST(a_reference_short_of_harmonics_is_told),
        TEST(marching_finds_what_harmonic_balance_finds),
        TEST(a_method_that_fails_is_a_row),
        TEST(a_small_basis_has_the_error_computed_by_hand),
        TEST(the_report_is_written_and_nothing_else),
        TEST(cancelled_anywhere_it_keeps_what_is_done),
        TEST(arrays_come_from_the_hosts_allocator),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
