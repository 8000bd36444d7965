/*
 * plm_study.c: error against run time of the ways to a response curve.
 *
 *     plm-study --scene cracked_plate --size quick --study all --output DIR
 *
 * Takes a scene of the paper, computes its response near one resonance by piecewise-linear modes and by every
 * other way the library knows, and compares each with the unreduced structure: errors, times, memory. Writes
 * report.md, CSV files, and what examples/plot/plot_study.py needs for the pictures.
 */
#include <stdio.h>

#include "study.h"

static int groups_of(const study_options *o) {
    int groups = 0;
    if (study_wants(o, "short")) groups |= STUDY_SHORT;
    if (study_wants(o, "methods")) groups |= STUDY_RIVALS;
    if (study_wants(o, "convergence")) groups |= STUDY_SAMPLES | STUDY_SVD;
    if (study_wants(o, "left-out")) groups |= STUDY_LEFT_OUT;
    if (study_wants(o, "refine")) groups |= STUDY_REFINE;
    return groups;
}

static int write_contacts(study_case *c, const study_result *one) {
    static const struct {
        const char *name, *file;
    } shown[] = {{"1 sample", "1_sample"}, {"4 samples", "4_samples"}, {"compressed to 12", "compressed_12"}};
    plm_branch *curve = NULL;
    int failed = plm_study_get_curve(one->study, -1, 0, &curve) || study_write_contact(c, curve, "reference");
    plm_branch_destroy(&curve);
    for (size_t k = 0; k < sizeof shown / sizeof *shown; k++)
        for (int32_t i = 0; i < one->n; i++) {
            if (one->row + i != study_find(one, shown[k].name)) continue;
            if (plm_study_get_curve(one->study, i, 0, &curve)) continue;
            failed |= study_write_contact(c, curve, shown[k].file);
            plm_branch_destroy(&curve);
        }
    return failed;
}

static int run(study_case *c) {
    static study_result one, levels;
    static study_steps steps;
    static study_exact exact;
    study_findings found = {NULL, NULL, NULL, NULL};
    const study_options *o = c->options;
    if (study_write_facts(c)) return 1;
    if (groups_of(o)) {
        if (study_run(c, groups_of(o), 1, "one_level", &one) || write_contacts(c, &one)) return 1;
        found.one = &one;
    }
    if (found.one && (study_wants(o, "short") || study_wants(o, "methods")) && !study_stopped()) {
        if (study_run_exact(c, &exact)) return 1;
        found.exact = &exact;
    }
    if (study_wants(o, "levels") && !study_stopped()) {
        if (study_run(c, STUDY_LEVELS, o->n_levels, "levels", &levels)) return 1;
        found.levels = &levels;
    }
    if ((study_wants(o, "convergence") || study_wants(o, "left-out")) && !study_stopped()) {
        if (study_run_steps(c, &steps)) return 1;
        if (study_wants(o, "convergence") && study_write_steps(c, &steps)) return 1;
        found.steps = &steps;
    }
    if (found.one) study_print_rows(&one, groups_of(o));
    if (found.levels) study_print_rows(&levels, STUDY_LEVELS);
    return study_write_report(c, &found);
}

int main(int argc, char **argv) {
    study_options options;
    study_case c;
    const int read = study_options_read(argc, argv, &options);
    if (read) return read == 1 ? 0 : 2;
    if (study_make_folder(options.output)) return 1;
    study_watch_signals();
    int failed = study_open(&c, &options);
    if (!failed) {
        failed = run(&c);
        study_say(&c, "%s; files in %s", failed ? "something FAILED" : "done", options.output);
    }
    study_close(&c);
    return failed;
}
