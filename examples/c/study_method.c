/* study_method.c: one basis, its response curve and its peak, with the time each took. */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "study.h"

static study_method plm_method(int64_t n_samples, const char *selection) {
    study_method m = {"", "", "plm", selection, n_samples};
    const char *tail = strcmp(selection, "bands") ? "" : "_bands";
    snprintf(m.name, sizeof m.name, "plm_%" PRId64 "%s", n_samples, tail);
    snprintf(m.label, sizeof m.label, "%" PRId64 " sample%s%s", n_samples, n_samples == 1 ? "" : "s",
             *tail ? ", bands" : "");
    return m;
}

int32_t study_methods(const study_options *o, study_method method[STUDY_METHODS]) {
    int32_t n = 0;
    for (int32_t i = 0; i < o->n_counts; i++) method[n++] = plm_method(o->count[i], "below");
    method[n++] = plm_method(4, "bands");
    method[n++] = (study_method){"craig_bampton", "Craig-Bampton", "craig_bampton", "below", 0};
    method[n++] = (study_method){"full_order", "full order", "full", "below", 0};
    return n;
}

typedef struct handles {
    plm_sampler *sampler;
    plm_basis *basis;
    plm_hbm *hbm;
    plm_branch *curve, *peak;
} handles;

#define TRY(call)                                                                                            \
    do {                                                                                                     \
        const plm_status status_ = (call);                                                                   \
        if (status_ < 0) return status_;                                                                     \
    } while (0)

static plm_status build_basis(study *s, const study_method *m, handles *h, study_result *r) {
    const double begin = study_seconds();
    if (m->n_samples > 0) {
        TRY(study_sample(s, m->n_samples, &h->sampler));
        TRY(plm_sampler_get_int(h->sampler, "n_selected", &r->contact_sets));
    }
    TRY(plm_basis_create(s->model, &h->basis));
    TRY(plm_basis_set_string(h->basis, "kind", m->kind));
    TRY(plm_basis_set_string(h->basis, "selection", m->selection));
    TRY(plm_basis_set_int(h->basis, "n_harmonics", s->options->n_harmonics));
    TRY(plm_basis_set_sampler(h->basis, h->sampler ? h->sampler : s->sampler));
    TRY(plm_basis_build(h->basis));
    r->setup_seconds = study_seconds() - begin;
    TRY(plm_basis_get_int(h->basis, "size", &r->basis_size));
    TRY(plm_basis_get_int(h->basis, "n_collected", &r->n_collected));
    return plm_basis_get_string(h->basis, "warning", sizeof r->warning, r->warning, NULL);
}

static plm_status follow_curve(study *s, handles *h, study_result *r) {
    TRY(plm_hbm_create(h->basis, &h->hbm));
    TRY(plm_hbm_set_int(h->hbm, "n_harmonics", s->options->n_harmonics));
    TRY(plm_hbm_sweep(h->hbm, &h->curve));
    TRY(plm_branch_get_double(h->curve, "seconds", &r->curve_seconds));
    TRY(plm_branch_get_double(h->curve, "seconds_per_iteration", &r->iteration_seconds));
    TRY(plm_branch_get_int(h->curve, "n_points", &r->n_points));
    TRY(plm_branch_get_int(h->curve, "newton_iterations", &r->newton_iterations));
    TRY(plm_branch_get_int(h->curve, "end_reason", &r->end_reason));
    TRY(plm_branch_get_string(h->curve, "end_text", sizeof r->end, r->end, NULL));
    return plm_branch_get_string(h->curve, "unknowns", sizeof r->unknowns, r->unknowns, NULL);
}

static plm_status find_peak(study *s, handles *h, study_result *r) {
    TRY(plm_hbm_find_peak(h->hbm, h->curve, s->scene->output_dof, PLM_HALF_PEAK_TO_PEAK, 0, &r->peak_hz,
                          &r->peak_amplitude, &h->peak));
    return plm_branch_get_full_residual(h->peak, 0, &r->full_residual);
}

static plm_status run(study *s, const study_method *m, handles *h, study_result *r) {
    TRY(build_basis(s, m, h, r));
    study_say(s, "%s: basis of %" PRId64 " from %" PRId64 " vectors, %.3f s", m->label, r->basis_size,
              r->n_collected, r->setup_seconds);
    TRY(follow_curve(s, h, r));
    TRY(find_peak(s, h, r));
    study_say(s, "%s: %" PRId64 " points in %.3f s, peak %.6g at %.6g Hz; %s", m->label, r->n_points,
              r->curve_seconds, r->peak_amplitude, r->peak_hz, r->end);
    return PLM_OK;
}

void study_run_method(study *s, const study_method *m, study_result *r) {
    handles h = {NULL, NULL, NULL, NULL, NULL};
    memset(r, 0, sizeof *r);
    r->method = *m;
    r->peak_hz = r->peak_amplitude = r->full_residual = r->error_hz = r->error_amplitude = NAN;
    const plm_status status = run(s, m, &h, r);
    if (status < 0) plm_context_get_error_text(s->ctx, sizeof r->error, r->error, NULL);
    if (status == PLM_OK && (study_write_curve(s, m, h.curve) || study_write_cycle(s, m, h.peak)))
        snprintf(r->error, sizeof r->error, "its files could not be written");
    if (r->error[0]) study_say(s, "%s: FAILED: %s", m->label, r->error);
    plm_branch_destroy(&h.peak);
    plm_branch_destroy(&h.curve);
    plm_hbm_destroy(&h.hbm);
    plm_basis_destroy(&h.basis);
    plm_sampler_destroy(&h.sampler);
}

void study_compare(study_result *result, int32_t n) {
    const study_result *reference = &result[n - 1];
    for (int32_t i = 0; i < n; i++) {
        result[i].error_hz = fabs(result[i].peak_hz / reference->peak_hz - 1);
        result[i].error_amplitude = fabs(result[i].peak_amplitude / reference->peak_amplitude - 1);
    }
}
