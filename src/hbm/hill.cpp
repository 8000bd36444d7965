#include "hbm/hill.hpp"
#include "hbm/contact_force.hpp"
#include "hbm/formulation.hpp"
#include "linalg/lapack.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

// Companion matrix of mu^2 + mu D + J over coefficients (2H + 1) x n; rows and columns c n + j.
class HillMatrix {
  public:
    HillMatrix(const FlowModel &flow, std::int64_t n_harmonics, double omega)
        : flow_(flow), n_(flow.size()), c_(2 * n_harmonics + 1), omega_(omega), a_(2 * n_ * c_, 2 * n_ * c_) {
        for (std::int64_t k = 0; k < n_ * c_; ++k) a_(k, n_ * c_ + k) = 1;
    }

    Matrix build(const ContactIndicator &indicator, const vector<double> &stiffness) {
        add_structure();
        for (std::int64_t i = 0; i < flow_.n_pairs(); ++i)
            add_pair(i, stiffness[i], indicator.averages.col(i));
        return std::move(a_);
    }

  private:
    double damping(std::int64_t i, std::int64_t j) const {
        if (!flow_.has_diagonal_damping()) return flow_.damping()(i, j);
        return i == j ? flow_.damping_diagonal()[i] : 0;
    }
    // J and D enter with a minus sign in the lower half.
    void add_j(std::int64_t row, std::int64_t column, double value) { a_(n_ * c_ + row, column) -= value; }
    void add_d(std::int64_t row, std::int64_t column, double value) {
        a_(n_ * c_ + row, n_ * c_ + column) -= value;
    }

    void add_structure() {
        for (std::int64_t c = 0; c < c_; ++c) {
            const std::int64_t h = (c + 1) / 2;
            const double w = static_cast<double>(h) * omega_;
            const std::int64_t partner = c == 0 ? 0 : (c % 2 == 1 ? c + 1 : c - 1);
            const double sign = c % 2 == 1 ? 1 : -1; // d/dt takes the sine into the cosine with +h w
            for (std::int64_t j = 0; j < n_; ++j) {
                add_j(c * n_ + j, c * n_ + j, flow_.lambda()[j] - w * w);
                if (c > 0) add_d(c * n_ + j, partner * n_ + j, 2 * sign * w);
                for (std::int64_t i = 0; i < n_; ++i) {
                    const double d = damping(i, j);
                    if (d == 0) continue;
                    add_d(c * n_ + i, c * n_ + j, d);
                    if (c > 0) add_j(c * n_ + i, partner * n_ + j, sign * w * d);
                }
            }
        }
    }

    void add_pair(std::int64_t pair, double stiffness, const double *averages) {
        for (std::int64_t c = 0; c < c_; ++c)
            for (std::int64_t d = 0; d < c_; ++d) {
                const double k = stiffness * indicator_entry(averages, c, d);
                if (k == 0) continue;
                for (std::int64_t j = 0; j < n_; ++j)
                    for (std::int64_t i = 0; i < n_; ++i)
                        add_j(c * n_ + i, d * n_ + j, k * flow_.gap()(pair, i) * flow_.gap()(pair, j));
            }
    }

    const FlowModel &flow_;
    std::int64_t n_, c_;
    double omega_;
    Matrix a_;
};

} // namespace

vector<std::complex<double>> hill_multipliers(const FlowModel &flow, const BranchPoint &point,
                                              std::int64_t period_multiple) {
    const double omega = point.omega / static_cast<double>(period_multiple);
    ContactIndicator indicator;
    const ContactMotion contact = contact_motion(flow.reduced(), point);
    make_event_force(point.n_harmonics, contact.u.rows())->indicator(contact.u, indicator);
    const Matrix matrix =
        HillMatrix(flow, point.n_harmonics, omega).build(indicator, flow.contact_stiffness());
    auto exponents = general_eigenvalues(matrix);
    // Every exponent appears 2H + 1 times, shifted by multiples of i omega; the unshifted ones are the
    // accurate ones.
    std::sort(exponents.begin(), exponents.end(),
              [](const auto &a, const auto &b) { return std::abs(a.imag()) < std::abs(b.imag()); });
    exponents.resize(2 * flow.size());
    for (std::complex<double> &e : exponents) e = std::exp(e * (2 * M_PI / omega));
    std::sort(exponents.begin(), exponents.end(),
              [](const auto &a, const auto &b) { return std::abs(a) > std::abs(b); });
    return exponents;
}

} // namespace plm
