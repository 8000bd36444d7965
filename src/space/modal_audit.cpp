#include "space/modal_audit.hpp"
#include <algorithm>
#include <cmath>
#include <complex>

namespace plm {
namespace {

using Complex = std::complex<double>;
using Response = vector<Complex>; // penetration per pair

constexpr std::int64_t n_elastic = 10; // elastic modes looked at

/// A harmonic of the excitation: its modal forces, and what the modes beyond the lowest answer at the pairs.
struct Drive {
    LoadPart part{1};
    double still = 0; // largest displacement under the same force at rest
    Response force, residual;
};

class ModalAudit {
  public:
    explicit ModalAudit(const Model &model)
        : m_(model), rigid_(model.n_rigid()),
          modes_(model.lowest_modes(std::min(rigid_ + n_elastic, model.n_free()))),
          n_(static_cast<std::int64_t>(modes_.values.size())), gap_(m_.gap_rows().of(modes_.vectors)) {}

    std::vector<Finding> run() {
        if (n_ <= rigid_) return findings_;
        lowest_frequency();
        damping_ = modal_damping();
        for (const auto &[part, load] : m_.excitation())
            if (part.harmonic > 0 && std::hypot(column_norms(load.real)[0], column_norms(load.imag)[0]) > 0)
                drives_.push_back(drive_of(part, load));
        if (drives_.empty()) return findings_;
        driven_modes();
        if (m_.n_pairs() > 0) motion_within_gaps();
        return findings_;
    }

  private:
    void add(int severity, double value, std::string text) {
        findings_.push_back({severity, value, std::move(text)});
    }

    double omega(std::int64_t j) const { return std::sqrt(std::max(0.0, modes_.values[j])); }
    double hz(std::int64_t j) const { return omega(j) / (2 * M_PI); }

    void lowest_frequency() {
        add(0, hz(rigid_), format("lowest elastic frequency of the open structure: %.6g Hz", hz(rigid_)));
    }

    // Viscous, of every mode: phi^T C phi.
    vector<double> modal_damping() const {
        const Damping &d = m_.damping();
        vector<double> c(n_);
        if (d.has_matrix) c = column_products(modes_.vectors, m_.damping_times(modes_.vectors));
        const std::int64_t last = static_cast<std::int64_t>(d.modal_ratio.size()) - 1;
        for (std::int64_t j = 0; j < n_; ++j) {
            c[j] += d.alpha + d.beta * modes_.values[j];
            if (last >= 0) c[j] += 2 * d.modal_ratio[std::min(j, last)] * omega(j);
        }
        return c;
    }

    // Complex stiffness of mode j at a frequency (rad/s).
    Complex stiffness(std::int64_t j, double at) const {
        return {modes_.values[j] - at * at, at * damping_[j] + m_.damping().structural * modes_.values[j]};
    }

    static Response joined(const vector<double> &real, const vector<double> &imag) {
        Response z(real.size());
        for (std::size_t i = 0; i < real.size(); ++i) z[i] = {real[i], imag[i]};
        return z;
    }

    Drive drive_of(const LoadPart &part, const HarmonicForce &load) const {
        Drive d;
        d.part = part;
        d.still = std::hypot(elastic_deflection(load.real), elastic_deflection(load.imag));
        d.force = joined(projected(modes_.vectors, load.real), projected(modes_.vectors, load.imag));
        if (m_.n_pairs() == 0) return d;
        d.residual = joined(m_.static_gaps(load.real), m_.static_gaps(load.imag));
        for (std::int64_t j = 0; j < n_; ++j)
            for (std::int64_t row = 0; row < gap_.rows(); ++row)
                d.residual[row] -= gap_(row, j) * d.force[j] / (modes_.values[j] + m_.shift());
        return d;
    }

    // A resonance that the excitation drives stands above its static deflection, or it is none to look at.
    void driven_modes() {
        constexpr double seen = 0.01;
        double most = 0, share = 0;
        std::int64_t best = rigid_;
        for (std::int64_t j = rigid_; j < n_; ++j) {
            const double reach = resonant_deflection(j), still = static_deflection(j);
            if (reach > most) most = reach, best = j;
            share = std::max(share, still > 0 ? reach / still : seen);
        }
        if (share < seen)
            add(1, share,
                format("the excitation moves none of the %lld lowest elastic modes, %.6g to %.6g Hz: at "
                       "resonance the largest moves %.2g as far as the same force at rest. It acts on DOFs, "
                       "or in a direction, that these modes leave still: move it",
                       static_cast<long long>(n_ - rigid_), hz(rigid_), hz(n_ - 1), share));
        else
            add(0, hz(best),
                format("of the %lld lowest elastic modes of the open structure the excitation moves the one "
                       "at %.6g Hz most",
                       static_cast<long long>(n_ - rigid_), hz(best)));
    }

