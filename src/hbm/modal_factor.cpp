#include "hbm/modal_factor.hpp"
#include "linalg/work.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

using Complex = std::complex<double>;

constexpr double singular = 1e-10;  // of an entry of D against its parts: J is not solved through D then
constexpr double hopeless = 1e-4;   // a first correction this large: D is too close to singular
constexpr double refined = 1e-9;    // the next correction would be below rounding
constexpr double worthwhile = 0.85; // order of the condensed equations against that of J

} // namespace

void ModalFactor::factor(ModalJacobian &jacobian, const Border &border, bool may_condense) {
    border_ = border;
    n_inner_ = jacobian.size();
    condensed_ = false;
    if (may_condense && pays(jacobian)) {
        jacobian_ = jacobian;
        condensed_ = condense();
    }
    if (!condensed_) factor_dense(jacobian);
}

bool ModalFactor::pays(const ModalJacobian &jacobian) const {
    return static_cast<double>(n_forces(jacobian)) < worthwhile * static_cast<double>(inner_size());
}

void ModalFactor::factor_dense(ModalJacobian &jacobian) {
    const std::int64_t n = inner_size(), k = n_borders();
    condensed_ = false;
    matrix_.reshape(n + k, n + k);
    jacobian.write_to(matrix_);
    for (std::int64_t j = 0; j < k; ++j) {
        std::copy(border_.columns.col(j), border_.columns.col(j) + n, matrix_.col(n + j));
        for (std::int64_t i = 0; i < n; ++i) matrix_(n + j, i) = border_.rows(i, j);
        for (std::int64_t i = 0; i < k; ++i) matrix_(n + i, n + j) = border_.corner(i, j);
    }
    lu_.factor(matrix_);
}

// --- the condensed equations

bool ModalFactor::condense() {
    if (!invert_linear_part()) return false;
    jacobian_.expand_tangent();
    const std::int64_t n = n_forces(jacobian_) + n_borders();
    matrix_.reset(n, n);
    for (std::int64_t i = 0; i < n_forces(jacobian_); ++i) matrix_(i, i) = 1;
    if (n_forces(jacobian_) > 0)
        for (std::int64_t h = 0; h <= jacobian_.n_harmonics(); ++h) add_contact_columns(h);
    add_borders();
    scale_borders();
    lu_.factor(matrix_);
    return !lu_.singular();
}

// False when D is too close to singular.
bool ModalFactor::invert_linear_part() {
    const ReducedModel &m = jacobian_.model();
    double largest = 0;
    sign_ = 1; // complex blocks (h >= 1) have positive determinants
    for (double l : m.lambda_0) largest = std::max(largest, std::abs(l));
    for (double l : m.lambda_0) {
        if (!(std::abs(l) > singular * largest)) return false;
        if (l < 0) sign_ = -sign_;
    }
    receptance_.resize(jacobian_.n_harmonics() + 1);
    for (std::int64_t h = 1; h <= jacobian_.n_harmonics(); ++h) {
        const double w = static_cast<double>(h) * jacobian_.omega();
        for (std::int64_t j = 0; j < m.size(); ++j)
            if (!(std::abs(jacobian_.dynamic_stiffness(h, j)) >
                  singular * (std::abs(m.lambda[j]) + w * w * m.mass(j))))
                return false;
        try {
            receptance_[h].update(m, h, jacobian_.omega(), jacobian_.self_excitation());
        } catch (const Error &error) {
            if (error.status() == status::singular) return false;
            throw;
        }
    }
    return true;
}

