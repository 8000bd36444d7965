#include "structure/solver/refined_factor.hpp"
#include "linalg/blas_lapack.hpp"
#include "linalg/parallel.hpp"
#include <algorithm>
#include <limits>

namespace plm {
namespace {

/// Of the residual, row by row against |A| max |x| + |b|: little more than a solve in double leaves.
constexpr double enough = 1e-14;
/// Left by a refinement that stands still: still as good as what double precision makes of stiff parts.
constexpr double tolerable = 1e-11;
/// Of the solution, as the corrections foretell it: what a factor in double leaves where A is well behaved.
/// It is asked for beside a tolerable residual, and spares solids their third solve.
constexpr double enough_of_solution = 1e-11;
/// A refinement that gains less than this ends (as LAPACK's dporfs).
constexpr double least_gain = 0.5;
constexpr int most_refinements = 10;

[[noreturn]] void throw_no_contraction(double residual) {
    throw Error(
        status::convergence,
        format(
            "a factorization kept in single precision does not serve this structure: refined solves keep a "
            "residual of %.1e; set factor_precision to double, with the memory it needs",
            residual))
        .reason(reason::no_contraction)
        .argument("factor_precision");
}

/// Columns that share a pass over the matrix, packed side by side.
constexpr std::int64_t pack = 4;

/// R -= A X for packed columns.
void subtract_product(const HalfMatrix &a, const double *x, double *r) {
    for (std::int64_t j = 0; j < a.size(); ++j) {
        double own[pack], right[pack] = {};
        std::copy_n(x + j * pack, pack, own);
        std::int64_t p = a.first[j];
        const std::int64_t end = a.first[j + 1];
        if (p < end && a.row[p] == j) { // the diagonal comes first
            for (std::int64_t c = 0; c < pack; ++c) right[c] = a.value[p] * own[c];
            ++p;
        }
        for (; p < end; ++p) {
            double *below = r + std::int64_t(a.row[p]) * pack;
            const double *across = x + std::int64_t(a.row[p]) * pack, v = a.value[p];
            for (std::int64_t c = 0; c < pack; ++c) {
                below[c] -= v * own[c];
                right[c] += v * across[c];
            }
        }
        for (std::int64_t c = 0; c < pack; ++c) r[j * pack + c] -= right[c];
    }
}

/// Right-hand sides on their way to a solution of double precision.
class Refinement {
  public:
    /// B is x's contents, which becomes zero: X so far.
    Refinement(const HalfMatrix &a, const PanelFactor<float> &factor, double *x, std::int64_t nrhs,
               std::int64_t ldx)
        : a_(a), factor_(factor), n_(a.size()), x_(x), ldx_(ldx), b_(n_, nrhs), r_(n_, nrhs), column_(nrhs),
          before_(nrhs, {std::numeric_limits<double>::infinity(), 0, 1}) {
        parallel_for(nrhs, work_on(nrhs), [&](std::int64_t j) {
            column_[j] = j;
            std::copy_n(x + j * ldx, n_, b_.col(j));
            std::copy_n(x + j * ldx, n_, r_.col(j));
            std::fill_n(x + j * ldx, n_, 0.0);
        });
    }

    void run() {
        for (int step = 0; !column_.empty(); ++step) {
            factor_.solve(r_.data(), width(), n_);
            const std::int64_t packs = (width() + pack - 1) / pack;
            now_.resize(width());
            parallel_for(packs, work_on(width()), [&](std::int64_t k) { correct(k * pack); });
            drop_finished(step);
        }
    }

  private:
    struct Progress { // of a column: its residual, and the largest entries of what was added, and of X
        double residual, correction, solution;
    };

    std::int64_t width() const { return static_cast<std::int64_t>(column_.size()); }
    /// As many flops take as long as a pass over so many columns.
    double work_on(std::int64_t columns) const { return 10 * static_cast<double>(n_ * columns); }

