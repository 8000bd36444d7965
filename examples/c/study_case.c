/* study_case.c: the scene, its model, and what the sampler finds. */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scene_model.h"
#include "study.h"

int study_complain(plm_context *ctx, const char *what) {
    char text[2 * STUDY_TEXT] = "";
    plm_context_get_error_text(ctx, sizeof text, text, NULL);
    fprintf(stderr, "%s: %s\n", what, text);
    return 1;
}

/* The model again with contacts as stiff as asked for. */
static int set_contact_stiffness(study_case *c) {
    double local = 0;
    if (c->options->contact_stiffness == 0) return 0;
    if (plm_model_get_double(c->model, "local_stiffness", &local)) return 1;
    for (int64_t i = 0; i < c->scene->n_pairs; i++)
        c->scene->contact_stiffness[i] = c->options->contact_stiffness * local;
    plm_model_destroy(&c->model);
    return scene_to_model(c->ctx, c->scene, &c->model) < 0;
}

int study_open(study_case *c, const study_options *o) {
    study_recipe r;
    memset(c, 0, sizeof *c);
    c->options = o;
    c->begin = c->last_note = study_seconds();
    const int made = scene_create(o->scene, o->size, o->with_preload, &c->scene);
    if (made != SCENE_OK) {
        fprintf(stderr, "%s, %s: %s\n", o->scene, o->size, scene_error_text(made));
        return 1;
    }
    study_say(c, "scene made: %" PRId64 " DOFs, %" PRId64 " contact pairs", c->scene->n_dof,
              c->scene->n_pairs);
    if (plm_context_create(PLM_API_VERSION, &c->ctx)) return 1;
    plm_context_set_progress(c->ctx, study_progress, c);
    plm_context_set_log(c->ctx, study_log, c);
    if (scene_to_model(c->ctx, c->scene, &c->model) < 0 || set_contact_stiffness(c))
        return study_complain(c->ctx, "model");
    study_say(c, "model built: matrices checked, stiffness factored");
    if (study_recipe_make(c, "", &r) || plm_sampler_run(r.sampler) < 0)
        return study_complain(c->ctx, "sampler");
    c->sampler = r.sampler;
    r.sampler = NULL;
    study_recipe_free(&r);
    study_say(c, "contact space made, contact area swept");
    return 0;
}

void study_close(study_case *c) {
    plm_context_destroy(&c->ctx); /* and all that is left in it */
    scene_destroy(&c->scene);
}

static void write_contact(study_case *c, FILE *to) {
    double local = 0, *k = malloc((size_t)c->scene->n_pairs * sizeof *k);
    int64_t n = 0;
    if (k && !plm_model_get_double(c->model, "local_stiffness", &local) &&
        !plm_model_get_array(c->model, "contact_stiffness", c->scene->n_pairs, k, &n) && n > 0)
        fprintf(to, "* Contact stiffness of a pair: %.4g, %.3g times the local stiffness.\n", k[0],
                k[0] / local);
    free(k);
}

static void write_rest(study_case *c, FILE *to) {
    int64_t n_closed = 0;
    if (!c->options->with_preload)
        fprintf(to, "* Without pre-load the contact carries no force at rest.\n");
    else if (plm_model_solve_rest(c->model) >= 0 && !plm_model_get_int(c->model, "rest_n_closed", &n_closed))
        fprintf(to, "* Closed at rest under the pre-load: %" PRId64 " of %" PRId64 " pairs.\n", n_closed,
                c->scene->n_pairs);
}

static void write_window(plm_sampler *sampler, FILE *to) {
    char why[STUDY_TEXT] = "";
    double low = 0, high = 0, blf = 0;
    plm_sampler_get_double(sampler, "window_low_hz", &low);
    plm_sampler_get_double(sampler, "window_high_hz", &high);
    plm_sampler_get_double(sampler, "blf_hz", &blf);
    plm_sampler_get_string(sampler, "window_why", sizeof why, why, NULL);
    fprintf(to, "* Window of %.6g to %.6g Hz: %s; bilinear frequency %.6g Hz.\n", low, high, why, blf);
}

void study_write_case(study_case *c, FILE *to) {
    char text[STUDY_TEXT] = "";
    int64_t mode = 0, n_sets = 0;
    double hz = 0, participation = 0;
    const study_options *o = c->options;
    fprintf(to, "* Scene %s (%s size), %" PRId64 " DOFs, %" PRId64 " contact pairs, H = %" PRId64 ".\n",
            o->scene, o->size, c->scene->n_dof, c->scene->n_pairs, o->n_harmonics);
    plm_sampler_get_string(c->sampler, "dominant_system", sizeof text, text, NULL);
    plm_sampler_get_int(c->sampler, "dominant_mode", &mode);
    plm_sampler_get_double(c->sampler, "dominant_frequency_hz", &hz);
    plm_sampler_get_double(c->sampler, "dominant_participation", &participation);
    fprintf(to,
            "* Dominant mode: number %" PRId64
            " of the %s system, %.6g Hz, %.0f %% of the drive-point response.\n",
            mode, text, hz, 100 * participation);
    write_contact(c, to);
    write_rest(c, to);
    write_window(c->sampler, to);
    plm_sampler_get_int(c->sampler, "n_sweep_samples", &n_sets);
    fprintf(to, "* The contact area passes through %" PRId64 " different contact sets.\n", n_sets);
    plm_sampler_get_string(c->sampler, "space_description", sizeof text, text, NULL);
    fprintf(to, "* Contact space: %s.\n", text);
}
