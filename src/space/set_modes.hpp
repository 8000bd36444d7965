// Modes of the structure with the springs of closed pairs, which a space gives to its tolerance, as exact as
// those of the open structure.
#pragma once
#include "space/space.hpp"

namespace plm {

/// The n lowest of them, fewer when there are fewer of finite frequency. ritz: those of the space, all or
/// some more than n.
StructureModes exact_set_modes(const Space &space, const PairStates &states, const SpaceModes &ritz,
                               std::int64_t n, Watch watch);

} // namespace plm
