// Checks of the arguments that name a point, a DOF or a measure of a branch.
#pragma once
#include "capi/handles.hpp"

namespace plm::capi {

void require_point(const Branch &branch, std::int64_t point);
void require_measure(const Branch &branch, std::int64_t dof, std::int32_t measure, std::int32_t harmonic);

} // namespace plm::capi
