#include "reduction/equivalent_motion.hpp"
#include "contact/describing_function.hpp"
#include "sampling/mode_clusters.hpp"
#include "sampling/mode_match.hpp"
#include "space/linear_contact.hpp"
#include "space/rest.hpp"
#include "structure/driven_harmonic.hpp"
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace plm {
namespace {

constexpr std::int64_t most_iterations = 200;
constexpr double settled_change = 1e-6; // of the largest coupling, which is tiny where contact is stiff

// Static equilibrium of the mean displacement while every pair oscillates with its amplitude: the minimum of
// a convex, smooth energy, by Newton's method.
class MeanEquilibrium {
  public:
    /// omega: of the excitation, whose constant part may grow with it.
    MeanEquilibrium(const Space &space, double omega)
        : space_(space), pivot_(held_pivots(space.lambda)), load_(space.preload),
          mean_(rest_of(space)->coordinates) {
        // Rigid-body motion that nothing holds drifts until contact is lost; the pivots let it end.
        load_.resize(space.size(), 0.0);
        const HarmonicLoad constant = load_at(space.excitation, 0, omega);
        for (std::size_t j = 0; j < constant.real.size(); ++j) load_[j] += constant.real[j];
    }

    vector<double> penetration() const { return penetration_at(mean_); }

    void solve(const vector<double> &amplitude) {
        const vector<double> &k = space_.model->contact_stiffness();
        for (int step = 0; step < 50; ++step) {
            const vector<double> u = penetration();
            vector<double> d = gradient(mean_, amplitude), tangent(u.size());
            for (std::size_t p = 0; p < u.size(); ++p) tangent[p] = mean_tangent(k[p], u[p], amplitude[p]);
            for (double &v : d) v = -v;
            solve_with_springs(pivot_, space_.gap, tangent, d);
            const double t = step_length(d, amplitude);
            for (std::size_t j = 0; j < d.size(); ++j) mean_[j] += t * d[j];
            const std::int64_t n = space_.size();
            if (t * norm2(n, d.data()) <= 1e-10 * norm2(n, mean_.data())) return;
        }
    }

  private:
    vector<double> penetration_at(const vector<double> &eta) const {
        vector<double> u = space_.model->contact().unloaded_penetration();
        gemv('N', 1.0, space_.gap, eta.data(), 1.0, u.data());
        return u;
    }

    vector<double> gradient(const vector<double> &eta, const vector<double> &amplitude) const {
        vector<double> g(eta.size()), force = penetration_at(eta);
        for (std::size_t j = 0; j < g.size(); ++j) g[j] = pivot_[j] * eta[j] - load_[j];
        for (std::size_t p = 0; p < force.size(); ++p)
            force[p] = force_coefficient(space_.model->contact_stiffness()[p], force[p], amplitude[p], 0);
        gemv('T', 1.0, space_.gap, force.data(), 1.0, g.data());
        return g;
    }

    // Where the slope along d, which increases, has lost most of what it was.
    double step_length(const vector<double> &d, const vector<double> &amplitude) const {
        const auto slope = [&](double t) {
            vector<double> eta(mean_);
            for (std::size_t j = 0; j < d.size(); ++j) eta[j] += t * d[j];
            return dot(space_.size(), d.data(), gradient(eta, amplitude).data());
        };
        const double first = std::abs(slope(0));
        double low = 0, high = 0, t = 1;
        for (int k = 0; k < 60; ++k) {
            const double s = slope(t);
            if (std::abs(s) <= 0.5 * first) return t;
            (s < 0 ? low : high) = t;
            t = high > 0 ? 0.5 * (low + high) : 2 * t;
        }
        return t;
    }

    const Space &space_;
    vector<double> pivot_, load_, mean_;
};

// What the structure's damping and the excitation make of a mode.
class Resonance {
  public:
    explicit Resonance(const Space &space)
        : space_(space), drive_(drive_of(space)), driven_(driven_harmonic(drive_)) {}

    bool excited() const { return driven_ > 0; }
    int harmonic() const { return std::max(1, driven_); }

    // At omega, a frequency of the motion.
    double force(const double *mode, double omega) const {
        if (!excited()) return 0;
        const HarmonicLoad load = load_at(drive_, driven_, omega / driven_);
        const auto part = [&](const vector<double> &f) {
            return f.empty() ? 0.0 : dot(space_.size(), mode, f.data());
        };
        return std::hypot(part(load.real), part(load.imag));
    }

    // omega times the modal damping, structural damping of K included.
    double damping_force(const double *mode, double omega) const {
        const std::int64_t m = space_.size();
        double viscous = 0, stiffness = 0;
        for (std::int64_t j = 0; j < m; ++j) {
            stiffness += space_.lambda[j] * mode[j] * mode[j];
            if (space_.damping.empty()) viscous += space_.damping_diagonal[j] * mode[j] * mode[j];
        }
        if (!space_.damping.empty()) {
            vector<double> c(m, 0.0);
            gemv('N', 1.0, space_.damping, mode, 0.0, c.data());
            viscous = dot(m, mode, c.data());
        }
        return omega * viscous + space_.model->damping().structural * stiffness;
    }

    // Modal amplitude at the excitation frequency `omega`, up to a common factor where nothing excites.
    double response(const double *mode, double eigenvalue, double omega) const {
        const double f = excited() ? force(mode, omega) : 1;
        return f / std::hypot(eigenvalue - omega * omega, damping_force(mode, omega));
    }

  private:
    const Space &space_;
    const HarmonicLoads drive_;
    const int driven_; // harmonic; 0: none
};

class Iteration {
  public:
    Iteration(const Space &space, const EquivalentMotionOptions &options)
        : space_(space), options_(options), resonance_(space), equilibrium_(space, options.middle) {
        motion_.coupling.assign(space.n_pairs(), 0.5); // the limit of large amplitudes
        motion_.mean = equilibrium_.penetration();
        motion_.amplitude.assign(space.n_pairs(), 0.0);
        set_springs();
        if (options.amplitude == 0 && !resonance_.excited())
            throw Error(status::argument, "without an excitation equivalent_amplitude must say how large the "
                                          "motion is that the contact is linearised about")
                .argument("equivalent_amplitude");
    }

    EquivalentMotion run(Watch watch) {
        for (motion_.iterations = 1; motion_.iterations <= most_iterations; ++motion_.iterations) {
            watch.step("equivalent motion",
                       static_cast<double>(motion_.iterations) / static_cast<double>(most_iterations));
            vector<double> change = update();
            double largest = 0, most = 0;
            for (std::size_t p = 0; p < change.size(); ++p) {
                largest = std::max({largest, change[p], motion_.coupling[p]});
                change[p] -= motion_.coupling[p];
                most = std::max(most, std::abs(change[p]));
            }
            motion_.settled = most <= settled_change * largest;
            const double relaxation = motion_.settled ? 1 : relaxation_for(change);
            for (std::size_t p = 0; p < change.size(); ++p)
                motion_.coupling[p] =
                    std::min(1.0, std::max(0.0, motion_.coupling[p] + relaxation * change[p]));
            set_springs();
            if (motion_.settled) break;
            before_ = std::move(change);
        }
        return std::move(motion_);
    }

  private:
    // Aitken's: the secant along the last change (Irons and Tuck 1969).
    double relaxation_for(const vector<double> &change) {
        if (before_.empty()) return relaxation_;
        double along = 0, squared = 0;
        for (std::size_t p = 0; p < change.size(); ++p) {
            along += before_[p] * (change[p] - before_[p]);
            squared += (change[p] - before_[p]) * (change[p] - before_[p]);
        }
        const double secant = squared > 0 ? -relaxation_ * along / squared : 1;
        relaxation_ = std::min(1.0, std::max(0.05, secant));
        return relaxation_;
    }

    void set_springs() {
        motion_.spring = space_.model->contact_stiffness();
        for (std::size_t p = 0; p < motion_.spring.size(); ++p) motion_.spring[p] *= motion_.coupling[p];
    }

    // The couplings that the motion of the present system asks for.
    vector<double> update() {
        const SpaceModes modes = lowest_modes();
        const std::int64_t leading = leading_mode(modes);
        shape_.assign(modes.vectors.col(leading), modes.vectors.col(leading) + space_.size());
        motion_.frequency = std::sqrt(std::max(0.0, modes.values[leading]));
        gemv('N', 1.0, space_.gap, shape_.data(), 0.0, motion_.amplitude.data());
        const double factor = modal_amplitude();
        for (double &a : motion_.amplitude) a *= factor;
        equilibrium_.solve(motion_.amplitude);
        motion_.mean = equilibrium_.penetration();
        const vector<double> &k = space_.model->contact_stiffness();
        vector<double> wanted(motion_.coupling.size());
        for (std::size_t p = 0; p < wanted.size(); ++p)
            wanted[p] = equivalent_stiffness(k[p], motion_.mean[p], motion_.amplitude[p]) / k[p];
        return wanted;
    }

    SpaceModes lowest_modes() const {
        SpaceModes modes = modes_with_springs(space_.lambda, space_.n_massless, space_.gap, motion_.spring,
                                              options_.highest_eigenvalue);
        if (modes.values.empty() || !(modes.values.back() > 0))
            modes = modes_with_springs(space_.lambda, space_.n_massless, space_.gap, motion_.spring,
                                       std::numeric_limits<double>::infinity());
        const Matrix seen = shape_.empty() ? driving_loads(space_).rows : row_of(space_, shape_);
        align_clusters({&seen}, modes);
        return modes;
    }

    // First by its response, then by its likeness with the last one. Rigid-body motion has no resonance.
    std::int64_t leading_mode(const SpaceModes &modes) const {
        const double omega = options_.middle * resonance_.harmonic();
        std::int64_t best = -1;
        double most = -1;
        for (std::int64_t j = 0; j < modes.vectors.cols(); ++j) {
            if (!(modes.values[j] > 0)) continue;
            const double *mode = modes.vectors.col(j);
            const double value = shape_.empty() ? resonance_.response(mode, modes.values[j], omega)
                                                : mac(space_.n_massive(), mode, shape_.data());
            if (value > most) most = value, best = j;
        }
        if (best < 0)
            throw Error(status::argument, "the equivalent system has no resonance below the limit; raise "
                                          "frequency_max_hz or below_factor")
                .argument("frequency_max_hz")
                .reason(reason::basis_too_small);
        return best;
    }

    double modal_amplitude() const {
        if (options_.amplitude > 0) {
            double largest = 0;
            for (double a : motion_.amplitude) largest = std::max(largest, std::abs(a));
            return largest > 0 ? options_.amplitude / largest : 0;
        }
        const double damping = resonance_.damping_force(shape_.data(), motion_.frequency);
        if (!(damping > 0))
            throw Error(status::argument,
                        "without damping nothing bounds the resonance; equivalent_amplitude "
                        "must say how large the motion is")
                .argument("equivalent_amplitude");
        return resonance_.force(shape_.data(), motion_.frequency) / damping;
    }

    const Space &space_;
    EquivalentMotionOptions options_;
    Resonance resonance_;
    MeanEquilibrium equilibrium_;
    EquivalentMotion motion_;
    vector<double> shape_, before_; // last mode, last change of the couplings
    double relaxation_ = 1;
};

} // namespace

EquivalentMotion equivalent_motion(const Space &space, const EquivalentMotionOptions &options, Watch watch) {
    return Iteration(space, options).run(watch);
}

} // namespace plm
