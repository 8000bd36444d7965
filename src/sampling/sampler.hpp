// The evolution of the contact area along a dominant mode, and the frequency window (paper, 2.3.1 and 2.3.2).
#pragma once
#include "sampling/frequency_window.hpp"
#include "sampling/sample_selection.hpp"
#include "sampling/sampler_options.hpp"

namespace plm {

class Sampler {
  public:
    /// Does all the work. `model` must have at least one pair. `known`: an earlier contact space of the
    /// model, or null.
    Sampler(std::shared_ptr<const Model> model, const SamplerOptions &options, Watch watch,
            std::shared_ptr<const Space> known = nullptr);

    const SamplerOptions &options() const { return options_; }
    const std::shared_ptr<const Space> &space() const { return space_; }
    const RestState &rest() const { return *rest_; }
    const std::vector<DominantMode> &dominant() const { return dominant_; } // first: the main one
    const std::vector<ContactSweep> &sweeps() const { return sweeps_; }     // one per dominant mode
    const std::vector<SelectedSample> &samples() const {
        return samples_;
    } // selected, complements after, no duplicate
    const FrequencyWindow &window() const { return window_; }
    /// Of the window, up to which the space is accurate: as asked for, or as far as it reaches anyhow.
    std::int64_t n_harmonics() const { return n_harmonics_; }
    const Warnings &warnings() const { return warnings_; }

  private:
    SamplerOptions options_;
    std::shared_ptr<const Space> space_;
    std::shared_ptr<const RestState> rest_;
    std::vector<DominantMode> dominant_;
    std::vector<ContactSweep> sweeps_;
    std::vector<SelectedSample> samples_;
    FrequencyWindow window_;
    std::int64_t n_harmonics_;
    Warnings warnings_;
};

} // namespace plm
