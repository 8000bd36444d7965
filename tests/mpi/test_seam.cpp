// The structure of libplm over the tall operations of a team, against the same structure with its matrices in
// one process: supports, lowest modes, their count, rigid-body modes, static gaps and responses.
#include "structure/matrix_input.hpp"
#include "structure/structure.hpp"
#include "structure/tall_operations.hpp"
#include "tests/mpi/grid.hpp"
#include <cstdio>

using namespace plm::mpi;
using namespace plm::mpi::test;

namespace {

int failures = 0;

void close_to(const char *what, double got, double wanted, double tolerance) {
    if (std::abs(got - wanted) <= tolerance) return;
    ++failures;
    std::printf("%s: %.15g instead of %.15g\n", what, got, wanted);
}

std::shared_ptr<const plm::MatrixInput> triplets(const Grid &grid, int which) {
    std::vector<std::int64_t> row, col;
    std::vector<double> value;
    grid.springs([&](std::int64_t number, std::int64_t i, std::int64_t j) {
        grid.element(number, i, j, [&](int w, std::int64_t r, std::int64_t c, double v) {
            if (w == which) row.push_back(r), col.push_back(c), value.push_back(v);
        });
    });
    plm::MatrixFormat f;
    f.n = grid.n(), f.nnz = static_cast<std::int64_t>(row.size()), f.storage = plm::storage::triplets;
    return std::make_shared<const plm::MatrixInput>(f, row.data(), col.data(), value.data());
}

/// Two pairs of one direction, and one load.
plm::StructureInput input(const Grid &grid) {
    plm::StructureInput in;
    in.n_dof = grid.n();
    in.gap_row = {0, 0, 1}, in.gap_dof = {5, 17, grid.n() - 3}, in.gap_coefficient = {1, -1, 2};
    return in;
}

plm::Structure structure(const plm::StructureInput &in) {
    return plm::Structure(in, {2, 1}, 0, plm::Solver(), plm::Watch());
}

void compare(const plm::Structure &one, const plm::Structure &many) {
    const auto modes = one.lowest_modes(12), other = many.lowest_modes(12);
    close_to("rigid-body modes", static_cast<double>(many.n_rigid()), static_cast<double>(one.n_rigid()), 0);
    close_to("number of modes", static_cast<double>(other.values.size()),
             static_cast<double>(modes.values.size()), 0);
    for (std::size_t k = 0; k < std::min(modes.values.size(), other.values.size()); ++k)
        close_to("an eigenvalue", other.values[k], modes.values[k], 1e-9 * modes.values.back());
    const double omega = std::sqrt(0.5 * (modes.values[6] + modes.values[7]));
    close_to("the count", static_cast<double>(many.count_modes_below(omega)),
             static_cast<double>(one.count_modes_below(omega)), 0);
    std::vector<double> load(static_cast<std::size_t>(one.n_dof()), 0);
    load[40] = 3, load[70] = -1;
    const auto gaps = one.static_gaps(one.restricted(load.data())),
               others = many.static_gaps(many.restricted(load.data()));
    for (std::size_t k = 0; k < gaps.size(); ++k)
        close_to("a static gap", others[k], gaps[k], 1e-9 * (std::abs(gaps[0]) + std::abs(gaps[1])));
    close_to("the trace of M", many.trace_of_mass(), one.trace_of_mass(), 1e-12 * one.trace_of_mass());
}

void over_a_team(const Grid &grid, bool held) {
    Service s;
    s.start(MPI_COMM_WORLD, grid.n(), {});
    s.parts = grid.parts(s.team().rank(), s.team().size());
    s.parts.matrices.has_damping = false, s.parts.matrices.entries[2].clear();
    if (!held) s.parts.matrices.fixed.clear();
    failures += lead(s, [&] {
        Parts all;
        s.assemble(all);
        plm::StructureInput in = input(grid), tall = in;
        in.mass = triplets(grid, 0), in.stiffness = triplets(grid, 1);
        if (held) in.fixed = {0, grid.n() / 2, grid.n() - 1};
        const auto operations = std::make_shared<plm::TallOperations>(
            [&](std::int32_t operation, const std::int64_t *number, const double *factor, const double *small,
                double *out) {
                Call call;
                call.operation = static_cast<Operation>(operation);
                call.number = number, call.factor = factor, call.in = small, call.out = out;
                s.perform(call);
                return 0;
            });
        tall.mass = tall.stiffness = std::make_shared<const plm::MatrixInput>(operations);
        compare(structure(in), structure(tall));
    });
}

} // namespace

int main(int argc, char **argv) {
    MPI_Init(&argc, &argv);
    over_a_team({14, 13, 12, 0.01, false}, true);
    over_a_team({14, 13, 12, 0, false}, false); // free: one rigid-body mode
    int rank = 0;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    if (rank == 0) std::printf("%d failures\n", failures);
    MPI_Finalize();
    return rank == 0 && failures > 0;
}
