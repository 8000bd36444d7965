#include "orbits/orbit_point.hpp"
#include "linalg/blas_lapack.hpp"
#include "motions/branch_path.hpp"
#include "motions/first_harmonics.hpp"
#include "orbits/instant_recorder.hpp"
#include "orbits/recorded_motion.hpp"
#include "reduction/compression.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

// What the harmonics of an exact motion may leave out, of harmonic_tolerance: those that harmonic balance
// would go on with, and those of the coefficients handed out, whose derivatives are read, too. At the gaps,
// whose local motion hardly acts back, more. No less than the motion itself is off by.
constexpr double of_solution = 0.1, of_coefficients = 0.01, at_gaps_more = 20;
constexpr std::int64_t harmonics_at_once = 8;

class OrbitMotion final : public PointMotion {
  public:
    OrbitMotion(std::shared_ptr<const FlowModel> model, std::shared_ptr<ContactModesKept> modes,
                FlowState start, const OrbitConditions &conditions, vector<double> closed_shares)
        : model_(std::move(model)), modes_(std::move(modes)), start_(std::move(start)),
          conditions_(conditions), closed_shares_(std::move(closed_shares)) {}

    const FlowState &start() const { return start_; }
    PointFlow flow() const { return {model_, modes_}; }
    double tolerance() const { return conditions_.tolerance; }

    ValueRange range(std::int64_t dof) const override {
        if (dof != known_dof_) {
            KnownMotion known;
            if (const auto &whole = model_->reduced().model)
                known = whole->known_motion(dof, conditions_.omega, conditions_.force_scale);
            known_range_ = range_of_flow(one_row(model_->dof_row(dof)), known);
            known_dof_ = dof;
        }
        return known_range_;
    }

    ValueRange range_of(const vector<double> &row) const override { return range_of_flow(row_of_flow(row)); }

    vector<double> displacement(double fraction) const override {
        return model_->in_static_coordinates(run(fraction - std::floor(fraction), nullptr).y);
    }

    // the recorder begins with the instant after the first, which is the last one of a periodic motion
    vector<double> history(const vector<double> &row, std::int64_t n) const override {
        InstantRecorder recorder(row_of_flow(row), period() / static_cast<double>(n));
        run(1, &recorder);
        vector<double> values = recorder.take_values();
        require(static_cast<std::int64_t>(values.size()) == n, "history: instants of a period");
        std::rotate(values.begin(), values.end() - 1, values.end());
        return values;
    }

    Matrix contact_forces(std::int64_t n_harmonics) const override {
        RecordedMotion motion;
        run(1, &motion);
        const RecordedMotion forces = motion.contact_forces(conditions_.flow(model_, modes_));
        const vector<double> mean = forces.mean();
        const Matrix harmonics = forces.harmonics(1, n_harmonics);
        Matrix all(static_cast<std::int64_t>(mean.size()), 2 * n_harmonics + 1);
        std::copy(mean.begin(), mean.end(), all.data());
        std::copy(harmonics.data(), harmonics.col(harmonics.cols()), all.col(1));
        return all;
    }

    const vector<double> &closed_shares() const override { return closed_shares_; }

  private:
    static Matrix one_row(const vector<double> &row) {
        Matrix rows(1, static_cast<std::int64_t>(row.size()));
        std::copy(row.begin(), row.end(), rows.data());
        return rows;
    }

    Matrix row_of_flow(const vector<double> &row) const {
        return one_row(model_->from_static_coordinates(row));
    }

    ValueRange range_of_flow(const Matrix &row, const KnownMotion &known = {}) const {
        RecordedMotion motion;
        run(1, &motion);
        return motion.ranges(row, known, conditions_.omega)[0];
    }

    double period() const {
        return static_cast<double>(conditions_.period_multiple) * 2 * M_PI / conditions_.omega;
    }

    FlowState run(double periods, FlowRecorder *recorder) const {
        ExactFlow flow = conditions_.flow(model_, modes_);
        FlowState state = start_;
        flow.advance(state, periods * static_cast<double>(conditions_.period_multiple) * flow.period(),
                     recorder);
        return state;
    }

