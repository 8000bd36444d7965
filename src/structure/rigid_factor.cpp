#include "structure/rigid_factor.hpp"
#include <algorithm>

namespace plm {
namespace {

class RigidFactor final : public Factor {
  public:
    RigidFactor(std::unique_ptr<Factor> factor, const Matrix &rigid_modes, const SparseMatrix &mass,
                double sigma)
        : factor_(std::move(factor)), modes_(rigid_modes), momenta_(multiply_transposed(mass, rigid_modes)),
          sigma_(sigma) {}

    void solve(double *x, std::int64_t nrhs, std::int64_t ldx) const override {
        constexpr std::int64_t block = 32; // right-hand sides at once: bounds the workspace
        const std::int64_t n = modes_.rows();
        for (std::int64_t first = 0; first < nrhs; first += block) {
            Matrix b(n, std::min(block, nrhs - first));
            for (std::int64_t j = 0; j < b.cols(); ++j) std::copy_n(x + (first + j) * ldx, n, b.col(j));
            solve(b);
            for (std::int64_t j = 0; j < b.cols(); ++j) std::copy_n(b.col(j), n, x + (first + j) * ldx);
        }
    }
    double reciprocal_condition() const override { return factor_->reciprocal_condition(); }
    std::int64_t factor_nonzeros() const override { return factor_->factor_nonzeros(); }

  private:
    void solve(Matrix &b) const {
        const Matrix along = product('T', 'N', modes_, b);
        gemm('N', 'N', -1.0, momenta_, along, 1.0, b);
        factor_->solve(b.data(), b.cols(), b.rows());
        gemm('N', 'N', -1.0, modes_, product('T', 'N', momenta_, b), 1.0, b); // what rounding left of them
        gemm('N', 'N', 1 / sigma_, modes_, along, 1.0, b);
    }

    std::unique_ptr<Factor> factor_;
    Matrix modes_, momenta_; // R, M R
    double sigma_;
};

} // namespace

std::unique_ptr<Factor> make_rigid_factor(std::unique_ptr<Factor> factor, const Matrix &rigid_modes,
                                          const SparseMatrix &mass, double sigma) {
    return std::make_unique<RigidFactor>(std::move(factor), rigid_modes, mass, sigma);
}

} // namespace plm
