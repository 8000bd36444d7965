#include "capi/arguments.hpp"
#include "capi/barrier.hpp"
#include "capi/keys.hpp"
#include "capi/study_results.hpp"
#include "orbits/make_transient.hpp"
#include "reduction/basis_kind.hpp"

namespace plm::capi {
namespace {

constexpr const char *reference_name = "reference";

void add_text(std::string &all, const char *what, const std::string &text) {
    if (!text.empty()) all += (all.empty() ? "" : "; ") + (what + (": " + text));
}

std::string name_for(const StudyHandle &s, const char *name) {
    require_pointer(name, "name");
    if (!*name) bad_argument("name", -1, "the name is empty; every method needs one of its own");
    bool used = name == std::string(reference_name);
    for (const MethodPlan &m : s.plan.methods) used = used || m.name == name;
    if (used)
        bad_argument("name", -1, format("the name \"%.80s\" is taken; give every method its own", name));
    return name;
}

/// The options of a basis and of its sampler and parent, as they are now.
void read_basis(const BasisHandle &b, MethodPlan &method) {
    Recipe &recipe = method.recipe;
    if (b.basis_options.kind->is_compressed())
        bad_argument("hbm", -1,
                     "its basis is of kind pod, which options alone do not make; add the method it is "
                     "compressed from, to be compressed or refined");
    recipe.basis = b.basis_options;
    if (b.sampler) {
        recipe.sampler = b.sampler->sampler_options;
        add_text(method.options_text, "sampler", changed_options(Kind::sampler, &*recipe.sampler));
        if (const std::size_t n = recipe.sampler->extra.size(); n > 0)
            add_text(method.options_text, "further dominant modes", std::to_string(n));
    }
    if (b.parent && recipe.basis.kind->is_collected()) {
        ParentRecipe parent{b.parent->options(), std::nullopt};
        if (b.parent->sampler()) parent.sampler = b.parent->sampler()->options();
        add_text(method.options_text, "parent", changed_options(Kind::basis, &parent.basis));
        recipe.parent = std::make_shared<const ParentRecipe>(std::move(parent));
    }
    add_text(method.options_text, "basis", changed_options(Kind::basis, &recipe.basis));
}

void require_own_model(const StudyHandle &s, const ModelHandle *model, const char *argument) {
    if (model != s.model.get())
        bad_argument(argument, -1,
                     format("the %s is of another model than the study; make both from one", argument));
}

MethodPlan read_hbm(const StudyHandle &s, plm_hbm *hbm, MethodKind kind) {
    const std::shared_ptr<HbmHandle> h = same_context<HbmHandle>(s, hbm, "hbm");
    require_own_model(s, h->basis->model.get(), "hbm");
    MethodPlan method;
    method.kind = kind;
    read_basis(*h->basis, method);
    method.recipe.hbm = h->hbm_options;
    add_text(method.options_text, "hbm", changed_options(Kind::hbm, &method.recipe.hbm));
    return method;
}

void add(StudyHandle &s, std::string name, MethodPlan method, std::int64_t *index) {
    method.name = std::move(name);
    s.plan.methods.push_back(std::move(method));
    if (index) *index = static_cast<std::int64_t>(s.plan.methods.size()) - 1;
}

const MethodResult &row_of(const StudyHandle &s, std::int64_t index) {
    const StudyResult &result = last_run(s);
    require_range(index, -1, static_cast<std::int64_t>(result.methods.size()) - 1, "index");
    return index < 0 ? result.reference : result.methods[static_cast<std::size_t>(index)];
}

/// Of a method that did not fail.
const MethodResult &measured(const StudyHandle &s, std::int64_t index, std::int64_t level) {
    const MethodResult &row = row_of(s, index);
    require_range(level, 0, static_cast<std::int64_t>(last_run(s).levels.size()) - 1, "level");
    if (row.failed)
        throw Error(PLM_ERR_STATE,
                    format("the method \"%.80s\" has no curve: %s", row.name.c_str(), row.outcome.c_str()))
            .argument("index");
    return row;
}

Outcome outcome_of(const StudyResult &result) {
    if (result.cancelled) return PLM_CANCELLED;
    std::string incomplete;
    const auto look_at = [&](const char *what, const MethodResult &r) {
        if (!r.failed && r.complete) return;
        incomplete += format("%s%s \"%.80s\": %s", incomplete.empty() ? "" : "; ", what, r.name.c_str(),
                             r.outcome.c_str());
    };
    look_at("the reference", result.reference);
    for (const MethodResult &r : result.methods) look_at("the method", r);
    if (incomplete.empty()) return PLM_OK;
    return {PLM_WARNING, PLM_REASON_NONE, incomplete};
}

} // namespace
} // namespace plm::capi

