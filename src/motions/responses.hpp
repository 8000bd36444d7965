// Points of response curves as snapshots for a smaller basis.
#pragma once
#include "motions/branch.hpp"
#include "reduction/compression.hpp"

namespace plm {

/// Every point of the branches, which share a reduced model. Each branch counts by its largest point, so that
/// curves at a small force weigh as much as those at a large one.
Responses responses_of(const std::vector<std::shared_ptr<const Branch>> &branches);

} // namespace plm
