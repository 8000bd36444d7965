#include "contact/contact_measures.hpp"
#include "contact/contact_force.hpp"
#include "contact/trig_polynomial.hpp"
#include <algorithm>
#include <cmath>
#include <limits>

namespace plm {

vector<double> closed_shares(const Matrix &u) {
    ContactIndicator indicator;
    make_event_force((u.cols() - 1) / 2, u.rows())->indicator(u, indicator);
    vector<double> share(u.rows());
    for (std::int64_t i = 0; i < u.rows(); ++i) share[i] = indicator.averages(0, i);
    return share;
}

double factor_to_switching(const Matrix &u) {
    const Matrix pairs = u.transposed();
    double least = std::numeric_limits<double>::infinity();
    for (std::int64_t i = 0; i < pairs.cols(); ++i) {
        const ValueRange range = trig_range(pairs.col(i), pairs.rows() / 2);
        const double half = 0.5 * (range.maximum - range.minimum);
        if (half > 0) least = std::min(least, std::abs(pairs(0, i)) / half);
    }
    return least;
}

double amplitude_of_first_switch(const vector<double> &rest, const vector<double> &swing,
                                 const vector<double> &closed_shares) {
    double first = 0;
    for (std::size_t i = 0; i < rest.size(); ++i) {
        if (swing[i] == 0 || closed_shares[i] == 0.5) continue;
        const double amplitude = std::abs(rest[i] / swing[i]);
        if (first == 0 || amplitude < first) first = amplitude;
    }
    return first;
}

double mean_energy(const Matrix &force, const Matrix &u) {
    double energy = 0;
    for (std::int64_t c = 0; c < u.cols(); ++c)
        energy += (c == 0 ? 0.5 : 0.25) * dot(u.rows(), force.col(c), u.col(c));
    return energy;
}

} // namespace plm
