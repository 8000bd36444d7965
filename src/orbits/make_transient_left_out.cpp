// In place of make_transient.cpp and its engines when PLM_WITH_TRANSIENT is OFF.
#include "orbits/make_transient.hpp"

namespace plm {

std::unique_ptr<Transient> make_transient(std::shared_ptr<const Model>, std::shared_ptr<const ReducedModel>) {
    throw Error(status::not_built, "motion in time was left out of this build; configure libplm with "
                                   "-DPLM_WITH_TRANSIENT=ON");
}

bool transient_is_built() {
    return false;
}

} // namespace plm
