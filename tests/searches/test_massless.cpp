// DOFs without mass: the structure condensed by hand must answer as the one with them, in harmonic balance
// and in exact motion, and a mass that goes to zero must lead there.
#include "orbits/exact_motion.hpp"
#include "orbits/hill.hpp"
#include "orbits/recorded_motion.hpp"
#include "orbits/shooting.hpp"
#include "orbits/stability.hpp"
#include "reduction/basis.hpp"
#include "reduction/basis_kind.hpp"
#include "sampling/small_models.hpp"
#include "searches/hbm.hpp"
#include "support/test.hpp"
#include <algorithm>
#include <complex>

using plm::BasisKind;
namespace basis_kinds = plm::basis_kinds;
using plm::HbmOptions;

namespace {

using BasisPtr = std::shared_ptr<const plm::Basis>;

constexpr int n_masses = 3, tip = 3, driven = 2; // three masses of 1, springs of 1e4, a tip that hits a stop
constexpr double spring = 1e4, stop = 3e4, alpha = 5, gap = 1e-4, preload = 20;

// M, K and the stop; no damping.
exact::Structure chain_with_tip(double tip_mass) {
    exact::Structure s;
    s.n = 4, s.z = 1;
    s.mass = {1, 1, 1, tip_mass};
    s.stiffness.assign(16, 0.0);
    for (int i = 0; i < 4; ++i) {
        s.stiffness[i * 4 + i] = i < 3 ? 2 * spring : spring;
        if (i > 0) s.stiffness[i * 4 + i - 1] = s.stiffness[(i - 1) * 4 + i] = -spring;
    }
    s.damping.assign(16, 0.0);
    s.gap_rows = {0, 0, 0, 1};
    s.contact_stiffness = {stop};
    s.gap = {gap};
    s.force = {0, 0, 10, 0};
    s.preload = {0, 0, 0, preload};
    return s;
}

// The tip eliminated: K_dd - K_ds K_ss^-1 K_sd, the stop behind the last spring, which its pre-load has bent.
// Damping alpha M.
exact::Structure condensed() {
    const exact::Structure whole = chain_with_tip(0);
    exact::Structure s;
    s.n = n_masses, s.z = 1;
    s.mass.assign(n_masses, 1.0);
    s.damping.assign(9, 0.0);
    s.stiffness.resize(9);
    s.gap_rows.resize(n_masses);
    s.force.assign(whole.force.begin(), whole.force.begin() + n_masses);
    s.preload.resize(n_masses);
    const auto k = [&](int i, int j) { return whole.stiffness[i * 4 + j]; };
    for (int i = 0; i < n_masses; ++i) {
        for (int j = 0; j < n_masses; ++j)
            s.stiffness[i * n_masses + j] = k(i, j) - k(i, tip) * k(tip, j) / k(tip, tip);
        s.damping[i * n_masses + i] = alpha;
        s.gap_rows[i] = -k(tip, i) / k(tip, tip);
        s.preload[i] = -k(i, tip) / k(tip, tip) * preload;
    }
    s.contact_stiffness = {1 / (1 / stop + 1 / k(tip, tip))};
    s.gap = {gap - preload / k(tip, tip)};
    return s;
}

test::ModelExtras mass_damping() {
    test::ModelExtras e;
    e.alpha = alpha;
    return e;
}

BasisPtr make_basis(const exact::Structure &s, const test::ModelExtras &extras, const BasisKind *kind) {
    const auto model = test::make_model(s, extras);
    const auto sampler = std::make_shared<plm::Sampler>(model, plm::SamplerOptions(), plm::Watch());
    plm::BasisOptions o;
    o.kind = kind;
    return std::make_shared<plm::Basis>(model, sampler, nullptr, o, plm::Watch());
}

HbmOptions options(std::int64_t n_harmonics) {
    HbmOptions o;
    o.n_harmonics = n_harmonics;
    o.stability = plm::StabilityKind::off;
    return o;
}

struct Peak {
    double hz = 0, amplitude = 0;
};
Peak peak_of(const plm::Basis &basis, const HbmOptions &o) {
    const plm::Hbm hbm(basis.reduced(), basis.window_min_hz(), basis.window_max_hz(), o, plm::Watch());
    const plm::Peak p = hbm.find_peak(*hbm.sweep(), driven, plm::Measure::half_peak_to_peak, 0);
    return {p.frequency_hz, p.amplitude};
}
double distance(const Peak &got, const Peak &want) {
    return std::max(std::abs(got.hz / want.hz - 1), std::abs(got.amplitude / want.amplitude - 1));
}

const BasisKind *const kinds[] = {
    &basis_kinds::full,     &basis_kinds::plm,   &basis_kinds::craig_bampton, &basis_kinds::snapshots,
    &basis_kinds::bilinear, &basis_kinds::lelsm, &basis_kinds::lelsm_updated, &basis_kinds::discontinuity};

// --- harmonic balance

double amplitude_at(const plm::Basis &basis, const HbmOptions &o, double hz) {
    const plm::Hbm hbm(basis.reduced(), basis.window_min_hz(), basis.window_max_hz(), o, plm::Watch());
    return hbm.solve(hz, nullptr, 0)->amplitude(0, driven, plm::Measure::half_peak_to_peak, 0);
}
double worst_against_condensation(HbmOptions o) {
    o.n_harmonics = 127; // see below
    const BasisPtr reference = make_basis(condensed(), mass_damping(), &basis_kinds::full);
    double worst = 0;
    for (const BasisKind *kind : kinds) {
        const BasisPtr basis = make_basis(chain_with_tip(0), mass_damping(), kind);
        for (double hz : {10.5, 11.5, 12.5}) {
            const double d = std::abs(amplitude_at(*basis, o, hz) / amplitude_at(*reference, o, hz) - 1);
            if (!(d < 1e-6)) std::printf("    basis of kind %s, %g Hz: %g\n", kind->name, hz, d);
            worst = std::max(worst, d);
        }
    }
    return worst;
}
double worst_between_bases(const HbmOptions &o) {
    const Peak want = peak_of(*make_basis(chain_with_tip(0), mass_damping(), &basis_kinds::full), o);
    double worst = 0;
    for (const BasisKind *kind : kinds)
        worst =
            std::max(worst, distance(peak_of(*make_basis(chain_with_tip(0), mass_damping(), kind), o), want));
    return worst;
}
// Four vectors span all there is in this model: the same equations in other coordinates. What differs is
// where Newton's method stops, 1e-9 of the motion, and at a peak the parabola through neighbouring points.
// Condensed by hand they are the same only with all harmonics: the motion of the tip is cut off after H of
// them, the force of the stop behind the last spring is not. That falls with H^-2 to H^-3: 5e-5 with 7, 5e-8
// with 127.
void every_basis_answers_as_the_structure_condensed_by_hand(void **) {
    assert_true(below(worst_between_bases(options(7)), 1e-6));
    assert_true(below(worst_against_condensation(options(7)), 1e-6));
}
void gaps_and_both_formulations_do_so(void **) {
    HbmOptions o = options(7);
    o.unknowns = plm::NonlinearUnknowns::gaps;
    for (plm::FormulationKind formulation :
         {plm::FormulationKind::penalty, plm::FormulationKind::compliance}) {
        o.formulation = formulation;
        assert_true(below(worst_between_bases(o), 1e-6));
        assert_true(below(worst_against_condensation(o), 1e-6));
    }
}

struct Case {
    const char *name;
    test::ModelExtras extras;
};
std::vector<Case> damping_cases() {
    test::ModelExtras rayleigh, modal, structural, matrix;
    rayleigh.beta = 1e-3;
    modal.modal_ratio = {0.03};
    structural.structural = 0.06;
    matrix.explicit_damping = true;
    return {{"alpha", mass_damping()},
            {"beta", rayleigh},
            {"modal", modal},
            {"structural", structural},
            {"matrix", matrix}};
}
exact::Structure with_dashpots(double tip_mass) {
    exact::Structure s = chain_with_tip(tip_mass);
    for (int i = 0; i < 4; ++i) s.damping[i * 4 + i] = i < 3 ? 4 : 2;
    return s;
}

// A damping ratio of a mode is a dashpot of 2 D sqrt(k m): it goes with the root of the mass.
double worst_step_to_zero(const BasisKind *kind, const Case &c) {
    const Peak want = peak_of(*make_basis(with_dashpots(0), c.extras, kind), options(5));
    double worst = 0;
    for (double mass : {1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-15}) {
        const BasisPtr basis = make_basis(with_dashpots(mass), c.extras, kind);
        const double d = distance(peak_of(*basis, options(5)), want);
        const double bound = c.extras.modal_ratio.empty() ? 10 * mass + 1e-6 : std::sqrt(mass) + 1e-6;
        if (!(d < bound)) std::printf("    %s, kind %s, mass %g: %g\n", c.name, kind->name, mass, d);
        worst = std::max(worst, d / bound);
        for (double l : basis->reduced()->lambda) // no mode a thousand times above all that matters
            if (!(l < 1e13)) worst = 1e300;
    }
    return worst;
}
// The change of a peak is proportional to the mass; 1e-6: as above, and what follows statically has no
// inertia at the highest harmonic.
void a_vanishing_mass_leads_to_none_with_every_damping(void **) {
    for (const Case &c : damping_cases()) assert_true(below(worst_step_to_zero(&basis_kinds::plm, c), 1));
}
void a_vanishing_mass_leads_to_none_in_every_basis(void **) {
    for (const BasisKind *kind : kinds) assert_true(below(worst_step_to_zero(kind, damping_cases()[1]), 1));
}

double nonlinear_mode_error() {
    const auto frequencies = [](const exact::Structure &s) {
        const BasisPtr basis = make_basis(s, {}, &basis_kinds::full);
        const plm::Hbm hbm(basis->reduced(), basis->window_min_hz(), basis->window_max_hz(), options(63),
                           plm::Watch());
        const auto branch = hbm.find_nonlinear_mode(1, -1, 0);
        return std::vector<double>{branch->points().front().omega, branch->points().back().omega};
    };
    const std::vector<double> got = frequencies(chain_with_tip(0)), want = frequencies(condensed());
    return std::max(std::abs(got[0] / want[0] - 1), std::abs(got[1] / want[1] - 1));
}
// Linear at the beginning: to Newton's tolerance. At the end harmonics cut off differ (above). The amplitude
// of the end depends on the coordinates' scale no more, since the modal mass is that of the same mode.
void nonlinear_modes_know_no_massless_mode(void **) {
    assert_true(below(nonlinear_mode_error(), 1e-6));
}

// --- exact motion

constexpr double omega = 72;

plm::PeriodicOrbit orbit_of(const plm::ReducedModel &m, const plm::FlowModel &model, plm::ExactFlow &flow) {
    const plm::Hbm hbm(std::make_shared<plm::ReducedModel>(m), 10, 13, options(9), plm::Watch());
    const auto branch = hbm.solve(omega / (2 * M_PI), nullptr, 0);
    const plm::BranchPoint &p = branch->points()[0];
    return plm::periodic_orbit(flow, model.state(p.eta_0, p.eta, omega, 0.0));
}

struct Exact {
    bool converged = false;
    std::size_t n_multipliers = 0;
    double peak = 0, multiplier = 0, tip = 0, hill = 0, events = 0;
};
// The largest multiplier of the motion that the events of a point lead to; NaN: none.
double multiplier_by_events(const plm::FlowModel &model, const plm::BranchPoint &point) {
    const plm::Matrix everything;
    plm::EventMotion motion(model, omega, 1.0, 1, everything);
    plm::EventSequence sequence = plm::contact_events(model.reduced(), point, 1);
    for (int k = 0; k < 8; ++k) {
        if (!motion.solve(sequence)) return NAN;
        sequence = motion.moved(sequence);
    }
    return motion.is_consistent() && !sequence.events.empty()
               ? std::abs(plm::multipliers(motion.monodromy()).front())
               : NAN;
}

Exact exact_motion(const exact::Structure &s, const test::ModelExtras &extras, int n_dofs) {
    const BasisPtr basis = make_basis(s, extras, &basis_kinds::full);
    const auto model = std::make_shared<const plm::FlowModel>(basis->reduced(), omega);
    plm::ExactFlow flow(model, omega, 1.0);
    const plm::PeriodicOrbit orbit = orbit_of(*basis->reduced(), *model, flow);
    plm::Matrix rows(n_dofs, model->size());
    for (int i = 0; i < n_dofs; ++i) {
        const plm::vector<double> row = model->dof_row(i);
        for (std::int64_t j = 0; j < model->size(); ++j) rows(i, j) = row[j];
    }
    const plm::vector<double> peaks = plm::orbit_peaks(flow, orbit.state, orbit.period_multiple, rows);
    const plm::Hbm hbm(basis->reduced(), 10, 13, options(40), plm::Watch());
    const auto fine = hbm.solve(omega / (2 * M_PI), nullptr, 0);
    Exact e;
    e.converged = orbit.converged;
    e.n_multipliers = orbit.multipliers.size();
    e.peak = peaks[driven];
    e.tip = peaks[n_dofs - 1];
    e.multiplier = std::abs(orbit.multipliers.front());
    e.events = multiplier_by_events(*model, fine->points()[0]);
    e.hill = std::abs(plm::hill_multipliers(*model, model->reduced(), fine->points()[0], 1).front());
    return e;
}

// Without damping the tip is no state: as many multipliers as the structure without it has.
void undamped_followers_move_exactly(void **) {
    const exact::Structure truth = condensed();
    const exact::Orbit want = exact::periodic_orbit(truth, omega, {}, 40, 4000);
    const Exact got = exact_motion(chain_with_tip(0), mass_damping(), 4),
                known = exact_motion(truth, mass_damping(), 3);
    assert_true(want.converged && got.converged && known.converged);
    assert_true(close_to(got.peak, want.peak(driven), 1e-6)); // sampled 4000 times, refined by parabolas
    assert_true(close_to(got.peak, known.peak, 1e-9));        // to the tolerance of the shooting
    assert_int_equal(got.n_multipliers, 6);
    assert_true(close_to(got.multiplier, known.multiplier, 1e-8));
    assert_true(close_to(got.events, got.multiplier, 1e-8));
    assert_true(close_to(got.hill, got.multiplier, 1e-4)); // converges with the harmonics' cube
}

// With damping it relaxes: one multiplier more. A mass of 1e-5 that has a frequency differs by its share.
void damped_ones_relax_exactly(void **) {
    test::ModelExtras beta;
    beta.beta = 1e-3;
    exact::Structure light = chain_with_tip(1e-5);
    for (int k = 0; k < 16; ++k) light.damping[k] = beta.beta * light.stiffness[k];
    const exact::Orbit want = exact::periodic_orbit(light, omega, {}, 40, 4000);
    const Exact got = exact_motion(chain_with_tip(0), beta, 4);
    assert_true(want.converged && got.converged);
    assert_true(close_to(got.peak, want.peak(driven), 2e-5));
    assert_true(close_to(got.tip, want.peak(tip), 2e-5));
    assert_int_equal(got.n_multipliers, 7);
    assert_true(close_to(got.events, got.multiplier, 1e-8));
    assert_true(close_to(got.hill, got.multiplier, 1e-4));
}

} // namespace

int main() {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_basis_answers_as_the_structure_condensed_by_hand),
        cmocka_unit_test(gaps_and_both_formulations_do_so),
        cmocka_unit_test(a_vanishing_mass_leads_to_none_with_every_damping),
        cmocka_unit_test(a_vanishing_mass_leads_to_none_in_every_basis),
        cmocka_unit_test(nonlinear_modes_know_no_massless_mode),
        cmocka_unit_test(undamped_followers_move_exactly),
        cmocka_unit_test(damped_ones_relax_exactly),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
