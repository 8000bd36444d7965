// Harmonic balance on small reduced models (small_reduced.hpp), as its tests use it.
#pragma once
#include "searches/hbm.hpp"
#include "support/small_reduced.hpp"

namespace test {

/// Harmonic balance, as many harmonics as needed, where exact motions would be the default.
inline plm::HbmOptions by_harmonics() {
    plm::HbmOptions options;
    options.motion = plm::MotionKind::harmonics;
    return options;
}
/// Frequencies of the excitation from `low` to `high` (rad/s).
plm::Hbm solver(std::shared_ptr<const plm::ReducedModel> m, const plm::HbmOptions &o, double low,
                double high);
/// Largest displacement of a DOF over the period of a point.
double peak_at(const plm::ReducedModel &m, const plm::BranchPoint &p, int dof);

} // namespace test
