#include "orbits/recorded_motion.hpp"
#include "contact/polynomial.hpp"
#include "linalg/work.hpp"
#include "orbits/exponential_integrals.hpp"
#include "orbits/load_powers.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

using Complex = std::complex<double>;

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

constexpr double not_worth_finding = 1e-10; // of the motion: what a crest of fast motion may be higher

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

// As many powers as add more than rounding to the motion: there are as many as the fastest mode asks for,
// which hardly moves.
std::int64_t n_felt(const Matrix &powers) {
    constexpr double rounding = 1e-17;
    double largest = 0;
    std::int64_t n = 0;
    for (std::int64_t k = 0; k < powers.cols(); ++k) {
        const double size = norm2(powers.rows(), powers.col(k));
        largest = std::max(largest, size);
        if (!(size <= rounding * largest)) n = k + 1;
    }
    return std::max<std::int64_t>(n, 1);
}

} // namespace

// Flops of a piece: for so many exponentials the integrals of all its terms, and products with so many
// columns.
double RecordedMotion::work_of(const Piece &p, double exponentials, double columns) {
    constexpr double of_exponential = 200, of_moment = 20, of_integral = 100;
    const double powers = static_cast<double>(p.coefficient.cols()),
                 fast = static_cast<double>(p.fast.rate.size());
    return exponentials * (of_exponential + of_moment * powers + of_integral * fast) +
           in_products * 2 * columns * static_cast<double>(p.coefficient.rows()) * (powers + 2 * fast);
}

void RecordedMotion::record(const FlowPiece &piece) {
    if (pieces_.empty()) begin_ = piece.start;
    pieces_.push_back({duration_, piece.duration, piece.coefficient.columns(0, n_felt(piece.coefficient)),
                       piece.states, piece.fast ? *piece.fast : FastMotion()});
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
            const Complex rate = p.fast.rate[k],
                          w = exponential_integral(rate, p.duration, std::exp(rate * p.duration)) / duration_;
            const std::int64_t column = static_cast<std::int64_t>(k);
            for (std::size_t j = 0; j < sum.size(); ++j)
                sum[j] += (w * Complex(p.fast.cosine.col(column)[j], p.fast.sine.col(column)[j])).real();
        }
    return sum;
}

namespace {

// W of the integral F W F^T of y y^T over a piece, y = F (1, s, s^2 ..., Re e_1, ... -Im e_1, ...), e_k =
// exp(rate_k t): F has the powers, the cosine and the sine parts side by side.
Matrix weigh_squares(std::int64_t n_powers, const FastMotion &fast, double duration) {
    const std::int64_t n = static_cast<std::int64_t>(fast.rate.size()), p = n_powers;
    Matrix w(p + 2 * n, p + 2 * n);
    for (std::int64_t k = 0; k < p; ++k)
        for (std::int64_t i = 0; i < p; ++i) w(i, k) = duration / static_cast<double>(i + k + 1);
    const auto put = [&w](std::int64_t i, std::int64_t k, double value) { w(i, k) = w(k, i) = value; };
    vector<Complex> m, end;
    for (std::int64_t k = 0; k < n; ++k) {
        const Complex rate = fast.rate[k];
        end.push_back(std::exp(rate * duration));
        exponential_moments(rate * duration, end[k], p - 1, m);
        for (std::int64_t i = 0; i < p; ++i) {
            put(i, p + k, duration * m[i].real());
            put(i, p + n + k, -duration * m[i].imag());
        }
        for (std::int64_t l = 0; l <= k; ++l) {
            const Complex other = fast.rate[l],
                          same = 0.5 * exponential_integral(rate + other, duration, end[k] * end[l]),
                          against = 0.5 * exponential_integral(rate + std::conj(other), duration,
                                                               end[k] * std::conj(end[l]));
            put(p + k, p + l, (against + same).real());
            put(p + n + k, p + n + l, (against - same).real());
            put(p + n + k, p + l, -(against + same).imag());
            put(p + k, p + n + l, (against - same).imag());
        }
    }
    return w;
}

} // namespace

