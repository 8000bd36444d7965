#include "reduction/reduced_rest.hpp"
#include <algorithm>

namespace plm {

bool is_loaded_at_rest(const ReducedModel &m) {
    return std::any_of(m.preload_0.begin(), m.preload_0.end(), [](double f) { return f != 0; }) ||
           m.contact.has_interference();
}

std::shared_ptr<const StaticState> rest_of(const ReducedModel &m) {
    return m.rest.get([&] {
        if (is_loaded_at_rest(m)) return solve_static({m.lambda_0, m.gap_0, m.preload_0, m.contact});
        return StaticState{vector<double>(m.lambda_0.size(), 0.0), m.contact.unloaded_penetration(), 0};
    });
}

vector<double> coupling_at_rest(const ReducedModel &m) {
    return m.contact.closed_shares(rest_of(m)->penetration);
}

} // namespace plm