    // Of a force at the resonance of mode j.
    double growth(const Drive &d, std::int64_t j) const { return d.part.growth(omega(j) / d.part.harmonic); }

    double resonant_deflection(std::int64_t j) const {
        constexpr double undamped = 1e-4; // of the stiffness: where nothing damps
        const double lost = std::max(std::abs(stiffness(j, omega(j)).imag()), undamped * modes_.values[j]);
        double force = 0;
        for (const Drive &d : drives_) force = std::hypot(force, growth(d, j) * std::abs(d.force[j]));
        return force / lost * largest_entry(modes_.vectors.columns(j, 1)).size;
    }

    double static_deflection(std::int64_t j) const {
        double size = 0;
        for (const Drive &d : drives_) size = std::hypot(size, growth(d, j) * d.still);
        return size;
    }

    // What rigid-body motion takes away of the force strains nothing.
    double elastic_deflection(Field force) const {
        const Field &rigid = m_.rigid_modes();
        if (rigid_ > 0) add_combination(-1, m_.mass_times(rigid), projected(rigid, force), force);
        m_.solve(force);
        return largest_entry(force).size;
    }

    // Of the linear response at every resonance of the open structure: while nothing touches it is the
    // answer.
    void motion_within_gaps() {
        const vector<double> gap = gap_at_rest();
        if (gap.empty() || *std::min_element(gap.begin(), gap.end()) <= 0) return;
        double most = 0, where = 0;
        std::int64_t pair = 0;
        for (std::int64_t j = rigid_; j < n_; ++j)
            for (const Drive &d : drives_) {
                const double base = omega(j) / d.part.harmonic;
                const vector<double> amplitude = penetration_at(base);
                for (std::int64_t i = 0; i < m_.n_pairs(); ++i) {
                    if (std::isnan(amplitude[i])) return; // a mode that nothing drives, nor damps
                    const double share = amplitude[i] / gap[i];
                    if (share > most) most = share, where = base / (2 * M_PI), pair = i;
                }
            }
        constexpr double nearly = 0.9; // the peak of a damped response lies beside the frequency of its mode
        if (most >= nearly) return;
        add(1, most,
            format(
                "no gap closes under the excitation as it is: the linear response takes up %.2g of its gap "
                "at most, at pair %lld near %.6g Hz, so that nothing touches. Check the units of gaps and "
                "excitation, and where it acts, or scale it (force_scale of the hbm)",
                most, static_cast<long long>(pair), where));
    }

    // Without contact: initial gaps less what static loads take; empty where rigid-body modes leave it open.
    vector<double> gap_at_rest() const {
        vector<double> gap = m_.initial_gap();
        const auto take_off = [&](const Field &load) {
            const vector<double> u = m_.static_gaps(load);
            for (std::int64_t i = 0; i < m_.n_pairs(); ++i) gap[i] -= u[Contact::normal_row(i)];
        };
        const auto still = m_.excitation().find(0); // what grows with the frequency is none at rest
        const bool loaded = m_.has_preload() || still != m_.excitation().end();
        if (loaded && rigid_ > 0) return {};
        if (m_.has_preload()) take_off(m_.preload());
        if (still != m_.excitation().end()) take_off(still->second.real);
        return gap;
    }

    // Largest possible penetration of the motion about rest: the harmonics' amplitudes, added up.
    vector<double> penetration_at(double base) const {
        vector<double> amplitude(static_cast<std::size_t>(m_.n_pairs()), 0.0);
        for (const Drive &d : drives_)
            for (std::int64_t i = 0; i < m_.n_pairs(); ++i) {
                const std::int64_t row = Contact::normal_row(i);
                Complex u = d.residual[row];
                for (std::int64_t j = 0; j < n_; ++j) {
                    const Complex k = stiffness(j, d.part.harmonic * base);
                    if (gap_(row, j) != 0 && d.force[j] != 0.0) u += gap_(row, j) * d.force[j] / k;
                }
                amplitude[i] += d.part.growth(base) * std::abs(u);
            }
        for (const auto &[part, gaps] : m_.contact().motion)
            for (std::int64_t i = 0; part.harmonic > 0 && i < m_.n_pairs(); ++i)
                amplitude[i] += part.growth(base) * std::abs(Contact::moved(gaps, i));
        return amplitude;
    }

    const Model &m_;
    std::int64_t rigid_;
    StructureModes modes_;
    std::int64_t n_;
    Matrix gap_; // of the modes, a row for each direction of each pair
    vector<double> damping_;
    std::vector<Drive> drives_;
    std::vector<Finding> findings_;
};

} // namespace

std::vector<Finding> modal_audit(const Model &model) {
    return ModalAudit(model).run();
}

} // namespace plm
