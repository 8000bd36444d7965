// The states of the pairs of a model: at one instant of a motion, or in one linear system. Which there are is
// up to the law; who holds a PairStates hands it on and need not know.
#pragma once
#include "contact/contact_law.hpp"
#include "linalg/memory.hpp"
#include <cstdint>
#include <cstring>

namespace plm {

using PairState = ContactLaw::State;

class PairStates {
  public:
    PairStates() = default;
    static PairStates all_open(std::int64_t n_pairs) { return PairStates(n_pairs, PairState::open); }
    static PairStates all_closed(std::int64_t n_pairs) { return PairStates(n_pairs, PairState::closed); }
    /// As hosts hand them over: 0 open, else closed.
    static PairStates from_flags(const std::int32_t *flags, std::int64_t n_pairs);
    /// As hosts get them: 0 open, 1 closed.
    vector<std::int64_t> flags() const;

    std::int64_t size() const { return static_cast<std::int64_t>(state_.size()); }
    bool empty() const { return state_.empty(); }
    bool is_closed(std::int64_t pair) const { return state_[pair] == PairState::closed; }
    void set(std::int64_t pair, bool closed) { state_[pair] = closed ? PairState::closed : PairState::open; }
    /// To the state on the other side of zero penetration.
    void switch_pair(std::int64_t pair) { set(pair, !is_closed(pair)); }

    std::int64_t n_closed() const;
    vector<std::int64_t> closed_pairs() const; // ascending
    /// Every pair on the other side.
    PairStates inverted() const;
    /// Pairs whose state is another one there; of the same size.
    std::int64_t n_different(const PairStates &other) const;
    /// In one comparison of memory: sets are looked up by their states.
    bool operator==(const PairStates &other) const {
        return state_.size() == other.state_.size() &&
               (state_.empty() || std::memcmp(state_.data(), other.state_.data(), state_.size()) == 0);
    }
    bool operator!=(const PairStates &other) const { return !(*this == other); }
    /// Some order, for lookup.
    bool operator<(const PairStates &other) const {
        if (state_.size() != other.state_.size()) return state_.size() < other.state_.size();
        return !state_.empty() && std::memcmp(state_.data(), other.state_.data(), state_.size()) < 0;
    }

  private:
    PairStates(std::int64_t n_pairs, PairState state) : state_(n_pairs, state) {}

    vector<PairState> state_;
};

} // namespace plm
