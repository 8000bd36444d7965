// What the functions of an hbm share: the solver behind it, its branches in and out.
#pragma once
#include "capi/handles.hpp"

namespace plm::capi {

using BranchPtr = std::shared_ptr<const Branch>;

/// A solver with the options as they are now.
Hbm solver(const HbmHandle &h);
plm_branch *publish_branch(const HbmHandle &h, BranchPtr core);
/// A branch among the arguments: of the same reduced model, since its coordinates mean nothing in another.
std::shared_ptr<BranchHandle> own_branch(const HbmHandle &h, const plm_branch *branch, const char *name);

} // namespace plm::capi
