#include "linalg/lane_products.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

// count times n_lanes rows from `first` on.
template <class L, int count>
PLM_IN_LANES void add_rows(const Matrix &a, std::int64_t first, double alpha, const double *x, double beta,
                           const double *c, double *y) {
    L sum[count] = {};
    const double *column = a.data() + first;
    for (std::int64_t j = 0; j < a.cols(); ++j, column += a.rows())
        for (int l = 0; l < count; ++l) sum[l] += x[j] * L::load(column + l * n_lanes);
    for (int l = 0; l < count; ++l) {
        const std::int64_t row = first + l * n_lanes;
        (alpha * sum[l] + beta * L::load(c + row)).store(y + row);
    }
}

/// The last rows are formed with some of those before once more.
template <class L>
PLM_IN_LANES void add_all_rows(const Matrix &a, double alpha, const double *x, double beta, const double *c,
                               double *y) {
    constexpr std::int64_t at_once = 4 * n_lanes;
    const std::int64_t n = a.rows();
    if (n >= n_lanes) {
        std::int64_t row = 0;
        for (; row + at_once <= n; row += at_once) add_rows<L, 4>(a, row, alpha, x, beta, c, y);
        for (; row < n; row += n_lanes) add_rows<L, 1>(a, std::min(row, n - n_lanes), alpha, x, beta, c, y);
    } else {
        for (std::int64_t row = 0; row < n; ++row) {
            double sum = 0;
            for (std::int64_t j = 0; j < a.cols(); ++j) sum += a(row, j) * x[j];
            y[row] = alpha * sum + beta * c[row];
        }
    }
}

template <class L>
PLM_IN_LANES void bound_rows(const Matrix &a, std::int64_t first, const double *x, const double *sizes,
                             double *ax, double *bound) {
    L sum[3] = {}, most{};
    const std::int64_t n = a.cols();
    const double *column = a.data() + first;
    for (std::int64_t j = 0; j < n; ++j, column += a.rows()) {
        const L entries = L::load(column);
        for (int k = 0; k < 3; ++k) sum[k] += x[j + k * n] * entries;
        most += sizes[j] * absolute(entries);
    }
    for (int k = 0; k < 3; ++k) sum[k].store(ax + first + k * a.rows());
    most.store(bound + first);
}

template <class L>
PLM_IN_LANES void bound_all_rows(const Matrix &a, const double *x, const double *sizes, double *ax,
                                 double *bound) {
    const std::int64_t n = a.rows();
    if (n >= n_lanes) {
        for (std::int64_t row = 0; row < n; row += n_lanes)
            bound_rows<L>(a, std::min(row, n - n_lanes), x, sizes, ax, bound);
        return;
    }
    for (std::int64_t row = 0; row < n; ++row) {
        double sum[3] = {0, 0, 0}, most = 0;
        for (std::int64_t j = 0; j < a.cols(); ++j) {
            for (int k = 0; k < 3; ++k) sum[k] += a(row, j) * x[j + k * a.cols()];
            most += sizes[j] * std::abs(a(row, j));
        }
        for (int k = 0; k < 3; ++k) ax[row + k * n] = sum[k];
        bound[row] = most;
    }
}

PLM_WIDE_LANES void add_wide(const Matrix &a, double alpha, const double *x, double beta, const double *c,
                             double *y) {
    add_all_rows<Lanes<4>>(a, alpha, x, beta, c, y);
}
PLM_WIDE_LANES void bound_wide(const Matrix &a, const double *x, const double *sizes, double *ax,
                               double *bound) {
    bound_all_rows<Lanes<4>>(a, x, sizes, ax, bound);
}

} // namespace

void multiply_and_add(const Matrix &a, double alpha, const double *x, double beta, const double *c, double *y,
                      bool wide) {
    wide ? add_wide(a, alpha, x, beta, c, y) : add_all_rows<Lanes<2>>(a, alpha, x, beta, c, y);
}

void multiply_three_and_bound(const Matrix &a, const double *x, const double *sizes, double *ax,
                              double *bound, bool wide) {
    wide ? bound_wide(a, x, sizes, ax, bound) : bound_all_rows<Lanes<2>>(a, x, sizes, ax, bound);
}

} // namespace plm
