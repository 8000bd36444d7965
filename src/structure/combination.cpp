#include "structure/combination.hpp"

namespace plm {

// Only what there is: the pattern of the sum decides what its factor costs.
Combination::Combination(const Structure &structure, MatrixWeights c) : solver_(structure.solver()) {
    const Tall &tall = structure.tall();
    take(c.mass, tall.mass());
    take(c.stiffness, tall.stiffness());
    if (tall.damping()) take(c.damping, *tall.damping());
}

void Combination::take(double factor, const TallMatrix &a) {
    if (factor == 0) return;
    sum_ = sum_ ? sum_->plus(factor, a) : a.scaled(factor);
}

} // namespace plm
