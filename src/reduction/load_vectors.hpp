// Static responses to the excitation: what no low mode carries of the deformation around a loaded DOF.
#pragma once
#include "space/space.hpp"

namespace plm {

/// K^-1 F_h of the open system (rigid-body motion left out) for every excitation harmonic's real and
/// imaginary part, as mass-normalised columns in the coordinates of the space; zero loads give none.
Matrix load_vectors(const Space &space);

} // namespace plm
