// The simplest path: x = p.
#pragma once
#include "paths/residual.hpp"

namespace test {

class Line final : public plm::Residual {
  public:
    std::int64_t size() const override { return 1; }
    void residual(const double *x, double p, double *r) override { r[0] = x[0] - p; }
    void linearize() override {}
    void solve(double *, std::int64_t) override {}
    int determinant_sign() const override { return 1; }
    void parameter_derivative(double *r) override { r[0] = -1; }
    double residual_scale() const override { return 1; }
};

} // namespace test
