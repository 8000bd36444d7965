// Points of a response curve on its own equations again: between two points, or with more harmonics.
#pragma once
#include "hbm/options.hpp"
#include "hbm/system.hpp"

namespace plm {

/// A point in the unknowns of a system.
struct CurvePoint {
    vector<double> x;
    double omega = 0;
};

/// Where lengths are measured: 1 is the size of the unknowns at a point or the width of the range of omega.
class CurveMetric {
  public:
    CurveMetric(const CurvePoint &at, const HbmOptions &options);
    double product(const vector<double> &x, double omega, const vector<double> &y, double other_omega) const;
    double omega_scale() const { return width_; }
    double per_square() const { return per_square_; }

  private:
    double per_square_, width_;
};

/// Moves the point to the curve of `system` within the hyperplane across (direction_x, direction_omega).
/// `factored`: the system was linearized near it. False: Newton's method did not converge, or went far; the
/// point is as it was.
bool correct_across(HbmSystem &system, const CurveMetric &metric, const HbmOptions &options,
                    const vector<double> &direction_x, double direction_omega, CurvePoint &point,
                    bool factored = false);

CurvePoint load(HbmSystem &system, const BranchPoint &point);

} // namespace plm
