// Reduction bases: piecewise-linear modes, Craig-Bampton and the unreduced reference, each giving a
// ReducedModel.
#pragma once
#include "reduction/compression.hpp"
#include "reduction/sweep_range.hpp"
#include "sampling/sampler.hpp"

namespace plm {

enum class BasisKind {
    plm,
    craig_bampton,
    full,
    pod,
    bilinear,
    lelsm,
    lelsm_updated,
    discontinuity,
    snapshots
};

/// Modes of linear systems and vectors beside them: all kinds but craig_bampton, full and pod.
bool is_made_of_vectors(BasisKind kind);
/// The name of a kind as in the options.
const char *name_of(BasisKind kind);
enum class ModeSelection {
    bands,
    below
}; // paper 2.3.4: windows [h f_i, h f_f]; or all below the highest window

enum class PairRule { effective_independence, mdof }; // pair_sampling.hpp

struct BasisOptions {
    BasisKind kind = BasisKind::plm;
    ModeSelection selection = ModeSelection::below;
    std::int64_t n_harmonics = 5;                      // windows h = 1..n_harmonics
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

/// Kinds that are made from the dominant mode and the contact sweep of a sampler.
constexpr bool needs_sampler(BasisKind kind) {
    return kind == BasisKind::plm || kind == BasisKind::snapshots;
}

/// What became of one sample's modes.
struct SampleSelection {
    vector<double> frequency_hz; // all its modes computed
    vector<char> kept;           // selected by the rule
    std::int64_t matched = -1;   // index of the mode with the highest MAC with the dominant mode
    double matched_mac = 0;
    bool matched_kept = false;
};

struct BasisReport {
    std::vector<SampleSelection> samples;
    std::int64_t n_collected = 0;    // columns before conditioning
    std::int64_t n_rest_modes = 0;   // snapshots: modes at rest among them
    vector<double> singular_values;  // scaled by the largest
    vector<double> equivalent_share; // of k_n, lelsm: in each column's system; lelsm_updated: of each pair
    double preload_residual =
        0; // paper, eq. (12): q_PS against P, L2 norm over the free DOFs; 0 without pre-load
    double preload_residual_mass = 0; // the same in the M-norm
    Warnings warnings;
    double setup_seconds = 0;
    double highest_frequency_hz = 0; // upper end of the rule
};

class Basis {
  public:
    /// sampler: needed for kinds plm and snapshots; the other kinds take the window from it. parent: first
    /// reduction under the modes or null; for kind pod the basis the responses were computed on. window_hz
    /// are taken from options, sampler or (pod) parent; other kinds need options.frequency_max_hz or a
    /// sampler, the rivals a contact pair. known: an earlier contact space of the model, or null;
    /// used where neither sampler nor parent has one.
    Basis(std::shared_ptr<const Model> model, std::shared_ptr<const Sampler> sampler,
          std::shared_ptr<const Basis> parent, const BasisOptions &options, Watch watch,
          const Responses *responses = nullptr, std::shared_ptr<const Space> known = nullptr);

    const BasisOptions &options() const { return options_; }
    const BasisReport &report() const { return report_; }
    const std::shared_ptr<const Space> &space() const { return space_; } // what P was made in
    const std::shared_ptr<const ReducedModel> &reduced() const { return reduced_; }
    const std::shared_ptr<const Sampler> &sampler() const { return sampler_; }
    const std::shared_ptr<const Model> &model() const { return model_; }
    double window_min_hz() const { return window_min_hz_; }
    double window_max_hz() const { return window_max_hz_; }
    /// The window and how far beyond its estimated ends the basis still serves.
    SweepRange sweep_range() const;

  private:
    void compress_parent(const Basis *parent, const Responses *responses);
    void choose_pairs();

    std::shared_ptr<const Model> model_;
    std::shared_ptr<const Sampler> sampler_;
    BasisOptions options_;
    BasisReport report_;
    std::shared_ptr<const Space> space_;
    std::shared_ptr<const ReducedModel> reduced_;
    double window_min_hz_ = 0, window_max_hz_ = 0;
    bool estimated_min_ = false, estimated_max_ = false; // ends of the window that are a sampler's estimate
};

/// The basis of kind full for the same frequencies with all pairs carried, in the contact space of `basis`
/// where that is one, else in `known` where that reaches far enough.
std::shared_ptr<const Basis> unreduced_basis(const std::shared_ptr<const Basis> &basis, Watch watch,
                                             std::shared_ptr<const Space> known = nullptr);

/// r of paper eq. (12) for any vector over the free DOFs, against P (or P_0).
double projection_residual(const Basis &basis, bool is_static, bool use_mass, const double *q_free);

struct CraigBamptonOptions {
    std::int64_t n_fixed = 0;     // fixed-interface modes; 0: all below highest_frequency
    double highest_frequency = 0; // rad/s
    bool load_vectors = true; // static responses of the interior to pre-load and excitation as further modes
};
/// Craig-Bampton (Craig & Bampton 1968): all DOFs with an entry in B retained; diagonalised.
std::shared_ptr<const Space> make_craig_bampton_space(std::shared_ptr<const Model> model,
                                                      const CraigBamptonOptions &options, Watch watch);

} // namespace plm
