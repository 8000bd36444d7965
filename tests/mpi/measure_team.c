/* The set-up of a cracked block of bricks by a team or, without one, by one process. One line: who, ranks,
 * DOFs; processor seconds of rank 0 for the hand-over of what was assembled, the build, 30 modes, their
 * count, samples and basis; all processor seconds of the rank that had most; MiB of the largest rank, and of
 * all. measure_team.py makes a table of it.
 *
 *     mpirun -n RANKS measure_team NX NY NZ [serial]
 */
#define _POSIX_C_SOURCE 200112L
#include <mpi.h>
#include <sched.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <time.h>

#include "brick.h"
#include "plm/plm_mpi.h"

enum { MODES = 30 };

typedef struct entries {
    int64_t n, *row, *column;
    double *k, *m;
} entries;

static int64_t nx, ny, nz, per_section;
static int rank, size;

/* Seconds of the processor that this rank has had so far, and its largest size in MiB. */
static double seconds(void) {
    struct rusage u;
    getrusage(RUSAGE_SELF, &u);
    return (double)(u.ru_utime.tv_sec + u.ru_stime.tv_sec) +
           1e-6 * (double)(u.ru_utime.tv_usec + u.ru_stime.tv_usec);
}
static double mebibytes(void) {
    struct rusage u;
    getrusage(RUSAGE_SELF, &u);
    return (double)u.ru_maxrss / 1024;
}

/* Sections 0 ... nx, and behind them the other face of the crack: the upper half of the middle section. */
static int64_t node_of(int64_t x, int64_t y, int64_t z, int right_of_crack) {
    const int64_t upper = z - nz / 2, torn = right_of_crack && x == nx / 2 && upper >= 0;
    return torn ? (nx + 1) * per_section + y * (nz + 1 - nz / 2) + upper : x * per_section + y * (nz + 1) + z;
}
static int64_t n_dof(void) {
    return 3 * ((nx + 1) * per_section + (ny + 1) * (nz + 1 - nz / 2));
}

