#include "hbm/start.hpp"
#include "hbm/formulation.hpp"
#include "hbm/make_system.hpp"
#include "hbm/wrapped_system.hpp"
#include "motions/branch_path.hpp"
#include "motions/penetration.hpp"
#include "paths/quiet_owner.hpp"
#include "reduction/reduced_rest.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

// Of a step along a path: a tenth of a second, of which a path may take a thousand. Every pair that switches
// makes a corner.
constexpr double dear_on_paths = 5e8; // flops
constexpr std::int64_t many_corners = 100;

// Another parameter in the place of the frequency: the force, p = 0 at rest; the gap, p = 0 with contact out
// of reach; the logarithm of the contact stiffness, p = 0 with soft contact. p = 1 is the problem asked for.
class StartPath final : public WrappedSystem {
  public:
    enum class Kind { force, gap, stiffness };
    StartPath(HbmSystem &inner, Kind kind, double omega, double full)
        : WrappedSystem(inner), kind_(kind), omega_(omega), full_(full) {}
    void residual(const double *x, double p, double *r) override {
        if (kind_ == Kind::force) {
            inner_.set_force_scale(p * full_);
        } else if (kind_ == Kind::gap) {
            inner_.set_extra_gap((1 - p) * full_);
        } else {
            inner_.set_stiffness_factor(std::exp((1 - p) * full_));
        }
        inner_.residual(x, omega_, r);
    }
    void parameter_derivative(double *r) override {
        if (kind_ == Kind::force) {
            inner_.force_derivative(r);
        } else if (kind_ == Kind::gap) {
            inner_.gap_derivative(r);
        } else {
            inner_.stiffness_derivative(r);
        }
        const double factor = kind_ == Kind::force ? full_ : -full_;
        for (std::int64_t i = 0; i < size(); ++i) r[i] *= factor;
    }
    void linear_response(const vector<double> &coupling, double, double *x) override {
        inner_.linear_response(coupling, omega_, x);
    }
    void to_point(const double *x, double, BranchPoint &point) override { inner_.to_point(x, omega_, point); }

  private:
    Kind kind_;
    double omega_, full_;
};

class Starter {
  public:
    Starter(HbmSystem &system, const ReducedModel &reduced, const HbmOptions &options, double omega,
            Watch watch, vector<double> &x)
        : watch_(watch), quiet_(watch), system_(system), reduced_(reduced), options_(options), omega_(omega),
          coupling_(coupling_at_rest(reduced)), x_(x) {
        x_.resize(system.size());
        for (double coupling : coupling_) loaded_ = loaded_ || coupling == 1;
    }

    StartOutcome run(bool have_guess, StartPaths paths) {
        if (paths == StartPaths::affordable) {
            if ((have_guess && attempt()) || from_linear_responses()) return out_;
            if (!affords_paths(reduced_, options_)) {
                damping_steps();
                return out_;
            }
        }
        if (loaded_ ? force_path() : gap_path()) return out_;
        if (stiffness_path()) return out_;
        frequency_path();
        return out_;
    }

  private:
    bool attempt() {
        out_.add(correct_at(system_, options_, omega_, watch_, x_));
        return out_.converged;
    }

    bool from_linear(const vector<double> &coupling) { return from_linear_guess(coupling) && attempt(); }

    bool from_linear_responses() {
        for (const vector<double> &coupling :
             {coupling_, vector<double>(coupling_.size(), 0.0), vector<double>(coupling_.size(), 1.0)})
            if (from_linear(coupling)) return true;
        return false;
    }

    bool from_linear_guess(const vector<double> &coupling) {
        try {
            system_.linear_response(coupling, omega_, x_.data());
        } catch (
            const Error &e) { // a coupling without a static solution, e.g. open contact and rigid-body modes
            if (e.status() != status::singular) throw;
            return false;
        }
        return true;
    }

    PathOptions path_options(double low, double high) const {
        PathOptions path;
        path.low = low;
        path.high = high;
        constexpr double on_the_way = 1e-6; // the end of the path is corrected to the tolerance asked for
        path.tolerance = std::max(options_.tolerance, on_the_way);
        path.max_points = 1000; // a path that needs more leads nowhere
        return path;
    }

    // From rest (unique) along the force, through folds, to the force asked for.
    bool force_path() {
        system_.set_force_scale(0);
        system_.linear_response(coupling_, omega_, x_.data());
        StartPath path(system_, StartPath::Kind::force, omega_, options_.force_scale);
        const bool found = follow(path);
        system_.set_force_scale(options_.force_scale);
        return found && attempt();
    }

    // Without pre-load the force changes nothing but the size; from the linear response with contact out of
    // reach the gap is closed instead.
    bool gap_path() {
        const vector<double> apart(coupling_.size(), 0.0);
        if (!from_linear_guess(apart)) return false;
        BranchPoint point;
        system_.to_point(x_.data(), omega_,
                         point); // what the unknowns are differs; the gaps follow from the point
        double reach = 0;
        const Matrix u = penetration_of(reduced_, point, point.eta.cols() / 2);
        for (std::int64_t i = 0; i < u.rows(); ++i) {
            double sum = 0;
            for (std::int64_t c = 1; c < u.cols(); ++c) sum += std::abs(u(i, c));
            reach = std::max(reach, sum);
        }
        reach *= 1.01; // clear of it
        system_.set_extra_gap(reach);
        system_.linear_response(apart, omega_, x_.data());
        StartPath path(system_, StartPath::Kind::gap, omega_, reach);
        const bool found = follow(path);
        system_.set_extra_gap(0);
        return found && attempt();
    }

