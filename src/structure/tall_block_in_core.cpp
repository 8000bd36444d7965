// Blocks of tall columns that are arrays of this process.
#include "linalg/blas_lapack.hpp"
#include "linalg/lapack.hpp"
#include "linalg/row_bands.hpp"
#include "structure/random_columns.hpp"
#include "structure/sparse.hpp"
#include "structure/tall.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

std::unique_ptr<TallBlock> block(Matrix columns) {
    return tall_block(std::move(columns));
}

class CoreBlock final : public TallBlock {
  public:
    explicit CoreBlock(Matrix columns) : x_(std::move(columns)) {}
    std::int64_t rows() const override { return x_.rows(); }
    std::int64_t cols() const override { return x_.cols(); }
    Matrix *matrix() override { return &x_; }

    std::unique_ptr<TallBlock> filled(std::int64_t cols, const ColumnFill &e) const override {
        Matrix x(rows(), cols);
        if (e.noise != 0) pseudo_random(x, e.seed);
        if (e.constant == 0 && e.wave == 0 && (e.noise == 0 || e.noise == 1)) return block(std::move(x));
        for (std::int64_t j = 0; j < cols; ++j)
            for (std::int64_t i = 0; i < rows(); ++i)
                x(i, j) = e.constant + e.wave * std::sin(static_cast<double>(i)) + e.noise * x(i, j);
        return block(std::move(x));
    }
    std::unique_ptr<TallBlock> patternless() const override {
        return from_column(patternless_vector(rows()));
    }
    std::unique_ptr<TallBlock> from_column(const vector<double> &column) const override {
        Matrix x(static_cast<std::int64_t>(column.size()), 1);
        std::copy(column.begin(), column.end(), x.data());
        return block(std::move(x));
    }
    std::unique_ptr<TallBlock> columns(std::int64_t first, std::int64_t count) const override {
        return block(x_.columns(first, count));
    }
    std::unique_ptr<TallBlock> columns(const vector<std::int64_t> &chosen) const override {
        Matrix some(rows(), static_cast<std::int64_t>(chosen.size()));
        for (std::int64_t j = 0; j < some.cols(); ++j) std::copy_n(x_.col(chosen[j]), rows(), some.col(j));
        return block(std::move(some));
    }
    std::unique_ptr<TallBlock> times(const Matrix &y) const override {
        return block(product('N', 'N', x_, y));
    }
    std::unique_ptr<TallBlock> times(const vector<double> &y) const override {
        Matrix x(rows(), 1);
        if (cols() > 0) gemv('N', 1.0, x_, y.data(), 0.0, x.data());
        return block(std::move(x));
    }
    std::unique_ptr<TallBlock> from_rows(const SparseMatrix &b, const Matrix &f) const override {
        Matrix x(b.cols, f.cols());
        for (std::int64_t j = 0; j < f.cols(); ++j) multiply_transposed(b, f.col(j), x.col(j));
        return block(std::move(x));
    }
    std::unique_ptr<TallBlock> from_rows(const SparseMatrix &b) const override {
        return block(to_dense(transpose(b)));
    }

    void reserve(std::int64_t cols) override { x_.reserve(rows(), cols); }
    void append(const TallBlock &other) override { x_.append(of(other)); }
    void put(std::int64_t first, const TallBlock &other) override {
        std::copy_n(of(other).data(), rows() * other.cols(), x_.col(first));
    }
    void copy_column(std::int64_t from, std::int64_t to) override {
        if (from != to) std::copy_n(x_.col(from), rows(), x_.col(to));
    }
    void cut(std::int64_t cols) override { x_.cut(cols); }
    void clear() override { x_.reset(rows(), cols()); }

    void add_product(double factor, const TallBlock &v, const Matrix &y) override {
        gemm('N', 'N', factor, of(v), y, 1.0, x_);
    }
    void add_product(double factor, const TallBlock &v, std::int64_t first, const Matrix &y) override {
        const Matrix &from = of(v);
        const std::int64_t n = rows();
        for_row_bands(n, flops(y), [&](std::int64_t, std::int64_t begin, std::int64_t height) {
            gemm('N', height, y.cols(), y.rows(), factor, from.col(first) + begin, n, y.data(), y.rows(), 1.0,
                 x_.data() + begin, n);
        });
    }
    void add_product(double factor, const TallBlock &v, const vector<double> &y,
                     std::int64_t column) override {
        gemv('N', factor, of(v), y.data(), 1.0, x_.col(column));
    }
    // By rows that stay in the cache.
    void replace_by_product(const Matrix &y, std::int64_t count) override {
        const double all = 2.0 * static_cast<double>(rows() * cols()) * static_cast<double>(count);
        for_row_bands(rows(), all, [&](std::int64_t, std::int64_t begin, std::int64_t height) {
            replace_rows(y, begin, begin + height, count);
        });
        x_.cut(count);
    }
    void divide(char triangle, bool transposed, const Matrix &r) override {
        const blas_int n = to_blas(rows()), count = to_blas(cols());
        const double one = 1;
        const char *op = transposed ? "T" : "N";
        if (n == 0 || count == 0) return;
        dtrsm_("R", &triangle, op, "N", &n, &count, &one, r.data(), &count, x_.data(), &n, 1, 1, 1, 1);
    }
    void scale(const vector<double> &factor) override {
        for (std::int64_t j = 0; j < cols(); ++j)
            for (std::int64_t i = 0; i < rows(); ++i) x_(i, j) *= factor[j];
    }
    void divide(const vector<double> &divisor) override {
        for (std::int64_t j = 0; j < cols(); ++j)
            for (std::int64_t i = 0; i < rows(); ++i) x_(i, j) /= divisor[j];
    }
    void add(double factor, const TallBlock &v) override {
        const double *from = of(v).data();
        double *to = x_.data();
        for (std::int64_t k = 0; k < rows() * cols(); ++k) to[k] += factor * from[k];
    }
    void set_sum(const vector<double> &factor, const vector<const TallBlock *> &v) override {
        double *to = x_.data();
        vector<const double *> from;
        for (const TallBlock *one : v) from.push_back(of(*one).data());
        for (std::int64_t k = 0; k < rows() * cols(); ++k) {
            double sum = 0;
            for (std::size_t t = 0; t < from.size(); ++t) sum += factor[t] * from[t][k];
            to[k] = sum;
        }
    }
    void add_sums(const std::vector<DofTerms> &sums) override {
        for (std::size_t j = 0; j < sums.size(); ++j)
            for (const DofTerm &t : sums[j]) x_(t.dof, static_cast<std::int64_t>(j)) += t.coefficient;
    }

