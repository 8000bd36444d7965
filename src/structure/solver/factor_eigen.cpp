// Eigen's simplicial L D L^T (MPL-2.0) behind the seam of factor.hpp.
#define EIGEN_MPL2_ONLY
#define EIGEN_NO_DEBUG // an eigen_assert would abort the host
#define EIGEN_DONT_PARALLELIZE
#include "linalg/blas_lapack.hpp"
#include "structure/solver/factor_builtin.hpp"
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <limits>

namespace plm {
namespace {

using EigenMatrix = Eigen::SparseMatrix<double, Eigen::ColMajor, std::int64_t>;
using Ldlt = Eigen::SimplicialLDLT<EigenMatrix, Eigen::Lower, Eigen::AMDOrdering<std::int64_t>>;

/// Right-hand sides solved by one pass over L, packed side by side: the pass is bound by reading L.
constexpr std::int64_t columns_at_once = 8;

Eigen::Map<const EigenMatrix> mapped(const SparseMatrix &a) {
    return {a.rows, a.cols, a.nnz(), a.ptr.data(), a.idx.data(), a.val.data()};
}

void decompose(const SparseMatrix &a, Ldlt &ldlt) {
    ldlt.compute(mapped(a));
}

/// Not L L^T: L D L^T tells where D stops being positive, which Eigen's L L^T does not.
class EigenFactor final : public Factor {
  public:
    explicit EigenFactor(const SparseMatrix &a) : n_(a.cols) {
        if (n_ == 0) return;
        decompose(a, ldlt_);
        inspect_diagonal();
    }

    void solve(double *x, std::int64_t nrhs, std::int64_t ldx) const override {
        if (n_ == 0) return;
        require(ldx >= n_, "Factor::solve: leading dimension");
        std::int64_t first = 0;
        for (; nrhs - first > 1; first += columns_at_once)
            solve_panel<columns_at_once>(x + first * ldx, std::min(columns_at_once, nrhs - first), ldx);
        if (first < nrhs) solve_panel<1>(x + first * ldx, 1, ldx);
    }
    double reciprocal_condition() const override { return reciprocal_condition_; }
    std::int64_t factor_nonzeros() const override { return nonzeros_; }

  private:
    /// Eigen's factorization stops at a zero pivot, leaving it in D.
    void inspect_diagonal() {
        double smallest = std::numeric_limits<double>::infinity(), largest = 0;
        const auto &d = ldlt_.vectorD();
        const auto &original = ldlt_.permutationPinv().indices();
        for (std::int64_t j = 0; j < n_; ++j) {
            if (!(d[j] > 0)) throw_not_positive_definite(original[j]);
            smallest = std::min(smallest, d[j]);
            largest = std::max(largest, d[j]);
        }
        reciprocal_condition_ = smallest / largest;
        nonzeros_ = lower().nonZeros() + n_;
    }

    /// L strictly below its unit diagonal.
    const EigenMatrix &lower() const { return ldlt_.matrixL().nestedExpression(); }

    template <std::int64_t W> void solve_panel(double *x, std::int64_t width, std::int64_t ldx) const {
        const auto &to_factor = ldlt_.permutationP().indices();
        work_.resize(static_cast<std::size_t>(n_ * columns_at_once)); // allocates in the first call only
        double *w = work_.data();
        for (std::int64_t i = 0; i < n_; ++i)
            for (std::int64_t c = 0; c < W; ++c) w[to_factor[i] * W + c] = c < width ? x[i + c * ldx] : 0;
        forward<W>(w);
        backward<W>(w);
        for (std::int64_t i = 0; i < n_; ++i)
            for (std::int64_t c = 0; c < width; ++c) x[i + c * ldx] = w[to_factor[i] * W + c];
    }

    template <std::int64_t W> void forward(double *w) const {
        const std::int64_t *ptr = lower().outerIndexPtr(), *idx = lower().innerIndexPtr();
        const double *val = lower().valuePtr();
        for (std::int64_t j = 0; j < n_; ++j) {
            double row[W];
            std::copy_n(w + j * W, W, row);
            for (std::int64_t p = ptr[j]; p < ptr[j + 1]; ++p)
                for (std::int64_t c = 0; c < W; ++c) w[idx[p] * W + c] -= val[p] * row[c];
        }
    }

    /// D^-1 and L^-T in one pass from the end.
    template <std::int64_t W> void backward(double *w) const {
        const std::int64_t *ptr = lower().outerIndexPtr(), *idx = lower().innerIndexPtr();
        const double *val = lower().valuePtr();
        const auto &d = ldlt_.vectorD();
        for (std::int64_t j = n_ - 1; j >= 0; --j) {
            double row[W];
            for (std::int64_t c = 0; c < W; ++c) row[c] = w[j * W + c] / d[j];
            for (std::int64_t p = ptr[j]; p < ptr[j + 1]; ++p)
                for (std::int64_t c = 0; c < W; ++c) row[c] -= val[p] * w[idx[p] * W + c];
            std::copy_n(row, W, w + j * W);
        }
    }

    Ldlt ldlt_;
    std::int64_t n_, nonzeros_ = 0;
    double reciprocal_condition_ = 1;
    mutable vector<double> work_;
};

FactorEstimate estimate_for_eigen(const SparseMatrix &a, const Solver &) {
    FactorEstimate e;
    e.kept_single = e.peak_single = std::numeric_limits<double>::infinity();
    if (a.cols == 0) return e;
    Ldlt ldlt;
    ldlt.analyzePattern(mapped(a));
    const EigenMatrix &l = ldlt.matrixL().nestedExpression();
    const double n = static_cast<double>(a.cols);
    for (std::int64_t j = 0; j < a.cols; ++j) {
        const double below = static_cast<double>(l.outerIndexPtr()[j + 1] - l.outerIndexPtr()[j]);
        e.nonzeros += below + 1;
        e.flops += (below + 1) * (below + 1);
    }
    e.kept_full = 16 * e.nonzeros + 48 * n; // values and indices
    const double matrix = 16 * static_cast<double>(a.nnz());
    e.peak_full = e.kept_full + matrix;
    e.at_work = e.kept_full + 2 * matrix; // the count forms its sum
    return e;
}

std::unique_ptr<Factor> factor_by_eigen(const SparseMatrix &a, const Solver &) {
    return std::make_unique<EigenFactor>(a);
}

/// Eigen's factorization stops at a zero pivot, leaving it in D.
std::int64_t count_negative_by_eigen(const MatrixSum &sum, const Solver &) {
    const SparseMatrix a = sum.formed();
    if (a.cols == 0) return 0;
    Ldlt ldlt;
    decompose(a, ldlt);
    std::int64_t negative = 0;
    const auto &d = ldlt.vectorD();
    for (std::int64_t j = 0; j < a.cols; ++j) {
        if (d[j] == 0 || !std::isfinite(d[j])) throw_singular(ldlt.permutationPinv().indices()[j]);
        negative += d[j] < 0;
    }
    return negative;
}

std::string eigen_version() {
    return format("Eigen %d.%d.%d", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION);
}

} // namespace

extern const Builtin solver_eigen;
const Builtin solver_eigen{SolverName::eigen, factor_by_eigen, count_negative_by_eigen, estimate_for_eigen,
                           eigen_version};

} // namespace plm
