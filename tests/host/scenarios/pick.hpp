#pragma once
#include "scenario.hpp"

namespace scenarios {

/// One of the handles, now and then none; some of them are stale.
template <class H> H *Scenario::pick(const std::vector<H *> &all) {
    return all.empty() || random_.chance(0.01) ? nullptr : random_.one_of(all);
}

} // namespace scenarios
