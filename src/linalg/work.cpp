#include "linalg/work.hpp"
#include "linalg/error.hpp"

namespace plm {
namespace {

// initial-exec: as in memory.cpp
[[gnu::tls_model("initial-exec")]] thread_local WorkListener *listening = nullptr;
[[gnu::tls_model("initial-exec")]] thread_local double flops_since = 0;

} // namespace

WorkScope::WorkScope(WorkListener *listener) : previous_(listening), previous_flops_(flops_since) {
    listening = listener;
    flops_since = 0;
}

WorkScope::~WorkScope() {
    listening = previous_;
    flops_since = previous_flops_;
}

void worked(double flops) {
    if (!listening) return;
    flops_since += flops;
    if (flops_since < piece_of_work) return;
    flops_since = 0;
    if (listening->goes_on())
        throw Error(PLM_CANCELLED, "cancelled by the progress callback").reason(PLM_REASON_CANCELLED);
}

} // namespace plm
