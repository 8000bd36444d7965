#include "contact/contact_force.hpp"
#include "contact/trig_lanes.hpp"
#include "linalg/work.hpp"
#include <algorithm>
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
    const std::int64_t z = u.rows(), n = u.cols(), h = n / 2, n_averages = s.averages.rows();
    force.reshape(z, n);
    constexpr std::int64_t few = 129; // averages that need no allocation, which would be felt
    double few_averages[n_lanes * few];
    vector<double> many_averages(n_averages > few ? n_lanes * n_averages : 0);
    double *averages = n_averages > few ? many_averages.data() : few_averages;
    std::int64_t i = 0;
    for (; i + n_lanes <= z; i += n_lanes) {
        const auto first = s.state.begin() + i;
        if (std::none_of(first, first + n_lanes, ContactLaw::acts)) {
            for (std::int64_t c = 0; c < n; ++c) std::fill_n(force.col(c) + i, n_lanes, 0.0);
            continue;
        }
        for (std::int64_t l = 0; l < n_lanes; ++l) {
            const double *average = s.averages.col(i + l);
            for (std::int64_t k = 0; k < n_averages; ++k) averages[k * n_lanes + l] = average[k];
        }
        apply_averages(h, averages, &stiffness[i], u.data() + i, z, force.data() + i);
        worked(12.0 * static_cast<double>(n_lanes * n * n));
    }
    for (; i < z; ++i)
        apply_averages_of_one(h, s.averages.col(i), stiffness[i], u.data() + i, z, force.data() + i);
}

} // namespace plm
