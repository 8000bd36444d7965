/* study_options.c: the command line of cracked_plate_study. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "study.h"

static const char help[] =
    "cracked_plate_study: error against run time of the reduction by piecewise-linear modes.\n"
    "\n"
    "  --size quick|paper   mesh of the scene (paper)\n"
    "  --samples 1,2,4      numbers of contact samples to compare (1,2,4,6,8)\n"
    "  --harmonics N        harmonics of the balance (5)\n"
    "  --output DIR         folder for the CSV files (demo_output)\n"
    "  --scene NAME         cracked_plate, coaxial_cylinders or bilinear_oscillator (cracked_plate)\n"
    "  --no-preload         without the static load\n"
    "  --help\n"
    "\n"
    "Plot the files with examples/plot/plot_study.py DIR; examples/demo.sh does it all.\n";

static int read_count(const char *text, char **end, int64_t *value) {
    *value = strtol(text, end, 10);
    return *end == text || *value < 1 || *value > 1000;
}

static int read_counts(const char *text, study_options *o) {
    o->n_counts = 0;
    for (;;) {
        char *end;
        if (o->n_counts == STUDY_COUNTS || read_count(text, &end, &o->count[o->n_counts])) return 1;
        o->n_counts++;
        if (*end == '\0') return 0;
        if (*end != ',') return 1;
        text = end + 1;
    }
}

static int bad_value(const char *name, const char *value, study_options *o) {
    char *end;
    if (!strcmp(name, "--size")) return o->size = value, strcmp(value, "quick") && strcmp(value, "paper");
    if (!strcmp(name, "--samples")) return read_counts(value, o);
    if (!strcmp(name, "--harmonics")) return read_count(value, &end, &o->n_harmonics) || *end;
    if (!strcmp(name, "--output")) return o->output = value, !*value;
    if (!strcmp(name, "--scene")) return o->scene = value, 0;
    return 1;
}

int study_options_read(int argc, char **argv, study_options *o) {
    *o = (study_options){"cracked_plate", "paper", "demo_output", 1, 5, 5, {1, 2, 4, 6, 8}};
    for (int i = 1; i < argc; i++) {
        if (!strcmp(argv[i], "--help")) {
            fputs(help, stdout);
            return 1;
        }
        if (!strcmp(argv[i], "--no-preload")) {
            o->with_preload = 0;
            continue;
        }
        const char *value = i + 1 < argc ? argv[i + 1] : NULL;
        if (!value || bad_value(argv[i], value, o)) {
            fprintf(stderr, "%s %s: not understood (see --help)\n", argv[i], value ? value : "");
            return 2;
        }
        i++;
    }
    return 0;
}
