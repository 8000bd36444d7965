// plm_mpi.hpp on ranks of a chain of masses, against the same chain as a model of one process; then what
// throws on one rank: its words, and that no rank is left waiting.
#include "plm/plm_mpi.hpp"
#include <cmath>
#include <cstdio>
#include <mpi.h>

namespace {

constexpr std::int64_t n = 12;
int rank, size, failures;

void expect(bool holds, const char *what) {
    if (holds) return;
    ++failures;
    std::printf("rank %d of %d: %s\n", rank, size, what);
}

double mass(std::int64_t i) {
    return 1 + 0.01 * static_cast<double>(i + 1);
}
double spring(std::int64_t i) {
    return 1 + 0.1 * static_cast<double>(i + 1);
}

/// Masses and springs (spring i holds mass i to the one before) from `first` on in steps.
template <class AddMass, class AddSpring>
void chain(std::int64_t first, std::int64_t step, AddMass add_mass, AddSpring add_spring) {
    for (std::int64_t i = first; i < n; i += step) {
        add_mass(i, mass(i));
        add_spring(i, i, spring(i));
        if (i > 0) add_spring(i, i - 1, -spring(i)), add_spring(i - 1, i - 1, spring(i));
    }
}

void hand_over(plm::Team &team) {
    std::vector<std::int32_t> own;
    for (std::int32_t i = rank; i < n; i += size) own.push_back(i);
    team.own_dofs(own);
    chain(
        rank, size,
        [&](std::int64_t i, double m) { team.add_entries(PLM_MASS, std::vector{i}, std::vector{i}, {m}); },
        [&](std::int64_t i, std::int64_t j, double k) {
            team.add_entries(PLM_STIFFNESS, std::vector{i}, std::vector{j}, {k}, PLM_LOWER);
        });
    if (rank < size - 1) return;
    team.add_gap_rows({0, 1}, {11}, {1.0}, {5.0}, {0.0});
    team.add_preload({12}, {0.3}, 1);
    team.add_excitation(1, {11}, {0.5});
}

plm::Model whole(const plm::Context &ctx) {
    std::vector<std::int64_t> row, column, diagonal;
    std::vector<double> k, m, force(n, 0.0);
    chain(
        0, 1, [&](std::int64_t i, double v) { diagonal.push_back(i), m.push_back(v); },
        [&](std::int64_t i, std::int64_t j, double v) {
            row.push_back(i), column.push_back(j), k.push_back(v);
        });
    plm::Model model(ctx, n);
    model.set_mass(plm::triplets(diagonal, diagonal, m));
    model.set_stiffness(plm::triplets(row, column, k).lower());
    model.add_gap_rows({0, 1}, {11}, {1.0}, {5.0}, {0.0});
    force[n - 1] = 0.3, model.set_preload(force);
    force[n - 1] = 0.5, model.set_excitation(1, force);
    return model;
}

std::vector<double> look(plm::Model &model) {
    model.set_rayleigh_damping(0, 0.1);
    model.build();
    std::vector<double> numbers = model.modes(PLM_SYSTEM_SLIDING, 5).frequency_hz;
    const plm::Response r = model.compute_response(n - 1);
    numbers.push_back(r.frequency_hz), numbers.push_back(r.amplitude);
    return numbers;
}

void over_ranks() {
    plm::Team first(MPI_Comm_c2f(MPI_COMM_WORLD), n), team = std::move(first);
    double sum = 0;
    team.on_field([&](plm::View<std::int64_t> dof, plm::Reals value) {
        for (std::int64_t k = 0; k < dof.size(); ++k)
            sum += value.data()[k] * static_cast<double>(dof.data()[k] % size == rank);
    });
    hand_over(team);
    if (rank == 0) {
        const plm::Context ctx;
        plm::Model one = whole(ctx), many = team.create_model(ctx);
        const std::vector<double> wanted = look(one), got = look(many);
        for (std::size_t k = 0; k < wanted.size(); ++k)
            expect(std::abs(got[k] - wanted[k]) <= 1e-8 * wanted[k], "a number is not that of one process");
        team.deliver(std::vector<double>(n, 1.0));
        team.dismiss();
    } else {
        expect(team.serve() == PLM_OK, "serve");
    }
    double all = 0;
    MPI_Allreduce(&sum, &all, 1, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
    expect(all == n, "a field is not delivered to its owners");
}

/// Runs f with a team on all ranks and returns what was thrown here; the team goes with the exception.
template <class F> plm::Error thrown_by(F f) {
    try {
        plm::Team team(MPI_Comm_c2f(MPI_COMM_WORLD), n);
        f(team);
    } catch (const plm::Error &e) {
        return e;
    }
    return plm::Error("nothing", {});
}

void lead(plm::Team &team) {
    const plm::Context ctx;
    if (rank == 0)
        team.create_model(ctx);
    else
        team.serve();
}

void refused() {
    plm::Error e =
        thrown_by([](plm::Team &team) { // rank 0 leaves by the exception: that dismisses the others
            hand_over(team);
            if (rank == size - 1) try {
                    team.fix_dofs({-1});
                } catch (const plm::Error &mine) {
                    expect(mine.status() == PLM_ERR_ARGUMENT && mine.function() == "plm_team_fix_dofs_i64",
                           mine.what());
                }
            lead(team);
        });
    expect(e.status() == (rank == 0 ? PLM_ERR_ARGUMENT : PLM_ERR_STATE), e.what());
    e = thrown_by([](plm::Team &team) { // the last rank leaves at once: rank 0 goes on, and fails by what was
                                        // not handed over
        if (rank == size - 1) throw plm::Error("its own", {});
        hand_over(team);
        lead(team);
    });
    expect(rank == size - 1 ? std::string(e.what()) == "its own" : e.status() < 0, e.what());
    e = thrown_by([](plm::Team &team) { team.add_entries(PLM_MASS, {0}, {0, 1}, {1.0}); });
    expect(e.status() == PLM_ERR_ARGUMENT && e.argument() == "column", e.what());
    e = thrown_by(
        [](plm::Team &team) { // a receiver that throws: its own exception there, words of it elsewhere
            team.on_field([](plm::View<std::int64_t>, plm::Reals) {
                if (rank == size - 1) throw plm::Error("cannot receive", {});
            });
            hand_over(team);
            const plm::Context ctx;
            if (rank > 0) {
                team.serve();
                return;
            }
            plm::Model model = team.create_model(ctx);
            team.deliver(std::vector<double>(n, 1.0));
        });
    expect(rank == size - 1 ? std::string(e.what()) == "cannot receive" : e.status() < 0, e.what());
}

} // namespace

int main(int argc, char **argv) {
    int all = 0;
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &size);
    over_ranks();
    refused();
    MPI_Allreduce(&failures, &all, 1, MPI_INT, MPI_SUM, MPI_COMM_WORLD);
    MPI_Finalize();
    return all > 0;
}
