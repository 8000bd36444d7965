/* A serial host that brings MPI of its own, as codes do that also run without: one rank, and functions that
 * do next to nothing. Neither libplm nor its plug-in for ranks, loaded beside it or not, may call them in the
 * host's place or come between the host and them. */
#include "whole_run.h"
#include <stdio.h>

static int calls;

#define OWN(name, result)                                                                                    \
    int name(void);                                                                                          \
    int name(void) {                                                                                         \
        calls++;                                                                                             \
        return result;                                                                                       \
    }
OWN(MPI_Init, 101)
OWN(MPI_Initialized, 102)
OWN(MPI_Finalized, 103)
OWN(MPI_Send, 104)
OWN(MPI_Recv, 105)
OWN(MPI_Allreduce, 106)
OWN(MPI_Bcast, 107)
OWN(MPI_Ibcast, 108)
OWN(MPI_Comm_dup, 109)
OWN(MPI_Comm_rank, 110)
OWN(MPI_Comm_size, 111)
OWN(MPI_Finalize, 112)
OWN(mpi_init_, 113)
OWN(mpi_comm_rank_, 114)
OWN(dmumps_c, 115)

/* All of them, and how many answered as their own. */
static int own(void) {
    return (MPI_Init() == 101) + (MPI_Initialized() == 102) + (MPI_Finalized() == 103) + (MPI_Send() == 104) +
           (MPI_Recv() == 105) + (MPI_Allreduce() == 106) + (MPI_Bcast() == 107) + (MPI_Ibcast() == 108) +
           (MPI_Comm_dup() == 109) + (MPI_Comm_rank() == 110) + (MPI_Comm_size() == 111) +
           (MPI_Finalize() == 112) + (mpi_init_() == 113) + (mpi_comm_rank_() == 114) + (dmumps_c() == 115);
}

int main(void) {
    enum { FUNCTIONS = 15 };
    outcome o;
    plm_context *ctx = NULL;
    char text[512] = "";
    const int before = own();
    plm_status s = plm_context_create(PLM_API_VERSION, &ctx);
    if (!s) s = whole_run(ctx, CURVE, &o);
    if (s) plm_context_get_error_text(ctx, sizeof text, text, NULL);
    const int others = calls - FUNCTIONS, after = own();
    printf(
        "status %d, %d points, peak %.6g at %.6g Hz; %d calls of others to the host's MPI, %d and %d of %d "
        "its own %s\n",
        (int)s, (int)o.points, o.peak_amplitude, o.peak_hz, others, before, after, FUNCTIONS, text);
    return plm_context_destroy(&ctx) || s < 0 || others != 0 || before != FUNCTIONS || after != FUNCTIONS;
}
