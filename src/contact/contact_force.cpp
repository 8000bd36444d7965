#include "contact/contact_force.hpp"
#include "linalg/work.hpp"
#include <cstdlib>

namespace plm {
namespace {

double cosine(const double *s, std::int64_t k) {
    k = std::abs(k);
    return k == 0 ? s[0] : s[2 * k - 1];
}
double sine(const double *s, std::int64_t k) {
    if (k == 0) return 0;
    return k > 0 ? s[2 * k] : -s[-2 * k];
}

// force(pair, :) = k J(s) u(pair, :): the sums of indicator_entry() with what two rows and two columns have
// in common taken once.
void apply_averages(const double *s, double k, const Matrix &u, std::int64_t pair, Matrix &force) {
    const std::int64_t n_harmonics = (u.cols() - 1) / 2, stride = u.rows();
    const double *x = u.data() + pair, mean = x[0];
    double f = s[0] * mean;
    for (std::int64_t n = 1; n <= n_harmonics; ++n)
        f += s[2 * n - 1] * x[(2 * n - 1) * stride] + s[2 * n] * x[2 * n * stride];
    force(pair, 0) = k * f;
    for (std::int64_t m = 1; m <= n_harmonics; ++m) {
        double c = 2 * s[2 * m - 1] * mean, d = 2 * s[2 * m] * mean;
        const auto add = [&](std::int64_t n, double cos_difference, double sin_difference) { // of (m - n) t
            const double a = x[(2 * n - 1) * stride], b = x[2 * n * stride];
            const double cos_sum = s[2 * (m + n) - 1], sin_sum = s[2 * (m + n)];
            c += (cos_difference + cos_sum) * a + (sin_sum - sin_difference) * b;
            d += (sin_sum + sin_difference) * a + (cos_difference - cos_sum) * b;
        };
        for (std::int64_t n = 1; n < m; ++n) add(n, s[2 * (m - n) - 1], s[2 * (m - n)]);
        add(m, s[0], 0);
        for (std::int64_t n = m + 1; n <= n_harmonics; ++n) add(n, s[2 * (n - m) - 1], -s[2 * (n - m)]);
        force(pair, 2 * m - 1) = k * c;
        force(pair, 2 * m) = k * d;
    }
}

} // namespace

// Rows and columns: 0 mean, 2h-1 cosine, 2h sine. From 2 <s cos m cos n> = <s cos(m-n)> + <s cos(m+n)> and
// its kin.
double indicator_entry(const double *s, std::int64_t row, std::int64_t column) {
    const std::int64_t m = (row + 1) / 2, n = (column + 1) / 2;
    const bool row_sine = row > 0 && row % 2 == 0, column_sine = column > 0 && column % 2 == 0;
    if (m == 0) return column_sine ? sine(s, n) : cosine(s, n);
    if (n == 0) return row_sine ? 2 * sine(s, m) : 2 * cosine(s, m);
    if (!row_sine && !column_sine) return cosine(s, m - n) + cosine(s, m + n);
    if (!row_sine) return sine(s, n + m) + sine(s, n - m);
    if (!column_sine) return sine(s, m + n) + sine(s, m - n);
    return cosine(s, m - n) - cosine(s, m + n);
}

void ContactIndicator::reset(std::int64_t n_harmonics, std::int64_t n_pairs) {
    averages.reset(4 * n_harmonics + 1, n_pairs);
    state.assign(n_pairs, PairState::open);
    n_switching = 0;
}

double ContactIndicator::closed_share() const {
    const std::int64_t z = averages.cols();
    double share = 0;
    for (std::int64_t i = 0; i < z; ++i) share += averages(0, i) / static_cast<double>(z);
    return share;
}

void constant_indicator(const vector<double> &coupling, std::int64_t n_harmonics, ContactIndicator &out) {
    const std::int64_t z = static_cast<std::int64_t>(coupling.size());
    out.reset(n_harmonics, z);
    for (std::int64_t i = 0; i < z; ++i) {
        out.averages(0, i) = coupling[i];
        if (coupling[i] == 0) continue;
        out.state[i] = coupling[i] == 1 ? PairState::closed : PairState::switching;
        out.n_switching += coupling[i] != 1;
    }
}

void apply_indicator(const ContactIndicator &s, const vector<double> &stiffness, const Matrix &u,
                     Matrix &force) {
    const std::int64_t z = u.rows(), n = u.cols();
    force.reset(z, n);
    for (std::int64_t i = 0; i < z; ++i) {
        if (s.state[i] == PairState::open) continue;
        const double k = stiffness[i];
        if (s.state[i] == PairState::closed) {
            for (std::int64_t c = 0; c < n; ++c) force(i, c) = k * u(i, c);
            continue;
        }
        apply_averages(s.averages.col(i), k, u, i, force);
        worked(12.0 * static_cast<double>(n * n));
    }
}

} // namespace plm
