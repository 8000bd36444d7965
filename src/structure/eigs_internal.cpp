#include "structure/eigs_internal.hpp"
#include "linalg/error.hpp"

namespace plm {

void pseudo_random(vector<double> &x, std::int64_t seed) {
    std::uint64_t state = 0x9E3779B97F4A7C15u + static_cast<std::uint64_t>(seed);
    for (double &value : x) {
        state = state * 6364136223846793005u + 1442695040888963407u; // Knuth's MMIX generator
        value = static_cast<double>(state >> 11) * 0x1p-52 - 1;
    }
}

void Pencil::poll() const {
    if (options.cancelled && options.cancelled())
        throw Error(PLM_CANCELLED, "cancelled by the progress callback").reason(PLM_REASON_CANCELLED);
}

} // namespace plm
