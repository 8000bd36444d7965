#include "hbm/moving_pairs.hpp"
#include "linalg/error.hpp"
#include "linalg/work.hpp"
#include <algorithm>

namespace plm {
namespace {

using Complex = PairElimination::Complex;

constexpr std::int64_t low_harmonics = 5;
constexpr double exact = 1e-11; // residual of a solution by GMRES: below the tolerance of Newton's method
constexpr double most_of_whole = 0.5; // of the whole factorization's time, for all its solutions: then that
constexpr std::int64_t least_steps = 60, most_steps = 250;
// Factorizations of the whole matrix before GMRES is tried again: after the first failure, and at the most,
// as they double from one failure to the next.
constexpr int first_refusals = 10, most_refusals = 1000;
// What is expected of a factorization by blocks: the solutions it serves, their steps, and how many times
// longer a flop takes in products with vectors than in the factorization of a matrix.
constexpr double solutions = 6, expected_steps = 40, slowness = 8;

double cube(double x) {
    return x * x * x;
}

} // namespace

MovingPairs::MovingPairs(std::int64_t n_harmonics)
    : h_(n_harmonics), n_(2 * n_harmonics + 1), elimination_(n_harmonics + 1), patience_(first_refusals) {}

MovingPairs::Costs MovingPairs::costs() const {
    const double s = static_cast<double>(n_pairs()), n = static_cast<double>(n_), h = static_cast<double>(h_),
                 low = s * (2 * low_harmonics + 1), above = h - low_harmonics;
    return {2.0 / 3 * cube(s * n), 2.0 / 3 * cube(low) + 8.0 / 3 * above * cube(s),
            slowness * (2 * low * low + 8 * above * s * s + 8 * h * s * s + 2 * s * n * n +
                        2 * expected_steps * s * n)};
}

bool MovingPairs::pays() const {
    const Costs c = costs();
    return h_ > low_harmonics && c.blocks + solutions * expected_steps * c.step < c.whole;
}

// What GMRES may take before the whole matrix is the cheaper way.
std::int64_t MovingPairs::allowed_steps() const {
    const Costs c = costs();
    const double steps = most_of_whole * c.whole / (solutions * c.step);
    return std::max(least_steps, static_cast<std::int64_t>(std::min<double>(most_steps, steps)));
}

void MovingPairs::factor(Method method) {
    iterated_ = false;
    steps_ = 0;
    if (n_pairs() == 0) return;
    if (method == Method::automatic && refused_ > 0 && pays())
        --refused_;
    else if (method == Method::iterated || (method == Method::automatic && pays()))
        iterated_ = factor_blocks();
    if (!iterated_) factor_whole();
}

void MovingPairs::factor_whole() {
    iterated_ = false;
    assemble(h_);
    lu_.factor(matrix_);
}

// False: a block is singular.
bool MovingPairs::factor_blocks() {
    const std::int64_t s = n_pairs();
    low_ = std::min(low_harmonics, h_);
    assemble(low_);
    lu_.factor(matrix_);
    if (lu_.singular()) return false;
    above_.resize(h_ - low_);
    try {
        for (std::int64_t h = low_ + 1; h <= h_; ++h) {
            const Matrix &real = elimination_[h].real(), &imag = elimination_[h].imag();
            block_.resize(s * s);
            for (std::int64_t q = 0; q < s; ++q) { // the mean of the two is that of the stiffness over time
                const double mean =
                    0.5 * (tangent_((2 * h - 1) * (n_ + 1), q) + tangent_(2 * h * (n_ + 1), q));
                for (std::int64_t p = 0; p < s; ++p)
                    block_[p + q * s] = Complex(real(p, q), imag(p, q)) * mean + (p == q ? 1.0 : 0.0);
            }
            above_[h - low_ - 1].factor(s, block_);
        }
    } catch (const Error &error) {
        if (error.status() == status::singular) return false;
        throw;
    }
    return true;
}

// I + G T of the harmonics up to n_harmonics.
void MovingPairs::assemble(std::int64_t n_harmonics) {
    const std::int64_t s = n_pairs(), n = 2 * n_harmonics + 1;
    matrix_.reset(s * n, s * n);
    for (std::int64_t c = 0; c < n; ++c) {
        worked(8.0 * static_cast<double>(s * s * n));
        for (std::int64_t q = 0; q < s; ++q) {
            double *column = matrix_.col(c * s + q);
            const double *tangent = tangent_.col(q) + c * n_; // T(:, c) of pair q
            const double *g0 = elimination_[0].real().col(q);
            for (std::int64_t p = 0; p < s; ++p) column[p] = g0[p] * tangent[0];
            for (std::int64_t h = 1; h <= n_harmonics; ++h) {
                const double *gr = elimination_[h].real().col(q), *gi = elimination_[h].imag().col(q);
                const double yc = tangent[2 * h - 1], ys = tangent[2 * h];
                double *cosine = column + (2 * h - 1) * s, *sine = cosine + s;
                for (std::int64_t p = 0; p < s; ++p) { // u_c - i u_s = G (y_c - i y_s)
                    cosine[p] = gr[p] * yc + gi[p] * ys;
                    sine[p] = gr[p] * ys - gi[p] * yc;
                }
            }
            column[c * s + q] += 1;
        }
    }
}

void MovingPairs::solve(double *b) {
    const std::int64_t n = n_pairs() * n_;
    if (n == 0) return;
    if (iterated_) {
        if (gmres_.solve(*this, n, b, exact, allowed_steps())) {
            patience_ = first_refusals;
            return keep_sign();
        }
        refused_ = patience_;
        patience_ = std::min(2 * patience_, most_refusals);
        factor_whole();
    }
    lu_.solve(b, 1, n);
}

// A right-hand side may miss a direction: the longest solution has seen the most.
void MovingPairs::keep_sign() {
    if (gmres_.n_steps() < steps_) return;
    steps_ = gmres_.n_steps();
    sign_ = lu_.determinant_sign() * gmres_.determinant_sign();
}

void MovingPairs::force(const double *u, double *y) const {
    const std::int64_t s = n_pairs();
    std::fill(y, y + s * n_, 0.0);
    for (std::int64_t p = 0; p < s; ++p)
        for (std::int64_t c = 0; c < n_; ++c) {
            const double *tangent = tangent_.col(p) + c * n_;
            const double moved = u[c * s + p];
            for (std::int64_t row = 0; row < n_; ++row) y[row * s + p] += tangent[row] * moved;
        }
}

// The blocks of harmonics above the low ones are complex, which have positive determinants.
int MovingPairs::determinant_sign() {
    if (n_pairs() == 0) return 1;
    if (iterated_ && steps_ == 0) {
        vector<double> any = patternless_vector(n_pairs() * n_);
        solve(any.data());
    }
    return iterated_ ? sign_ : lu_.determinant_sign();
}

// r = u + G T u
void MovingPairs::product(const double *u, double *r) {
    const std::int64_t s = n_pairs();
    force_.resize(s * n_);
    force(u, force_.data());
    std::copy(u, u + s * n_, r);
    gemv('N', 1.0, elimination_[0].real(), force_.data(), 1.0, r);
    real_.reset(s, 2);
    imag_.reset(s, 2);
    for (std::int64_t h = 1; h <= h_; ++h) {
        const double *y = force_.data() + (2 * h - 1) * s;
        gemm('N', 1.0, elimination_[h].real(), y, 2, 0.0, real_.data());
        gemm('N', 1.0, elimination_[h].imag(), y, 2, 0.0, imag_.data());
        double *cosine = r + (2 * h - 1) * s, *sine = cosine + s;
        for (std::int64_t p = 0; p < s; ++p) {
            cosine[p] += real_(p, 0) + imag_(p, 1);
            sine[p] += real_(p, 1) - imag_(p, 0);
        }
    }
    worked(static_cast<double>(s * (2 * n_ * n_ + 8 * h_ * s)));
}

void MovingPairs::precondition(double *v) {
    const std::int64_t s = n_pairs(), n_low = s * (2 * low_ + 1);
    lu_.solve(v, 1, n_low);
    block_.resize(s);
    for (std::int64_t h = low_ + 1; h <= h_; ++h) {
        double *cosine = v + (2 * h - 1) * s, *sine = cosine + s;
        for (std::int64_t p = 0; p < s; ++p) block_[p] = Complex(cosine[p], -sine[p]);
        above_[h - low_ - 1].solve(block_.data(), 1, s);
        for (std::int64_t p = 0; p < s; ++p) cosine[p] = block_[p].real(), sine[p] = -block_[p].imag();
    }
}

} // namespace plm
