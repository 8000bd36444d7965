// The dense form costs (4H + 1) Z r^2 flops: one product with the precomputed products of gap rows.
#include "hbm/modal_jacobian.hpp"
#include "linalg/work.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

// Rows: all products g_i g_j (i <= j when symmetric) of two sets of gap columns, one column per pair.
Matrix row_products(const Matrix &left, const Matrix &right, bool symmetric) {
    const std::int64_t n = left.cols(), m = right.cols(), z = left.rows();
    Matrix products(symmetric ? n * (n + 1) / 2 : n * m, z);
    for (std::int64_t p = 0; p < z; ++p) {
        double *out = products.col(p);
        for (std::int64_t j = 0; j < m; ++j)
            for (std::int64_t i = 0; i < (symmetric ? j + 1 : n); ++i) *out++ = left(p, i) * right(p, j);
    }
    return products;
}

// What four pointers in one loop would not tell the compiler: they do not overlap.
void sum_and_difference(std::int64_t n, const double *__restrict a, double sign, const double *__restrict b,
                        double *__restrict left, double *__restrict right) {
    for (std::int64_t i = 0; i < n; ++i) {
        left[i] = a[i] + sign * b[i];
        right[i] = a[i] - sign * b[i];
    }
}

} // namespace

void gaps_of_coordinates(const Matrix &gap_0, const Matrix &gap, const double *x, Matrix &u) {
    const std::int64_t z = gap.rows(), n = u.cols() - 1;
    if (z == 0) return;
    gemv('N', 1.0, gap_0, x, 0.0, u.col(0));
    gemm('N', 1.0, gap, x + gap_0.cols(), n, 0.0, u.col(1));
}

void add_coordinates_of_gaps(const Matrix &gap_0, const Matrix &gap, double factor, const Matrix &f,
                             double *y) {
    const std::int64_t z = gap.rows(), n = f.cols() - 1;
    if (z == 0) return;
    gemv('T', factor, gap_0, f.col(0), 1.0, y);
    gemm('T', factor, gap, f.col(1), n, 1.0, y + gap_0.cols());
}

// Made when the dense form is first asked for.
struct ModalJacobian::Products {
    void make(const ReducedModel &m) {
        if (!dynamic.empty()) return;
        dynamic = row_products(m.gap, m.gap, true);
        if (m.same_static) return;
        constant = row_products(m.gap_0, m.gap_0, true);
        mixed = row_products(m.gap_0, m.gap, false);
    }
    Matrix dynamic, constant, mixed;
};

ModalJacobian::ModalJacobian(std::shared_ptr<const ReducedModel> reduced, std::int64_t n_harmonics)
    : m_(std::move(reduced)), products_(std::make_shared<Products>()), h_(n_harmonics), r_(m_->size()),
      r0_(m_->static_size()), weights_(4 * h_ + 1, m_->n_pairs()), hold_(*m_) {}

void ModalJacobian::set_tangent(const ContactIndicator &indicator, const vector<double> &stiffness) {
    acting_.clear();
    for (std::int64_t i = 0; i < m_->n_pairs(); ++i) {
        const double *average = indicator.averages.col(i);
        double *weights = weights_.col(i);
        for (std::int64_t k = 0; k <= 4 * h_; ++k) weights[k] = stiffness[i] * average[k];
        if (indicator.acts(i)) acting_.push_back(i);
    }
}

void ModalJacobian::expand_tangent() {
    const std::int64_t n = n_coefficients();
    select_rows(m_->gap, acting_, gap_);
    select_rows(m_->gap_0, acting_, gap_0_);
    tangent_.reset(n_acting(), n * n);
    for (std::int64_t p = 0; p < n_acting(); ++p) {
        const double *weights = weights_.col(acting_[p]);
        for (std::int64_t d = 0; d < n; ++d)
            for (std::int64_t c = 0; c < n; ++c) tangent_(p, c + d * n) = indicator_entry(weights, c, d);
        worked(10.0 * static_cast<double>(n * n));
    }
}

// --- products

std::complex<double> ModalJacobian::dynamic_stiffness(std::int64_t h, std::int64_t j) const {
    const double w = static_cast<double>(h) * omega_, l = m_->lambda[j];
    const double damping = m_->damping.empty() ? m_->damping_diagonal[j] : 0.0;
    const double m = m_->mass(j);
    return {l - w * w * m, m_->structural * l + w * (damping - 2 * self_excitation_ * omega_ * m)};
}

