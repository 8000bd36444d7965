#include "contact/near_pairs.hpp"
#include <algorithm>
#include <cmath>

namespace plm {

void NearPairs::expand(const vector<double> &now, const vector<double> &travel, const Matrix &gap_by_pair,
                       char op, const Matrix &powers, Matrix &penetration) {
    const std::int64_t n = gap_by_pair.rows(), terms = penetration.rows();
    near_.clear();
    for (std::int64_t i = 0; i < penetration.cols(); ++i) {
        if (!(std::abs(now[i]) > travel[i])) {
            near_.push_back(i);
            continue;
        }
        std::fill_n(penetration.col(i), terms, 0.0);
        penetration(0, i) = now[i];
    }
    const std::int64_t count = static_cast<std::int64_t>(near_.size());
    if (count == 0) return;
    const bool most = 4 * count > 3 * penetration.cols(); // not worth being put together
    if (!most) {
        rows_.reset(n, count);
        for (std::int64_t c = 0; c < count; ++c) std::copy_n(gap_by_pair.col(near_[c]), n, rows_.col(c));
    }
    moved_.reset(terms, most ? penetration.cols() : count);
    gemm(op, 'N', 1.0, powers, most ? gap_by_pair : rows_, 0.0, moved_);
    for (std::int64_t c = 0; c < count; ++c) {
        const double *moved = moved_.col(most ? near_[c] : c);
        double *p = penetration.col(near_[c]);
        for (std::int64_t k = 0; k < terms; ++k) p[k] += moved[k];
    }
}

} // namespace plm
