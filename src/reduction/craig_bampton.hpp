// Craig-Bampton: a space of fixed-interface modes and constraint modes.
#pragma once
#include "linalg/monitor.hpp"
#include "space/space.hpp"

namespace plm {

struct CraigBamptonOptions {
    std::int64_t n_fixed = 0;     // fixed-interface modes; 0: all below highest_frequency
    double highest_frequency = 0; // rad/s
    bool load_vectors = true; // static responses of the interior to pre-load and excitation as further modes
};
/// Craig-Bampton (Craig & Bampton 1968): all DOFs with an entry in B retained; diagonalised.
std::shared_ptr<const Space> make_craig_bampton_space(std::shared_ptr<const Model> model,
                                                      const CraigBamptonOptions &options, Watch watch);

} // namespace plm
