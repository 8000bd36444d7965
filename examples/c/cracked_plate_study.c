/*
 * cracked_plate_study.c: how good is a basis of piecewise-linear modes, and what does it cost?
 *
 *     cracked_plate_study [--help]
 *
 * Takes the cracked plate of the paper (section 3.2) or another scene, computes its response near one
 * resonance on bases from 1 to 8 contact samples, by Craig-Bampton and without reduction, and compares
 * resonance frequency and peak amplitude with the unreduced ones at the same number of harmonics.
 */
#include <stdio.h>
#include <string.h>

#include "study.h"

static int compare_methods(study *s) {
    study_method method[STUDY_METHODS];
    static study_result result[STUDY_METHODS];
    const int32_t n = study_methods(s->options, method);
    int failed = study_write_facts(s);
    for (int32_t i = 0; i < n; i++) {
        study_run_method(s, &method[i], &result[i]);
        if (result[i].error[0] && strcmp(method[i].selection, "bands"))
            failed = 1; /* the bands may be empty */
    }
    study_compare(result, n);
    study_print_table(result, n);
    return failed | study_write_table(s->options, result, n);
}

int main(int argc, char **argv) {
    study_options options;
    study s;
    const int read = study_options_read(argc, argv, &options);
    if (read) return read == 1 ? 0 : 2;
    if (study_make_folder(options.output)) return 1;
    int failed = study_open(&s, &options);
    if (!failed) {
        study_print_found(&s);
        failed = compare_methods(&s);
        printf("\n");
        study_say(&s, "%s; files in %s", failed ? "something FAILED" : "done", options.output);
    }
    study_close(&s);
    return failed;
}
