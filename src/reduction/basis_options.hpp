// What a basis is asked for. The bounds of each option stand in the table of the keys (capi/keys_basis.cpp)
// alone.
#pragma once
#include "reduction/basis_kinds.hpp"
#include <cstdint>

namespace plm {

enum class ModeSelection {
    bands,
    below
}; // paper 2.3.4: windows [h f_i, h f_f]; or all below the highest window

enum class PairRule { effective_independence, mdof }; // pair_sampling.hpp

struct BasisOptions {
    const BasisKind *kind = &basis_kinds::plm;
    ModeSelection selection = ModeSelection::below;
    std::int64_t n_harmonics = 0; // windows h = 1..n_harmonics; 0: the sampler's, 5 without one
    double frequency_min_hz = 0, frequency_max_hz = 0; // f_i, f_f; 0: the sampler's window
    double below_factor = 1.1;          // rule "below": all modes below below_factor * n_harmonics * f_f
    double svd_tolerance = 1e-6;        // singular values relative to the largest (paper, 2.3.3)
    bool static_augmentation = true;    // P_0 = [P q_PS] (paper, eq. (9)); not used without pre-load
    bool load_vectors = true;           // P also holds the static responses to the loads
    double pod_tolerance = 1e-5;        // pod: share of the responses left out, energy norm
    std::int64_t pod_size = 0;          // pod: columns; 0: by pod_tolerance
    double equivalent_amplitude = 0;    // lelsm_updated: largest amplitude of a pair; 0: by the excitation
    std::int64_t n_discontinuities = 0; // discontinuity: leading vectors; 0: one per pair
    double rest_factor = 5.5;           // snapshots: modes at rest up to this multiple of f_f
    std::int64_t n_snapshots = 12;      // snapshots: static solutions for each dominant mode
    double snapshot_tolerance = 1e-2;   // snapshots: left out below this share of the motion, energy norm
    std::int64_t n_pairs_carried = 0;   // contact pairs in the equations (node sampling); 0: all
    PairRule pair_rule = PairRule::effective_independence;
    std::int64_t n_fixed_modes = 0; // Craig-Bampton: fixed-interface modes; 0: all below 4 below_factor H f_f
};

} // namespace plm
