#include "capi/model_space.hpp"
#include "space/set_modes.hpp"
#include <algorithm>
#include <cmath>
#include <limits>

namespace plm::capi {
namespace {

void require_count(const vector<double> &values, std::int64_t n) {
    const auto found = static_cast<std::int64_t>(values.size());
    if (found < n)
        throw Error(PLM_ERR_ARGUMENT,
                    format("n is too large: the model has only %lld modes of finite frequency",
                           static_cast<long long>(found)))
            .argument("n");
}

} // namespace

const Space &contact_space(ModelHandle &h, double highest_frequency, std::int64_t least_modes) {
    const std::int64_t wanted = std::min(least_modes, h.core->n_free());
    h.space = make_contact_space(h.core, highest_frequency, wanted, h.owner->watch(), h.space);
    return *h.space;
}

std::unique_ptr<Spaceless> spaceless(const ModelHandle &h, std::int64_t n_modes) {
    return h.space ? nullptr : Spaceless::if_worth(h.core, n_modes, h.owner->watch());
}

Field LowestModes::shapes(std::int64_t n) const {
    return space ? combine(space->vectors, coordinates.columns(0, n)) : vectors.columns(0, n);
}

namespace {

// The space that is exact in statics gives an upper bound of the n-th frequency, and the space that is
// accurate up to there the modes to the model's space_tolerance, from where it is not far to exact ones.
LowestModes modes_in_space(ModelHandle &h, const PairStates &states, std::int64_t n) {
    const double all = std::numeric_limits<double>::infinity();
    const Space &first = contact_space(h, 0, n + 8);
    const bool open = states.n_closed() == 0;
    SpaceModes modes = modes_of_contact_set(first, states, all);
    require_count(modes.values, n);
    if (open) return {std::move(modes.values), h.space, std::move(modes.vectors), Field()};
    const double highest = std::sqrt(std::max(0.0, modes.values[static_cast<std::size_t>(n - 1)]));
    modes = modes_of_contact_set(contact_space(h, highest, n + 8), states, all);
    require_count(modes.values, n);
    StructureModes exact = exact_set_modes(*h.space, states, modes, n, h.owner->watch());
    return {std::move(exact.values), nullptr, Matrix(), std::move(exact.vectors)};
}

} // namespace

LowestModes lowest_modes(ModelHandle &h, const PairStates &states, std::int64_t n, Spaceless *without) {
    if (!without) return modes_in_space(h, states, n);
    StructureModes modes = without->modes(states, n);
    require_count(modes.values, n);
    return {std::move(modes.values), nullptr, Matrix(), std::move(modes.vectors)};
}

} // namespace plm::capi
