/* study_report.c: report.md, with the pictures that plot_study.py will draw. */
#include <inttypes.h>
#include <math.h>
#include <time.h>

#include "study.h"

static double real(plm_study *study, const char *key) {
    double value = NAN;
    plm_study_get_double(study, key, &value);
    return value;
}

static void write_reference(const study_result *one, FILE *to) {
    int64_t size = 0;
    plm_study_get_int(one->study, "reference_size", &size);
    fprintf(to,
            "\n## The reference\n\nThe unreduced structure, condensed to its contact gaps, at the same H: "
            "%" PRId64 " coordinates, set-up %.3g s, curve %.3g s.\n\n",
            size, real(one->study, "reference_setup_seconds"), real(one->study, "reference_curve_seconds"));
    fprintf(to, "* Peak %.9g at %.9g Hz, between %.6g and %.6g Hz.\n",
            real(one->study, "reference_peak_amplitude"), real(one->study, "reference_peak_hz"),
            real(one->study, "frequency_low_hz"), real(one->study, "frequency_high_hz"));
    fprintf(
        to,
        "* Harmonics: twice as many change the peak%s by %.1e and its frequency by %.1e. All methods have "
        "the same H, so this is in none of their errors.\n",
        one->n_levels > 1 ? ", at the lowest or the highest level," : "",
        real(one->study, "reference_harmonic_error"), real(one->study, "reference_harmonic_shift"));
    fprintf(
        to,
        "* Space: its contact receptances are right to %.1e; the peak leaves a residual of %.1e in the full "
        "equations.\n",
        real(one->study, "reference_space_error"), real(one->study, "reference_full_residual"));
    fprintf(to, "* All curves are known to %.1e, which bounds what their distances mean.\n",
            real(one->study, "curve_resolution_error"));
    fprintf(to, "* Contact space: %.3g s, made once; part of the set-up of every method but Craig-Bampton.\n",
            real(one->study, "reference_space_seconds"));
}

static void write_legend(FILE *to) {
    fprintf(to, "\n"
                "## How to read the tables\n\n"
                "Errors are relative to the reference. Those of curves are distances in the plane of "
                "frequency over the width of the window and amplitude over the reference's peak, over the "
                "arc length of the reference's curve, so that folds do not spoil them. Set-up is everything "
                "before the method's own curve: contact space, samples, basis, and for compressed and "
                "refined bases the curves they are made from. Times are medians. Memory: the most held at "
                "once by the library's arrays and CHOLMOD, the model not counted. Effectivity: the method's "
                "own estimate of its error over the true one. Front: no other method of the table is both "
                "faster (both) and nearer (L2).\n\n");
}

static void write_methods(const study_result *one, int all, FILE *to) {
    fprintf(to, "\n## The methods\n\n");
    study_write_rows(to, one, all ? STUDY_RIVALS : STUDY_SHORT);
    fprintf(to, "\n![Error against time](error_against_time.png)\n\n![Response curves](curves.png)\n\n"
                "![Contact over the cycle](contact_over_cycle.png)\n");
}

static void write_levels(const study_result *levels, FILE *to) {
    fprintf(to,
            "\n## A sweep of %" PRId64 " force levels\n\nFrom a %" PRId64
            "th of the force to all of it; times are the sum, "
            "errors the worst.\n\n",
            levels->n_levels, levels->n_levels);
    study_write_rows(to, levels, STUDY_LEVELS);
    fprintf(to, "\n![Error against time, all levels](levels.png)\n");
}

/* Errors against the last step. */
static void write_steps(FILE *to, const char *what, const study_step *step, int32_t n, const char *zero) {
    const study_step *truth = &step[n - 1];
    fprintf(to, "| %s | curve (s) | points | amplitude | frequency | peak |\n|--:|--:|--:|--:|--:|--:|\n",
            what);
    for (int32_t i = 0; i < n; i++) {
        const study_step *s = &step[i];
        if (s->number > 0)
            fprintf(to, "| %" PRId64 " |", s->number);
        else
            fprintf(to, "| %s |", zero);
        fprintf(to, " %.3g | %" PRId64 " | %.6e | %.1e | %.1e |\n", s->seconds, s->n_points, s->amplitude,
                fabs(s->hz / truth->hz - 1), fabs(s->amplitude / truth->amplitude - 1));
    }
    fputc('\n', to);
}

