#include "orbits/recorded_motion.hpp"
#include "contact/polynomial.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

using Complex = std::complex<double>;

// m_k = integral of s^k exp(rate s) over [0, 1], k = 0 .. degree. By parts, m_k = (exp(rate) - k m_(k-1)) /
// rate: forward as long as k < |rate|, from beyond the degree backward for the rest, so that errors shrink.
void moments(Complex rate, std::int64_t degree, vector<Complex> &m) {
    constexpr std::int64_t run_up = 60; // the guess at its far end is forgotten like |rate|^k / k!
    const Complex end = std::exp(rate), inverse = 1.0 / rate;
    const double a = std::abs(rate), real = end.real(), imag = end.imag();
    const std::int64_t turn = a > static_cast<double>(degree) ? degree + 1 : static_cast<std::int64_t>(a);
    m.resize(static_cast<std::size_t>(degree + 1));
    double re = 0, im = 0;
    for (std::int64_t k = 0; k < turn; ++k) {
        const double x = real - (k > 0 ? static_cast<double>(k) * re : 1.0),
                     y = imag - static_cast<double>(k) * im;
        re = x * inverse.real() - y * inverse.imag(), im = x * inverse.imag() + y * inverse.real();
        m[k] = {re, im};
    }
    if (turn > degree) return;
    const double far = static_cast<double>(degree + run_up + 1);
    re = real / far, im = imag / far;
    for (std::int64_t k = degree + run_up;; --k) { // m_(k-1) = (exp(rate) - rate m_k) / k
        if (k <= degree) m[k] = {re, im};
        if (k == turn) return;
        const double share = 1 / static_cast<double>(k),
                     x = (real - rate.real() * re + rate.imag() * im) * share;
        im = (imag - rate.real() * im - rate.imag() * re) * share;
        re = x;
    }
}

// Integral of exp(rate t) over [0, duration].
Complex growth(Complex rate, double duration) {
    constexpr double still = 1e-8; // hardly changes
    if (std::abs(rate) * duration < still) return duration;
    return (std::exp(rate * duration) - 1.0) / rate;
}

struct FastTerm {
    Complex rate, size; // Re(size exp(rate t)), t in s from the beginning of the piece
};
using FastRow = std::vector<FastTerm>;

// p(a + (b - a) s) by repeated Horner steps.
vector<double> polynomial_between(const vector<double> &c, double a, double b) {
    vector<double> out(c);
    const std::size_t n = out.size();
    for (std::size_t i = 0; i + 1 < n; ++i)
        for (std::size_t k = n - 1; k-- > i;) out[k] += a * out[k + 1];
    double scale = 1;
    for (double &v : out) v *= scale, scale *= b - a;
    return out;
}

constexpr double resolved_turn = 3.0; // rad of a fast motion that the added powers describe
constexpr std::size_t resolved_terms = 32;

constexpr double not_worth_finding = 1e-8; // of the motion: what a crest of fast motion may be higher

