// Harmonic balance in reduced coordinates (paper, eq. (10)): x = [eta_0 (r_0); a_1; b_1; ...; a_H; b_H (r
// each)]. Cost of one linearisation: (4H + 1) Z r^2 flops for the contact matrices (one product with the
// precomputed products of gap rows) and 2/3 (r (2H + 1))^3 for the factorization.
#include "hbm/system.hpp"
#include "linalg/lapack.hpp"
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

class ModalSystem final : public HbmSystem {
  public:
    ModalSystem(std::shared_ptr<const ReducedModel> reduced, const HbmOptions &options)
        : m_(std::move(reduced)), h_(options.n_harmonics), r_(m_->size()), r0_(m_->static_size()),
          z_(m_->n_pairs()), force_(make_contact_force(options, z_)), stiffness_(m_->contact_stiffness),
          gap_(m_->initial_gap), u_(z_, 2 * h_ + 1), contact_(z_, 2 * h_ + 1), eta_(r_, 2 * h_),
          dynamic_(z_, 2 * h_), x_(size(), 0.0) {
        dynamic_products_ = row_products(m_->gap, m_->gap, true);
        if (!m_->same_static) {
            static_products_ = row_products(m_->gap_0, m_->gap_0, true);
            mixed_products_ = row_products(m_->gap_0, m_->gap, false);
        }
        load_.assign(size(), 0.0);
        fill_excitation();
        ModalSystem::set_force_scale(options.force_scale);
    }

    std::int64_t size() const override { return r0_ + 2 * h_ * r_; }
    std::int64_t static_size() const override { return r0_; }

    void set_force_scale(double scale) override {
        for (std::int64_t j = 0; j < size(); ++j) load_[j] = scale * excitation_[j];
        for (std::int64_t j = 0; j < r0_; ++j) load_[j] += m_->preload_0[j];
    }

    void force_derivative(double *r) override {
        for (std::int64_t j = 0; j < size(); ++j) r[j] = -excitation_[j];
    }

    void set_stiffness_factor(double factor) override {
        for (std::int64_t i = 0; i < z_; ++i) stiffness_[i] = factor * m_->contact_stiffness[i];
    }

    void stiffness_derivative(double *r) override { // B' N
        std::fill(r, r + size(), 0.0);
        if (z_ > 0) add_contact_force(r);
    }

    void set_extra_gap(double extra) override {
        for (std::int64_t i = 0; i < z_; ++i) gap_[i] = m_->initial_gap[i] + extra;
    }

    void gap_derivative(double *r) override { // B' dN/d gap, dN = -k J(s) e_0
        const std::int64_t n = 2 * h_ + 1;
        Matrix change(z_, n);
        for (std::int64_t i = 0; i < z_; ++i)
            for (std::int64_t c = 0; c < n; ++c)
                change(i, c) = -stiffness_[i] * indicator_entry(indicator_.averages.col(i), c, 0);
        gemv('T', 1.0, m_->gap_0, change.col(0), 0.0, r);
        gemm('T', 'N', 1.0, m_->gap, dynamic_columns(change), 0.0, eta_);
        std::copy(eta_.data(), eta_.data() + 2 * h_ * r_, r + r0_);
    }

    double residual_scale() const override { return norm2(size(), load_.data()); }

    void residual(const double *x, double omega, double *r) override {
        x_.assign(x, x + size());
        omega_ = omega;
        penetration();
        force_->indicator(u_, indicator_);
        apply_indicator(indicator_, stiffness_, u_, contact_);
        for (std::int64_t j = 0; j < size(); ++j) r[j] = -load_[j];
        linear_part(r);
        if (z_ > 0) add_contact_force(r);
    }

    void linearize() override {
        assemble();
        lu_.factor(jacobian_);
    }

    void jacobian(Matrix &out) override {
        assemble();
        out = jacobian_;
    }

    void solve(double *b, std::int64_t n) override { lu_.solve(b, n, size()); }

    int determinant_sign() const override { return lu_.determinant_sign(); }

    void omega_derivative(double *r) override {
        std::fill(r, r + size(), 0.0);
        for (std::int64_t h = 1; h <= h_; ++h) {
            const double *a = x_.data() + cosine_at(h), *b = a + r_;
            double *rc = r + cosine_at(h), *rs = rc + r_;
            const double k = static_cast<double>(h), mass = -2 * k * k * omega_;
            for (std::int64_t j = 0; j < r_; ++j) {
                rc[j] = mass * a[j];
                rs[j] = mass * b[j];
            }
            add_damping_product(k, b, rc);
            add_damping_product(-k, a, rs);
        }
    }

    void linear_response(const vector<double> &share, double omega, double *x) override {
        omega_ = omega;
        x_.assign(size(), 0.0);
        constant_indicator(share, h_, indicator_);
        linearize();
        std::copy(load_.begin(), load_.end(), x);
        vector<double> gap_force(z_); // -B' k s (-g)
        for (std::int64_t i = 0; i < z_; ++i) gap_force[i] = stiffness_[i] * share[i] * gap_[i];
        if (z_ > 0) gemv('T', 1.0, m_->gap_0, gap_force.data(), 1.0, x);
        solve(x, 1);
    }

