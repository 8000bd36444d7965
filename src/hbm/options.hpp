// What the harmonic-balance solver is asked for.
#pragma once
#include <cstdint>

namespace plm {

enum class AftKind { event, sampled };
enum class NonlinearUnknowns { automatic, modal, gaps };
enum class FormulationKind { automatic, penalty, compliance };
enum class MotionKind { automatic, exact, harmonics };
enum class StabilityKind { off, automatic, floquet, hill };

struct HbmOptions {
    MotionKind motion =
        MotionKind::automatic;        // periodic orbits of the exact flow, or harmonic balance: by cost
    std::int64_t n_harmonics = 0;     // 0: as many as each point needs
    std::int64_t max_harmonics = 60;  // n_harmonics = 0 only
    double accuracy = 1e-3;           // of results, relative: a peak that misses it says so
    double harmonic_tolerance = 0;    // n_harmonics = 0: allowed harmonic_error of a point; 0: by accuracy
    bool tail_correction = false;     // adds the next harmonics that follow from the exact force
    std::int64_t period_multiple = 1; // response period over excitation period
    AftKind aft = AftKind::event;
    std::int64_t time_samples = 256;                           // sampled AFT only
    NonlinearUnknowns unknowns = NonlinearUnknowns::automatic; // reduced coordinates or contact gaps, by cost
    FormulationKind formulation = FormulationKind::automatic;  // of the contact law: by its stiffness
    double frequency_min_hz = 0, frequency_max_hz = 0;         // 0: the basis' window
    bool upward = false;              // direction of a sweep; downwards starts are safer
    double force_scale = 1;           // scales the excitation, not the pre-load
    double tolerance = 1e-9;          // of the Newton correction, relative to the solution
    std::int64_t max_iterations = 30; // Newton iterations per point
    std::int64_t max_points = 1000;   // of a sweep; a curve to its peak and beyond has some 50 to 500
    double initial_step = 0;          // arc length relative to the curve's scale; 0: automatic
    double min_step = 1e-7,
           max_step = 0.15; // arc length, where 1 = the window's width or the response's scale
    StabilityKind stability = StabilityKind::automatic; // Floquet multipliers of each point
    bool bifurcations = true;                           // locate folds, branch points, ...
    // Flops of a step of Newton's method for exact motions, about half a second: where one takes longer, a
    // curve would take minutes, and what it would know better is told, not followed. No key.
    double dearest_step = 2.5e9;
    // max_harmonics is what a curve can afford, less than what was asked for. No key.
    bool harmonics_by_cost = false;

    /// Half of the accuracy, unless set: the basis takes its share.
    double allowed_harmonic_error() const {
        return harmonic_tolerance > 0 ? harmonic_tolerance : 0.5 * accuracy;
    }
};

} // namespace plm
