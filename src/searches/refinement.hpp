// A basis for one number, the tolerance: the motions of a curve, corrected by what the unreduced structure
// answers to their contact forces, are compressed to the basis of the next curve, until the error estimated
// on it is small enough. The corrections bring in whatever the first basis lacks: contact sets met on the
// curve, other modes, attachment and static vectors. No unreduced curve is computed.
#pragma once
#include "reduction/basis.hpp"
#include "searches/basis_error.hpp"
#include "searches/hbm.hpp"

namespace plm {

struct RefinementOptions {
    HbmOptions hbm;
    Output output; // whose amplitude counts
    double tolerance =
        1e-3; // on the curve: |error of amplitude| over the peak, |error of frequency| over frequency
    std::int64_t max_rounds = 8;
};

struct Refinement {
    std::shared_ptr<const Basis> basis;   // of kind pod
    std::shared_ptr<const Branch> branch; // the curve on it
    double error = 0;                     // estimated, largest of the points looked at
    std::int64_t rounds = 0;              // curves computed
    bool met = false;
    Warnings warnings = {}; // where it was met: of what no basis mends
};

/// start: a basis of any kind; its curve is the first one. known: that curve, by the same options of hbm, or
/// null.
Refinement refine(std::shared_ptr<const Basis> start, const RefinementOptions &options, Watch watch,
                  std::shared_ptr<const Branch> known = nullptr);

} // namespace plm