// T R: R couples cosine and sine of harmonic h, as [real, imaginary; -imaginary, real].
void ModalFactor::add_contact_columns(std::int64_t h) {
    const std::int64_t z = jacobian_.n_acting(), n = jacobian_.n_coefficients();
    Matrix &real = real_, &imaginary = imaginary_;
    if (h > 0) {
        receptance_[h].contact_receptance(jacobian_.gap(), real, imaginary);
    } else {
        scaled_ = jacobian_.gap_0();
        for (std::int64_t j = 0; j < scaled_.cols(); ++j)
            for (std::int64_t i = 0; i < z; ++i) scaled_(i, j) /= jacobian_.model().lambda_0[j];
        real.reset(z, z);
        gemm('N', 'T', 1.0, scaled_, jacobian_.gap_0(), 0.0, real);
    }
    worked(16.0 * static_cast<double>(n * z * z));
    for (std::int64_t c = 0; c < n; ++c) {
        const double *cosine = jacobian_.tangent().col(c + (h > 0 ? 2 * h - 1 : 0) * n);
        const double *sine = h > 0 ? jacobian_.tangent().col(c + 2 * h * n) : nullptr;
        for (std::int64_t q = 0; q < z; ++q) {
            if (h == 0) {
                double *out = matrix_.col(q) + c * z;
                for (std::int64_t p = 0; p < z; ++p) out[p] += cosine[p] * real(p, q);
                continue;
            }
            double *left = matrix_.col((2 * h - 1) * z + q) + c * z, *right = left + z * matrix_.rows();
            for (std::int64_t p = 0; p < z; ++p) {
                left[p] += cosine[p] * real(p, q) - sine[p] * imaginary(p, q);
                right[p] += cosine[p] * imaginary(p, q) + sine[p] * real(p, q);
            }
        }
    }
}

void ModalFactor::add_borders() {
    const std::int64_t n = inner_size(), forces = n_forces(jacobian_), k = n_borders();
    Matrix &gaps = gaps_, &force = force_;
    vector<double> &v = v_;
    for (std::int64_t j = 0; j < k; ++j) {
        v.assign(border_.columns.col(j), border_.columns.col(j) + n);
        apply_inverse(false, v.data());
        jacobian_.to_gaps(v.data(), gaps);
        jacobian_.apply_tangent(false, gaps, force);
        std::copy(force.data(), force.data() + forces, matrix_.col(forces + j));
        for (std::int64_t i = 0; i < k; ++i)
            matrix_(forces + i, forces + j) = border_.corner(i, j) - dot(n, border_.rows.col(i), v.data());
        v.assign(border_.rows.col(j), border_.rows.col(j) + n);
        apply_inverse(true, v.data());
        jacobian_.to_gaps(v.data(), gaps);
        for (std::int64_t i = 0; i < forces; ++i) matrix_(forces + j, i) = -gaps.data()[i];
    }
}

// Their size has nothing to do with that of the others, I + T R; pivots are chosen among both.
void ModalFactor::scale_borders() {
    const std::int64_t forces = n_forces(jacobian_), n = forces + n_borders();
    scale_.assign(n_borders(), 1.0);
    for (std::int64_t i = forces; i < n; ++i) {
        double largest = 0;
        for (std::int64_t j = 0; j < n; ++j) largest = std::max(largest, std::abs(matrix_(i, j)));
        if (!(largest > 0)) continue;
        scale_[i - forces] = 1 / largest;
        for (std::int64_t j = 0; j < n; ++j) matrix_(i, j) /= largest;
    }
}

// --- solutions

void ModalFactor::apply_inverse(bool transposed, double *v) {
    const ReducedModel &m = jacobian_.model();
    const std::int64_t r = m.size();
    const double sign = transposed ? 1.0 : -1.0; // D' is D conjugated: its blocks are complex symmetric
    for (std::int64_t j = 0; j < m.static_size(); ++j) v[j] /= m.lambda_0[j];
    vector<Complex> &q = q_;
    q.resize(r);
    for (std::int64_t h = 1; h <= jacobian_.n_harmonics(); ++h) {
        double *a = v + jacobian_.cosine_at(h), *b = a + r;
        for (std::int64_t j = 0; j < r; ++j) q[j] = Complex(a[j], sign * b[j]);
        receptance_[h].apply(q.data());
        for (std::int64_t j = 0; j < r; ++j) a[j] = q[j].real(), b[j] = sign * q[j].imag();
    }
}

