/* Models that are unlike a usual structure, dealt out over 1, 2, ... ranks of one run, against one process: a
 * rod with loose joints that is free, one that has DOFs without mass, and a superelement. ctest starts
 * the ranks with different kernels of OpenBLAS. */
#include <math.h>
#include <mpi.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "plm/plm_mpi.h"

enum { N = 60, JOINTS = 2, MODES = 8, FUNCTIONS = 14 };

typedef struct system_of {
    const char *name;
    int64_t n, joint[2 * JOINTS], driven[2], pulled[2];
    double m[N * N], k[N * N];
} system_of;

typedef struct results {
    double hz[MODES], rest[N], peak[2];
} results;

static int rank, failures;

static void expect(int holds, const char *name, int ranks, const char *what, double by) {
    if (holds) return;
    failures++;
    printf("%s on %d ranks: %s differs by %.2g\n", name, ranks, what, by);
}

static void rod(system_of *s, const char *name, int clamped, int massless) {
    const int64_t joint[] = {N / 4 + 1, N / 4, N - 3, N - 4}, driven[] = {N / 3, N - 2},
                  pulled[] = {N - 1, N / 4};
    memset(s, 0, sizeof *s);
    s->name = name, s->n = N;
    memcpy(s->joint, joint, sizeof joint), memcpy(s->driven, driven, sizeof driven);
    memcpy(s->pulled, pulled, sizeof pulled);
    for (int i = 0; i < N; i++) {
        const int next = i + 1 < N ? i + 1 : i;
        const double k = i + 1 < N ? 4e4 * (1 + 0.1 * cos(i)) : 0;
        s->m[i + N * i] = massless && i % 7 == 3 ? 0 : 1 + 0.3 * sin(i);
        s->k[i + N * i] += k, s->k[next + N * next] += k;
        s->k[i + N * next] -= k, s->k[next + N * i] -= k;
    }
    if (clamped) s->k[0] += 5e4;
}

/* T^T A T, in place, n x r */
static void project(double *a, int n, const double *t, int r) {
    static double at[N * N];
    for (int j = 0; j < r; j++)
        for (int i = 0; i < n; i++) {
            at[i + n * j] = 0;
            for (int q = 0; q < n; q++) at[i + n * j] += a[i + n * q] * t[q + n * j];
        }
    for (int j = 0; j < r; j++)
        for (int i = 0; i < r; i++) {
            a[i + r * j] = 0;
            for (int q = 0; q < n; q++) a[i + r * j] += t[q + n * i] * at[q + n * j];
        }
}

/* The DOFs with joints and forces stay, all else moves by smooth functions: full matrices. */
static void superelement(system_of *s) {
    static double t[N * N];
    int64_t kept[8], n_kept = 0;
    rod(s, "superelement", 1, 0);
    int64_t *const lists[] = {s->joint, s->driven, s->pulled};
    const int length[] = {2 * JOINTS, 2, 2};
    for (int list = 0; list < 3; list++)
        for (int i = 0; i < length[list]; i++) {
            int64_t at = 0;
            while (at < n_kept && kept[at] != lists[list][i]) at++;
            if (at == n_kept) kept[n_kept++] = lists[list][i];
            lists[list][i] = at;
        }
    memset(t, 0, sizeof t);
    for (int64_t j = 0; j < n_kept; j++) t[kept[j] + N * j] = 1;
    for (int64_t j = 0; j < FUNCTIONS; j++)
        for (int64_t i = 0; i < N; i++) {
            int is_kept = 0;
            for (int64_t q = 0; q < n_kept; q++) is_kept |= kept[q] == i;
            if (!is_kept) t[i + N * (n_kept + j)] = cos(3.14159265358979 * (double)j * ((double)i + 0.5) / N);
        }
    s->n = n_kept + FUNCTIONS;
    project(s->m, N, t, (int)s->n), project(s->k, N, t, (int)s->n);
}

static const double normal[2] = {1, -1}, stiffness[JOINTS] = {3e4, 5e4}, gap[JOINTS], drive[2] = {3, -3},
                    pull[2] = {0.2, -0.2};

static plm_status one_process(plm_context *ctx, const system_of *s, plm_model **model) {
    double force[N] = {0}, preload[N] = {0};
    plm_status status = plm_model_create(ctx, s->n, model);
    if (!status) status = plm_model_set_dense_matrix(*model, PLM_MASS, PLM_FULL, s->m, s->n);
    if (!status) status = plm_model_set_dense_matrix(*model, PLM_STIFFNESS, PLM_FULL, s->k, s->n);
    for (int j = 0; j < JOINTS && !status; j++)
        status = plm_model_add_gap_rows_i64(*model, 0, 1, (int64_t[]){0, 2}, s->joint + 2 * j, normal,
                                            stiffness + j, gap + j);
    for (int i = 0; i < 2; i++) force[s->driven[i]] = drive[i], preload[s->pulled[i]] = pull[i];
    if (!status) status = plm_model_set_excitation(*model, 1, s->n, force, NULL);
    return status ? status : plm_model_set_preload(*model, s->n, preload);
}

