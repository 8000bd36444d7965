// The engine for a motion. This header needs none, so that a build may leave them out (PLM_WITH_TRANSIENT).
#pragma once
#include "orbits/transient.hpp"

namespace plm {

/// reduced null: the full model. PLM_ERR_NOT_BUILT when left out of the build.
std::unique_ptr<Transient> make_transient(std::shared_ptr<const Model> model,
                                          std::shared_ptr<const ReducedModel> reduced);
bool transient_is_built();

} // namespace plm
