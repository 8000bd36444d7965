/* accuracy SIZE: the accuracy that libplm promises, measured against the full-order solution at the same
 * number of harmonics, on the scenes of examples/scenes at "quick" (the test suite) or "paper" size (about
 * ten minutes). One line per promise: what was measured, the bound, and whether it holds. Ends with 1 if one
 * does not. */
#include "scene_model.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int failures;

static void promise(const char *what, double value, double bound) {
    const int holds = value <= bound;
    printf("  %-66s %9.1e  <= %7.0e  %s\n", what, value, bound, holds ? "holds" : "FAILS");
    fflush(stdout);
    failures += !holds;
}

typedef struct {
    double frequency, amplitude, residual;
    int64_t size;
} answer;

typedef struct {
    scene *s;
    plm_context *ctx;
    plm_model *model;
    plm_sampler *sampler;
} study;

static study begin(const char *name, const char *size, int with_preload, int n_samples) {
    study t = {NULL, NULL, NULL, NULL};
    if (scene_create(name, size, with_preload, &t.s)) exit(1);
    must(NULL, plm_context_create(PLM_API_VERSION, &t.ctx), "context");
    must(t.ctx, scene_to_model(t.ctx, t.s, &t.model), "model");
    must(t.ctx, plm_sampler_create(t.model, &t.sampler), "sampler");
    must(t.ctx, plm_sampler_set_string(t.sampler, "system", t.s->dominant_system ? "sliding" : "open"),
         "system");
    must(t.ctx, plm_sampler_set_int(t.sampler, "mode", t.s->dominant_mode), "mode");
    must(t.ctx, plm_sampler_set_int(t.sampler, "n_samples", n_samples), "n_samples");
    must(t.ctx, plm_sampler_run(t.sampler), "sampler run");
    printf("%s, %s size, %s, %d samples\n", name, size, with_preload ? "with pre-load" : "no pre-load",
           n_samples);
    return t;
}

static void end(study *t) {
    plm_context_destroy(&t->ctx);
    scene_destroy(&t->s);
}

static plm_basis *make_basis(const study *t, const char *kind, const char *selection, int *warned) {
    plm_basis *b = NULL;
    plm_status status;
    must(t->ctx, plm_basis_create(t->model, &b), "basis");
    must(t->ctx, plm_basis_set_sampler(b, t->sampler), "set sampler");
    must(t->ctx, plm_basis_set_string(b, "kind", kind), "kind");
    must(t->ctx, plm_basis_set_string(b, "selection", selection), "selection");
    status = plm_basis_build(b);
    if (status < 0) must(t->ctx, status, "basis build");
    *warned = status == PLM_WARNING;
    return b;
}

static answer peak(const study *t, plm_basis *b, double force_scale) {
    answer a = {0, 0, 0, 0};
    plm_hbm *h = NULL;
    plm_branch *curve = NULL, *top = NULL;
    must(t->ctx, plm_hbm_create(b, &h), "hbm");
    must(t->ctx, plm_hbm_set_int(h, "n_harmonics", 5), "n_harmonics"); /* the paper's */
    must(t->ctx, plm_hbm_set_double(h, "force_scale", force_scale), "force_scale");
    must(t->ctx, plm_hbm_sweep(h, &curve), "sweep");
    must(t->ctx,
         plm_hbm_find_peak(h, curve, t->s->output_dof, PLM_HALF_PEAK_TO_PEAK, 0, &a.frequency, &a.amplitude,
                           &top),
         "peak");
    must(t->ctx, plm_branch_get_full_residual(top, 0, &a.residual), "residual");
    must(t->ctx, plm_basis_get_int(b, "size", &a.size), "size");
    plm_hbm_destroy(&h);
    plm_branch_destroy(&curve);
    plm_branch_destroy(&top);
    return a;
}

static answer solve(const study *t, const char *kind, const char *selection) {
    int warned;
    plm_basis *b = make_basis(t, kind, selection, &warned);
    answer a = peak(t, b, 1.0);
    printf("  %-13s %-5s r = %3d  peak %.6f Hz  %.6e  residual in the full equations %.1e%s\n", kind,
           strcmp(kind, "plm") ? "" : selection, (int)a.size, a.frequency, a.amplitude, a.residual,
           warned ? "  (warns)" : "");
    plm_basis_destroy(&b);
    return a;
}

