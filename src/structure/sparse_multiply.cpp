// Sparse matrix times vector and times a block of columns.
#include "linalg/blas_lapack.hpp"
#include "linalg/parallel.hpp"
#include "structure/sparse.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

/// Columns served by one pass over the matrix: their rows are packed side by side, so that each stored entry
/// is read once for all of them and one cache line of X (or Y) serves it.
constexpr std::int64_t panel = 8;

void pack_columns(const double *x, std::int64_t ld, std::int64_t first, std::int64_t last, std::int64_t width,
                  double *packed) {
    for (std::int64_t i = first; i < last; ++i)
        for (std::int64_t c = 0; c < panel; ++c) packed[i * panel + c] = c < width ? x[i + c * ld] : 0;
}

void unpack(const double *packed, std::int64_t rows, std::int64_t width, double *y, std::int64_t ld) {
    for (std::int64_t c = 0; c < width; ++c)
        for (std::int64_t i = 0; i < rows; ++i) y[i + c * ld] = packed[i * panel + c];
}

/// columns(first, width, packed) for each panel of a product, with room for a packed panel of so many rows;
/// shared out where that is worth a thread.
template <class Columns>
void for_panels(const SparseMatrix &a, std::int64_t cols, std::int64_t packed_rows, Columns columns) {
    constexpr double worth_a_thread = 2e6; // flops of a panel, about a millisecond
    const std::int64_t panels = (cols + panel - 1) / panel;
    const bool worth = 2.0 * panel * static_cast<double>(a.nnz()) > worth_a_thread;
    const std::int64_t runs = std::min(panels, worth ? threads_at_hand() : 1);
    parallel_for(runs, [&](std::int64_t run) {
        vector<double> packed(packed_rows * panel);
        for (std::int64_t k = run * panels / runs; k < (run + 1) * panels / runs; ++k)
            columns(k * panel, std::min(panel, cols - k * panel), packed);
    });
}

/// op(A) x and op(A) X by BLAS, for a matrix that is dense.
void dense_times(char op, const SparseMatrix &a, const double *x, double *y) {
    const blas_int rows = to_blas(a.rows), cols = to_blas(a.cols), step = 1;
    const double one = 1, zero = 0;
    dgemv_(&op, &rows, &cols, &one, a.val.data(), &rows, x, &step, &zero, y, &step, 1);
}
Matrix dense_times(char op, const SparseMatrix &a, const Matrix &x) {
    Matrix y(op == 'N' ? a.rows : a.cols, x.cols());
    const blas_int m = to_blas(y.rows()), n = to_blas(y.cols()), k = to_blas(x.rows()), lda = to_blas(a.rows);
    const double one = 1, zero = 0;
    dgemm_(&op, "N", &m, &n, &k, &one, a.val.data(), &lda, x.data(), &k, &zero, y.data(), &m, 1, 1);
    return y;
}

/// A sum in twice the digits (Ogita, Rump and Oishi, Accurate sum and dot product, 2005).
class LongSum {
  public:
    void add(double a, double b) {
        const double product = a * b, sum = sum_ + product, was = sum - sum_;
        rest_ += ((sum_ - (sum - was)) + (product - was)) + std::fma(a, b, -product);
        sum_ = sum;
    }
    double high() const { return sum_; }
    double low() const { return rest_; }

  private:
    double sum_ = 0, rest_ = 0;
};

} // namespace

void multiply(const SparseMatrix &a, const double *x, double *y) {
    if (is_dense(a)) return dense_times('N', a, x, y);
    std::fill_n(y, a.rows, 0.0);
    for (std::int64_t j = 0; j < a.cols; ++j) {
        const double factor = x[j];
        for (std::int64_t p = a.ptr[j]; p < a.ptr[j + 1]; ++p) y[a.idx[p]] += a.val[p] * factor;
    }
}

