/* study_methods.c: the ways to a response curve that are compared, and the tables each is in. */
#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "study.h"

typedef struct list {
    study_case *c;
    study_method *method;
    int32_t n;
    int groups; /* those asked for */
} list;

/* name and settings: formats with the same number, if any. */
static void add(list *l, int groups, study_way way, int64_t number, const char *name, const char *settings) {
    if (!(groups & l->groups) || l->n == STUDY_METHODS) return;
    study_method *m = &l->method[l->n++];
    m->groups = groups;
    m->way = way;
    m->number = number;
    snprintf(m->name, sizeof m->name, "%s", name);
    snprintf(m->settings, sizeof m->settings, "%s", settings);
}

static void add_samples(list *l, int64_t n, int groups) {
    char name[STUDY_NAME], settings[STUDY_SETTINGS];
    snprintf(name, sizeof name, "%" PRId64 " sample%s", n, n == 1 ? "" : "s");
    snprintf(settings, sizeof settings, "sampler.n_samples=%" PRId64, n);
    add(l, groups, STUDY_RESPONSE, 0, name, settings);
}

static void add_bands(list *l, int64_t n) {
    char name[STUDY_NAME], settings[STUDY_SETTINGS];
    snprintf(name, sizeof name, "%" PRId64 " sample%s, bands", n, n == 1 ? "" : "s");
    snprintf(settings, sizeof settings, "sampler.n_samples=%" PRId64 " basis.selection=bands", n);
    add(l, STUDY_RIVALS | STUDY_SAMPLES | (n == 4 ? STUDY_SHORT : 0), STUDY_RESPONSE, 0, name, settings);
}

static void add_all_samples(list *l) {
    const study_options *o = l->c->options;
    const int base = STUDY_SVD | STUDY_LEVELS | STUDY_REFINE;
    int has_base = 0;
    for (int32_t i = 0; i < o->n_counts; i++) {
        const int is_base = o->count[i] == 4;
        has_base |= is_base;
        add_samples(l, o->count[i], STUDY_RIVALS | STUDY_SAMPLES | STUDY_SHORT | (is_base ? base : 0));
    }
    if (!has_base) add_samples(l, 4, base);
    for (int32_t i = 0; i < o->n_counts; i++) add_bands(l, o->count[i]);
}

static void add_rivals(list *l) {
    const int both = STUDY_RIVALS | STUDY_LEVELS;
    char settings[STUDY_SETTINGS];
    add(l, both | STUDY_LEFT_OUT | STUDY_SHORT, STUDY_RESPONSE, 0, "full order",
        "basis.kind=full hbm.unknowns=gaps");
    add(l, STUDY_RIVALS, STUDY_RESPONSE, 0, "bilinear modes", "basis.kind=bilinear");
    add(l, STUDY_RIVALS, STUDY_RESPONSE, 0, "LELSM", "basis.kind=lelsm");
    add(l, both, STUDY_RESPONSE, 0, "updated LELSM", "basis.kind=lelsm_updated");
    add(l, STUDY_RIVALS, STUDY_RESPONSE, 0, "discontinuity", "basis.kind=discontinuity");
    add(l, both, STUDY_RESPONSE, 0, "snapshots", "basis.kind=snapshots");
    if (l->c->scene->n_pairs >= 4) {
        const int64_t half = l->c->scene->n_pairs / 2;
        snprintf(settings, sizeof settings,
                 "basis.kind=full hbm.unknowns=gaps basis.n_pairs_carried=%" PRId64, half);
        add(l, STUDY_RIVALS, STUDY_RESPONSE, 0, "half of the pairs", settings);
        snprintf(settings, sizeof settings,
                 "basis.kind=full hbm.unknowns=gaps basis.pair_rule=mdof basis.n_pairs_carried=%" PRId64,
                 half);
        add(l, STUDY_RIVALS, STUDY_RESPONSE, 0, "half of the pairs, MDOF", settings);
    }
    add(l, STUDY_RIVALS, STUDY_RESPONSE, 0, "sampled forces, 256", "hbm.aft=sampled hbm.time_samples=256");
    add(l, both, STUDY_COMPRESSED, 10, "POD of full order to 10", "basis.kind=full");
    if (!strcmp(l->c->options->size, "quick")) {
        add(l, STUDY_RIVALS, STUDY_MARCHING, 12, "marching, 1 sample",
            "sampler.n_samples=1 basis.selection=bands");
    }
    add(l, both | STUDY_SAMPLES | STUDY_LEFT_OUT | STUDY_SHORT, STUDY_RESPONSE, 0, "Craig-Bampton",
        "basis.kind=craig_bampton");
}

