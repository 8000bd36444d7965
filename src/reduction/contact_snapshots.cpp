// A basis from statics: modes at rest, and what the contact forces of exact unilateral static solutions do to
// the structure.
//
// S is the system linearised about its contact status at rest; without pre-load
// and gap there are two, the open and the sliding one, and the columns of both are taken.
//  1. Static solutions: minima of the unilateral problem (solve_static) under pre-load + alpha omega_d^2 M v
//     for each dominant mode v with its own frequency omega_d; this load is K_d v with the stiffness of the
//     mode's own linear system. options.n_snapshots values of alpha, half of each sign, are spaced
//     geometrically from 0.3 to 30 times the median size of the sweep's thresholds (the alpha at which the
//     linear estimate switches a pair). Homogeneous problems have only the two of alpha = -1 and 1.
//     A snapshot is the solution less the position at rest, of mass norm 1.
//  2. Modes of S up to rest_factor f_f. One is left out when the snapshots' contact forces beyond those of S
//     and the excitation, at any harmonic 0..H in the window and with 1 % of critical damping, move it by
//     less than snapshot_tolerance of a snapshot, energies compared: modes of another symmetry, mostly.
//  3. Of the snapshots and of the static responses of S to their inertia at H f_f (one step of a Krylov
//     sequence, which stands for the modes above rest_factor f_f) what is not in these modes, by its
//     singular values in the energy norm lambda + (2 pi f_f)^2, down to snapshot_tolerance of the largest.
#include "linalg/lapack.hpp"
#include "linalg/work.hpp"
#include "reduction/basis_kind.hpp"
#include "reduction/mode_selection.hpp"
#include "sampling/dominant_mode.hpp"
#include "sampling/mode_clusters.hpp"
#include "sampling/sampler.hpp"
#include "space/linear_contact.hpp"
#include "space/rest.hpp"
#include <algorithm>
#include <cmath>
#include <utility>

namespace plm {
namespace {

// Measured on the cracked plate and the cylinders of examples/scenes: below 0.3 no pair leaves its status at
// rest, beyond 30 the contact area no longer moves.
constexpr double smallest_alpha = 0.3, largest_alpha = 30;
constexpr double damping = 0.02; // twice the share of critical damping at which a resonance is judged

void scale(Matrix &x, const vector<double> &weight, bool inverse) {
    for (std::int64_t k = 0; k < x.cols(); ++k)
        for (std::int64_t j = 0; j < x.rows(); ++j)
            x(j, k) = inverse ? x(j, k) / weight[j] : x(j, k) * weight[j];
}

Matrix momentum(const Space &space, Matrix x) {
    for (std::int64_t k = 0; k < x.cols(); ++k)
        for (std::int64_t j = space.n_massive(); j < space.size(); ++j) x(j, k) = 0;
    return x;
}

// modes: mass-orthonormal
void remove_span(const Space &space, const Matrix &modes, Matrix &x) {
    if (modes.cols() == 0 || x.cols() == 0) return;
    for (int pass = 0; pass < 2; ++pass) // twice is enough
        gemm('N', 'N', -1.0, modes, product('T', 'N', modes, momentum(space, x)), 1.0, x);
}

// A mass-orthonormal basis of the span; modes that contact does not touch are in both systems.
Matrix orthonormal(const Space &space, const Matrix &columns) {
    if (columns.cols() == 0) return columns;
    const Svd svd = thin_svd(momentum(space, columns));
    std::int64_t rank = 0;
    for (double s : svd.values)
        if (s > 1e-8 * svd.values[0]) ++rank;
    Matrix back = svd.vt.transposed().columns(0, rank); // columns times this: where there is no mass, too
    for (std::int64_t j = 0; j < rank; ++j)
        for (std::int64_t i = 0; i < back.rows(); ++i) back(i, j) /= svd.values[j];
    Matrix y = product('N', 'N', columns, back);
    for (std::int64_t j = 0; j < rank; ++j) std::copy_n(svd.u.col(j), space.n_massive(), y.col(j));
    return y;
}

vector<double> snapshot_alphas(const ContactSweep &sweep, bool homogeneous, std::int64_t n) {
    vector<double> alphas, size;
    if (homogeneous) return vector<double>{-1.0, 1.0};
    for (double t : sweep.thresholds) size.push_back(std::abs(t));
    if (size.empty()) return alphas; // the dominant mode does not move the contact
    std::nth_element(size.begin(), size.begin() + size.size() / 2, size.end());
    const double typical = size[size.size() / 2];
    for (int sign = 1; sign >= -1; sign -= 2) {
        const std::int64_t count = sign > 0 ? (n + 1) / 2 : n / 2;
        for (std::int64_t k = 0; k < count; ++k) {
            const double x = count > 1 ? static_cast<double>(k) / static_cast<double>(count - 1) : 0.5;
            alphas.push_back(sign * typical * smallest_alpha * std::pow(largest_alpha / smallest_alpha, x));
        }
    }
    return alphas;
}

// Static solutions less the position at rest, and the penetrations they change.
class Snapshots {
  public:
    Snapshots(const Space &space, const RestState &rest) : space_(space), rest_(rest) {}

