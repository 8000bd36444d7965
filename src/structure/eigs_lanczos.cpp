// Block Lanczos method with thick restarts (Wu and Simon, SIAM J. Matrix Anal. Appl. 22, 2000; in blocks:
// Zhou and Saad, Numer. Algorithms 47, 2008) in shift-invert mode: the pairs of A^-1 M with the largest
// theta = 1 / (lambda - shift), orthogonal in the inner product of M, which may be semi-definite. A block
// reads the factor once for all its columns, and sees as many copies of an eigenvalue. All its state is in
// one object: problems run side by side, and one inside a callback of another.
#include "linalg/blas_lapack.hpp"
#include "linalg/lapack.hpp"
#include "structure/eigs_block.hpp"
#include "structure/eigs_internal.hpp"
#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

namespace plm {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

/// The factorization A^-1 M V = V T + W B, with V and the block W M-orthonormal.
class Lanczos {
  public:
    Lanczos(const Pencil &pencil, const KrylovRequest &request)
        : pencil_(pencil), request_(request), t_(request.n_lanczos, request.n_lanczos), v_(pencil.place) {
        v_.reserve(request.n_lanczos);
    }

    KrylovResult run() {
        if (!begin()) return {KrylovEnd::exhausted, {}};
        for (std::int64_t restart = 0;;) {
            const bool whole = extend();
            solve_projected();
            if (!whole && size() < request_.n_wanted) return {KrylovEnd::exhausted, extract()};
            if (n_converged_ == n_wanted()) return {KrylovEnd::converged, extract_with_rest()};
            if (fits(w_.width())) continue;
            if (restart++ >= request_.max_restarts) return {KrylovEnd::too_few, extract()};
            compress();
        }
    }

  private:
    std::int64_t size() const { return v_.cols(); }
    std::int64_t n_wanted() const { return std::min(request_.n_wanted, size()); }
    bool fits(std::int64_t more) const { return size() + more <= request_.n_lanczos; }

    /// X = A^-1 X in place, kept apart from the vectors named.
    void apply_inverse(Field &x) {
        pencil_.poll();
        pencil_.factor.solve(x);
        if (request_.apart) // X -= Y Y^T M X
            add_combination(-1, *request_.apart, block_gram(*request_.m_apart, x), x);
        if (!x.is_finite()) // NaN in the basis would go round until the last restart
            throw Error(status::eigensolver, "the factorization's solve returned NaN or Inf");
    }

    /// The space of an earlier search, or none, and W.
    bool begin() {
        const KnownPairs &known = request_.known;
        if (!known.values) return fresh_block();
        v_.append(*known.vectors);
        if (!known.rest || known.rest->w.cols() == 0) {
            for (std::int64_t j = 0; j < size(); ++j) t_(j, j) = 1 / ((*known.values)[j] - pencil_.shift);
            return fresh_block();
        }
        const SearchRest rest = std::exchange(*known.rest, SearchRest());
        const std::int64_t room = request_.n_lanczos - rest.w.cols() - size();
        v_.append(rest.v.columns(0, std::min(room, rest.v.cols())));
        for (std::int64_t j = 0; j < size(); ++j) t_(j, j) = rest.theta[j];
        w_.x = rest.w;
        w_.mx = pencil_.m.times(w_.x);
        b_ = rest.b.columns(0, size());
        return true;
    }

    /// A new W, for the start and where the space closed in itself; false: there is none.
    bool fresh_block() {
        // what a restart keeps and the block have room beside each other
        const std::int64_t room =
            std::min(request_.n_lanczos - request_.n_wanted, request_.n_lanczos - size());
        const std::int64_t width = std::max<std::int64_t>(1, std::min(request_.width, room));
        for (int attempt = 0; attempt < 3; ++attempt) {
            w_.x = pencil_.m.times(v_.filled(width, {0, 0, 1, request_.seed + 3 * size() + attempt}));
            apply_inverse(w_.x); // into the range of A^-1 M: M may be singular
            w_.orthonormalize(pencil_.m, v_, vector<double>(w_.width(), 0.0));
            if (w_.width() == 0) continue;
            b_.reset(w_.width(), size());
            coupled_from_ = size();
            return true;
        }
        return false;
    }

    /// Columns of V and T, until the next block does not fit or a look at the Ritz pairs may be worth it.
    /// False: the space closed in itself and there is no direction beside it.
    bool extend() {
        const std::int64_t look = std::max(size() + size() / 6, request_.n_wanted + 4 * w_.width());
        do {
            advance();
            if (w_.width() > 0) continue;
            if (!fits(1)) return true; // full, and every pair is exact
            if (!fresh_block()) return false;
        } while (fits(w_.width()) && size() < look);
        return true;
    }

    /// W goes into V, and A^-1 M W, less what lies in V, is the next.
    void advance() {
        const std::int64_t first = size(), width = w_.width();
        v_.append(w_.x);
        for (std::int64_t j = 0; j < width; ++j)
            for (std::int64_t i = 0; i < first; ++i) t_(i, first + j) = t_(first + j, i) = b_(j, i);
        std::swap(w_.mx, mv_);
        w_.x = mv_;
        apply_inverse(w_.x);
        add_to_t(first, block_gram(mv_, w_.x), 0);
        w_.orthonormalize(pencil_.m, v_, take_recurrence(first));
        add_to_t(first, w_.taken(), first);
        b_.reset(w_.width(), size());
        for (std::int64_t j = 0; j < width; ++j) std::copy_n(w_.rest().col(j), w_.width(), b_.col(first + j));
        coupled_from_ = first;
    }

