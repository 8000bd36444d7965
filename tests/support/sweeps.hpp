// What tests of sweeps share: contact sets as texts, x for a closed pair.
#pragma once
#include "contact/contact_sweep.hpp"
#include <initializer_list>
#include <string>

namespace test {

inline plm::vector<double> numbers(std::initializer_list<double> v) {
    return plm::vector<double>(v);
}

inline std::string text(const plm::PairStates &states) {
    std::string s;
    for (std::int64_t closed : states.flags()) s += closed ? 'x' : '.';
    return s;
}

} // namespace test
