// Which modes of each contact sample enter the reduction matrix (paper, 2.3.4).
#pragma once
#include "linalg/monitor.hpp"
#include "reduction/basis_options.hpp"
#include "reduction/conditioning.hpp"
#include "sampling/sample_selection.hpp"

namespace plm {

/// What became of one sample's modes.
struct SampleSelection {
    vector<double> frequency_hz; // all its modes computed
    vector<char> kept;           // selected by the rule
    std::int64_t matched = -1;   // index of the mode with the highest MAC with the dominant mode
    double matched_mac = 0;
    bool matched_kept = false;
};

/// The rule by which modes are kept, resolved from options and window.
struct SelectionRule {
    ModeSelection selection = ModeSelection::below;
    double min_hz = 0, max_hz = 0; // f_i, f_f
    std::int64_t n_harmonics = 5;
    double below_factor = 1.1;

    /// Upper end: n_harmonics f_f (bands) or below_factor n_harmonics f_f (below).
    double highest_hz() const;
    /// The same as an eigenvalue (rad^2/s^2), a rounding higher: the upper end itself belongs to the rule.
    double highest_eigenvalue() const;
    /// In a band [h f_i, h f_f], h = 1..n_harmonics, or not above highest_hz().
    bool keeps(double hz) const;
};

struct CollectedModes {
    Matrix columns; // kept modes of all samples, space size x n_collected, mass-normalised
    std::vector<SampleSelection> samples;
    Matrix lost;                     // modes that match the dominant one and are not kept, sample by sample
    vector<double> equivalent_share; // lelsm: s_i of each column; lelsm_updated: of each pair; else empty
    std::int64_t n_rest_modes = 0;   // snapshots: modes at rest among the columns
};

/// Columns j of the modes with kept[j] != 0.
Matrix kept_columns(const SpaceModes &modes, const vector<char> &kept);
/// PLM_ERR_ARGUMENT: "<who> has a mode in the windows ...".
Error no_mode_kept(const SelectionRule &rule, const char *who);

/// Says which samples do not keep the mode that matches the dominant one, unless the basis holds that mode
/// all the same: from other samples, or because it holds everything.
void warn_of_lost_modes(const std::vector<SampleSelection> &samples, const Matrix &lost,
                        const Coordinates &basis, const SelectionRule &rule, Watch watch);

/// dominant: coordinates of the dominant modes in this space.
CollectedModes collect_modes(const Space &space, const std::vector<SelectedSample> &samples,
                             const std::vector<vector<double>> &dominant, const SelectionRule &rule,
                             Watch watch);

} // namespace plm
