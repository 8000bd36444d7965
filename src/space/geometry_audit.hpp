// What coordinates of nodes say of a model.
#pragma once
#include "space/finding.hpp"
#include "space/model.hpp"
#include <vector>

namespace plm {

/// Nothing where no coordinates are known.
std::vector<Finding> geometry_audit(const Model &model);

} // namespace plm
