#include "capi/model_space.hpp"
#include <algorithm>
#include <cmath>
#include <limits>

namespace plm::capi {
namespace {

std::int64_t count(const SpaceModes &modes) {
    return static_cast<std::int64_t>(modes.values.size());
}

[[noreturn]] void too_few(std::int64_t found) {
    throw Error(PLM_ERR_ARGUMENT, format("n is too large: the model has only %lld modes of finite frequency",
                                         static_cast<long long>(found)))
        .argument("n");
}

} // namespace

const Space &contact_space(ModelHandle &h, double highest_frequency, std::int64_t least_modes) {
    const std::int64_t wanted = std::min(least_modes, h.core->n_free());
    h.space = make_contact_space(h.core, highest_frequency, wanted, h.owner->watch(), h.space);
    return *h.space;
}

// Two passes: the space that is exact in statics gives an upper bound of the n-th frequency, and the space
// that is accurate up to there gives the modes to the model's space_tolerance.
LowestModes lowest_modes(ModelHandle &h, const PairStates &states, std::int64_t n) {
    const double all = std::numeric_limits<double>::infinity();
    const Space &first = contact_space(h, 0, n + 8);
    const bool open = states.n_closed() == 0;
    SpaceModes modes = modes_of_contact_set(first, states, all);
    if (count(modes) < n) too_few(count(modes));
    if (!open) {
        const double highest = std::sqrt(std::max(0.0, modes.values[static_cast<std::size_t>(n - 1)]));
        modes = modes_of_contact_set(contact_space(h, highest, n + 8), states, all);
        if (count(modes) < n) too_few(count(modes));
    }
    return {h.space, std::move(modes)};
}

} // namespace plm::capi