    void add(const vector<double> &mode, double factor) {
        vector<double> load(space_.preload);
        load.resize(space_.size(), 0.0);
        for (std::int64_t j = 0; j < space_.size(); ++j) load[j] += factor * space_.mass(j) * mode[j];
        const Model &model = *space_.model;
        StaticState state;
        ++asked;
        worked(1e6 + 100.0 * static_cast<double>(space_.size() * space_.n_pairs())); // about a millisecond
        try {
            state = solve_static({space_.lambda, space_.gap, load, model.contact()});
        } catch (const Error &e) {
            if (e.status() != status::convergence) throw; // nothing holds the structure under this load
            return;
        }
        Matrix column(space_.size(), 1), u(space_.n_pairs(), 1);
        for (std::int64_t j = 0; j < column.rows(); ++j)
            column(j, 0) = state.coordinates[j] - rest_.coordinates[j];
        std::copy(state.penetration.begin(), state.penetration.end(), u.data());
        const double size = norm2(column.rows(), column.data());
        if (!(size > 0)) return;
        for (std::int64_t j = 0; j < column.rows(); ++j) column(j, 0) /= size;
        motions.append(column);
        penetrations.append(u);
        sizes.push_back(size);
    }

    /// G^T of the contact forces that the linear system with these springs does not have, per unit snapshot.
    Matrix forces_beyond(const vector<double> &springs) const {
        const Contact &contact = space_.model->contact();
        Matrix beyond(space_.n_pairs(), penetrations.cols());
        for (std::int64_t i = 0; i < beyond.rows(); ++i) {
            const double u0 = rest_.penetration[i];
            for (std::int64_t c = 0; c < beyond.cols(); ++c) {
                const double u = penetrations(i, c), linear = springs[i] * (u - u0);
                beyond(i, c) = (contact.force(i, u) - contact.force(i, u0) - linear) / sizes[c];
            }
        }
        return product('T', 'N', space_.gap, beyond);
    }

    Matrix motions;      // m x n, columns of norm 1
    Matrix penetrations; // Z x n
    vector<double> sizes;
    std::int64_t asked = 0;

  private:
    const Space &space_;
    const RestState &rest_;
};

// One linearised system S and what it contributes.
class RestSystem {
  public:
    RestSystem(const Space &space, const PairStates &states, const SelectionRule &rule)
        : space_(space), springs_(space.model->contact().springs(states)), omega_min_(2 * M_PI * rule.min_hz),
          omega_max_(2 * M_PI * rule.max_hz), n_harmonics_(rule.n_harmonics) {}

