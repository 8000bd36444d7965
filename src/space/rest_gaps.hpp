// Initial gaps of the pairs whose contact force at rest is given.
#pragma once
#include "space/spaceless.hpp"

namespace plm {

/// The model with the gaps at which its given forces (Model::rest_forces()) are those at rest. Throws as
/// solve_static().
std::shared_ptr<const Model> with_rest_gaps(std::shared_ptr<Model> model, Watch watch);

} // namespace plm