static void add_brick(int64_t x, int64_t y, int64_t z, const double *k, const double *m, entries *e) {
    static const int corner[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                     {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
    int64_t dof[24];
    for (int i = 0; i < 24; i++) {
        const int *c = corner[i / 3];
        dof[i] = 3 * node_of(x + c[0], y + c[1], z + c[2], x >= nx / 2) + i % 3;
    }
    for (int a = 0; a < 24; a++)
        for (int b = 0; b <= a; b++, e->n++) {
            e->row[e->n] = dof[a] > dof[b] ? dof[a] : dof[b],
            e->column[e->n] = dof[a] + dof[b] - e->row[e->n];
            e->k[e->n] = k[24 * a + b], e->m[e->n] = a % 3 == b % 3 ? m[8 * (a / 3) + b / 3] : 0;
        }
}

static entries assemble(int64_t first, int64_t last) {
    static const double xyz[24] = {0, 0, 0, 2, 0, 0, 2, 2, 0, 0, 2, 0, 0, 0, 2, 2, 0, 2, 2, 2, 2, 0, 2, 2};
    const brick_material steel = {2.1e5, 0.3, 7.8e-9}; /* N, mm, t */
    const size_t room = (size_t)((last - first) * ny * nz * 300 + 1);
    entries e = {0, malloc(room * sizeof(int64_t)), malloc(room * sizeof(int64_t)),
                 malloc(room * sizeof(double)), malloc(room * sizeof(double))};
    double k[24 * 24], m[8 * 8];
    if (!e.row || !e.column || !e.k || !e.m || brick_matrices(xyz, &steel, k, m))
        MPI_Abort(MPI_COMM_WORLD, 1);
    for (int64_t x = first; x < last; x++)
        for (int64_t y = 0; y < ny; y++)
            for (int64_t z = 0; z < nz; z++) add_brick(x, y, z, k, m, &e);
    return e;
}

static void release(entries *e) {
    free(e->row), free(e->column), free(e->k), free(e->m);
}

/* Clamped at section 0, contact where the crack is, a force at the tip; in the words of team or model. */
static plm_status rest_of(plm_team *team, plm_model *model) {
    const double normal[2] = {1, -1}, stiffness = 1e6, gap = 0, force = 50;
    const int64_t tip = 3 * node_of(nx, ny, nz, 0) + 2;
    plm_status status = PLM_OK;
    for (int64_t d = 0; d < 3 * per_section && !status; d++)
        status = team ? plm_team_fix_dofs_i64(team, 0, 1, &d) : plm_model_fix_dofs_i64(model, 0, 1, &d);
    for (int64_t y = 0; y <= ny && !status; y++)
        for (int64_t z = nz / 2; z <= nz && !status; z++) {
            const int64_t ptr[2] = {0, 2},
                          pair[2] = {3 * node_of(nx / 2, y, z, 0), 3 * node_of(nx / 2, y, z, 1)};
            status = team ? plm_team_add_gap_rows_i64(team, 0, 1, ptr, pair, normal, &stiffness, &gap)
                          : plm_model_add_gap_rows_i64(model, 0, 1, ptr, pair, normal, &stiffness, &gap);
        }
    if (status) return status;
    if (team) return plm_team_add_excitation_i64(team, 1, 0, 1, &tip, &force, NULL);
    double *load = calloc((size_t)n_dof(), sizeof *load);
    load[tip] = force;
    status = plm_model_set_excitation(model, 1, n_dof(), load, NULL);
    free(load);
    return status;
}

/* With the seconds of the processor before it: what a host assembles is its own affair. */
static plm_status hand_over(plm_team *team, double *begin) {
    const int64_t first = nx * rank / size, last = nx * (rank + 1) / size;
    entries e = assemble(first, last);
    plm_status status = PLM_OK;
    *begin = seconds();
    for (int64_t d = 3 * first * per_section; d < (rank == size - 1 ? n_dof() : 3 * last * per_section); d++)
        status = plm_team_own_dofs_i64(team, 0, 1, &d);
    status = plm_team_add_entries_i64(team, PLM_STIFFNESS, PLM_LOWER, 0, e.n, e.row, e.column, e.k);
    if (!status) status = plm_team_add_entries_i64(team, PLM_MASS, PLM_LOWER, 0, e.n, e.row, e.column, e.m);
    release(&e);
    return status || rank > 0 ? status : rest_of(team, NULL);
}

static plm_status serial_model(plm_context *ctx, plm_model **model, double *begin) {
    entries e = assemble(0, nx);
    *begin = seconds();
    plm_status status = plm_model_create(ctx, n_dof(), model);
    if (!status)
        status = plm_model_set_matrix_i64(*model, PLM_STIFFNESS, PLM_TRIPLETS, PLM_LOWER, 0, PLM_COPY, e.n,
                                          e.row, e.column, e.k);
    if (!status)
        status = plm_model_set_matrix_i64(*model, PLM_MASS, PLM_TRIPLETS, PLM_LOWER, 0, PLM_COPY, e.n, e.row,
                                          e.column, e.m);
    release(&e);
    return status ? status : rest_of(NULL, *model);
}

/* Ranks of Open MPI that wait inside MUMPS ask for messages again and again, and give their turn away in
 * between (mpi_yield_when_idle): here they sleep instead, the longer the longer they wait, or their seconds
 * would be counted as work. */
__attribute__((visibility("default"))) int sched_yield(void) {
    static struct timespec last, nap;
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    const double since = (double)(now.tv_sec - last.tv_sec) + 1e-9 * (double)(now.tv_nsec - last.tv_nsec);
    nap.tv_nsec = since < 5e-5 && nap.tv_nsec < 100000 ? nap.tv_nsec + nap.tv_nsec / 2 + 1000
                  : since < 5e-5                       ? nap.tv_nsec
                                                       : 1000;
    const int code = nanosleep(&nap, NULL);
    clock_gettime(CLOCK_MONOTONIC, &last);
    return code;
}

/* The build, 30 modes, their count by a factorization, samples and basis: all that contact needs. */
enum { STEPS = 4 };

static plm_status step(plm_model *model, int which) {
    static double hz[MODES];
    static plm_sampler *sampler;
    static plm_basis *basis;
    int64_t count = 0;
    plm_status status;
    switch (which) {
    case 0:
        return plm_model_build(model);
    case 1:
        return plm_model_get_modes(model, PLM_SYSTEM_OPEN, NULL, MODES, hz, NULL);
    case 2:
        status = plm_model_count_modes(model, hz[MODES - 1] * 1.0001, &count);
        return status < 0 || count == MODES ? status : PLM_ERR_INTERNAL;
    default:
        status = plm_sampler_create(model, &sampler);
        if (status >= 0) status = plm_sampler_run(sampler);
        if (status >= 0) status = plm_basis_create(model, &basis);
        if (status >= 0) status = plm_basis_set_sampler(basis, sampler);
        return status >= 0 ? plm_basis_build(basis) : status;
    }
}

static plm_status work(plm_model *model, double *took) {
    plm_status status = plm_model_set_rayleigh_damping(model, 0, 1e-6);
    for (int k = 0; k < STEPS && status >= 0; k++) {
        const double before = seconds();
        status = step(model, k);
        took[k] = seconds() - before;
    }
    return status;
}

int main(int argc, char **argv) {
    char text[600] = "";
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &size);
    if (argc < 4) MPI_Abort(MPI_COMM_WORLD, 2);
    nx = strtol(argv[1], NULL, 10), ny = strtol(argv[2], NULL, 10), nz = strtol(argv[3], NULL, 10);
    const int serial = argc > 4;
    double took[STEPS] = {0};
    per_section = (ny + 1) * (nz + 1);
    plm_team *team = NULL;
    plm_context *ctx = NULL;
    plm_model *model = NULL;
    plm_status status = PLM_OK;
    double begin = seconds(), handed_over = 0;
    if (!serial) {
        status = plm_team_create(MPI_Comm_c2f(MPI_COMM_WORLD), n_dof(), &team);
        if (!status) hand_over(team, &begin);
    }
    if (rank == 0) {
        plm_context_create(PLM_API_VERSION, &ctx);
        status = serial ? serial_model(ctx, &model, &begin) : plm_team_create_model(team, ctx, &model);
        handed_over = seconds() - begin;
        if (status >= 0) status = work(model, took);
        plm_context_get_error_text(ctx, sizeof text, text, NULL);
        if (*text) fprintf(stderr, "%s\n", text);
        if (team) plm_team_dismiss(team, status < 0 ? status : PLM_OK);
    } else {
        status = plm_team_serve(team);
    }
    const double mine[2] = {seconds() - begin, mebibytes()};
    double most[2], sum[2];
    MPI_Reduce(mine, most, 2, MPI_DOUBLE, MPI_MAX, 0, MPI_COMM_WORLD);
    MPI_Reduce(mine, sum, 2, MPI_DOUBLE, MPI_SUM, 0, MPI_COMM_WORLD);
    if (rank == 0) printf("%s, %d, %lld", serial ? "serial" : "team", size, (long long)n_dof());
    if (rank == 0) printf(", %.2f", handed_over);
    for (int k = 0; k < STEPS && rank == 0; k++) printf(", %.2f", took[k]);
    if (rank == 0) printf(", %.2f, %.0f, %.0f\n", most[0], most[1], sum[1]);
    plm_team_destroy(&team);
    plm_context_destroy(&ctx);
    MPI_Finalize();
    return status < 0;
}
