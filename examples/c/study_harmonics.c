/* study_harmonics.c: what the number of harmonics, of time samples, and the search for bifurcations do to a
 * curve, on one and the same compressed basis, so that nothing else differs. */
#include <inttypes.h>
#include <string.h>

#include "study.h"

/* The basis of four samples, its curve, and the basis of kind "pod" made from it. */
static plm_status compress(study_case *c, study_recipe *r, plm_basis **pod) {
    plm_branch *curve = NULL;
    plm_status status = study_recipe_make(c, "", r);
    if (status >= 0) status = plm_sampler_run(r->sampler);
    if (status >= 0) status = plm_basis_build(r->basis);
    if (status >= 0) status = plm_hbm_sweep(r->hbm, &curve);
    if (status >= 0) status = plm_basis_create(c->model, pod);
    if (status >= 0) status = plm_basis_set_string(*pod, "kind", "pod");
    if (status >= 0) status = plm_basis_set_parent(*pod, r->basis);
    if (status >= 0) status = plm_basis_set_responses(*pod, 1, &curve);
    if (status >= 0) status = plm_basis_build(*pod);
    plm_branch_destroy(&curve);
    return status;
}

static plm_status follow(study_case *c, plm_hbm *hbm, study_step *s) {
    plm_branch *curve = NULL;
    plm_status status = plm_hbm_sweep(hbm, &curve);
    if (status >= 0) status = plm_branch_get_double(curve, "seconds", &s->seconds);
    if (status >= 0) status = plm_branch_get_int(curve, "n_points", &s->n_points);
    if (status >= 0) status = plm_branch_get_int(curve, "n_harmonics", &s->harmonics);
    if (status >= 0)
        status = plm_hbm_find_peak(hbm, curve, c->scene->output_dof, PLM_HALF_PEAK_TO_PEAK, 0, &s->hz,
                                   &s->amplitude, NULL);
    plm_branch_destroy(&curve);
    return status;
}

static plm_status vary_harmonics(study_case *c, plm_hbm *hbm, study_steps *s) {
    static const int64_t numbers[] = {0, 1, 2, 3, 5, 7, 9, 12, 16, 20, 30};
    plm_status status = PLM_OK;
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers && status >= 0; i++) {
        study_step *step = &s->harmonics[s->n_harmonics++];
        step->number = numbers[i];
        status = plm_hbm_set_int(hbm, "n_harmonics", step->number);
        if (status >= 0) status = follow(c, hbm, step);
    }
    return status;
}

static plm_status vary_samples(study_case *c, plm_hbm *hbm, study_steps *s) {
    static const int64_t numbers[] = {16, 32, 64, 128, 256, 512, 1024, 0};
    plm_status status = plm_hbm_set_int(hbm, "n_harmonics", c->options->n_harmonics);
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers && status >= 0; i++) {
        if (numbers[i] > 0 && numbers[i] <= 4 * c->options->n_harmonics)
            continue; /* too few for the tangent */
        study_step *step = &s->samples[s->n_samples++];
        step->number = numbers[i];
        status = plm_hbm_set_string(hbm, "aft", step->number > 0 ? "sampled" : "event");
        if (status >= 0 && step->number > 0) status = plm_hbm_set_int(hbm, "time_samples", step->number);
        if (status >= 0) status = follow(c, hbm, step);
    }
    return status;
}

/* What a curve can do without. */
static plm_status leave_out(study_case *c, plm_hbm *hbm, study_steps *s) {
    plm_status status = plm_hbm_set_int(hbm, "n_harmonics", c->options->n_harmonics);
    if (status >= 0) status = follow(c, hbm, &s->plain);
    if (status >= 0) status = plm_hbm_set_string(hbm, "bifurcations", "on");
    if (status >= 0) status = follow(c, hbm, &s->bifurcations);
    if (status >= 0) status = plm_hbm_set_string(hbm, "bifurcations", "off");
    if (status >= 0) status = plm_hbm_set_string(hbm, "stability", "floquet");
    if (status >= 0) status = follow(c, hbm, &s->stability);
    if (status >= 0) status = plm_hbm_set_string(hbm, "stability", "off");
    if (status >= 0) status = plm_hbm_set_int(hbm, "n_harmonics", STUDY_MANY_HARMONICS);
    if (status >= 0) status = follow(c, hbm, &s->many_harmonics);
    return status;
}

int study_run_steps(study_case *c, study_steps *s) {
    study_recipe r;
    plm_basis *pod = NULL;
    plm_hbm *hbm = NULL;
    memset(s, 0, sizeof *s);
    plm_context_set_effort(c->ctx, 0); /* what is compared is not to be cut */
    plm_status status = compress(c, &r, &pod);
    if (status >= 0) status = plm_basis_get_int(pod, "size", &s->basis_size);
    if (status >= 0) study_say(c, "harmonics and time samples on %" PRId64 " coordinates", s->basis_size);
    if (status >= 0) status = plm_hbm_create(pod, &hbm);
    if (status >= 0) status = plm_hbm_set_string(hbm, "stability", "off");
    if (status >= 0) status = plm_hbm_set_string(hbm, "bifurcations", "off");
    if (study_wants(c->options, "convergence")) {
        if (status >= 0) status = vary_harmonics(c, hbm, s);
        if (status >= 0) status = vary_samples(c, hbm, s);
    }
    if (status >= 0 && study_wants(c->options, "left-out")) status = leave_out(c, hbm, s);
    const int failed = status < 0 ? study_complain(c->ctx, "harmonics and time samples") : 0;
    plm_hbm_destroy(&hbm);
    plm_basis_destroy(&pod);
    study_recipe_free(&r);
    return failed;
}