void ModalJacobian::add_linear_product(const double *x, double *y) const {
    for (std::int64_t j = 0; j < r0_; ++j) y[j] += m_->lambda_0[j] * x[j];
    const Matrix &hold = hold_.columns();
    for (std::int64_t k = 0; k < hold.cols(); ++k) {
        const double held = dot(r0_, hold.col(k), x);
        for (std::int64_t j = 0; j < r0_; ++j) y[j] += held * hold(j, k);
    }
    for (std::int64_t h = 1; h <= h_; ++h) {
        const double *a = x + cosine_at(h), *b = a + r_;
        double *c = y + cosine_at(h), *s = c + r_;
        for (std::int64_t j = 0; j < r_; ++j) {
            const std::complex<double> d = dynamic_stiffness(h, j);
            c[j] += d.real() * a[j] + d.imag() * b[j];
            s[j] += d.real() * b[j] - d.imag() * a[j];
        }
        if (m_->damping.empty()) continue;
        gemv('N', static_cast<double>(h) * omega_, m_->damping, b, 1.0, c);
        gemv('N', -static_cast<double>(h) * omega_, m_->damping, a, 1.0, s);
    }
}

void ModalJacobian::product(bool transposed, const double *x, double *y) {
    std::fill(y, y + size(), 0.0);
    if (transposed) { // D' = S D S with S = diag(1, -1) on (cosine, sine): its blocks are complex symmetric
        vector<double> &mirrored = scratch_.mirrored;
        mirrored.assign(x, x + size());
        const auto mirror = [this](double *v) {
            for (std::int64_t h = 1; h <= h_; ++h)
                for (std::int64_t j = 0; j < r_; ++j) v[cosine_at(h) + r_ + j] *= -1;
        };
        mirror(mirrored.data());
        add_linear_product(mirrored.data(), y);
        mirror(y);
    } else {
        add_linear_product(x, y);
    }
    to_gaps(x, scratch_.gaps);
    apply_tangent(transposed, scratch_.gaps, scratch_.force);
    add_from_gaps(1.0, scratch_.force, y);
}

void ModalJacobian::to_gaps(const double *x, Matrix &u) const {
    u.reset(n_acting(), n_coefficients());
    gaps_of_coordinates(gap_0_, gap_, x, u);
}

void ModalJacobian::add_from_gaps(double factor, const Matrix &f, double *y) const {
    add_coordinates_of_gaps(gap_0_, gap_, factor, f, y);
}

void ModalJacobian::apply_tangent(bool transposed, const Matrix &u, Matrix &f) const {
    const std::int64_t n = n_coefficients();
    f.reset(n_acting(), n);
    for (std::int64_t d = 0; d < n; ++d)
        for (std::int64_t c = 0; c < n; ++c) {
            const double *t = tangent_.col(transposed ? d + c * n : c + d * n), *in = u.col(d);
            double *out = f.col(c);
            for (std::int64_t p = 0; p < n_acting(); ++p) out[p] += t[p] * in[p];
        }
}

// --- the dense form

void ModalJacobian::write_to(Matrix &out) {
    if (n_acting() > 0)
        write_contact(out);
    else
        for (std::int64_t j = 0; j < size(); ++j) std::fill_n(out.col(j), size(), 0.0);
    add_linear(out);
}

void ModalJacobian::add_linear(Matrix &out) const {
    for (std::int64_t j = 0; j < r0_; ++j) out(j, j) += m_->lambda_0[j];
    const Matrix &hold = hold_.columns();
    for (std::int64_t k = 0; k < hold.cols(); ++k)
        for (std::int64_t j = 0; j < r0_; ++j)
            for (std::int64_t i = 0; i < r0_; ++i) out(i, j) += hold(i, k) * hold(j, k);
    for (std::int64_t h = 1; h <= h_; ++h) {
        const std::int64_t c = cosine_at(h), s = c + r_;
        for (std::int64_t j = 0; j < r_; ++j) {
            const std::complex<double> d = dynamic_stiffness(h, j);
            out(c + j, c + j) += d.real();
            out(s + j, s + j) += d.real();
            out(c + j, s + j) += d.imag();
            out(s + j, c + j) -= d.imag();
        }
        if (m_->damping.empty()) continue;
        const double w = static_cast<double>(h) * omega_;
        for (std::int64_t j = 0; j < r_; ++j)
            for (std::int64_t i = 0; i < r_; ++i) {
                out(c + i, s + j) += w * m_->damping(i, j);
                out(s + i, c + j) -= w * m_->damping(i, j);
            }
    }
}

