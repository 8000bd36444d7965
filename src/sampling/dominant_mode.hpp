// The mode of the open or sliding linear system that is taken to carry the contact kinematics (paper, 2.3.2).
#pragma once
#include "linalg/monitor.hpp"
#include "sampling/sampler_options.hpp"
#include "space/space.hpp"

namespace plm {

/// A linear mode that is taken to carry the contact kinematics.
struct DominantMode {
    LinearSystem system = LinearSystem::open;
    std::int64_t mode = 0; // 1-based in its system
    double frequency_hz = 0;
    int harmonic = 1;                // of the excitation, by which it is driven
    double participation = 0;        // |phi . F_1| / ... share of the drive-point response, in [0, 1]
    vector<double> coordinates;      // in the space
    vector<double> mode_penetration; // dV = B phi, per pair
};

/// Which mode is wanted: by number, else nearest to a frequency, else the one that responds most.
struct ModeRequest {
    LinearSystem system = LinearSystem::open; // resolved: not automatic
    std::int64_t mode = 0;                    // 1, 2, ...; 0: not by number
    double frequency_hz = 0;                  // > 0: nearest
    double search_min_hz = 0, search_max_hz = 0;
};

/// The pairs that are closed in a linear system.
PairStates contact_set(LinearSystem system, const Space &space);
const char *name_of(LinearSystem system);

/// True when neither a pre-load nor an initial gap sets a scale: the problem is homogeneous of degree one.
bool is_homogeneous(const Model &model);

/// Throws PLM_ERR_ARGUMENT when the mode asked for does not exist.
DominantMode find_dominant_mode(const Space &space, const ModeRequest &request, Watch watch);

} // namespace plm
