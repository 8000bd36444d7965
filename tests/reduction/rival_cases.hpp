// What the tests of the rival bases share: small chains with piecewise-linear springs, bases of given
// columns, and the resonance on them.
#pragma once
#include "reduction/basis.hpp"
#include "reduction/conditioning.hpp"
#include "reduction/mode_selection.hpp"
#include "reduction/projection.hpp"
#include "sampling/small_models.hpp"
#include "searches/hbm.hpp"
#include "support/small_reduced.hpp"
#include "support/test.hpp"
#include <algorithm>
#include <limits>

namespace rival {

constexpr double infinite = std::numeric_limits<double>::infinity();

/// A chain of 24 masses, its last one against ground through a piecewise-linear spring of 0.1 (the chain's
/// are 1); the last one is driven. Without gap its first resonance lies between 0.064 and 0.12 rad/s.
inline exact::Structure grounded_chain(double gap, double force) {
    return test::chain(24, 0.02, 0.1, gap, force, 0, {23});
}

inline double rayleigh_beta(const exact::Structure &s) {
    return s.damping[0] / s.stiffness[0];
}

struct Window {
    double min_hz = 0, max_hz = 0;
};

struct Scene {
    exact::Structure structure;
    std::shared_ptr<const plm::Model> model;
    Window window;
    std::shared_ptr<const plm::Basis> full; // the unreduced structure
};

inline std::shared_ptr<const plm::Basis> build(const Scene &s, plm::BasisOptions o) {
    o.frequency_min_hz = s.window.min_hz;
    o.frequency_max_hz = s.window.max_hz;
    return std::make_shared<const plm::Basis>(s.model, nullptr, nullptr, o, plm::Watch());
}

/// omega_min, omega_max: the window searched for the peak, rad/s.
inline Scene make_scene(const exact::Structure &structure, double omega_min, double omega_max) {
    Scene s;
    s.structure = structure;
    test::ModelExtras extras;
    extras.beta = rayleigh_beta(structure);
    s.model = test::make_model(structure, extras);
    s.window = {omega_min / (2 * M_PI), omega_max / (2 * M_PI)};
    plm::BasisOptions o;
    o.kind = &plm::basis_kinds::full;
    s.full = build(s, o);
    return s;
}

inline plm::BasisOptions kind(const plm::BasisKind *k, double below_factor = 1.1) {
    plm::BasisOptions o;
    o.kind = k;
    o.below_factor = below_factor;
    o.load_vectors = false; // the modes alone are compared
    return o;
}

inline std::shared_ptr<const plm::ReducedModel> span_of(const plm::Space &space, const plm::Matrix &columns) {
    return plm::project(space, plm::condition_columns(space, columns, 1e-8).coordinates, plm::StaticBasis());
}

/// The n lowest modes of the system with all pairs open, or all closed.
inline plm::Matrix linear_modes(const plm::Space &space, bool closed, std::int64_t n) {
    const plm::SpaceModes modes = plm::modes_of_contact_set(
        space,
        closed ? plm::PairStates::all_closed(space.n_pairs()) : plm::PairStates::all_open(space.n_pairs()),
        infinite);
    return modes.vectors.columns(0, n);
}

inline plm::Peak peak_on(const std::shared_ptr<const plm::ReducedModel> &reduced, Window w,
                         std::int64_t dof) {
    plm::HbmOptions o;
    o.n_harmonics = 5;
    o.stability = plm::StabilityKind::off;
    o.bifurcations = false;
    const plm::Hbm hbm(reduced, w.min_hz, w.max_hz, o, plm::Watch());
    return hbm.find_peak(*hbm.sweep(), dof, plm::Measure::half_peak_to_peak, 0);
}

struct PeakError {
    double frequency = 0, amplitude = 0;
    double larger() const { return std::max(frequency, amplitude); }
};
inline PeakError error_of(const plm::Peak &got, const plm::Peak &truth) {
    return {std::abs(got.frequency_hz / truth.frequency_hz - 1),
            std::abs(got.amplitude / truth.amplitude - 1)};
}
inline PeakError error_on(const Scene &s, const std::shared_ptr<const plm::ReducedModel> &reduced) {
    const std::int64_t dof = s.structure.n - 1;
    return error_of(peak_on(reduced, s.window, dof), peak_on(s.full->reduced(), s.window, dof));
}

} // namespace rival
