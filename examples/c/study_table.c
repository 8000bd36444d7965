/* study_table.c: the table of error against run time on the screen. */
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "study.h"

static void print_head(const char *title) {
    printf("\n%s\n", title);
    printf("                     basis   set-up  Newton it.    curve  points  resonance    error   peak "
           "ampl.    error"
           "  residual in the\n");
    printf("method                size        s          ms        s                Hz                       "
           "        "
           "  full equations\n");
}

static void print_row(const study_result *r) {
    printf("%-18s  %6" PRId64 "  %7.3f  %10.3f  %7.3f  %6" PRId64 "  %9.3f  %7.1e  %11.5e  %7.1e  %15.1e\n",
           r->method.label, r->basis_size, r->setup_seconds, 1e3 * r->iteration_seconds, r->curve_seconds,
           r->n_points, r->peak_hz, r->error_hz, r->peak_amplitude, r->error_amplitude, r->full_residual);
}

/* What a reader of the row has to know. */
static void print_notes(const study_result *r) {
    if (r->error[0]) printf("  %s: FAILED: %s\n", r->method.label, r->error);
    if (r->warning[0]) printf("  %s: warning: %s\n", r->method.label, r->warning);
    if (!r->error[0] && r->end_reason != PLM_REASON_RANGE_END)
        printf("  %s: the curve ended early: %s\n", r->method.label, r->end);
}

void study_print_table(const study_result *result, int32_t n) {
    print_head("Modes below 1.1 H f_max (the default), errors relative to the full order at the same H");
    for (int32_t i = 0; i < n; i++)
        if (strcmp(result[i].method.selection, "bands")) print_row(&result[i]);
    for (int32_t i = 0; i < n; i++)
        if (strcmp(result[i].method.selection, "bands")) print_notes(&result[i]);
    print_head("The paper's rule: modes inside the bands [h f_min, h f_max] only");
    for (int32_t i = 0; i < n; i++)
        if (!strcmp(result[i].method.selection, "bands")) {
            print_row(&result[i]);
            print_notes(&result[i]);
        }
}
