#include "hbm/free_motion.hpp"
#include "linalg/lapack.hpp"
#include "model/rest.hpp"
#include <algorithm>
#include <cmath>

namespace plm {

Matrix free_motion(const ReducedModel &m) {
    std::int64_t n_rigid = 0;
    while (n_rigid < m.static_size() && m.lambda_0[n_rigid] <= 0) ++n_rigid;
    if (n_rigid == 0) return Matrix(m.static_size(), 0);
    const std::int64_t z = m.n_pairs();
    Matrix gap(std::max(z, n_rigid), n_rigid); // rows of zeros below: the SVD is to have all directions
    double size = 0;
    for (std::int64_t i = 0; i < z; ++i) {
        for (std::int64_t j = 0; j < n_rigid; ++j) gap(i, j) = m.gap_0(i, j);
        for (std::int64_t j = 0; j < m.static_size(); ++j) size = std::max(size, std::abs(m.gap_0(i, j)));
    }
    const Svd held = thin_svd(gap);
    std::int64_t n_held = 0;
    while (n_held < n_rigid && held.values[n_held] > 1e-9 * size) ++n_held;
    Matrix free(m.static_size(), n_rigid - n_held);
    for (std::int64_t k = n_held; k < n_rigid; ++k)
        for (std::int64_t j = 0; j < n_rigid; ++j) free(j, k - n_held) = held.vt(k, j);
    return free;
}

Matrix hold_free_motion(const ReducedModel &m) {
    Matrix s = free_motion(m);
    const auto flexible = std::find_if(m.lambda_0.begin(), m.lambda_0.end(), [](double l) { return l > 0; });
    const double root = flexible == m.lambda_0.end() ? 1 : std::sqrt(*flexible);
    for (std::int64_t k = 0; k < s.rows() * s.cols(); ++k) s.data()[k] *= root;
    return s;
}

void require_balanced(const ReducedModel &m) {
    const Matrix free = free_motion(m);
    if (free.cols() == 0) return;
    const auto drives = [&](const vector<double> &load) {
        const std::int64_t n = static_cast<std::int64_t>(load.size());
        if (n == 0) return false;
        vector<double> along(free.cols(), 0.0);
        gemv('T', 1.0, free, load.data(), 0.0, along.data());
        return norm2(free.cols(), along.data()) > 1e-8 * norm2(n, load.data());
    };
    const auto mean = m.excitation.find(0);
    if (drives(m.preload_0)) throw no_equilibrium("pre-load");
    if (mean != m.excitation.end() && drives(mean->second.real))
        throw no_equilibrium("mean of the excitation");
}

} // namespace plm
