// Where a curve stands, as bytes. Sizes that only its equations know are checked when it goes on.
#pragma once
#include "linalg/bytes.hpp"
#include "motions/curve_progress.hpp"

namespace plm {

void write_progress(ByteWriter &bytes, const CurveProgress &progress);
/// Of a curve with so many points.
CurveProgress read_progress(ByteReader &bytes, std::int64_t n_points);

/// Operations that a curve has taken: what bytes say of it adds up to a number.
constexpr std::int64_t most_work = 10'000'000'000'000'000;

} // namespace plm
