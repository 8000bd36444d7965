// The order of elimination that a team finds: the DOFs of a node stay together, and it is the same on any
// number of ranks, also where nodes are owned by chance.
#include "mpi/node_order.hpp"
#include "tests/mpi/grid.hpp"
#include <cstdio>

using namespace plm::mpi;
using namespace plm::mpi::test;

namespace {

constexpr std::int64_t per_node = 3;

/// Nodes of a grid with three DOFs each; the first node is held. Every rank assembles what it owns.
MatrixParts assembled(const Grid &grid, const std::vector<std::int64_t> &owned) {
    MatrixParts parts;
    const auto join = [&](std::int64_t v, std::int64_t w) {
        for (std::int64_t i = per_node * v; i < per_node * (v + 1); ++i)
            for (std::int64_t j = per_node * w; j < per_node * (w + 1); ++j)
                if (i >= j && std::binary_search(owned.begin(), owned.end(), i))
                    parts.entries[1].add(
                        {static_cast<std::int32_t>(i), static_cast<std::int32_t>(j), i == j ? 9.0 : -0.1, 0});
    };
    for (std::int64_t v = 0; v < grid.n(); ++v) join(v, v);
    grid.springs([&](std::int64_t, std::int64_t v, std::int64_t w) { join(std::max(v, w), std::min(v, w)); });
    parts.fixed = {0, 1, 2};
    return parts;
}

NodeOrder order_on(MPI_Comm comm, const Grid &grid) {
    Team team;
    team.start(comm, {});
    std::vector<std::int64_t> owned;
    for (std::int64_t dof = 0; dof < per_node * grid.n(); ++dof)
        if (grid.owner(dof / per_node, team.size()) == team.rank()) owned.push_back(dof);
    MatrixParts parts = assembled(grid, owned);
    const Rows rows(team, per_node * grid.n(), owned);
    const Matrices matrices(team, rows, parts);
    const std::int64_t row[] = {per_node * grid.n() - 1}, column[] = {4}; // two far ends, by an added spring
    NodeOrder order = order_of_nodes(team, rows, matrices, {row, column, team.is_brain() ? 1 : 0});
    team.close();
    return order;
}

bool keeps_nodes_together(const NodeOrder &order, std::int64_t nodes) {
    std::vector<MUMPS_INT> sorted = order.position;
    std::sort(sorted.begin(), sorted.end());
    bool good = static_cast<std::int64_t>(sorted.size()) == per_node * nodes;
    for (std::size_t k = 0; k < sorted.size(); ++k) good = good && sorted[k] == static_cast<MUMPS_INT>(k) + 1;
    for (std::size_t dof = per_node; good && dof < sorted.size();
         dof += per_node) // not of the one that is held
        for (std::size_t d = 1; d < per_node; ++d)
            good = good && order.position[dof + d] == order.position[dof] + static_cast<MUMPS_INT>(d);
    return good && static_cast<std::int64_t>(order.first.size()) == nodes - 1 + per_node + 1;
}

} // namespace

int main(int argc, char **argv) {
    MPI_Init(&argc, &argv);
    const Grid grid{7, 6, 5};
    int rank = 0, failures = 0;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    const NodeOrder all = order_on(MPI_COMM_WORLD, grid), alone = order_on(MPI_COMM_SELF, grid);
    if (rank == 0 && !alone.position.empty()) { // else SCOTCH was left out
        failures += !keeps_nodes_together(all, grid.n()) + !keeps_nodes_together(alone, grid.n());
        failures += all.position != alone.position;
    }
    if (rank > 0) failures += !all.position.empty();
    if (failures) std::printf("rank %d: %d failures\n", rank, failures);
    MPI_Finalize();
    return failures > 0;
}
