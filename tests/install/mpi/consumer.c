/* A mass on a spring by a team of one rank: its frequency is 1 Hz. */
#include <math.h>
#include <mpi.h>
#include <plm/plm_mpi.h>

int main(int argc, char **argv) {
    const int64_t dof = 0;
    const double mass = 1, stiffness = 39.47841760435743;
    double hz = 0;
    plm_team *team = NULL;
    plm_context *ctx = NULL;
    plm_model *model = NULL;
    plm_status status;
    MPI_Init(&argc, &argv);
    status = plm_team_create((int32_t)MPI_Comm_c2f(MPI_COMM_WORLD), 1, &team);
    if (!status) status = plm_team_own_dofs_i64(team, 0, 1, &dof);
    if (!status) status = plm_team_add_entries_i64(team, PLM_MASS, PLM_FULL, 0, 1, &dof, &dof, &mass);
    if (!status)
        status = plm_team_add_entries_i64(team, PLM_STIFFNESS, PLM_FULL, 0, 1, &dof, &dof, &stiffness);
    if (!status) status = plm_context_create(PLM_API_VERSION, &ctx);
    if (!status) status = plm_team_create_model(team, ctx, &model);
    if (!status) status = plm_model_build(model);
    if (!status) status = plm_model_get_modes(model, PLM_SYSTEM_OPEN, NULL, 1, &hz, NULL);
    plm_team_dismiss(team, status);
    plm_context_destroy(&ctx);
    plm_team_destroy(&team);
    MPI_Finalize();
    return !(status == PLM_OK && fabs(hz - 1) < 1e-9);
}