// Raises `highest` to the largest value between a and b. Where what is fast turns often, the half in which
// the slow part is higher comes first: its crests leave next to nothing to look for in all other turns.
void raise_between(const vector<double> &slow, const FastRow &fast, double duration, double a, double b,
                   double tolerance, double &highest) {
    double most = 0, turn = 0;
    for (const FastTerm &f : fast) {
        const double size =
            std::abs(f.size) * std::exp(f.rate.real() * (f.rate.real() > 0 ? b : a) * duration);
        most += size;
        if (size > tolerance) turn = std::max(turn, std::abs(f.rate) * (b - a) * duration);
    }
    const bool resolved = turn <= resolved_turn;
    vector<double> p = a == 0 && b == 1 ? slow : polynomial_between(slow, a, b);
    double reach = most;
    for (std::size_t k = 1; k < p.size(); ++k) reach += std::abs(p[k]);
    if (p[0] + reach <= highest + (resolved ? 0 : tolerance)) return;
    if (!resolved) {
        const double middle = 0.5 * (a + b), quarter = 0.25 * (b - a);
        const std::int64_t n = static_cast<std::int64_t>(slow.size()) - 1;
        const bool later = evaluate_polynomial(slow.data(), n, b - quarter) >
                           evaluate_polynomial(slow.data(), n, a + quarter);
        raise_between(slow, fast, duration, later ? middle : a, later ? b : middle, tolerance, highest);
        raise_between(slow, fast, duration, later ? a : middle, later ? middle : b, tolerance, highest);
        return;
    }
    p.resize(std::max(p.size(), fast.empty() ? p.size() : resolved_terms), 0.0);
    for (const FastTerm &f : fast) {
        if (std::abs(f.rate) * (b - a) * duration > resolved_turn) continue; // has died away
        Complex term = f.size * std::exp(f.rate * (a * duration));
        for (std::size_t k = 0; k < resolved_terms; ++k) {
            p[k] += term.real();
            term *= f.rate * ((b - a) * duration) / static_cast<double>(k + 1);
        }
    }
    double lowest = -INFINITY; // of no interest
    widen_range(p.data(), static_cast<std::int64_t>(p.size()) - 1, lowest, highest);
}

void widen_between(vector<double> slow, FastRow fast, double duration, ValueRange &range) {
    double size = 0;
    for (std::size_t k = 1; k < slow.size(); ++k) size += std::abs(slow[k]);
    for (const FastTerm &f : fast) size += std::abs(f.size);
    raise_between(slow, fast, duration, 0, 1, not_worth_finding * size, range.maximum);
    for (double &c : slow) c = -c;
    for (FastTerm &f : fast) f.size = -f.size;
    double lowest = -range.minimum;
    raise_between(slow, fast, duration, 0, 1, not_worth_finding * size, lowest);
    range.minimum = -lowest;
}

} // namespace

void RecordedMotion::record(const FlowPiece &piece) {
    pieces_.push_back({duration_, piece.duration, piece.coefficient, piece.states,
                       piece.fast ? *piece.fast : FastMotion()});
    duration_ += piece.duration;
}

vector<double> RecordedMotion::mean() const {
    vector<double> sum(pieces_.empty() ? 0 : pieces_[0].coefficient.rows(), 0.0);
    for (const Piece &p : pieces_)
        for (std::int64_t k = 0; k < p.coefficient.cols(); ++k) {
            const double share = p.duration / duration_ / static_cast<double>(k + 1);
            for (std::size_t j = 0; j < sum.size(); ++j) sum[j] += share * p.coefficient.col(k)[j];
        }
    for (const Piece &p : pieces_)
        for (std::size_t k = 0; k < p.fast.rate.size(); ++k) {
            const Complex w = growth(p.fast.rate[k], p.duration) / duration_;
            const std::int64_t column = static_cast<std::int64_t>(k);
            for (std::size_t j = 0; j < sum.size(); ++j)
                sum[j] += (w * Complex(p.fast.cosine.col(column)[j], p.fast.sine.col(column)[j])).real();
        }
    return sum;
}

namespace {

// Integral of |y|^2 over a piece: of the polynomials, of what is fast, and of both together.
double square_of(const Matrix &powers, const FastMotion &fast, double duration) {
    const Matrix inner = product('T', 'N', powers, powers);
    double sum = 0;
    for (std::int64_t k = 0; k < inner.cols(); ++k)
        for (std::int64_t i = 0; i < inner.rows(); ++i) sum += inner(i, k) / static_cast<double>(i + k + 1);
    sum *= duration;
    const std::int64_t n = powers.rows();
    vector<Complex> m;
    for (std::size_t k = 0; k < fast.rate.size(); ++k) {
        const double *a = fast.cosine.col(static_cast<std::int64_t>(k)),
                     *b = fast.sine.col(static_cast<std::int64_t>(k));
        moments(fast.rate[k] * duration, powers.cols() - 1, m);
        for (std::int64_t i = 0; i < powers.cols(); ++i)
            sum +=
                2 * duration *
                (Complex(dot(n, powers.col(i), a), dot(n, powers.col(i), b)) * m[static_cast<std::size_t>(i)])
                    .real();
        for (std::size_t l = 0; l < fast.rate.size(); ++l) {
            const double *c = fast.cosine.col(static_cast<std::int64_t>(l)),
                         *d = fast.sine.col(static_cast<std::int64_t>(l));
            const double ac = dot(n, a, c), bd = dot(n, b, d), ad = dot(n, a, d), bc = dot(n, b, c);
            sum +=
                0.5 * (Complex(ac - bd, ad + bc) * growth(fast.rate[k] + fast.rate[l], duration) +
                       Complex(ac + bd, bc - ad) * growth(fast.rate[k] + std::conj(fast.rate[l]), duration))
                          .real();
        }
    }
    return sum;
}

} // namespace

