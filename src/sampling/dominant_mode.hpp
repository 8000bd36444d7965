// The mode of the open or sliding linear system that is taken to carry the contact kinematics (paper, 2.3.2).
#pragma once
#include "sampling/sampler.hpp"

namespace plm {

/// Which mode is wanted: by number, else nearest to a frequency, else the one that responds most.
struct ModeRequest {
    LinearSystem system = LinearSystem::open; // open or sliding, resolved
    std::int64_t mode = 0;                    // 1, 2, ...; 0: not by number
    double frequency_hz = 0;                  // > 0: nearest
    double search_min_hz = 0, search_max_hz = 0;
};

/// The contact set of the open or sliding system.
vector<char> contact_set(LinearSystem system, std::int64_t n_pairs);

/// True when neither a pre-load nor an initial gap sets a scale: the problem is homogeneous of degree one.
bool is_homogeneous(const Model &model);

/// Throws PLM_ERR_ARGUMENT when the mode asked for does not exist.
DominantMode find_dominant_mode(const Space &space, const ModeRequest &request, Watch watch);

} // namespace plm
