#include "space/spring_compliance.hpp"
#include "linalg/error.hpp"

namespace plm {
namespace {

bool factor(Matrix t, double softening, DenseCholesky &cholesky) {
    for (std::int64_t i = 0; i < t.rows(); ++i) t(i, i) *= 1 + softening;
    return cholesky.factor(t);
}

} // namespace

DenseCholesky with_springs(Matrix t, const vector<double> &spring) {
    for (std::int64_t i = 0; i < t.rows(); ++i) t(i, i) += 1 / spring[i];
    DenseCholesky cholesky;
    if (factor(t, 0, cholesky)) return cholesky;
    // More pairs than they can move, on springs that are rigid to rounding: how they share the force is
    // open. A compliance below the rounding of T lets them, and changes nothing else.
    const double rounding = 1e-15 * static_cast<double>(10 + t.rows());
    for (double softening : {rounding, 10 * rounding, 100 * rounding})
        if (factor(t, softening, cholesky)) return cholesky;
    throw Error(status::singular, "the contact flexibility is not positive definite; look for gap rows "
                                  "of very different size")
        .reason(reason::singular);
}

} // namespace plm
