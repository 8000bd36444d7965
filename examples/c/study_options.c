/* study_options.c: the command line of plm-study. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "study.h"

static const char help[] =
    "plm-study: error against run time of the ways to a response curve with contact.\n"
    "\n"
    "  --scene NAME         cracked_plate, coaxial_cylinders or bilinear_oscillator (cracked_plate)\n"
    "  --size quick|paper   mesh of the scene (quick)\n"
    "  --no-preload         without the static load\n"
    "  --contact-stiffness X   of every pair, as a multiple of the local stiffness (that of the scene)\n"
    "  --study PART         short: piecewise-linear modes beside Craig-Bampton and the full order;\n"
    "                       methods: all ways to the curve beside each other;\n"
    "                       levels: some of them for a sweep of force levels;\n"
    "                       convergence: numbers of samples, harmonics, time samples, tolerance of the "
    "basis;\n"
    "                       left-out: what the scene does not need, and what leaving it out saves;\n"
    "                       refine: bases for a tolerance from several starts; all; or several: "
    "refine,levels\n"
    "                       (methods)\n"
    "  --samples 1,2,4      numbers of contact samples to compare (1,2,4,8)\n"
    "  --harmonics N        harmonics of the balance (5)\n"
    "  --unknowns HOW       auto, modal or gaps, of the methods that are not compressed (auto)\n"
    "  --levels N           force levels of that sweep (10)\n"
    "  --tolerance X        what bases are refined to (1e-3)\n"
    "  --repeats N          timed runs of each method, after one to warm up; 0: that one (1)\n"
    "  --resolution X       further points are computed on curves until they are known to this (1e-5)\n"
    "  --output DIR         folder for the report, made when missing (study_output)\n"
    "  --help\n"
    "\n"
    "Then examples/plot/plot_study.py DIR draws the pictures of DIR/report.md; examples/demo.sh does it "
    "all.\n";

static const char *const parts[] = {"short", "methods", "levels", "convergence", "left-out", "refine", "all"};

static int among(const char *value, const char *const *words, size_t n) {
    for (size_t i = 0; i < n; i++)
        if (!strcmp(value, words[i])) return 1;
    return 0;
}

/* The word at the start of a list, and its length. */
static int is_part(const char *word, size_t n) {
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++)
        if (strlen(parts[i]) == n && !strncmp(parts[i], word, n)) return 1;
    return 0;
}

static int are_parts(const char *list) {
    for (;;) {
        const size_t n = strcspn(list, ",");
        if (!is_part(list, n)) return 0;
        if (!list[n]) return 1;
        list += n + 1;
    }
}

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

static int read_positive(const char *text, double *value) {
    char *end;
    *value = strtod(text, &end);
    return end == text || *end || !(*value > 0 && *value <= 1e12);
}

static int read_share(const char *text, double *value) {
    return read_positive(text, value) || *value >= 1;
}

/* NULL: good; else what is wanted. */
static const char *read_value(const char *name, const char *value, study_options *o) {
    static const char *const sizes[] = {"quick", "paper"}, *const unknowns[] = {"auto", "modal", "gaps"};
    char *end;
    if (!strcmp(name, "--scene")) {
        o->scene = value;
        for (int i = 0; i < scene_count(); i++)
            if (!strcmp(value, scene_name(i))) return NULL;
        return "cracked_plate, coaxial_cylinders or bilinear_oscillator";
    }
    if (!strcmp(name, "--size")) return o->size = value, among(value, sizes, 2) ? NULL : "quick or paper";
    if (!strcmp(name, "--study"))
        return o->study = value,
               are_parts(value) ? NULL : "short, methods, levels, convergence, left-out, refine or all";
    if (!strcmp(name, "--unknowns"))
        return o->unknowns = value, among(value, unknowns, 3) ? NULL : "auto, modal or gaps";
    if (!strcmp(name, "--samples"))
        return read_counts(value, o) ? "up to 16 numbers from 1 to 1000, separated by commas" : NULL;
    if (!strcmp(name, "--harmonics"))
        return read_count(value, &end, &o->n_harmonics) || *end ? "a number from 1 to 1000" : NULL;
    if (!strcmp(name, "--levels"))
        return read_count(value, &end, &o->n_levels) || *end ? "a number from 1 to 1000" : NULL;
    if (!strcmp(name, "--repeats"))
        return (read_count(value, &end, &o->repeats) && strcmp(value, "0")) || *end
                   ? "a number from 0 to 1000"
                   : NULL;
    if (!strcmp(name, "--tolerance"))
        return read_share(value, &o->tolerance) ? "a number between 0 and 1" : NULL;
    if (!strcmp(name, "--contact-stiffness"))
        return read_positive(value, &o->contact_stiffness) ? "a positive number" : NULL;
    if (!strcmp(name, "--resolution"))
        return read_share(value, &o->curve_tolerance) || o->curve_tolerance > 1e-2 ||
                       o->curve_tolerance < 1e-10
                   ? "a number from 1e-10 to 1e-2"
                   : NULL;
    if (!strcmp(name, "--output")) return o->output = value, *value ? NULL : "a folder";
    return "an option of plm-study";
}

static void remember(int argc, char **argv, study_options *o) {
    size_t used = (size_t)snprintf(o->command, sizeof o->command, "plm-study");
    for (int i = 1; i < argc && used < sizeof o->command; i++)
        used += (size_t)snprintf(o->command + used, sizeof o->command - used, " %s", argv[i]);
}

int study_options_read(int argc, char **argv, study_options *o) {
    memset(o, 0, sizeof *o);
    o->scene = "cracked_plate", o->size = "quick", o->study = "methods", o->output = "study_output",
    o->unknowns = "auto";
    o->with_preload = 1;
    o->n_harmonics = 5, o->repeats = 1, o->n_levels = 10;
    o->tolerance = 1e-3, o->curve_tolerance = 1e-5;
    read_counts("1,2,4,8", o);
    remember(argc, argv, o);
    for (int i = 1; i < argc; i++) {
        const char *value = i + 1 < argc ? argv[i + 1] : NULL;
        if (!strcmp(argv[i], "--help")) return fputs(help, stdout), 1;
        if (!strcmp(argv[i], "--no-preload")) {
            o->with_preload = 0;
            continue;
        }
        const char *wanted = value ? read_value(argv[i], value, o) : "a value, or an option of plm-study";
        if (wanted) {
            fprintf(stderr, "%s %s: not %s (see --help)\n", argv[i], value ? value : "", wanted);
            return 2;
        }
        i++;
    }
    return 0;
}

int study_wants(const study_options *o, const char *part) {
    for (const char *list = o->study;; list++) {
        const size_t n = strcspn(list, ",");
        if (!strncmp(list, "all", n) || (strlen(part) == n && !strncmp(list, part, n))) return 1;
        list += n;
        if (!*list) return 0;
    }
}
