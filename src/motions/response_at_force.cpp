#include "motions/response_at_force.hpp"

namespace plm {

double response_at_force(double response, const BranchPoint &about, const MotionOptions &options) {
    const double there =
        about.force_scale > 0 ? response * options.force_scale / about.force_scale : response;
    return there > 0 ? there : 1;
}

} // namespace plm
