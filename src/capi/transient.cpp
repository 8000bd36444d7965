#include "capi/arguments.hpp"
#include "capi/barrier.hpp"
#include "capi/branch_input.hpp"
#include "capi/model_input.hpp"
#include "capi/transient_results.hpp"
#include "linalg/scale.hpp"
#include "orbits/make_transient.hpp"
#include "orbits/orbit_point.hpp"
#include <algorithm>

namespace plm::capi {
namespace {

/// Of the model and the basis as they are now, once.
Transient &core(TransientHandle &h) {
    if (!h.core) {
        const std::shared_ptr<const Model> &model = built(*h.model);
        if (h.basis) require_current(*h.basis);
        h.core = make_transient(model, h.basis ? built(*h.basis)->reduced() : nullptr);
        h.made_of = model;
    }
    require_current(h.made_of, *h.model, "transient", "make a new one, and hand its state over");
    return *h.core;
}

void require_n_dof(const TransientHandle &h, std::int64_t n) {
    const std::int64_t n_dof = h.model->input.n_dof;
    require_range(n, n_dof, n_dof, "n");
}

template <class Index>
plm_status observe(const char *function, plm_transient *transient, std::int32_t index_base, std::int64_t n,
                   const Index *dof) {
    return call<TransientHandle>(function, transient, [&](TransientHandle &t) {
        require_index_base(index_base);
        require_range(n, 0, INT64_MAX / 64, "n");
        if (n > 0) require_pointer(dof, "dof");
        vector<std::int64_t> observed;
        for (std::int64_t i = 0; i < n; ++i) {
            require_dof(dof[i], index_base, t.model->n_outputs(), "dof", i);
            observed.push_back(dof[i] - index_base);
        }
        t.observed = std::move(observed);
        return PLM_OK;
    });
}

} // namespace

} // namespace plm::capi

using namespace plm::capi;

plm_status plm_transient_create(plm_model *model, plm_basis *basis, plm_transient **transient) {
    return call<ModelHandle>("plm_transient_create", model, [&](ModelHandle &m) {
        std::shared_ptr<BasisHandle> b;
        if (basis) b = same_context<BasisHandle>(m, basis, "basis");
        if (b && b->model.get() != &m)
            bad_argument("basis", -1, "the basis is of another model; make both from one");
        require_pointer(transient, "transient");
        if (!plm::transient_is_built()) plm::make_transient(nullptr, nullptr); // says which option
        *transient = publish(std::make_shared<TransientHandle>(m.owner, find<ModelHandle>(model), b));
        return PLM_OK;
    });
}

plm_status plm_transient_destroy(plm_transient **transient) {
    return destroy<TransientHandle>(transient);
}

plm_status plm_transient_observe_i32(plm_transient *transient, std::int32_t index_base, std::int64_t n,
                                     const std::int32_t *dof) {
    return observe("plm_transient_observe_i32", transient, index_base, n, dof);
}

plm_status plm_transient_observe_i64(plm_transient *transient, std::int32_t index_base, std::int64_t n,
                                     const std::int64_t *dof) {
    return observe("plm_transient_observe_i64", transient, index_base, n, dof);
}

namespace {

/// Supports left in the matrices do not move, whatever the state says.
void require_held_at_rest(const plm::Model &model, const double *values, const char *name) {
    for (std::int64_t dof : model.still_dofs().dof)
        if (values && values[dof] != 0)
            bad_argument(name, dof,
                         plm::format("DOF %lld is coupled to nothing and loaded by nothing, and is held at "
                                     "zero (the audit names all such DOFs): give it 0",
                                     static_cast<long long>(dof)));
}

} // namespace

plm_status plm_transient_set_state(plm_transient *transient, std::int64_t n, const double *q,
                                   const double *v) {
    return call<TransientHandle>("plm_transient_set_state", transient, [&](TransientHandle &t) {
        require_n_dof(t, n);
        if (q) require_finite_array(q, n, "q");
        if (v) require_finite_array(v, n, "v");
        require_held_at_rest(*built(*t.model), q, "q");
        require_held_at_rest(*built(*t.model), v, "v");
        core(t).set_state(q, v);
        t.periodic.reset();
        return PLM_OK;
    });
}

