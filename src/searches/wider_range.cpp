#include "searches/wider_range.hpp"
#include "motions/motion_measures.hpp"
#include "searches/curve.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

enum class End { none, first, last };

// Of the largest response: where the curve ends higher, its top is so near that single DOFs may have theirs
// beyond.
constexpr double still_high = 0.9;

class Widening {
  public:
    Widening(const HbmOptions &options, const SweepRange &range, Watch watch, Branch &branch,
             CurveRecorder *recorder)
        : options_(options), range_(range), watch_(watch), branch_(branch), recorder_(recorder),
          asked_min_(options.frequency_min_hz), asked_max_(options.frequency_max_hz) {}

    void run(const Output *asked) {
        if (points().size() < 2) return; // it left the range with its first step, and leads nowhere
        if (bring_inside()) leave_room();
        asked_ = asked;
        if (asked_ && branch_.end_reason == reason::range_end) bring_inside();
    }

  private:
    // True: it stands inside.
    bool bring_inside() {
        for (;;) {
            const End at = where_highest();
            if (at == End::none) return true;
            if (is_fixed(at)) return false;
            if (!move_range(is_low(at)) || !go_on(at)) {
                if (!asked_) warn(at); // of what is asked its search for the peak speaks
                return false;
            }
            if (branch_.end_reason != reason::range_end) return false;
        }
    }

    double height(std::int64_t point) const {
        return asked_ ? branch_.amplitude(point, asked_->dof, asked_->measure, asked_->harmonic)
                      : response_size(branch_, point);
    }

    std::int64_t highest() const {
        return asked_ ? branch_.highest_point(asked_->dof, asked_->measure, asked_->harmonic)
                      : largest_response(branch_);
    }

    const std::vector<BranchPoint> &points() const { return branch_.points(); }
    double hz(End at) const {
        return (at == End::first ? points().front() : points().back()).omega / (2 * M_PI);
    }
    bool is_low(End at) const { return 2 * hz(at) < options_.frequency_min_hz + options_.frequency_max_hz; }

    // Both ends may lie at one frequency: a curve that comes back through its folds.
    End where_highest() const {
        const std::int64_t top = highest(), n = static_cast<std::int64_t>(points().size());
        if ((top > 0 && top < n - 1) || !(height(top) > 0)) return End::none;
        return top == 0 ? End::first : End::last;
    }

    // The peak of the response as a whole is inside, those of single DOFs stand beside it.
    void leave_room() {
        const double most = response_size(branch_, largest_response(branch_));
        for (End at : {End::first, End::last}) {
            const std::int64_t i = at == End::first ? 0 : static_cast<std::int64_t>(points().size()) - 1;
            if (!(response_size(branch_, i) > still_high * most) || is_fixed(at)) continue;
            if (!move_range(is_low(at)) || !go_on(at) || branch_.end_reason != reason::range_end) return;
        }
    }

    bool is_fixed(End at) const {
        return is_low(at) ? range_.least_hz >= asked_min_ : range_.most_hz <= asked_max_;
    }

    // By half of the range, or where that is wide at its lower end in proportion to the frequency: resonances
    // shift by shares of theirs.
    bool move_range(bool low) {
        const double before = options_.frequency_max_hz - options_.frequency_min_hz;
        double &end = low ? options_.frequency_min_hz : options_.frequency_max_hz;
        const double part = 0.5 * (1 - asked_min_ / asked_max_) * end;
        end = low ? std::max(range_.least_hz, end - part) : std::min(range_.most_hz, end + part);
        return options_.frequency_max_hz - options_.frequency_min_hz >
               before * (1 + 1e-9); // by more than rounding
    }

    bool go_on(End at) {
        const std::size_t n = points().size();
        const CurveStart start = at == End::first ? CurveStart{points()[0], {points()[1]}, true}
                                                  : CurveStart{points()[n - 1], {points()[n - 2]}, true};
        HbmOptions options = options_;
        options.max_points -= static_cast<std::int64_t>(n) - 1; // the start is recorded once more
        Branch piece(branch_.reduced_model(), branch_.force_scale(), branch_.period_multiple());
        trace_curve(options, start, watch_, piece, recorder_);
        add_cost(piece);
        if (piece.end_reason == reason::loop_closed) // what was known is a part of it
            take_loop(piece);
        else if (at == End::first)
            branch_.prepend(piece);
        else
            branch_.continue_with(piece);
        if (at == End::last || piece.end_reason != reason::range_end) branch_.end_reason = piece.end_reason;
        return piece.points().size() > 1;
    }

    void take_loop(const Branch &loop) {
        branch_.truncate(0);
        for (const BranchPoint &point : loop.points()) branch_.append(point);
    }

    void add_cost(const Branch &piece) {
        branch_.newton_work += piece.newton_work;
        branch_.failed_steps += piece.failed_steps;
        branch_.warnings.add(piece.warnings);
        if (piece.unknowns_used != branch_.unknowns_used) branch_.unknowns_used = "both";
    }

    void warn(End at) {
        const bool low = is_low(at);
        watch_.keeping(branch_.warnings)
            .warn(reason::no_peak,
                  format("the response is largest at the %s end of the curve, %.6g Hz, though the range was "
                         "moved there from %.6g Hz: the resonance lies elsewhere or does not stand out, as "
                         "under damping near critical (1 %% is the ratio 0.01; of Rayleigh's damping alpha "
                         "is in 1/s, beta in s). Set "
                         "frequency_min_hz and frequency_max_hz of the hbm, or name the dominant mode of the "
                         "sampler (mode, mode_frequency_hz)",
                         low ? "lower" : "upper", hz(at), low ? asked_min_ : asked_max_));
    }

    HbmOptions options_; // with the range as it is now
    const SweepRange range_;
    Watch watch_;
    Branch &branch_;
    CurveRecorder *recorder_;
    const double asked_min_, asked_max_;
    const Output *asked_ = nullptr;
};

} // namespace

void bring_peak_inside(const HbmOptions &options, const SweepRange &range, const Output *asked, Watch watch,
                       Branch &branch, CurveRecorder *recorder) {
    if (branch.end_reason == reason::range_end) Widening(options, range, watch, branch, recorder).run(asked);
}

} // namespace plm
