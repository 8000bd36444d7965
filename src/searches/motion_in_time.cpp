#include "searches/motion_in_time.hpp"
#include "contact/contact_force.hpp"
#include "hbm/harmonic_choice.hpp"
#include "hbm/make_system.hpp"
#include "motions/penetration.hpp"
#include "orbits/mean_motion.hpp"

namespace plm {
namespace {

// Periods for the bounces to set in, and those whose mean counts: twice as many change the estimate by its
// half, and no more of it is known, since such a motion never repeats.
constexpr MeanOver periods{1, 2};

// The forces less those of the linear springs that the solution's own contact is: had the motion drifted on
// with these, it would say nothing against the solution.
Matrix unexplained(const ReducedModel &reduced, const BranchPoint &point, const ContactIndicator &indicator,
                   const MeanMotion &mean) {
    const std::int64_t solved = point.n_harmonics;
    const ContactMotion contact = contact_motion(reduced, point);
    BranchPoint moved = point;
    moved.eta_0.assign(mean.motion.col(0), mean.motion.col(1));
    moved.eta = mean.motion.columns(1, 2 * solved);
    Matrix u = penetration_of(reduced, moved, solved), springs;
    for (std::int64_t i = 0; i < u.rows(); ++i) {
        // in compliance form the unknowns hold the slack, too
        const double slack = 1 / (*contact.stiffness)[i] - 1 / reduced.contact.stiffness[i];
        for (std::int64_t k = 0; k < u.cols(); ++k) u(i, k) += slack * mean.force(i, k);
    }
    apply_indicator(indicator, *contact.stiffness, u, springs);
    for (std::int64_t k = 0; k < u.rows() * u.cols(); ++k)
        springs.data()[k] = mean.force.data()[k] - springs.data()[k];
    return springs;
}

} // namespace

HarmonicChange change_in_time(std::shared_ptr<const ReducedModel> reduced, const HbmOptions &options,
                              const BranchPoint &point, Watch watch) {
    const std::int64_t multiple = options.period_multiple, solved = point.n_harmonics, all = 2 * solved + 2;
    const MeanMotion mean = mean_motion(reduced, point, multiple, periods, all, watch);
    const auto system = make_system(reduced, options_at(point, multiple, options));
    vector<double> x(system->size()), residual(system->size());
    system->from_point(point, x.data());
    system->residual(x.data(), point.omega, residual.data());
    system->linearize();
    HarmonicContent content;
    content.force_change = unexplained(*reduced, point, system->indicator(), mean);
    content.tail_response = mean.motion.columns(2 * solved + 1, 2 * (all - solved));
    return harmonic_change(*reduced, point, multiple, content, *system, x.data());
}

} // namespace plm
