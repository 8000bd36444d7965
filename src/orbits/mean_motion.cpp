#include "orbits/mean_motion.hpp"
#include "linalg/work.hpp"
#include "motions/motion_measures.hpp"
#include "orbits/exact_flow.hpp"
#include "orbits/orbit_point.hpp"
#include "orbits/recorded_motion.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

// The record is one period of so many of the response.
Matrix mean_harmonics(const RecordedMotion &record, std::int64_t last, std::int64_t periods) {
    const vector<double> mean = record.mean();
    Matrix all(static_cast<std::int64_t>(mean.size()), 1);
    std::copy(mean.begin(), mean.end(), all.data());
    for (std::int64_t h = 1; h <= last; ++h) all.append(record.harmonics(periods * h, 1));
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

// Mean square of what the coordinates do beside their mean.
double square_of(const BranchPoint &p) {
    return 0.5 * dot(p.eta.rows() * p.eta.cols(), p.eta.data(), p.eta.data());
}

// The same after the periods that damping takes to forget where the motion began.
double square_after(const Branch &curve, const BranchPoint &begin, Watch watch) {
    constexpr int periods = 40, watched = 4, instants = 16, count = watched * instants;
    const auto model = std::make_shared<FlowModel>(curve.reduced_model(), begin.omega);
    ExactFlow flow(model, begin.omega, begin.force_scale, watch, std::make_shared<ContactModesKept>(model));
    FlowState state = start_of(*model, begin, curve.period_multiple());
    const std::int64_t n = model->size();
    const double period = static_cast<double>(curve.period_multiple()) * flow.period();
    vector<double> mean(static_cast<std::size_t>(n), 0.0);
    double square = 0;
    for (int k = 0; k < count; ++k) {
        flow.advance(state, period * (periods + static_cast<double>(k) / instants));
        square += dot(n, state.y.data(), state.y.data()) / count;
        for (std::int64_t j = 0; j < n; ++j) mean[j] += state.y[j] / count;
    }
    return square - dot(n, mean.data(), mean.data());
}

} // namespace

MeanMotion mean_motion(std::shared_ptr<const ReducedModel> reduced, const BranchPoint &point,
                       std::int64_t period_multiple, MeanOver periods, std::int64_t n_harmonics,
                       Watch watch) {
    const auto model = std::make_shared<const FlowModel>(std::move(reduced), point.omega);
    ExactFlow flow(model, point.omega, point.force_scale, watch, std::make_shared<ContactModesKept>(model));
    FlowState state = start_of(*model, point, period_multiple);
    flow.complete(state);
    const double period = static_cast<double>(period_multiple) * flow.period();
    flow.advance(state, static_cast<double>(periods.settling) * period);
    RecordedMotion record;
    flow.advance(state, static_cast<double>(periods.settling + periods.counted) * period, &record);
    return {in_static_coordinates(*model, mean_harmonics(record, n_harmonics, periods.counted)),
            mean_harmonics(record.contact_forces(flow), n_harmonics, periods.counted)};
}

bool says_more(const Branch &curve, const Branch &part, Watch watch) {
    constexpr double lasting = 0.25, larger = 1.2; // of squares: half the size, a tenth more
    const BranchPoint &top = curve.points()[static_cast<std::size_t>(largest_response(curve))];
    double known = 0;
    for (const BranchPoint &p : part.points()) known = std::max(known, square_of(p));
    if (square_of(top) < larger * known) return false;
    double after = INFINITY; // a motion that there is no effort to look at is taken at its word
    within(effort_left(), [&] { after = square_after(curve, top, watch); });
    return after > lasting * square_of(top) && after > larger * known;
}

} // namespace plm
