// The count of negative eigenvalues where the root of the elimination tree is so large that MUMPS would leave
// it to ScaLAPACK, whose factors with exchanged rows do not tell them. The root is a full matrix of chosen
// eigenvalues whose diagonal next to vanishes. MUMPS does so only where branches hang on the root: here four
// sparse grids, by a congruence, so that the inertia of all is that of its parts.
#include "tests/mpi/grid.hpp"
#include <cstdio>
#include <cstdlib>

using namespace plm::mpi;
using namespace plm::mpi::test;

namespace {

constexpr std::int64_t side = 24, branches = 4; // nodes along a grid; grids

/// A = H P H with the reflection H = I - 2 v v^T, v alike everywhere, and pairs of DOFs [0 d; d 0] in P:
/// eigenvalues +-d, d = 2/n, 4/n, ... 1; unit masses.
double full_entry(std::int64_t n, std::int64_t i, std::int64_t j) {
    const auto d = [&](std::int64_t k) {
        return static_cast<double>(k / 2 + 1) / static_cast<double>(n / 2);
    };
    const double share = 1 / static_cast<double>(n), energy = 0.5 * (1 + 2 * share); // v_i v_j, v^T P v
    return share * (4 * energy - 2 * (d(i) + d(j))) + (i == j + 1 && i % 2 == 1 ? d(i) : 0);
}

/// K = [A + L^T D L, L^T D; D L, D], where D is a grid of springs to the ground and to neighbours, with no
/// mass, and L has ones where the first nodes of a grid meet DOFs of A. DOFs of A come first.
struct Builder {
    std::int64_t n;
    Parts p;
    void add(std::int64_t i, std::int64_t j, double v) {
        p.matrices.entries[1].add(
            {static_cast<std::int32_t>(std::max(i, j)), static_cast<std::int32_t>(std::min(i, j)), v, 0});
    }
    /// Entry (i, j) of D, i >= j, of a branch; what it brings to each block of K.
    void spread(std::int64_t branch, std::int64_t i, std::int64_t j, double v) {
        const std::int64_t first = n + branch * side * side;
        const auto met = [&](std::int64_t k) { // the DOF of A that node k meets, or none
            return k < n / branches ? branch * (n / branches) + k : -1;
        };
        add(first + i, first + j, v);
        if (met(j) >= 0) add(first + i, met(j), v);
        if (i != j && met(i) >= 0) add(first + j, met(i), v);
        if (met(i) >= 0 && met(j) >= 0) add(met(i), met(j), v);
    }
};

/// DOFs are owned, and rows assembled, by slices.
Parts slice(std::int64_t n, int rank, int size) {
    Builder b{n, {}};
    const std::int64_t all = n + branches * side * side;
    for (std::int64_t i = 0; i < all; ++i) {
        if (i * size / all != rank) continue;
        b.p.owned.push_back(i);
        if (i < n) {
            b.p.matrices.entries[0].add({static_cast<std::int32_t>(i), static_cast<std::int32_t>(i), 1, 0});
            for (std::int64_t j = 0; j <= i; ++j) b.add(i, j, full_entry(n, i, j));
        } else {
            const std::int64_t branch = (i - n) / (side * side), node = (i - n) % (side * side);
            b.spread(branch, node, node, 4.5);
            if (node % side > 0) b.spread(branch, node, node - 1, -1);
            if (node >= side) b.spread(branch, node, node - side, -1);
        }
    }
    return b.p;
}

} // namespace

int main(int argc, char **argv) {
    MPI_Init(&argc, &argv);
    int failures = 0;
    const std::int64_t n = argc > 1 ? std::atoi(argv[1]) : 1600;
    Service s;
    s.start(MPI_COMM_WORLD, n + branches * side * side, {});
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
