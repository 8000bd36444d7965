#include "orbits/monodromy.hpp"
#include "linalg/lapack.hpp"
#include "linalg/work.hpp"
#include "orbits/contact_set.hpp"
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

// What the series of a contact set is worth in pieces of the flow, by time (ContactModesKept::find).
constexpr std::int64_t effort_of_series = 4;

// The exponential of [0 I; -K -C] applied to matrices [Y; V] of n + m rows and n + m columns, n displacements
// of which the first m have mass and a velocity. With T_k the Taylor terms of Y, T_{k+2} = -dt^2 / ((k + 1)(k
// + 2)) K T_k - dt / (k + 2) C T_{k+1}: one n x n by n x 2n product a term, two when C is not diagonal, that
// is 4 n^3 (8 n^3) flops. What has no mass relaxes (ContactSet::relax) from term to term.
class Exponential {
  public:
    Exponential(const FlowModel &model, double tolerance)
        : model_(model), system_(model), n_(model.n_moving()), massive_(model.n_massive()),
          size_(model.state_size()), tolerance_(tolerance), older_(n_, size_), newer_(n_, size_),
          next_(n_, size_), y_(n_, size_), v_(n_, size_) {}

    void apply(const ContactInterval &interval, Matrix &m) {
        system_.assign(interval.states);
        const double x = system_.rate() * interval.duration;
        if (x <= longest_series) {
            split(m);
            series(interval.duration, n_terms(x, tolerance_));
            join(m);
            return;
        }
        require_resolved(x);
        const int squarings = static_cast<int>(std::ceil(std::log2(x)));
        set_identity(step_);
        split(step_);
        series(std::ldexp(interval.duration, -squarings),
               n_terms(std::ldexp(x, -squarings), std::ldexp(tolerance_, -squarings)));
        join(step_);
        square_.reset(size_, size_);
        for (int k = 0; k < squarings; ++k) {
            gemm('N', 'N', 1.0, step_, step_, 0.0, square_);
            std::swap(step_, square_);
            worked(16 * cube());
        }
        gemm('N', 'N', 1.0, step_, m, 0.0, square_);
        std::swap(m, square_);
    }

    void set_identity(Matrix &m) const {
        m.reset(size_, size_);
        for (std::int64_t j = 0; j < size_; ++j) m(j, j) = 1;
    }

  private:
    // Of a phase beyond 1 / eps no digit is left; what overflowed has none either.
    static void require_resolved(double x) {
        if (x < 1 / std::numeric_limits<double>::epsilon()) return;
        throw Error(
            PLM_ERR_CONVERGENCE,
            format("the structure's fastest motion turns by %.3g radian between two contact events, too "
                   "far for double precision; leave out what is so fast (a DOF nearly without mass?)",
                   x))
            .reason(PLM_REASON_NOT_FINITE);
    }

    double cube() const {
        return static_cast<double>(n_) * static_cast<double>(n_) * static_cast<double>(n_);
    }

    // The velocity's series is the derivative of the displacement's: it needs one term more.
    static std::int64_t n_terms(double x, double tolerance) { return taylor_terms(x, tolerance) + 1; }

    // [y_; v_] becomes exp(A dt) [y_; v_].
    void series(double dt, std::int64_t n_terms) {
        if (dt == 0) return;
        worked(static_cast<double>(n_terms) * 4 * cube());
        const std::int64_t size = n_ * size_;
        std::copy_n(y_.data(), size, older_.data());
        for (std::int64_t i = 0; i < size; ++i) newer_.data()[i] = dt * v_.data()[i];
        relax(1, dt, older_, newer_);
        for (std::int64_t i = 0; i < size; ++i) {
            y_.data()[i] += newer_.data()[i];
            v_.data()[i] = newer_.data()[i]; // dt v is summed: sum of k T_k
        }
        for (std::int64_t k = 2; k < n_terms; ++k) {
            const double order = static_cast<double>(k);
            gemm('N', 'N', -dt * dt / (order * (order - 1)), system_.stiffness(), older_, 0.0, next_);
            subtract_damping(dt / order);
            relax(k, dt, newer_, next_);
            for (std::int64_t i = 0; i < size; ++i) {
                y_.data()[i] += next_.data()[i];
                v_.data()[i] += order * next_.data()[i];
            }
            std::swap(older_, newer_);
            std::swap(newer_, next_);
        }
        for (std::int64_t i = 0; i < size; ++i) v_.data()[i] /= dt;
    }