using namespace plm::capi;

plm_status plm_study_create(plm_model *model, plm_study **study) {
    return call<ModelHandle>("plm_study_create", model, [&](ModelHandle &m) {
        require_pointer(study, "study");
        if (!plm::study_is_built()) { // says which option
            plm::KnownSpace none;
            plm::run_study(nullptr, {}, plm::Watch(), none);
        }
        *study = publish(std::make_shared<StudyHandle>(m.owner, find<ModelHandle>(model)));
        return PLM_OK;
    });
}

plm_status plm_study_destroy(plm_study **study) {
    return destroy<StudyHandle>(study);
}

plm_status plm_study_set_output(plm_study *study, std::int64_t dof, std::int32_t measure,
                                std::int32_t harmonic) {
    return call<StudyHandle>("plm_study_set_output", study, [&](StudyHandle &s) {
        require_range(dof, 0, s.model->n_outputs() - 1, "dof");
        require_range(measure, PLM_PEAK, PLM_HARMONIC, "measure");
        if (measure == PLM_HARMONIC) require_range(harmonic, 0, 1000000, "harmonic");
        s.plan.output = plm::Output{dof, static_cast<plm::Measure>(measure), harmonic};
        return PLM_OK;
    });
}

plm_status plm_study_set_force_levels(plm_study *study, std::int64_t n, const double *scale) {
    return call<StudyHandle>("plm_study_set_force_levels", study, [&](StudyHandle &s) {
        require_range(n, 1, 1 << 20, "n");
        require_finite_array(scale, n, "scale");
        for (std::int64_t i = 0; i < n; ++i)
            if (!(scale[i] > 0))
                bad_argument(
                    "scale", i,
                    plm::format("scale[%lld] is %g; it must be > 0", static_cast<long long>(i), scale[i]));
        s.plan.levels.assign(scale, scale + n);
        return PLM_OK;
    });
}

plm_status plm_study_set_reference(plm_study *study, plm_hbm *hbm) {
    return call<StudyHandle>("plm_study_set_reference", study, [&](StudyHandle &s) {
        if (hbm)
            s.plan.reference = read_hbm(s, hbm, plm::MethodKind::response);
        else
            s.plan.reference.reset();
        return PLM_OK;
    });
}

plm_status plm_study_add_response(plm_study *study, const char *name, plm_hbm *hbm, std::int64_t *index) {
    return call<StudyHandle>("plm_study_add_response", study, [&](StudyHandle &s) {
        plm::MethodPlan method = read_hbm(s, hbm, plm::MethodKind::response);
        add(s, name_for(s, name), std::move(method), index);
        return PLM_OK;
    });
}

plm_status plm_study_add_compressed(plm_study *study, const char *name, plm_hbm *hbm, std::int64_t size,
                                    std::int64_t *index) {
    return call<StudyHandle>("plm_study_add_compressed", study, [&](StudyHandle &s) {
        plm::MethodPlan method = read_hbm(s, hbm, plm::MethodKind::compressed);
        std::string own = name_for(s, name);
        require_range(size, 0, 1000000000, "size");
        method.size = size;
        add_text(method.options_text, "compressed",
                 size > 0 ? std::to_string(size) + " columns" : "by pod_tolerance");
        add(s, std::move(own), std::move(method), index);
        return PLM_OK;
    });
}

plm_status plm_study_add_refined(plm_study *study, const char *name, plm_hbm *hbm, double tolerance,
                                 std::int64_t *index) {
    return call<StudyHandle>("plm_study_add_refined", study, [&](StudyHandle &s) {
        plm::MethodPlan method = read_hbm(s, hbm, plm::MethodKind::refined);
        std::string own = name_for(s, name);
        require_finite(tolerance, "tolerance");
        if (!(tolerance > 0 && tolerance < 1))
            bad_argument("tolerance", -1,
                         plm::format("tolerance is %g; a relative error in (0, 1) is wanted", tolerance));
        method.tolerance = tolerance;
        add_text(method.options_text, "refined", plm::format("tolerance %g", tolerance));
        add(s, std::move(own), std::move(method), index);
        return PLM_OK;
    });
}