    // With much more damping the response is small and nearly linear, at a resonance of the open, of the
    // closed or of the breathing structure alike; the damping is taken away in steps as long as Newton's
    // method lets it, without following every corner on the way.
    void damping_steps() {
        constexpr double at_first = 0.3, least = 1e-5; // ratios at the frequency of the excitation
        constexpr double boldest = 0.1, too_careful = 0.97;
        system_.set_self_excitation(-at_first);
        bool found = false;
        for (double share : {0.0, 1.0}) found = found || from_linear(vector<double>(coupling_.size(), share));
        double damping = at_first, factor = 0.3;
        while (found && damping > 0 && factor < too_careful) {
            const double next = factor * damping < least ? 0 : factor * damping;
            system_.set_self_excitation(-next);
            const bool nearer = attempt();
            if (nearer) damping = next;
            factor = nearer ? std::max(boldest, factor * factor) : std::sqrt(factor);
        }
        system_.set_self_excitation(0);
        out_.converged = found && damping == 0;
    }

    // Soft contact has a solution near the linear ones; it is stiffened from there, through folds.
    bool stiffness_path() {
        const double local = local_stiffness(reduced_);
        double stiffest = 0;
        for (double k : reduced_.contact.stiffness) stiffest = std::max(stiffest, k);
        constexpr double stiffer = 0.5;  // contact that is hardly stiffer is no easier when softened
        for (double soft : {1.0, 0.1}) { // of the structure's own stiffness at the contact
            const double factor = soft * local / stiffest;
            if (!(factor > 0 && factor < stiffer)) continue;
            system_.set_stiffness_factor(factor);
            bool found = false;
            for (const vector<double> &coupling :
                 {coupling_, vector<double>(coupling_.size(), 0.0), vector<double>(coupling_.size(), 1.0)})
                found = found || from_linear(coupling);
            out_.converged = false;
            StartPath path(system_, StartPath::Kind::stiffness, omega_, std::log(factor));
            found = found && follow(path);
            system_.set_stiffness_factor(1);
            if (found && attempt()) return true;
        }
        return false;
    }

    bool follow(StartPath &path) {
        PathOptions range = path_options(0, 1);
        range.upward = true;
        return arrived(follow_path(path, range, {{x_, 0}}, quiet_), 1.0);
    }

    // From well above the resonances, where the response is nearly linear, down to the frequency asked for.
    bool frequency_path() {
        for (double far : {1.5, 3.0, 10.0}) { // farther is safer, but the way back is longer
            const PathOptions path = path_options(omega_, far * omega_);
            system_.linear_response(coupling_, far * omega_, x_.data());
            NewtonLimits limits;
            limits.max_iterations = options_.max_iterations;
            limits.parameter_scale = omega_;
            if (!newton_at(system_, limits, x_, far * omega_).converged) continue;
            if (arrived(follow_path(system_, path, {{x_, far * omega_}}, quiet_), omega_) && attempt())
                return true;
        }
        return false;
    }

    bool arrived(const PathOutcome &out, double parameter) {
        out_ += out.work;
        if (out.end_reason != reason::range_end || out.at.parameter != parameter) return false;
        x_ = out.at.x;
        return true;
    }

    Watch watch_;
    QuietOwner quiet_;
    HbmSystem &system_;
    const ReducedModel &reduced_;
    const HbmOptions &options_;
    double omega_;
    vector<double> coupling_;
    bool loaded_ = false; // some pair is closed at rest
    vector<double> &x_;
    StartOutcome out_;
};

} // namespace

bool affords_paths(const ReducedModel &reduced, const HbmOptions &options) {
    return reduced.n_pairs() < many_corners &&
           harmonic_step_flops(reduced, options.n_harmonics * options.period_multiple) < dear_on_paths;
}

void StartOutcome::add(const StartOutcome &next) {
    *this += next;
    residual = next.residual;
    converged = next.converged;
}

StartOutcome correct_at(HbmSystem &system, const HbmOptions &options, double omega, Watch watch,
                        vector<double> &x) {
    watch.step("start", 0.0);
    NewtonLimits limits = newton_limits(options);
    limits.parameter_scale = omega;
    vector<double> solution = x;
    const NewtonOutcome found = newton_at(system, limits, solution, omega);
    if (found.converged) x = solution;
    return {found, found.converged, found.residual};
}

StartOutcome find_start(HbmSystem &system, const ReducedModel &reduced, const HbmOptions &options,
                        double omega, bool have_guess, Watch watch, vector<double> &x, StartPaths paths) {
    return Starter(system, reduced, options, omega, watch, x).run(have_guess, paths);
}

} // namespace plm
