// Exact motions or harmonic balance.
#pragma once
#include "hbm/options.hpp"
#include "reduction/reduced_model.hpp"

namespace plm {

/// Whether curves of this model are made of exact motions. Throws for motion = exact where other options, or
/// the model, speak against it.
bool prefers_exact(const ReducedModel &reduced, const HbmOptions &options);
/// The same where they are followed on what the motions need of it.
bool prefers_exact_compressed(const ReducedModel &whole, const HbmOptions &options);

} // namespace plm
