// A curve as comma-separated text, for whatever draws it.
#pragma once
#include "motions/branch.hpp"

namespace plm {

/// A header with the names of the keys, then a line a point with all digits; the decimal sign is a point
/// whatever the locale. The amplitude is that of `of`.
std::string csv_of(const Branch &branch, const Output &of);

} // namespace plm
