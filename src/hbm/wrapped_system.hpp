// A system made from another one by giving p another meaning or adding equations: forwards what it does not
// change.
#pragma once
#include "hbm/system.hpp"

namespace plm {

class WrappedSystem : public HbmSystem {
  public:
    explicit WrappedSystem(HbmSystem &inner) : inner_(inner) {}
    std::int64_t size() const override { return inner_.size(); }
    std::int64_t static_size() const override { return inner_.static_size(); }
    void residual(const double *x, double p, double *r) override { inner_.residual(x, p, r); }
    void linearize() override { inner_.linearize(); }
    void solve(double *b, std::int64_t n) override { inner_.solve(b, n); }
    void factor_bordered(const Border &border, ModalFactor &out) override {
        inner_.factor_bordered(border, out);
    }
    void jacobian_product(const double *v, double *r) override { inner_.jacobian_product(v, r); }
    void set_self_excitation(double xi) override { inner_.set_self_excitation(xi); }
    void parameter_derivative(double *r) override { inner_.parameter_derivative(r); }
    void parameter_derivative_of_structure(double *r) override {
        inner_.parameter_derivative_of_structure(r);
    }
    int determinant_sign() const override { return inner_.determinant_sign(); }
    void linear_response(const vector<double> &coupling, double p, double *x) override {
        inner_.linear_response(coupling, p, x);
    }
    double residual_scale() const override { return inner_.residual_scale(); }
    bool in_balance() const override { return inner_.in_balance(); }
    void to_point(const double *x, double p, BranchPoint &point) override { inner_.to_point(x, p, point); }
    void from_point(const BranchPoint &point, double *x) override { inner_.from_point(point, x); }
    void set_force_scale(double scale) override { inner_.set_force_scale(scale); }
    void force_derivative(double *r) override { inner_.force_derivative(r); }
    void set_stiffness_factor(double factor) override { inner_.set_stiffness_factor(factor); }
    void contact_force_change(const Matrix &force, double *r) override {
        inner_.contact_force_change(force, r);
    }
    const Matrix &contact_force() const override { return inner_.contact_force(); }
    void contact_motion_change(const double *x, Matrix &u) override { inner_.contact_motion_change(x, u); }
    void set_extra_gap(double gap) override { inner_.set_extra_gap(gap); }
    void gap_derivative(double *r) override { inner_.gap_derivative(r); }
    const ContactIndicator &indicator() const override { return inner_.indicator(); }

  protected:
    HbmSystem &inner_;
};

} // namespace plm
