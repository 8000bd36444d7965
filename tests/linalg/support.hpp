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
#include "linalg/dense.hpp"
#include "linalg/error.hpp"
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <new>

namespace test {

using plm::Matrix;
using plm::vector;

struct Outcome {
    int status = plm::status::ok;
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

/// A A^T + I of a random A.
inline Matrix random_definite_dense(std::int64_t n, std::uint64_t seed) {
    const Matrix a = random_matrix(n, n, seed);
    Matrix k = plm::product('N', 'T', a, a);
    for (std::int64_t i = 0; i < n; ++i) k(i, i) += 1;
    return k;
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

} // namespace test
