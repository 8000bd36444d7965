// Stays of the flow in a contact set that need no polynomials: what ended the last stay there is the guess.
#include "orbits/exact_flow.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

constexpr int most_looks = 5;        // at the end of a stay, for one piece
constexpr double shorter_look = 0.5; // where it is not known what a pair does meanwhile
// Of the longest: shorter ones would come nearer and nearer to where two pairs switch at once.
constexpr double shortest_look = 1.0 / 32;
constexpr std::int64_t more_lost = 8;

} // namespace

// The excitation's angle at the end of the last stay in this set, as time from now; 0 where it is past.
double ExactFlow::expected_end(const ContactModesKept::Stay &last) const {
    const double ahead = std::remainder(last.angle - omega_ * modal_->now(), 2 * M_PI);
    return std::max(0.0, ahead / omega_);
}

bool ExactFlow::may_stay(FlowRecorder *recorder) const {
    return !(recorder && recorder->needs_motion()) && n_lost_stays_ <= more_lost + n_stays_;
}

// False: the polynomials have to say what happens; nothing has moved.
bool ExactFlow::stay(FlowState &state, double left, FlowRecorder *recorder) {
    if (!may_stay(recorder) || !modal_->begin_stay()) return false;
    ContactModesKept::Stay &last = modes_->last_stay(events_.states());
    const double longest = std::min(left, 0.125 * period());
    std::int64_t pair = last.pair;
    double duration = pair < 0 ? longest : modal_->zero_of(pair, expected_end(last));
    modal_->look(0, here_);
    for (int look = 0; look < most_looks; ++look) {
        if (!(duration > 0 && duration <= longest)) {
            pair = -1;
            duration = longest;
        }
        modal_->look(duration, there_);
        const std::int64_t other =
            events_.not_staying(here_, there_, modal_->fourth(duration), modal_->rounding(), duration, pair);
        if (other < 0) {
            end_stay(state, duration, pair, recorder);
            return true;
        }
        if (other != pair && events_.is_beyond(other, there_(other, 0))) {
            const double share = here_(other, 0) / (here_(other, 0) - there_(other, 0));
            duration = modal_->zero_of(pair = other, std::clamp(share, 0.0, 1.0) * duration);
        } else {
            pair = -1;
            duration *= shorter_look;
            if (duration < shortest_look * 0.125 * period()) break;
        }
    }
    ++n_lost_stays_;
    return false;
}

void ExactFlow::end_stay(FlowState &state, double duration, std::int64_t pair, FlowRecorder *recorder) {
    ++n_stays_;
    if (recorder) report(state.time, 1.0, duration, nothing_, nullptr, *recorder);
    modal_->advance(duration);
    state.time = modal_->now();
    fresh_ = false;
    events_.forget_zeros();
    if (pair < 0) return;
    modes_->last_stay(events_.states()) = {pair, omega_ * state.time};
    switch_pair(pair, duration / period(), state.time);
    if (!pass_on()) modal_->leave(state, change_);
}

} // namespace plm
