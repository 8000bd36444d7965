// What stands behind each handle: the options, the parents, and after build/run/sweep the immutable core
// object.
#pragma once
#include "capi/context.hpp"
#include "capi/recovery.hpp"
#include "capi/surfaces.hpp"
#include "motions/branch_report.hpp"
#include "orbits/transient.hpp"
#include "reduction/basis.hpp"
#include "sampling/sampler.hpp"
#include "searches/hbm.hpp"
#include "searches/isolated.hpp"
#include "searches/larger_motion.hpp"
#include "space/audit.hpp"
#include "space/memory_estimate.hpp"
#include "space/rest.hpp"
#include "study/study.hpp"
#include <optional>

namespace plm::capi {

template <class Opaque_, Kind kind_> struct HandleOf : Object {
    using Opaque = Opaque_;
    static constexpr Kind the_kind = kind_;
    explicit HandleOf(std::shared_ptr<Context> c) : Object(kind_, std::move(c)) {}
    Context &context() const { return *owner; }
};

struct ModelHandle final : HandleOf<plm_model, Kind::model> {
    ModelHandle(std::shared_ptr<Context> c, std::int64_t n_dof) : HandleOf(std::move(c)) {
        input.n_dof = n_dof;
        input.outputs = outputs;
    }
    void *options() override { return &space_options; }
    /// DOFs, and sums of them numbered on from there.
    std::int64_t n_outputs() const { return input.n_dof + static_cast<std::int64_t>(outputs->size()); }
    const char *frozen() const override {
        return core ? "the model is built and no longer changes; make a new one" : nullptr;
    }

    std::shared_ptr<std::vector<DofTerms>> outputs = std::make_shared<std::vector<DofTerms>>();
    ModelInput input;                       // after the build: what acts, which may still be changed
    std::shared_ptr<SolverBinding> binding; // of the host's solver that factored, or null
    SpaceOptions space_options;
    std::shared_ptr<const Model> core;
    std::shared_ptr<const Space> space; // for modes and rest, made when first needed
    std::shared_ptr<const RestState> rest;
    std::vector<Finding> findings;
    std::optional<MemoryEstimate> memory;
    std::int64_t n_findings = 0;          // worth a look, of the build or of the last audit
    Warnings warnings;                    // of the build
    Recovery recovery;                    // of a superelement
    std::int64_t n_untied = 0;            // nodes that ties left free
    double tie_distance = 0;              // largest of those tied
    std::vector<ContactSurface> surfaces; // until the build
    SurfaceReport surface_report;
};

struct SamplerHandle final : HandleOf<plm_sampler, Kind::sampler> {
    SamplerHandle(std::shared_ptr<Context> c, std::shared_ptr<ModelHandle> m)
        : HandleOf(std::move(c)), model(std::move(m)) {}
    void *options() override { return &sampler_options; }

    std::shared_ptr<ModelHandle> model;
    SamplerOptions sampler_options;
    std::shared_ptr<const Sampler> core;
    double work = 0; // that it took, flops
};

struct BasisHandle final : HandleOf<plm_basis, Kind::basis> {
    BasisHandle(std::shared_ptr<Context> c, std::shared_ptr<ModelHandle> m)
        : HandleOf(std::move(c)), model(std::move(m)) {}
    void *options() override { return &basis_options; }

    std::shared_ptr<ModelHandle> model;
    std::shared_ptr<SamplerHandle> sampler;
    std::shared_ptr<const Basis> parent;        // as it was when it was set
    std::shared_ptr<const Responses> responses; // for kind pod
    BasisOptions basis_options;
    double work = 0; // that it and its sampler took, flops
    std::shared_ptr<const Basis> core;
    bool is_read = false; // from bytes: there is no model to build it on again
};

/// A curve found by a search, and the force scales between which it exists (NaN: unknown).
struct FoundBranch {
    std::shared_ptr<const Branch> branch;
    double force_low, force_high;
};

struct HbmHandle final : HandleOf<plm_hbm, Kind::hbm> {
    HbmHandle(std::shared_ptr<Context> c, std::shared_ptr<BasisHandle> b)
        : HandleOf(std::move(c)), basis(std::move(b)) {}
    void *options() override { return &hbm_options; }

    std::shared_ptr<BasisHandle> basis;
    HbmOptions hbm_options;
    std::int64_t save_every = 0; // points of a sweep, to save_path; 0: never
    std::string save_path;
    std::vector<FoundBranch> found;     // by the last plm_hbm_find_..., or beside the curve of the one call
    std::optional<LargerMotion> larger; // beside that curve
    Warnings warnings;                  // of the last call that computed something
};

struct BranchHandle final : HandleOf<plm_branch, Kind::branch> {
    BranchHandle(std::shared_ptr<Context> c, std::shared_ptr<const Branch> b)
        : HandleOf(std::move(c)), core(std::move(b)) {}

    std::shared_ptr<const Branch> core;
    /// By the calls that looked for its peak, shared with that; null: none has.
    std::shared_ptr<CurveFindings> found;
};

struct TransientHandle final : HandleOf<plm_transient, Kind::transient> {
    TransientHandle(std::shared_ptr<Context> c, std::shared_ptr<ModelHandle> m,
                    std::shared_ptr<BasisHandle> b)
        : HandleOf(std::move(c)), model(std::move(m)), basis(std::move(b)) {}
    void *options() override { return &transient_options; }

    std::shared_ptr<ModelHandle> model;
    std::shared_ptr<BasisHandle> basis; // null: the full model
    TransientOptions transient_options;
    vector<std::int64_t> observed;   // DOFs, base 0
    std::unique_ptr<Transient> core; // made when first needed, of the basis as it is then
    std::shared_ptr<const Model> made_of;
    std::optional<TransientRun> last_run;
    std::optional<PeriodicMotion> periodic; // of the last search from the present start
};

struct StudyHandle final : HandleOf<plm_study, Kind::study> {
    StudyHandle(std::shared_ptr<Context> c, std::shared_ptr<ModelHandle> m)
        : HandleOf(std::move(c)), model(std::move(m)) {}
    void *options() override { return &plan.options; }

    std::shared_ptr<ModelHandle> model;
    StudyPlan plan;
    std::optional<StudyResult> result; // of the last run
};

/// The built core of a handle; PLM_ERR_STATE with what to call when it does not exist yet.
const std::shared_ptr<const Model> &built(const ModelHandle &h);
const std::shared_ptr<const Sampler> &built(const SamplerHandle &h);
const std::shared_ptr<const Basis> &built(const BasisHandle &h);
const std::shared_ptr<const Branch> &built(const BranchHandle &h);

/// Of the model's build and of the run: samples of a model that is not meant so are not meant so.
Warnings warnings_of(const SamplerHandle &h);

/// Of the model as it is, or PLM_ERR_STATE: its loads, damping or walls were changed after this was made.
/// what: "sampler"; again: how to renew it.
void require_current(const std::shared_ptr<const Model> &made_of, const ModelHandle &model, const char *what,
                     const char *again);
/// The same of a basis.
void require_current(const BasisHandle &h);

/// The rest state, solved when it is not known yet.
const RestState &solved_rest(ModelHandle &h);

} // namespace plm::capi
