/* levels.c: force levels shared out over the ranks of an MPI program. Rank 0 makes the basis, its bytes go to
 * the others by the host's own broadcast, and every rank follows the curves of its levels. libplm knows
 * nothing of MPI.
 *
 *     mpirun -n 4 levels [scene] [quick|paper]
 */
#include <mpi.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scene_model.h"

enum { LEVELS = 6, LARGEST_MESSAGE = 1 << 30 };

typedef struct curve {
    double force_scale, hz, amplitude, points;
} curve;

/* As must(); but what a basis of bytes cannot be asked is no news: it has no structure to compare its curves
 * with. */
static void computed(plm_context *ctx, plm_status status, const char *what) {
    int32_t reason = PLM_REASON_NONE;
    plm_context_get_error_info(ctx, NULL, &reason, NULL, NULL);
    if (status != PLM_WARNING || reason != PLM_REASON_UNVERIFIED) must(ctx, status, what);
}

/* The basis of the scene as bytes, which the caller frees. */
static char *make_basis(plm_context *ctx, const scene *s, int64_t *n) {
    plm_model *model = NULL;
    plm_sampler *sampler = NULL;
    plm_basis *basis = NULL;
    must(ctx, scene_to_model(ctx, s, &model), "model");
    must(ctx, plm_sampler_create(model, &sampler), "sampler");
    must(ctx,
         plm_sampler_set_string(sampler, "system", s->dominant_system == SCENE_OPEN ? "open" : "sliding"),
         "system");
    must(ctx, plm_sampler_set_int(sampler, "mode", s->dominant_mode), "mode");
    must(ctx, plm_sampler_run(sampler), "sampler");
    must(ctx, plm_basis_create(model, &basis), "basis");
    must(ctx, plm_basis_set_sampler(basis, sampler), "basis");
    must(ctx, plm_basis_build(basis), "basis");
    must(ctx, plm_basis_write(basis, 0, NULL, n), "bytes");
    char *bytes = malloc((size_t)*n);
    if (bytes) must(ctx, plm_basis_write(basis, *n, bytes, n), "bytes");
    return bytes;
}

/* From rank 0 to all; a message of MPI has at most 2^31 bytes. */
static void broadcast(char *bytes, int64_t n) {
    for (int64_t done = 0; done < n; done += LARGEST_MESSAGE) {
        const int64_t left = n - done;
        MPI_Bcast(bytes + done, (int)(left < LARGEST_MESSAGE ? left : LARGEST_MESSAGE), MPI_BYTE, 0,
                  MPI_COMM_WORLD);
    }
}

/* The curve of one level, and the highest point of it. */
static curve follow(plm_context *ctx, plm_basis *basis, int64_t dof, double force_scale) {
    plm_hbm *hbm = NULL;
    plm_branch *branch = NULL;
    int64_t points = 0;
    curve c = {force_scale, 0, 0, 0};
    must(ctx, plm_hbm_create(basis, &hbm), "hbm");
    must(ctx, plm_hbm_set_double(hbm, "force_scale", force_scale), "force_scale");
    computed(ctx, plm_hbm_sweep(hbm, &branch), "sweep");
    computed(ctx, plm_hbm_find_peak(hbm, branch, dof, PLM_HALF_PEAK_TO_PEAK, 0, &c.hz, &c.amplitude, NULL),
             "peak");
    must(ctx, plm_branch_get_int(branch, "n_points", &points), "points");
    c.points = (double)points;
    plm_hbm_destroy(&hbm);
    return c;
}

int main(int argc, char **argv) {
    int rank = 0, size = 1;
    int64_t head[2] = {0, 0}; /* bytes of the basis, DOF that is watched */
    char *bytes = NULL;
    curve mine[LEVELS], all[LEVELS];
    plm_context *ctx = NULL;
    plm_basis *basis = NULL;

    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &size);
    if (plm_context_create(PLM_API_VERSION, &ctx) < 0) MPI_Abort(MPI_COMM_WORLD, 1);
    if (rank == 0) {
        scene *s = NULL;
        if (scene_create(argc > 1 ? argv[1] : "cracked_plate", argc > 2 ? argv[2] : "quick", 1, &s))
            MPI_Abort(MPI_COMM_WORLD, 1);
        bytes = make_basis(ctx, s, &head[0]);
        head[1] = s->output_dof;
        plm_context_destroy(&ctx); /* the model has borrowed the scene's matrices */
        scene_destroy(&s);
        if (plm_context_create(PLM_API_VERSION, &ctx) < 0) MPI_Abort(MPI_COMM_WORLD, 1);
    }
    MPI_Bcast(head, 2, MPI_INT64_T, 0, MPI_COMM_WORLD);
    if (rank > 0) bytes = malloc((size_t)head[0]);
    if (!bytes) MPI_Abort(MPI_COMM_WORLD, 1);
    broadcast(bytes, head[0]);

    /* all ranks alike read the same bytes: their curves are those of one process, to the last digit */
    must(ctx, plm_basis_read(ctx, head[0], bytes, &basis), "basis");
    free(bytes);
    memset(mine, 0, sizeof mine);
    for (int level = rank; level < LEVELS; level += size)
        mine[level] = follow(ctx, basis, head[1], 0.25 * (level + 1));
    MPI_Reduce(mine, all, 4 * LEVELS, MPI_DOUBLE, MPI_SUM, 0, MPI_COMM_WORLD);
    if (rank == 0) {
        printf("basis: %lld bytes\nforce scale  peak (Hz)    amplitude      points\n", (long long)head[0]);
        for (int level = 0; level < LEVELS; level++)
            printf("%11.2f  %11.6f  %13.8g  %6.0f\n", all[level].force_scale, all[level].hz,
                   all[level].amplitude, all[level].points);
    }
    plm_context_destroy(&ctx);
    MPI_Finalize();
    return 0;
}
