// The monodromy matrix of a piecewise-linear motion: the product of the exponentials of its contact
// intervals. The contact force is continuous at an event, so no saltation matrix comes in between.
#pragma once
#include "linalg/monitor.hpp"
#include "orbits/contact_modes.hpp"
#include <complex>

namespace plm {

/// A time span in which every pair keeps its state.
struct ContactInterval {
    double duration = 0;
    PairStates states;
};

/// d(y, y') at the end / d(y, y') at the beginning for a given sequence of contact sets: square of order 2n,
/// or FlowModel::state_size() where coordinates have no mass (y of those that move, y' of those with mass);
/// `tolerance` bounds the truncation error of each interval; from 1e-8 on, and where all coordinates have
/// mass, it is computed in single precision, right to about 1e-5. PLM_ERR_ARGUMENT for a wrong number of
/// pairs or a duration that is not finite and >= 0. `modes`, unless null: those of the sets that are known by
/// them, in double precision, or, from 1e-6 on and where they bear it, in single precision. Cost of an
/// interval of length dt, x = rate dt (contact_set.hpp): (12 + 5 x) 4 n^3 flops about, up to x = 3, and (85 +
/// 16 log2 x) n^3 beyond; half of the terms at 1e-7. Measured, 180 intervals with x near 1 (and 3.5) on one
/// core: 2 (3) ms for n = 12, 8 (11) ms for n = 24, 32 (47) ms for n = 42.
Matrix monodromy(const FlowModel &model, const std::vector<ContactInterval> &intervals,
                 double tolerance = 1e-15, Watch watch = Watch(), ContactModesKept *modes = nullptr);

/// Floquet multipliers: the eigenvalues of a monodromy matrix, largest modulus first.
vector<std::complex<double>> multipliers(const Matrix &monodromy);

} // namespace plm
