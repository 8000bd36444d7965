#include "motions/branch_point.hpp"
#include <algorithm>
#include <cmath>

namespace plm {

std::int64_t stability_of(const BranchPoint &point) {
    if (point.multipliers.empty()) return -1;
    double largest = 0;
    for (const std::complex<double> &m : point.multipliers) largest = std::max(largest, std::abs(m));
    if (std::abs(largest - 1) < point.multiplier_error) return -1;
    return largest > 1 + 1e-9 ? 0 : 1;
}

vector<double> bifurcation_tests(const vector<std::complex<double>> &multipliers) {
    if (multipliers.empty()) return {NAN, NAN};
    double doubling = 1, largest = 0;
    for (const std::complex<double> &m : multipliers) {
        const double modulus = std::abs(m), size = 1 + modulus; // no product of hundreds overflows
        if (m.imag() == 0) {
            doubling *= (m.real() + 1) / size;
            continue;
        }
        doubling *= std::abs(m + 1.0) / size; // its conjugate gives the other half
        largest = std::max(largest, modulus);
    }
    return {doubling, largest - 1};
}

void set_harmonics(Matrix &eta, std::int64_t n) {
    if (eta.cols() == 2 * n) return;
    Matrix changed(eta.rows(), 2 * n);
    const std::int64_t kept = std::min(eta.cols(), 2 * n) * eta.rows();
    std::copy(eta.data(), eta.data() + kept, changed.data());
    eta = std::move(changed);
}

double solution_distance(const BranchPoint &a, const BranchPoint &b) {
    Matrix x = a.eta, y = b.eta;
    const std::int64_t n = std::max(x.cols(), y.cols()) / 2, size = x.rows() * 2 * n;
    set_harmonics(x, n);
    set_harmonics(y, n);
    const double scale = std::max(norm2(size, x.data()), norm2(size, y.data()));
    double change = 0;
    for (std::int64_t i = 0; i < size; ++i) change = std::hypot(change, x.data()[i] - y.data()[i]);
    return std::hypot(scale > 0 ? change / scale : 0.0, a.omega / b.omega - 1);
}

BranchPoint between(const BranchPoint &a, const BranchPoint &b, double t) {
    BranchPoint p = a;
    p.motion.reset();
    Matrix towards = b.eta;
    set_harmonics(towards, p.eta.cols() / 2);
    for (std::size_t j = 0; j < p.eta_0.size(); ++j) p.eta_0[j] += t * (b.eta_0[j] - a.eta_0[j]);
    for (std::int64_t j = 0; j < p.eta.rows() * p.eta.cols(); ++j)
        p.eta.data()[j] += t * (towards.data()[j] - a.eta.data()[j]);
    p.omega += t * (b.omega - a.omega);
    return p;
}

namespace {

// Column pairs after the first `mean` columns, cosine and sine of harmonic k, become those of multiple x k.
Matrix spread_harmonics(const Matrix &from, std::int64_t mean, std::int64_t multiple) {
    const std::int64_t rows = from.rows(), h = (from.cols() - mean) / 2;
    Matrix to(rows, mean + 2 * multiple * h);
    std::copy(from.data(), from.col(mean), to.data());
    for (std::int64_t k = 1; k <= h; ++k)
        std::copy(from.col(mean + 2 * k - 2), from.col(mean + 2 * k), to.col(mean + 2 * multiple * k - 2));
    return to;
}

} // namespace

BranchPoint on_longer_period(const BranchPoint &point, std::int64_t multiple) {
    if (multiple == 1) return point;
    BranchPoint longer = point;
    longer.motion.reset();
    longer.n_harmonics = multiple * point.n_harmonics;
    longer.period_multiple = multiple * point.period_multiple;
    longer.eta = spread_harmonics(point.eta, 0, multiple);
    if (point.contact_stiffness) longer.contact_motion = spread_harmonics(point.contact_motion, 1, multiple);
    longer.multipliers.clear(); // those of the longer period are powers
    return longer;
}

} // namespace plm