void ModalFactor::product(bool transposed, const double *x, double *y) {
    const std::int64_t n = inner_size(), k = n_borders();
    const Matrix &columns = transposed ? border_.rows : border_.columns;
    const Matrix &rows = transposed ? border_.columns : border_.rows;
    jacobian_.product(transposed, x, y);
    if (k == 0) return;
    gemv('N', 1.0, columns, x + n, 1.0, y);
    gemv('T', 1.0, rows, x, 0.0, y + n);
    gemv(transposed ? 'T' : 'N', 1.0, border_.corner, x + n, 1.0, y + n);
}

void ModalFactor::solve(bool transposed, double *b, std::int64_t n) {
    std::int64_t done = 0;
    while (condensed_ && done < n)
        if (solve_refined(transposed, b + done * size())) {
            ++done;
        } else {
            factor_dense(jacobian_);
        }
    b += done * size();
    transposed ? lu_.solve_transposed(b, n - done, size()) : lu_.solve(b, n - done, size());
}

// False: the corrections do not shrink; b is kept.
bool ModalFactor::solve_refined(bool transposed, double *b) {
    const std::int64_t n = size();
    const auto once = [&](double *v) { transposed ? solve_once_transposed(v) : solve_once(v); };
    vector<double> &x = x_, &change = change_;
    x.assign(b, b + n);
    change.resize(n);
    once(x.data());
    for (int k = 0; k < 3; ++k) {
        product(transposed, x.data(), change.data());
        for (std::int64_t i = 0; i < n; ++i) change[i] = b[i] - change[i];
        once(change.data());
        const double step = norm2(n, change.data()), all = norm2(n, x.data());
        if (!(step <= hopeless * all)) return false;
        for (std::int64_t i = 0; i < n; ++i) x[i] += change[i];
        if (step <= refined * all) break;
    }
    std::copy(x.begin(), x.end(), b);
    return true;
}

void ModalFactor::solve_once(double *b) {
    const std::int64_t n = inner_size(), forces = n_forces(jacobian_), k = n_borders();
    vector<double> &v = v_, &ys = forces_;
    Matrix &gaps = gaps_, &force = force_;
    v.assign(b, b + n);
    ys.resize(forces + k);
    apply_inverse(false, v.data());
    jacobian_.to_gaps(v.data(), gaps);
    jacobian_.apply_tangent(false, gaps, force);
    std::copy(force.data(), force.data() + forces, ys.data());
    for (std::int64_t i = 0; i < k; ++i)
        ys[forces + i] = scale_[i] * (b[n + i] - dot(n, border_.rows.col(i), v.data()));
    lu_.solve(ys.data(), 1, forces + k);
    std::copy(ys.data(), ys.data() + forces, force.data());
    jacobian_.add_from_gaps(-1.0, force, b);
    std::copy(ys.data() + forces, ys.data() + forces + k, b + n);
    if (k > 0) gemv('N', -1.0, border_.columns, b + n, 1.0, b);
    apply_inverse(false, b);
}

// The same equations transposed, for (-G z, t).
void ModalFactor::solve_once_transposed(double *b) {
    const std::int64_t n = inner_size(), forces = n_forces(jacobian_), k = n_borders();
    vector<double> &v = v_, &wt = forces_;
    Matrix &gaps = gaps_, &force = force_;
    v.assign(b, b + n);
    wt.resize(forces + k);
    apply_inverse(true, v.data());
    jacobian_.to_gaps(v.data(), gaps);
    for (std::int64_t i = 0; i < forces; ++i) wt[i] = -gaps.data()[i];
    for (std::int64_t i = 0; i < k; ++i) wt[forces + i] = b[n + i] - dot(n, border_.columns.col(i), v.data());
    lu_.solve_transposed(wt.data(), 1, forces + k);
    std::copy(wt.data(), wt.data() + forces, gaps.data());
    jacobian_.apply_tangent(true, gaps, force);
    jacobian_.add_from_gaps(1.0, force, b);
    for (std::int64_t i = 0; i < k; ++i) b[n + i] = scale_[i] * wt[forces + i];
    if (k > 0) gemv('N', -1.0, border_.rows, b + n, 1.0, b);
    apply_inverse(true, b);
}

} // namespace plm
