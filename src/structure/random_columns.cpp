#include "structure/random_columns.hpp"

namespace plm {

void pseudo_random(Matrix &x, std::int64_t seed) {
    std::uint64_t state = 0x9E3779B97F4A7C15u + static_cast<std::uint64_t>(seed);
    for (std::int64_t i = 0; i < x.rows() * x.cols(); ++i) {
        state = state * 6364136223846793005u + 1442695040888963407u; // Knuth's MMIX generator
        x.data()[i] = static_cast<double>(state >> 11) * 0x1p-52 - 1;
    }
}

} // namespace plm
