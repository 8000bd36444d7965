// The evolution of the contact area along a dominant mode, and the frequency window (paper, 2.3.1 and 2.3.2).
#pragma once
#include "model/rest.hpp"
#include "model/space.hpp"

namespace plm {

enum class LinearSystem { automatic = -1, open = 0, sliding = 1 };

struct SamplerOptions {
    LinearSystem system =
        LinearSystem::automatic;  // automatic: see reference_system()
    std::int64_t mode = 0;        // 1, 2, ...; 0: by frequency or proposed
    double mode_frequency_hz = 0; // > 0: the mode nearest to it; 0: proposed by participation
    double search_min_hz = 0, search_max_hz = 0; // proposal: range searched (0, 0: the 20 lowest modes)
    std::int64_t n_samples = 4;
    bool complements = true;
    bool include_ends = true;        // equally spaced over the sweep with its two ends
    bool include_rest = true;        // with pre-load: the contact set at rest is among the samples
    double window_half_width = 0.05; // of the estimated resonance frequency
    double window_min_hz = 0, window_max_hz = 0; // > 0: the caller's window instead
    std::int64_t n_harmonics = 5;                // the space must be accurate up to n_harmonics x window
    struct Extra {
        LinearSystem system;
        std::int64_t mode;
    };
    std::vector<Extra> extra; // further dominant modes
};

/// A linear mode that is taken to carry the contact kinematics.
struct DominantMode {
    LinearSystem system = LinearSystem::open;
    std::int64_t mode = 0; // 1-based in its system
    double frequency_hz = 0;
    double participation = 0;        // |phi . F_1| / ... share of the drive-point response, in [0, 1]
    vector<double> coordinates;      // in the space
    vector<double> mode_penetration; // dV = B phi, per pair
};

/// The sweep dX = dX_0 + alpha dV of one dominant mode: Z + 1 contact sets at most.
struct ContactSweep {
    vector<double> offset;                       // dX_PS (rest penetration) or dX_0 (static offset), per pair
    bool offset_is_rest = false;                 // which of the two
    vector<double> thresholds;                   // the alphas where a pair switches, ascending, ties merged
    std::vector<vector<std::int64_t>> switching; // pairs that switch at each threshold
    std::vector<vector<char>> samples; // thresholds.size() + 1 contact sets, from alpha_min to alpha_max
    vector<double> alpha;              // a representative alpha inside each interval
};

struct SelectedSample {
    vector<char> closed;
    std::int64_t dominant = 0;    // which dominant mode's sweep
    std::int64_t sweep_index = 0; // position in that sweep
    bool complement = false;
    std::int64_t n_closed = 0;
};

struct MacRow {                  // one compared linear system
    std::string system;          // "system 1", "system 2", "rest"
    vector<double> frequency_hz; // its lowest modes
    vector<double> mac;          // mass-weighted MAC with the dominant mode
    std::int64_t best = 0;
};

struct FrequencyWindow {
    double blf_hz = 0;           // paper, eq. (6)
    double f1_hz = 0, f2_hz = 0; // of the two half-cycle systems
    double rest_hz = 0;          // of the system closed as at rest (case B), 0 in case A
    bool preload_case = false;   // case B of the paper
    double min_hz = 0, max_hz = 0;
    std::vector<MacRow> mac;
    std::string why; // one sentence
};

class Sampler {
  public:
    /// Does all the work. `model` must have at least one pair. `known`: an earlier contact space of the
    /// model, or null.
    Sampler(std::shared_ptr<const Model> model, const SamplerOptions &options, Watch watch,
            std::shared_ptr<const Space> known = nullptr);

    const SamplerOptions &options() const { return options_; }
    const std::shared_ptr<const Space> &space() const { return space_; }
    const RestState &rest() const { return rest_; }
    const std::vector<DominantMode> &dominant() const { return dominant_; } // first: the main one
    const std::vector<ContactSweep> &sweeps() const { return sweeps_; }     // one per dominant mode
    const std::vector<SelectedSample> &samples() const {
        return samples_;
    } // selected, complements after, no duplicate
    const FrequencyWindow &window() const { return window_; }
    const Warnings &warnings() const { return warnings_; }

  private:
    SamplerOptions options_;
    std::shared_ptr<const Space> space_;
    RestState rest_;
    std::vector<DominantMode> dominant_;
    std::vector<ContactSweep> sweeps_;
    std::vector<SelectedSample> samples_;
    FrequencyWindow window_;
    Warnings warnings_;
};

} // namespace plm
