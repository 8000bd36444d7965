#include "orbits/make_transient.hpp"
#include "orbits/full_motion.hpp"
#include "orbits/reduced_motion.hpp"

namespace plm {

std::unique_ptr<Transient> make_transient(std::shared_ptr<const Model> model,
                                          std::shared_ptr<const ReducedModel> reduced) {
    if (reduced) return std::make_unique<ReducedMotion>(std::move(reduced));
    return std::make_unique<FullMotion>(std::move(model));
}

bool transient_is_built() {
    return true;
}

} // namespace plm
