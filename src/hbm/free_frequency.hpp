// Harmonic balance with the frequency as its last unknown and the force as the parameter:
// y = (x, (omega - omega_reference) unit).
#pragma once
#include "hbm/wrapped_system.hpp"

namespace plm {

/// Base: WrappedSystem or what is derived from it.
template <class Base> class FreeFrequency : public Base {
  public:
    template <class... Arguments>
    FreeFrequency(double omega_reference, double unit, HbmSystem &inner, Arguments... arguments)
        : Base(inner, arguments...), omega_reference_(omega_reference), unit_(unit) {}
    std::int64_t size() const override { return this->inner_.size() + 1; }
    /// For a last equation that does not depend on the force.
    void parameter_derivative(double *r) override {
        this->inner_.force_derivative(r);
        r[this->inner_.size()] = 0;
    }
    void linear_response(const vector<double> &coupling, double force, double *y) override {
        this->inner_.set_force_scale(force);
        this->inner_.linear_response(coupling, omega_reference_, y);
        y[this->inner_.size()] = 0;
    }
    void to_point(const double *y, double force, BranchPoint &point) override {
        this->inner_.to_point(y, omega_of(y), point);
        point.force_scale = force;
    }
    void from_point(const BranchPoint &point, double *y) override {
        this->inner_.from_point(point, y);
        y[this->inner_.size()] = (point.omega - omega_reference_) * unit_;
    }

  protected:
    double omega_of(const double *y) const { return omega_reference_ + y[this->inner_.size()] / unit_; }
    double unit() const { return unit_; }

  private:
    double omega_reference_, unit_;
};

} // namespace plm
