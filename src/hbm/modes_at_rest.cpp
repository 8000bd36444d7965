#include "hbm/modes_at_rest.hpp"
#include "space/linear_contact.hpp"
#include <limits>

namespace plm {

SpaceModes modes_at_rest(const ReducedModel &m, const vector<double> &coupling) {
    vector<double> spring(coupling);
    for (std::int64_t i = 0; i < m.n_pairs(); ++i) spring[i] *= m.contact.stiffness[i];
    return modes_with_springs(m.lambda, m.n_massless, m.gap, spring, std::numeric_limits<double>::infinity());
}

} // namespace plm