    std::shared_ptr<const FlowModel> model_;
    std::shared_ptr<ContactModesKept> modes_;
    FlowState start_;
    OrbitConditions conditions_;
    vector<double> closed_shares_;
    mutable std::int64_t known_dof_ = -1; // of the last range(): curves are asked for one DOF at a time
    mutable ValueRange known_range_ = {};
};

// Of the motion, of the gaps together and of each of them: mean squares, of all and of what the harmonics so
// far leave out.
struct Remainder {
    double all, gaps, left, left_at_gaps;
    vector<double> at_pair, left_at_pair;

    bool is_within(double share) const {
        return left <= share * share * all &&
               left_at_gaps <= share * share * at_gaps_more * at_gaps_more * gaps;
    }
    void take(const Matrix &harmonics, const Matrix &at_gaps) {
        for (std::int64_t k = 0; k < harmonics.cols(); ++k) {
            left -= 0.5 * dot(harmonics.rows(), harmonics.col(k), harmonics.col(k));
            left_at_gaps -= 0.5 * dot(at_gaps.rows(), at_gaps.col(k), at_gaps.col(k));
            for (std::int64_t i = 0; i < at_gaps.rows(); ++i)
                left_at_pair[i] -= 0.5 * at_gaps(i, k) * at_gaps(i, k);
        }
    }
    /// The largest share, of the motion or of a pair's, as harmonic_error() counts them.
    double largest_share() const {
        constexpr double least_motion = 0.03; // of the pair that moves most
        constexpr double rounding = 1e-14;    // of differences of squares
        const double most = at_pair.empty() ? 0 : *std::max_element(at_pair.begin(), at_pair.end());
        double share = all > 0 ? left / all : 0;
        for (std::size_t i = 0; i < at_pair.size() && most > 0; ++i)
            share =
                std::max(share, left_at_pair[i] / std::max(at_pair[i], least_motion * least_motion * most));
        return share > rounding ? std::sqrt(share) : 0;
    }
};

Remainder mean_squares(const Matrix &covariance, const Matrix &gap) {
    const Matrix at_gaps = product('N', 'N', gap, covariance);
    double all = 0, gaps = 0;
    for (std::int64_t j = 0; j < covariance.cols(); ++j) all += covariance(j, j);
    vector<double> at_pair(static_cast<std::size_t>(gap.rows()), 0.0);
    for (std::int64_t j = 0; j < gap.cols(); ++j)
        for (std::int64_t i = 0; i < gap.rows(); ++i) at_pair[i] += gap(i, j) * at_gaps(i, j);
    for (double &square : at_pair) gaps += square = std::max(0.0, square);
    return {all, gaps, all, gaps, at_pair, at_pair};
}

// Mean and harmonics in the coordinates of the basis.
void put_harmonics(const FlowModel &model, const RecordedMotion &motion, const MotionOptions &options,
                   BranchPoint &point) {
    point.eta_0 = model.in_static_coordinates(motion.mean());
    Remainder rest = mean_squares(motion.covariance(), model.gap());
    const std::int64_t fewest = few_harmonics(model.reduced()) * options.period_multiple,
                       most = std::max(fewest, options.max_harmonics * options.period_multiple);
    const double enough = std::max(of_coefficients * options.allowed_harmonic_error(), options.tolerance);
    const auto told = [&] {
        return rest.gaps > 0 ? std::sqrt(std::max(rest.left_at_gaps, 0.0) / rest.gaps) : 0.0;
    };
    point.n_harmonics = 0;
    Matrix eta;
    while (eta.cols() < 2 * most) {
        if (eta.cols() >= 2 * fewest && point.n_harmonics == 0 &&
            rest.is_within(of_solution * options.allowed_harmonic_error())) {
            point.n_harmonics = eta.cols() / 2;
            point.harmonic_tail = told();
        }
        if (point.n_harmonics > 0 && rest.is_within(enough)) break;
        const std::int64_t known = eta.cols() / 2,
                           more = std::min(most - known, known == 0 ? fewest : harmonics_at_once);
        const Matrix next = motion.harmonics(known + 1, more);
        rest.take(next, product('N', 'N', model.gap(), next));
        eta.append(next);
    }
    if (point.n_harmonics == 0) {
        point.n_harmonics = eta.cols() / 2;
        point.harmonic_tail = told();
    }
    for (std::int64_t k = 0; k < eta.cols(); ++k) {
        const vector<double> turned =
            model.in_static_coordinates(vector<double>(eta.col(k), eta.col(k) + eta.rows()));
        std::copy(turned.begin(), turned.end(), eta.col(k));
    }
    point.eta = std::move(eta);
    point.harmonic_error = rest.largest_share();
}

} // namespace

