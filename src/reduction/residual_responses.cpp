#include "reduction/residual_responses.hpp"
#include <algorithm>

namespace plm {

Matrix residual_responses(const SpaceModes &all, const vector<char> &kept, const Matrix &loads) {
    constexpr double rounding = 1e-11; // of the whole response
    Matrix columns(all.vectors.rows(), 0);
    if (loads.cols() == 0) return columns;
    const std::int64_t n = all.vectors.cols(), m = all.vectors.rows();
    const Matrix forces = product('T', 'N', all.vectors, loads),
                 still = product('T', 'N', all.massless, loads);
    Matrix column(m, 1);
    for (std::int64_t c = 0; c < loads.cols(); ++c) {
        vector<double> modal(n, 0.0);
        for (std::int64_t j = 0; j < n; ++j)
            if (all.values[j] > 0) modal[j] = forces(j, c) / all.values[j];
        gemv('N', 1.0, all.vectors, modal.data(), 0.0, column.data());
        gemv('N', 1.0, all.massless, still.col(c), 1.0, column.data());
        const double whole = norm2(m, column.data());
        for (std::int64_t j = 0; j < n; ++j)
            if (kept[j]) modal[j] = 0;
        gemv('N', 1.0, all.vectors, modal.data(), 0.0, column.data());
        gemv('N', 1.0, all.massless, still.col(c), 1.0, column.data());
        const double size = norm2(m, column.data());
        if (!(size > rounding * whole)) continue;
        for (std::int64_t i = 0; i < m; ++i) column(i, 0) /= size;
        columns.append(column);
    }
    return columns;
}

} // namespace plm
