// A mass on a spring by a team of one rank: its frequency is 1 Hz.
#include <cmath>
#include <mpi.h>
#include <plm/plm_mpi.hpp>

int main(int argc, char **argv) {
    MPI_Init(&argc, &argv);
    double hz = 0;
    {
        plm::Team team(MPI_Comm_c2f(MPI_COMM_WORLD), 1);
        team.own_dofs({0});
        team.add_entries(PLM_MASS, {0}, {0}, {1.0});
        team.add_entries(PLM_STIFFNESS, {0}, {0}, {39.47841760435743});
        const plm::Context ctx;
        plm::Model model = team.create_model(ctx);
        model.build();
        hz = model.modes(PLM_SYSTEM_OPEN, 1).frequency_hz[0];
        team.dismiss();
    }
    MPI_Finalize();
    return !(std::abs(hz - 1) < 1e-9);
}
