// The model's life, build, rest state, modes and audit.
#include "capi/barrier.hpp"
#include "capi/model_input.hpp"
#include "capi/model_space.hpp"
#include "linalg/scale.hpp"
#include "space/rest_gaps.hpp"
#include "structure/matrix_input.hpp"
#include <algorithm>

namespace plm::capi {

const std::shared_ptr<const Model> &built(const ModelHandle &h) {
    if (!h.core) throw Error(PLM_ERR_STATE, "the model is not built; build it first").argument("model");
    return h.core;
}

namespace {

constexpr std::int64_t modes_beside_rest = 8; // in the space that is made for it

// without: to find it without a space, or null.
const RestState &solved_rest(ModelHandle &h, Spaceless *without) {
    if (!h.rest) h.rest = without ? without->rest() : rest_of(contact_space(h, 0, modes_beside_rest));
    return *h.rest;
}

} // namespace

const RestState &solved_rest(ModelHandle &h) {
    built(h);
    if (h.rest) return *h.rest;
    return solved_rest(h, spaceless(h, modes_beside_rest).get());
}

namespace {

// The host's solver lives as long as the models whose factors it owns.
std::shared_ptr<const Model> finished(std::unique_ptr<Model> model,
                                      const std::shared_ptr<SolverBinding> &binding, Watch watch) {
    return with_rest_gaps(std::shared_ptr<Model>(model.release(), [binding](const Model *p) { delete p; }),
                          watch);
}

void build(ModelHandle &m) {
    const std::shared_ptr<SolverBinding> binding = m.owner->bind_solver();
    const HostSolver host = binding ? binding->for_core() : HostSolver();
    Warnings said;
    const Watch watch = m.owner->watch().keeping(said);
    take(m,
         finished(std::make_unique<Model>(m.input, m.space_options, binding ? &host : nullptr, watch),
                  binding, watch),
         said);
    m.binding = binding;
}

// The matrices live in the core now; borrowed arrays are the caller's again.
ModelInput what_acts(const ModelInput &all) {
    ModelInput kept;
    kept.n_dof = all.n_dof, kept.damping = all.damping;
    kept.preload = all.preload, kept.excitation = all.excitation;
    kept.contact = all.contact, kept.rest_forces = all.rest_forces;
    return kept;
}

MemoryEstimate estimate(const ModelHandle &m) {
    const std::shared_ptr<SolverBinding> binding = m.owner->bind_solver();
    const HostSolver host = binding ? binding->for_core() : HostSolver();
    m.owner->watch().step("memory", 0.0);
    return estimate_memory(m.input, m.space_options, binding ? &host : nullptr);
}

constexpr int worth_a_look = 1, probably_wrong = 2;

std::int64_t n_worth_a_look(const std::vector<Finding> &findings) {
    return std::count_if(findings.begin(), findings.end(),
                         [](const Finding &f) { return f.severity >= worth_a_look; });
}

// Who never asks for the audit hears the worst of it all the same, and the rest in the log.
Warnings look_over(const std::vector<Finding> &findings, Watch watch) {
    Warnings warnings;
    for (const Finding &f : findings) {
        if (f.severity >= worth_a_look) watch.log(2, f.text);
        if (f.severity >= probably_wrong) warnings.add(PLM_REASON_MODEL, f.text);
    }
    return warnings;
}

} // namespace

Warnings take(ModelHandle &m, std::shared_ptr<const Model> core, const Warnings &said) {
    const std::vector<Finding> findings = quick_audit(*core);
    m.warnings = look_over(findings, m.owner->watch());
    m.warnings.add(said);
    m.n_findings = n_worth_a_look(findings);
    m.findings.clear();
    m.space.reset(), m.rest.reset();
    m.core = std::move(core);
    return m.warnings;
}

Outcome change_loads(ModelHandle &m, const std::function<void(ModelInput &)> &change) {
    if (!m.core) {
        change(m.input);
        return PLM_OK;
    }
    ModelInput changed = m.input;
    change(changed);
    Warnings said;
    const Watch watch = m.owner->watch().keeping(said);
    const Warnings warnings =
        take(m, finished(std::make_unique<Model>(*m.core, changed, watch), m.binding, watch), said);
    m.input = std::move(changed);
    return warnings;
}

void require_current(const std::shared_ptr<const Model> &made_of, const ModelHandle &model, const char *what,
                     const char *again) {
    if (made_of != model.core)
        throw Error(PLM_ERR_STATE,
                    format("the loads, the damping or the walls of the model were changed after "
                           "the %s was made; %s",
                           what, again))
            .argument(what);
}

namespace {

PairStates contact_set(ModelHandle &m, std::int32_t system, const std::int32_t *closed, Spaceless *without) {
    const std::int64_t z = m.core->n_pairs();
    switch (system) {
    case PLM_SYSTEM_OPEN:
        return PairStates::all_open(z);
    case PLM_SYSTEM_SLIDING:
        return PairStates::all_closed(z);
    case PLM_SYSTEM_REST:
        return solved_rest(m, without).states;
    default:
        if (z > 0) require_pointer(closed, "closed");
        return PairStates::from_flags(closed, z);
    }
}

void put_modes(const ModelHandle &m, const LowestModes &found, std::int64_t n, double *frequency_hz,
               double *shape) {
    const Model &model = *m.core;
    require_finite_result(found.values.data(), n, "frequency_hz");
    if (shape) {
        const Field free = found.shapes(n);
        for (std::int64_t j = 0; j < n; ++j) model.expand(free, j, shape + j * model.n_dof());
    }
    for (std::int64_t j = 0; j < n; ++j)
        frequency_hz[j] = std::sqrt(std::max(0.0, found.values[static_cast<std::size_t>(j)])) / (2 * M_PI);
}

} // namespace
} // namespace plm::capi

