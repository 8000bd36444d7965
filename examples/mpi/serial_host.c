/* serial_host.c: a serial program with a distributed solver. Rank 0 has the model and runs libplm; its
 * factorizations and solutions go through plm_context_set_solver to MUMPS on all ranks, which wait in
 * serve().
 *
 *     mpirun -n 3 serial_host [scene] [quick|paper]
 */
#include <dmumps_c.h>
#include <mpi.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scene_model.h"

enum {
    MOST_FACTORS = 64,
    START = -1,
    END = -2,
    FACTOR = 4,
    SOLVE = 3,
    STOP = 0
}; /* jobs of MUMPS but for STOP */

static DMUMPS_STRUC_C mumps[MOST_FACTORS];
static int in_use[MOST_FACTORS];

#define ICNTL(i) icntl[(i)-1] /* as the manual counts */
#define INFOG(i) infog[(i)-1]

/* On all ranks: one job of one factor. Rank 0 has set what the job reads. */
static void do_job(int job, int f) {
    DMUMPS_STRUC_C *m = &mumps[f];
    if (job == START) {
        m->par = 1, m->sym = 2, m->comm_fortran = (MUMPS_INT)MPI_Comm_c2f(MPI_COMM_WORLD);
        m->job = START;
        dmumps_c(m);
        m->ICNTL(1) = m->ICNTL(2) = m->ICNTL(3) = -1, m->ICNTL(4) = 0; /* it is silent */
        m->ICNTL(13) = m->ICNTL(24) = 1; /* negative pivots of the root are counted, vanishing ones found */
        return;
    }
    m->job = job;
    dmumps_c(m);
}

/* Rank 0: the others do it, too. */
static void order(int job, int f) {
    int words[2] = {job, f};
    MPI_Bcast(words, 2, MPI_INT, 0, MPI_COMM_WORLD);
    if (job != STOP) do_job(job, f);
}
static void serve(void) {
    for (;;) {
        int words[2];
        MPI_Bcast(words, 2, MPI_INT, 0, MPI_COMM_WORLD);
        if (words[0] == STOP) return;
        do_job(words[0], words[1]);
    }
}

/* --- the three functions, and the count of negative pivots ------------------------------------------------
 */

static void release(plm_context *ctx, void *factor, void *user) {
    const int f = (int)((DMUMPS_STRUC_C *)factor - mumps);
    (void)ctx, (void)user;
    order(END, f);
    in_use[f] = 0;
}

static int32_t factorize(plm_context *ctx, int64_t n, const int64_t *col_ptr, const int64_t *row,
                         const double *value, int32_t positive_definite, void **factor, void *user) {
    const int64_t nnz = col_ptr[n];
    MUMPS_INT *i = malloc((size_t)(2 * nnz) * sizeof *i);
    int f = 0;
    while (f < MOST_FACTORS && in_use[f]) f++;
    if (f == MOST_FACTORS || !i) return free(i), 1;
    in_use[f] = 1;
    order(START, f);
    for (int64_t column = 0; column < n; column++)
        for (int64_t k = col_ptr[column]; k < col_ptr[column + 1]; k++)
            i[k] = (MUMPS_INT)(row[k] + 1), i[nnz + k] = (MUMPS_INT)(column + 1);
    mumps[f].n = (MUMPS_INT)n, mumps[f].nnz = nnz;
    mumps[f].irn = i, mumps[f].jcn = i + nnz, mumps[f].a = (double *)value;
    order(FACTOR, f); /* analysis and factorization */
    mumps[f].irn = mumps[f].jcn = NULL, mumps[f].a = NULL;
    free(i);
    *factor = &mumps[f];
    /* INFOG(12): negative pivots, INFOG(28): vanishing ones */
    if (mumps[f].INFOG(1) < 0 || mumps[f].INFOG(28) > 0 || (positive_definite && mumps[f].INFOG(12) > 0)) {
        const int32_t code = mumps[f].INFOG(1) < 0 ? mumps[f].INFOG(1) : 1;
        release(ctx, *factor, user);
        return code;
    }
    return 0;
}

static int32_t solve(plm_context *ctx, void *factor, int64_t nrhs, double *x, int64_t ldx, void *user) {
    DMUMPS_STRUC_C *m = factor;
    (void)ctx, (void)user;
    m->nrhs = (MUMPS_INT)nrhs, m->lrhs = (MUMPS_INT)ldx, m->rhs = x;
    order(SOLVE, (int)(m - mumps));
    return m->INFOG(1) < 0 ? m->INFOG(1) : 0;
}

static int32_t inertia(plm_context *ctx, void *factor, int64_t *negative, void *user) {
    (void)ctx, (void)user;
    *negative = ((DMUMPS_STRUC_C *)factor)->INFOG(12);
    return 0;
}

/* --- the program ------------------------------------------------------------------------------------------
 */

static void compute(const scene *s) {
    double hz = 0, amplitude = 0;
    plm_context *ctx = NULL;
    plm_model *model = NULL;
    if (plm_context_create(PLM_API_VERSION, &ctx) < 0) MPI_Abort(MPI_COMM_WORLD, 1);
    must(ctx, plm_context_set_solver(ctx, factorize, solve, release, NULL), "solver");
    must(ctx, plm_context_set_inertia(ctx, inertia), "inertia");
    must(ctx, scene_to_model(ctx, s, &model), "model");
    must(ctx,
         plm_model_compute_response(model, s->output_dof, PLM_HALF_PEAK_TO_PEAK, 1e-3, &hz, &amplitude, NULL,
                                    NULL, NULL),
         "response");
    printf("peak %.9g at %.9g Hz\n", amplitude, hz);
    plm_context_destroy(&ctx); /* gives back all factors */
}

int main(int argc, char **argv) {
    int rank = 0;
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    if (rank == 0) {
        scene *s = NULL;
        if (scene_create(argc > 1 ? argv[1] : "cracked_plate", argc > 2 ? argv[2] : "quick", 1, &s))
            MPI_Abort(MPI_COMM_WORLD, 1);
        compute(s);
        scene_destroy(&s);
        order(STOP, 0);
    } else {
        serve();
    }
    MPI_Finalize();
    return 0;
}
