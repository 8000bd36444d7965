#include "reduction/residual_responses.hpp"
#include <algorithm>

namespace plm {

Matrix residual_responses(const SpaceModes &all, const vector<char> &kept, const Matrix &loads) {
    constexpr double rounding = 1e-11; // of the whole response
    Matrix columns(all.vectors.rows(), 0);
    if (loads.cols() == 0) return columns;
    const Matrix forces = product('T', 'N', all.vectors, loads);
    for (std::int64_t c = 0; c < loads.cols(); ++c) {
        const std::int64_t n = forces.rows();
        vector<double> modal(n, 0.0);
        for (std::int64_t j = 0; j < n; ++j)
            if (all.values[j] > 0) modal[j] = forces(j, c) / all.values[j];
        const double whole = norm2(n, modal.data());
        for (std::int64_t j = 0; j < n; ++j)
            if (kept[j]) modal[j] = 0;
        const double size = norm2(n, modal.data());
        if (!(size > rounding * whole)) continue;
        for (double &v : modal) v /= size;
        Matrix column(columns.rows(), 1);
        gemv('N', 1.0, all.vectors, modal.data(), 0.0, column.data());
        columns.append(column);
    }
    return columns;
}

} // namespace plm