    void to_point(const double *x, double omega, BranchPoint &point) override {
        point.omega = omega;
        point.eta_0.assign(x, x + r0_);
        point.n_harmonics = h_;
        point.eta.reset(r_, 2 * h_);
        std::copy(x + r0_, x + size(), point.eta.data());
    }

    void from_point(const BranchPoint &point, double *x) override {
        std::copy(point.eta_0.begin(), point.eta_0.end(), x);
        const std::int64_t known = std::min(point.eta.cols(), 2 * h_) * r_;
        std::copy(point.eta.data(), point.eta.data() + known, x + r0_);
        std::fill(x + r0_ + known, x + size(), 0.0);
    }

  private:
    std::int64_t cosine_at(std::int64_t h) const { return r0_ + 2 * (h - 1) * r_; }

    void assemble() {
        jacobian_.reset(size(), size());
        if (z_ > 0) add_contact();
        add_linear();
    }

    void add_contact_force(double *r) {
        gemv('T', 1.0, m_->gap_0, contact_.col(0), 1.0, r);
        gemm('T', 'N', 1.0, m_->gap, dynamic_columns(contact_), 0.0, eta_);
        for (std::int64_t k = 0; k < 2 * h_ * r_; ++k) r[r0_ + k] += eta_.data()[k];
    }

    void fill_excitation() {
        excitation_.assign(size(), 0.0);
        for (const auto &[harmonic, load] : m_->excitation) {
            if (harmonic > h_) continue;
            if (harmonic == 0) {
                std::copy(load.real.begin(), load.real.end(), excitation_.begin());
                continue;
            }
            double *cosine = excitation_.data() + cosine_at(harmonic), *sine = cosine + r_;
            for (std::int64_t j = 0; j < r_; ++j) {
                cosine[j] = load.real[j]; // Re((F_r + i F_i) exp(i h t)) = F_r cos - F_i sin
                sine[j] = -load.imag[j];
            }
        }
    }

    void penetration() {
        if (z_ == 0) return;
        double *mean = u_.col(0);
        for (std::int64_t i = 0; i < z_; ++i) mean[i] = -gap_[i];
        gemv('N', 1.0, m_->gap_0, x_.data(), 1.0, mean);
        if (h_ == 0) return;
        std::copy(x_.begin() + r0_, x_.end(), eta_.data());
        dynamic_.reset(z_, 2 * h_);
        gemm('N', 'N', 1.0, m_->gap, eta_, 0.0, dynamic_);
        std::copy(dynamic_.data(), dynamic_.data() + z_ * 2 * h_, u_.col(1));
    }

    const Matrix &dynamic_columns(const Matrix &all) {
        dynamic_.reset(z_, 2 * h_);
        std::copy(all.data() + z_, all.data() + z_ * (2 * h_ + 1), dynamic_.data());
        return dynamic_;
    }

    // y += factor * C v
    void add_damping_product(double factor, const double *v, double *y) const {
        if (m_->damping.empty()) {
            for (std::int64_t j = 0; j < r_; ++j) y[j] += factor * m_->damping_diagonal[j] * v[j];
        } else {
            gemv('N', factor, m_->damping, v, 1.0, y);
        }
    }

    void linear_part(double *r) const {
        for (std::int64_t j = 0; j < r0_; ++j) r[j] += m_->lambda_0[j] * x_[j];
        for (std::int64_t h = 1; h <= h_; ++h) {
            const double *a = x_.data() + cosine_at(h), *b = a + r_;
            double *rc = r + cosine_at(h), *rs = rc + r_;
            const double w = static_cast<double>(h) * omega_;
            for (std::int64_t j = 0; j < r_; ++j) {
                const double l = m_->lambda[j], loss = m_->structural * l;
                rc[j] += (l - w * w) * a[j] + loss * b[j];
                rs[j] += (l - w * w) * b[j] - loss * a[j];
            }
            add_damping_product(w, b, rc);
            add_damping_product(-w, a, rs);
        }
    }

    void add_linear() {
        for (std::int64_t j = 0; j < r0_; ++j) jacobian_(j, j) += m_->lambda_0[j];
        for (std::int64_t h = 1; h <= h_; ++h) {
            const std::int64_t c = cosine_at(h), s = c + r_;
            const double w = static_cast<double>(h) * omega_;
            for (std::int64_t j = 0; j < r_; ++j) {
                const double l = m_->lambda[j], dynamic = l - w * w;
                double loss = m_->structural * l;
                if (m_->damping.empty()) loss += w * m_->damping_diagonal[j];
                jacobian_(c + j, c + j) += dynamic;
                jacobian_(s + j, s + j) += dynamic;
                jacobian_(c + j, s + j) += loss;
                jacobian_(s + j, c + j) -= loss;
            }
            if (m_->damping.empty()) continue;
            for (std::int64_t j = 0; j < r_; ++j)
                for (std::int64_t i = 0; i < r_; ++i) {
                    jacobian_(c + i, s + j) += w * m_->damping(i, j);
                    jacobian_(s + i, c + j) -= w * m_->damping(i, j);
                }
        }
    }