using namespace plm::capi;

plm_status plm_model_create(plm_context *ctx, std::int64_t n_dof, plm_model **model) {
    return call<Context>("plm_model_create", ctx, [&](Context &) {
        require_pointer(model, "model");
        require_range(n_dof, 1, INT64_MAX / 64, "n_dof");
        *model = publish(std::make_shared<ModelHandle>(find<Context>(ctx), n_dof));
        return PLM_OK;
    });
}

plm_status plm_model_destroy(plm_model **model) {
    return destroy<ModelHandle>(model);
}

plm_status plm_model_estimate_memory(plm_model *model, double *bytes) {
    return call<ModelHandle>("plm_model_estimate_memory", model, [&](ModelHandle &m) {
        require_open(m);
        require_pointer(bytes, "bytes");
        m.memory = estimate(m);
        *bytes = m.memory->peak();
        return PLM_OK;
    });
}

plm_status plm_model_build(plm_model *model) {
    return call<ModelHandle>("plm_model_build", model, [&](ModelHandle &m) {
        require_open(m);
        build(m);
        m.input = what_acts(m.input);
        m.surfaces.clear();
        return Outcome(m.warnings);
    });
}

plm_status plm_model_solve_rest(plm_model *model) {
    return call<ModelHandle>("plm_model_solve_rest", model, [&](ModelHandle &m) {
        solved_rest(m);
        return PLM_OK;
    });
}

plm_status plm_model_get_modes(plm_model *model, std::int32_t system, const std::int32_t *closed,
                               std::int64_t n, double *frequency_hz, double *shape) {
    return call<ModelHandle>("plm_model_get_modes", model, [&](ModelHandle &m) {
        built(m);
        require_range(system, PLM_SYSTEM_OPEN, PLM_SYSTEM_GIVEN, "system");
        if (system != PLM_SYSTEM_GIVEN && closed)
            bad_argument("closed", -1, "closed must be NULL unless system is PLM_SYSTEM_GIVEN");
        require_range(n, 1, m.core->n_free(), "n");
        require_pointer(frequency_hz, "frequency_hz");
        const std::unique_ptr<plm::Spaceless> without = spaceless(m, n);
        const plm::PairStates states = contact_set(m, system, closed, without.get());
        put_modes(m, lowest_modes(m, states, n, without.get()), n, frequency_hz, shape);
        return PLM_OK;
    });
}

plm_status plm_model_count_modes(plm_model *model, double frequency_hz, std::int64_t *count) {
    return call<ModelHandle>("plm_model_count_modes", model, [&](ModelHandle &m) {
        const plm::Model &core = *built(m);
        require_finite(frequency_hz, "frequency_hz");
        if (!(frequency_hz > 0)) bad_argument("frequency_hz", -1, "frequency_hz must be positive");
        require_pointer(count, "count");
        m.owner->watch().step("count of modes", 0); // a factorization, which hears nobody
        const std::int64_t below = core.count_modes_below(2 * M_PI * frequency_hz);
        if (below == plm::cannot_tell_count)
            throw plm::Error(PLM_ERR_STATE, "the host's solver does not tell the inertia, by which modes are "
                                            "counted; hand the callback over, or build the model with a "
                                            "\"solver\" of the library's own")
                .argument("model");
        if (below == plm::hit_a_mode)
            throw plm::Error(PLM_ERR_SINGULAR,
                             "frequency_hz is a natural frequency to working precision; ask "
                             "a little above or below")
                .argument("frequency_hz");
        *count = below;
        return PLM_OK;
    });
}

plm_status plm_model_audit(plm_model *model, std::int64_t *count) {
    return call<ModelHandle>("plm_model_audit", model, [&](ModelHandle &m) {
        require_pointer(count, "count");
        m.findings = plm::audit(*built(m));
        m.n_findings = n_worth_a_look(m.findings);
        *count = static_cast<std::int64_t>(m.findings.size());
        return PLM_OK;
    });
}

plm_status plm_model_get_finding(plm_model *model, std::int64_t index, std::int32_t *severity, double *value,
                                 std::int64_t capacity, char *buffer, std::int64_t *needed) {
    return call<ModelHandle>("plm_model_get_finding", model, [&](ModelHandle &m) {
        if (m.findings.empty())
            throw plm::Error(PLM_ERR_STATE, "there are no findings yet; audit the model first");
        require_range(index, 0, static_cast<std::int64_t>(m.findings.size()) - 1, "index");
        require_pointer(severity, "severity");
        require_pointer(value, "value");
        const plm::Finding &f = m.findings[static_cast<std::size_t>(index)];
        put_text(f.text, capacity, buffer, needed);
        *severity = f.severity, *value = f.value;
        return PLM_OK;
    });
}