// Contact matrices A_k = G' diag(weights_k) G, one per average of the indicator.
void ModalJacobian::write_contact(Matrix &out) {
    products_->make(*m_);
    Matrix &dynamic = scratch_.dynamic, &other = scratch_.other;
    expand_symmetric(products_->dynamic, r_, dynamic);
    if (m_->same_static) {
        write_static(dynamic, r_, out);
        write_mixed(dynamic, r_, out);
    } else {
        expand_symmetric(products_->constant, r0_, other);
        write_static(other, r0_, out);
        other.reshape(r0_ * r_, weights_.rows());
        gemm('N', 'T', 1.0, products_->mixed, weights_, 0.0, other);
        write_mixed(other, r0_, out);
    }
    for (std::int64_t n = 1; n <= h_; ++n)
        for (std::int64_t m = 1; m <= h_; ++m) write_dynamic(dynamic, m, n, out);
}

// One column per average: the packed upper triangles, unpacked to full n x n blocks.
void ModalJacobian::expand_symmetric(const Matrix &products, std::int64_t n, Matrix &blocks) {
    Matrix &packed = scratch_.packed;
    packed.reshape(products.rows(), weights_.rows());
    gemm('N', 'T', 1.0, products, weights_, 0.0, packed);
    blocks.reshape(n * n, weights_.rows());
    for (std::int64_t k = 0; k < weights_.rows(); ++k) {
        const double *in = packed.col(k);
        double *out = blocks.col(k);
        for (std::int64_t j = 0; j < n; ++j)
            for (std::int64_t i = 0; i <= j; ++i) out[i + j * n] = out[j + i * n] = *in++;
    }
}

void ModalJacobian::write_static(const Matrix &blocks, std::int64_t ld, Matrix &out) const {
    for (std::int64_t j = 0; j < r0_; ++j)
        for (std::int64_t i = 0; i < r0_; ++i) out(i, j) = blocks(i + j * ld, 0);
}

// Blocks between h = 0 (rows, leading dimension ld of each block) and h = n, and their transposes
// doubled.
void ModalJacobian::write_mixed(const Matrix &blocks, std::int64_t ld, Matrix &out) const {
    for (std::int64_t c = 1; c <= 2 * h_; ++c) {
        const double *block = blocks.col(c);
        const std::int64_t at = r0_ + (c - 1) * r_;
        for (std::int64_t j = 0; j < r_; ++j)
            for (std::int64_t i = 0; i < r0_; ++i) {
                out(i, at + j) = block[i + j * ld];
                out(at + j, i) = 2 * block[i + j * ld];
            }
    }
}

// The four blocks between harmonics m (rows) and n (columns); see indicator_entry.
void ModalJacobian::write_dynamic(const Matrix &blocks, std::int64_t m, std::int64_t n, Matrix &out) const {
    const std::int64_t difference = std::abs(m - n), sum = m + n;
    const double *cos_difference = blocks.col(difference == 0 ? 0 : 2 * difference - 1);
    const double *cos_sum = blocks.col(2 * sum - 1), *sin_sum = blocks.col(2 * sum);
    const double *sin_difference = blocks.col(2 * difference); // of |m - n|, not used for 0
    const double sign = m == n ? 0 : m > n ? 1 : -1;
    const std::int64_t row = cosine_at(m), column = cosine_at(n);
    worked(20.0 * static_cast<double>(r_ * r_));
    for (std::int64_t j = 0; j < r_; ++j) {
        double *left = out.col(column + j) + row, *right = out.col(column + r_ + j) + row;
        const std::int64_t at = j * r_;
        sum_and_difference(r_, cos_difference + at, 1, cos_sum + at, left, right + r_);
        sum_and_difference(r_, sin_sum + at, sign, sin_difference + at, left + r_, right);
    }
}

} // namespace plm
