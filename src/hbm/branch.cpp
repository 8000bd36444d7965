#include "hbm/branch.hpp"
#include "hbm/contact_force.hpp"
#include "hbm/trig_polynomial.hpp"
#include <cmath>

namespace plm {

vector<double> Branch::coefficients(std::int64_t point, std::int64_t dof) const {
    const BranchPoint &p = points_[point];
    vector<double> c(2 * n_harmonics_ + 1, 0.0);
    const std::int64_t row = reduced_->model->free_index(dof);
    if (row < 0) return c;
    const Matrix &v = reduced_->vectors, &v0 = reduced_->static_vectors();
    for (std::int64_t j = 0; j < v0.cols(); ++j) c[0] += v0(row, j) * p.eta_0[j];
    for (std::int64_t k = 0; k < 2 * n_harmonics_; ++k)
        for (std::int64_t j = 0; j < v.cols(); ++j) c[k + 1] += v(row, j) * p.eta(j, k);
    return c;
}

double Branch::amplitude(std::int64_t point, std::int64_t dof, Measure measure, std::int64_t harmonic) const {
    const vector<double> c = coefficients(point, dof);
    if (measure == Measure::harmonic)
        return harmonic == 0 ? c[0] : std::hypot(c[2 * harmonic - 1], c[2 * harmonic]);
    if (measure == Measure::rms) {
        double s = c[0] * c[0];
        for (std::size_t k = 1; k < c.size(); ++k) s += 0.5 * c[k] * c[k];
        return std::sqrt(s);
    }
    const TrigRange range = trig_range(c.data(), n_harmonics_);
    if (measure == Measure::half_peak_to_peak) return 0.5 * (range.maximum - range.minimum);
    return std::max(std::abs(range.maximum), std::abs(range.minimum));
}

vector<double> Branch::field(std::int64_t point, double fraction) const {
    const BranchPoint &p = points_[point];
    vector<double> eta(reduced_->size(), 0.0), free(reduced_->model->n_free()), all(reduced_->model->n_dof());
    for (std::int64_t h = 1; h <= n_harmonics_; ++h) {
        const double angle = 2 * M_PI * fraction * static_cast<double>(h), c = std::cos(angle),
                     s = std::sin(angle);
        for (std::int64_t j = 0; j < reduced_->size(); ++j)
            eta[j] += c * p.eta(j, 2 * h - 2) + s * p.eta(j, 2 * h - 1);
    }
    gemv('N', 1.0, reduced_->static_vectors(), p.eta_0.data(), 0.0, free.data());
    gemv('N', 1.0, reduced_->vectors, eta.data(), 1.0, free.data());
    reduced_->model->expand(free.data(), all.data());
    return all;
}

Matrix Branch::penetration_coefficients(std::int64_t point) const {
    const BranchPoint &p = points_[point];
    const std::int64_t z = reduced_->n_pairs();
    Matrix u(2 * n_harmonics_ + 1, z);
    if (z == 0) return u;
    vector<double> mean(z);
    for (std::int64_t i = 0; i < z; ++i) mean[i] = -reduced_->initial_gap[i];
    gemv('N', 1.0, reduced_->gap_0, p.eta_0.data(), 1.0, mean.data());
    const Matrix dynamic = product('N', 'N', reduced_->gap, p.eta);
    for (std::int64_t i = 0; i < z; ++i) {
        u(0, i) = mean[i];
        for (std::int64_t k = 0; k < 2 * n_harmonics_; ++k) u(k + 1, i) = dynamic(i, k);
    }
    return u;
}

vector<double> Branch::closed_share(std::int64_t point) const {
    const Matrix u = penetration_coefficients(point).transposed();
    ContactIndicator indicator;
    make_event_force(n_harmonics_, u.rows())->indicator(u, indicator);
    vector<double> share(u.rows());
    for (std::int64_t i = 0; i < u.rows(); ++i) share[i] = indicator.averages(0, i);
    return share;
}

} // namespace plm
