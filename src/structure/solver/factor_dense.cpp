// LAPACK's Cholesky factorization of a matrix that stores every entry, as those of superelements do.
#include "linalg/lapack.hpp"
#include "structure/solver/factor_builtin.hpp"
#include <algorithm>

namespace plm {
namespace {

class DenseFactor final : public Factor {
  public:
    explicit DenseFactor(const SparseMatrix &a) {
        Matrix values = to_dense(a);
        if (!cholesky_.factor(values)) throw_not_positive_definite(cholesky_.broke_at());
    }

    void solve(double *x, std::int64_t nrhs, std::int64_t ldx) const override {
        cholesky_.solve(x, nrhs, ldx);
    }
    /// As the sparse ones tell it.
    double reciprocal_condition() const override {
        const Matrix &l = cholesky_.lower();
        double lowest = l(0, 0), highest = lowest;
        for (std::int64_t i = 1; i < l.rows(); ++i)
            lowest = std::min(lowest, l(i, i)), highest = std::max(highest, l(i, i));
        return lowest / highest * (lowest / highest);
    }
    std::int64_t factor_nonzeros() const override {
        const std::int64_t n = cholesky_.lower().rows();
        return n * (n + 1) / 2;
    }

  private:
    DenseCholesky cholesky_;
};

} // namespace

std::unique_ptr<Factor> make_dense_factor(const SparseMatrix &a) {
    return std::make_unique<DenseFactor>(a);
}

} // namespace plm
