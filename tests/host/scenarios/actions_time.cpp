// What a scenario does with motion in time and with studies.
#include "keys.hpp"
#include "pick.hpp"
#include "scenario.hpp"

namespace scenarios {

void Scenario::create_transient() {
    plm_transient *transient = nullptr;
    if (CALL(witness_, plm_transient_create(pick(models_), random_.chance(0.5) ? nullptr : pick(bases_),
                                            &transient)) != PLM_OK)
        return;
    transients_.push_back(transient);
    CALL(witness_, plm_transient_set_int(transient, "periods", random_.integer(1, 5)));
    draw_options(witness_, random_, transient_access, transient, 0.1);
    if (random_.chance(0.7))
        CALL(witness_, plm_transient_start_at(transient, pick(branches_), 0));
    else
        CALL(witness_, plm_transient_set_double(transient, "frequency_hz", random_.decades(0, 2)));
    const auto dof = static_cast<std::int32_t>(any_dof());
    CALL(witness_, plm_transient_observe_i32(transient, 0, 1, &dof));
}

void Scenario::run_transient() {
    plm_transient *transient = pick(transients_);
    CALL(witness_, plm_transient_run(transient));
    if (random_.chance(0.5)) CALL(witness_, plm_transient_find_periodic(transient));
    std::vector<double> q(static_cast<std::size_t>(n_dof_)), v(q), history(10000), real(1000), imag(1000);
    std::int64_t n = 0;
    if (CALL(witness_, plm_transient_get_state(transient, n_dof_, q.data(), v.data())) == PLM_OK) {
        witness_.expect_finite(q.data(), q.size(), "displacements");
        witness_.expect_finite(v.data(), v.size(), "velocities");
    }
    if (CALL(witness_, plm_transient_get_history(transient, 0, 10000, history.data(), &n)) == PLM_OK)
        witness_.expect_finite(history.data(), static_cast<std::size_t>(n), "history");
    if (CALL(witness_, plm_transient_get_multipliers(transient, 1000, real.data(), imag.data(), &n)) ==
        PLM_OK)
        witness_.expect_finite(real.data(), static_cast<std::size_t>(n), "multipliers of the orbit");
    read_results(witness_, transient_access, transient);
}

void Scenario::create_study() {
    plm_study *study = nullptr;
    std::int64_t index = 0;
    if (CALL(witness_, plm_study_create(pick(models_), &study)) != PLM_OK) return;
    studies_.push_back(study);
    CALL(witness_, plm_study_set_int(study, "repeats", 0));
    CALL(witness_, plm_study_set_int(study, "curve_samples", 20));
    CALL(witness_, plm_study_set_double(study, "curve_tolerance", 1e-2));
    if (random_.chance(0.2)) draw_options(witness_, random_, study_access, study, 0.1);
    CALL(witness_, plm_study_set_output(study, any_dof(), any_measure(), 0));
    CALL(witness_, plm_study_add_response(study, "response", pick(hbms_), &index));
    if (random_.chance(0.3))
        CALL(witness_,
             plm_study_add_compressed(study, "compressed", pick(hbms_), random_.integer(0, 4), &index));
    if (random_.chance(0.2))
        CALL(witness_, plm_study_add_refined(study, "refined", pick(hbms_), 0.1, &index));
    if (random_.chance(0.2))
        CALL(witness_, plm_study_add_marching(study, "marching", pick(transients_), 3, &index));
    const double levels[2] = {1, 2};
    if (random_.chance(0.2)) CALL(witness_, plm_study_set_force_levels(study, 2, levels));
}

void Scenario::run_study() {
    plm_study *study = pick(studies_);
    if (CALL(witness_, plm_study_run(study)) < 0) return;
    read_results(witness_, study_access, study);
    char text[300];
    CALL(witness_, plm_study_get_outcome(study, 0, sizeof text, text, nullptr));
    plm_branch *curve = nullptr;
    CALL(witness_, plm_study_get_curve(study, random_.integer(-1, 0), 0, &curve));
    keep(curve);
}

} // namespace scenarios
