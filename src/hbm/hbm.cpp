#include "hbm/hbm.hpp"
#include "hbm/continuation.hpp"
#include "hbm/start.hpp"
#include <chrono>
#include <cmath>

namespace plm {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

// Keeps a response curve's points, and gets it going again where it is stuck.
class CurveOwner final : public PathOwner {
  public:
    CurveOwner(HbmSystem &system, const HbmOptions &options, Watch watch, Branch &branch)
        : system_(system), options_(options), watch_(watch), branch_(branch) {}

    void record(const PathPoint &p) override {
        BranchPoint point;
        point.residual = p.residual;
        point.iterations = p.iterations;
        point.arclength = p.arclength;
        system_.to_point(p.x.data(), p.parameter, point);
        point.n_switching = system_.indicator().n_switching;
        branch_.append(std::move(point));
    }
    bool cancelled(double fraction) override { return cancelled_ || watch_.cancelled("sweep", fraction); }
    bool rescue(double omega, vector<double> &x) override {
        try {
            return start_again(omega, x);
        } catch (const Error &e) { // the branch found so far stays valid
            if (e.status() != PLM_CANCELLED) throw;
            cancelled_ = true;
            return false;
        }
    }

  private:
    bool start_again(double omega, vector<double> &x) {
        const StartOutcome out = find_start(system_, branch_.reduced(), options_, omega, true, watch_, x);
        branch_.newton_iterations += out.iterations;
        branch_.factorizations += out.factorizations;
        return out.converged;
    }

    HbmSystem &system_;
    const HbmOptions &options_;
    Watch watch_;
    Branch &branch_;
    bool cancelled_ = false;
};

PathOptions path_options(const HbmOptions &o) {
    PathOptions p;
    p.low = 2 * M_PI * o.frequency_min_hz;
    p.high = 2 * M_PI * o.frequency_max_hz;
    p.upward = o.upward;
    p.tolerance = o.tolerance;
    p.max_iterations = o.max_iterations;
    p.max_points = o.max_points;
    p.initial_step = o.initial_step;
    p.min_step = o.min_step;
    p.max_step = o.max_step;
    return p;
}

void check(const HbmOptions &o) {
    const auto refuse = [](const char *name, const std::string &text) {
        throw Error(PLM_ERR_ARGUMENT, text).argument(name);
    };
    if (o.n_harmonics < 1) refuse("n_harmonics", "n_harmonics must be at least 1");
    if (!(o.frequency_min_hz > 0 && o.frequency_max_hz > o.frequency_min_hz))
        refuse("frequency_min_hz",
               format("the frequency range [%g, %g] Hz is empty or not positive; set "
                      "frequency_min_hz < frequency_max_hz, or use a basis that has a window",
                      o.frequency_min_hz, o.frequency_max_hz));
    if (!(o.min_step > 0 && o.max_step > o.min_step))
        refuse("min_step", "steps need 0 < min_step < max_step");
}

} // namespace

Hbm::Hbm(std::shared_ptr<const ReducedModel> reduced, double window_min_hz, double window_max_hz,
         const HbmOptions &options, Watch watch)
    : reduced_(std::move(reduced)), options_(options), watch_(watch) {
    if (options_.frequency_min_hz <= 0) options_.frequency_min_hz = window_min_hz;
    if (options_.frequency_max_hz <= 0) options_.frequency_max_hz = window_max_hz;
    check(options_);
}

Hbm::~Hbm() = default;

std::shared_ptr<const Branch> Hbm::sweep() const {
    const Clock::time_point begin = Clock::now();
    auto branch = std::make_shared<Branch>(reduced_, options_.n_harmonics, options_.force_scale);
    const auto system = make_system(reduced_, options_, &branch->space_used);
    const double low = 2 * M_PI * options_.frequency_min_hz, high = 2 * M_PI * options_.frequency_max_hz;
    vector<double> x;
    StartOutcome start;
    double omega = options_.upward ? low : high;
    // A start inside a super-harmonic region may fail: the range is entered a little further on then.
    for (int attempt = 0; attempt < 5 && !start.converged; ++attempt) {
        watch_.step("sweep", 0.0);
        omega = (options_.upward ? low : high) + (options_.upward ? 1 : -1) * 0.02 * attempt * (high - low);
        start = find_start(*system, *reduced_, options_, omega, false, watch_, x);
        branch->newton_iterations += start.iterations;
        branch->factorizations += start.factorizations;
    }
    if (!start.converged)
        throw Error(
            PLM_ERR_CONVERGENCE,
            format("no periodic response was found at the start of the sweep (%.6g Hz and four neighbours); "
                   "start from the other end (direction) or with a smaller force_scale",
                   (options_.upward ? low : high) / (2 * M_PI)))
            .reason(PLM_REASON_START_FAILED);
    CurveOwner owner(*system, options_, watch_, *branch);
    const PathOutcome out = follow_path(*system, path_options(options_), x, omega, start.residual, owner);
    branch->end_reason = out.end_reason;
    branch->newton_iterations += out.newton_iterations;
    branch->factorizations += out.factorizations;
    branch->failed_steps = out.failed_steps;
    branch->seconds = seconds_since(begin);
    branch->seconds_per_iteration =
        branch->seconds / static_cast<double>(std::max<std::int64_t>(1, branch->factorizations));
    watch_.log(
        1, format("sweep: %zu points, %lld Newton iterations, %lld factorizations, %lld failed steps, %.3g s",
                  branch->points().size(), static_cast<long long>(branch->newton_iterations),
                  static_cast<long long>(branch->factorizations),
                  static_cast<long long>(branch->failed_steps), branch->seconds));
    return branch;
}

std::shared_ptr<const Branch> Hbm::solve(double frequency_hz, const Branch *start, std::int64_t point) const {
    const Clock::time_point begin = Clock::now();
    if (!(frequency_hz > 0 && std::isfinite(frequency_hz)))
        throw Error(PLM_ERR_ARGUMENT, "the frequency must be positive and finite").argument("frequency_hz");
    auto branch = std::make_shared<Branch>(reduced_, options_.n_harmonics, options_.force_scale);
    const auto system = make_system(reduced_, options_, &branch->space_used);
    const double omega = 2 * M_PI * frequency_hz;
    vector<double> x(system->size(), 0.0);
    if (start) {
        if (start->reduced_model() != reduced_ || start->n_harmonics() != options_.n_harmonics)
            throw Error(PLM_ERR_ARGUMENT, "the start belongs to another basis or number of harmonics")
                .argument("start");
        system->from_point(start->points().at(static_cast<std::size_t>(point)), x.data());
    }
    const StartOutcome out = find_start(*system, *reduced_, options_, omega, start != nullptr, watch_, x);
    if (!out.converged)
        throw Error(PLM_ERR_CONVERGENCE,
                    format("no periodic response was found at %.6g Hz; give a neighbouring point "
                           "as start or use a sweep",
                           frequency_hz))
            .argument("frequency_hz")
            .reason(PLM_REASON_START_FAILED);
    BranchPoint result;
    result.residual = out.residual;
    result.iterations = out.iterations;
    system->to_point(x.data(), omega, result);
    result.n_switching = system->indicator().n_switching;
    branch->append(std::move(result));
    branch->newton_iterations = out.iterations;
    branch->factorizations = out.factorizations;
    branch->end_reason = PLM_REASON_RANGE_END;
    branch->seconds = seconds_since(begin);
    branch->seconds_per_iteration =
        branch->seconds / static_cast<double>(std::max<std::int64_t>(1, out.factorizations));
    return branch;
}

} // namespace plm
