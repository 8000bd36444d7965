// What is asked of the periodic motions on a curve, whichever equations they solve.
#pragma once
#include "motions/error_budget.hpp"
#include <cstdint>

namespace plm {

enum class StabilityKind { off, automatic, floquet, hill };

struct MotionOptions {
    std::int64_t max_harmonics = 60;  // of a point, n_harmonics = 0 only
    double accuracy = 1e-3;           // of results, relative: a peak that misses it says so
    double harmonic_tolerance = 0;    // n_harmonics = 0: allowed harmonic_error of a point; 0: by accuracy
    std::int64_t period_multiple = 1; // response period over excitation period
    double frequency_min_hz = 0, frequency_max_hz = 0; // 0: the basis' window
    bool upward = false;                               // direction of a sweep; downwards starts are safer
    double force_scale = 1;                            // scales the excitation, not the pre-load
    double tolerance = 1e-9;                           // of the Newton correction, relative to the solution
    std::int64_t max_iterations = 30;                  // Newton iterations per point
    std::int64_t max_points = 10000;                   // a guard of memory: what bounds a sweep is the effort
    double initial_step = 0; // arc length relative to the curve's scale; 0: automatic
    double min_step = 1e-7,
           max_step = 0.15; // arc length, where 1 = the window's width or the response's scale
    StabilityKind stability = StabilityKind::automatic; // Floquet multipliers of each point
    bool bifurcations = true;                           // locate folds, branch points, ...

    double allowed_harmonic_error() const {
        return harmonic_tolerance > 0 ? harmonic_tolerance : ErrorBudget(accuracy).harmonics();
    }
};

} // namespace plm