    void relax(std::int64_t k, double dt, const Matrix &before, Matrix &next) const {
        if (n_ == massive_) return;
        for (std::int64_t j = 0; j < size_; ++j) system_.relax(k, dt, before.col(j), nullptr, next.col(j));
    }

    void subtract_damping(double factor) {
        if (!model_.has_diagonal_damping()) {
            if (damping_.empty()) damping_ = moving_part(model_.damping());
            gemm('N', 'N', -factor, damping_, newer_, 1.0, next_);
            return;
        }
        const vector<double> &c = model_.damping_diagonal();
        for (std::int64_t j = 0; j < size_; ++j)
            for (std::int64_t i = 0; i < n_; ++i) next_(i, j) -= factor * c[i] * newer_(i, j);
    }

    Matrix moving_part(const Matrix &c) const {
        Matrix part(n_, n_);
        for (std::int64_t j = 0; j < n_; ++j) std::copy_n(c.col(j), n_, part.col(j));
        return part;
    }

    void split(const Matrix &m) {
        for (std::int64_t j = 0; j < size_; ++j) {
            std::copy_n(m.col(j), n_, y_.col(j));
            std::copy_n(m.col(j) + n_, massive_, v_.col(j));
            std::fill(v_.col(j) + massive_, v_.col(j) + n_, 0.0);
        }
    }

    void join(Matrix &m) const {
        for (std::int64_t j = 0; j < size_; ++j) {
            std::copy_n(y_.col(j), n_, m.col(j));
            std::copy_n(v_.col(j), massive_, m.col(j) + n_);
        }
    }

    const FlowModel &model_;
    ContactSet system_;
    std::int64_t n_, massive_, size_;
    double tolerance_;
    Matrix older_, newer_, next_, y_, v_, step_, square_, damping_;
};

void check(const FlowModel &model, const ContactInterval &interval, std::int64_t index) {
    if (interval.states.size() != model.n_pairs())
        throw Error(PLM_ERR_ARGUMENT,
                    format("contact interval %lld has states of %lld pairs where the model has %lld",
                           static_cast<long long>(index), static_cast<long long>(interval.states.size()),
                           static_cast<long long>(model.n_pairs())))
            .argument("intervals")
            .index(index);
    if (!(interval.duration >= 0 && std::isfinite(interval.duration)))
        throw Error(PLM_ERR_ARGUMENT, format("contact interval %lld has the duration %g",
                                             static_cast<long long>(index), interval.duration))
            .argument("intervals")
            .index(index);
}

double cube_of(const Matrix &m) {
    return static_cast<double>(m.rows()) * static_cast<double>(m.rows()) * static_cast<double>(m.cols());
}

} // namespace

Matrix monodromy(const FlowModel &model, const std::vector<ContactInterval> &intervals, double tolerance,
                 Watch watch, ContactModesKept *modes) {
    Exponential exponential(model, tolerance);
    Matrix m, scratch;
    exponential.set_identity(m);
    std::shared_ptr<const ContactModes> at; // in whose coordinates m is; null: in those of the state
    const std::int64_t n = static_cast<std::int64_t>(intervals.size());
    for (std::int64_t i = 0; i < n; ++i) {
        check(model, intervals[i], i);
        if (i % 16 == 0) watch.step("monodromy", static_cast<double>(i) / static_cast<double>(n));
        const auto next = modes ? modes->find(intervals[i].states, effort_of_series) : nullptr;
        if (at && next) {
            const Matrix &way = modes->transition(at, next);
            scratch.reset(m.rows(), m.cols());
            gemm('N', 'N', 1.0, way, m, 0.0, scratch);
            std::swap(m, scratch);
            worked(cube_of(m));
        } else if (at) {
            at->leave(m);
        } else if (next) {
            next->enter(m);
        }
        at = next;
        if (at)
            at->turn(intervals[i].duration, m);
        else
            exponential.apply(intervals[i], m);
    }
    if (at) at->leave(m);
    return m;
}

vector<std::complex<double>> multipliers(const Matrix &monodromy) {
    return general_eigenvalues(monodromy);
}

} // namespace plm
