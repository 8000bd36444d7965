// Sparse matrices that the tests of structure share.
#pragma once
#include "linalg/support.hpp"
#include "structure/sparse.hpp"

namespace test {

using plm::SparseMatrix;

inline SparseMatrix diagonal(const vector<double> &d) {
    const auto n = static_cast<std::int64_t>(d.size());
    vector<std::int64_t> i(n);
    for (std::int64_t j = 0; j < n; ++j) i[j] = j;
    return plm::from_triplets(n, n, i, i, d);
}

/// Five-point Laplacian of an nx x ny membrane; fixed rim, or free rim (singular: one rigid mode).
inline SparseMatrix membrane(std::int64_t nx, std::int64_t ny, bool fixed = true) {
    vector<std::int64_t> i, j;
    vector<double> v;
    const auto put = [&](std::int64_t a, std::int64_t b, double value) {
        i.push_back(a);
        j.push_back(b);
        v.push_back(value);
    };
    for (std::int64_t y = 0; y < ny; ++y)
        for (std::int64_t x = 0; x < nx; ++x)
            for (const auto &step : {std::pair<int, int>{-1, 0}, {1, 0}, {0, -1}, {0, 1}}) {
                const std::int64_t at = y * nx + x, px = x + step.first, py = y + step.second;
                const bool inside = px >= 0 && px < nx && py >= 0 && py < ny;
                if (inside || fixed) put(at, at, 1);
                if (inside) put(at, py * nx + px, -1);
            }
    return plm::from_triplets(nx * ny, nx * ny, i, j, v);
}

/// Sparse random symmetric matrix with a dominant diagonal: positive definite.
inline SparseMatrix random_definite(std::int64_t n, std::uint64_t seed) {
    Random random(seed);
    vector<std::int64_t> i, j;
    vector<double> v;
    for (std::int64_t a = 0; a < n; ++a) {
        i.push_back(a);
        j.push_back(a);
        v.push_back(8 + random());
        for (int k = 0; k < 3; ++k) {
            const auto b = static_cast<std::int64_t>((random() + 1) / 2 * static_cast<double>(n));
            const double value = random();
            for (int side = 0; side < 2; ++side) {
                i.push_back(side ? a : b);
                j.push_back(side ? b : a);
                v.push_back(value);
            }
        }
    }
    return plm::from_triplets(n, n, i, j, v);
}

} // namespace test
