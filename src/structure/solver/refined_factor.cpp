#include "structure/solver/refined_factor.hpp"
#include "linalg/blas_lapack.hpp"
#include <algorithm>
#include <limits>

namespace plm {
namespace {

/// Of the residual, entry by entry against |A| |x| + |b| (Oettli and Prager, 1964): what a good solve in double leaves.
constexpr double enough = 1e-15;
/// Left by a refinement that stands still: still as good as what double precision makes of stiff parts.
constexpr double tolerable = 1e-11;
/// A refinement that gains less than this ends (as LAPACK's dporfs).
constexpr double least_gain = 0.5;
constexpr int most_refinements = 10;

[[noreturn]] void throw_no_contraction(double residual) {
    throw Error(PLM_ERR_CONVERGENCE,
                format("a factorization kept in single precision does not serve this structure: refined solves keep a "
                       "residual of %.1e; set factor_precision to double, with the memory it needs",
                       residual))
        .reason(PLM_REASON_NO_CONTRACTION)
        .argument("factor_precision");
}

} // namespace

HalfMatrix::HalfMatrix(const SparseMatrix &a) : first(a.cols + 1, 0) {
    require(a.cols <= std::numeric_limits<std::int32_t>::max(), "HalfMatrix: too many rows");
    row.reserve((a.nnz() + a.cols) / 2);
    value.reserve((a.nnz() + a.cols) / 2);
    for (std::int64_t j = 0; j < a.cols; ++j) {
        for (std::int64_t p = a.ptr[j]; p < a.ptr[j + 1]; ++p) {
            if (a.idx[p] < j) continue;
            row.push_back(static_cast<std::int32_t>(a.idx[p]));
            value.push_back(a.val[p]);
        }
        first[j + 1] = static_cast<std::int64_t>(row.size());
    }
}

void HalfMatrix::residual(const double *x, double *r, double *s) const {
    const auto n = static_cast<std::int64_t>(first.size()) - 1;
    for (std::int64_t j = 0; j < n; ++j) {
        double sum = 0, size = 0; // of row j, what stands right of the diagonal
        const double own = x[j];
        for (std::int64_t p = first[j]; p < first[j + 1]; ++p) {
            const std::int64_t i = row[p];
            const double below = value[p] * own;
            r[i] -= below;
            s[i] += std::fabs(below);
            if (i == j) continue;
            const double right = value[p] * x[i];
            sum += right;
            size += std::fabs(right);
        }
        r[j] -= sum;
        s[j] += size;
    }
}

/// r = b - A x; returns its size.
double RefinedFactor::set_residual(const double *b, const double *x, double *r) const {
    const auto n = static_cast<std::int64_t>(matrix_.first.size()) - 1;
    vector<double> size(n);
    for (std::int64_t i = 0; i < n; ++i) {
        r[i] = b[i];
        size[i] = std::fabs(b[i]);
    }
    matrix_.residual(x, r, size.data());
    // rows where next to nothing meets are measured by the largest
    const double least = std::numeric_limits<double>::epsilon() * *std::max_element(size.begin(), size.end());
    double largest = 0;
    for (std::int64_t i = 0; i < n; ++i) {
        if (!(std::fabs(r[i]) <= std::numeric_limits<double>::max())) return std::numeric_limits<double>::infinity();
        if (r[i] != 0) largest = std::max(largest, std::fabs(r[i]) / std::max(size[i], least));
    }
    return largest;
}

void RefinedFactor::solve(double *x, std::int64_t nrhs, std::int64_t ldx) const {
    for (std::int64_t first = 0; first < nrhs; first += PanelFactor::widest_solve)
        solve_some(x + first * ldx, std::min(PanelFactor::widest_solve, nrhs - first), ldx);
}

/// Columns leave the block when they are done.
void RefinedFactor::solve_some(double *x, std::int64_t nrhs, std::int64_t ldx) const {
    const auto n = static_cast<std::int64_t>(matrix_.first.size()) - 1;
    Matrix b(n, nrhs), r(n, nrhs);
    vector<std::int64_t> column(nrhs);
    vector<double> before(nrhs, std::numeric_limits<double>::infinity());
    for (std::int64_t j = 0; j < nrhs; ++j) {
        column[j] = j;
        std::copy_n(x + j * ldx, n, b.col(j));
        std::copy_n(x + j * ldx, n, r.col(j));
        std::fill_n(x + j * ldx, n, 0.0);
    }
    for (int step = 0; !column.empty(); ++step) {
        factor_.solve(r.data(), static_cast<std::int64_t>(column.size()));
        std::size_t left = 0;
        for (std::size_t k = 0; k < column.size(); ++k) {
            const std::int64_t j = column[k];
            double *solution = x + j * ldx;
            for (std::int64_t i = 0; i < n; ++i) solution[i] += r(i, static_cast<std::int64_t>(k));
            const double size = set_residual(b.col(j), solution, r.col(static_cast<std::int64_t>(left)));
            if (size <= enough) continue;
            if (step == most_refinements || !(size < least_gain * before[j])) {
                if (!(size <= tolerable)) throw_no_contraction(size);
                continue;
            }
            before[j] = size;
            column[left++] = j;
        }
        column.resize(left);
    }
}

} // namespace plm