Matrix RecordedMotion::covariance() const {
    const vector<double> mean = this->mean();
    const std::int64_t n = static_cast<std::int64_t>(mean.size());
    Matrix sum(n, n), weighted;
    for (const Piece &p : pieces_) {
        Matrix parts = p.coefficient;
        for (std::int64_t j = 0; j < n; ++j) parts.col(0)[j] -= mean[j];
        parts.append(p.fast.cosine);
        parts.append(p.fast.sine);
        worked(work_of(p, static_cast<double>(p.fast.rate.size()), static_cast<double>(n + parts.cols())));
        weighted.reset(n, parts.cols());
        gemm('N', 'N', 1 / duration_, parts, weigh_squares(p.coefficient.cols(), p.fast, p.duration), 0.0,
             weighted);
        gemm('N', 'T', 1.0, weighted, parts, 1.0, sum);
    }
    return sum;
}

Matrix RecordedMotion::harmonics(std::int64_t first, std::int64_t count) const {
    const std::int64_t n = pieces_.empty() ? 0 : pieces_[0].coefficient.rows();
    Matrix found(n, 2 * count), weight(0, 2 * count), of_sine;
    for (const Piece &p : pieces_) {
        worked(work_of(p, static_cast<double>(count), 2.0 * static_cast<double>(count)));
        weigh_powers(p, first, weight);
        gemm('N', 'N', 1.0, p.coefficient, weight, 1.0, found);
        if (p.fast.rate.empty()) continue;
        weigh_fast(p, first, weight, of_sine);
        gemm('N', 'N', 1.0, p.fast.cosine, weight, 1.0, found);
        gemm('N', 'N', 1.0, p.fast.sine, of_sine, 1.0, found);
    }
    return found;
}

// What each power of a piece adds to harmonic h, y = Re(Y exp(i h w t)): a = Re Y, b = -Im Y.
void RecordedMotion::weigh_powers(const Piece &p, std::int64_t first, Matrix &weight) const {
    const std::int64_t terms = p.coefficient.cols(), count = weight.cols() / 2;
    const double turn = 2 * M_PI * p.duration / duration_; // of the first harmonic during the piece
    const auto turned_by = [](double angle) { return std::polar(1.0, -angle); };
    const double start = 2 * M_PI * p.start / duration_, number_of_first = static_cast<double>(first);
    const Complex next_end = turned_by(turn), next_phase = turned_by(start);
    Complex end = turned_by(number_of_first * turn),
            phase = 2 * p.duration / duration_ * turned_by(number_of_first * start);
    vector<Complex> m;
    weight.reset(terms, weight.cols());
    for (std::int64_t h = 0; h < count; ++h, end *= next_end, phase *= next_phase) {
        exponential_moments({0, -(number_of_first + static_cast<double>(h)) * turn}, end, terms - 1, m);
        for (std::int64_t k = 0; k < terms; ++k) {
            const Complex w = phase * m[k];
            weight(k, 2 * h) = w.real();
            weight(k, 2 * h + 1) = -w.imag();
        }
    }
}

// The same of fast motions, y = Re(q exp(rate t)) = (q exp(rate t) + its conjugate) / 2, q = cosine + i sine.
void RecordedMotion::weigh_fast(const Piece &p, std::int64_t first, Matrix &of_cosine,
                                Matrix &of_sine) const {
    const std::int64_t n = static_cast<std::int64_t>(p.fast.rate.size());
    vector<Complex> end;
    for (const Complex &rate : p.fast.rate) end.push_back(std::exp(rate * p.duration));
    of_cosine.reset(n, of_cosine.cols());
    of_sine.reset(n, of_cosine.cols());
    for (std::int64_t h = 0; 2 * h < of_cosine.cols(); ++h) {
        const double per_time = 2 * M_PI * static_cast<double>(first + h) / duration_;
        const Complex turn(0, per_time), turned = std::polar(1.0, -per_time * p.duration),
                                         phase = 1 / duration_ * std::polar(1.0, -per_time * p.start);
        for (std::int64_t k = 0; k < n; ++k) {
            const Complex rate = p.fast.rate[k],
                          w = phase * exponential_integral(rate - turn, p.duration, end[k] * turned),
                          back = phase * exponential_integral(std::conj(rate) - turn, p.duration,
                                                              std::conj(end[k]) * turned);
            of_cosine(k, 2 * h) = w.real() + back.real();
            of_cosine(k, 2 * h + 1) = -w.imag() - back.imag();
            of_sine(k, 2 * h) = back.imag() - w.imag();
            of_sine(k, 2 * h + 1) = back.real() - w.real();
        }
    }
}

