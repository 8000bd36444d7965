// The count of negative eigenvalues where the root of the elimination tree is so large that MUMPS would leave
// it to ScaLAPACK, whose factors with exchanged rows do not tell them. A full matrix is nothing but a root;
// its diagonal next to vanishes, and its eigenvalues are chosen.
#include "tests/mpi/grid.hpp"
#include <cstdio>
#include <cstdlib>

using namespace plm::mpi;
using namespace plm::mpi::test;

namespace {

/// H P H with the reflection H = I - 2 v v^T, v alike everywhere, and pairs of DOFs [0 d; d 0] in P:
/// eigenvalues
/// +-d, d = 2/n, 4/n, ... 1; unit masses. DOFs are owned, and rows assembled, by slices.
Parts slice(std::int64_t n, int rank, int size) {
    Parts p;
    const auto d = [&](std::int64_t i) {
        return static_cast<double>(i / 2 + 1) / static_cast<double>(n / 2);
    };
    const double share = 1 / static_cast<double>(n), energy = 0.5 * (1 + 2 * share); // v_i v_j, v^T P v
    for (std::int64_t i = 0; i < n; ++i) {
        if (i * size / n != rank) continue;
        p.owned.push_back(i), p.matrices.entries[0].push_back({i, i, 1, 0});
        for (std::int64_t j = 0; j <= i; ++j)
            p.matrices.entries[1].push_back(
                {i, j, share * (4 * energy - 2 * (d(i) + d(j))) + (i == j + 1 && i % 2 == 1 ? d(i) : 0), 0});
    }
    return p;
}

} // namespace

int main(int argc, char **argv) {
    MPI_Init(&argc, &argv);
    int failures = 0;
    const std::int64_t n = argc > 1 ? std::atoi(argv[1]) : 1600;
    Service s;
    s.start(MPI_COMM_WORLD, n, {});
    s.parts = slice(n, s.team().rank(), s.team().size());
    failures += lead(s, [&] {
        Parts all;
        s.assemble(all);
        for (double shift : {0.0303, 0.5003}) {
            const auto said = perform(s, Operation::factor, {1, 1, 0, 0}, {-shift, 1, 0}, {}, 8);
            const double wanted = static_cast<double>(n / 2) + std::floor(shift * static_cast<double>(n / 2));
            failures += said[0] != wanted || said[3] != 0;
            std::printf("%lld DOFs, %d ranks: %g of %g eigenvalues below %g\n", static_cast<long long>(n),
                        s.team().size(), said[0], wanted, shift);
        }
    });
    MPI_Finalize();
    return failures > 0;
}
