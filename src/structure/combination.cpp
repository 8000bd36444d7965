#include "structure/combination.hpp"
#include "structure/solver/make_factor.hpp"

namespace plm {

Combination::Combination(const Structure &structure, MatrixWeights c) : solver_(structure.matrices().solver) {
    const Structure::Matrices a = structure.matrices();
    take(c.mass, a.mass);
    take(c.stiffness, a.stiffness);
    take(c.damping, a.damping);
}

// Only what there is: the pattern of the sum decides what its factor costs.
void Combination::take(double factor, const SparseMatrix &a) {
    if (factor == 0 || a.rows == 0) return;
    if (sum_.rows > 0) {
        sum_ = add(1.0, sum_, factor, a);
        return;
    }
    sum_ = a;
    for (double &v : sum_.val) v *= factor;
}

void Combination::factor() {
    factor_ = make_factor(sum_, solver_);
}

} // namespace plm
