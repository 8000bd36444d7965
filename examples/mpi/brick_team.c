/* brick_team.c: a clamped block of bricks with a crack over half its section. Every rank assembles the bricks
 * of its own slice; rank 0 computes the peak of the response.
 *
 *     mpirun -n 4 brick_team [bricks along the block, 12 if not given]
 */
#include <mpi.h>
#include <plm/plm_mpi.h>
#include <stdio.h>
#include <stdlib.h>

#include "brick.h"

enum {
    NY = 3,
    NZ = 4,
    NODES = (NY + 1) * (NZ + 1),
    CRACK = NODES * 3
}; /* bricks and nodes of a section; DOFs of the crack */

/* --- the host's own code: numbers of DOFs, and the matrices of a slice
 * --------------------------------------------- */

/* Sections 0 ... nx, and behind them the other face of the crack, which stands at the middle section. */
static int64_t node_of(int64_t nx, int64_t x, int64_t y, int64_t z, int right_of_crack) {
    const int64_t split = right_of_crack && x == nx / 2 && z >= NZ / 2; /* torn from z = NZ / 2 upwards */
    return (split ? nx + 1 : x) * NODES + y * (NZ + 1) + z;
}

typedef struct entries {
    int64_t n, *row, *column;
    double *k, *m;
} entries;

static void assemble_brick(int64_t nx, int64_t x, int64_t y, int64_t z, entries *e) {
    static const int corner[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                     {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
    const brick_material steel = {2.1e5, 0.3, 7.8e-9}; /* N, mm, t */
    double xyz[24], k[24 * 24], m[8 * 8];
    int64_t node[8];
    for (int c = 0; c < 8; c++) {
        const int64_t at[3] = {x + corner[c][0], y + corner[c][1], z + corner[c][2]};
        node[c] = node_of(nx, at[0], at[1], at[2], x >= nx / 2);
        for (int i = 0; i < 3; i++) xyz[3 * c + i] = 10.0 * (double)at[i];
    }
    if (brick_matrices(xyz, &steel, k, m)) MPI_Abort(MPI_COMM_WORLD, 1);
    for (int a = 0; a < 24; a++)
        for (int b = 0; b < 24; b++, e->n++) {
            e->row[e->n] = 3 * node[a / 3] + a % 3, e->column[e->n] = 3 * node[b / 3] + b % 3;
            e->k[e->n] = k[24 * a + b], e->m[e->n] = a % 3 == b % 3 ? m[8 * (a / 3) + b / 3] : 0;
        }
}

/* The bricks between the sections first and last. */
static entries assemble(int64_t nx, int64_t first, int64_t last) {
    const size_t room = (size_t)(last - first) * NY * NZ * 576 + 1;
    entries e = {0, malloc(room * sizeof(int64_t)), malloc(room * sizeof(int64_t)),
                 malloc(room * sizeof(double)), malloc(room * sizeof(double))};
    for (int64_t x = first; x < last; x++)
        for (int64_t y = 0; y < NY; y++)
            for (int64_t z = 0; z < NZ; z++) assemble_brick(nx, x, y, z, &e);
    return e;
}

/* --- from parts to peak
 * ---------------------------------------------------------------------------------------------- */

static int64_t nx = 12;

static plm_status hand_over(plm_team *team, int rank, int size) {
    const int64_t first = nx * rank / size, last = nx * (rank + 1) / size, is_last = rank == size - 1,
                  one = 1;
    entries e = assemble(nx, first, last);
    int64_t clamped[CRACK], n_own = 0, *own = malloc((size_t)(last - first + 2) * CRACK * sizeof *own);
    plm_status status;
    for (int64_t d = first * CRACK; d < (last + is_last) * CRACK; d++) own[n_own++] = d;
    if (is_last)
        for (int64_t d = 0; d < CRACK; d++) own[n_own++] = (nx + 1) * CRACK + d;
    status = plm_team_own_dofs_i64(team, 0, n_own, own);
    if (!status)
        status = plm_team_add_entries_i64(team, PLM_STIFFNESS, PLM_FULL, 0, e.n, e.row, e.column, e.k);
    if (!status) status = plm_team_add_entries_i64(team, PLM_MASS, PLM_FULL, 0, e.n, e.row, e.column, e.m);
    free(own), free(e.row), free(e.column), free(e.k), free(e.m);
    if (rank > 0 || status) return status;
    for (int64_t d = 0; d < CRACK; d++) clamped[d] = d; /* what is small may come from any rank */
    status = plm_team_fix_dofs_i64(team, 0, CRACK, clamped);
    for (int64_t y = 0; y <= NY && !status; y++)
        for (int64_t z = 0; z <= NZ && !status; z++) {
            const int64_t left = 3 * node_of(nx, nx / 2, y, z, 0), right = 3 * node_of(nx, nx / 2, y, z, 1);
            const int64_t pair[2] = {left, right}, ptr[2] = {0, 2},
                          other_face = 3 * ((nx + 1) * NODES + y * (NZ + 1) + z);
            const double normal[2] = {1, -1}, stiffness = 1e5, gap = 0;
            if (left != right)
                status = plm_team_add_gap_rows_i64(team, 0, 1, ptr, pair, normal, &stiffness, &gap);
            for (int64_t i = 0; i < 3 && left == right && !status;
                 i++) /* numbers of the other face that are not used */
                status = plm_team_fix_dofs_i64(team, 0, 1, (int64_t[]){other_face + i});
        }
    if (!status)
        status = plm_team_add_excitation_i64(team, 1, 0, one, (int64_t[]){(nx + 1) * CRACK - 1},
                                             (double[]){50}, NULL);
    return status;
}

static plm_status find_peak(plm_team *team, plm_context *ctx, double peak[2]) {
    plm_model *model = NULL;
    plm_status status = plm_team_create_model(team, ctx, &model); /* from here on the serial program */
    if (!status) status = plm_model_set_rayleigh_damping(model, 0, 1e-5);
    if (!status) status = plm_model_build(model);
    if (status >= 0)
        status = plm_model_compute_response(model, (nx + 1) * CRACK - 1, PLM_HALF_PEAK_TO_PEAK, 1e-3,
                                            &peak[0], &peak[1], NULL, NULL, NULL);
    return status;
}

int main(int argc, char **argv) {
    int rank, size;
    double peak[2] = {0, 0};
    char text[600] = "";
    plm_team *team = NULL;
    plm_context *ctx = NULL;
    plm_status status;
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &size);
    if (argc > 1) nx = strtol(argv[1], NULL, 10);
    if (plm_team_create(MPI_Comm_c2f(MPI_COMM_WORLD), (nx + 2) * CRACK, &team) < 0)
        MPI_Abort(MPI_COMM_WORLD, 1);
    hand_over(team, rank, size); /* what failed here is told by the next call, on all ranks */
    if (rank == 0) {
        plm_context_create(PLM_API_VERSION, &ctx);
        status = find_peak(team, ctx, peak);
        plm_team_get_error_text(team, sizeof text, text, NULL);
        if (status && !*text) plm_context_get_error_text(ctx, sizeof text, text, NULL);
        plm_team_dismiss(team, status < 0 ? status : PLM_OK);
        if (*text) fprintf(stderr, "%s\n", text);
        if (status >= 0)
            printf("%lld DOFs on %d ranks: peak %.9g mm at %.9g Hz\n", (long long)((nx + 2) * CRACK), size,
                   peak[1], peak[0]);
        plm_context_destroy(&ctx);
    } else {
        status = plm_team_serve(team);
    }
    plm_team_destroy(&team);
    MPI_Finalize();
    return status < 0;
}