    /// The symmetric part of a square block, rows from `row` of a matrix, goes on T's diagonal.
    void add_to_t(std::int64_t first, const Matrix &block, std::int64_t row) {
        for (std::int64_t j = 0; j < block.cols(); ++j)
            for (std::int64_t i = 0; i < block.cols(); ++i)
                t_(first + i, first + j) += 0.5 * (block(row + i, j) + block(row + j, i));
    }

    /// Takes from the new columns what T says lies in V, the most of it and without a product with M; returns
    /// its squared M-norms.
    vector<double> take_recurrence(std::int64_t first) {
        const std::int64_t coupled = size() - coupled_from_, width = w_.width();
        Matrix t(coupled, width);
        for (std::int64_t j = 0; j < width; ++j)
            std::copy_n(t_.col(first + j) + coupled_from_, coupled, t.col(j));
        add_combination_of_columns(-1.0, v_, coupled_from_, t, w_.x);
        vector<double> taken(width);
        for (std::int64_t j = 0; j < width; ++j) taken[j] = dot(coupled, t.col(j), t.col(j));
        return taken;
    }

    /// The Ritz pairs, largest |theta| first, and how many of those wanted have converged.
    void solve_projected() {
        Matrix t(size(), size());
        for (std::int64_t j = 0; j < size(); ++j) std::copy_n(t_.col(j), size(), t.col(j));
        SymmetricEigen e = symmetric_eigen(t);
        vector<std::int64_t> order(size());
        std::iota(order.begin(), order.end(), 0);
        std::stable_sort(order.begin(), order.end(), [&](std::int64_t a, std::int64_t b) {
            return std::fabs(e.values[a]) > std::fabs(e.values[b]);
        });
        theta_.clear();
        ritz_.reset(size(), size());
        for (std::int64_t from : order) {
            std::copy_n(e.vectors.col(from), size(), ritz_.col(static_cast<std::int64_t>(theta_.size())));
            theta_.push_back(e.values[from]);
        }
        residual_ = product('N', 'N', b_, ritz_);
        n_converged_ = 0;
        for (std::int64_t j = 0; j < n_wanted(); ++j) n_converged_ += converged(j);
    }

    /// M-norm of what A^-1 M x misses theta x by.
    double residual(std::int64_t j) const { return norm2(residual_.rows(), residual_.col(j)); }
    bool converged(std::int64_t j) const {
        constexpr double glance = 1e-2; // what looks smaller than it is has shown by then
        const double size = std::fabs(theta_[j]), off = residual(j);
        if (off <= glance * size && size + off < request_.of_interest) return true;
        // seen from a shift far away all eigenvalues look alike
        const double share = std::min(1.0, std::fabs(1 + pencil_.shift * theta_[j])), // |lambda theta|
            tolerance = std::max(eps, request_.tolerance * share);
        return off <= tolerance * std::max(size, std::pow(eps, 2.0 / 3) * std::fabs(theta_[0]));
    }

    /// Restart with the best Ritz vectors; some more than wanted, the more the closer it gets.
    void compress() {
        std::int64_t kept = n_wanted() + std::min(n_converged_, (size() - n_wanted()) / 2);
        if (kept == 1) kept = size() >= 6 ? size() / 2 : 2;
        kept = std::min(kept, request_.n_lanczos - w_.width()); // less than there are: W did not fit
        v_.replace_by_product(ritz_, kept);
        t_.reset(t_.rows(), t_.cols());
        for (std::int64_t j = 0; j < kept; ++j) t_(j, j) = theta_[j];
        b_ = residual_.columns(0, kept);
        coupled_from_ = 0;
    }

    EigenPairs extract_with_rest() {
        if (!request_.keep_rest) return extract();
        const std::int64_t wanted = n_wanted(), kept = std::min(size(), wanted + most_rest);
        SearchRest rest;
        rest.theta.assign(theta_.begin(), theta_.begin() + kept);
        rest.b = residual_.columns(0, kept);
        v_.replace_by_product(ritz_, kept);
        rest.v = v_.columns(wanted, kept - wanted);
        EigenPairs pairs = extract_first(wanted);
        rest.w = std::move(w_.x);
        pairs.rest = std::move(rest);
        return pairs;
    }

    EigenPairs extract() {
        const std::int64_t wanted = n_wanted();
        v_.replace_by_product(ritz_, wanted);
        return extract_first(wanted);
    }

    /// Converged pairs of those wanted. A^-1 M x / theta in place of x frees them from what M does not see
    /// (Ericsson and Ruhe's purification).
    EigenPairs extract_first(std::int64_t wanted) {
        EigenPairs pairs;
        for (std::int64_t from = 0; from < wanted; ++from) {
            if (!converged(from)) continue;
            const auto to = static_cast<std::int64_t>(pairs.values.size());
            v_.copy_column(from, to);
            if (theta_[from] != 0 && residual(from) > 0)
                add_to_column(1 / theta_[from], w_.x, column_of(residual_, from), v_, to);
            pairs.values.push_back(pencil_.shift + 1 / theta_[from]); // infinite for theta = 0
        }
        v_.cut(static_cast<std::int64_t>(pairs.values.size()));
        pairs.vectors = std::move(v_);
        return pairs;
    }

    static vector<double> column_of(const Matrix &a, std::int64_t j) {
        return vector<double>(a.col(j), a.col(j + 1));
    }

    const Pencil &pencil_;
    const KrylovRequest &request_;
    std::int64_t n_converged_ = 0;
    Matrix t_, b_, ritz_, residual_; // of the Ritz pairs: W residual_
    Field v_, mv_;                   // mv_: M times the last block of V
    LanczosBlock w_;
    std::int64_t coupled_from_ = 0; // B is zero to the left of this column
    vector<double> theta_;
};

} // namespace

KrylovResult run_lanczos(const Pencil &pencil, const KrylovRequest &request) {
    return Lanczos(pencil, request).run();
}

} // namespace plm
