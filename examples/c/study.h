/* study.h: what the parts of plm-study share: the command line, one scene, the methods compared on it, their
 * results. */
#ifndef STUDY_H
#define STUDY_H

#include <plm/plm.h>
#include <stdio.h>

#include "scene.h"

enum {
    STUDY_COUNTS = 16,
    STUDY_METHODS = 80,
    STUDY_NAME = 64,
    STUDY_SETTINGS = 200,
    STUDY_TEXT = 512,
    STUDY_PATH = 4096
};

/* ---- the command line: study_options.c ---- */

typedef struct study_options {
    const char *scene, *size, *study, *unknowns, *output;
    int with_preload;
    int64_t n_harmonics, repeats, n_levels;
    double tolerance, curve_tolerance;
    double contact_stiffness; /* in local stiffnesses; 0: that of the scene */
    int32_t n_counts;
    int64_t count[STUDY_COUNTS]; /* numbers of contact samples to compare */
    char command[STUDY_TEXT];    /* as it was given */
} study_options;

/* 0: go on; 1: help was printed; 2: not understood (said on stderr). */
int study_options_read(int argc, char **argv, study_options *options);
/* 1 when --study asks for the part of this name, among others. */
int study_wants(const study_options *options, const char *part);

/* ---- the case: study_case.c ---- */

typedef struct study_case {
    const study_options *options;
    scene *scene;
    plm_context *ctx;
    plm_model *model;
    plm_sampler *sampler; /* four samples of the scene's dominant mode; it has run */
    double begin;         /* study_seconds() of the start */
    double last_note;     /* of the last sign of life */
} study_case;

/* Makes the scene, hands it over, finds the dominant mode and the window. 0, or 1 with the reason on stderr.
 */
int study_open(study_case *c, const study_options *options);
void study_close(study_case *c);
/* What was found, as a list in Markdown. */
void study_write_case(study_case *c, FILE *to);
/* "what: error text of the context" on stderr; returns 1. */
int study_complain(plm_context *ctx, const char *what);

/* ---- one way to a response curve: study_recipe.c ---- */

typedef struct study_recipe {
    plm_sampler *sampler;
    plm_basis *basis;
    plm_hbm *hbm;
} study_recipe;

/* New handles with the options all methods of the case share, then those of `settings`: "handle.key=value"
 * separated by blanks, handles sampler, basis, hbm. Free them whatever the status. */
plm_status study_recipe_make(study_case *c, const char *settings, study_recipe *r);
void study_recipe_free(study_recipe *r);

/* ---- the methods: study_methods.c ---- */

typedef enum study_way { STUDY_RESPONSE, STUDY_COMPRESSED, STUDY_REFINED, STUDY_MARCHING } study_way;

/* Which tables a method is in. */
enum {
    STUDY_RIVALS = 1,
    STUDY_SAMPLES = 2,
    STUDY_SVD = 4,
    STUDY_LEFT_OUT = 8,
    STUDY_REFINE = 16,
    STUDY_LEVELS = 32,
    STUDY_SHORT = 64
};

typedef struct study_method {
    char name[STUDY_NAME], settings[STUDY_SETTINGS];
    study_way way;
    int64_t number; /* compressed: columns, 0: by tolerance; marching: frequencies */
    int groups;
} study_method;

/* The method that parts are left out of: 4 samples. */
#define STUDY_AS_IS "as it is"
/* All methods of the groups; returns their number. */
int32_t study_methods(study_case *c, int groups, study_method method[STUDY_METHODS]);

/* ---- running them: study_run.c ---- */

typedef struct study_row {
    study_method method;
    int64_t size, n_points, pareto;
    double setup, space, iteration, curve, megabytes; /* seconds */
    double hz, amplitude, error_hz, error_amplitude, error_l2, error_max, estimated, effectivity;
    char outcome[STUDY_TEXT];
} study_row;

