#include "hbm/nonlinear_mode.hpp"
#include "contact/contact_measures.hpp"
#include "hbm/harmonic_tail.hpp"
#include "hbm/make_system.hpp"
#include "hbm/mode_system.hpp"
#include "hbm/modes_at_rest.hpp"
#include "hbm/solved_point.hpp"
#include "motions/tracer.hpp"
#include "reduction/reduced_rest.hpp"
#include "space/rest.hpp"
#include <algorithm>
#include <cmath>

namespace plm {

namespace {

class ModePath final : public Tracer {
  public:
    ModePath(const std::shared_ptr<Branch> &found, const NonlinearModeOptions &options, Watch watch)
        : Tracer("nonlinear mode", watch, *found), m_(found->reduced_model()), options_(options),
          found_(found), coupling_(coupling_at_rest(*m_)) {
        HbmOptions &o = options_.hbm;
        o.unknowns = NonlinearUnknowns::modal;
        o.period_multiple = 1;
        o.force_scale = 0;
    }

    NonlinearMode run() {
        find_mode();
        const std::int64_t asked = options_.hbm.n_harmonics;
        if (asked > 0) return follow(asked);
        for (std::int64_t h = std::min<std::int64_t>(7, options_.hbm.max_harmonics);;
             h = std::min(2 * h, options_.hbm.max_harmonics)) {
            NonlinearMode found = follow(h);
            if (largest_tail_ <= options_.hbm.allowed_harmonic_error()) return found;
            if (h < options_.hbm.max_harmonics) continue;
            warn_of_tail(*found.branch);
            return found;
        }
    }

    void record(const PathPoint &p) override {
        if (reached_) return; // the step that passed the end
        reached_ = p.bifurcation == reached;
        BranchPoint point = solved_point(*system_, p);
        point.bifurcation = bifurcation::none;
        point.harmonic_tail = harmonic_content(*m_, point, 1).tail;
        largest_tail_ = std::max(largest_tail_, point.harmonic_tail);
        result_.amplitude.push_back(std::exp(p.parameter));
        result_.measures.push_back(measure_motion(*m_, point));
        branch_.append(std::move(point));
    }
    // The path ends at the located point at which the DOF moves as asked.
    vector<std::int32_t> test_kinds() const override {
        return ends_by_dof() ? vector<std::int32_t>{reached} : vector<std::int32_t>();
    }
    void test(const vector<double> &y, double log_amplitude, vector<double> &values) override {
        if (!ends_by_dof()) return;
        BranchPoint point;
        system_->to_point(y.data(), log_amplitude, point);
        Branch alone(m_, 0.0);
        alone.append(std::move(point));
        values = {alone.amplitude(0, options_.dof, Measure::harmonic, 1) / options_.dof_amplitude_max - 1};
    }
    bool interrupt() override { return reached_; }

  private:
    static constexpr std::int32_t reached = -1; // kind of the test function, as bifurcations have theirs

    void warn_of_tail(Branch &branch) const {
        const auto &points = branch.points();
        std::size_t over = 0, worst = 0;
        for (std::size_t i = 0; i < points.size(); ++i) {
            if (points[i].harmonic_tail > points[worst].harmonic_tail) worst = i;
            over += points[i].harmonic_tail > options_.hbm.allowed_harmonic_error();
        }
        watch_.keeping(branch.warnings)
            .warn(reason::harmonics_too_few,
                  format("harmonic_tolerance (%.2g) was not reached at %zu of %zu points of the nonlinear "
                         "mode: at point %zu (%.6g Hz) the next harmonics have a share of %.2g in the "
                         "motion of the gaps. Raise max_harmonics (%lld) or, if that is accurate enough, "
                         "harmonic_tolerance; or end at a smaller amplitude (amplitude_max)",
                         options_.hbm.allowed_harmonic_error(), over, points.size(), worst,
                         points[worst].omega / (2 * M_PI), points[worst].harmonic_tail,
                         static_cast<long long>(options_.hbm.max_harmonics)));
    }

    bool ends_by_dof() const { return options_.dof >= 0 && options_.dof_amplitude_max > 0; }

    NonlinearMode follow(std::int64_t n_harmonics) {
        options_.hbm.n_harmonics = n_harmonics;
        inner_ = make_system(m_, options_.hbm);
        result_ = NonlinearMode();
        result_.branch = found_;
        branch_ = Branch(m_, 0.0);
        branch_.is_mode = true;
        largest_tail_ = 0;
        reached_ = false;
        find_amplitudes();
        system_ = std::make_unique<NonlinearModeSystem>(*inner_, *m_, shape_, omega_, options_.amplitude_max);
        const PathStart from = start();
        PathOptions range =
            path_options(options_.hbm, std::log(options_.amplitude_min), std::log(options_.amplitude_max));
        range.upward = true;
        constexpr double longest_of_mode = 0.05; // internal resonances take up little of the range
        range.max_step = std::min(longest_of_mode, options_.hbm.max_step);
        range.locate = true;
        Tracer::follow(*system_, range, from);
        if (branch_.end_reason == reason::none) branch_.end_reason = reason::range_end;
        branch_.unknowns_used = "modal";
        return std::move(result_);
    }

