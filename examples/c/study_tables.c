/* study_tables.c: rows of a study as tables, in Markdown and on the screen. */
#include <inttypes.h>
#include <math.h>
#include <string.h>

#include "study.h"

static double whole(const study_row *r) {
    return r->setup + r->curve;
}

/* No other row of the group is both faster and nearer. */
static int on_front(const study_result *result, int group, const study_row *r) {
    if (r->size < 0 || isnan(r->error_l2)) return 0;
    for (int32_t i = 0; i < result->n; i++) {
        const study_row *o = &result->row[i];
        if (!(o->method.groups & group) || o->size < 0 || isnan(o->error_l2)) continue;
        if (whole(o) <= whole(r) && o->error_l2 <= r->error_l2 &&
            (whole(o) < whole(r) || o->error_l2 < r->error_l2))
            return 0;
    }
    return 1;
}

static void put(FILE *to, const char *format, double value) {
    if (isnan(value))
        fputs(" - |", to);
    else
        fprintf(to, format, value);
}

static void write_row(FILE *to, const study_row *r, int front) {
    fprintf(to, "| %s | %s | %" PRId64 " |", r->method.name, front ? "yes" : "", r->size);
    put(to, " %.3g |", r->setup);
    put(to, " %.3g |", 1e3 * r->iteration);
    put(to, " %.3g |", r->curve);
    put(to, " %.3g |", whole(r));
    put(to, " %.3g |", r->megabytes);
    put(to, " %.1e |", r->error_hz);
    put(to, " %.1e |", r->error_amplitude);
    put(to, " %.1e |", r->error_l2);
    put(to, " %.1e |", r->error_max);
    put(to, " %.1e |", r->estimated);
    put(to, " %.2g |", r->effectivity);
    fputc('\n', to);
}

void study_write_rows(FILE *to, const study_result *result, int group) {
    fprintf(to, "| method | front | r | set-up (s) | iteration (ms) | curve (s) | both (s) | memory (MB) | "
                "frequency | peak | curve, L2 | curve, max | estimated | effectivity |\n"
                "|---|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n");
    for (int32_t i = 0; i < result->n; i++) {
        const study_row *r = &result->row[i];
        if ((r->method.groups & group) && r->size >= 0) write_row(to, r, on_front(result, group, r));
    }
}

void study_write_notes(FILE *to, const study_result *result) {
    for (int32_t i = 0; i < result->n; i++) {
        const study_row *r = &result->row[i];
        if (strcmp(r->outcome, "reached the end of its range"))
            fprintf(to, "* %s: %s\n", r->method.name, r->outcome);
    }
}

/* ---- left out ---- */

static const struct {
    const char *part, *without, *with;
} parts[] = {
    {"static augmentation of P_0 (paper, eq. (9))", "no static augmentation", STUDY_AS_IS},
    {"contact set at rest among the samples", "no rest sample", STUDY_AS_IS},
    {"complements of the samples", "no complements", STUDY_AS_IS},
    {"ends of the sweep among the samples", "no ends of the sweep", STUDY_AS_IS},
    {"attachment vectors of the loads (static responses)", "no load vectors", STUDY_AS_IS},
    {"more samples, 8 for 4", STUDY_AS_IS, "twice the samples"},
    {"pairs that do not open or close (gaps instead of coordinates as unknowns)", "moving pairs only",
     "all pairs, modal"},
    {"reduced coordinates as unknowns (instead: what --unknowns says)", STUDY_AS_IS, "all pairs, modal"},
    {"all contact DOFs and fixed-interface modes (against Craig-Bampton)", STUDY_AS_IS, "Craig-Bampton"},
    {"the rest of the structure (against the full order)", STUDY_AS_IS, "full order"},
};

static void write_part(FILE *to, const char *part, const study_row *without, const study_row *with) {
    const double saved = whole(with) - whole(without);
    fprintf(to,
            "| %s | %" PRId64 " / %" PRId64 " | %.3g / %.3g | %.3g | %.0f %% | %.1e | %.1e | %.1e / %.1e |\n",
            part, without->size, with->size, without->curve, with->curve, saved, 100 * saved / whole(with),
            fabs(without->hz / with->hz - 1), fabs(without->amplitude / with->amplitude - 1),
            without->error_amplitude, with->error_amplitude);
}

