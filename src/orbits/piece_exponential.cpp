#include "orbits/piece_exponential.hpp"
#include "linalg/work.hpp"
#include <algorithm>
#include <cmath>
#include <limits>

namespace plm {
namespace {

// x = rate * dt. Up to this x the series is applied to the matrix as it is, beyond it to the identity, and
// the result is squared: m(x) terms of 4 n^3 flops each against m(1) terms, log2(x) squarings and one product
// of 16 n^3 flops. The rounding error grows with the largest term, e^x, which is the other reason to stop
// here.
constexpr double longest_series = 3.0;
// Each squaring doubles the rounding error, too. Single precision has no digits for that: step by step.
double steps_in_single(double x) {
    constexpr double longest = 1.5;
    return std::max(1.0, std::ceil(x / longest));
}

// Of a phase beyond 1 / eps no digit is left; what overflowed has none either.
void require_resolved(double x) {
    if (x < 1 / std::numeric_limits<double>::epsilon()) return;
    throw Error(PLM_ERR_CONVERGENCE,
                format("the structure's fastest motion turns by %.3g radian between two contact events, too "
                       "far for double precision; leave out what is so fast (a DOF nearly without mass?)",
                       x))
        .reason(PLM_REASON_NOT_FINITE);
}

} // namespace

template <class Real>
PieceExponential<Real>::PieceExponential(const FlowModel &model, double tolerance)
    : model_(model), system_(model), n_(model.n_moving()), massive_(model.n_massive()),
      size_(model.state_size()), tolerance_(tolerance) {
    for (vector<Real> *v : {&block_.y, &block_.v, &older_, &newer_, &next_}) v->resize(n_ * size_);
    stiffness_.resize(n_ * n_);
    damping_.resize(model.has_diagonal_damping() ? n_ : n_ * n_);
}

// dt^2 K and dt C: of the order of x, whatever the units.
template <class Real> void PieceExponential<Real>::scale_by(double dt) {
    const double *k = system_.stiffness().data();
    for (std::int64_t i = 0; i < n_ * n_; ++i) stiffness_[i] = static_cast<Real>(dt * dt * k[i]);
    const bool diagonal = model_.has_diagonal_damping();
    for (std::int64_t j = 0; j < (diagonal ? 1 : n_); ++j)
        for (std::int64_t i = 0; i < n_; ++i)
            damping_[i + j * n_] =
                static_cast<Real>(dt * (diagonal ? model_.damping_diagonal()[i] : model_.damping()(i, j)));
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

template <class Real> double PieceExponential<Real>::n_products(double x, double tolerance) {
    if constexpr (std::is_same_v<Real, float>) {
        const double steps = steps_in_single(x);
        return steps * static_cast<double>(taylor_terms(x / steps, tolerance) - 1);
    }
    if (x <= longest_series) return static_cast<double>(taylor_terms(x, tolerance) - 1);
    return static_cast<double>(taylor_terms(1.0, tolerance)) + 4 * (std::ceil(std::log2(x)) + 1);
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

// The velocity's series is the derivative of the displacement's: it needs one term more.
template <class Real> std::int64_t PieceExponential<Real>::n_terms(double x, double tolerance) const {
    return taylor_terms(x, tolerance) + 1;
}

template <class Real> void PieceExponential<Real>::apply(const PairStates &states, double dt) {
    if (dt == 0) return;
    system_.assign(states);
    const double x = system_.rate() * dt;
    if constexpr (std::is_same_v<Real, float>) {
        const double steps = steps_in_single(x);
        for (double k = 0; k < steps; ++k) sum(block_, dt / steps, n_terms(x / steps, tolerance_));
        return;
    }
    if (x <= longest_series) {
        sum(block_, dt, n_terms(x, tolerance_));
        return;
    }
    require_resolved(x);
    const int squarings = static_cast<int>(std::ceil(std::log2(x)));
    make_identity(step_);
    sum(step_, std::ldexp(dt, -squarings),
        n_terms(std::ldexp(x, -squarings), std::ldexp(tolerance_, -squarings)));
    join(step_, turned_);
    square_.resize(size_ * size_);
    for (int k = 0; k < squarings; ++k) {
        gemm('N', size_, size_, size_, 1, turned_.data(), size_, turned_.data(), size_, 0, square_.data(),
             size_);
        std::swap(turned_, square_);
        worked(16 * cube());
    }
    join(block_, whole_);
    gemm('N', size_, size_, size_, 1, turned_.data(), size_, whole_.data(), size_, 0, square_.data(), size_);
    split(square_, block_);
}

template <class Real> void PieceExponential<Real>::sum(Block &block, double dt, std::int64_t n_terms) {
    worked(static_cast<double>(n_terms) * 4 * cube());
    const std::int64_t size = n_ * size_;
    const Real step = static_cast<Real>(dt);
    scale_by(dt);
    std::copy_n(block.y.data(), size, older_.data());
    for (std::int64_t i = 0; i < size; ++i) newer_[i] = step * block.v[i];
    relax(1, dt, older_, newer_);
    for (std::int64_t i = 0; i < size; ++i) {
        block.y[i] += newer_[i];
        block.v[i] = newer_[i]; // dt v is summed: sum of k T_k
    }
    for (std::int64_t k = 2; k < n_terms; ++k) {
        next_term(k, dt);
        const Real order = static_cast<Real>(k);
        for (std::int64_t i = 0; i < size; ++i) {
            block.y[i] += next_[i];
            block.v[i] += order * next_[i];
        }
        std::swap(older_, newer_);
        std::swap(newer_, next_);
    }
    for (std::int64_t i = 0; i < size; ++i) block.v[i] /= step;
}

template <class Real> void PieceExponential<Real>::next_term(std::int64_t k, double dt) {
    const double order = static_cast<double>(k);
    gemm('N', n_, size_, n_, static_cast<Real>(-1 / (order * (order - 1))), stiffness_.data(), n_,
         older_.data(), n_, 0, next_.data(), n_);
    const Real factor = static_cast<Real>(1 / order);
    if (model_.has_diagonal_damping()) {
        for (std::int64_t j = 0; j < size_; ++j)
            for (std::int64_t i = 0; i < n_; ++i)
                next_[i + j * n_] -= factor * damping_[i] * newer_[i + j * n_];
    } else {
        gemm('N', n_, size_, n_, -factor, damping_.data(), n_, newer_.data(), n_, 1, next_.data(), n_);
    }
    relax(k, dt, newer_, next_);
}

template <class Real>
void PieceExponential<Real>::relax(std::int64_t k, double dt, const vector<Real> &before,
                                   vector<Real> &next) const {
    if constexpr (std::is_same_v<Real, double>)
        for (std::int64_t j = 0; j < size_ && n_ > massive_; ++j)
            system_.relax(k, dt, before.data() + j * n_, nullptr, next.data() + j * n_);
}

template class PieceExponential<float>;
template class PieceExponential<double>;

} // namespace plm