    /// Modes up to `highest` (rad/s) that the forces (m x n) move by more than the tolerance.
    Matrix modes(double highest, const Matrix &forces, double tolerance) const {
        SpaceModes all = modes_with_springs(space_.lambda, space_.n_massless, space_.gap, springs_,
                                            highest * highest * (1 + 1e-12));
        if (forces.cols() == 0) return all.vectors;
        const Matrix seen = forces.transposed();
        align_clusters({&seen}, all);
        const Matrix work = product('T', 'N', all.vectors, forces);
        Matrix kept;
        for (std::int64_t j = 0; j < all.vectors.cols(); ++j) {
            double largest = 0;
            for (std::int64_t k = 0; k < work.cols(); ++k) largest = std::max(largest, std::abs(work(j, k)));
            if (largest * receptance(all.values[j]) > tolerance) kept.append(all.vectors.columns(j, 1));
        }
        return kept;
    }

    /// (H omega_f)^2 K_S^-1 M x.
    Matrix inertia_response(const Matrix &motions) const {
        vector<double> pivot(space_.lambda);
        const double shift = 1e-4 * omega_min_ * omega_min_; // rigid-body motion is among the modes anyway
        for (std::int64_t j = 0; j < space_.size(); ++j) pivot[j] += shift * space_.mass(j);
        Matrix x = momentum(space_, motions);
        solve_with_springs(pivot, space_.gap, springs_, x);
        const double omega = static_cast<double>(n_harmonics_) * omega_max_;
        for (std::int64_t i = 0; i < x.rows() * x.cols(); ++i) x.data()[i] *= omega * omega;
        return x;
    }

    const vector<double> &springs() const { return springs_; }

  private:
    // Largest motion of a mode under a unit force at the harmonics of the window, times the root of its
    // energy over that of a unit motion at f_f.
    double receptance(double lambda) const {
        double largest = 0;
        const double omega = std::sqrt(lambda), floor = damping * std::max(lambda, omega_min_ * omega_min_);
        for (std::int64_t n = 0; n <= n_harmonics_; ++n) {
            const double h = static_cast<double>(n);
            const double nearest = std::min(std::max(omega, h * omega_min_), h * omega_max_);
            largest = std::max(largest, 1 / std::max(std::abs(lambda - nearest * nearest), floor));
        }
        return largest * std::sqrt(1 + lambda / (omega_max_ * omega_max_));
    }

