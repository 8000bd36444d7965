// What a scenario does with response curves: sweeps, peaks, points, and every search from them.
#include "keys.hpp"
#include "pick.hpp"
#include "scenario.hpp"
#include <algorithm>

namespace scenarios {

void Scenario::keep(plm_branch *branch) {
    if (branch) branches_.push_back(branch);
}

std::int64_t Scenario::any_point(plm_branch *branch) {
    std::int64_t n = 0;
    CALL(witness_, plm_branch_get_int(branch, "n_points", &n));
    return n > 0 ? random_.integer(0, random_.chance(0.02) ? n : n - 1) : 0;
}

double Scenario::some_frequency(plm_branch *branch) {
    std::int64_t n = 0;
    std::vector<double> hz(5000);
    if (random_.chance(0.3) ||
        CALL(witness_, plm_branch_get_array(branch, "frequency_hz", 5000, hz.data(), &n)) != PLM_OK || n < 1)
        return random_.chance(0.05) ? wild(random_) : random_.decades(-1, 2);
    return hz[static_cast<std::size_t>(random_.integer(0, n - 1))] * random_.between(0.98, 1.02);
}

void Scenario::create_hbm() {
    plm_hbm *hbm = nullptr;
    if (CALL(witness_, plm_hbm_create(pick(bases_), &hbm)) != PLM_OK) return;
    hbms_.push_back(hbm);
    if (random_.chance(0.7)) CALL(witness_, plm_hbm_set_int(hbm, "n_harmonics", random_.integer(1, 7)));
    draw_options(witness_, random_, hbm_access, hbm, tame_ ? 0.06 : 0.15);
}

void Scenario::sweep() {
    plm_branch *branch = nullptr;
    CALL(witness_, plm_hbm_sweep(pick(hbms_), &branch));
    keep(branch);
}

void Scenario::read_branch() {
    plm_branch *branch = pick(branches_);
    read_results(witness_, branch_access, branch);
    std::vector<double> amplitude(5000);
    std::int64_t n = 0;
    if (CALL(witness_, plm_branch_get_amplitude(branch, any_dof(), any_measure(), any_harmonic(), 5000,
                                                amplitude.data(), &n)) == PLM_OK)
        witness_.expect_finite(amplitude.data(), static_cast<std::size_t>(n), "amplitude");
}

void Scenario::read_point() {
    plm_branch *branch = pick(branches_);
    const std::int64_t point = any_point(branch);
    std::int64_t n_dof = 0, pairs = 0, n = 0;
    CALL(witness_, plm_branch_get_int(branch, "n_pairs", &pairs));
    CALL(witness_, plm_branch_get_int(branch, "n_dof", &n_dof));
    constexpr std::int64_t times = 8;
    const auto of_pairs = static_cast<std::size_t>(pairs * times) + 1;
    std::vector<double> u(of_pairs), force(of_pairs), q(static_cast<std::size_t>(n_dof) + 1), real(1000),
        imag(1000);
    std::vector<std::int32_t> closed(of_pairs);
    double value[2];
    if (CALL(witness_, plm_branch_get_contact(branch, point, times, u.data(), force.data(), closed.data())) ==
        PLM_OK) {
        witness_.expect_finite(u.data(), of_pairs - 1, "penetration");
        witness_.expect_finite(force.data(), of_pairs - 1, "contact force");
    }
    if (CALL(witness_, plm_branch_get_closed_share(branch, point, pairs, u.data())) == PLM_OK)
        witness_.expect_finite(u.data(), static_cast<std::size_t>(pairs), "closed share");
    if (CALL(witness_, plm_branch_get_energy(branch, point, value, value + 1)) == PLM_OK)
        witness_.expect_finite(value, 2, "energy and contact area");
    if (CALL(witness_, plm_branch_get_full_residual(branch, point, value)) == PLM_OK)
        witness_.expect_finite(value, 1, "full residual");
    if (CALL(witness_, plm_branch_get_periodicity_defect(branch, point, value)) == PLM_OK)
        witness_.expect_finite(value, 1, "periodicity defect");
    if (CALL(witness_, plm_branch_get_multipliers(branch, point, 1000, real.data(), imag.data(), &n)) ==
        PLM_OK) {
        witness_.expect_finite(real.data(), static_cast<std::size_t>(n), "multipliers");
        witness_.expect_finite(imag.data(), static_cast<std::size_t>(n), "multipliers");
    }
    if (CALL(witness_, plm_branch_get_field(branch, point, random_.real(), n_dof, q.data())) == PLM_OK)
        witness_.expect_finite(q.data(), static_cast<std::size_t>(n_dof), "field");
}

void Scenario::compute_response() {
    double peak[2], error = 0;
    plm_branch *curve = nullptr;
    plm_hbm *hbm = nullptr;
    if (CALL(witness_,
             plm_model_compute_response(pick(models_), any_dof(), any_measure(), random_.decades(-4, -1),
                                        peak, peak + 1, &error, random_.chance(0.7) ? &curve : nullptr,
                                        random_.chance(0.7) ? &hbm : nullptr)) == PLM_OK)
        witness_.expect_finite(peak, 2, "peak");
    if (hbm) hbms_.push_back(hbm);
    keep(curve);
}

void Scenario::find_peak() {
    double hz_and_amplitude[2];
    plm_branch *peak = nullptr;
    if (CALL(witness_, plm_hbm_find_peak(pick(hbms_), pick(branches_), any_dof(), any_measure(),
                                         any_harmonic(), hz_and_amplitude, hz_and_amplitude + 1,
                                         random_.chance(0.5) ? &peak : nullptr)) == PLM_OK)
        witness_.expect_finite(hz_and_amplitude, 2, "peak");
    keep(peak);
}

void Scenario::solve() {
    plm_branch *start = random_.chance(0.5) ? pick(branches_) : nullptr, *found = nullptr;
    const double hz = some_frequency(start);
    const std::int64_t point = start ? any_point(start) : 0;
    CALL(witness_, plm_hbm_solve(pick(hbms_), hz, start, point, &found));
    keep(found);
}

void Scenario::keep_found(std::int64_t count) {
    plm_hbm *hbm = pick(hbms_);
    for (std::int64_t i = 0; i < std::min<std::int64_t>(count, 3); ++i) {
        double range[2];
        plm_branch *branch = nullptr;
        CALL(witness_, plm_hbm_get_found(hbm, i, range, &branch));
        keep(branch);
    }
}

void Scenario::find_isolated() {
    std::int64_t count = 0;
    CALL(witness_, plm_hbm_find_isolated(pick(hbms_), pick(branches_),
                                         random_.chance(0.5) ? 0 : random_.decades(-1, 1), &count));
    keep_found(count);
}

void Scenario::find_backbones() {
    std::int64_t count = 0;
    CALL(witness_,
         plm_hbm_find_backbones(pick(hbms_), random_.chance(0.5) ? 0 : random_.decades(-1, 1), &count));
    keep_found(count);
}

void Scenario::estimate_error() {
    plm_branch *branch = pick(branches_);
    double amplitude[3], hz[3];
    if (CALL(witness_, plm_hbm_estimate_error(pick(hbms_), branch, any_point(branch), any_dof(),
                                              any_measure(), any_harmonic(), amplitude, hz)) != PLM_OK)
        return;
    witness_.expect_finite(amplitude, 3, "estimated errors of the amplitude");
    witness_.expect_finite(hz, 3, "estimated errors of the frequency");
}

void Scenario::refine_basis() {
    plm_basis *refined = nullptr;
    double error = 0;
    if (CALL(witness_, plm_hbm_refine_basis(pick(hbms_), any_dof(), any_measure(), any_harmonic(),
                                            random_.decades(-3, -1), &refined, &error)) == PLM_OK)
        witness_.expect_finite(&error, 1, "error of the refined basis");
    if (refined) bases_.push_back(refined);
}

void Scenario::find_nonlinear_mode() {
    plm_branch *mode = nullptr;
    CALL(witness_, plm_hbm_find_nonlinear_mode(pick(hbms_), random_.integer(1, 3), any_dof(),
                                               random_.chance(0.7) ? 0 : random_.real(), &mode));
    keep(mode);
}

void Scenario::follow_bifurcation() {
    plm_branch *branch = pick(branches_), *other = nullptr;
    std::vector<std::int64_t> kinds(5000);
    std::int64_t n = 0, point = 0;
    if (CALL(witness_, plm_branch_get_int_array(branch, "bifurcation", 5000, kinds.data(), &n)) == PLM_OK)
        for (std::int64_t i = 0; i < n; ++i)
            if (kinds[static_cast<std::size_t>(i)] > PLM_BIFURCATION_NONE) point = i;
    if (random_.chance(0.5))
        CALL(witness_, plm_hbm_switch_branch(pick(hbms_), branch, point, random_.chance(0.5), &other));
    else
        CALL(witness_, plm_hbm_track_fold(pick(hbms_), branch, point, 0.5, 1.5, &other));
    keep(other);
}

void Scenario::find_by_marching() {
    plm_branch *const known[2] = {pick(branches_), pick(branches_)};
    std::int64_t count = 0;
    CALL(witness_, plm_hbm_find_by_marching(pick(hbms_), random_.integer(0, 2), known, random_.integer(1, 2),
                                            random_.integer(0, 1), &count));
    keep_found(count);
}

} // namespace scenarios
