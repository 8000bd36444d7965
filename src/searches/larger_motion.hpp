// Beside the curve of a response, at the same force: a stable motion that is larger than the curve's peak, on
// a curve of its own. Where contact is pressed together or apart at rest, the resonance goes on past the
// curve's own, in growing amplitude: the force that it needs may rise, fall and rise again (the backbone),
// and where it comes back to the force of the curve there is such a motion.
#pragma once
#include "reduction/basis.hpp"
#include "searches/hbm.hpp"
#include "searches/isolated.hpp"

namespace plm {

/// What is looked at: the basis and the options that `curve` was followed with, and its highest motion.
struct KnownResponse {
    std::shared_ptr<const Basis> basis;
    HbmOptions options;
    std::shared_ptr<const Branch> curve;
    double amplitude = 0; // of the peak, of `output`
    Output output;
};

/// The highest one that is found for no more work than the curve took (at least a part of a second), and as
/// much for its own curve; none: no larger one, or none that is stable. Each was solved on the basis itself,
/// and lies near a solution of the whole structure where that can be told. found: curves beside it that are
/// known already, in place of a search.
std::optional<LargerMotion> find_larger_motion(const KnownResponse &known, Watch watch,
                                               const std::vector<IsolatedBranch> *found = nullptr);

/// What is said of it.
std::string words_for(const LargerMotion &larger, const KnownResponse &known);

} // namespace plm
