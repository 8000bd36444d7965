#include "linalg/work.hpp"
#include <algorithm>
#include <limits>

namespace plm {
namespace {

// initial-exec: as in memory.cpp
[[gnu::tls_model("initial-exec")]] thread_local WorkListener *listening = nullptr;
[[gnu::tls_model("initial-exec")]] thread_local double flops_since = 0;
// whole numbers: their sum does not depend on how threads share the pieces
constexpr std::int64_t no_limit = std::numeric_limits<std::int64_t>::max();
[[gnu::tls_model("initial-exec")]] thread_local std::int64_t done = 0, limit = no_limit;

} // namespace

WorkScope::WorkScope(WorkListener *listener) : previous_(listening), previous_flops_(flops_since) {
    listening = listener;
    flops_since = 0;
}

WorkScope::~WorkScope() {
    listening = previous_;
    flops_since = previous_flops_;
}

std::int64_t work_done() {
    return done;
}

Effort::Effort(double flops) : previous_(limit) {
    constexpr double most = 1e18; // of a sum that stays a number
    if (flops < most) limit = std::min(limit, done + static_cast<std::int64_t>(std::max(0.0, flops)));
}

Effort::~Effort() {
    limit = previous_;
}

double effort_left() {
    return limit == no_limit ? std::numeric_limits<double>::infinity() : static_cast<double>(limit - done);
}

WorkCount::WorkCount() : done_(done), limit_(limit) {
    limit = no_limit;
}

WorkCount::~WorkCount() {
    done = done_, limit = limit_;
}

std::int64_t WorkCount::so_far() const {
    return done - done_;
}

void add_work(std::int64_t flops) {
    done += flops;
    if (done > limit)
        throw Error(status::cancelled, "the effort allowed was spent before there was a result; raise effort")
            .reason(reason::effort);
}

void worked(double flops) {
    add_work(static_cast<std::int64_t>(flops));
    if (!listening) return;
    flops_since += flops;
    if (flops_since < piece_of_work) return;
    flops_since = 0;
    if (listening->goes_on())
        throw Error(status::cancelled, "cancelled by the progress callback").reason(reason::cancelled);
}

} // namespace plm
