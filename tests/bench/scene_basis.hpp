// A basis of piecewise-linear modes of one of the examples' scenes, with nothing set.
#pragma once
#include "capi/handles.hpp"
extern "C" {
#include "scene.h"
#include "scene_model.h"
}

struct SceneBasis {
    SceneBasis(const char *name, const char *size, bool with_preload) {
        plm_model *model = nullptr;
        plm_sampler *sampler = nullptr;
        plm_basis *basis = nullptr;
        if (scene_create(name, size, with_preload, &host)) return;
        must(nullptr, plm_context_create(PLM_API_VERSION, &context), "context");
        must(context, scene_to_model(context, host, &model), "model");
        must(context, plm_sampler_create(model, &sampler), "sampler");
        must(context, plm_sampler_run(sampler), "sampler");
        must(context, plm_basis_create(model, &basis), "basis");
        must(context, plm_basis_set_sampler(basis, sampler), "basis");
        must(context, plm_basis_build(basis), "basis");
        core = plm::capi::find<plm::capi::BasisHandle>(basis)->core;
    }
    ~SceneBasis() {
        core.reset();
        if (context) plm_context_destroy(&context);
        scene_destroy(&host);
    }
    SceneBasis(const SceneBasis &) = delete;
    SceneBasis &operator=(const SceneBasis &) = delete;

    plm_context *context = nullptr;
    scene *host = nullptr;
    std::shared_ptr<const plm::Basis> core; // null: there is no such scene
};