static void add_compressed(list *l) {
    static const int64_t sizes[] = {8, 10, 12, 18, 24};
    const int64_t n_free = l->c->scene->n_dof - l->c->scene->n_fixed;
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        char name[STUDY_NAME];
        snprintf(name, sizeof name, "compressed to %" PRId64, sizes[i]);
        const int groups = STUDY_RIVALS | (sizes[i] == 12 ? STUDY_SHORT | STUDY_LEVELS : 0) |
                           (sizes[i] == 24 ? STUDY_LEVELS : 0);
        if (sizes[i] < n_free) add(l, groups, STUDY_COMPRESSED, sizes[i], name, "");
    }
    add(l, STUDY_RIVALS, STUDY_COMPRESSED, 0, "compressed by tolerance", "");
    add(l, STUDY_RIVALS | STUDY_LEVELS | STUDY_REFINE, STUDY_REFINED, 0, "refined", "");
}

/* The last three start from a dominant mode that is not a good guess. Some need a larger contact space than
 * the other methods, so that they come last. */
static void add_refined(list *l) {
    char next[STUDY_SETTINGS], range[STUDY_SETTINGS / 2];
    double low = 0, high = 0;
    plm_sampler_get_double(l->c->sampler, "window_low_hz", &low);
    plm_sampler_get_double(l->c->sampler, "window_high_hz", &high);
    snprintf(range, sizeof range, "basis.frequency_min_hz=%.17g basis.frequency_max_hz=%.17g", low, high);
    const int modes = l->c->scene->n_dof - l->c->scene->n_fixed > 20;
    add(l, STUDY_REFINE, STUDY_REFINED, 0, "refined from 1 sample", "sampler.n_samples=1");
    if (!modes) return;
    snprintf(next, sizeof next, "sampler.n_samples=1 basis.selection=bands %s", range);
    add(l, STUDY_REFINE, STUDY_REFINED, 0, "refined from 1 sample, bands", next);
    snprintf(next, sizeof next, "sampler.mode=%d sampler.n_samples=1 basis.selection=bands %s",
             (int)l->c->scene->dominant_mode + 1, range);
    add(l, STUDY_REFINE, STUDY_REFINED, 0, "refined from the next mode, bands", next);
    snprintf(next, sizeof next, "sampler.mode=%d", (int)l->c->scene->dominant_mode + 1);
    add(l, STUDY_REFINE, STUDY_REFINED, 0, "refined from the next mode", next);
    snprintf(next, sizeof next, "sampler.mode=1 sampler.system=open");
    add(l, STUDY_REFINE, STUDY_REFINED, 0, "refined from mode 1 and its BLF", next);
}

static void add_svd(list *l) {
    static const char *const tolerances[] = {"1e-1", "1e-2", "1e-3", "1e-4", "1e-8"};
    for (size_t i = 0; i < sizeof tolerances / sizeof *tolerances; i++) {
        char name[STUDY_NAME], settings[STUDY_SETTINGS];
        snprintf(name, sizeof name, "svd_tolerance %s", tolerances[i]);
        snprintf(settings, sizeof settings, "basis.svd_tolerance=%s", tolerances[i]);
        add(l, STUDY_SVD, STUDY_RESPONSE, 0, name, settings);
    }
}

static void add_left_out(list *l) {
    const int g = STUDY_LEFT_OUT;
    add(l, g, STUDY_RESPONSE, 0, STUDY_AS_IS, ""); /* timed beside the others, not minutes before */
    if (l->c->options->with_preload) {
        add(l, g, STUDY_RESPONSE, 0, "no static augmentation", "basis.static_augmentation=0");
        add(l, g, STUDY_RESPONSE, 0, "no rest sample", "sampler.include_rest=0");
    }
    add(l, g, STUDY_RESPONSE, 0, "no complements", "sampler.complements=0");
    add(l, g, STUDY_RESPONSE, 0, "no ends of the sweep", "sampler.include_ends=0");
    add(l, g, STUDY_RESPONSE, 0, "no load vectors", "basis.load_vectors=0");
    add(l, g, STUDY_RESPONSE, 0, "twice the samples", "sampler.n_samples=8");
    add(l, g, STUDY_RESPONSE, 0, "all pairs, modal", "hbm.unknowns=modal");
    add(l, g, STUDY_RESPONSE, 0, "moving pairs only", "hbm.unknowns=gaps");
}

int32_t study_methods(study_case *c, int groups, study_method method[STUDY_METHODS]) {
    list l = {c, method, 0, groups};
    add_all_samples(&l);
    add_compressed(&l);
    add_rivals(&l);
    add_svd(&l);
    add_left_out(&l);
    add_refined(&l);
    return l.n;
}
