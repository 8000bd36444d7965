#include "searches/marching_search.hpp"
#include "hbm/harmonic_choice.hpp"
#include "hbm/make_system.hpp"
#include "hbm/solved_point.hpp"
#include "linalg/work.hpp"
#include "motions/branch_path.hpp"
#include "orbits/recorded_motion.hpp"
#include "orbits/shooting.hpp"
#include "reduction/reduced_rest.hpp"
#include "searches/curve.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

class Marching {
  public:
    Marching(std::shared_ptr<const ReducedModel> reduced, const MarchingOptions &options,
             const std::vector<std::shared_ptr<const Branch>> &known, Watch watch)
        : reduced_(std::move(reduced)), options_(options), known_(known), watch_(watch),
          hbm_(with_first_harmonics(*reduced_, options.hbm)) {
        hbm_.unknowns = NonlinearUnknowns::modal;
        hbm_.period_multiple = 1;
        system_ = make_system(reduced_, hbm_);
    }

    MarchingSearch run() {
        within(effort_left(), [&] { search(); });
        return std::move(out_);
    }

  private:
    void search() {
        find_largest();
        const double low = 2 * M_PI * hbm_.frequency_min_hz, high = 2 * M_PI * hbm_.frequency_max_hz;
        for (std::int64_t i = 0; i < options_.n_frequencies; ++i) {
            const double done = (static_cast<double>(i) + 0.5) / static_cast<double>(options_.n_frequencies);
            for (double scale : options_.scales) {
                watch_.step("search by marching", done);
                if (scale != 0 && largest_.eta.empty()) continue;
                try_start(low + done * (high - low), scale);
            }
        }
    }

    void find_largest() {
        double most = 0;
        for (const auto &branch : known_)
            for (const BranchPoint &p : branch->points()) {
                const double size = norm2(p.eta.rows() * p.eta.cols(), p.eta.data());
                if (size > most) most = size, largest_ = p;
            }
        rest_.assign(reduced_->static_size(), 0.0);
        const ReducedModel &m = *reduced_;
        const vector<double> coupling = coupling_at_rest(m);
        if (std::find(coupling.begin(), coupling.end(), 1.0) == coupling.end()) return;
        rest_ = rest_of(m)->coordinates;
    }

    void try_start(double omega, double scale) {
        ++out_.n_starts;
        const auto model = std::make_shared<const FlowModel>(reduced_, omega);
        ExactFlow flow(model, omega, hbm_.force_scale, watch_);
        FlowState start;
        const vector<double> rest = model->from_static_coordinates(rest_);
        start.y = rest;
        start.v.assign(rest.size(), 0.0);
        if (scale != 0) {
            const FlowState moving = model->state(largest_.eta_0, largest_.eta, omega, 0.0);
            for (std::size_t j = 0; j < rest.size(); ++j) {
                start.y[j] += scale * (moving.y[j] - rest[j]);
                start.v[j] = scale * moving.v[j];
            }
        }
        ShootingOptions shooting;
        shooting.transient_periods = options_.transient_periods;
        shooting.tolerance = 1e-8; // a first guess for the harmonics, which cut off more
        PeriodicOrbit orbit;
        try {
            orbit = periodic_orbit(flow, start, shooting);
        } catch (const Error &e) { // chattering from a violent start: nothing found here
            if (e.status() != status::convergence) throw;
            return;
        }
        if (!orbit.converged) return;
        ++out_.n_periodic;
        BranchPoint point = in_harmonics(flow, orbit);
        if (!correct(point)) return;
        if (is_known(point)) {
            ++out_.n_known;
            return;
        }
        settle_harmonics(reduced_, options_.hbm, point, watch_);
        out_.branches.push_back(trace_through(reduced_, options_.hbm, point, watch_));
        known_.push_back(out_.branches.back());
    }

    // Fourier coefficients of the orbit, dynamic part in the coordinates of h >= 1.
    BranchPoint in_harmonics(ExactFlow &flow, const PeriodicOrbit &orbit) {
        RecordedMotion motion;
        FlowState state = orbit.state;
        flow.advance(state, state.time + flow.period(), &motion);
        BranchPoint point;
        point.omega = flow.omega();
        point.force_scale = hbm_.force_scale;
        point.n_harmonics = hbm_.n_harmonics;
        point.eta_0 = flow.model().in_static_coordinates(motion.mean());
        point.eta =
            least_squares(to_flow(flow.model(), reduced_->size()), motion.harmonics(1, hbm_.n_harmonics));
        return point;
    }

    // T: n x r, from what the flow makes of unit coordinates.
    static Matrix to_flow(const FlowModel &model, std::int64_t r) {
        Matrix t(model.size(), r);
        const vector<double> zero(model.size(), 0.0);
        for (std::int64_t j = 0; j < r; ++j) {
            Matrix unit(r, 2);
            unit(j, 0) = 1;
            const vector<double> y = model.state(zero, unit, 1.0, 0.0).y;
            std::copy(y.begin(), y.end(), t.col(j));
        }
        return t;
    }

    bool correct(BranchPoint &point) {
        vector<double> x = unknowns_of(*system_, point);
        NewtonLimits limits = newton_limits(hbm_);
        limits.parameter_scale = point.omega;
        const NewtonOutcome out = newton_at(*system_, limits, x, point.omega);
        if (!out.converged) return false;
        point = solved_point(*system_, {x, point.omega}, out.residual, out.iterations);
        return true;
    }

    // The known branches at the same frequency, corrected with the same harmonics.
    bool is_known(const BranchPoint &point) {
        for (const auto &branch : known_) {
            if (branch->period_multiple() != 1) continue; // another motion, with other harmonics
            const auto &points = branch->points();
            for (std::size_t i = 1; i < points.size(); ++i) {
                const double left = points[i - 1].omega - point.omega, right = points[i].omega - point.omega;
                if (left * right > 0 || left == right) continue;
                BranchPoint guess = between(points[i - 1], points[i], left / (left - right));
                guess.omega = point.omega;
                if (correct(guess) && solution_distance(guess, point) < same_response) return true;
            }
        }
        return false;
    }

    std::shared_ptr<const ReducedModel> reduced_;
    MarchingOptions options_;
    std::vector<std::shared_ptr<const Branch>> known_;
    Watch watch_;
    HbmOptions hbm_;
    std::unique_ptr<HbmSystem> system_;
    BranchPoint largest_;
    vector<double> rest_;
    MarchingSearch out_;
};

} // namespace

MarchingSearch search_by_marching(std::shared_ptr<const ReducedModel> reduced, const MarchingOptions &options,
                                  const std::vector<std::shared_ptr<const Branch>> &known, Watch watch) {
    if (options.hbm.period_multiple != 1)
        throw Error(status::argument, "the search by marching needs period_multiple = 1")
            .argument("period_multiple");
    return Marching(std::move(reduced), options, known, watch).run();
}

} // namespace plm
