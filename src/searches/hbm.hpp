// The harmonic-balance solver over a reduced model: single solutions, response curves, peaks.
#pragma once
#include "hbm/options.hpp"
#include "linalg/monitor.hpp"
#include "motions/curve_findings.hpp"
#include "searches/sweep.hpp"

namespace plm {

class Basis;           // reduction/basis.hpp
struct IsolatedSearch; // isolated.hpp
struct Backbone;       // phase_resonance.hpp

class Hbm {
  public:
    /// window: that of the basis, taken where the options have no frequencies of their own; a sweep goes on
    /// past its estimated ends to have the peak inside, and what lies outside it is checked.
    Hbm(std::shared_ptr<const ReducedModel> reduced, const SweepRange &window, const HbmOptions &options,
        Watch watch);
    /// On a basis whose errors can be estimated, in its window.
    Hbm(std::shared_ptr<const Basis> basis, const HbmOptions &options, Watch watch);
    /// A range that stays as it is.
    Hbm(std::shared_ptr<const ReducedModel> reduced, double min_hz, double max_hz, const HbmOptions &options,
        Watch watch)
        : Hbm(std::move(reduced), SweepRange{min_hz, max_hz, min_hz, max_hz}, options, watch) {}
    ~Hbm();

    /// Always returns a branch with at least one point, or throws; the outcome is in branch->end_reason.
    /// asked, level_before, look: as in SweepTask.
    std::shared_ptr<const Branch> sweep(const Output *asked = nullptr, LevelBefore *level_before = nullptr,
                                        std::shared_ptr<const Branch> look = nullptr) const;
    /// The same, recorded, so that it can be stopped and go on later: with this recorder of that branch.
    std::shared_ptr<const Branch> sweep(CurveRecorder &recorder) const;
    /// The first look at the range, see sweep_with_few_harmonics().
    std::shared_ptr<const Branch> sweep_with_few_harmonics() const;
    /// start may be null (cold start).
    std::shared_ptr<const Branch> solve(double frequency_hz, const Branch *start, std::int64_t point) const;
    Peak find_peak(const Branch &branch, std::int64_t dof, Measure measure, std::int64_t harmonic) const;

    /// The curve that crosses a located branch point of `branch`, or leaves a period doubling (with twice the
    /// period); `mirrored` takes the other side.
    std::shared_ptr<const Branch> switch_branch(const Branch &branch, std::int64_t point,
                                                bool mirrored) const;

    /// See plm_hbm_find_isolated, plm_hbm_find_backbones, plm_hbm_track_fold.
    IsolatedSearch find_isolated(const Branch &main, double force_max) const;
    std::vector<Backbone> find_backbones(double force_max) const;
    std::shared_ptr<const Branch> track_fold(const Branch &branch, std::int64_t point, double force_min,
                                             double force_max) const;
    /// Motions marched from rest and from `n_states` multiples of the known curves' largest response.
    std::vector<std::shared_ptr<Branch>>
    find_by_marching(const std::vector<std::shared_ptr<const Branch>> &known, std::int64_t n_frequencies,
                     std::int64_t n_states) const;
    /// mode: 1, 2, ... about rest; amplitude_max 0: a hundred times the amplitude at which contact first
    /// changes.
    std::shared_ptr<const Branch> find_nonlinear_mode(std::int64_t mode, std::int64_t dof,
                                                      double amplitude_max) const;

  private:
    using Clock = std::chrono::steady_clock;
    SweepTask task() const;
    std::shared_ptr<const Branch> judged(const SweepTask &task) const;
    void judge(Branch &curve, LevelBefore *before) const;
    void look_over(Branch &curve, LevelBefore *before) const;
    BranchPoint first_guess(const Branch &start, std::int64_t point) const;

    /// The model that a branch of this basis was computed on. PLM_ERR_ARGUMENT for one of another basis.
    std::shared_ptr<const ReducedModel> model_of(const Branch &branch, const char *argument) const;

    std::shared_ptr<const Basis> made_as_;                // null: not known
    std::shared_ptr<const ReducedModel> basis_, reduced_; // as handed over; widened for exact motions
    HbmOptions options_;
    bool exact_ = false;        // curves of exact motions, where their first point is one
    SweepRange window_, reach_; // of the basis; of a sweep with these options
    Watch watch_;
};

} // namespace plm
