/* superelement.c: a host that reduces its structure itself. A rod of 400 masses is clamped at its left and
 * meets a stop with its right end. Craig and Bampton's method retains the end and adds fixed-interface modes,
 * which for this rod are sines; the small dense matrices go to libplm with the way back, and the peak is that
 * of the rod handed over whole. */
#include <math.h>
#include <plm/plm.h>
#include <stdio.h>
#include <stdlib.h>

#define TRY(call)                                                                                            \
    do {                                                                                                     \
        if ((call) < 0) return 1;                                                                            \
    } while (0)

enum { N = 400, MODES = 100, SIZE = 1 + MODES, END = N - 1, MIDDLE = N / 2 };
static const double mass = 0.01, spring = 1e7; /* kg, N/m; half a mass at the end */
static const double beta = 1e-5, stop = 1e4, gap = 1e-4, force = 1;

/* Column j of T at mass i: the constraint mode of the end, then the modes with the end held. */
static double column_of_t(int i, int j) {
    if (j == 0) return (i + 1.0) / N;
    return i == END ? 0 : sqrt(2.0 / (N * mass)) * sin(acos(-1.0) * j * (i + 1.0) / N);
}

/* The rod gives both to a reduction that a finite-element code has already. */
static double times_m(const double *q, int i) {
    return (i == END ? 0.5 : 1) * mass * q[i];
}
static double times_k(const double *q, int i) {
    const double left = i > 0 ? q[i - 1] : 0;
    return spring * (q[i] - left + (i < END ? q[i] - q[i + 1] : 0));
}

static void reduce(const double *t, double *m, double *k) {
    for (int j = 0; j < SIZE; ++j)
        for (int i = 0; i < SIZE; ++i) {
            m[i + j * SIZE] = k[i + j * SIZE] = 0;
            for (int p = 0; p < N; ++p) {
                m[i + j * SIZE] += t[p + i * N] * times_m(t + j * N, p);
                k[i + j * SIZE] += t[p + i * N] * times_k(t + j * N, p);
            }
        }
}

/* The way back, full = T reduced; a finite-element code has it as a routine. user: T */
static int32_t recover(plm_context *ctx, int64_t n_dof, int64_t n_columns, const double *reduced,
                       int64_t n_full, double *full, void *user) {
    const double *t = user;
    (void)ctx;
    for (int64_t c = 0; c < n_columns; ++c)
        for (int64_t i = 0; i < n_full; ++i) {
            double q = 0;
            for (int64_t j = 0; j < n_dof; ++j) q += t[i + j * n_full] * reduced[j + c * n_dof];
            full[i + c * n_full] = q;
        }
    return 0;
}

/* What both models share: damping, the stop at DOF `end` and a force there. */
static int complete(plm_model *model, int n, int32_t end) {
    const int32_t ground[] = {end, -1, -1};
    const double normal[] = {1, 0, 0};
    double *load = calloc((size_t)n, sizeof *load);
    if (!load) return 1;
    load[end] = force;
    const plm_status set = plm_model_set_excitation(model, 1, n, load, NULL);
    free(load);
    TRY(set);
    TRY(plm_model_set_rayleigh_damping(model, 0, beta));
    TRY(plm_model_add_ground_contacts_i32(model, 0, 1, ground, normal, &stop, &gap));
    TRY(plm_model_build(model));
    return 0;
}

static int superelement(plm_context *ctx, double *t, plm_model **model) {
    static double m[SIZE * SIZE], k[SIZE * SIZE];
    reduce(t, m, k);
    TRY(plm_model_create(ctx, SIZE, model));
    TRY(plm_model_set_dense_matrix(*model, PLM_MASS, PLM_FULL, m, SIZE));
    TRY(plm_model_set_dense_matrix(*model, PLM_STIFFNESS, PLM_FULL, k, SIZE));
    TRY(plm_model_set_recovery(*model, N, recover, t));
    TRY(plm_model_set_double(*model, "reduction_error", 1e-6)); /* as the host knows it */
    return complete(*model, SIZE, 0);                           /* the end is its first DOF */
}

static int whole_rod(plm_context *ctx, plm_model **model) {
    static int32_t diagonal[N], row[2 * N], column[2 * N];
    static double m[N], k[2 * N];
    int n = 0;
    for (int i = 0; i < N; ++i) {
        diagonal[i] = i, m[i] = (i == END ? 0.5 : 1) * mass;
        row[n] = column[n] = i, k[n++] = (i == END ? 1 : 2) * spring;
        if (i > 0) row[n] = i, column[n] = i - 1, k[n++] = -spring;
    }
    TRY(plm_model_create(ctx, N, model));
    TRY(plm_model_set_matrix_i32(*model, PLM_MASS, PLM_TRIPLETS, PLM_LOWER, 0, PLM_COPY, N, diagonal,
                                 diagonal, m));
    TRY(plm_model_set_matrix_i32(*model, PLM_STIFFNESS, PLM_TRIPLETS, PLM_LOWER, 0, PLM_COPY, n, row, column,
                                 k));
    return complete(*model, N, END);
}

static int compare(plm_context *ctx, double *t) {
    plm_model *small = NULL, *whole = NULL;
    plm_branch *curve = NULL;
    double hz, peak, error, true_hz, true_peak, middle[4000], top = 0;
    int64_t count;
    TRY(superelement(ctx, t, &small));
    TRY(plm_model_compute_response(small, 0, PLM_PEAK, 1e-4, &hz, &peak, &error, &curve, NULL));
    printf("superelement, %3d DOFs: peak %.9e m at %.6f Hz, error below %.1e\n", SIZE, peak, hz, error);
    TRY(plm_model_recover_amplitude(small, curve, MIDDLE, PLM_PEAK, 0, 4000, middle, &count));
    for (int64_t p = 0; p < count; ++p) top = middle[p] > top ? middle[p] : top;
    printf("recovered: up to %.4e m in the middle of the rod\n", top);

    TRY(whole_rod(ctx, &whole));
    TRY(plm_model_compute_response(whole, END, PLM_PEAK, 1e-4, &true_hz, &true_peak, NULL, NULL, NULL));
    printf("the whole rod, %d DOFs: peak %.9e m at %.6f Hz\n", N, true_peak, true_hz);
    return fabs(peak - true_peak) < 1e-6 * true_peak && fabs(hz - true_hz) < 1e-6 * true_hz ? 0 : 1;
}

int main(void) {
    plm_context *ctx = NULL;
    double *t = malloc(sizeof *t * N * SIZE);
    if (!t || plm_context_create(PLM_API_VERSION, &ctx) < 0) return 1;
    for (int j = 0; j < SIZE; ++j)
        for (int i = 0; i < N; ++i) t[i + j * N] = column_of_t(i, j);
    const int failed = compare(ctx, t);
    if (failed) {
        char text[500];
        plm_context_get_error_text(ctx, sizeof text, text, NULL);
        fprintf(stderr, "not as expected; the library says: %s\n", text);
    }
    plm_context_destroy(&ctx);
    free(t);
    return failed;
}
