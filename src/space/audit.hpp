// Looks a built model over for what engineers get wrong: units, missing mass, loose bodies, gap signs,
// contact stiffness. Every finding is a fact with a number; its severity says whether to worry.
#pragma once
#include "space/finding.hpp"
#include "space/model.hpp"
#include <vector>

namespace plm {

/// Nothing damps the structure, so that a resonance has no height.
bool is_undamped(const Model &model);

std::vector<Finding> audit(const Model &model);
/// What costs next to nothing: without the lowest modes.
std::vector<Finding> quick_audit(const Model &model);

} // namespace plm
