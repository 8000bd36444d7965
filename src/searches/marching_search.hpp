// Response branches that a search in time comes upon: the exact flow is marched from rest and from scaled
// motions at a grid of frequencies, shooting makes what is reached periodic, and what lies on no known branch
// is traced. A last resort: an isolated branch is reached only from states near it.
#pragma once
#include "hbm/options.hpp"
#include "motions/branch.hpp"
#include "searches/isolated.hpp"

namespace plm {

struct MarchingOptions {
    HbmOptions hbm;                       // as for the curves; period_multiple 1
    std::int64_t n_frequencies = 12;      // equidistant inside the frequency range
    vector<double> scales = {0, 1, 3, 8}; // start states: rest, and rest plus so many times the motion at the
                                          // known branches' largest response
    std::int64_t transient_periods = 50;  // marched before shooting
};

struct MarchingSearch {
    std::vector<std::shared_ptr<Branch>> branches; // new ones only
    std::int64_t n_starts = 0, n_periodic = 0, n_known = 0;
};

MarchingSearch search_by_marching(std::shared_ptr<const ReducedModel> reduced, const MarchingOptions &options,
                                  const std::vector<std::shared_ptr<const Branch>> &known, Watch watch);

} // namespace plm