    // The mode about rest with the number asked for, or the nearest to the frequency asked for.
    void find_mode() {
        const SpaceModes modes = modes_at_rest(*m_, coupling_);
        const std::int64_t best = choose_mode(modes.values);
        omega_ = std::sqrt(modes.values[best]);
        shape_.assign(modes.vectors.col(best), modes.vectors.col(best) + m_->size());
    }

    std::int64_t choose_mode(const vector<double> &squares) const {
        std::int64_t elastic = 0, best = -1;
        for (std::size_t j = 0; j < squares.size(); ++j) {
            if (!(squares[j] > 0)) continue; // rigid-body motion
            const std::int64_t column = static_cast<std::int64_t>(j);
            if (++elastic == options_.mode) return column;
            const auto away = [&](std::int64_t i) {
                return std::abs(std::sqrt(squares[i]) - 2 * M_PI * options_.frequency_hz);
            };
            if (options_.mode == 0 && (best < 0 || away(column) < away(best))) best = column;
        }
        if (best < 0)
            throw Error(status::argument,
                        format("the basis has %lld elastic modes about the structure at rest",
                               static_cast<long long>(elastic)))
                .argument("mode");
        return best;
    }

    // Amplitude of the mode at which the first pair changes its state; 0: none does, or at any amplitude.
    double first_change() const {
        vector<double> x(inner_->size());
        inner_->linear_response(coupling_, omega_, x.data());
        const ReducedModel &m = *m_;
        vector<double> rest = m.contact.unloaded_penetration(), swing(m.n_pairs(), 0.0);
        for (std::int64_t i = 0; i < m.n_pairs(); ++i) {
            for (std::int64_t j = 0; j < m.static_size(); ++j) rest[i] += m.gap_0(i, j) * x[j];
            for (std::int64_t j = 0; j < m.size(); ++j) swing[i] += m.gap(i, j) * shape_[j];
        }
        return amplitude_of_first_switch(rest, swing, coupling_);
    }

    void find_amplitudes() {
        constexpr double still_linear = 0.5; // of the first change
        constexpr double below = 0.1,
                         far_below = 0.01; // of the amplitude asked for: the mode begins well before it
        constexpr double far_beyond = 100,
                         out_of_reach = 1000; // of the first change, of the amplitude asked for
        if (options_.amplitude_min > 0 && options_.amplitude_max > options_.amplitude_min) return;
        const double first = first_change(), asked = asked_amplitude();
        if (first == 0 && asked == 0)
            throw Error(
                status::argument,
                "no pair changes its state at a certain amplitude (neither pre-load nor gap): say up to "
                "which amplitude to go")
                .argument("amplitude_max");
        double low = first > 0 ? still_linear * first : far_below * asked;
        if (asked > 0) low = std::min(low, below * asked);
        options_.amplitude_min = low;
        options_.amplitude_max =
            asked > 0 ? out_of_reach * std::max(asked, first) : far_beyond * first; // interrupt() ends it
    }

    // The amplitude of the mode that moves the DOF as asked; 0: not asked.
    double asked_amplitude() const {
        if (options_.dof < 0 || !(options_.dof_amplitude_max > 0)) return 0;
        const Field mode = combine(m_->vectors, shape_);
        const double swing = mode.at(m_->model->terms(options_.dof)), most = largest_entry(mode).size;
        constexpr double moves = 1e-6; // of the largest displacement: below, it is rounding of the mode
        if (!(std::abs(swing) > moves * most))
            throw Error(status::argument, "this mode does not move the DOF; name one that it moves")
                .argument("dof");
        return options_.dof_amplitude_max / std::abs(swing);
    }

    PathStart start() {
        vector<double> x(inner_->size());
        inner_->linear_response(coupling_, omega_, x.data());
        std::fill(x.begin() + m_->static_size(), x.end(), 0.0);
        for (std::int64_t j = 0; j < m_->size(); ++j)
            x[m_->static_size() + j] = options_.amplitude_min * shape_[j];
        BranchPoint guess;
        inner_->to_point(x.data(), omega_, guess);
        PathStart from;
        from.at = {unknowns_of(*system_, guess), std::log(options_.amplitude_min)};
        NewtonLimits limits = newton_limits(options_.hbm);
        limits.max_iterations = std::max<std::int64_t>(100, limits.max_iterations);
        const NewtonOutcome out = newton_at(*system_, limits, from.at.x, from.at.parameter);
        if (!out.converged)
            throw Error(
                status::convergence,
                format("no periodic motion was found at the smallest amplitude, %g", options_.amplitude_min))
                .reason(reason::start_failed);
        from.residual = out.residual;
        return from;
    }

    std::shared_ptr<const ReducedModel> m_;
    NonlinearModeOptions options_;
    std::shared_ptr<Branch> found_;
    vector<double> coupling_, shape_;
    double omega_ = 0;
    std::unique_ptr<HbmSystem> inner_;
    std::unique_ptr<NonlinearModeSystem> system_;
    NonlinearMode result_;
    double largest_tail_ = 0;
    bool reached_ = false;
};

} // namespace

NonlinearMode follow_nonlinear_mode(std::shared_ptr<const ReducedModel> reduced,
                                    const NonlinearModeOptions &options, Watch watch) {
    return ModePath(std::make_shared<Branch>(std::move(reduced), 0.0), options, watch).run();
}

} // namespace plm
