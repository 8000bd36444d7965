#include "orbits/exact_motion.hpp"
#include "linalg/scale.hpp"
#include "motions/penetration.hpp"
#include "orbits/period_map.hpp"
#include <algorithm>
#include <cmath>
#include <utility>

namespace plm {
namespace {

constexpr int max_steps = 10, event_steps = 5;
constexpr int may_wander = 3; // steps that may wander; later ones have to contract
constexpr double contraction = 0.7;
constexpr double same_motion = 0.3; // of the motion's size: farther away it is another one
// How exact a motion has to be for its multipliers. What they still change by, as a share of their distance
// from the unit circle; a motion, as a share of its size, that is exact enough wherever they are.
constexpr double settled = 1e-2, exact_state = 1e-9;
// Of the series of the flow and of its monodromy: they are to leave an exact state exact.
constexpr double enough_digits = 1e-11;
// A step, as a share of that distance, after which they are told where no better motion is found: beside a
// fold the exact curve has turned already.
constexpr double safe_state = 2e-5;
// The same by the instants of the events, as angles.
constexpr double safe_shift = 5e-4, exact_shift = 1e-7;

// The fastest motion of the stiffest contact set bounds the length of the flow's pieces from above; every
// event ends one.
double flops_of_run(const ExactFlow &flow, std::int64_t periods, std::size_t n_events) {
    const FlowModel &model = flow.model();
    ContactSet stiffest(model);
    stiffest.assign_stiffest();
    const double n = static_cast<double>(model.size()), z = static_cast<double>(model.n_pairs()),
                 pieces = 16 + 0.5 * stiffest.rate() * flow.period() * static_cast<double>(periods) +
                          static_cast<double>(n_events);
    return pieces * 26 * 2 * n * (n + z); // 26 terms of the series
}

// The flag is safe when the multipliers are farther from the unit circle than they are uncertain.
struct Verdict {
    explicit Verdict(vector<std::complex<double>> of = {}) : multipliers(std::move(of)) {
        for (const std::complex<double> &m : multipliers) {
            margin = std::min(margin, std::abs(std::abs(m) - 1));
            n_outside += std::abs(m) > 1;
        }
    }
    /// INFINITY: another number of them is outside.
    double change_from(const Verdict &before) const {
        if (before.n_outside != n_outside || before.multipliers.size() != multipliers.size()) return INFINITY;
        double change = 0;
        for (std::size_t i = 0; i < multipliers.size(); ++i)
            change = std::max(change, std::abs(std::abs(multipliers[i]) - std::abs(before.multipliers[i])));
        return change;
    }
    vector<std::complex<double>> multipliers; // the largest first
    double margin = 1;
    std::int64_t n_outside = 0;
};

// Chatter, overflow, a mode too fast for the exponential, a singular system: no answer.
template <class Search> vector<std::complex<double>> found_by(const Search &search) {
    try {
        return search();
    } catch (const Error &e) {
        if (e.status() == status::cancelled || e.status() == status::memory) throw;
        return {};
    }
}

} // namespace

EventSequence contact_events(const ReducedModel &m, const BranchPoint &point, std::int64_t period_multiple) {
    const double period = 2 * M_PI / point.omega * static_cast<double>(period_multiple);
    return event_sequence(contact_motion(m, point).u, period);
}

// Where no pair switches the solution is exact. Elsewhere the instants of harmonic balance are those of a
// nearby motion, to whose shifts a stiff contact's multipliers answer with a factor of ten.
vector<std::complex<double>> MotionBeside::multipliers(std::shared_ptr<const FlowModel> model,
                                                       const BranchPoint &point,
                                                       const EventSequence &sequence, const Matrix &within,
                                                       const OfMonodromy &of) {
    if (model != model_) {
        model_ = model;
        modes_ = std::make_shared<ContactModesKept>(model);
    }
    ExactFlow flow(model, point.omega, point.force_scale, Watch(), modes_);
    flow.truncate(enough_digits);
    if (sequence.events.empty())
        return found_by([&] {
            const double duration = flow.period() * static_cast<double>(periods_);
            return of(plm::monodromy(*model, {{duration, sequence.first}}));
        });
    const double omega = point.omega / static_cast<double>(periods_);
    const FlowState start = model->state(point.eta_0, point.eta, omega, 0.0);
    const double flops = flops_of_run(flow, periods_, sequence.events.size());
    vector<std::complex<double>> found;
    if (flops > of_curve) found = found_by([&] { return by_events(flow, start, sequence, within, of); });
    if (!found.empty() || flops > affordable_) return found;
    if (static_cast<std::int64_t>(correction_.size()) == model->state_size())
        found =
            found_by([&] { return newton(flow, start, moved(*model, start, correction_, 1), within, of); });
    return !found.empty() ? found : found_by([&] { return newton(flow, start, start, within, of); });
}

// With the events of the solution, as long as no other ones come in. On a surface with many pairs some barely
// touch, and their events find no rest; what does not change from step to step does not hang on them.
vector<std::complex<double>> MotionBeside::by_events(const ExactFlow &flow, const FlowState &start,
                                                     EventSequence sequence, const Matrix &within,
                                                     const OfMonodromy &of) {
    EventMotion motion(flow.model(), flow.omega(), flow.force_scale(), periods_, within);
    const EnergyNorm norm(flow);
    Verdict verdict;
    for (int k = 0; k < event_steps; ++k) {
        if (!motion.solve(sequence)) return {};
        if (norm.distance(motion.start(), start) > same_motion * motion.size()) return {};
        const Verdict before = std::exchange(verdict, Verdict(of(motion.monodromy())));
        if (motion.is_consistent() && motion.shift() <= std::max(exact_shift, safe_shift * verdict.margin))
            return verdict.multipliers;
        if (k > 0 && verdict.n_outside != before.n_outside) return {};
        sequence = motion.moved(sequence);
    }
    return verdict.multipliers;
}

vector<std::complex<double>> MotionBeside::newton(ExactFlow &flow, const FlowState &start, FlowState now,
                                                  const Matrix &within, const OfMonodromy &of) {
    const FlowModel &model = flow.model();
    const EnergyNorm norm(flow);
    double before = INFINITY;
    Verdict verdict(found_multipliers_);
    vector<std::complex<double>> safe; // of the last run that was that near to a motion
    for (int k = 0; k < max_steps; ++k) {
        const PeriodRun run = run_periods(flow, now, periods_);
        const Matrix matrix = plm::monodromy(model, run.intervals, enough_digits, Watch(), modes_.get());
        FlowState next = moved(model, now, period_step(model, now, run, matrix, within), 1);
        const double step = run.size > 0 ? norm.distance(next, now) / run.size : 0;
        if (!std::isfinite(step) || norm.distance(next, start) > same_motion * run.size) return {};
        if (k >= may_wander && step > contraction * before) return safe;
        now = std::move(next);
        const Verdict last = std::exchange(verdict, Verdict(of(matrix)));
        if (k == 0 && !last.multipliers.empty()) before = norm.distance(now, found_) / run.size;
        // near grazing multipliers change with the root of the penetration, from point to point more evenly
        const double shorter = step / before,
                     left = verdict.change_from(last) * (k > 0 ? std::sqrt(shorter) : shorter);
        before = step;
        if (step > exact_state && !(left <= settled * verdict.margin)) {
            if (step <= safe_state * verdict.margin) safe = verdict.multipliers;
            continue;
        }
        keep_correction(model, start, now);
        found_ = std::move(now);
        return found_multipliers_ = verdict.multipliers;
    }
    return safe;
}

const vector<double> &MotionBeside::settle() {
    model_ = nullptr;
    modes_ = nullptr;
    found_multipliers_.clear();
    return correction_;
}

void MotionBeside::keep_correction(const FlowModel &model, const FlowState &start, const FlowState &found) {
    correction_.clear();
    for (std::int64_t j = 0; j < model.n_moving(); ++j) correction_.push_back(found.y[j] - start.y[j]);
    for (std::int64_t j = 0; j < model.n_massive(); ++j) correction_.push_back(found.v[j] - start.v[j]);
}

} // namespace plm
