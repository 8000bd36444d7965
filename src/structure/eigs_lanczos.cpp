// Lanczos method with thick restarts (Wu and Simon, SIAM J. Matrix Anal. Appl. 22, 2000) in shift-invert
// mode: the pairs of A^-1 M with the largest theta = 1 / (lambda - shift), orthogonal in the inner product of
// M, which may be semi-definite. All its state is in one object: problems run side by side, and one inside a
// callback of another.
#include "linalg/blas_lapack.hpp"
#include "linalg/lapack.hpp"
#include "structure/eigs_internal.hpp"
#include <algorithm>
#include <limits>
#include <numeric>

namespace plm {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

/// The factorization A^-1 M V = V T + beta v e^T, with V and v M-orthonormal.
class Lanczos {
  public:
    Lanczos(const Pencil &pencil, const KrylovRequest &request)
        : pencil_(pencil), request_(request), n_(pencil.size()), v_(n_, request.n_lanczos),
          t_(request.n_lanczos, request.n_lanczos), w_(n_), mw_(n_),
          overlap_(std::max(request.n_lanczos, request.known ? request.known->cols() : 0)),
          taken_(request.n_lanczos) {}

    KrylovResult run() {
        if (!fresh_direction()) return {KrylovEnd::exhausted, {}};
        for (std::int64_t restart = 0;; ++restart) {
            const bool whole = extend();
            solve_projected();
            if (!whole && size_ < request_.n_wanted) return {KrylovEnd::exhausted, extract()};
            if (n_converged_ == n_wanted()) return {KrylovEnd::converged, extract()};
            if (restart >= request_.max_restarts) return {KrylovEnd::too_few, extract()};
            compress();
        }
    }

  private:
    std::int64_t n_wanted() const { return std::min(request_.n_wanted, size_); }

    /// w = A^-1 x in place, kept away from the known vectors.
    void apply_inverse(vector<double> &w) {
        pencil_.poll();
        pencil_.factor.solve(w.data(), 1, n_);
        if (request_.known) { // w -= X X^T M w
            gemv('T', 1, *request_.m_known, w.data(), 0, overlap_.data());
            gemv('N', -1, *request_.known, overlap_.data(), 1, w.data());
        }
        if (!finite(w.data(), n_)) // NaN in the basis would go round until the last restart
            throw Error(PLM_ERR_EIGENSOLVER, "the factorization's solve returned NaN or Inf");
    }

    /// M w into mw; returns the M-norm of w.
    double measure() {
        multiply_transposed(pencil_.m, w_.data(), mw_.data()); // M is symmetric: the gathering form is faster
        return std::sqrt(std::max(0.0, dot(n_, w_.data(), mw_.data())));
    }

    /// Takes from w what lies in the columns of V, again as long as much was taken; the sum of what was taken
    /// from column j goes into taken_[j]. Returns what is left of its M-norm: 0 for nothing but rounding of
    /// what was there.
    double orthogonalize() {
        std::fill(taken_.begin(), taken_.end(), 0.0);
        const double first = measure();
        double norm = first;
        for (int pass = 0; pass < 4; ++pass) {
            const double before = norm;
            gemv_columns('T', 1, mw_.data(), 0, overlap_.data());
            gemv_columns('N', -1, overlap_.data(), 1, w_.data());
            for (std::int64_t i = 0; i < size_; ++i) taken_[i] += overlap_[i];
            norm = measure();
            if (norm > 0.717 * before) // sin(pi / 4): Daniel, Gragg, Kaufman and Stewart (1976)
                return norm > eps * first ? norm : 0;
        }
        return 0;
    }

    /// gemv with the columns of V that are there.
    void gemv_columns(char op, double alpha, const double *x, double beta, double *y) const {
        if (size_ == 0) return;
        const blas_int rows = to_blas(n_), cols = to_blas(size_), one = 1;
        dgemv_(&op, &rows, &cols, &alpha, v_.data(), &rows, x, &one, &beta, y, &one, 1);
    }

    /// A new direction, for the start and where the space closed in itself; false: there is none.
    bool fresh_direction() {
        for (int attempt = 0; attempt < 3; ++attempt) {
            pseudo_random(mw_, static_cast<std::uint64_t>(request_.seed + 3 * size_ + attempt));
            multiply_transposed(pencil_.m, mw_.data(), w_.data());
            apply_inverse(w_); // into the range of A^-1 M: M may be singular
            const double left = orthogonalize();
            if (!(left > 0)) continue;
            normalize(left);
            return true;
        }
        return false;
    }

    void normalize(double norm) {
        for (std::int64_t i = 0; i < n_; ++i) w_[i] /= norm, mw_[i] /= norm;
    }