    double at(std::int64_t row, std::int64_t column) const override { return x_(row, column); }
    Matrix rows_at(const vector<std::int64_t> &rows) const override { return select_rows(x_, rows); }
    vector<double> column(std::int64_t j) const override {
        return vector<double>(x_.col(j), x_.col(j) + rows());
    }
    Matrix gram(const TallBlock &b, bool by_columns) const override {
        if (!by_columns || b.cols() != 1) return product('T', 'N', x_, of(b));
        Matrix c(cols(), 1);
        if (cols() > 0) gemv('T', 1.0, x_, of(b).data(), 0.0, c.data());
        return c;
    }
    vector<double> products(const TallBlock &b) const override {
        vector<double> products(cols());
        for (std::int64_t j = 0; j < cols(); ++j) products[j] = dot(rows(), x_.col(j), of(b).col(j));
        return products;
    }
    vector<double> absolute_products(const TallBlock &one) const override {
        vector<double> products(cols(), 0.0);
        const double *with = of(one).data();
        for (std::int64_t j = 0; j < cols(); ++j)
            for (std::int64_t i = 0; i < rows(); ++i) products[j] += std::abs(x_(i, j) * with[i]);
        return products;
    }
    vector<double> norms() const override {
        vector<double> norms(cols());
        for (std::int64_t j = 0; j < cols(); ++j) norms[j] = norm2(rows(), x_.col(j));
        return norms;
    }
    Matrix by_rows(const SparseMatrix &b) const override { return multiply(b, x_); }
    void by_rows(const SparseMatrix &b, double *u) const override { multiply(b, x_.data(), u); }
    Matrix terms_by_rows(const SparseMatrix &b) const override {
        SparseMatrix sizes = b;
        for (double &a : sizes.val) a = std::abs(a);
        Matrix motion = x_;
        for (std::int64_t k = 0; k < rows() * cols(); ++k) motion.data()[k] = std::abs(motion.data()[k]);
        return multiply(sizes, motion);
    }
    LargestEntry largest() const override {
        LargestEntry largest;
        for (std::int64_t i = 0; i < rows(); ++i) {
            double size = 0;
            for (std::int64_t j = 0; j < cols(); ++j) size = std::hypot(size, x_(i, j));
            if (size > largest.size) largest = {i, size};
        }
        return largest;
    }
    bool is_finite() const override { return finite(x_.data(), rows() * cols()); }
    double remainder(const TallBlock &q) const override {
        if (rows() <= cols()) return 0; // P spans everything
        const double size = q.norms()[0];
        if (!(size > 0)) return 0;
        CoreBlock rest(of(q));
        rest.add_product(-1.0, *this, least_squares(x_, of(q)));
        return rest.norms()[0] / size;
    }

  private:
    static const Matrix &of(const TallBlock &other) {
        if (!other.matrix())
            throw Error(status::state, "vectors in this process meet those that the host keeps behind its "
                                       "tall operations: they do not belong to one model")
                .argument("model");
        return *other.matrix();
    }
    double flops(const Matrix &y) const {
        return 2.0 * static_cast<double>(rows() * y.rows()) * static_cast<double>(y.cols());
    }
    void replace_rows(const Matrix &y, std::int64_t begin, std::int64_t end, std::int64_t count) {
        constexpr std::int64_t panel = 256;
        Matrix some(panel, cols());
        for (std::int64_t first = begin; first < end; first += panel) {
            const std::int64_t height = std::min(panel, end - first);
            for (std::int64_t j = 0; j < cols(); ++j) std::copy_n(x_.col(j) + first, height, some.col(j));
            const blas_int m = to_blas(height), n = to_blas(count), k = to_blas(cols()), ld = to_blas(panel),
                           ldx = to_blas(rows());
            const double one = 1, zero = 0;
            dgemm_("N", "N", &m, &n, &k, &one, some.data(), &ld, y.data(), &k, &zero, x_.data() + first, &ldx,
                   1, 1);
        }
    }

    Matrix x_;
};

} // namespace

std::unique_ptr<TallBlock> tall_block(Matrix columns) {
    return std::make_unique<CoreBlock>(std::move(columns));
}

} // namespace plm
