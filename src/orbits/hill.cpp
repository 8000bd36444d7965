#include "orbits/hill.hpp"
#include "contact/contact_force.hpp"
#include "linalg/lapack.hpp"
#include "motions/penetration.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

Matrix block(const Matrix &a, const vector<std::int64_t> &rows, const vector<std::int64_t> &columns) {
    Matrix b(static_cast<std::int64_t>(rows.size()), static_cast<std::int64_t>(columns.size()));
    for (std::int64_t j = 0; j < b.cols(); ++j)
        for (std::int64_t i = 0; i < b.rows(); ++i) b(i, j) = a(rows[i], columns[j]);
    return b;
}

// M mu^2 + D mu + J over coefficients (2H + 1) x n, rows and columns c n + j, and its companion matrix.
class HillMatrix {
  public:
    HillMatrix(const FlowModel &flow, std::int64_t n_harmonics, double omega)
        : flow_(flow), n_(flow.size()), c_(2 * n_harmonics + 1), omega_(omega), j_(n_ * c_, n_ * c_),
          d_(n_ * c_, n_ * c_) {}

    Matrix build(const ContactIndicator &indicator, const vector<double> &stiffness) {
        add_structure();
        for (std::int64_t i = 0; i < flow_.n_pairs(); ++i)
            add_pair(i, stiffness[i], indicator.averages.col(i));
        eliminate_followers();
        return companion();
    }

  private:
    double damping(std::int64_t i, std::int64_t j) const {
        if (!flow_.has_diagonal_damping()) return flow_.damping()(i, j);
        return i == j ? flow_.damping_diagonal()[i] : 0;
    }
    void add_j(std::int64_t row, std::int64_t column, double value) { j_(row, column) += value; }
    void add_d(std::int64_t row, std::int64_t column, double value) { d_(row, column) += value; }

    // Rows of all coefficients of the coordinates [first, end).
    vector<std::int64_t> rows_of(std::int64_t first, std::int64_t end) const {
        vector<std::int64_t> rows;
        for (std::int64_t c = 0; c < c_; ++c)
            for (std::int64_t j = first; j < end; ++j) rows.push_back(c * n_ + j);
        return rows;
    }

    // Coordinates with neither mass nor damping have no exponents: J becomes its Schur complement.
    void eliminate_followers() {
        const vector<std::int64_t> moving = rows_of(0, flow_.n_moving()),
                                   following = rows_of(flow_.n_moving(), n_);
        if (following.empty()) return;
        Matrix stiff = block(j_, following, following), by_moving = block(j_, following, moving);
        RealLu lu;
        lu.factor(stiff);
        lu.solve(by_moving.data(), by_moving.cols(), by_moving.rows());
        const Matrix change = product('N', 'N', block(j_, moving, following), by_moving);
        for (std::int64_t j = 0; j < change.cols(); ++j)
            for (std::int64_t i = 0; i < change.rows(); ++i) j_(moving[i], moving[j]) -= change(i, j);
    }

    // Of (p, q): q = mu p where there is mass; where there is none, mu p = -D_r^-1 (J_r p + D_rm q), D_r
    // diagonal.
    Matrix companion() const {
        const vector<std::int64_t> massive = rows_of(0, flow_.n_massive()),
                                   relaxing = rows_of(flow_.n_massive(), flow_.n_moving());
        vector<std::int64_t> all(massive);
        all.insert(all.end(), relaxing.begin(), relaxing.end());
        const std::int64_t m = static_cast<std::int64_t>(massive.size()),
                           n = static_cast<std::int64_t>(all.size());
        const Matrix j_m = block(j_, massive, all), d_m = block(d_, massive, massive);
        const Matrix j_r = block(j_, relaxing, all), d_r = block(d_, relaxing, massive);
        Matrix a(n + m, n + m), rates(n - m, n + m);
        for (std::int64_t k = 0; k < m; ++k) a(k, n + k) = 1;
        for (std::int64_t i = m; i < n; ++i) {
            const double own = d_(all[i], all[i]);
            for (std::int64_t j = 0; j < n; ++j) a(i, j) = rates(i - m, j) = -j_r(i - m, j) / own;
            for (std::int64_t j = 0; j < m; ++j) a(i, n + j) = rates(i - m, n + j) = -d_r(i - m, j) / own;
        }
        for (std::int64_t i = 0; i < m; ++i) {
            for (std::int64_t j = 0; j < n; ++j) a(n + i, j) = -j_m(i, j);
            for (std::int64_t j = 0; j < m; ++j) a(n + i, n + j) = -d_m(i, j);
        }
        if (n == m) return a;
        const Matrix back = product('N', 'N', block(d_, massive, relaxing), rates);
        for (std::int64_t j = 0; j < n + m; ++j)
            for (std::int64_t i = 0; i < m; ++i) a(n + i, j) -= back(i, j);
        return a;
    }

    void add_structure() {
        for (std::int64_t c = 0; c < c_; ++c) {
            const std::int64_t h = (c + 1) / 2;
            const double w = static_cast<double>(h) * omega_;
            const std::int64_t partner = c == 0 ? 0 : (c % 2 == 1 ? c + 1 : c - 1);
            const double sign = c % 2 == 1 ? 1 : -1; // d/dt takes the sine into the cosine with +h w
            for (std::int64_t j = 0; j < n_; ++j) {
                add_j(c * n_ + j, c * n_ + j, flow_.lambda()[j] - w * w * flow_.mass(j));
                if (c > 0) add_d(c * n_ + j, partner * n_ + j, 2 * sign * w * flow_.mass(j));
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
    Matrix j_, d_;
};

} // namespace

vector<std::complex<double>> hill_multipliers(const FlowModel &flow, const ReducedModel &reduced,
                                              const BranchPoint &point, std::int64_t period_multiple) {
    if (flow.state_size() * (2 * point.n_harmonics + 1) > largest_hill_order) return {};
    const double omega = point.omega / static_cast<double>(period_multiple);
    ContactIndicator indicator;
    const ContactMotion contact = contact_motion(reduced, point);
    make_event_force(point.n_harmonics, contact.u.rows())->indicator(contact.u, indicator);
    const Matrix matrix =
        HillMatrix(flow, point.n_harmonics, omega).build(indicator, flow.contact_stiffness());
    auto exponents = general_eigenvalues(matrix);
    // Every exponent appears 2H + 1 times, shifted by multiples of i omega; the unshifted ones are the
    // accurate ones.
    std::sort(exponents.begin(), exponents.end(),
              [](const auto &a, const auto &b) { return std::abs(a.imag()) < std::abs(b.imag()); });
    exponents.resize(flow.state_size());
    for (std::complex<double> &e : exponents) e = std::exp(e * (2 * M_PI / omega));
    std::sort(exponents.begin(), exponents.end(),
              [](const auto &a, const auto &b) { return std::abs(a) > std::abs(b); });
    return exponents;
}

} // namespace plm