plm_status plm_transient_start_at(plm_transient *transient, plm_branch *branch, std::int64_t point) {
    return call<TransientHandle>("plm_transient_start_at", transient, [&](TransientHandle &t) {
        const std::shared_ptr<BranchHandle> b = same_context<BranchHandle>(t, branch, "branch");
        require_point(*b->core, point);
        const plm::BranchPoint &p = b->core->points()[static_cast<std::size_t>(point)];
        core(t).start_at(plm::start_of(*b->core, point));
        t.transient_options.frequency_hz = p.omega / (2 * M_PI);
        t.transient_options.force_scale = p.force_scale;
        t.transient_options.period_multiple = b->core->period_multiple();
        t.periodic.reset();
        return PLM_OK;
    });
}

plm_status plm_transient_run(plm_transient *transient) {
    return call<TransientHandle>("plm_transient_run", transient, [&](TransientHandle &t) {
        t.last_run = core(t).run(t.transient_options, t.observed, t.owner->watch());
        return t.last_run->cancelled ? PLM_CANCELLED : PLM_OK;
    });
}

plm_status plm_transient_find_periodic(plm_transient *transient) {
    return call<TransientHandle>("plm_transient_find_periodic", transient, [&](TransientHandle &t) {
        t.periodic = core(t).find_periodic(t.transient_options, t.owner->watch());
        if (t.periodic->converged) return Outcome(PLM_OK);
        return Outcome(
            PLM_NOT_CONVERGED, PLM_REASON_NONE,
            plm::format("no periodic motion was found near this state; the best one has the periodicity "
                        "defect %.1e. March more periods first, or start at a point of a curve",
                        t.periodic->defect));
    });
}

plm_status plm_transient_get_state(plm_transient *transient, std::int64_t n, double *q, double *v) {
    return call<TransientHandle>("plm_transient_get_state", transient, [&](TransientHandle &t) {
        require_n_dof(t, n);
        plm::vector<double> state(static_cast<std::size_t>(2 * n));
        (t.core ? *t.core : core(t)).get_state(state.data(), state.data() + n); // also when it is stale
        plm::require_finite_result(state.data(), 2 * n, "state");
        if (q) std::copy_n(state.data(), n, q);
        if (v) std::copy_n(state.data() + n, n, v);
        return PLM_OK;
    });
}

plm_status plm_transient_get_history(plm_transient *transient, std::int64_t observed, std::int64_t capacity,
                                     double *values, std::int64_t *count) {
    return call<TransientHandle>("plm_transient_get_history", transient, [&](TransientHandle &t) {
        const plm::TransientRun &run = last_run(t);
        const std::size_t n_observed = run.observed.size();
        if (n_observed == 0)
            throw plm::Error(PLM_ERR_STATE, "the last run recorded no DOF; say before the run "
                                            "which to observe")
                .argument("observed");
        require_range(observed, 0, static_cast<std::int64_t>(n_observed) - 1, "observed");
        plm::vector<double> history(run.time.size());
        for (std::size_t k = 0; k < history.size(); ++k)
            history[k] = run.values[k * n_observed + static_cast<std::size_t>(observed)];
        plm::require_finite_result(history.data(), static_cast<std::int64_t>(history.size()), "history");
        return put_array(history, capacity, values, count);
    });
}

plm_status plm_transient_get_multipliers(plm_transient *transient, std::int64_t capacity, double *real,
                                         double *imag, std::int64_t *count) {
    return call<TransientHandle>("plm_transient_get_multipliers", transient, [&](TransientHandle &t) {
        return put_complex_array(periodic_motion(t).multipliers, capacity, real, imag, count);
    });
}
