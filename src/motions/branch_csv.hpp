// A curve as comma-separated text, for whatever draws it, and the contact of one of its points in words.
#pragma once
#include "motions/branch.hpp"

namespace plm {

/// A header with the names of the keys, then a line a point with all digits; the decimal sign is a point
/// whatever the locale. The amplitude is that of `of`.
std::string csv_of(const Branch &branch, const Output &of);

/// "9 of 15 pairs open and close; closed on average for 44.5 % of the period"
std::string contact_in_words(const Branch &branch, std::int64_t point);

} // namespace plm
