#include "motions/phase_system.hpp"
#include <algorithm>

namespace plm {

bool PhaseSystem::linearize_all(double &by_force) {
    MotionGradient phase;
    if (!inner_.phase_gradient(phase)) return false;
    by_force = phase.by_force;
    border_.reset(n_, 1);
    inner_.parameter_derivative(border_.columns.data());
    for (std::int64_t i = 0; i < n_; ++i) border_.columns(i, 0) /= unit_;
    std::copy(phase.by_unknowns.begin(), phase.by_unknowns.end(), border_.rows.data());
    border_.corner(0, 0) = phase.by_frequency / unit_;
    inner_.factor_bordered(border_, factor_);
    return true;
}

} // namespace plm
