/* study_run.c: methods handed to plm_study, and what came out, row by row. */
#include <inttypes.h>
#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include "study.h"

static plm_status add_marching(study_case *c, plm_study *study, const study_method *m, study_recipe *r) {
    plm_transient *motion = NULL;
    plm_status status = plm_transient_create(c->model, r->basis, &motion);
    if (!status) status = plm_transient_set_double(motion, "settled", 1e-5);
    if (!status) status = plm_transient_set_int(motion, "periods", 2000);
    if (!status) status = plm_study_add_marching(study, m->name, motion, m->number, NULL);
    plm_transient_destroy(&motion);
    return status;
}

static plm_status add_method(study_case *c, plm_study *study, const study_method *m) {
    study_recipe r;
    plm_status status = study_recipe_make(c, m->settings, &r);
    if (!status && m->way == STUDY_RESPONSE && !strstr(m->settings, "hbm.unknowns"))
        status = plm_hbm_set_string(r.hbm, "unknowns", c->options->unknowns);
    if (!status && m->way == STUDY_RESPONSE) status = plm_study_add_response(study, m->name, r.hbm, NULL);
    if (!status && m->way == STUDY_COMPRESSED)
        status = plm_study_add_compressed(study, m->name, r.hbm, m->number, NULL);
    if (!status && m->way == STUDY_REFINED)
        status = plm_study_add_refined(study, m->name, r.hbm, c->options->tolerance, NULL);
    if (!status && m->way == STUDY_MARCHING) status = add_marching(c, study, m, &r);
    study_recipe_free(&r);
    return status;
}

static plm_status set_reference(study_case *c, plm_study *study) {
    study_recipe r;
    plm_status status = study_recipe_make(c, "basis.kind=full hbm.unknowns=gaps", &r);
    if (!status) status = plm_study_set_reference(study, r.hbm);
    study_recipe_free(&r);
    return status;
}

static plm_status set_levels(plm_study *study, int64_t n) {
    double level[1000];
    for (int64_t i = 0; i < n; i++) level[i] = (double)(i + 1) / (double)n;
    return plm_study_set_force_levels(study, n, level);
}

static plm_status make(study_case *c, int64_t n_levels, study_result *r) {
    plm_status status = plm_study_create(c->model, &r->study);
    if (!status) status = plm_study_set_output(r->study, c->scene->output_dof, PLM_HALF_PEAK_TO_PEAK, 0);
    if (!status) status = plm_study_set_int(r->study, "repeats", c->options->repeats);
    if (!status) status = plm_study_set_double(r->study, "curve_tolerance", c->options->curve_tolerance);
    if (!status) status = set_levels(r->study, n_levels);
    if (!status) status = set_reference(c, r->study);
    for (int32_t i = 0; i < r->n && !status; i++) status = add_method(c, r->study, &r->row[i].method);
    return status;
}

static plm_status read_reals(study_result *r, const char *key, size_t offset) {
    double value[STUDY_METHODS];
    int64_t n = 0;
    const plm_status status = plm_study_get_array(r->study, key, STUDY_METHODS, value, &n);
    for (int64_t i = 0; i < n && !status; i++) memcpy((char *)&r->row[i] + offset, &value[i], sizeof *value);
    return status;
}

static plm_status read_counts(study_result *r, const char *key, size_t offset) {
    int64_t value[STUDY_METHODS], n = 0;
    const plm_status status = plm_study_get_int_array(r->study, key, STUDY_METHODS, value, &n);
    for (int64_t i = 0; i < n && !status; i++) memcpy((char *)&r->row[i] + offset, &value[i], sizeof *value);
    return status;
}

#define AT(member) offsetof(study_row, member)

static plm_status read_results(study_result *r) {
    static const struct {
        const char *key;
        size_t offset;
    } reals[] = {{"setup_seconds", AT(setup)},
                 {"space_seconds", AT(space)},
                 {"iteration_seconds", AT(iteration)},
                 {"curve_seconds", AT(curve)},
                 {"peak_hz", AT(hz)},
                 {"peak_amplitude", AT(amplitude)},
                 {"frequency_error", AT(error_hz)},
                 {"amplitude_error", AT(error_amplitude)},
                 {"curve_error_l2", AT(error_l2)},
                 {"curve_error_max", AT(error_max)},
                 {"estimated_error", AT(estimated)},
                 {"effectivity", AT(effectivity)}};
    int64_t bytes[STUDY_METHODS] = {0}, n = 0;
    plm_status status = PLM_OK;
    for (size_t k = 0; k < sizeof reals / sizeof *reals && !status; k++)
        status = read_reals(r, reals[k].key, reals[k].offset);
    if (!status) status = read_counts(r, "basis_size", AT(size));
    if (!status) status = read_counts(r, "n_points", AT(n_points));
    if (!status) status = read_counts(r, "pareto", AT(pareto));
    if (!status) status = plm_study_get_int_array(r->study, "peak_bytes", STUDY_METHODS, bytes, &n);
    for (int32_t i = 0; i < r->n && !status; i++) {
        study_row *row = &r->row[i];
        row->megabytes = bytes[i] < 0 ? NAN : (double)bytes[i] / 1e6;
        status = plm_study_get_outcome(r->study, i, sizeof row->outcome, row->outcome, NULL);
    }
    return status;
}

/* methods.csv: which tables each method is in, for the pictures. */
static int write_groups(study_case *c, const char *folder, const study_result *r) {
    static const struct {
        int group;
        const char *name;
    } groups[] = {{STUDY_RIVALS, "methods"},    {STUDY_SAMPLES, "samples"}, {STUDY_SVD, "svd"},
                  {STUDY_LEFT_OUT, "left-out"}, {STUDY_REFINE, "refine"},   {STUDY_LEVELS, "levels"}};
    char path[2 * STUDY_NAME];
    snprintf(path, sizeof path, "%s/methods.csv", folder);
    FILE *file = study_open_file(c->options, path);
    if (!file) return 1;
    fprintf(file, "name,way,groups\n");
    for (int32_t i = 0; i < r->n; i++) {
        fprintf(file, "\"%s\",%d,", r->row[i].method.name, (int)r->row[i].method.way);
        for (size_t k = 0; k < sizeof groups / sizeof *groups; k++)
            if (r->row[i].method.groups & groups[k].group) fprintf(file, "%s ", groups[k].name);
        fputc('\n', file);
    }
    return study_close_file(file);
}

int study_run(study_case *c, int groups, int64_t n_levels, const char *name, study_result *r) {
    static study_method method[STUDY_METHODS];
    char folder[STUDY_PATH];
    memset(r, 0, sizeof *r);
    r->n_levels = n_levels;
    r->n = study_methods(c, groups, method);
    for (int32_t i = 0; i < r->n; i++) r->row[i].method = method[i];
    study_say(c, "%d methods, %" PRId64 " force level%s", (int)r->n, n_levels, n_levels == 1 ? "" : "s");
    snprintf(folder, sizeof folder, "%s/%s", c->options->output, name);
    if (make(c, n_levels, r) < 0 || plm_study_run(r->study) < 0 || plm_study_write(r->study, folder) < 0 ||
        read_results(r) < 0)
        return study_complain(c->ctx, "study");
    return write_groups(c, name, r);
}

const study_row *study_find(const study_result *r, const char *name) {
    for (int32_t i = 0; i < r->n; i++)
        if (!strcmp(r->row[i].method.name, name)) return r->row[i].size < 0 ? NULL : &r->row[i];
    return NULL;
}
