// What the linalg tests share: cmocka, small model problems, and errors as values. cmocka's assertions
// long-jump, so they stand only where nothing on the stack needs a destructor that matters: a test computes
// in a helper, then asserts.
#pragma once
#include <csetjmp>
#include <cstdarg>
#include <cstddef>
#include <cstdint>
extern "C" {
#include <cmocka.h>
}
#undef fail // cmocka's macro breaks std::ios, whichever header brings that in
#include "linalg/error.hpp"
#include "linalg/make_factor.hpp"
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <new>

namespace test {

using plm::Matrix;
using plm::SparseMatrix;
using plm::vector;

struct Outcome {
    int status = PLM_OK;
    int reason = 0;
    std::int64_t index = -1, code = 0;
};
constexpr int bad_alloc = 1000, unknown_exception = 1001;

template <class Work> Outcome outcome_of(Work work) {
    try {
        work();
    } catch (const plm::Error &e) {
        return {e.status(), e.reason(), e.index(), e.library_code()};
    } catch (const std::bad_alloc &) {
        return {bad_alloc, 0, -1, 0};
    } catch (...) {
        return {unknown_exception, 0, -1, 0};
    }
    return {};
}

/// Uniform in (-1, 1), the same on every machine.
class Random {
  public:
    explicit Random(std::uint64_t seed) : state_(seed * 2 + 1) {}
    double operator()() {
        state_ = state_ * 6364136223846793005u + 1442695040888963407u;
        return static_cast<double>(state_ >> 11) * 0x1p-52 - 1;
    }

  private:
    std::uint64_t state_;
};

inline Matrix random_matrix(std::int64_t rows, std::int64_t cols, std::uint64_t seed) {
    Random random(seed);
    Matrix a(rows, cols);
    for (std::int64_t i = 0; i < rows * cols; ++i) a.data()[i] = random();
    return a;
}

inline double max_abs(const Matrix &a) {
    double largest = 0;
    for (std::int64_t i = 0; i < a.rows() * a.cols(); ++i)
        largest = std::max(largest, std::isnan(a.data()[i]) ? INFINITY : std::fabs(a.data()[i]));
    return largest;
}
inline double max_difference(Matrix a, const Matrix &b) {
    if (a.rows() != b.rows() || a.cols() != b.cols()) return INFINITY;
    for (std::int64_t i = 0; i < a.rows() * a.cols(); ++i) a.data()[i] -= b.data()[i];
    return max_abs(a);
}
/// |X^T Y - I|
inline double distance_from_identity(const Matrix &x, const Matrix &y) {
    Matrix gram = plm::product('T', 'N', x, y);
    for (std::int64_t i = 0; i < gram.rows(); ++i) gram(i, i) -= 1;
    return max_abs(gram);
}

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
