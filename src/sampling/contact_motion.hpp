// How far a mode moves the contact.
#pragma once
#include "space/space.hpp"

namespace plm {

/// The most of any pair, of what a motion of the mode's energy and frequency (rad/s) can do to that pair:
/// about 1 where the mode is one of the contact, 0 where it passes it by. mode_penetration: B phi.
double contact_motion(const Space &space, const vector<double> &mode_penetration, double omega);
/// Below it there are rounding errors only.
constexpr double no_contact_motion = 1e-9;

} // namespace plm