FlowState start_of(const FlowModel &model, const BranchPoint &point, std::int64_t period_multiple) {
    if (const auto *motion = dynamic_cast<const OrbitMotion *>(point.motion.get())) return motion->start();
    return model.state(point.eta_0, point.eta, point.omega / static_cast<double>(period_multiple), 0.0);
}

PointFlow flow_of(const BranchPoint &point) {
    const auto *motion = dynamic_cast<const OrbitMotion *>(point.motion.get());
    return motion ? motion->flow() : PointFlow();
}

bool kept_orbit(const BranchPoint &point, KeptOrbit &kept) {
    const auto *motion = dynamic_cast<const OrbitMotion *>(point.motion.get());
    if (motion) kept = {motion->start(), motion->tolerance(), motion->closed_shares()};
    return motion != nullptr;
}

std::shared_ptr<const PointMotion> motion_of(std::shared_ptr<const FlowModel> model,
                                             std::shared_ptr<ContactModesKept> modes,
                                             const BranchPoint &point, KeptOrbit kept) {
    const OrbitConditions conditions{point.omega, point.force_scale, point.period_multiple, kept.tolerance};
    return std::make_shared<OrbitMotion>(std::move(model), std::move(modes), std::move(kept.start),
                                         conditions, std::move(kept.shares));
}

PointStart start_of(const Branch &branch, std::int64_t point) {
    const BranchPoint &p = branch.points()[static_cast<std::size_t>(point)];
    const FlowModel model(branch.reduced_model(), p.omega);
    FlowState state = start_of(model, p, branch.period_multiple());
    if (!branch.reduced().from) return {branch.reduced_model(), state};
    const auto whole = uncompressed(branch.reduced_model());
    const FlowModel flow_model(whole, p.omega);
    for (vector<double> *y : {&state.y, &state.v}) {
        vector<double> in_whole(flow_model.size(), 0.0);
        gemv('N', 1.0, branch.reduced().from->coordinates, model.in_static_coordinates(*y).data(), 0.0,
             in_whole.data());
        *y = flow_model.from_static_coordinates(in_whole);
    }
    return {whole, state};
}

vector<double> orbit_unknowns(const OrbitEquations &equations, const BranchPoint &point,
                              std::int64_t period_multiple) {
    return equations.unknowns(start_of(equations.model(), point, period_multiple));
}

BranchPoint orbit_point(const OrbitEquations &equations, const MotionOptions &options, const PathState &at,
                        double residual, std::int64_t iterations) {
    const OrbitConditions conditions = equations.conditions(at.parameter);
    RecordedMotion motion;
    ExactFlow flow = conditions.flow(equations.shared_model(), equations.modes());
    FlowState start = equations.state(at.x.data());
    flow.complete(start); // what follows without mass is no unknown
    FlowState state = start;
    flow.advance(state, static_cast<double>(conditions.period_multiple) * flow.period(), &motion);
    BranchPoint point;
    point.omega = conditions.omega;
    point.force_scale = conditions.force_scale;
    point.period_multiple = conditions.period_multiple;
    put_harmonics(equations.model(), motion, options, point);
    put_record(residual, iterations, motion.n_switching(), point);
    point.motion = std::make_shared<OrbitMotion>(equations.shared_model(), equations.modes(), start,
                                                 conditions, motion.closed_shares());
    return point;
}

} // namespace plm
