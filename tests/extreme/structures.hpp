// The small structures of the table.
#pragma once
#include "support/exact_flow.hpp"

namespace extreme {

/// A structure of n DOFs and z pairs with everything at zero.
exact::Structure empty(int n, int z);
void add_spring(exact::Structure &s, int i, int j, double k, double c); // j = -1: to the ground
void set_contact(exact::Structure &s, double stiffness, double gap);    // of every pair

/// n unit masses and unit springs, fixed at one end, force and pre-load at the free end; damping proportional
/// to the stiffness, zeta in the first mode. Pairs: between neighbours i and i + 1, the last mass against the
/// ground.
exact::Structure chain(int n, double zeta, const std::vector<int> &pairs);
/// One unit mass on a unit spring with a stop.
exact::Structure oscillator(double zeta, double contact_stiffness, double gap, double force, double preload);

} // namespace extreme
