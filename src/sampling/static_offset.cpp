#include "sampling/static_offset.hpp"
#include <cmath>

namespace plm {

vector<double> static_offset(const Space &space, LinearSystem system,
                             const vector<double> &mode_penetration) {
    const std::int64_t z = space.n_pairs();
    vector<double> d(z), load(space.size(), 0.0);
    for (std::int64_t i = 0; i < z; ++i) d[i] = std::abs(mode_penetration[i]); // F_A = |dV|, F_B = -F_A
    if (z > 0) gemv('T', -1.0, space.gap, d.data(), 0.0, load.data());
    if (system == LinearSystem::sliding) {
        const vector<double> &stiffness = space.model->contact_stiffness();
        vector<double> offset = spring_forces(space.lambda, space.gap, stiffness, load);
        for (std::int64_t i = 0; i < z; ++i) offset[i] /= stiffness[i];
        return offset;
    }
    vector<double> offset(z, 0.0); // without rigid-body motion
    for (std::int64_t j = 0; j < space.size(); ++j)
        load[j] = space.lambda[j] > 0 ? load[j] / space.lambda[j] : 0.0;
    gemv('N', 1.0, space.gap, load.data(), 0.0, offset.data());
    return offset;
}

} // namespace plm
