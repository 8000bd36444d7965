// Which methods are worth their time.
#pragma once
#include "linalg/memory.hpp"

namespace plm {

/// 1 for each entry that no other one beats in one of time and error without losing in the other; 0 where
/// either is NaN.
vector<char> pareto_front(const vector<double> &time, const vector<double> &error);

} // namespace plm
