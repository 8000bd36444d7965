// What the harmonic-balance solver is asked for.
#pragma once
#include "motions/options.hpp"

namespace plm {

enum class AftKind { event, sampled };
enum class NonlinearUnknowns { automatic, modal, gaps };
enum class FormulationKind { automatic, penalty, compliance };
enum class MotionKind { automatic, exact, harmonics };

struct HbmOptions : MotionOptions {
    MotionKind motion =
        MotionKind::automatic;    // periodic orbits of the exact flow, or harmonic balance: by cost
    std::int64_t n_harmonics = 0; // 0: as many as each point needs
    bool tail_correction = false; // adds the next harmonics that follow from the exact force
    AftKind aft = AftKind::event;
    std::int64_t time_samples = 256;                           // sampled AFT only
    NonlinearUnknowns unknowns = NonlinearUnknowns::automatic; // reduced coordinates or contact gaps, by cost
    FormulationKind formulation = FormulationKind::automatic;  // of the contact law: by its stiffness
    // Flops of a step of Newton's method for exact motions, about half a second: where one takes longer, a
    // curve would take minutes, and what it would know better is told, not followed. No key.
    double dearest_step = 2.5e9;
    // max_harmonics is what a curve can afford, less than what was asked for. No key.
    bool harmonics_by_cost = false;
};

/// What the options ask of one another; the bounds of each stand in the table of the keys.
void require_consistent(const HbmOptions &options);

} // namespace plm