/* Entries by chance, of DOFs owned anywhere. */
static void hand_over(plm_team *team, const system_of *s, int ranks) {
    for (int64_t j = 0; j < s->n; j++) {
        if ((7 * j + 3) % ranks == rank) plm_team_own_dofs_i64(team, 0, 1, &j);
        for (int64_t i = 0; i < s->n; i++) {
            if ((i + j + i * j) % ranks != rank) continue;
            plm_team_add_entries_i64(team, PLM_MASS, PLM_FULL, 0, 1, &i, &j, s->m + i + s->n * j);
            plm_team_add_entries_i64(team, PLM_STIFFNESS, PLM_FULL, 0, 1, &i, &j, s->k + i + s->n * j);
        }
    }
    if (rank < ranks - 1) return;
    for (int j = 0; j < JOINTS; j++)
        plm_team_add_gap_rows_i64(team, 0, 1, (int64_t[]){0, 2}, s->joint + 2 * j, normal, stiffness + j,
                                  gap + j);
    plm_team_add_excitation_i64(team, 1, 0, 2, s->driven, drive, NULL);
    plm_team_add_preload_i64(team, 0, 2, s->pulled, pull);
}

static plm_status compute(plm_model *model, const system_of *s, results *r) {
    int64_t n;
    plm_status status = plm_model_set_rayleigh_damping(model, 0, 2e-4);
    if (status >= 0) status = plm_model_set_double(model, "space_tolerance", 1e-10);
    if (status >= 0) status = plm_model_build(model);
    if (status >= 0) status = plm_model_get_modes(model, PLM_SYSTEM_OPEN, NULL, MODES, r->hz, NULL);
    if (status >= 0) status = plm_model_solve_rest(model);
    if (status >= 0) status = plm_model_get_array(model, "rest_displacement", N, r->rest, &n);
    if (status >= 0)
        status = plm_model_compute_response(model, s->driven[0], PLM_HALF_PEAK_TO_PEAK, 1e-3, &r->peak[0],
                                            &r->peak[1], NULL, NULL, NULL);
    return status;
}

static void compare(const system_of *s, int ranks, const results *one, const results *many, double of_rest) {
    double size = 0, error = 0;
    for (int k = 0; k < MODES; k++) {
        const double by = fabs(many->hz[k] - one->hz[k]);
        expect(by <= 1e-9 * one->hz[k], s->name, ranks, "a frequency", by / one->hz[k]);
    }
    for (int64_t i = 0; i < s->n; i++)
        size = fmax(size, fabs(one->rest[i])), error = fmax(error, fabs(many->rest[i] - one->rest[i]));
    expect(error <= of_rest * size, s->name, ranks, "the rest", error / size);
    for (int k = 0; k < 2; k++) {
        const double by = fabs(many->peak[k] - one->peak[k]);
        expect(by <= 1e-8 * one->peak[k], s->name, ranks, "the peak", by / one->peak[k]);
    }
}

/* On the first `ranks` ranks of all. */
static void over(const system_of *s, int ranks, MPI_Comm comm, results *one, double of_rest) {
    plm_team *team = NULL;
    results many;
    if (plm_team_create(MPI_Comm_c2f(comm), s->n, &team)) MPI_Abort(MPI_COMM_WORLD, 1);
    hand_over(team, s, ranks);
    if (rank == 0) {
        char text[600] = "";
        plm_context *ctx = NULL;
        plm_model *model = NULL;
        plm_context_create(PLM_API_VERSION, &ctx);
        plm_status status = PLM_OK;
        if (ranks == 1) {
            status = one_process(ctx, s, &model);
            if (!status) status = compute(model, s, one);
        }
        if (status >= 0) status = plm_team_create_model(team, ctx, &model);
        if (status >= 0) status = compute(model, s, &many);
        plm_context_get_error_text(ctx, sizeof text, text, NULL);
        if (status < 0) printf("%s\n", text);
        expect(status >= 0, s->name, ranks, "the status", status);
        compare(s, ranks, one, &many, of_rest);
        plm_team_dismiss(team, status < 0 ? status : PLM_OK);
        plm_context_destroy(&ctx);
    } else {
        expect(plm_team_serve(team) == PLM_OK, s->name, ranks, "the status", 0);
    }
    plm_team_destroy(&team);
}

int main(int argc, char **argv) {
    static system_of systems[3];
    static results one[3];
    int size, all = 0;
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &size);
    rod(&systems[0], "free rod", 0, 0);
    rod(&systems[1], "rod with DOFs without mass", 1, 1), superelement(&systems[2]);
    for (int ranks = 1; ranks <= size; ranks++) {
        MPI_Comm comm;
        MPI_Comm_split(MPI_COMM_WORLD, rank < ranks ? 0 : MPI_UNDEFINED, rank, &comm);
        if (rank >= ranks) continue;
        for (int k = 0; k < 3; k++) /* a free rod has the digits of responses beside a soft shift */
            over(&systems[k], ranks, comm, &one[k], k == 0 ? 1e-7 : 1e-9);
        MPI_Comm_free(&comm);
    }
    MPI_Allreduce(&failures, &all, 1, MPI_INT, MPI_SUM, MPI_COMM_WORLD);
    MPI_Finalize();
    return all > 0;
}