// Where what is fast might raise or lower an extremum, the piece is halved until a polynomial describes it,
// too.
void RecordedMotion::widen_by_piece(const Piece &piece, const double *row, const KnownMotion &known,
                                    double omega, ValueRange &range) const {
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
    for (const auto &[harmonic, u] : known)
        fast.push_back(
            {{0, harmonic * omega}, u * std::polar(1.0, harmonic * omega * (begin_ + piece.start))});
    widen_between(std::move(slow), std::move(fast), piece.duration, range);
}

std::vector<ValueRange> RecordedMotion::ranges(const Matrix &rows, const KnownMotion &known,
                                               double omega) const {
    std::vector<ValueRange> out(static_cast<std::size_t>(rows.rows()), {INFINITY, -INFINITY});
    const Matrix by_row = rows.transposed();
    for (const Piece &p : pieces_)
        for (std::int64_t i = 0; i < rows.rows(); ++i)
            widen_by_piece(p, by_row.col(i), known, omega, out[static_cast<std::size_t>(i)]);
    return out;
}

namespace {

// Z x terms, powers of the share of a piece.
Matrix gap_powers(const ExactFlow &flow, double begin, double duration) {
    constexpr double rounding = 1e-17;
    const Contact &contact = flow.model().contact();
    const std::int64_t fastest = std::max(contact.highest_motion(), 0);
    const double turn = static_cast<double>(fastest) * flow.omega() * duration;
    Matrix g(contact.n_pairs(), taylor_terms(turn, rounding));
    for (std::int64_t i = 0; i < g.rows(); ++i) g(i, 0) = contact.initial_gap[i];
    const auto powers_of = [&](const LoadPart &part) {
        return load_powers(part, flow.omega(), flow.force_scale(), begin, duration, g.cols());
    };
    add_wall_powers(contact, 1, powers_of, g);
    return g;
}

} // namespace

RecordedMotion RecordedMotion::contact_forces(const ExactFlow &flow) const {
    const FlowModel &model = flow.model();
    RecordedMotion forces;
    forces.begin_ = begin_;
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
        const Matrix gaps = gap_powers(flow, begin_ + p.start, p.duration);
        if (gaps.cols() > now.coefficient.cols())
            now.coefficient.append(Matrix(gaps.rows(), gaps.cols() - now.coefficient.cols()));
        for (std::int64_t k = 0; k < gaps.cols(); ++k)
            for (std::size_t i = 0; i < springs.size(); ++i)
                now.coefficient.col(k)[i] -= springs[i] * gaps.col(k)[i];
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

vector<char> acting_pairs(const std::vector<ContactInterval> &intervals, std::int64_t n_pairs) {
    vector<char> acting(static_cast<std::size_t>(n_pairs), 0);
    for (const ContactInterval &interval : intervals)
        for (std::int64_t pair : interval.states.closed_pairs()) acting[static_cast<std::size_t>(pair)] = 1;
    return acting;
}

vector<double> orbit_peaks(ExactFlow &flow, const FlowState &start, std::int64_t period_multiple,
                           const Matrix &rows) {
    if (rows.cols() != flow.model().size())
        throw Error(status::argument, "the rows do not fit the coordinates of the flow").argument("rows");
    RecordedMotion motion;
    FlowState state = start;
    flow.advance(state, state.time + static_cast<double>(period_multiple) * flow.period(), &motion);
    vector<double> peaks;
    for (const ValueRange &range : motion.ranges(rows))
        peaks.push_back(std::max(std::abs(range.minimum), std::abs(range.maximum)));
    return peaks;
}

} // namespace plm
