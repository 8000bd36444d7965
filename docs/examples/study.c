/* study.c: error against run time of several ways to one response curve. */
#include "example.h"
#include <stdio.h>
#include <stdlib.h>

enum { MAX_METHODS = 8 };

static int plan(plm_model *model, plm_basis *basis, plm_hbm *hbm, plm_study **made) {
    /* [plm_study_create] */
    plm_study *study = NULL;
    TRY(plm_study_create(model, &study));
    /* [plm_study_create] */
    *made = study;

    /* [plm_study_set_output] [plm_study_set_force_levels] */
    const double levels[] = {0.5, 1};
    TRY(plm_study_set_output(study, 1, PLM_HALF_PEAK_TO_PEAK, 0)); /* the second DOF */
    TRY(plm_study_set_force_levels(study, 2, levels));
    /* [plm_study_set_output] [plm_study_set_force_levels] */

    /* [plm_study_set_int] [plm_study_set_double] */
    TRY(plm_study_set_int(study, "repeats", 1));
    TRY(plm_study_set_double(study, "curve_tolerance", 1e-6));
    /* [plm_study_set_int] [plm_study_set_double] */

    /* [plm_study_add_response] */
    int64_t index;
    TRY(plm_study_add_response(study, "piecewise-linear modes", hbm, &index));
    TRY(plm_basis_set_string(basis, "kind", "craig_bampton")); /* the first method keeps its own options */
    TRY(plm_study_add_response(study, "Craig-Bampton", hbm, &index));
    /* [plm_study_add_response] */
    EXPECT(index == 1);
    TRY(plm_basis_set_string(basis, "kind", "plm"));

    /* [plm_study_add_compressed] [plm_study_add_refined] */
    TRY(plm_study_add_compressed(study, "compressed", hbm, 0,
                                 NULL)); /* as many columns as pod_tolerance asks for */
    TRY(plm_study_add_refined(study, "refined", hbm, 1e-3, NULL));
    /* [plm_study_add_compressed] [plm_study_add_refined] */

    /* [plm_study_add_marching] */
    plm_transient *motion = NULL;
    TRY(plm_transient_create(model, basis, &motion));
    TRY(plm_transient_set_double(motion, "settled", 1e-6));
    TRY(plm_transient_set_int(motion, "periods", 2000)); /* at most, at each frequency */
    TRY(plm_study_add_marching(study, "marching", motion, 5, NULL));
    TRY(plm_transient_destroy(&motion));
    /* [plm_study_add_marching] */

    /* [plm_study_set_reference] */
    TRY(plm_basis_set_string(basis, "kind", "full"));
    TRY(plm_study_set_reference(study, hbm)); /* NULL would mean the same here */
    /* [plm_study_set_reference] */
    return 0;
}

static int read(plm_study *study) {
    /* [plm_study_get_array] [plm_study_get_int_array] [plm_study_get_name] */
    int64_t n, k, pareto[MAX_METHODS];
    double error[MAX_METHODS], seconds[MAX_METHODS];
    TRY(plm_study_get_array(study, "curve_error_l2", MAX_METHODS, error, &n));
    TRY(plm_study_get_array(study, "curve_seconds", MAX_METHODS, seconds, &n));
    TRY(plm_study_get_int_array(study, "pareto", MAX_METHODS, pareto, &n));
    for (k = 0; k < n; ++k) {
        char name[60];
        TRY(plm_study_get_name(study, k, sizeof name, name, NULL));
        printf("%-24s %8.2g s, error %.1e%s\n", name, seconds[k], error[k], pareto[k] ? "  (Pareto)" : "");
    }
    /* [plm_study_get_array] [plm_study_get_int_array] [plm_study_get_name] */
    EXPECT(n == 5 && error[0] < 1e-2);

    /* [plm_study_get_int] [plm_study_get_double] */
    int64_t size;
    double harmonics;
    TRY(plm_study_get_int(study, "reference_size", &size));
    TRY(plm_study_get_double(study, "reference_harmonic_error", &harmonics));
    printf("reference: %d coordinates, with twice the harmonics %.1e off\n", (int)size, harmonics);
    /* [plm_study_get_int] [plm_study_get_double] */

    /* [plm_study_get_outcome] */
    char how[200];
    TRY(plm_study_get_outcome(study, -1, sizeof how, how, NULL)); /* -1: the reference */
    printf("reference: %s\n", how);
    /* [plm_study_get_outcome] */

    /* [plm_study_get_curve] */
    plm_branch *curve = NULL;
    TRY(plm_study_get_curve(study, 0, 1, &curve)); /* of the first method at the second force level */
    TRY(plm_branch_destroy(&curve));
    /* [plm_study_get_curve] */

    /* [plm_study_get_points] */
    TRY(plm_study_get_points(study, 0, 1, 0, NULL, NULL, &n)); /* capacity 0: how many points? */
    double *hz = malloc((size_t)n * sizeof *hz), *amplitude = malloc((size_t)n * sizeof *amplitude);
    plm_status s = hz && amplitude ? PLM_OK : PLM_ERR_MEMORY;
    if (!s) s = plm_study_get_points(study, 0, 1, n, hz, amplitude, &n);
    if (!s) printf("from %.3f mm at %.2f Hz on\n", 1e3 * amplitude[0], hz[0]);
    free(hz), free(amplitude);
    /* [plm_study_get_points] */
    EXPECT(s == PLM_OK && n > 10);
    return 0;
}

int example(plm_context *ctx) {
    plm_model *model = NULL;
    plm_basis *basis = NULL;
    plm_hbm *hbm = NULL;
    plm_study *study = NULL;
    int line;
    TRY(start_model(ctx, &model));
    TRY(plm_model_build(model));
    TRY(basis_of(model, &basis));
    TRY(plm_hbm_create(basis, &hbm));
    TRY(plm_hbm_set_int(hbm, "n_harmonics", 5));
    line = plan(model, basis, hbm, &study);
    if (line) return line;

    /* [plm_study_run] */
    const plm_status ran = plm_study_run(study);
    if (ran == PLM_WARNING) printf("some methods need a look: see plm_study_get_outcome\n");
    /* [plm_study_run] */
    EXPECT(ran == PLM_OK || ran == PLM_WARNING);
    line = read(study);
    if (line) return line;

    /* [plm_study_write] */
    TRY(plm_study_write(study, "study_report")); /* report.md, table.csv, curve_*.csv */
    /* [plm_study_write] */

    /* [plm_study_set_string] [plm_study_get_string] */
    char text[60]; /* no key of a study is a text so far */
    EXPECT(plm_study_set_string(study, "repeats", "3") == PLM_ERR_ARGUMENT);
    EXPECT(plm_study_get_string(study, "repeats", sizeof text, text, NULL) == PLM_ERR_ARGUMENT);
    /* [plm_study_set_string] [plm_study_get_string] */

    /* [plm_study_destroy] */
    TRY(plm_study_destroy(&study));
    /* [plm_study_destroy] */
    return 0;
}
