// Modes of one frequency have no directions of their own: an eigensolver returns those that rounding picks,
// others for each order of the DOFs. What is to follow from the structure alone takes the directions from
// what it looks at.
#pragma once
#include "space/space.hpp"

namespace plm {

/// The end of the modes whose frequency is that of mode `first` but for 5e-7 of it, as rounding and the
/// digits of a file leave equal ones. values: ascending (rad^2/s^2).
std::int64_t cluster_end(const vector<double> &values, std::int64_t first);

/// Turns the modes of every cluster among themselves so that what `seen` (k x m) sees of it is seen in the
/// fewest of them, most in the first: of one row all in the first, sum of (row . phi) phi, and nothing in the
/// others. Those that `seen` does not see are turned by the next matrix.
void align_clusters(const std::vector<const Matrix *> &seen, SpaceModes &modes);

/// What drives a structure: the excitation and, through the springs of the pairs that touch at rest, the
/// moving walls; of all pairs, where none touches.
HarmonicLoads drive_of(const Space &space);
/// To look at: the parts of the harmonic that drives the resonance, two rows each, real and imaginary part;
/// of no part two rows of zeros. And a shape, by its kinetic energy (1 x m).
struct DrivingLoads {
    std::vector<LoadPart> parts;
    Matrix rows;
};
DrivingLoads driving_loads(const Space &space);
Matrix row_of(const Space &space, const vector<double> &shape);

} // namespace plm