double RecordedMotion::mean_square(const Matrix &a) const {
    const vector<double> mean = this->mean();
    double sum = 0;
    for (const Piece &p : pieces_) {
        Matrix powers = p.coefficient;
        FastMotion fast = p.fast;
        for (std::size_t j = 0; j < mean.size(); ++j) powers.col(0)[j] -= mean[j];
        if (a.cols() > 0) {
            powers = product('N', 'N', a, powers);
            if (!fast.rate.empty()) {
                fast.cosine = product('N', 'N', a, fast.cosine);
                fast.sine = product('N', 'N', a, fast.sine);
            }
        }
        sum += square_of(powers, fast, p.duration) / duration_;
    }
    return std::max(sum, 0.0);
}

Matrix RecordedMotion::harmonics(std::int64_t first, std::int64_t count) const {
    const std::int64_t n = pieces_.empty() ? 0 : pieces_[0].coefficient.rows();
    Matrix found(n, 2 * count), weight;
    vector<Complex> m;
    for (const Piece &p : pieces_) {
        const std::int64_t terms = p.coefficient.cols();
        weight.reset(terms, 2 * count);
        for (std::int64_t h = 0; h < count; ++h) {
            const double per_time = 2 * M_PI * static_cast<double>(first + h) / duration_;
            moments(Complex(0, -per_time * p.duration), terms - 1, m);
            const Complex phase = std::polar(2 * p.duration / duration_, -per_time * p.start);
            for (std::int64_t k = 0; k < terms; ++k) {
                const Complex w = phase * m[k]; // y = Re(Y exp(i h w t)): a = Re Y, b = -Im Y
                weight(k, 2 * h) = w.real();
                weight(k, 2 * h + 1) = -w.imag();
            }
        }
        gemm('N', 'N', 1.0, p.coefficient, weight, 1.0, found);
        for (std::size_t k = 0; k < p.fast.rate.size(); ++k) add_fast(p, k, first, found);
    }
    return found;
}

// y = Re(q exp(rate t)) = (q exp(rate t) + its conjugate) / 2.
void RecordedMotion::add_fast(const Piece &p, std::size_t k, std::int64_t first, Matrix &found) const {
    const std::int64_t column = static_cast<std::int64_t>(k);
    for (std::int64_t h = 0; 2 * h < found.cols(); ++h) {
        const double per_time = 2 * M_PI * static_cast<double>(first + h) / duration_;
        const Complex turn(0, per_time), phase = std::polar(1 / duration_, -per_time * p.start),
                                         w = phase * growth(p.fast.rate[k] - turn, p.duration),
                                         back = phase * growth(std::conj(p.fast.rate[k]) - turn, p.duration);
        for (std::int64_t j = 0; j < found.rows(); ++j) {
            const Complex q(p.fast.cosine(j, column), p.fast.sine(j, column)),
                y = w * q + back * std::conj(q);
            found(j, 2 * h) += y.real();
            found(j, 2 * h + 1) -= y.imag();
        }
    }
}

