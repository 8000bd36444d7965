// What a scenario does with models, samplers and bases, and with any handle.
#include "keys.hpp"
#include "pick.hpp"
#include "scenario.hpp"

namespace scenarios {

void Scenario::build_model() {
    plm_model *model = pick(models_);
    CALL(witness_, plm_model_build(model));
    std::int64_t count = 0;
    if (!random_.chance(0.3) || CALL(witness_, plm_model_audit(model, &count)) != PLM_OK) return;
    for (std::int64_t i = 0; i < count; ++i) {
        std::int32_t severity = 0;
        double value = 0;
        char text[300];
        CALL(witness_, plm_model_get_finding(model, i, &severity, &value, sizeof text, text, nullptr));
    }
}

void Scenario::read_rest_and_modes() {
    plm_model *model = pick(models_);
    CALL(witness_, plm_model_solve_rest(model));
    const std::int64_t n = random_.integer(1, 4);
    std::vector<double> hz(static_cast<std::size_t>(n)), shape(static_cast<std::size_t>(n * 30));
    const auto system = static_cast<std::int32_t>(random_.integer(PLM_SYSTEM_OPEN, PLM_SYSTEM_REST));
    if (CALL(witness_, plm_model_get_modes(model, system, nullptr, n, hz.data(), shape.data())) != PLM_OK)
        return;
    witness_.expect_finite(hz.data(), hz.size(), "frequencies of modes");
    witness_.expect_finite(shape.data(), static_cast<std::size_t>(n), "mode shapes");
}

void Scenario::create_sampler() {
    plm_sampler *sampler = nullptr;
    if (CALL(witness_, plm_sampler_create(pick(models_), &sampler)) != PLM_OK) return;
    samplers_.push_back(sampler);
    draw_options(witness_, random_, sampler_access, sampler, tame_ ? 0.05 : 0.15);
}

void Scenario::run_sampler() {
    plm_sampler *sampler = pick(samplers_);
    if (random_.chance(0.1))
        CALL(witness_,
             plm_sampler_add_dominant_mode(sampler, static_cast<std::int32_t>(random_.integer(-1, 3)),
                                           random_.integer(-1, 5)));
    CALL(witness_, plm_sampler_run(sampler));
}

void Scenario::create_basis() {
    plm_basis *basis = nullptr;
    if (CALL(witness_, plm_basis_create(pick(models_), &basis)) != PLM_OK) return;
    bases_.push_back(basis);
    draw_options(witness_, random_, basis_access, basis, tame_ ? 0.05 : 0.15);
    if (random_.chance(0.9)) CALL(witness_, plm_basis_set_sampler(basis, pick(samplers_)));
    if (random_.chance(0.1)) CALL(witness_, plm_basis_set_parent(basis, pick(bases_)));
    plm_branch *const curves[2] = {pick(branches_), pick(branches_)};
    if (random_.chance(0.1)) CALL(witness_, plm_basis_set_responses(basis, random_.integer(0, 2), curves));
}

void Scenario::build_basis() {
    plm_basis *basis = pick(bases_);
    std::int64_t size = 0;
    if (CALL(witness_, plm_basis_build(basis)) < 0) return;
    if (CALL(witness_, plm_basis_get_int(basis, "size", &size)) != PLM_OK || size < 1) return;
    constexpr std::int64_t rows = 30; // no model has more
    std::vector<double> vectors(static_cast<std::size_t>(rows * size)), q(rows, 1.0), r(rows);
    if (CALL(witness_, plm_basis_get_vectors(basis, 0, 0, size, vectors.data(), rows)) == PLM_OK)
        witness_.expect_finite(vectors.data(), 1, "vectors of the basis");
    const auto is_static = static_cast<std::int32_t>(random_.integer(0, 1)),
               use_mass = static_cast<std::int32_t>(random_.integer(0, 1));
    if (CALL(witness_, plm_basis_get_residual(basis, is_static, use_mass, n_dof_, q.data(), r.data())) ==
        PLM_OK)
        witness_.expect_finite(r.data(), 1, "residual of a field in the basis");
}

void Scenario::change_options() {
    witness_.cancel_after(random_.chance(0.5) ? 0 : random_.integer(1, 30));
    draw_options(witness_, random_, hbm_access, pick(hbms_), 0.1);
}

void Scenario::read_everything() {
    read_results(witness_, model_access, pick(models_));
    read_results(witness_, sampler_access, pick(samplers_));
    read_results(witness_, basis_access, pick(bases_));
    read_results(witness_, hbm_access, pick(hbms_));
}

// The handle stays in its list: it is used again, stale.
void Scenario::destroy_one() {
    const auto gone = [this](auto *handle, auto destroy) {
        witness_.begin("a handle is destroyed");
        witness_.end(destroy(&handle));
    };
    switch (random_.integer(0, 6)) {
    case 0:
        return gone(pick(models_), plm_model_destroy);
    case 1:
        return gone(pick(samplers_), plm_sampler_destroy);
    case 2:
        return gone(pick(bases_), plm_basis_destroy);
    case 3:
        return gone(pick(hbms_), plm_hbm_destroy);
    case 4:
        return gone(pick(branches_), plm_branch_destroy);
    case 5:
        return gone(pick(transients_), plm_transient_destroy);
    default:
        return gone(pick(studies_), plm_study_destroy);
    }
}

} // namespace scenarios