    // weights: Z x (4H + 1) = k_n times the averages; then contact matrices A_k = G' diag(weights_k) G.
    void add_contact() {
        weights_.reset(z_, 4 * h_ + 1);
        for (std::int64_t i = 0; i < z_; ++i) {
            const double *average = indicator_.averages.col(i);
            for (std::int64_t k = 0; k <= 4 * h_; ++k) weights_(i, k) = stiffness_[i] * average[k];
        }
        expand_symmetric(dynamic_products_, r_, dynamic_blocks_);
        if (m_->same_static) {
            for (std::int64_t j = 0; j < r0_; ++j)
                for (std::int64_t i = 0; i < r0_; ++i) jacobian_(i, j) += dynamic_blocks_(i + j * r_, 0);
            add_mixed(dynamic_blocks_, r_);
        } else {
            expand_symmetric(static_products_, r0_, static_blocks_);
            for (std::int64_t j = 0; j < r0_; ++j)
                for (std::int64_t i = 0; i < r0_; ++i) jacobian_(i, j) += static_blocks_(i + j * r0_, 0);
            mixed_blocks_.reset(r0_ * r_, weights_.cols());
            gemm('N', 'N', 1.0, mixed_products_, weights_, 0.0, mixed_blocks_);
            add_mixed(mixed_blocks_, r0_);
        }
        for (std::int64_t n = 1; n <= h_; ++n)
            for (std::int64_t m = 1; m <= h_; ++m) add_dynamic(m, n);
    }

    // One column per average: the packed upper triangles, unpacked to full r x r blocks.
    void expand_symmetric(const Matrix &products, std::int64_t n, Matrix &blocks) {
        packed_.reset(products.rows(), weights_.cols());
        gemm('N', 'N', 1.0, products, weights_, 0.0, packed_);
        blocks.reset(n * n, weights_.cols());
        for (std::int64_t k = 0; k < weights_.cols(); ++k) {
            const double *in = packed_.col(k);
            double *out = blocks.col(k);
            for (std::int64_t j = 0; j < n; ++j)
                for (std::int64_t i = 0; i <= j; ++i) out[i + j * n] = out[j + i * n] = *in++;
        }
    }

    // Blocks between h = 0 (rows, leading dimension ld of each block) and h = n, and their transposes
    // doubled.
    void add_mixed(const Matrix &blocks, std::int64_t ld) {
        for (std::int64_t c = 1; c <= 2 * h_; ++c) {
            const double *block = blocks.col(c);
            const std::int64_t at = r0_ + (c - 1) * r_;
            for (std::int64_t j = 0; j < r_; ++j)
                for (std::int64_t i = 0; i < r0_; ++i) {
                    jacobian_(i, at + j) += block[i + j * ld];
                    jacobian_(at + j, i) += 2 * block[i + j * ld];
                }
        }
    }

    // The four blocks between harmonics m (rows) and n (columns); see indicator_entry.
    void add_dynamic(std::int64_t m, std::int64_t n) {
        const std::int64_t difference = std::abs(m - n), sum = m + n;
        const double *cos_difference = dynamic_blocks_.col(difference == 0 ? 0 : 2 * difference - 1);
        const double *cos_sum = dynamic_blocks_.col(2 * sum - 1), *sin_sum = dynamic_blocks_.col(2 * sum);
        const double *sin_difference = difference == 0 ? nullptr : dynamic_blocks_.col(2 * difference);
        const double sign = m > n ? 1.0 : -1.0; // sin (m - n) from sin |m - n|
        const std::int64_t row = cosine_at(m), column = cosine_at(n);
        for (std::int64_t j = 0; j < r_; ++j) {
            double *left = jacobian_.col(column + j) + row, *right = jacobian_.col(column + r_ + j) + row;
            const std::int64_t at = j * r_;
            for (std::int64_t i = 0; i < r_; ++i) {
                const double d = sin_difference ? sign * sin_difference[at + i] : 0.0;
                left[i] += cos_difference[at + i] + cos_sum[at + i];
                left[r_ + i] += sin_sum[at + i] + d;
                right[i] += sin_sum[at + i] - d;
                right[r_ + i] += cos_difference[at + i] - cos_sum[at + i];
            }
        }
    }

    std::shared_ptr<const ReducedModel> m_;
    std::int64_t h_, r_, r0_, z_;
    std::unique_ptr<ContactForce> force_;
    vector<double> stiffness_, gap_, excitation_, load_;
    Matrix u_, contact_, eta_, dynamic_;
    vector<double> x_;
    double omega_ = 0;
    Matrix dynamic_products_, static_products_, mixed_products_;
    Matrix weights_, packed_, dynamic_blocks_, static_blocks_, mixed_blocks_, jacobian_;
    RealLu lu_;
};

} // namespace

std::unique_ptr<HbmSystem> make_modal_system(std::shared_ptr<const ReducedModel> reduced,
                                             const HbmOptions &options) {
    return std::make_unique<ModalSystem>(std::move(reduced), options);
}

} // namespace plm
