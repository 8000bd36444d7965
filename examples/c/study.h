/* study.h: what the parts of cracked_plate_study share: one scene, the methods compared on it, their results.
 */
#ifndef STUDY_H
#define STUDY_H

#include <plm/plm.h>

#include "scene.h"

enum { STUDY_COUNTS = 16, STUDY_METHODS = STUDY_COUNTS + 3, STUDY_NAME = 32, STUDY_TEXT = 512 };

/* ---- the command line: study_options.c ---- */

typedef struct study_options {
    const char *scene, *size, *output;
    int with_preload;
    int64_t n_harmonics;
    int32_t n_counts;
    int64_t count[STUDY_COUNTS]; /* numbers of contact samples to compare */
} study_options;

/* 0: go on; 1: help was printed; 2: not understood (said on stderr). */
int study_options_read(int argc, char **argv, study_options *options);

/* ---- the case: study_case.c ---- */

typedef struct study {
    const study_options *options;
    scene *scene;
    plm_context *ctx;
    plm_model *model;
    plm_sampler *sampler; /* of the first run; gives the window to the methods that need no samples */
    double begin;         /* study_seconds() of the start */
    double last_note;     /* of the last sign of life */
    double contact_space; /* seconds of the first sampler run; every later one shares its space */
} study;

/* Makes the scene, hands it over, finds the dominant mode and the window. 0, or 1 with the reason on stderr.
 */
int study_open(study *s, const study_options *options);
void study_close(study *s);
/* Prints what was found. */
void study_print_found(study *s);
/* A sampler that takes n_samples from the sweep of the scene's dominant mode. Returns the first bad status.
 */
plm_status study_sample(study *s, int64_t n_samples, plm_sampler **sampler);

/* ---- one method: study_method.c ---- */

typedef struct study_method {
    char name[STUDY_NAME];  /* in file names */
    char label[STUDY_NAME]; /* in tables */
    const char *kind, *selection;
    int64_t n_samples; /* 0: the method needs none */
} study_method;

typedef struct study_result {
    study_method method;
    char error[STUDY_TEXT];   /* not empty: the method failed, and why */
    char warning[STUDY_TEXT]; /* of the basis */
    char end[STUDY_TEXT];     /* why the curve ended */
    char unknowns[STUDY_NAME];
    int64_t contact_sets, n_collected, basis_size, n_points, newton_iterations, end_reason;
    double setup_seconds, iteration_seconds, curve_seconds;
    double peak_hz, peak_amplitude, full_residual;
    double error_hz, error_amplitude; /* relative, against the full order; NaN: unknown */
} study_result;

/* All methods of the options: samples in ascending order of the list, the bands rule, Craig-Bampton, full
 * order last. */
int32_t study_methods(const study_options *options, study_method method[STUDY_METHODS]);
/* Basis, curve and peak; writes the method's CSV files. A failure is text in the result. */
void study_run_method(study *s, const study_method *method, study_result *result);
/* Fills the errors of all results against the last one. */
void study_compare(study_result *result, int32_t n);

/* ---- output: study_files.c, study_table.c. The writers return 1 when a file cannot be written. ---- */

int study_make_folder(const char *path);
int study_write_curve(study *s, const study_method *method, plm_branch *curve);
int study_write_cycle(study *s, const study_method *method, plm_branch *peak);
int study_write_table(const study_options *options, const study_result *result, int32_t n);
int study_write_facts(study *s);
void study_print_table(const study_result *result, int32_t n);

/* ---- time and progress: study_progress.c ---- */

double study_seconds(void);
/* "[ 12.3 s] text" */
void study_say(study *s, const char *format, ...);
/* A progress callback: a line every few seconds; user is the study. */
int32_t study_progress(plm_context *ctx, const char *stage, double fraction, void *user);

#endif
