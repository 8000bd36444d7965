/* study_case.c: the scene, its model, the first run of the sampler and what it found. */
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "scene_model.h"
#include "study.h"

plm_status study_sample(study *s, int64_t n_samples, plm_sampler **sampler) {
    /* The engineer knows which resonance is studied; without these two the library would propose the mode
     * that takes the largest part in the response of the driven DOF. */
    const char *system = s->scene->dominant_system == SCENE_OPEN ? "open" : "sliding";
    plm_status status = plm_sampler_create(s->model, sampler);
    if (!status) status = plm_sampler_set_string(*sampler, "system", system);
    if (!status) status = plm_sampler_set_int(*sampler, "mode", s->scene->dominant_mode);
    if (!status) status = plm_sampler_set_int(*sampler, "n_samples", n_samples);
    if (!status) status = plm_sampler_set_int(*sampler, "n_harmonics", s->options->n_harmonics);
    if (!status) status = plm_sampler_run(*sampler);
    return status;
}

static int complain(plm_context *ctx, const char *what) {
    char text[STUDY_TEXT] = "";
    plm_context_get_error_text(ctx, sizeof text, text, NULL);
    fprintf(stderr, "%s: %s\n", what, text);
    return 1;
}

int study_open(study *s, const study_options *o) {
    memset(s, 0, sizeof *s);
    s->options = o;
    s->begin = s->last_note = study_seconds();
    const int made = scene_create(o->scene, o->size, o->with_preload, &s->scene);
    if (made != SCENE_OK) {
        fprintf(stderr, "%s, %s: %s\n", o->scene, o->size, scene_error_text(made));
        return 1;
    }
    study_say(s, "scene made: %" PRId64 " DOFs, %" PRId64 " contact pairs", s->scene->n_dof,
              s->scene->n_pairs);
    if (plm_context_create(PLM_API_VERSION, &s->ctx)) return 1;
    plm_context_set_progress(s->ctx, study_progress, s);
    if (scene_to_model(s->ctx, s->scene, &s->model)) return complain(s->ctx, "model");
    study_say(s, "model built: matrices checked, stiffness factored");

    const double begin = study_seconds();
    if (study_sample(s, o->count[0], &s->sampler)) return complain(s->ctx, "sampler");
    s->contact_space = study_seconds() - begin;
    study_say(s, "contact space made, contact area swept");
    return 0;
}

void study_close(study *s) {
    plm_context_destroy(&s->ctx); /* and all that is left in it */
    scene_destroy(&s->scene);
}

static void print_rest(study *s) {
    int64_t n_closed = 0;
    if (!s->options->with_preload) {
        printf("Closed at rest   without pre-load the contact carries no force at rest\n");
        return;
    }
    if (plm_model_solve_rest(s->model) < 0 || plm_model_get_int(s->model, "rest_n_closed", &n_closed)) return;
    printf("Closed at rest   %" PRId64 " of %" PRId64 " pairs\n", n_closed, s->scene->n_pairs);
}

static void print_window(plm_sampler *sampler) {
    char why[STUDY_TEXT] = "";
    double low = 0, high = 0, blf = 0;
    plm_sampler_get_double(sampler, "window_low_hz", &low);
    plm_sampler_get_double(sampler, "window_high_hz", &high);
    plm_sampler_get_double(sampler, "blf_hz", &blf);
    plm_sampler_get_string(sampler, "window_why", sizeof why, why, NULL);
    printf("Window           [%.1f, %.1f] Hz: %s\n", low, high, why);
    printf("Bilinear freq.   %.1f Hz\n", blf);
}

void study_print_found(study *s) {
    char text[STUDY_TEXT] = "";
    int64_t mode = 0, n_sets = 0;
    double hz = 0, participation = 0;
    const study_options *o = s->options;
    printf("\nScene            %s (%s size), %" PRId64 " DOFs, %" PRId64 " contact pairs, H = %" PRId64 "\n",
           o->scene, o->size, s->scene->n_dof, s->scene->n_pairs, o->n_harmonics);
    plm_sampler_get_string(s->sampler, "dominant_system", sizeof text, text, NULL);
    plm_sampler_get_int(s->sampler, "dominant_mode", &mode);
    plm_sampler_get_double(s->sampler, "dominant_frequency_hz", &hz);
    plm_sampler_get_double(s->sampler, "dominant_participation", &participation);
    printf("Dominant mode    number %" PRId64
           " of the %s system, %.1f Hz, %.0f %% of the drive-point response\n",
           mode, text, hz, 100 * participation);
    print_rest(s);
    print_window(s->sampler);
    plm_sampler_get_int(s->sampler, "n_sweep_samples", &n_sets);
    printf("Contact sweep    %" PRId64 " different contact sets to take samples from\n", n_sets);
    plm_sampler_get_string(s->sampler, "space_description", sizeof text, text, NULL);
    printf("Contact space    %s\n", text);
    printf("contact space (shared): %.2f s, once for all samplers and the full order\n\n", s->contact_space);
}