plm_status plm_study_add_marching(plm_study *study, const char *name, plm_transient *transient,
                                  std::int64_t n_frequencies, std::int64_t *index) {
    return call<StudyHandle>("plm_study_add_marching", study, [&](StudyHandle &s) {
        if (!plm::transient_is_built()) plm::make_transient(nullptr, nullptr); // says which option
        const std::shared_ptr<TransientHandle> t = same_context<TransientHandle>(s, transient, "transient");
        require_own_model(s, t->model.get(), "transient");
        std::string own = name_for(s, name);
        require_range(n_frequencies, 1, 1 << 20, "n_frequencies");
        plm::MethodPlan method;
        method.kind = plm::MethodKind::marching;
        method.reduced = t->basis != nullptr;
        if (t->basis) read_basis(*t->basis, method);
        method.transient = t->transient_options;
        method.n_frequencies = n_frequencies;
        add_text(method.options_text, "transient", changed_options(Kind::transient, &method.transient));
        add_text(method.options_text, "marching",
                 plm::format("%s model, %lld frequencies", method.reduced ? "reduced" : "full",
                             static_cast<long long>(n_frequencies)));
        add(s, std::move(own), std::move(method), index);
        return PLM_OK;
    });
}

plm_status plm_study_run(plm_study *study) {
    return call<StudyHandle>("plm_study_run", study, [&](StudyHandle &s) {
        s.result = plm::run_study(built(*s.model), s.plan, s.owner->watch(), s.model->space);
        return outcome_of(*s.result);
    });
}

plm_status plm_study_get_name(plm_study *study, std::int64_t index, std::int64_t capacity, char *buffer,
                              std::int64_t *needed) {
    return call<StudyHandle>("plm_study_get_name", study, [&](StudyHandle &s) {
        require_range(index, -1, static_cast<std::int64_t>(s.plan.methods.size()) - 1, "index");
        return put_text(index < 0 ? reference_name : s.plan.methods[static_cast<std::size_t>(index)].name,
                        capacity, buffer, needed);
    });
}

plm_status plm_study_get_outcome(plm_study *study, std::int64_t index, std::int64_t capacity, char *buffer,
                                 std::int64_t *needed) {
    return call<StudyHandle>("plm_study_get_outcome", study, [&](StudyHandle &s) {
        return put_text(row_of(s, index).outcome, capacity, buffer, needed);
    });
}

plm_status plm_study_get_curve(plm_study *study, std::int64_t index, std::int64_t level,
                               plm_branch **branch) {
    return call<StudyHandle>("plm_study_get_curve", study, [&](StudyHandle &s) {
        const plm::MethodResult &row = measured(s, index, level);
        require_pointer(branch, "branch");
        if (row.curves.empty())
            throw plm::Error(
                PLM_ERR_STATE,
                plm::format("the method \"%.80s\" marches in time and has points, no branch; read its points",
                            row.name.c_str()))
                .argument("index");
        *branch =
            publish(std::make_shared<BranchHandle>(s.owner, row.curves[static_cast<std::size_t>(level)]));
        return PLM_OK;
    });
}

plm_status plm_study_get_points(plm_study *study, std::int64_t index, std::int64_t level,
                                std::int64_t capacity, double *frequency_hz, double *amplitude,
                                std::int64_t *count) {
    return call<StudyHandle>("plm_study_get_points", study, [&](StudyHandle &s) {
        const plm::PlaneSamples &points = measured(s, index, level).samples[static_cast<std::size_t>(level)];
        if (capacity > 0 || frequency_hz || amplitude) {
            require_pointer(frequency_hz, "frequency_hz");
            require_pointer(amplitude, "amplitude");
        }
        put_array(points.hz, capacity, frequency_hz, count);
        return put_array(points.amplitude, capacity, amplitude, count);
    });
}

plm_status plm_study_write(plm_study *study, const char *folder) {
    return call<StudyHandle>("plm_study_write", study, [&](StudyHandle &s) {
        require_pointer(folder, "folder");
        plm::write_study(last_run(s), folder);
        return PLM_OK;
    });
}
