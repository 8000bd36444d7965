#include "orbits/piece_exponential.hpp"
#include "linalg/work.hpp"
#include <algorithm>
#include <cmath>
#include <limits>

namespace plm {
namespace {

// x = rate * dt. Terms of Chebyshev's series are counted up to here, and then the next step begins. What is
// damped lies beside the interval that the series is made for: its terms grow with |C| dt.
constexpr double longest_power = 100, most_damped = 1;
// The series holds for any bound of the rate: where nothing turns, a larger one keeps the units finite.
constexpr double least_step = 1e-3;
// Taylor's series: its rounding error grows with its largest term, e^x.
constexpr double longest_taylor = 3;

// exp(x z) on the imaginary interval [-i, i] is J_0(x) + 2 sum J_k(x) phi_k(z), |phi_k| <= 1 and
// |J_k(x)| <= (x / 2)^k / k!.
std::int64_t chebyshev_terms(double x, double tolerance) {
    return taylor_terms(0.5 * x, tolerance) + 1;
}

double n_steps(double x, double damped) {
    return std::max({1.0, std::ceil(x / longest_power), std::ceil(damped / most_damped)});
}

double products_by_series(double x, double damped, double tolerance) {
    const double steps = n_steps(x, damped);
    return steps * static_cast<double>(chebyshev_terms(x / steps, tolerance) - 1);
}

// The series up to 1 of the identity, squarings and one product, of 16 n^3 flops each. Each squaring doubles
// the rounding error, for which single precision has no digits.
double n_squarings(double x) {
    return std::max(0.0, std::ceil(std::log2(x)));
}
double products_by_squaring(double x, double tolerance) {
    return products_by_series(1.0, 0.0, tolerance) + 4 * (n_squarings(x) + 1);
}

// J_0(x) ... J_(n-1)(x), by their recurrence downward (Miller), where they are its decaying solution.
vector<double> bessel_functions(double x, std::int64_t n) {
    constexpr double small = 1e-250, large = 1e250;
    vector<double> j(static_cast<std::size_t>(n), 0.0);
    const std::int64_t top = n + 30 + static_cast<std::int64_t>(x);
    double above = 0, now = small, sum = 0;
    for (std::int64_t k = top; k >= 0; --k) {
        if (k < n) j[k] = now;
        if (k % 2 == 0) sum += k == 0 ? now : 2 * now; // J_0 + 2 J_2 + 2 J_4 ... = 1
        const double below = 2 * static_cast<double>(k) / x * now - above;
        above = now;
        now = below;
        if (std::abs(now) < large) continue;
        for (double *v : {&now, &above, &sum}) *v *= small;
        for (std::int64_t i = k; i < n; ++i) j[i] *= small;
    }
    for (double &v : j) v /= sum;
    return j;
}

// Of a phase beyond 1 / eps no digit is left; what overflowed has none either.
void require_resolved(double x) {
    if (x < 1 / std::numeric_limits<double>::epsilon()) return;
    throw Error(status::convergence,
                format("the structure's fastest motion turns by %.3g radian between two contact events, too "
                       "far for double precision; leave out what is so fast (a DOF nearly without mass?)",
                       x))
        .reason(reason::not_finite);
}

} // namespace

template <class Real>
PieceExponential<Real>::PieceExponential(const FlowModel &model, double tolerance)
    : model_(model), system_(model), n_(model.n_moving()), massive_(model.n_massive()),
      size_(model.state_size()), tolerance_(tolerance) {
    for (vector<Real> *v : {&block_.y, &block_.v, &older_.y, &newer_.y, &older_.v, &newer_.v})
        v->resize(n_ * size_);
    stiffness_.resize(n_ * n_);
    damping_.resize(model.has_diagonal_damping() ? n_ : n_ * n_);
}

// time^2 K and time C: of the order of one, whatever the units.
template <class Real> void PieceExponential<Real>::scale_by(double time) {
    const double *k = system_.stiffness().data();
    for (std::int64_t i = 0; i < n_ * n_; ++i) stiffness_[i] = static_cast<Real>(time * time * k[i]);
    const bool diagonal = model_.has_diagonal_damping();
    for (std::int64_t j = 0; j < (diagonal ? 1 : n_); ++j)
        for (std::int64_t i = 0; i < n_; ++i)
            damping_[i + j * n_] =
                static_cast<Real>(time * (diagonal ? model_.damping_diagonal()[i] : model_.damping()(i, j)));
}

template <class Real> double PieceExponential<Real>::cube() const {
    return static_cast<double>(n_) * static_cast<double>(n_) * static_cast<double>(n_);
}

template <class Real> void PieceExponential<Real>::make_identity(Block &block) const {
    block.y.assign(n_ * size_, 0);
    block.v.assign(n_ * size_, 0);
    for (std::int64_t j = 0; j < n_; ++j) block.y[j + j * n_] = 1;
    for (std::int64_t j = 0; j < massive_; ++j) block.v[j + (n_ + j) * n_] = 1;
}

template <class Real>
double PieceExponential<Real>::n_products(const ContactSet &set, double dt, double tolerance) {
    const double x = set.rate() * dt, series = products_by_series(x, set.damping_bound() * dt, tolerance);
    return std::is_same_v<Real, float> ? series : std::min(series, products_by_squaring(x, tolerance));
}

template <class Real> void PieceExponential<Real>::set_identity() {
    make_identity(block_);
}

template <class Real> void PieceExponential<Real>::set(const Matrix &m) {
    whole_.assign(m.data(), m.col(m.cols()));
    split(whole_, block_);
}

template <class Real> void PieceExponential<Real>::get(Matrix &m) const {
    vector<Real> whole;
    join(block_, whole);
    m.reset(size_, size_);
    std::copy(whole.begin(), whole.end(), m.data());
}

template <class Real> void PieceExponential<Real>::split(const vector<Real> &m, Block &block) const {
    block.v.assign(n_ * size_, 0);
    for (std::int64_t j = 0; j < size_; ++j) {
        std::copy_n(m.data() + j * size_, n_, block.y.data() + j * n_);
        std::copy_n(m.data() + j * size_ + n_, massive_, block.v.data() + j * n_);
    }
}

template <class Real> void PieceExponential<Real>::join(const Block &block, vector<Real> &m) const {
    m.resize(size_ * size_);
    for (std::int64_t j = 0; j < size_; ++j) {
        std::copy_n(block.y.data() + j * n_, n_, m.data() + j * size_);
        std::copy_n(block.v.data() + j * n_, massive_, m.data() + j * size_ + n_);
    }
}

template <class Real> void PieceExponential<Real>::apply(const PairStates &states, double dt) {
    if (dt == 0) return;
    system_.assign(states);
    const double x = system_.rate() * dt;
    const double series = products_by_series(x, system_.damping_bound() * dt, tolerance_);
    const bool is_long = relaxes() ? x > longest_taylor : products_by_squaring(x, tolerance_) < series;
    if (is_long && std::is_same_v<Real, double>)
        square(x, dt);
    else
        sum(block_, x, dt, tolerance_);
}

template <class Real> void PieceExponential<Real>::square(double x, double dt) {
    require_resolved(x);
    const int squarings = static_cast<int>(n_squarings(x));
    make_identity(step_);
    sum(step_, std::ldexp(x, -squarings), std::ldexp(dt, -squarings), std::ldexp(tolerance_, -squarings));
    join(step_, turned_);
    square_.resize(size_ * size_);
    for (int k = 0; k < squarings; ++k) {
        gemm('N', size_, size_, size_, 1, turned_.data(), size_, turned_.data(), size_, 0, square_.data(),
             size_);
        std::swap(turned_, square_);
        worked(in_products * 16 * cube());
    }
    join(block_, whole_);
    gemm('N', size_, size_, size_, 1, turned_.data(), size_, whole_.data(), size_, 0, square_.data(), size_);
    split(square_, block_);
}

template <class Real> void PieceExponential<Real>::sum(Block &block, double x, double dt, double tolerance) {
    if (relaxes()) {
        sum_taylor(block, dt, taylor_terms(x, tolerance) + 1); // the velocity's needs one term more
        return;
    }
    require_resolved(x);
    x = std::max(x, least_step);
    const double steps = n_steps(x, system_.damping_bound() * dt);
    for (double k = 0; k < steps; ++k) sum_chebyshev(block, x / steps, dt / steps, tolerance);
}

// In Y and W = dt / x V, of which A is of the order of one.
template <class Real>
void PieceExponential<Real>::sum_chebyshev(Block &block, double x, double dt, double tolerance) {
    const std::int64_t size = n_ * size_, n_terms = chebyshev_terms(x, tolerance);
    const double unit = dt / x;
    const Real into = static_cast<Real>(unit), back = static_cast<Real>(1 / unit);
    worked(in_products * static_cast<double>(n_terms) * 4 * cube());
    scale_by(unit);
    const vector<double> weight = bessel_functions(x, n_terms);
    std::copy_n(block.y.data(), size, older_.y.data());
    for (std::int64_t i = 0; i < size; ++i) older_.v[i] = into * block.v[i];
    std::copy_n(older_.v.data(), size, newer_.y.data());
    std::fill_n(newer_.v.data(), size, Real(0));
    add_acceleration(1, older_, newer_.v);
    const Real first = static_cast<Real>(weight[0]);
    for (std::int64_t i = 0; i < size; ++i) {
        block.y[i] = first * older_.y[i];
        block.v[i] = first * older_.v[i];
    }
    for (std::int64_t k = 1;; ++k) {
        const Real w = static_cast<Real>(2 * weight[k]);
        for (std::int64_t i = 0; i < size; ++i) {
            block.y[i] += w * newer_.y[i];
            block.v[i] += w * newer_.v[i];
        }
        if (k + 1 >= n_terms) break;
        for (std::int64_t i = 0; i < size; ++i) older_.y[i] += 2 * newer_.v[i];
        add_acceleration(2, newer_, older_.v);
        std::swap(older_, newer_);
    }
    for (std::int64_t i = 0; i < size; ++i) block.v[i] *= back;
}

// to -= factor (K Y + C V), both scaled.
template <class Real>
void PieceExponential<Real>::add_acceleration(double factor, const Block &of, vector<Real> &to) {
    const Real f = static_cast<Real>(factor);
    gemm('N', n_, size_, n_, -f, stiffness_.data(), n_, of.y.data(), n_, 1, to.data(), n_);
    if (model_.has_diagonal_damping()) {
        for (std::int64_t j = 0; j < size_; ++j)
            for (std::int64_t i = 0; i < n_; ++i) to[i + j * n_] -= f * damping_[i] * of.v[i + j * n_];
    } else {
        gemm('N', n_, size_, n_, -f, damping_.data(), n_, of.v.data(), n_, 1, to.data(), n_);
    }
}

template <class Real> void PieceExponential<Real>::sum_taylor(Block &block, double dt, std::int64_t n_terms) {
    worked(in_products * static_cast<double>(n_terms) * 4 * cube());
    const std::int64_t size = n_ * size_;
    const Real step = static_cast<Real>(dt);
    vector<Real> &older = older_.y, &newer = newer_.y, &next = newer_.v;
    scale_by(dt);
    std::copy_n(block.y.data(), size, older.data());
    for (std::int64_t i = 0; i < size; ++i) newer[i] = step * block.v[i];
    relax(1, dt, older, newer);
    for (std::int64_t i = 0; i < size; ++i) {
        block.y[i] += newer[i];
        block.v[i] = newer[i]; // dt v is summed: sum of k T_k
    }
    for (std::int64_t k = 2; k < n_terms; ++k) {
        next_taylor_term(k, dt);
        const Real order = static_cast<Real>(k);
        for (std::int64_t i = 0; i < size; ++i) {
            block.y[i] += next[i];
            block.v[i] += order * next[i];
        }
        std::swap(older, newer);
        std::swap(newer, next);
    }
    for (std::int64_t i = 0; i < size; ++i) block.v[i] /= step;
}

template <class Real> void PieceExponential<Real>::next_taylor_term(std::int64_t k, double dt) {
    const vector<Real> &older = older_.y, &newer = newer_.y;
    vector<Real> &next = newer_.v;
    const double order = static_cast<double>(k);
    gemm('N', n_, size_, n_, static_cast<Real>(-1 / (order * (order - 1))), stiffness_.data(), n_,
         older.data(), n_, 0, next.data(), n_);
    const Real factor = static_cast<Real>(1 / order);
    if (model_.has_diagonal_damping()) {
        for (std::int64_t j = 0; j < size_; ++j)
            for (std::int64_t i = 0; i < n_; ++i)
                next[i + j * n_] -= factor * damping_[i] * newer[i + j * n_];
    } else {
        gemm('N', n_, size_, n_, -factor, damping_.data(), n_, newer.data(), n_, 1, next.data(), n_);
    }
    relax(k, dt, newer, next);
}

template <class Real>
void PieceExponential<Real>::relax(std::int64_t k, double dt, const vector<Real> &before,
                                   vector<Real> &next) const {
    if constexpr (std::is_same_v<Real, double>)
        for (std::int64_t j = 0; j < size_; ++j)
            system_.relax(k, dt, before.data() + j * n_, nullptr, next.data() + j * n_);
}

template class PieceExponential<float>;
template class PieceExponential<double>;

} // namespace plm
