/* study_exact.c: the response with nothing set, beside the curves of a fixed number of harmonics: what these
 * leave out is in none of their errors, since their reference has as many. */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "study.h"

/* Its peak, and its curve where that is of exact motions. */
static int write_files(study_case *c, const study_exact *e, plm_branch *curve) {
    char path[STUDY_PATH];
    FILE *file = study_open_file(c->options, "nothing_set.csv");
    if (!file) return 1;
    fprintf(file, "peak_hz,peak_amplitude\n%.9g,%.9g\n", e->hz, e->amplitude);
    if (study_close_file(file)) return 1;
    snprintf(path, sizeof path, "%s/curve_exact.csv", c->options->output);
    return e->is_exact &&
           plm_branch_write_csv(curve, c->scene->output_dof, PLM_HALF_PEAK_TO_PEAK, 0, path) < 0;
}

int study_run_exact(study_case *c, study_exact *e) {
    char unknowns[STUDY_NAME] = "";
    plm_branch *curve = NULL;
    const double begin = study_seconds();
    memset(e, 0, sizeof *e);
    int failed = plm_model_compute_response(c->model, c->scene->output_dof, PLM_HALF_PEAK_TO_PEAK, 1e-3,
                                            &e->hz, &e->amplitude, &e->error, &curve, NULL) < 0;
    e->seconds = study_seconds() - begin;
    failed = failed || plm_branch_get_int(curve, "basis_size", &e->columns) < 0 ||
             plm_branch_get_string(curve, "unknowns", sizeof unknowns, unknowns, NULL) < 0;
    e->is_exact = !strcmp(unknowns, "state");
    failed = failed || write_files(c, e, curve);
    plm_branch_destroy(&curve);
    return failed ? study_complain(c->ctx, "response with nothing set") : 0;
}

void study_write_exact(const study_case *c, const study_result *one, const study_exact *e, FILE *to) {
    double peak = NAN, hz = NAN;
    plm_study_get_double(one->study, "reference_peak_amplitude", &peak);
    plm_study_get_double(one->study, "reference_peak_hz", &hz);
    fprintf(to,
            "\n## With nothing set\n\nAll curves above have H = %" PRId64
            ", the reference too. The response in one call with nothing set, %s on a basis of %" PRId64
            " columns, took %.3g s: peak %.6g at %.6g Hz, its error estimated to be %.1e. H = %" PRId64
            " is %.2g %% off that peak and %.2g %% off its frequency. The picture of the curves has it as "
            "\"nothing set\".\n",
            c->options->n_harmonics,
            e->is_exact ? "a curve of exact motions"
                        : "a curve of few harmonics and a peak that is closed in upon",
            e->columns, e->seconds, e->amplitude, e->hz, e->error, c->options->n_harmonics,
            100 * fabs(peak / e->amplitude - 1), 100 * fabs(hz / e->hz - 1));
}
