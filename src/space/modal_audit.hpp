// What the lowest modes of the open structure tell of a model: units, whether the excitation moves any of
// them, whether the linear response to it closes a gap.
#pragma once
#include "space/finding.hpp"
#include "space/model.hpp"
#include <vector>

namespace plm {

std::vector<Finding> modal_audit(const Model &model);

} // namespace plm
