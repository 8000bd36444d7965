#include "contact/pair_states.hpp"
#include <algorithm>

namespace plm {

PairStates PairStates::from_flags(const std::int32_t *flags, std::int64_t n_pairs) {
    PairStates states = all_open(n_pairs);
    for (std::int64_t i = 0; i < n_pairs; ++i) states.set(i, flags[i] != 0);
    return states;
}

vector<std::int64_t> PairStates::flags() const {
    vector<std::int64_t> flags(state_.size());
    for (std::int64_t i = 0; i < size(); ++i) flags[i] = is_closed(i);
    return flags;
}

std::int64_t PairStates::n_closed() const {
    return std::count(state_.begin(), state_.end(), PairState::closed);
}

vector<std::int64_t> PairStates::closed_pairs() const {
    vector<std::int64_t> pairs;
    for (std::int64_t i = 0; i < size(); ++i)
        if (is_closed(i)) pairs.push_back(i);
    return pairs;
}

PairStates PairStates::inverted() const {
    PairStates other = *this;
    for (std::int64_t i = 0; i < size(); ++i) other.switch_pair(i);
    return other;
}

std::int64_t PairStates::n_different(const PairStates &other) const {
    std::int64_t n = 0;
    for (std::size_t i = 0; i < state_.size(); ++i) n += state_[i] != other.state_[i];
    return n;
}

} // namespace plm
