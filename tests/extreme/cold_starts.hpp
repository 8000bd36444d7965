// Tables beside the rows: starts without a guess, and the scenes of examples/scenes.
#pragma once
#include "solver.hpp"

namespace extreme {

/// 25 frequencies over the window of the cracked plate, each started without a guess.
struct ColdStarts {
    double ratio = 0; // contact stiffness over the local stiffness of the structure
    int converged = 0;
    std::string failing; // frequencies in Hz
    Work work;
};

ColdStarts cold_starts(double ratio);

/// A default sweep of a scene over the sampler's window.
struct SceneSweep {
    std::string name;
    std::int64_t n_dof = 0, n_pairs = 0;
    std::string outcome;
    std::int32_t reason = 0;
    Work work;
};

std::vector<std::pair<std::string, bool>> scene_cases(); // name, with pre-load
SceneSweep sweep_scene(const std::string &name, bool preload);

} // namespace extreme
