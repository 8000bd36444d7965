#include "contact/near_pairs.hpp"
#include <algorithm>
#include <cmath>

namespace plm {

void NearPairs::expand(const vector<double> &now, const vector<double> &travel, const Matrix &gap_by_pair,
                       char op, const Matrix &powers, Matrix &penetration) {
    const std::int64_t n = gap_by_pair.rows(), terms = penetration.cols();
    near_.clear();
    for (std::int64_t i = 0; i < penetration.rows(); ++i) {
        if (!(std::abs(now[i]) > travel[i])) {
            near_.push_back(i);
            continue;
        }
        for (std::int64_t k = 1; k < terms; ++k) penetration(i, k) = 0;
        penetration(i, 0) = now[i];
    }
    const std::int64_t count = static_cast<std::int64_t>(near_.size());
    if (count == 0) return;
    rows_.reset(n, count);
    for (std::int64_t c = 0; c < count; ++c) std::copy_n(gap_by_pair.col(near_[c]), n, rows_.col(c));
    moved_.reset(terms, count);
    gemm(op, 'N', 1.0, powers, rows_, 0.0, moved_);
    for (std::int64_t k = 0; k < terms; ++k)
        for (std::int64_t c = 0; c < count; ++c) penetration(near_[c], k) += moved_(k, c);
}

} // namespace plm