    /// Columns of V and T until both are full. False: the space closed in itself and there is no direction
    /// beside it.
    bool extend() {
        while (size_ < v_.cols()) {
            const std::int64_t j = size_++;
            std::copy_n(w_.data(), n_, v_.col(j));
            w_ = mw_;
            apply_inverse(w_);
            beta_ = orthogonalize();
            t_(j, j) = taken_[j];
            if (beta_ > 0) {
                normalize(beta_);
            } else {
                if (size_ == v_.cols()) return true; // full, and every pair is exact
                if (!fresh_direction()) return false;
            }
            if (size_ < v_.cols()) t_(size_, j) = t_(j, size_) = beta_;
        }
        return true;
    }

    /// The Ritz pairs, largest |theta| first, and how many of those wanted have converged.
    void solve_projected() {
        Matrix t(size_, size_);
        for (std::int64_t j = 0; j < size_; ++j) std::copy_n(t_.col(j), size_, t.col(j));
        SymmetricEigen e = symmetric_eigen(t);
        vector<std::int64_t> order(size_);
        std::iota(order.begin(), order.end(), 0);
        std::stable_sort(order.begin(), order.end(), [&](std::int64_t a, std::int64_t b) {
            return std::fabs(e.values[a]) > std::fabs(e.values[b]);
        });
        theta_.clear();
        ritz_.reset(size_, size_);
        for (std::int64_t from : order) {
            std::copy_n(e.vectors.col(from), size_, ritz_.col(static_cast<std::int64_t>(theta_.size())));
            theta_.push_back(e.values[from]);
        }
        n_converged_ = 0;
        for (std::int64_t j = 0; j < n_wanted(); ++j) n_converged_ += converged(j);
    }

    /// The residual of Ritz pair j is coupling(j) v.
    double coupling(std::int64_t j) const { return beta_ * ritz_(size_ - 1, j); }
    bool converged(std::int64_t j) const {
        const double tolerance = request_.tolerance > 0 ? request_.tolerance : eps;
        return std::fabs(coupling(j)) <=
               tolerance * std::max(std::fabs(theta_[j]), std::pow(eps, 2.0 / 3) * std::fabs(theta_[0]));
    }

    /// Restart with the best Ritz vectors; some more than wanted, the more the closer it gets.
    void compress() {
        std::int64_t kept = n_wanted() + std::min(n_converged_, (size_ - n_wanted()) / 2);
        if (kept == 1) kept = size_ >= 6 ? size_ / 2 : 2;
        kept = std::min(kept, size_ - 1);
        const Matrix x = ritz_vectors(kept);
        std::copy_n(x.data(), n_ * kept, v_.data());
        t_.reset(t_.rows(), t_.cols());
        for (std::int64_t j = 0; j < kept; ++j) {
            t_(j, j) = theta_[j];
            t_(kept, j) = t_(j, kept) = coupling(j);
        }
        size_ = kept;
    }

    Matrix ritz_vectors(std::int64_t count) const {
        Matrix x(n_, count);
        const blas_int rows = to_blas(n_), inner = to_blas(size_), cols = to_blas(count);
        const double one = 1, zero = 0;
        dgemm_("N", "N", &rows, &cols, &inner, &one, v_.data(), &rows, ritz_.data(), &inner, &zero, x.data(),
               &rows, 1, 1);
        return x;
    }

    /// Converged pairs of those wanted. A^-1 M x / theta in place of x frees them from what M does not see
    /// (Ericsson and Ruhe's purification).
    EigenPairs extract() const {
        vector<std::int64_t> good;
        for (std::int64_t j = 0; j < n_wanted(); ++j)
            if (converged(j)) good.push_back(j);
        const Matrix x = ritz_vectors(n_wanted());
        EigenPairs pairs{{}, Matrix(n_, static_cast<std::int64_t>(good.size()))};
        for (std::int64_t from : good) {
            double *to = pairs.vectors.col(static_cast<std::int64_t>(pairs.values.size()));
            std::copy_n(x.col(from), n_, to);
            const double rest = coupling(from);
            if (rest != 0 && theta_[from] != 0)
                for (std::int64_t i = 0; i < n_; ++i) to[i] += rest / theta_[from] * w_[i];
            pairs.values.push_back(pencil_.shift + 1 / theta_[from]); // infinite for theta = 0
        }
        return pairs;
    }

    const Pencil &pencil_;
    const KrylovRequest &request_;
    std::int64_t n_, size_ = 0, n_converged_ = 0; // size_: columns of V
    Matrix v_, t_, ritz_;
    vector<double> w_, mw_, overlap_, taken_, theta_; // w_: v, the direction after the last column; mw_: M v
    double beta_ = 0;
};

} // namespace

KrylovResult run_lanczos(const Pencil &pencil, const KrylovRequest &request) {
    return Lanczos(pencil, request).run();
}

} // namespace plm