// Where what is fast might raise or lower an extremum, the piece is halved until a polynomial describes it,
// too.
void RecordedMotion::widen_by_piece(const Piece &piece, const double *row, ValueRange &range) {
    const std::int64_t n = piece.coefficient.rows(), degree = piece.coefficient.cols() - 1;
    vector<double> slow(static_cast<std::size_t>(degree + 1), 0.0);
    gemv('T', 1.0, piece.coefficient, row, 0.0, slow.data());
    FastRow fast;
    for (std::size_t k = 0; k < piece.fast.rate.size(); ++k) {
        const std::int64_t column = static_cast<std::int64_t>(k);
        fast.push_back(
            {piece.fast.rate[k],
             {dot(n, row, piece.fast.cosine.col(column)), dot(n, row, piece.fast.sine.col(column))}});
    }
    widen_between(std::move(slow), std::move(fast), piece.duration, range);
}

std::vector<ValueRange> RecordedMotion::ranges(const Matrix &rows) const {
    std::vector<ValueRange> out(static_cast<std::size_t>(rows.rows()), {INFINITY, -INFINITY});
    const Matrix by_row = rows.transposed();
    for (const Piece &p : pieces_)
        for (std::int64_t i = 0; i < rows.rows(); ++i)
            widen_by_piece(p, by_row.col(i), out[static_cast<std::size_t>(i)]);
    return out;
}

RecordedMotion RecordedMotion::contact_forces(const FlowModel &model) const {
    RecordedMotion forces;
    forces.duration_ = duration_;
    for (const Piece &p : pieces_) {
        const vector<double> springs = model.contact().springs(p.states); // 0 where open
        const auto pressed = [&](const Matrix &motion) {
            Matrix force = product('N', 'N', model.gap(), motion);
            for (std::int64_t k = 0; k < force.cols(); ++k)
                for (std::size_t i = 0; i < springs.size(); ++i) force.col(k)[i] *= springs[i];
            return force;
        };
        Piece now{p.start, p.duration, pressed(p.coefficient), p.states, {p.fast.rate, Matrix(), Matrix()}};
        for (std::size_t i = 0; i < springs.size(); ++i)
            now.coefficient.col(0)[i] -= springs[i] * model.initial_gap()[i];
        now.fast.cosine = p.fast.rate.empty() ? Matrix() : pressed(p.fast.cosine);
        now.fast.sine = p.fast.rate.empty() ? Matrix() : pressed(p.fast.sine);
        forces.pieces_.push_back(std::move(now));
    }
    return forces;
}

vector<double> RecordedMotion::closed_shares() const {
    vector<double> share(pieces_.empty() ? 0 : pieces_[0].states.size(), 0.0);
    for (const Piece &p : pieces_)
        for (std::size_t i = 0; i < share.size(); ++i)
            if (p.states.is_closed(static_cast<std::int64_t>(i))) share[i] += p.duration / duration_;
    return share;
}

std::int64_t RecordedMotion::n_switching() const {
    std::int64_t n = 0;
    const std::int64_t pairs = pieces_.empty() ? 0 : pieces_[0].states.size();
    for (std::int64_t i = 0; i < pairs; ++i)
        n += std::any_of(pieces_.begin(), pieces_.end(), [&](const Piece &p) {
            return p.states.is_closed(i) != pieces_[0].states.is_closed(i);
        });
    return n;
}

vector<double> orbit_peaks(ExactFlow &flow, const FlowState &start, std::int64_t period_multiple,
                           const Matrix &rows) {
    if (rows.cols() != flow.model().size())
        throw Error(PLM_ERR_ARGUMENT, "the rows do not fit the coordinates of the flow").argument("rows");
    RecordedMotion motion;
    FlowState state = start;
    flow.advance(state, state.time + static_cast<double>(period_multiple) * flow.period(), &motion);
    vector<double> peaks;
    for (const ValueRange &range : motion.ranges(rows))
        peaks.push_back(std::max(std::abs(range.minimum), std::abs(range.maximum)));
    return peaks;
}

} // namespace plm
