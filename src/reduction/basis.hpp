// Reduction bases: piecewise-linear modes, Craig-Bampton and the unreduced reference, each giving a
// ReducedModel.
#pragma once
#include "linalg/kept.hpp"
#include "reduction/compression.hpp"
#include "reduction/mode_selection.hpp"
#include "reduction/sweep_range.hpp"
#include "sampling/sampler.hpp"

namespace plm {

struct BasisReport {
    std::vector<SampleSelection> samples;
    std::int64_t n_collected = 0;     // columns before conditioning
    std::int64_t n_rest_modes = 0;    // snapshots: modes at rest among them
    vector<double> singular_values;   // scaled by the largest
    vector<double> equivalent_share;  // of k_n, lelsm: in each column's system; lelsm_updated: of each pair
    double preload_residual_mass = 0; // paper, eq. (12): q_PS against P, in the M-norm; 0 without pre-load
    Warnings warnings;
    double setup_seconds = 0;
    double highest_frequency_hz = 0; // upper end of the rule
    std::int64_t n_harmonics = 0;    // of the rule
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

    /// From the bytes of another one: on a model without matrices, whose vectors are all there.
    explicit Basis(ByteReader &bytes);
    void write(ByteWriter &bytes) const;
    /// One that was read, on the model that it was made of: PLM_ERR_ARGUMENT for any other.
    Basis(const Basis &read, std::shared_ptr<const Model> model);

    const BasisOptions &options() const { return options_; }
    const BasisReport &report() const { return report_; }
    /// Paper, eq. (12): q_PS against P, L2 norm over the free DOFs; 0 without pre-load. Computed when first
    /// asked for: it forms P.
    double preload_residual() const;
    const std::shared_ptr<const Space> &space() const { return space_; } // what P was made in
    const std::shared_ptr<const ReducedModel> &reduced() const { return reduced_; }
    const std::shared_ptr<const Sampler> &sampler() const { return sampler_; }
    const std::shared_ptr<const Model> &model() const { return model_; }
    double window_min_hz() const { return window_min_hz_; }
    double window_max_hz() const { return window_max_hz_; }
    /// The window and how far beyond its estimated ends the basis still serves.
    SweepRange sweep_range() const;

  private:
    template <class Self, class Bytes> static void pass(Self &self, Bytes &bytes);
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
    Kept<double> preload_residual_;
    Kept<std::shared_ptr<const Basis>> unreduced_; // unreduced_basis()
    friend std::shared_ptr<const Basis> unreduced_basis(const std::shared_ptr<const Basis> &, Watch,
                                                        std::shared_ptr<const Space>);
};

/// The basis of kind full for the same frequencies with all pairs carried, in the contact space of `basis`
/// where that is one, else in `known` where that reaches far enough. Made once.
std::shared_ptr<const Basis> unreduced_basis(const std::shared_ptr<const Basis> &basis, Watch watch,
                                             std::shared_ptr<const Space> known = nullptr);

/// r of paper eq. (12) for any vector over the free DOFs, against P (or P_0).
double projection_residual(const Basis &basis, bool is_static, bool use_mass, const Field &q);

} // namespace plm
