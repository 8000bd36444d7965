// Jacobian of the harmonic balance in reduced coordinates (paper, eq. (10)), J = D(omega) + G' T G for
// x = [eta_0 (r_0); a_1; b_1; ...; a_H; b_H (r each)]: D couples cosine and sine of one harmonic, G holds the
// gap rows of every harmonic, T couples the harmonics of one pair.
#pragma once
#include "contact/contact_force.hpp"
#include "motions/free_motion.hpp"
#include "reduction/reduced_model.hpp"
#include <complex>

namespace plm {

/// A value: a copy keeps what it was set to. Pairs that stay open are left out of T and G.
class ModalJacobian {
  public:
    ModalJacobian() = default;
    ModalJacobian(std::shared_ptr<const ReducedModel> reduced, std::int64_t n_harmonics);
    void set_omega(double omega) { omega_ = omega; }
    /// Adds the damping -2 xi omega M (nonlinear modes).
    void set_self_excitation(double xi) { self_excitation_ = xi; }
    void set_tangent(const ContactIndicator &indicator, const vector<double> &stiffness);
    /// What holds the mean position of motion that no contact holds: before add_linear_product().
    void set_hold(const ContactIndicator &indicator, const double *mean_load) {
        hold_.set(*m_, indicator, mean_load);
    }
    /// Call it before product() and what stands below write_to(), which does without.
    void expand_tangent();

    const ReducedModel &model() const { return *m_; }
    double omega() const { return omega_; }
    double self_excitation() const { return self_excitation_; }
    std::int64_t n_harmonics() const { return h_; }
    std::int64_t n_coefficients() const { return 2 * h_ + 1; }
    std::int64_t size() const { return r0_ + 2 * h_ * r_; }
    /// Where a_h stands in x, h >= 1; b_h follows it.
    std::int64_t cosine_at(std::int64_t h) const { return r0_ + 2 * (h - 1) * r_; }

    /// Diagonal entry of D, h >= 1, as a complex number: D (a - i b). Without damping that is not diagonal.
    std::complex<double> dynamic_stiffness(std::int64_t h, std::int64_t j) const;
    /// y += D x
    void add_linear_product(const double *x, double *y) const;
    /// y = J x or J' x
    void product(bool transposed, const double *x, double *y);
    /// Overwrites the leading rows and columns of `out` by J.
    void write_to(Matrix &out);

    std::int64_t n_acting() const { return static_cast<std::int64_t>(acting_.size()); }
    /// Rows of the pairs that act at some time.
    const Matrix &gap() const { return gap_; }
    const Matrix &gap_0() const { return gap_0_; }
    /// n_acting x (2H + 1)^2: column c + (2H + 1) d is the block (c, d) of T, diagonal over the pairs.
    const Matrix &tangent() const { return tangent_; }
    /// u = G x, f = T u or T' u: n_acting x (2H + 1)
    void to_gaps(const double *x, Matrix &u) const;
    void apply_tangent(bool transposed, const Matrix &u, Matrix &f) const;
    /// y += factor G' f
    void add_from_gaps(double factor, const Matrix &f, double *y) const;

  private:
    struct Products;
    struct Scratch { // of one call to the next: no iteration allocates
        Matrix gaps, force, packed, dynamic, other;
        vector<double> mirrored;
        Scratch() = default;
        Scratch(const Scratch &) {}
        Scratch &operator=(const Scratch &) { return *this; } // nothing of it belongs to the value
    };
    void add_linear(Matrix &out) const;
    void write_contact(Matrix &out);
    void write_static(const Matrix &blocks, std::int64_t ld, Matrix &out) const;
    void write_mixed(const Matrix &blocks, std::int64_t ld, Matrix &out) const;
    void write_dynamic(const Matrix &blocks, std::int64_t m, std::int64_t n, Matrix &out) const;
    void expand_symmetric(const Matrix &products, std::int64_t n, Matrix &blocks);

    std::shared_ptr<const ReducedModel> m_;
    std::shared_ptr<Products> products_; // the same for all copies
    std::int64_t h_ = 0, r_ = 0, r0_ = 0;
    double omega_ = 0, self_excitation_ = 0;
    vector<std::int64_t> acting_;
    Matrix weights_; // (4H + 1) x Z: stiffness times the averages of the indicator
    Matrix gap_, gap_0_, tangent_;
    MeanHold hold_;
    Scratch scratch_;
};

/// u (one column per coefficient) = gap_0 eta_0, gap a_1, gap b_1, ...
void gaps_of_coordinates(const Matrix &gap_0, const Matrix &gap, const double *x, Matrix &u);
/// y += factor (gap_0' f_0, gap' f_1, ...)
void add_coordinates_of_gaps(const Matrix &gap_0, const Matrix &gap, double factor, const Matrix &f,
                             double *y);

} // namespace plm
