#include "searches/motion_in_time.hpp"
#include "contact/contact_force.hpp"
#include "hbm/harmonic_choice.hpp"
#include "hbm/make_system.hpp"
#include "motions/penetration.hpp"
#include "orbits/orbit_point.hpp"
#include "orbits/recorded_motion.hpp"

namespace plm {
namespace {

// Periods for the bounces to set in, and those whose mean counts: twice as many change the estimate by its
// half, and no more of it is known, since such a motion never repeats.
constexpr std::int64_t settling = 1, counted = 2;

// Means over the counted periods: a_0, a_1, b_1, ..., of harmonics up to `last`, in coordinates or forces.
Matrix mean_harmonics(const RecordedMotion &motion, std::int64_t last) {
    const vector<double> mean = motion.mean();
    Matrix all(static_cast<std::int64_t>(mean.size()), 1);
    std::copy(mean.begin(), mean.end(), all.data());
    for (std::int64_t h = 1; h <= last; ++h) all.append(motion.harmonics(counted * h, 1));
    return all;
}

Matrix in_static_coordinates(const FlowModel &model, const Matrix &motion) {
    Matrix out(model.size(), motion.cols());
    for (std::int64_t k = 0; k < motion.cols(); ++k) {
        const vector<double> y =
            model.in_static_coordinates(vector<double>(motion.col(k), motion.col(k) + motion.rows()));
        std::copy(y.begin(), y.end(), out.col(k));
    }
    return out;
}

// The forces less those of the linear springs that the solution's own contact is: had the motion drifted on
// with these, it would say nothing against the solution.
Matrix unexplained(const ReducedModel &reduced, const BranchPoint &point, const ContactIndicator &indicator,
                   const Matrix &motion, const Matrix &force) {
    const std::int64_t solved = point.n_harmonics;
    const ContactMotion contact = contact_motion(reduced, point);
    BranchPoint mean = point;
    mean.eta_0.assign(motion.col(0), motion.col(1));
    mean.eta = motion.columns(1, 2 * solved);
    Matrix u = penetration_of(reduced, mean, solved), springs;
    for (std::int64_t i = 0; i < u.rows(); ++i) {
        // in compliance form the unknowns hold the slack, too
        const double slack = 1 / (*contact.stiffness)[i] - 1 / reduced.contact.stiffness[i];
        for (std::int64_t k = 0; k < u.cols(); ++k) u(i, k) += slack * force(i, k);
    }
    apply_indicator(indicator, *contact.stiffness, u, springs);
    for (std::int64_t k = 0; k < u.rows() * u.cols(); ++k)
        springs.data()[k] = force.data()[k] - springs.data()[k];
    return springs;
}

} // namespace

HarmonicChange change_in_time(std::shared_ptr<const ReducedModel> reduced, const HbmOptions &options,
                              const BranchPoint &point, Watch watch) {
    const std::int64_t multiple = options.period_multiple, solved = point.n_harmonics, all = 2 * solved + 2;
    const auto model = std::make_shared<const FlowModel>(reduced, point.omega);
    ExactFlow flow(model, point.omega, point.force_scale, watch, std::make_shared<ContactModesKept>(model));
    FlowState state = start_of(*model, point, multiple);
    flow.complete(state);
    const double period = static_cast<double>(multiple) * flow.period();
    flow.advance(state, settling * period);
    RecordedMotion motion;
    flow.advance(state, (settling + counted) * period, &motion);
    const Matrix harmonics = in_static_coordinates(*model, mean_harmonics(motion, all)),
                 force = mean_harmonics(motion.contact_forces(flow), solved);

    const auto system = make_system(reduced, options_at(point, multiple, options));
    vector<double> x(system->size()), residual(system->size());
    system->from_point(point, x.data());
    system->residual(x.data(), point.omega, residual.data());
    system->linearize();
    HarmonicContent content;
    content.force_change =
        unexplained(*reduced, point, system->indicator(), harmonics.columns(0, 2 * solved + 1), force);
    content.tail_response = harmonics.columns(2 * solved + 1, 2 * (all - solved));
    return harmonic_change(*reduced, point, multiple, content, *system, x.data());
}

} // namespace plm
