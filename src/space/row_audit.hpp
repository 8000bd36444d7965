// What the gap rows of a model tell of how they were made: components, signs and lengths.
#pragma once
#include "space/finding.hpp"
#include "space/model.hpp"
#include <vector>

namespace plm {

/// model: with at least one pair.
std::vector<Finding> row_audit(const Model &model);

/// Some pair is not between parts of the structure alone: a translation of everything moves it. Where
/// translations are not known, one of a single DOF.
bool touches_ground(const Model &model);

} // namespace plm
