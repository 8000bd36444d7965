// Which linear system the dominant mode is taken from when the host leaves it to the library.
#pragma once
#include "sampling/dominant_mode.hpp"
#include "space/rest.hpp"

namespace plm {

/// How far the dominant mode explains vibration through both half cycles, 0..1: the least, over the two, of
/// the likeness (MatchedModes) of the mode that resembles it in the half cycle's linear system (pairs with dV
/// > 0 closed; then those with dV < 0), times the share of that mode's contact that is as the system assumes
/// it: closed pairs pressed, open ones apart.
double half_cycle_agreement(const Space &space, const DominantMode &dominant);

/// `automatic` resolved: sliding when at rest more than half of the pairs are closed, else open; but where
/// parts float then, the one that holds them: closed as at rest if that does as well as all pairs, all pairs
/// if nothing could vibrate else. Without pre-load and gap (homogeneous) no pair is closed at rest, and the
/// open system is taken unless it cannot serve: a part of it is held by contact alone, or the dominant mode
/// of the sliding system explains the two half cycles clearly better (components that vibrate each by itself
/// when open).
LinearSystem reference_system(LinearSystem asked, const Space &space, const RestState &rest, bool homogeneous,
                              ModeRequest request);

} // namespace plm
