// What a sampler is asked for, and what its options ask of one another. The bounds of each stand in the table
// of the keys (capi/keys_sampler.cpp) alone.
#pragma once
#include <cstdint>
#include <vector>

namespace plm {

enum class LinearSystem { automatic = -1, open = 0, sliding = 1, rest = 2 }; // rest: closed as at rest

struct SamplerOptions {
    LinearSystem system = LinearSystem::automatic; // automatic: see reference_system()
    std::int64_t mode = 0;                         // 1, 2, ...; 0: by frequency or proposed
    double mode_frequency_hz = 0;                // > 0: the mode nearest to it; 0: proposed by participation
    double search_min_hz = 0, search_max_hz = 0; // proposal: range searched (0, 0: the 20 lowest modes)
    std::int64_t n_samples = 4;
    bool complements = true;
    bool include_ends = true;        // equally spaced over the sweep with its two ends
    bool include_rest = true;        // with pre-load: the contact set at rest is among the samples
    double window_half_width = 0.05; // of the estimated resonance frequency
    double window_min_hz = 0, window_max_hz = 0; // > 0: the caller's window instead
    std::int64_t n_harmonics = 0; // the space must be accurate up to n_harmonics x window; 0: 5, and up to
                                  // 15 as far as the modes reach that are computed anyhow
    struct Extra {
        LinearSystem system; // open, sliding or rest
        std::int64_t mode;   // 1, 2, ...
    };
    std::vector<Extra> extra; // further dominant modes
};

/// Throws PLM_ERR_ARGUMENT with the option's key as argument.
void check_options(const SamplerOptions &options);

} // namespace plm
