/* clang-format off */
/* plm_mpi.h - libplm_mpi: a structure that is spread over the ranks of an MPI program.
 *
 * Every rank hands over what it has assembled. Rank 0 makes a model of it all and runs the usual program of plm.h; the
 * others serve meanwhile, with their rows of everything that is as long as the structure. Factorizations are MUMPS's.
 *
 *     plm_team_create(MPI_Comm_c2f(comm), n_dof, &team);               all ranks
 *     plm_team_own_dofs_i64 / add_entries_i64 / fix_dofs_i64 ...       all ranks, each its own part
 *     if (rank == 0) {
 *         plm_team_create_model(team, ctx, &model);                    then plm_model_build(model) ... as ever
 *         plm_team_dismiss(team, status);
 *     } else
 *         status = plm_team_serve(team);                               until rank 0 dismisses
 *     plm_team_destroy(&team);                                         all ranks
 *
 * Rules beside those of plm.h
 *   - MPI must be running; it is neither initialised nor finalised here, and called on the calling thread alone
 *     (MPI_THREAD_FUNNELED will do). The communicator is duplicated: messages of the host and of the team never meet.
 *   - Collective are create and destroy alone, and between them serve against what rank 0 does. A rank whose own call
 *     failed goes on as if it had not: the team remembers, and plm_team_create_model then fails on rank 0 and names it.
 *   - What fails on one rank fails on all, with one status; the text names the rank. No rank is left waiting. (A rank that
 *     ends or dies ends the job, by MPI's launcher.)
 *   - The matrices stay with the ranks: plm_model_set_matrix_i64, plm_model_fix_dofs_i64 and what needs their entries are
 *     refused for the model of a team; plm_model_set_tall_operations says which calls these are.
 */
#ifndef PLM_PLM_MPI_H
#define PLM_PLM_MPI_H

#include "plm.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct plm_team plm_team;

/* Receives a field on the rank that owns these n DOFs (ascending, base 0). The arrays live during the call only. Return 0
 * for success; any other number fails the call that delivers. */
typedef int32_t (*plm_team_field_fn)(plm_team *team, int64_t n, const int64_t *dof, const double *value, void *user);

/* fortran_communicator: MPI_Comm_c2f(comm) in C, `comm` of mpif.h and the module mpi, comm%mpi_val of mpi_f08. n_dof: DOFs of
 * the whole structure, the same number on all ranks. Collective. On failure *team is NULL on all ranks, and
 * plm_team_get_error_text(NULL, ...) says why. */
PLM_API plm_status plm_team_create(int32_t fortran_communicator, int64_t n_dof, plm_team **team);
/* Collective. Rank 0 dismisses the others if that has not been done, and the others serve until then if they have not. Models
 * made of the team are of no use afterwards: what is asked of them is PLM_ERR_CALLBACK. NULL and *team == NULL: nothing is
 * done. *team becomes NULL. */
PLM_API plm_status plm_team_destroy(plm_team **team);

/* What this rank owns: any DOFs, in any order and in any number of calls; each DOF has one owner in the end. The owner
 * keeps the row of the DOF. index_base: 0 or 1, here and below. */
PLM_API plm_status plm_team_own_dofs_i64(plm_team *team, int32_t index_base, int64_t n, const int64_t *dof);
/* Entries of a matrix (PLM_MASS, PLM_STIFFNESS, PLM_DAMPING) as this rank has assembled them, in numbers of the whole
 * structure; of any DOFs, owned here or not. What comes for one place, from one rank or from several, is summed.
 * part: PLM_FULL both triangles, PLM_LOWER or PLM_UPPER one. In any number of calls. */
PLM_API plm_status plm_team_add_entries_i64(plm_team *team, int32_t which, int32_t part, int32_t index_base, int64_t n,
                                            const int64_t *row, const int64_t *column, const double *value);
/* DOFs held at zero; by any rank, or by several. */
PLM_API plm_status plm_team_fix_dofs_i64(plm_team *team, int32_t index_base, int64_t n, const int64_t *dof);
/* As plm_model_add_gap_rows_i64. A row comes whole, from one rank; its DOFs may be owned anywhere. Pairs are numbered from
 * rank 0's rows on to those of the last rank. */
PLM_API plm_status plm_team_add_gap_rows_i64(plm_team *team, int32_t index_base, int64_t n, const int64_t *row_ptr,
                                             const int64_t *dof, const double *coefficient, const double *stiffness,
                                             const double *gap);
/* Static pre-load at some DOFs; what comes for one DOF is summed, over calls and ranks. */
PLM_API plm_status plm_team_add_preload_i64(plm_team *team, int32_t index_base, int64_t n, const int64_t *dof,
                                            const double *force);
/* Harmonic >= 0 of the excitation at some DOFs, as plm_model_set_excitation; imag or NULL (zero). Summed likewise. */
PLM_API plm_status plm_team_add_excitation_i64(plm_team *team, int32_t harmonic, int32_t index_base, int64_t n,
                                               const int64_t *dof, const double *real, const double *imag);
/* Who receives fields on this rank; fn NULL: nobody. */
PLM_API plm_status plm_team_set_field(plm_team *team, plm_team_field_fn fn, void *user);

/* Rank 0: sums up what the ranks have added and makes a model of it in `ctx`, with gap rows, pre-load and excitation, once
 * for a team. Damping other than PLM_DAMPING, options and whatever else is small follow by the usual calls, then
 * plm_model_build. The model goes before or with its context, and belongs to the calling thread as that does. */
PLM_API plm_status plm_team_create_model(plm_team *team, plm_context *ctx, plm_model **model);
/* Rank 0: each rank's function receives its part of n_dof values, such as those of plm_branch_get_displacement. */
PLM_API plm_status plm_team_deliver(plm_team *team, int64_t n_dof, const double *value);
/* Rank 0: the others come back from plm_team_serve, with `outcome` as its status and the error text of the context. Doing it
 * again does nothing. */
PLM_API plm_status plm_team_dismiss(plm_team *team, plm_status outcome);
/* Ranks other than 0: does what rank 0 says until it dismisses. Waits asleep, so that its core is free meanwhile. Returns
 * what rank 0 gave as outcome; PLM_ERR_STATE on rank 0. */
PLM_API plm_status plm_team_serve(plm_team *team);

/* Of the last call of this team that failed on this rank; NULL: of the last plm_team_create on this thread. As
 * plm_context_get_error_text. */
PLM_API plm_status plm_team_get_error_text(plm_team *team, int64_t capacity, char *buffer, int64_t *needed);

#ifdef __cplusplus
}
#endif

#endif
