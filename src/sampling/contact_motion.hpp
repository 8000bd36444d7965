// How far a mode moves the contact.
#pragma once
#include "space/space.hpp"

namespace plm {

/// The most of any pair, of what a motion of the mode's energy and frequency (rad/s) can do to that pair in
/// the open structure. mode_penetration: B phi.
double contact_motion(const Space &space, const vector<double> &mode_penetration, double omega);
/// Below it there are rounding errors only.
constexpr double no_contact_motion = 1e-9;

/// The same of what the pairs on springs (Z, 0: open) would move if they were released, which hold against it
/// by their forces; 1 at most: 1 of a mode that is one of the contact, 0 of one that passes it by.
double contact_share(const Space &space, const vector<double> &mode_penetration, double omega,
                     const vector<double> &spring);

} // namespace plm
