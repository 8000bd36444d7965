// The course of a scenario; what its steps do is in actions_*.cpp.
#include "scenario.hpp"
#include "keys.hpp"

namespace scenarios {

Scenario::Scenario(Tally &tally, std::uint64_t seed, const Limits &limits)
    : tally_(tally), random_(seed), witness_(tally, random_, limits),
      memory_(random_.chance(0.1) ? random_.integer(1, random_.chance(0.5) ? 3000 : 60000) : 0),
      tame_(random_.chance(0.6)) {
    tally_.seed = seed;
}

void Scenario::run() {
    ++tally_.scenarios;
    if (!create_context()) return;
    create_model();
    if (random_.chance(0.1)) create_model();
    if (random_.chance(0.3)) witness_.cancel_after(random_.integer(1, random_.chance(0.5) ? 20 : 400));
    build_model();
    steps();
    finish();
}

bool Scenario::create_context() {
    // now and then the library's own memory, so that malloc is used, too
    const plm_status status =
        random_.chance(0.7)
            ? CALL(witness_, plm_context_create_with_allocator(PLM_API_VERSION, Memory::allocate,
                                                               Memory::release, &memory_, &context_))
            : CALL(witness_, plm_context_create(PLM_API_VERSION, &context_));
    if (status != PLM_OK) return false;
    witness_.use(context_, nullptr);
    CALL(witness_, plm_context_set_progress(context_, Witness::on_progress, &witness_));
    return true;
}

void Scenario::create_model() {
    plm_model *model = nullptr;
    n_dof_ = random_.integer(1, 30);
    if (CALL(witness_, plm_model_create(context_, n_dof_, &model)) != PLM_OK) return;
    models_.push_back(model);
    witness_.use(context_, model);
    draw_structure(witness_, random_, model, n_dof_, tame_, arrays_);
}

// Mostly in the order of plm.h, from some place on; in between anything.
void Scenario::steps() {
    const std::int64_t count = random_.integer(8, 40),
                       n_actions = static_cast<std::int64_t>(actions().size());
    std::int64_t next = 0;
    for (std::int64_t k = 0; k < count && !witness_.out_of_time(); ++k) {
        const std::int64_t now = random_.chance(0.65) ? next++ : random_.integer(0, n_actions - 1);
        if (next >= n_actions) next = random_.integer(0, 10);
        (this->*actions()[static_cast<std::size_t>(now)])();
    }
}

const std::vector<Scenario::Action> &Scenario::actions() {
    static const std::vector<Action> all = {&Scenario::create_sampler,     &Scenario::run_sampler,
                                            &Scenario::create_basis,       &Scenario::build_basis,
                                            &Scenario::create_hbm,         &Scenario::sweep,
                                            &Scenario::read_branch,        &Scenario::find_peak,
                                            &Scenario::read_point,         &Scenario::solve,
                                            &Scenario::estimate_error,     &Scenario::find_isolated,
                                            &Scenario::find_backbones,     &Scenario::find_nonlinear_mode,
                                            &Scenario::follow_bifurcation, &Scenario::create_transient,
                                            &Scenario::run_transient,      &Scenario::create_study,
                                            &Scenario::run_study,          &Scenario::find_by_marching,
                                            &Scenario::refine_basis,       &Scenario::read_rest_and_modes,
                                            &Scenario::change_options,     &Scenario::read_everything,
                                            &Scenario::build_model,        &Scenario::destroy_one,
                                            &Scenario::compute_response};
    return all;
}

// A context takes everything with it, and knows afterwards that it is gone.
void Scenario::finish() {
    if (random_.chance(0.5))
        for (plm_model *model : models_) plm_model_destroy(&model);
    if (random_.chance(0.5))
        for (plm_basis *basis : bases_) plm_basis_destroy(&basis);
    CALL(witness_, plm_context_destroy(&context_));
    if (context_) witness_.report("the context was not destroyed");
    witness_.use(nullptr, nullptr);
    std::int64_t n = 0;
    for (plm_branch *branch : branches_)
        if (branch && CALL(witness_, plm_branch_get_int(branch, "n_points", &n)) != PLM_ERR_HANDLE)
            witness_.report("a branch outlived its context");
}

} // namespace scenarios