/* The piecewise-linear modes compressed to `size` columns by their own curve. */
static plm_basis *make_compressed(const study *t, int size) {
    int warned;
    plm_hbm *h = NULL;
    plm_branch *curve = NULL;
    plm_basis *pod = NULL, *parent = make_basis(t, "plm", "below", &warned);
    must(t->ctx, plm_hbm_create(parent, &h), "hbm");
    must(t->ctx, plm_hbm_set_int(h, "n_harmonics", 5), "n_harmonics");
    must(t->ctx, plm_hbm_sweep(h, &curve), "sweep");
    must(t->ctx, plm_basis_create(t->model, &pod), "basis");
    must(t->ctx, plm_basis_set_string(pod, "kind", "pod"), "kind");
    must(t->ctx, plm_basis_set_int(pod, "pod_size", size), "pod_size");
    must(t->ctx, plm_basis_set_parent(pod, parent), "set parent");
    must(t->ctx, plm_basis_set_responses(pod, 1, &curve), "set responses");
    must(t->ctx, plm_basis_build(pod), "basis build");
    plm_hbm_destroy(&h);
    plm_branch_destroy(&curve);
    plm_basis_destroy(&parent);
    return pod;
}

static answer compressed(const study *t, plm_basis *pod) {
    const answer a = peak(t, pod, 1.0);
    printf("  %-13s %-5s r = %3d  peak %.6f Hz  %.6e  residual in the full equations %.1e\n", "pod of plm",
           "", (int)a.size, a.frequency, a.amplitude, a.residual);
    return a;
}

static void compare(const char *what, answer got, answer want, double frequency, double amplitude) {
    char text[100];
    snprintf(text, sizeof text, "%s: resonance frequency", what);
    promise(text, fabs(got.frequency / want.frequency - 1), frequency);
    snprintf(text, sizeof text, "%s: peak amplitude", what);
    promise(text, fabs(got.amplitude / want.amplitude - 1), amplitude);
}

/* Without pre-load and gap the equations are homogeneous: the frequency stays, the amplitude follows the
 * force. */
static void homogeneous(const study *t, plm_basis *b, answer one) {
    double frequency = 0, amplitude = 0;
    for (double force = 1e-3; force < 2e3; force *= 1e6) {
        const answer a = peak(t, b, force);
        frequency = fmax(frequency, fabs(a.frequency / one.frequency - 1));
        amplitude = fmax(amplitude, fabs(a.amplitude / force / one.amplitude - 1));
    }
    promise("force 1e-3 to 1e3: resonance frequency does not move", frequency, 1e-9);
    promise("force 1e-3 to 1e3: amplitude proportional", amplitude, 1e-9);
}

/* Bounds: the and the paper's figures (0.1 % and 1 %, 0.02 % and 0.05 %) or better. */
static void cylinders(const char *size, int with_preload) {
    study t = begin("coaxial_cylinders", size, with_preload, with_preload ? 10 : 4);
    const answer full = solve(&t, "full", "below"), below = solve(&t, "plm", "below"),
                 bands = solve(&t, "plm", "bands");
    plm_basis *pod = make_compressed(&t, with_preload ? 24 : 18);
    const answer few = compressed(&t, pod);
    promise("full order: residual in the full equations", full.residual, 1e-5);
    if (with_preload) {
        compare("all modes below", below, full, 2e-4, 5e-4);
        compare("compressed, r = 24", few, full, 1e-5, 5e-4);
        compare("bands", bands, full, 1e-3, 1e-2);
    } else {
        double blf;
        compare("compressed, r = 18", few, full, 1e-4, 1e-3);
        compare("all modes below", below, full, 5e-4, 8e-3);
        compare("bands", bands, full, 5e-4, 8e-3);
        must(t.ctx, plm_sampler_get_double(t.sampler, "blf_hz", &blf), "blf");
        promise("bilinear frequency against the resonance", fabs(blf / full.frequency - 1), 2e-3);
        homogeneous(&t, pod, few);
    }
    plm_basis_destroy(&pod);
    end(&t);
}

static void plate(const char *size) {
    study t = begin("cracked_plate", size, 1, 4);
    const answer full = solve(&t, "full", "below"), below = solve(&t, "plm", "below"),
                 bands = solve(&t, "plm", "bands"), cb = solve(&t, "craig_bampton", "below"),
                 snapshots = solve(&t, "snapshots", "below");
    promise("full order: residual in the full equations", full.residual, 1e-5);
    compare("all modes below", below, full, 1e-5, 1e-4);
    compare("bands", bands, full, 1e-3, 1e-2);
    compare("Craig-Bampton", cb, full, 1e-3, 1e-2);
    compare("static contact snapshots", snapshots, full, 1e-5, 1e-4);
    promise("static contact snapshots: columns", (double)snapshots.size, 20);
    end(&t);
}

int main(int argc, char **argv) {
    const char *size = argc > 1 ? argv[1] : "quick";
    if (argc > 2 || (strcmp(size, "quick") && strcmp(size, "paper"))) {
        fprintf(stderr, "usage: accuracy [quick|paper]\n");
        return 2;
    }
    plate(size);
    cylinders(size, 0);
    cylinders(size, 1);
    printf(failures ? "%d promises do not hold\n" : "all promises hold\n", failures);
    return failures ? 1 : 0;
}
