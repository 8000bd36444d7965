// Rows of tall matrices in bands, for threads. The cut follows from the number of rows alone, and so do the
// digits.
#pragma once
#include "linalg/parallel.hpp"

namespace plm {

constexpr std::int64_t row_bands = 16;

/// body(band, first row, rows) for each band; flops: of all together.
template <class Body> void for_row_bands(std::int64_t rows, double flops, const Body &body) {
    parallel_for(row_bands, flops, [&](std::int64_t k) {
        const std::int64_t first = k * rows / row_bands;
        body(k, first, (k + 1) * rows / row_bands - first);
    });
}

} // namespace plm
