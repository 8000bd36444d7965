// A structure on a grid whose parts any number of ranks assemble, and its dense matrices.
#pragma once
#include "mpi/service.hpp"
#include <algorithm>
#include <cmath>
#include <cstdio>

namespace plm::mpi::test {

inline std::uint64_t mixed(std::uint64_t k) {
    k = (k ^ (k >> 30)) * 0xbf58476d1ce4e5b9u;
    return k ^ (k >> 27);
}

/// Nodes of an nx x ny x nz grid, one DOF each, joined by springs to their neighbours and by another one to
/// the ground; each spring brings a consistent mass. Owners of DOFs and of springs are drawn by chance.
struct Grid {
    std::int64_t nx, ny, nz;
    double ground = 0.01;
    bool idle_rank = false; // rank 1 has nothing

    std::int64_t n() const { return nx * ny * nz; }
    int owner(std::int64_t k, int size) const {
        int r =
            static_cast<int>(mixed(static_cast<std::uint64_t>(k) + 17) % static_cast<std::uint64_t>(size));
        return idle_rank && r == 1 ? 0 : r;
    }
    template <class Spring> void springs(Spring spring) const { // spring(number, one DOF, other DOF)
        std::int64_t number = 0;
        for (std::int64_t z = 0; z < nz; ++z)
            for (std::int64_t y = 0; y < ny; ++y)
                for (std::int64_t x = 0; x < nx; ++x) {
                    const std::int64_t i = x + nx * (y + ny * z);
                    if (x + 1 < nx) spring(number++, i, i + 1);
                    if (y + 1 < ny) spring(number++, i, i + nx);
                    if (z + 1 < nz) spring(number++, i, i + nx * ny);
                }
    }
    /// Entries of both triangles, as an element matrix has them: add(which, row, column, value).
    template <class Add> void element(std::int64_t number, std::int64_t i, std::int64_t j, Add add) const {
        const double k = 1 + 0.5 * std::sin(static_cast<double>(number)),
                     m = 0.1 + 0.01 * std::cos(static_cast<double>(number));
        for (const auto &[row, col] : {std::pair(i, i), {j, j}, {i, j}, {j, i}}) {
            add(0, row, col, row == col ? 2 * m : m);
            add(1, row, col, row == col ? k + ground : -k);
            add(2, row, col, row == col ? 0.3 * k : -0.1 * k);
        }
    }
    /// Supports at the first few DOFs.
    std::vector<std::int64_t> fixed() const { return {0, n() / 2, n() - 1}; }

    Parts parts(int rank, int size) const {
        Parts p;
        for (std::int64_t k = 0; k < n(); ++k)
            if (owner(k, size) == rank) p.owned.push_back(k);
        springs([&](std::int64_t number, std::int64_t i, std::int64_t j) {
            if (owner(number + 7, size) != rank) return;
            element(number, i, j, [&](int which, std::int64_t row, std::int64_t col, double v) {
                const double skew = row == col ? 0 : row > col ? v / 2 : -v / 2;
                p.matrices.entries[static_cast<std::size_t>(which)].add(
                    {static_cast<std::int32_t>(std::max(row, col)),
                     static_cast<std::int32_t>(std::min(row, col)), row == col ? v : v / 2, skew});
            });
        });
        if (rank == size - 1) p.matrices.fixed = fixed();
        p.matrices.has_damping = true;
        return p;
    }
    /// M, K, C, column-major, empty rows at supports.
    std::vector<double> dense(int which) const {
        std::vector<double> a(static_cast<std::size_t>(n() * n()), 0);
        springs([&](std::int64_t number, std::int64_t i, std::int64_t j) {
            element(number, i, j, [&](int w, std::int64_t row, std::int64_t col, double v) {
                if (w == which) a[static_cast<std::size_t>(row + col * n())] += v;
            });
        });
        for (std::int64_t f : fixed())
            for (std::int64_t k = 0; k < n(); ++k)
                a[static_cast<std::size_t>(f + k * n())] = a[static_cast<std::size_t>(k + f * n())] = 0;
        return a;
    }
};

/// A team's life: the brain works, the others serve. Returns 1 where the work ends with an error.
template <class Work> int lead(Service &s, Work work) {
    int failures = 0;
    if (s.team().is_brain()) {
        try {
            work();
        } catch (const std::exception &e) {
            ++failures;
            std::printf("an error: %s\n", e.what());
        }
        s.dismiss({});
    } else {
        s.serve();
    }
    s.close();
    return failures;
}

/// One operation from the brain.
inline std::vector<double> perform(Service &s, Operation operation, const std::vector<std::int64_t> &number,
                                   const std::vector<double> &factor = {}, const std::vector<double> &in = {},
                                   std::int64_t out = 0) {
    std::vector<double> result(static_cast<std::size_t>(out), 0);
    Call call;
    call.operation = operation;
    call.number = number.data(), call.factor = factor.data(), call.in = in.data(), call.out = result.data();
    s.perform(call);
    return result;
}

} // namespace plm::mpi::test