typedef struct study_result {
    plm_study *study;
    int32_t n;
    int64_t n_levels;
    study_row row[STUDY_METHODS];
} study_result;

/* Runs the methods of the groups at n_levels force levels, evenly up to that of the scene, and writes the
 * library's own files to the folder `name` of the output. 0, or 1 with the reason on stderr. */
int study_run(study_case *c, int groups, int64_t n_levels, const char *name, study_result *result);
/* NULL: none of this name, or it failed. */
const study_row *study_find(const study_result *result, const char *name);

/* ---- on one compressed basis: study_harmonics.c ---- */

enum { STUDY_STEPS = 16, STUDY_MANY_HARMONICS = 20 };

/* A curve with one number varied. */
typedef struct study_step {
    int64_t number, harmonics, n_points; /* harmonics: the most of any point */
    double seconds, hz, amplitude;
} study_step;

typedef struct study_steps {
    int64_t basis_size;
    int32_t n_harmonics, n_samples;
    study_step plain;                                   /* the harmonics asked for, without all else */
    study_step bifurcations, stability, many_harmonics; /* with one of them */
    study_step harmonics[STUDY_STEPS]; /* number: harmonics, 0: automatic; the last is the truth */
    study_step
        samples[STUDY_STEPS]; /* number: time samples, 0: exact switching instants, the last and the truth */
} study_steps;

int study_run_steps(study_case *c, study_steps *steps);

/* ---- files: study_contact.c, study_files.c ---- */

int study_make_folder(const char *path);
/* A new file of the output; NULL with the reason on stderr. */
FILE *study_open_file(const study_options *options, const char *name);
int study_close_file(FILE *file);
/* study.csv: the facts that the pictures name; harmonics.csv, time_samples.csv. 1 when a file cannot be
 * written. */
int study_write_facts(study_case *c);
int study_write_steps(study_case *c, const study_steps *steps);
/* Pairs closed over the cycle at the peak, and along the curve: contact_cycle_<file>.csv,
 * contact_curve_<file>.csv. */
int study_write_contact(study_case *c, plm_branch *curve, const char *file);

/* ---- the report: study_report.c, study_tables.c ---- */

/* ---- the same response with nothing set: study_exact.c ---- */

/* Of plm_model_compute_response(): a curve of exact motions where that is affordable, else of harmonics with
 * a peak that is closed in upon. */
typedef struct study_exact {
    double hz, amplitude, error, seconds;
    int64_t columns;
    int is_exact;
} study_exact;

/* Computes it and writes its peak to nothing_set.csv, a curve of exact motions to curve_exact.csv. 0, or 1
 * with the reason on stderr. */
int study_run_exact(study_case *c, study_exact *exact);
/* What it says of the H that all others have. */
void study_write_exact(const study_case *c, const study_result *one, const study_exact *exact, FILE *to);

typedef struct study_findings {
    const study_result *one, *levels; /* NULL: not asked for */
    const study_steps *steps;
    const study_exact *exact;
} study_findings;

int study_write_report(study_case *c, const study_findings *found);
void study_write_rows(FILE *to, const study_result *result, int group);
/* How methods ended that did not reach the end of the range, or what has to be known of them. */
void study_write_notes(FILE *to, const study_result *result);
void study_write_left_out(FILE *to, const study_findings *found, int64_t n_harmonics);
void study_write_refined(FILE *to, const study_result *result);
void study_print_rows(const study_result *result, int group);

/* ---- time and progress: study_progress.c ---- */

double study_seconds(void);
/* From here on an interrupt cancels the running call, and study_stopped() is 1. */
void study_watch_signals(void);
int study_stopped(void);
/* "[ 12.3 s] text" */
void study_say(study_case *c, const char *format, ...);
/* Callbacks of the context, user is the case: a line every few seconds; the study's own notes. */
int32_t study_progress(plm_context *ctx, const char *stage, double fraction, void *user);
void study_log(plm_context *ctx, int32_t level, const char *text, void *user);

#endif