void multiply_transposed(const SparseMatrix &a, const double *x, double *y) {
    if (is_dense(a)) return dense_times('T', a, x, y);
    const std::int64_t *idx = a.idx.data();
    const double *val = a.val.data();
    for (std::int64_t j = 0; j < a.cols; ++j) {
        const std::int64_t begin = a.ptr[j], end = a.ptr[j + 1];
        double even = 0, odd = 0; // two chains hide the latency of the addition
        std::int64_t p = begin;
        for (; p + 1 < end; p += 2) {
            even += val[p] * x[idx[p]];
            odd += val[p + 1] * x[idx[p + 1]];
        }
        if (p < end) even += val[p] * x[idx[p]];
        y[j] = even + odd;
    }
}

Matrix multiply(const SparseMatrix &a, const Matrix &x) {
    require(a.cols == x.rows(), "sparse multiply: shapes differ");
    if (is_dense(a) && x.cols() > 1) return dense_times('N', a, x);
    Matrix y(a.rows, x.cols());
    if (x.cols() == 1) return multiply(a, x.data(), y.data()), y;
    for_panels(a, x.cols(), a.rows, [&](std::int64_t first, std::int64_t width, vector<double> &packed) {
        std::fill(packed.begin(), packed.end(), 0.0);
        for (std::int64_t j = 0; j < a.cols; ++j) {
            if (a.ptr[j] == a.ptr[j + 1]) continue; // most columns of a gap matrix are empty
            double row[panel] = {};
            for (std::int64_t c = 0; c < width; ++c) row[c] = x(j, first + c);
            for (std::int64_t p = a.ptr[j]; p < a.ptr[j + 1]; ++p) {
                double *target = packed.data() + a.idx[p] * panel;
                for (std::int64_t c = 0; c < panel; ++c) target[c] += a.val[p] * row[c];
            }
        }
        unpack(packed.data(), a.rows, width, y.col(first), a.rows);
    });
    return y;
}

Matrix multiply_transposed(const SparseMatrix &a, const Matrix &x) {
    require(a.rows == x.rows(), "sparse multiply: shapes differ");
    if (is_dense(a) && x.cols() > 1) return dense_times('T', a, x);
    Matrix y(a.cols, x.cols());
    if (x.cols() == 1) return multiply_transposed(a, x.data(), y.data()), y;
    vector<double> packed(a.rows * panel);
    const double flops = 2.0 * panel * static_cast<double>(a.nnz());
    constexpr std::int64_t pieces = 16;
    for (std::int64_t first = 0; first < x.cols(); first += panel) {
        const std::int64_t width = std::min(panel, x.cols() - first);
        parallel_for(pieces, flops, [&](std::int64_t k) {
            pack_columns(x.col(first), a.rows, k * a.rows / pieces, (k + 1) * a.rows / pieces, width,
                         packed.data());
        });
        parallel_for(pieces, flops, [&](std::int64_t k) {
            for (std::int64_t j = k * a.cols / pieces; j < (k + 1) * a.cols / pieces; ++j) {
                double sum[panel] = {};
                for (std::int64_t p = a.ptr[j]; p < a.ptr[j + 1]; ++p) {
                    const double *source = packed.data() + a.idx[p] * panel;
                    for (std::int64_t c = 0; c < panel; ++c) sum[c] += a.val[p] * source[c];
                }
                for (std::int64_t c = 0; c < width; ++c) y(j, first + c) = sum[c];
            }
        });
    }
    return y;
}

Energy energy(const SparseMatrix &a, const double *x) {
    Energy e;
    LongSum all;
    double rest = 0;
    for (std::int64_t j = 0; j < a.cols; ++j) {
        LongSum force;
        for (std::int64_t p = a.ptr[j]; p < a.ptr[j + 1]; ++p) {
            force.add(a.val[p], x[a.idx[p]]);
            e.terms += std::abs(a.val[p] * x[a.idx[p]] * x[j]);
        }
        all.add(force.high(), x[j]);
        rest += force.low() * x[j];
    }
    e.sum = all.high() + (all.low() + rest);
    return e;
}

} // namespace plm
