/* study_recipe.c: sampler, basis and solver from options in words. The type of a key comes from the library's
 * own table. */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "study.h"

static int32_t type_of(int32_t kind, const char *key) {
    int32_t n = 0, type = 0, is_option = 0;
    double low, high;
    plm_key_count(kind, &n);
    for (int32_t i = 0; i < n; i++) {
        char name[STUDY_NAME] = "";
        plm_key_text(kind, i, PLM_KEY_NAME, sizeof name, name, NULL);
        if (strcmp(name, key)) continue;
        plm_key_info(kind, i, &type, &is_option, &low, &high);
        if (is_option) return type;
    }
    return PLM_TYPE_STRING; /* the setter will say that there is no such key */
}

#define SET(noun)                                                                                            \
    static plm_status set_##noun(plm_##noun *handle, int32_t type, const char *key, const char *value) {     \
        if (type == PLM_TYPE_INT) return plm_##noun##_set_int(handle, key, strtol(value, NULL, 10));         \
        if (type == PLM_TYPE_DOUBLE) return plm_##noun##_set_double(handle, key, strtod(value, NULL));       \
        return plm_##noun##_set_string(handle, key, value);                                                  \
    }
SET(sampler)
SET(basis)
SET(hbm)

/* One "handle.key=value". */
static plm_status set(study_recipe *r, char *setting) {
    char *key = strchr(setting, '.'), *value = strchr(setting, '=');
    if (!key || !value || value < key) return PLM_ERR_ARGUMENT;
    *key++ = *value++ = '\0';
    if (!strcmp(setting, "sampler"))
        return set_sampler(r->sampler, type_of(PLM_KIND_SAMPLER, key), key, value);
    if (!strcmp(setting, "basis")) return set_basis(r->basis, type_of(PLM_KIND_BASIS, key), key, value);
    if (!strcmp(setting, "hbm")) return set_hbm(r->hbm, type_of(PLM_KIND_HBM, key), key, value);
    return PLM_ERR_ARGUMENT;
}

static plm_status set_all(study_recipe *r, const char *settings) {
    char text[2 * STUDY_SETTINGS + STUDY_TEXT];
    snprintf(text, sizeof text, "%s", settings);
    for (char *next = text, *end; *next; next = end) {
        end = next + strcspn(next, " ");
        if (*end) *end++ = '\0';
        const plm_status status = *next ? set(r, next) : PLM_OK;
        if (status < 0) return status;
    }
    return PLM_OK;
}

/* The engineer knows which resonance is studied; without system and mode the library would propose the mode
 * that takes the largest part in the response of the driven DOF. Curves alone are compared, hence no
 * multipliers and no search for folds, which bases of some sizes would get and others not. */
static plm_status set_common(study_case *c, study_recipe *r) {
    char text[STUDY_TEXT];
    const int64_t h = c->options->n_harmonics;
    snprintf(text, sizeof text,
             "sampler.system=%s sampler.mode=%d sampler.n_harmonics=%" PRId64 " basis.n_harmonics=%" PRId64
             " hbm.n_harmonics=%" PRId64 " hbm.stability=off hbm.bifurcations=off",
             c->scene->dominant_system == SCENE_OPEN ? "open" : "sliding", (int)c->scene->dominant_mode, h, h,
             h);
    return set_all(r, text);
}

plm_status study_recipe_make(study_case *c, const char *settings, study_recipe *r) {
    *r = (study_recipe){NULL, NULL, NULL};
    plm_status status = plm_sampler_create(c->model, &r->sampler);
    if (!status) status = plm_basis_create(c->model, &r->basis);
    if (!status) status = plm_basis_set_sampler(r->basis, r->sampler);
    if (!status) status = plm_hbm_create(r->basis, &r->hbm);
    if (!status) status = set_common(c, r);
    return status ? status : set_all(r, settings);
}

void study_recipe_free(study_recipe *r) {
    plm_hbm_destroy(&r->hbm);
    plm_basis_destroy(&r->basis);
    plm_sampler_destroy(&r->sampler);
}