    /// X += R, R = B - A X and its size in some columns.
    void correct(std::int64_t first) {
        const std::int64_t count = std::min(pack, width() - first);
        vector<double> packed_x(n_ * pack, 0.0), packed_r(n_ * pack, 0.0);
        for (std::int64_t c = 0; c < count; ++c) {
            double *x = x_ + column_[first + c] * ldx_;
            const double *b = b_.col(column_[first + c]), *more = r_.col(first + c);
            Progress &now = now_[first + c] = {};
            for (std::int64_t i = 0; i < n_; ++i) {
                packed_x[i * pack + c] = x[i] += more[i];
                packed_r[i * pack + c] = b[i];
                now.solution = std::max(now.solution, std::fabs(x[i]));
                now.correction = std::max(now.correction, std::fabs(more[i]));
            }
        }
        subtract_product(a_, packed_x.data(), packed_r.data());
        for (std::int64_t c = 0; c < count; ++c) {
            double *r = r_.col(first + c);
            for (std::int64_t i = 0; i < n_; ++i) r[i] = packed_r[i * pack + c];
            now_[first + c].residual = residual(first + c);
        }
    }

    /// The largest entry of a residual against what its row may sum up.
    double residual(std::int64_t k) const {
        const double *r = r_.col(k), *b = b_.col(column_[k]);
        const double most = now_[k].solution;
        double largest = 0;
        for (std::int64_t i = 0; i < n_; ++i) {
            if (!std::isfinite(r[i])) return std::numeric_limits<double>::infinity();
            if (r[i] != 0)
                largest = std::max(largest, std::fabs(r[i]) / (a_.row_sum[i] * most + std::fabs(b[i])));
        }
        return largest;
    }

    /// The corrections fall by a factor, the last of which is what the solution is off by before the next.
    static bool is_close(const Progress &now, const Progress &before) {
        return now.residual <= tolerable &&
               now.correction / before.correction * now.correction <= enough_of_solution * now.solution;
    }

    void drop_finished(int step) {
        std::int64_t left = 0;
        for (std::int64_t k = 0; k < width(); ++k) {
            const Progress &now = now_[k];
            Progress &before = before_[column_[k]];
            if (now.residual <= enough || (step > 0 && is_close(now, before))) continue;
            if (step == most_refinements || !(now.residual < least_gain * before.residual)) {
                if (!(now.residual <= tolerable)) throw_no_contraction(now.residual);
                continue;
            }
            before = now;
            std::copy_n(r_.col(k), n_, r_.col(left));
            column_[left++] = column_[k];
        }
        column_.resize(left);
    }

    const HalfMatrix &a_;
    const PanelFactor<float> &factor_;
    const std::int64_t n_;
    double *const x_;
    const std::int64_t ldx_;
    Matrix b_, r_;                  // r_: of the columns that are left
    vector<std::int64_t> column_;   // that are left
    vector<Progress> before_, now_; // of all columns, of those that are left
};

} // namespace

HalfMatrix::HalfMatrix(const SparseMatrix &a) : first(a.cols + 1, 0), row_sum(a.cols, 0.0) {
    require(a.cols <= std::numeric_limits<std::int32_t>::max(), "HalfMatrix: too many rows");
    row.reserve((a.nnz() + a.cols) / 2);
    value.reserve((a.nnz() + a.cols) / 2);
    for (std::int64_t j = 0; j < a.cols; ++j) {
        for (std::int64_t p = a.ptr[j]; p < a.ptr[j + 1]; ++p) {
            row_sum[j] += std::fabs(a.val[p]);
            if (a.idx[p] < j) continue;
            row.push_back(static_cast<std::int32_t>(a.idx[p]));
            value.push_back(a.val[p]);
        }
        first[j + 1] = static_cast<std::int64_t>(row.size());
    }
}

void RefinedFactor::solve(double *x, std::int64_t nrhs, std::int64_t ldx) const {
    for (std::int64_t first = 0; first < nrhs; first += PanelFactor<float>::widest_solve)
        Refinement(matrix_, factor_, x + first * ldx,
                   std::min(PanelFactor<float>::widest_solve, nrhs - first), ldx)
            .run();
}

} // namespace plm
