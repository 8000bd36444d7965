#include "orbits/curve_progress_bytes.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

constexpr std::int64_t most = 1'000'000'000, most_attempts = 8, most_sets = 4096;

template <class Bytes, class X> void pass_real(Bytes &bytes, X &x) {
    bytes(x);
    bytes.require(std::isfinite(x), "a number that is not finite");
}

template <class Bytes, class S> void pass_state(Bytes &bytes, S &state) {
    bytes(state.x);
    pass_real(bytes, state.parameter);
}

template <class Bytes, class P> void pass_path(Bytes &bytes, P &p) {
    pass_state(bytes, p.at);
    pass_state(bytes, p.direction);
    pass_real(bytes, p.orientation);
    pass_real(bytes, p.scale);
    pass_real(bytes, p.arclength);
    pass_real(bytes, p.step);
    pass_real(bytes, p.last_step);
    pass_state(bytes, p.last_direction);
    bytes(p.plain_predictor);
    bytes(p.rescued);
    bytes.integer(p.n_recorded, 0, most);
    bytes.integer(p.n_rescues, 0, most);
    bytes.integer(p.failed_steps, 0, most);
    pass_list(bytes, p.tests, 8, [&](auto &test) { bytes(test); }); // not known where it is no number
    pass_state(bytes, p.target);
    pass_state(bytes, p.target_direction);
    bytes(p.closes_at_start);
    bytes(p.passed);
    bytes.require(p.passed.size() % 6 == 0, "points passed of another kind");
}

template <class Bytes, class T> void pass_tangent(Bytes &bytes, T &tangent) {
    bytes(tangent.x);
    pass_real(bytes, tangent.parameter);
    bytes(tangent.change);
}

void pass_sets(ByteWriter &bytes, const std::vector<PairStates> &sets) {
    bytes.size(static_cast<std::int64_t>(sets.size()), 8);
    for (const PairStates &set : sets) {
        const vector<std::int64_t> flags = set.flags();
        bytes(vector<char>(flags.begin(), flags.end()));
    }
}

void pass_sets(ByteReader &bytes, std::vector<PairStates> &sets) {
    const std::int64_t n = bytes.size(0, 8);
    bytes.require(n <= most_sets, "more contact sets than are kept");
    for (std::int64_t k = 0; k < n; ++k) {
        vector<char> flags;
        bytes(flags);
        const vector<std::int32_t> set(flags.begin(), flags.end());
        sets.push_back(PairStates::from_flags(set.data(), static_cast<std::int64_t>(set.size())));
    }
}

template <class Bytes, class M> void pass_memory(Bytes &bytes, M &memory) {
    pass_sets(bytes, memory.contact_sets);
    pass_tangent(bytes, memory.before);
    pass_tangent(bytes, memory.last);
    bytes(memory.guessed);
    bytes(memory.beside);
}

template <class Bytes, class C> void pass_choices(Bytes &bytes, C &c, std::int64_t n_points) {
    bytes.integer(c.n_harmonics, 0, most);
    bytes(c.modal);
    bytes(c.wants_modal);
    bytes(c.rejects);
    bytes.integer(c.n_kept, 0, std::max<std::int64_t>(n_points, 1));
    bytes.integer(c.wanted_harmonics, 0, most);
    bytes.integer(c.since_change, 0, most);
    bytes.integer(c.blocked, 0, most);
    bytes.integer(c.moved_most, 0, most);
    bytes.integer(c.failed_growths, 0, most);
    pass_real(bytes, c.base_arclength);
}

template <class Bytes, class P> void pass_progress(Bytes &bytes, P &p, std::int64_t n_points) {
    bytes.integer(p.n_points, 0, n_points);
    bytes.integer(p.attempt, 0, most_attempts);
    if (p.n_points == 0) return;
    bytes.integer(p.newton_work.iterations, 0, INT64_MAX);
    bytes.integer(p.newton_work.factorizations, 0, INT64_MAX);
    bytes(p.newton_work.seconds);
    bytes.integer(p.failed_steps, 0, INT64_MAX);
    bytes(p.unknowns_used);
    bytes.integer(p.work, 0, most_work);
    pass_path(bytes, p.path);
    pass_memory(bytes, p.memory);
    pass_choices(bytes, p.harmonics, p.n_points);
}

} // namespace

void write_progress(ByteWriter &bytes, const CurveProgress &progress) {
    pass_progress(bytes, progress, INT64_MAX);
}

CurveProgress read_progress(ByteReader &bytes, std::int64_t n_points) {
    CurveProgress progress;
    pass_progress(bytes, progress, n_points);
    return progress;
}

} // namespace plm
