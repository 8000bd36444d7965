// A factor of K + sigma M that treats the rigid-body modes R by themselves: (K + sigma M)^-1 M R = R / sigma.
// Through the factor alone they would come with an error of eps times the condition, and bury the elastic
// part of every static solution under it.
#pragma once
#include "structure/field.hpp"

namespace plm {

/// rigid_modes: R, M-orthonormal. The mass matrix is not kept.
std::unique_ptr<TallFactor> make_rigid_factor(std::unique_ptr<TallFactor> factor, const Field &rigid_modes,
                                              const TallMatrix &mass, double sigma);

} // namespace plm
