#include "capi/arguments.hpp"
#include "capi/barrier.hpp"
#include "capi/handles.hpp"
#include "linalg/scale.hpp"
#include "motions/responses.hpp"
#include "reduction/basis_kind.hpp"
#include "reduction/compression.hpp"

namespace plm::capi {

const std::shared_ptr<const Basis> &built(const BasisHandle &h) {
    if (!h.core) throw Error(PLM_ERR_STATE, "the basis is not built; build it first").argument("basis");
    return h.core;
}

void require_current(const BasisHandle &h) {
    if (h.core) require_current(h.core->model(), *h.model, "basis", "build it again");
}

namespace {

/// The sampler's result; null when the kind of basis does without.
std::shared_ptr<const Sampler> run_sampler(const BasisHandle &b) {
    const bool needed = b.basis_options.kind->needs_sampler;
    if (!b.sampler) {
        if (needed)
            throw Error(PLM_ERR_STATE, "a basis of this kind needs a sampler; give it one first")
                .argument("sampler");
        return nullptr;
    }
    if (needed) built(*b.sampler);
    if (b.sampler->core)
        require_current(b.sampler->core->space()->model, *b.model, "sampler", "run it again");
    return b.sampler->core;
}

void require_same_model(const ModelHandle *one, const ModelHandle *other, const char *name) {
    if (one != other) bad_argument(name, -1, format("the %s is of another model; make both from one", name));
}

} // namespace
} // namespace plm::capi

using namespace plm::capi;

plm_status plm_basis_create(plm_model *model, plm_basis **basis) {
    return call<ModelHandle>("plm_basis_create", model, [&](ModelHandle &m) {
        require_pointer(basis, "basis");
        *basis = publish(std::make_shared<BasisHandle>(m.owner, find<ModelHandle>(model)));
        return PLM_OK;
    });
}

plm_status plm_basis_destroy(plm_basis **basis) {
    return destroy<BasisHandle>(basis);
}

plm_status plm_basis_set_sampler(plm_basis *basis, plm_sampler *sampler) {
    return call<BasisHandle>("plm_basis_set_sampler", basis, [&](BasisHandle &b) {
        std::shared_ptr<SamplerHandle> s = same_context<SamplerHandle>(b, sampler, "sampler");
        require_same_model(b.model.get(), s->model.get(), "sampler");
        b.sampler = std::move(s);
        return PLM_OK;
    });
}

plm_status plm_basis_set_parent(plm_basis *basis, plm_basis *parent) {
    return call<BasisHandle>("plm_basis_set_parent", basis, [&](BasisHandle &b) {
        if (!parent) {
            b.parent = nullptr;
            return PLM_OK;
        }
        const std::shared_ptr<BasisHandle> p = same_context<BasisHandle>(b, parent, "parent");
        require_same_model(b.model.get(), p->model.get(), "parent");
        const std::shared_ptr<const plm::Basis> &core = built(*p);
        b.parent = core;
        return PLM_OK;
    });
}

plm_status plm_basis_set_responses(plm_basis *basis, std::int64_t n, plm_branch *const *branch) {
    return call<BasisHandle>("plm_basis_set_responses", basis, [&](BasisHandle &b) {
        require_range(n, 0, 1 << 20, "n");
        if (n > 0) require_pointer(branch, "branch");
        std::vector<std::shared_ptr<const plm::Branch>> curves;
        for (std::int64_t i = 0; i < n; ++i) {
            const std::shared_ptr<BranchHandle> curve = same_context<BranchHandle>(b, branch[i], "branch", i);
            if (i > 0 && plm::uncompressed(curve->core->reduced_model()) !=
                             plm::uncompressed(curves[0]->reduced_model()))
                bad_argument("branch", i,
                             "all branches must have been computed on one basis, this one was on another");
            curves.push_back(curve->core);
        }
        b.responses = n > 0 ? std::make_shared<const plm::Responses>(plm::responses_of(curves)) : nullptr;
        return PLM_OK;
    });
}

plm_status plm_basis_build(plm_basis *basis) {
    return call<BasisHandle>("plm_basis_build", basis, [&](BasisHandle &b) {
        if (b.is_read)
            throw plm::Error(PLM_ERR_STATE, "the basis was read from bytes, and is built; to build it anew "
                                            "attach its model first")
                .argument("basis");
        const std::shared_ptr<const plm::Model> &model = built(*b.model);
        if (b.parent)
            require_current(b.parent->model(), *b.model, "parent",
                            "build the parent again, and set it as the parent again");
        const std::int64_t before = plm::work_done();
        b.core = std::make_shared<const plm::Basis>(model, run_sampler(b), b.parent, b.basis_options,
                                                    b.owner->watch(), b.responses.get());
        b.work = static_cast<double>(plm::work_done() - before) + (b.sampler ? b.sampler->work : 0);
        return Outcome(b.core->report().warnings);
    });
}

plm_status plm_basis_get_vectors(plm_basis *basis, std::int32_t is_static, std::int64_t first, std::int64_t n,
                                 double *vector, std::int64_t ld) {
    return call<BasisHandle>("plm_basis_get_vectors", basis, [&](BasisHandle &b) {
        const plm::Basis &core = *built(b);
        const plm::Model &model = *core.model();
        require_range(is_static, 0, 1, "is_static");
        const plm::SpaceVectors &p = is_static ? core.reduced()->static_vectors() : core.reduced()->vectors;
        require_range(first, 0, p.cols(), "first");
        require_range(n, 0, p.cols() - first, "n");
        require_range(ld, model.n_dof(), INT64_MAX / 64, "ld");
        if (n > 0) require_pointer(vector, "vector");
        const plm::Field some = columns(p, first, n);
        plm::require_finite_result(some, "vector");
        for (std::int64_t j = 0; j < n; ++j) model.expand(some, j, vector + j * ld);
        return PLM_OK;
    });
}

plm_status plm_basis_get_residual(plm_basis *basis, std::int32_t is_static, std::int32_t use_mass,
                                  std::int64_t n, const double *q, double *r) {
    return call<BasisHandle>("plm_basis_get_residual", basis, [&](BasisHandle &b) {
        const plm::Basis &core = *built(b);
        const plm::Model &model = *core.model();
        require_range(is_static, 0, 1, "is_static");
        require_range(use_mass, 0, 1, "use_mass");
        require_range(n, model.n_dof(), model.n_dof(), "n");
        require_finite_array(q, n, "q");
        require_pointer(r, "r");
        const double found =
            plm::projection_residual(core, is_static != 0, use_mass != 0, model.restricted(q));
        plm::require_finite_result(&found, 1, "r");
        *r = found;
        return PLM_OK;
    });
}
