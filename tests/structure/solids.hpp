// Stiffness-like matrices of solids, three DOFs a node, that the tests of orderings and factors share.
#pragma once
#include "matrices.hpp"

namespace test {

/// Springs between the nearest 26 neighbours of a grid of nodes, along x, y and z alike and with a coupling
/// of the three DOFs of each node; held at one face. Positive definite.
inline SparseMatrix solid(std::int64_t nx, std::int64_t ny, std::int64_t nz) {
    vector<std::int64_t> i, j;
    vector<double> v;
    const auto node = [&](std::int64_t x, std::int64_t y, std::int64_t z) { return (z * ny + y) * nx + x; };
    const auto put = [&](std::int64_t a, std::int64_t b, double value) {
        for (std::int64_t c = 0; c < 3; ++c)
            for (std::int64_t d = 0; d < 3; ++d) {
                i.push_back(3 * a + c);
                j.push_back(3 * b + d);
                v.push_back(c == d ? value : 0.1 * value);
            }
    };
    for (std::int64_t z = 0; z < nz; ++z)
        for (std::int64_t y = 0; y < ny; ++y)
            for (std::int64_t x = 0; x < nx; ++x) {
                double held = x == 0 ? 1 : 0;
                for (std::int64_t k = 0; k < 27; ++k) {
                    const std::int64_t p = x + k % 3 - 1, q = y + k / 3 % 3 - 1, r = z + k / 9 - 1;
                    if (k == 13 || p < 0 || p >= nx || q < 0 || q >= ny || r < 0 || r >= nz) continue;
                    put(node(x, y, z), node(p, q, r), -1);
                    held += 1;
                }
                put(node(x, y, z), node(x, y, z), held);
            }
    const std::int64_t n = 3 * nx * ny * nz;
    return plm::from_triplets(n, n, i, j, v);
}

} // namespace test