static void write_convergence(const study_findings *f, FILE *to) {
    char automatic[STUDY_NAME];
    const study_steps *s = f->steps;
    fprintf(to, "\n## Convergence\n\n### Samples (paper, figures 9 to 12)\n\nCraig-Bampton is the paper's "
                "measure of time.\n\n");
    study_write_rows(to, f->one, STUDY_SAMPLES);
    fprintf(to, "\n### Tolerance of the singular values (figure 16's basis of several samples, thinned; 1e-6 "
                "otherwise)\n\n");
    study_write_rows(to, f->one, STUDY_SVD);
    fprintf(to,
            "\n### Harmonics\n\nOn the basis of 4 samples compressed to %" PRId64
            " columns, against 30 harmonics on it.\n\n",
            s->basis_size);
    snprintf(automatic, sizeof automatic, "automatic, up to %" PRId64, s->harmonics[0].harmonics);
    write_steps(to, "H", s->harmonics, s->n_harmonics, automatic);
    fprintf(to, "### Time samples\n\nOn the same basis, against exact switching instants.\n\n");
    write_steps(to, "samples in a period", s->samples, s->n_samples, "exact");
    fprintf(to, "![Convergence](convergence.png)\n");
}

static void write_left_out(const study_findings *f, int64_t n_harmonics, FILE *to) {
    fprintf(to, "\n"
                "## What was left out and what it saved\n\n"
                "Each part switched off and on, everything else as in the basis of 4 samples. Where leaving "
                "a part out changes the peak by no more than its error with the part, the scene does not "
                "need it. Rows with an empty last column are on the basis compressed from that of 4 samples. "
                "Times scatter between runs: savings of less than 20 %% mean nothing. Parts of the build: "
                "[build_sizes.md](../build_sizes.md).\n\n");
    study_write_left_out(to, f, n_harmonics);
}

static void write_refined(const study_case *c, const study_result *one, FILE *to) {
    fprintf(to,
            "\n"
            "## Bases for a tolerance of %g\n\n"
            "Each start is grown by corrected motions and compressed until its own estimate meets the "
            "tolerance. The starts of the next mode and of mode 1 have a dominant mode that is not the one "
            "that responds; the last one has its window, too.\n\n",
            c->options->tolerance);
    study_write_refined(to, one);
}

static void write_day(FILE *to) {
    char day[16];
    const time_t now = time(NULL);
    if (strftime(day, sizeof day, "%Y-%m-%d", localtime(&now))) fprintf(to, "* Measured on %s.\n", day);
}

int study_write_report(study_case *c, const study_findings *f) {
    const study_options *o = c->options;
    FILE *to = study_open_file(o, "report.md");
    if (!to) return 1;
    fprintf(to, "# Error against run time: %s, %s pre-load\n\n", o->scene,
            o->with_preload ? "with" : "without");
    fprintf(to, "    OPENBLAS_NUM_THREADS=1 %s\n    plot_study.py %s\n\n", o->command, o->output);
    write_day(to);
    study_write_case(c, to);
    write_reference(f->one ? f->one : f->levels, to);
    write_legend(to);
    if (study_wants(o, "methods") || study_wants(o, "short"))
        write_methods(f->one, study_wants(o, "methods"), to);
    if (f->exact) study_write_exact(c, f->one, f->exact, to);
    if (f->levels) write_levels(f->levels, to);
    if (study_wants(o, "convergence") && f->steps) write_convergence(f, to);
    if (study_wants(o, "left-out")) write_left_out(f, o->n_harmonics, to);
    if (study_wants(o, "refine")) write_refined(c, f->one, to);
    fprintf(to, "\n## Notes\n\n%s", study_stopped() ? "Interrupted: some parts are missing.\n\n" : "");
    if (f->one) study_write_notes(to, f->one);
    if (f->levels) study_write_notes(to, f->levels);
    return study_close_file(to);
}
