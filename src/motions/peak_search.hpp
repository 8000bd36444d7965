// The highest point of a curve, found on the curve itself: points on hyperplanes across the chord through the
// three highest ones, by successive parabolic interpolation.
#pragma once
#include "linalg/monitor.hpp"
#include "motions/branch.hpp"
#include "motions/options.hpp"
#include "motions/periodic_equations.hpp"
#include <array>
#include <cmath>

namespace plm {

class PeakSearch {
  public:
    /// jumps: forces from samples jump as a pair switches past one, and amplitudes with them.
    PeakSearch(PeriodicEquations &equations, const MotionOptions &options, bool jumps,
               std::shared_ptr<const ReducedModel> reduced, const Output &of, Watch watch)
        : equations_(equations), options_(options), jumps_(jumps), reduced_(std::move(reduced)), of_(of),
          watch_(watch) {}

    /// around: the curve's highest point between its neighbours. False: that is no solution of these
    /// equations, nor near one.
    bool run(const Branch &branch, const std::array<std::int64_t, 3> &around, BranchPoint &highest);

    /// By how much the peak may be higher than the point found, of that: 0 where it was closed in upon, NaN
    /// before run() came to its end. The parabola may miss a sharp top by as much as it rises.
    double above() const { return 2 * above_; }

  private:
    struct Sample {
        double s = 0; // position along the chord
        PathState at;
        double amplitude = 0;
        BranchPoint point;
    };

    bool is_exact() const;
    bool solve_triple();
    bool close_in();
    double rise() const;
    void load(const Branch &branch, std::int64_t i, Sample &s);
    void set_chord();
    double vertex() const;
    bool corrected(double s, Sample &out);
    bool solved(Sample &out);
    double climb(Sample &best, double above);

    PeriodicEquations &equations_;
    const MotionOptions &options_;
    bool jumps_;
    std::shared_ptr<const ReducedModel> reduced_;
    Output of_;
    Watch watch_;
    std::array<Sample, 3> three_, of_curve_; // the latter its highest point between its neighbours
    Metric metric_;
    PathState origin_, chord_; // the latter of length 1
    double first_ = 0, last_ = 1, span_ = 1, above_ = NAN;
};

} // namespace plm
