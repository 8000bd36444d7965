/* study_exact.c: the response with nothing set, beside the curves of a fixed number of harmonics: what these
 * leave out is in none of their errors, since their reference has as many. */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "study.h"

int study_run_exact(study_case *c, study_exact *e) {
    char path[STUDY_PATH], unknowns[STUDY_NAME] = "";
    plm_branch *curve = NULL;
    const double begin = study_seconds();
    const int64_t dof = c->scene->output_dof;
    memset(e, 0, sizeof *e);
    snprintf(path, sizeof path, "%s/curve_exact.csv", c->options->output);
    int failed = plm_model_compute_response(c->model, dof, PLM_HALF_PEAK_TO_PEAK, 1e-3, &e->hz, &e->amplitude,
                                            &e->error, &curve, NULL) < 0;
    e->seconds = study_seconds() - begin;
    failed = failed || plm_branch_write_csv(curve, dof, PLM_HALF_PEAK_TO_PEAK, 0, path) < 0 ||
             plm_branch_get_int(curve, "basis_size", &e->columns) < 0 ||
             plm_branch_get_string(curve, "unknowns", sizeof unknowns, unknowns, NULL) < 0;
    e->is_exact = !strcmp(unknowns, "state");
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
            " is %.2g %% off that peak and %.2g %% off its frequency. The picture of the curves shows it as "
            "\"nothing set\".\n",
            c->options->n_harmonics, e->is_exact ? "exact motions" : "harmonics as each point needs",
            e->columns, e->seconds, e->amplitude, e->hz, e->error, c->options->n_harmonics,
            100 * fabs(peak / e->amplitude - 1), 100 * fabs(hz / e->hz - 1));
}
