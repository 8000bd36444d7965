#include "structure/rigid_factor.hpp"
#include <algorithm>

namespace plm {
namespace {

class RigidFactor final : public TallFactor {
  public:
    RigidFactor(std::unique_ptr<TallFactor> factor, const Field &rigid_modes, const TallMatrix &mass,
                double sigma)
        : factor_(std::move(factor)), modes_(rigid_modes), momenta_(mass.times(rigid_modes)), sigma_(sigma) {}

    void solve(Field &x) const override {
        constexpr std::int64_t block = 32; // right-hand sides at once: bounds the workspace
        for (std::int64_t first = 0; first < x.cols(); first += block) {
            Field b = x.columns(first, std::min(block, x.cols() - first));
            solve_some(b);
            x.put(first, b);
        }
    }
    double reciprocal_condition() const override { return factor_->reciprocal_condition(); }
    std::int64_t factor_nonzeros() const override { return factor_->factor_nonzeros(); }
    bool calls_host() const override { return factor_->calls_host(); }

  private:
    void solve_some(Field &b) const {
        const Matrix along = block_gram(modes_, b);
        add_combination(-1.0, momenta_, along, b);
        factor_->solve(b);
        add_combination(-1.0, modes_, block_gram(momenta_, b), b); // what rounding left of them
        add_combination(1 / sigma_, modes_, along, b);
    }

    std::unique_ptr<TallFactor> factor_;
    Field modes_, momenta_; // R, M R
    double sigma_;
};

} // namespace

std::unique_ptr<TallFactor> make_rigid_factor(std::unique_ptr<TallFactor> factor, const Field &rigid_modes,
                                              const TallMatrix &mass, double sigma) {
    return std::make_unique<RigidFactor>(std::move(factor), rigid_modes, mass, sigma);
}

} // namespace plm
