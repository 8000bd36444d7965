// The count of negative eigenvalues where the root of the elimination tree is so large that MUMPS would leave
// it to ScaLAPACK, which hides its negative pivots. The truth is a closed form: eigenvalues of a grid of
// equal springs and masses.
#include "tests/mpi/grid.hpp"
#include <cstdio>
#include <cstdlib>

using namespace plm::mpi;
using namespace plm::mpi::test;

namespace {

/// Equal springs between the nodes of a grid, unit masses. DOFs are owned, and springs assembled, by slices.
Parts slice(const Grid &g, int rank, int size) {
    Parts p;
    const auto owner = [&](std::int64_t k) { return static_cast<int>(k * size / g.n()); };
    for (std::int64_t k = 0; k < g.n(); ++k)
        if (owner(k) == rank) p.owned.push_back(k), p.matrices.entries[0].push_back({k, k, 1, 0});
    g.springs([&](std::int64_t, std::int64_t i, std::int64_t j) {
        if (owner(i) != rank) return;
        auto &k = p.matrices.entries[1];
        k.push_back({i, i, 1, 0}), k.push_back({j, j, 1, 0}), k.push_back({j, i, -1, 0});
    });
    return p;
}

double eigenvalues_below(const Grid &g, double limit) {
    const auto path = [](std::int64_t mode, std::int64_t n) {
        return 2 - 2 * std::cos(M_PI * static_cast<double>(mode) / static_cast<double>(n));
    };
    double count = 0;
    for (std::int64_t a = 0; a < g.nx; ++a)
        for (std::int64_t b = 0; b < g.ny; ++b)
            for (std::int64_t c = 0; c < g.nz; ++c)
                count += path(a, g.nx) + path(b, g.ny) + path(c, g.nz) < limit;
    return count;
}

} // namespace

int main(int argc, char **argv) {
    MPI_Init(&argc, &argv);
    int failures = 0;
    const std::int64_t edge = argc > 1 ? std::atoi(argv[1]) : 32;
    const Grid grid{edge, edge, edge + 1};
    Service s;
    s.start(MPI_COMM_WORLD, grid.n(), {});
    s.parts = slice(grid, s.team().rank(), s.team().size());
    if (s.team().is_brain()) {
        Parts all;
        s.assemble(all);
        for (double shift : {0.05, 0.2}) {
            const double begin = MPI_Wtime();
            const auto said = perform(s, Operation::factor, {1, 1, 0, 0}, {-shift, 1, 0}, {}, 8);
            const double wanted = eigenvalues_below(grid, shift);
            failures += said[0] != wanted || said[3] != 0;
            std::printf("%lld DOFs, %d ranks: %g of %g eigenvalues below %g, %.1f s\n",
                        static_cast<long long>(grid.n()), s.team().size(), said[0], wanted, shift,
                        MPI_Wtime() - begin);
        }
        s.dismiss({});
    } else {
        s.serve();
    }
    s.close();
    MPI_Finalize();
    return failures > 0;
}
