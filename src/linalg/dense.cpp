#include "dense.hpp"
#include "blas_lapack.hpp"
#include "panel_lanes.hpp"
#include "row_bands.hpp"
#include <algorithm>
#include <cmath>

namespace plm {

void Matrix::outside(std::int64_t i, std::int64_t j) const {
    throw Error(status::internal, format("index (%lld, %lld) of a matrix of %lld x %lld",
                                         static_cast<long long>(i), static_cast<long long>(j),
                                         static_cast<long long>(rows_), static_cast<long long>(cols_)));
}

void Matrix::reset(std::int64_t rows, std::int64_t cols) {
    reshape(rows, cols);
    std::fill(data_.begin(), data_.end(), 0.0);
}

void Matrix::reshape(std::int64_t rows, std::int64_t cols) {
    require(rows >= 0 && cols >= 0 && (rows == 0 || cols <= INT64_MAX / rows), "Matrix::reshape: shape");
    data_.resize(static_cast<std::size_t>(rows * cols));
    rows_ = rows;
    cols_ = cols;
}

Matrix Matrix::columns(std::int64_t first, std::int64_t count) const {
    require(first >= 0 && count >= 0 && first + count <= cols_, "Matrix::columns: range");
    Matrix result(rows_, count);
    std::copy_n(col(first), rows_ * count, result.data());
    return result;
}

void Matrix::reserve(std::int64_t rows, std::int64_t cols) {
    require(rows >= 0 && cols >= 0 && (rows == 0 || cols <= INT64_MAX / rows), "Matrix::reserve: shape");
    data_.reserve(static_cast<std::size_t>(rows * cols));
}

void Matrix::cut(std::int64_t cols) {
    require(cols >= 0 && cols <= cols_, "Matrix::cut: number of columns");
    data_.resize(static_cast<std::size_t>(rows_ * cols));
    cols_ = cols;
}

void Matrix::append(const Matrix &other) {
    if (cols_ == 0) {
        if (&other != this) *this = other;
        return;
    }
    require(other.cols_ == 0 || other.rows_ == rows_, "Matrix::append: number of rows");
    const std::int64_t count = other.rows_ * other.cols_, old = rows_ * cols_, more = other.cols_;
    data_.resize(static_cast<std::size_t>(old + count)); // other may be *this: its data is read after this
    std::copy_n(other.data(), count, data_.data() + old);
    cols_ += more;
}

Matrix Matrix::transposed() const {
    constexpr std::int64_t tile = 32; // both the rows read and the rows written of a tile stay in L1
    Matrix result(cols_, rows_);
    for (std::int64_t j0 = 0; j0 < cols_; j0 += tile)
        for (std::int64_t i0 = 0; i0 < rows_; i0 += tile)
            for (std::int64_t j = j0; j < std::min(j0 + tile, cols_); ++j)
                for (std::int64_t i = i0; i < std::min(i0 + tile, rows_); ++i) result(j, i) = (*this)(i, j);
    return result;
}

namespace {

bool is_transpose(char op) {
    require(op == 'N' || op == 'T', "dense product: op must be 'N' or 'T'");
    return op == 'T';
}

} // namespace

Matrix select_rows(const Matrix &a, const vector<std::int64_t> &rows) {
    Matrix s;
    select_rows(a, rows, s);
    return s;
}

void select_rows(const Matrix &a, const vector<std::int64_t> &rows, Matrix &out) {
    require(&out != &a, "select_rows: the result must not be A");
    out.reset(static_cast<std::int64_t>(rows.size()), a.cols());
    for (std::int64_t j = 0; j < a.cols(); ++j)
        for (std::int64_t i = 0; i < out.rows(); ++i) out(i, j) = a(rows[i], j);
}

namespace {

constexpr std::int64_t tall = 1024 * row_bands;

/// So few columns that packing A for them takes longer than the product.
bool are_few(std::int64_t columns) {
    return columns > 1 && columns <= side_by_side<double>;
}

LaneBlock<double> in_lanes(std::int64_t rows, std::int64_t columns, double factor, const double *b,
                           std::int64_t ldb) {
    LaneBlock<double> x(rows, columns);
    for (std::int64_t i = 0; i < rows; ++i)
        for (std::int64_t j = 0; j < columns; ++j) x(i, j) = factor * b[i + j * ldb];
    return x;
}

/// C = alpha A B + beta C of few columns.
void multiply_few(std::int64_t rows, const Matrix &b, double alpha, const double *a, std::int64_t lda,
                  double beta, double *c, std::int64_t ldc) {
    const LaneBlock<double> x = in_lanes(b.rows(), b.cols(), alpha, b.data(), b.rows());
    LaneBlock<double> y(rows, b.cols());
    multiply_panel<double>(rows, b.rows(), a, lda, x.all(), 1, true, y.all());
    for (std::int64_t j = 0; j < b.cols(); ++j)
        for (std::int64_t i = 0; i < rows; ++i)
            c[i + j * ldc] = beta == 0 ? y(i, j) : beta * c[i + j * ldc] + y(i, j);
}

/// C = alpha A^T B of few columns.
void multiply_few_transposed(std::int64_t rows, std::int64_t n, std::int64_t columns, double alpha,
                             const double *a, const double *b, std::int64_t ld, double *c) {
    const LaneBlock<double> x = in_lanes(rows, columns, -alpha, b, ld);
    LaneBlock<double> y(n, columns);
    subtract_panel_transposed<double>(rows, n, a, ld, x.all(), y.all());
    for (std::int64_t j = 0; j < columns; ++j)
        for (std::int64_t i = 0; i < n; ++i) c[i + j * n] = y(i, j);
}

/// C = alpha A op(B) + beta C, band by band of A and C.
void multiply_tall(char op_b, double alpha, const Matrix &a, const Matrix &b, double beta, Matrix &c) {
    const double flops = 2.0 * static_cast<double>(a.rows() * a.cols()) * static_cast<double>(c.cols());
    const blas_int n = to_blas(c.cols()), k = to_blas(a.cols()), ld = leading(a.rows()),
                   ldb = leading(b.rows());
    for_row_bands(a.rows(), flops, [&](std::int64_t, std::int64_t first, std::int64_t rows) {
        if (op_b == 'N' && are_few(c.cols()))
            return multiply_few(rows, b, alpha, a.data() + first, a.rows(), beta, c.data() + first, c.rows());
        if (op_b == 'N')
            return gemm('N', rows, c.cols(), a.cols(), alpha, a.data() + first, a.rows(), b.data(), b.rows(),
                        beta, c.data() + first, c.rows());
        const blas_int m = to_blas(rows);
        dgemm_("N", &op_b, &m, &n, &k, &alpha, a.data() + first, &ld, b.data(), &ldb, &beta, c.data() + first,
               &ld, 1, 1);
    });
}

/// C = alpha A^T B + beta C: the sum of the bands' products.
void multiply_tall_transposed(double alpha, const Matrix &a, const Matrix &b, double beta, Matrix &c) {
    const std::int64_t entries = c.rows() * c.cols(), ld = a.rows();
    const double flops = 2.0 * static_cast<double>(ld) * static_cast<double>(entries);
    vector<double> parts(row_bands * entries);
    for_row_bands(ld, flops, [&](std::int64_t band, std::int64_t first, std::int64_t rows) {
        double *part = parts.data() + band * entries;
        if (are_few(c.cols()))
            return multiply_few_transposed(rows, c.rows(), c.cols(), alpha, a.data() + first,
                                           b.data() + first, ld, part);
        gemm('T', c.rows(), c.cols(), rows, alpha, a.data() + first, ld, b.data() + first, ld, 0.0, part,
             c.rows());
    });
    for (std::int64_t e = 0; e < entries; ++e) {
        double sum = beta == 0 ? 0 : beta * c.data()[e];
        for (std::int64_t i = 0; i < row_bands; ++i) sum += parts[i * entries + e];
        c.data()[e] = sum;
    }
}

} // namespace

void gemm(char op_a, char op_b, double alpha, const Matrix &a, const Matrix &b, double beta, Matrix &c) {
    const bool ta = is_transpose(op_a), tb = is_transpose(op_b);
    const std::int64_t inner = ta ? a.rows() : a.cols();
    require(inner == (tb ? b.cols() : b.rows()), "gemm: inner dimensions differ");
    require(c.rows() == (ta ? a.cols() : a.rows()) && c.cols() == (tb ? b.rows() : b.cols()),
            "gemm: shape of C");
    require(&c != &a && &c != &b, "gemm: C must not be A or B");
    const bool worth = static_cast<double>(c.rows() * c.cols()) * static_cast<double>(inner) > worth_threads;
    if (worth && !ta && a.rows() >= tall) return multiply_tall(op_b, alpha, a, b, beta, c);
    if (worth && ta && !tb && inner >= tall &&
        c.rows() * c.cols() * row_bands <= inner * (c.rows() + c.cols()))
        return multiply_tall_transposed(alpha, a, b, beta, c);
    if (!tb)
        return gemm(op_a, c.rows(), c.cols(), inner, alpha, a.data(), a.rows(), b.data(), b.rows(), beta,
                    c.data(), c.rows());
    const blas_int m = to_blas(c.rows()), n = to_blas(c.cols()), k = to_blas(inner);
    const blas_int lda = leading(a.rows()), ldb = leading(b.rows()), ldc = leading(c.rows());
    dgemm_(&op_a, &op_b, &m, &n, &k, &alpha, a.data(), &lda, b.data(), &ldb, &beta, c.data(), &ldc, 1, 1);
}

void gemm(char op, double alpha, const Matrix &a, const double *b, std::int64_t n, double beta, double *c) {
    const bool transposed = is_transpose(op);
    const std::int64_t rows = transposed ? a.cols() : a.rows(), inner = transposed ? a.rows() : a.cols();
    if (rows == 0 || n == 0) return;
    gemm(op, rows, n, inner, alpha, a.data(), a.rows(), b, inner, beta, c, rows);
}

void gemm(char op, std::int64_t m, std::int64_t n, std::int64_t k, double alpha, const double *a,
          std::int64_t lda, const double *b, std::int64_t ldb, double beta, double *c, std::int64_t ldc) {
    if (n == 1 && k > 0) // dgemm packs A even for that
        return gemv(op, op == 'N' ? m : k, op == 'N' ? k : m, alpha, a, lda, b, beta, c);
    const blas_int rows = to_blas(m), cols = to_blas(n), inner = to_blas(k);
    const blas_int ld_a = leading(lda), ld_b = leading(ldb), ld_c = leading(ldc);
    dgemm_(&op, "N", &rows, &cols, &inner, &alpha, a, &ld_a, b, &ld_b, &beta, c, &ld_c, 1, 1);
}

void gemm(char op, std::int64_t m, std::int64_t n, std::int64_t k, float alpha, const float *a,
          std::int64_t lda, const float *b, std::int64_t ldb, float beta, float *c, std::int64_t ldc) {
    const blas_int rows = to_blas(m), cols = to_blas(n), inner = to_blas(k);
    const blas_int ld_a = leading(lda), ld_b = leading(ldb), ld_c = leading(ldc);
    sgemm_(&op, "N", &rows, &cols, &inner, &alpha, a, &ld_a, b, &ld_b, &beta, c, &ld_c, 1, 1);
}

Matrix identity(std::int64_t n) {
    Matrix one(n, n);
    for (std::int64_t i = 0; i < n; ++i) one(i, i) = 1;
    return one;
}

Matrix product(char op_a, char op_b, const Matrix &a, const Matrix &b) {
    Matrix c(is_transpose(op_a) ? a.cols() : a.rows(), is_transpose(op_b) ? b.rows() : b.cols());
    gemm(op_a, op_b, 1, a, b, 0, c);
    return c;
}

void gemv(char op, double alpha, const Matrix &a, const double *x, double beta, double *y) {
    const std::int64_t length = is_transpose(op) ? a.cols() : a.rows();
    if (a.rows() == 0 || a.cols() == 0) { // dgemv returns without scaling y then
        for (std::int64_t i = 0; i < length; ++i) y[i] = beta == 0 ? 0 : beta * y[i];
        return;
    }
    const blas_int m = to_blas(a.rows()), n = to_blas(a.cols()), one = 1;
    dgemv_(&op, &m, &n, &alpha, a.data(), &m, x, &one, &beta, y, &one, 1);
}

void gemv(char op, std::int64_t rows, std::int64_t cols, double alpha, const double *a, std::int64_t lda,
          const double *x, double beta, double *y) {
    const blas_int m = to_blas(rows), n = to_blas(cols), ld = leading(lda), one = 1;
    dgemv_(&op, &m, &n, &alpha, a, &ld, x, &one, &beta, y, &one, 1);
}

void gemv(char op, std::int64_t rows, std::int64_t cols, float alpha, const float *a, std::int64_t lda,
          const float *x, float beta, float *y) {
    const blas_int m = to_blas(rows), n = to_blas(cols), ld = leading(lda), one = 1;
    sgemv_(&op, &m, &n, &alpha, a, &ld, x, &one, &beta, y, &one, 1);
}

double dot(std::int64_t n, const double *x, const double *y) {
    const blas_int count = to_blas(n), one = 1;
    return ddot_(&count, x, &one, y, &one);
}

double norm2(std::int64_t n, const double *x) {
    const blas_int count = to_blas(n), one = 1;
    return dnrm2_(&count, x, &one);
}

vector<double> patternless_vector(std::int64_t n) {
    constexpr double step = 0.754877666; // the inverse plastic number: its multiples fill [0, 1) evenly
    vector<double> v(n);
    for (std::int64_t i = 0; i < n; ++i) v[i] = 0.5 + std::fmod(step * static_cast<double>(i + 1), 1.0);
    return v;
}

} // namespace plm
