// Contact forces at rest that are given, in place of gaps: the gaps follow from them.
#pragma once
#include "contact/contact.hpp"

namespace plm {

/// Of a pair that keeps its gap (PLM_KEEP_GAP of plm.h).
constexpr double keep_gap = -1;

struct GivenForces {
    vector<double> force; // N of each pair, or keep_gap, as of pairs beyond the end

    bool empty() const;
    bool has(std::int64_t pair) const {
        return pair < static_cast<std::int64_t>(force.size()) && force[pair] != keep_gap;
    }
    /// What rest is found with: the pairs of given force never touch, and these forces are loads (n of them,
    /// 0 of the other pairs).
    Contact without_them(const Contact &contact) const;
    vector<double> loads(std::int64_t n) const;
    /// Of these pairs u = N / k_n, and N to the last digit.
    void put_penetrations(const Contact &contact, vector<double> &penetration) const;
    void put_forces(vector<double> &forces) const;
};

} // namespace plm