static void write_step(FILE *to, const char *part, int64_t size, const study_step *without,
                       const study_step *with) {
    const double saved = with->seconds - without->seconds;
    fprintf(to, "| %s | %" PRId64 " / %" PRId64 " | %.3g / %.3g | %.3g | %.0f %% | %.1e | %.1e | |\n", part,
            size, size, without->seconds, with->seconds, saved, 100 * saved / with->seconds,
            fabs(without->hz / with->hz - 1), fabs(without->amplitude / with->amplitude - 1));
}

/* On the compressed basis; n_harmonics: what the plain curve has. */
static void write_steps(FILE *to, const study_steps *s, int64_t n_harmonics) {
    char part[2 * STUDY_NAME];
    snprintf(part, sizeof part, "harmonics above %" PRId64 " (against %d)", n_harmonics,
             STUDY_MANY_HARMONICS);
    write_step(to, part, s->basis_size, &s->plain, &s->many_harmonics);
    write_step(to, "search for folds and branch points", s->basis_size, &s->plain, &s->bifurcations);
    write_step(to, "stability of every point", s->basis_size, &s->plain, &s->stability);
}

void study_write_left_out(FILE *to, const study_findings *found, int64_t n_harmonics) {
    fprintf(to, "| left out | r without / with | curve (s) without / with | saved, set-up and curve (s) | "
                "saved | change of frequency | change of peak | true error of the peak without / with |\n"
                "|---|--:|--:|--:|--:|--:|--:|--:|\n");
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++) {
        const study_row *without = study_find(found->one, parts[i].without),
                        *with = study_find(found->one, parts[i].with);
        if (without && with) write_part(to, parts[i].part, without, with);
    }
    if (found->steps) write_steps(to, found->steps, n_harmonics);
}

/* ---- refinement ---- */

static double median_effectivity(const study_result *result, int32_t *n) {
    double value[STUDY_METHODS];
    *n = 0;
    for (int32_t i = 0; i < result->n; i++) {
        const study_row *r = &result->row[i];
        if (r->method.way != STUDY_REFINED || r->size < 0 || isnan(r->effectivity)) continue;
        int32_t k = (*n)++;
        for (; k > 0 && value[k - 1] > r->effectivity; k--) value[k] = value[k - 1];
        value[k] = r->effectivity;
    }
    if (*n == 0) return NAN;
    return 0.5 * (value[(*n - 1) / 2] + value[*n / 2]);
}

void study_write_refined(FILE *to, const study_result *result) {
    int32_t n = 0, met = 0, all = 0;
    study_write_rows(to, result, STUDY_REFINE);
    fputc('\n', to);
    for (int32_t i = 0; i < result->n; i++) {
        const study_row *r = &result->row[i];
        if (r->method.way != STUDY_REFINED) continue;
        all++;
        met += r->size >= 0 && r->error_amplitude <= 1e-3 && r->error_hz <= 1e-3 && r->error_max <= 1e-3;
    }
    const double median = median_effectivity(result, &n);
    fprintf(to,
            "* %d of %d refined bases have true errors of at most 1e-3 in peak, frequency and everywhere on "
            "the curve.\n",
            (int)met, (int)all);
    if (n > 0) fprintf(to, "* Median effectivity %.2g, of %d.\n", median, (int)n);
}

/* ---- screen ---- */

void study_print_rows(const study_result *result, int group) {
    printf("\n%-34s %5s %9s %9s %9s  %9s %9s %9s\n", "", "r", "set-up, s", "iter., ms", "curve, s",
           "frequency", "peak", "curve, L2");
    for (int32_t i = 0; i < result->n; i++) {
        const study_row *r = &result->row[i];
        if (!(r->method.groups & group)) continue;
        if (r->size < 0)
            printf("%-34s %s\n", r->method.name, r->outcome);
        else
            printf("%-34s %5" PRId64 " %9.3g %9.3g %9.3g  %9.1e %9.1e %9.1e%s\n", r->method.name, r->size,
                   r->setup, 1e3 * r->iteration, r->curve, r->error_hz, r->error_amplitude, r->error_l2,
                   on_front(result, group, r) ? "  *" : "");
    }
    printf("*: no other one is both faster (set-up and curve) and nearer\n\n");
}