    const Space &space_;
    vector<double> springs_;
    double omega_min_, omega_max_;
    std::int64_t n_harmonics_;
};

// The excitation, as large as moves the dominant mode by 1 in its resonance.
Matrix excitation_columns(const Space &space, const vector<double> &mode, double omega) {
    Matrix columns(space.size(), 0);
    const auto append = [&](const vector<double> &load) {
        if (load.empty()) return;
        const double size = norm2(space.size(), load.data());
        if (!(size > 0)) return;
        double work = std::abs(dot(space.size(), load.data(), mode.data()));
        if (!(work > 1e-6 * size)) work = size; // it does not drive this mode at all
        Matrix column(space.size(), 1);
        for (std::int64_t j = 0; j < space.size(); ++j)
            column(j, 0) = load[j] * damping * omega * omega / work;
        columns.append(column);
    };
    for (const auto &[part, load] : drive_of(space)) {
        if (part.harmonic == 0) continue;
        append(load.real);
        append(load.imag);
    }
    return columns;
}

// The main directions of x outside the modes in the energy norm.
Matrix main_directions(const Space &space, const Matrix &modes, Matrix x, double omega, double tolerance) {
    remove_span(space, modes, x);
    vector<double> weight;
    for (std::int64_t j = 0; j < space.size(); ++j)
        weight.push_back(std::sqrt(space.lambda[j] + space.mass(j) * omega * omega));
    scale(x, weight, false);
    const Svd svd = thin_svd(x);
    std::int64_t kept = 0;
    // what rounding leaves of snapshots that lie in the modes is no direction
    const double least = std::max(tolerance * (svd.values.empty() ? 0 : svd.values[0]), 1e-10 * omega);
    for (double s : svd.values)
        if (s > least) ++kept;
    Matrix y = svd.u.columns(0, kept);
    if (kept == 0) return y;
    scale(y, weight, true);
    return thin_svd(y).u;
}

std::vector<RestSystem> rest_systems(const Space &space, const RestState &rest, const SelectionRule &rule) {
    std::vector<RestSystem> systems;
    if (!is_homogeneous(*space.model)) {
        systems.emplace_back(space, rest.states, rule);
        return systems;
    }
    for (LinearSystem s : {LinearSystem::open, LinearSystem::sliding})
        systems.emplace_back(space, contact_set(s, space), rule);
    return systems;
}

void warn_of_missing(const Snapshots &s, Watch watch) {
    const std::int64_t found = s.motions.cols();
    if (s.asked == 0)
        watch.warn(reason::basis_too_small, "the dominant mode does not move the contact: the basis has "
                                            "no snapshot; name another dominant mode");
    else if (found < s.asked)
        watch.warn(
            reason::basis_too_small,
            format("%lld of %lld static contact solutions do not exist: their loads drive a part that only "
                   "contact holds apart; kind \"plm\" needs none",
                   static_cast<long long>(s.asked - found), static_cast<long long>(s.asked)));
}

CollectedModes collect_snapshots(const ColumnSources &from, Watch watch) {
    const auto &[space, sampler, dominant, rest, rule, options] = from;
    Snapshots snapshots(space, rest);
    const bool homogeneous = is_homogeneous(*space.model);
    Matrix excitation(space.size(), 0);
    for (std::size_t d = 0; d < dominant.size(); ++d) {
        watch.step("snapshots", 0.5 * static_cast<double>(d) / static_cast<double>(dominant.size()));
        const double omega = 2 * M_PI * sampler->dominant()[d].frequency_hz;
        for (double a : snapshot_alphas(sampler->sweeps()[d], homogeneous, options.n_snapshots))
            snapshots.add(dominant[d], a * omega * omega);
        excitation.append(excitation_columns(space, dominant[d], omega));
    }
    watch.step("snapshots", 0.5);
    CollectedModes result;
    Matrix static_motions = snapshots.motions, modes;
    for (const RestSystem &system : rest_systems(space, rest, rule)) {
        Matrix forces = excitation;
        if (snapshots.motions.cols() > 0) {
            forces.append(snapshots.forces_beyond(system.springs()));
            static_motions.append(system.inertia_response(snapshots.motions));
        }
        modes.append(
            system.modes(2 * M_PI * options.rest_factor * rule.max_hz, forces, options.snapshot_tolerance));
    }
    result.n_rest_modes = modes.cols();
    warn_of_missing(snapshots, watch);
    result.columns = modes;
    if (homogeneous) modes = orthonormal(space, modes); // those of one system are already
    if (static_motions.cols() > 0)
        result.columns.append(main_directions(space, modes, std::move(static_motions), 2 * M_PI * rule.max_hz,
                                              options.snapshot_tolerance));
    if (result.columns.cols() == 0)
        throw Error(status::argument, format("no mode at rest below %.6g Hz answers to the loads, and there "
                                             "is no snapshot; raise rest_factor",
                                             options.rest_factor * rule.max_hz))
            .argument("rest_factor")
            .reason(reason::basis_too_small);
    return result;
}

constexpr BasisKind snapshots_kind() {
    BasisKind kind("snapshots", "modes at rest and static contact solutions");
    kind.own_options = "rest_factor,n_snapshots,snapshot_tolerance";
    kind.needs_sampler = true;
    kind.highest_hz = [](const BasisOptions &o, const SelectionRule &rule) {
        return o.rest_factor * rule.max_hz;
    };
    kind.collect = collect_snapshots;
    return kind;
}

} // namespace

constexpr BasisKind basis_kinds::snapshots = snapshots_kind();

} // namespace plm
