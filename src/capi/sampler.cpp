#include "capi/arguments.hpp"
#include "capi/barrier.hpp"
#include "capi/handles.hpp"

namespace plm::capi {

const std::shared_ptr<const Sampler> &built(const SamplerHandle &h) {
    if (!h.core) throw Error(PLM_ERR_STATE, "the sampler has not run; run it first").argument("sampler");
    return h.core;
}

Warnings warnings_of(const SamplerHandle &h) {
    const Sampler &core = *built(h);
    Warnings all = h.model->warnings;
    all.add(core.warnings());
    return all;
}

} // namespace plm::capi

using namespace plm::capi;

plm_status plm_sampler_create(plm_model *model, plm_sampler **sampler) {
    return call<ModelHandle>("plm_sampler_create", model, [&](ModelHandle &m) {
        require_pointer(sampler, "sampler");
        *sampler = publish(std::make_shared<SamplerHandle>(m.owner, find<ModelHandle>(model)));
        return PLM_OK;
    });
}

plm_status plm_sampler_destroy(plm_sampler **sampler) {
    return destroy<SamplerHandle>(sampler);
}

plm_status plm_sampler_add_dominant_mode(plm_sampler *sampler, std::int32_t system, std::int64_t mode) {
    return call<SamplerHandle>("plm_sampler_add_dominant_mode", sampler, [&](SamplerHandle &s) {
        require_range(system, PLM_SYSTEM_OPEN, PLM_SYSTEM_REST, "system");
        require_range(mode, 1, 1000000, "mode");
        s.sampler_options.extra.push_back({static_cast<plm::LinearSystem>(system), mode});
        return PLM_OK;
    });
}

plm_status plm_sampler_run(plm_sampler *sampler) {
    return call<SamplerHandle>("plm_sampler_run", sampler, [&](SamplerHandle &s) {
        const std::shared_ptr<const plm::Model> &model = built(*s.model);
        if (model->n_pairs() == 0)
            throw plm::Error(PLM_ERR_STATE,
                             "the model has no contact pair, so there is no contact area to sample; use "
                             "a basis of kind full or craig_bampton")
                .argument("sampler");
        const std::int64_t before = plm::work_done();
        s.core =
            std::make_shared<const plm::Sampler>(model, s.sampler_options, s.owner->watch(), s.model->space);
        s.work = static_cast<double>(plm::work_done() - before);
        s.model->space = s.core->space(); // the next sampler of this model starts from it
        if (!s.model->rest) s.model->rest = plm::rest_of(*s.core->space());
        return Outcome(warnings_of(s));
    });
}
