// A scene of the host's FE code at the test suite's size, its sampler, and the peak of its response on any
// basis.
#pragma once
#include "capi/handles.hpp"
#include "reduction/basis.hpp"
#include "searches/hbm.hpp"
extern "C" {
#include "scene_model.h"
}

namespace test {

class Host {
  public:
    Host(const char *name, bool with_preload, int n_samples) {
        if (!scene_create(name, "quick", with_preload, &host_)) sample(n_samples);
    }
    /// Owns the scene.
    Host(scene *host, int n_samples) : host_(host) { sample(n_samples); }
    ~Host() {
        model_ = nullptr;
        sampler_ = nullptr;
        plm_context_destroy(&context_);
        scene_destroy(&host_);
    }
    Host(const Host &) = delete;

    std::shared_ptr<const plm::Basis> basis(const plm::BasisOptions &o) const {
        return std::make_shared<plm::Basis>(model_, sampler_, nullptr, o, plm::Watch());
    }
    static plm::HbmOptions options() {
        plm::HbmOptions o;
        o.n_harmonics = 5; // the paper's
        o.stability = plm::StabilityKind::off;
        return o;
    }
    plm::Peak peak(const plm::Basis &basis) const {
        const plm::Hbm hbm(basis.reduced(), basis.window_min_hz(), basis.window_max_hz(), options(),
                           plm::Watch());
        return hbm.find_peak(*hbm.sweep(), host_->output_dof, plm::Measure::half_peak_to_peak, 0);
    }
    const std::shared_ptr<const plm::Model> &model() const { return model_; }
    const std::shared_ptr<const plm::Sampler> &sampler() const { return sampler_; }
    std::int64_t output_dof() const { return host_->output_dof; }

  private:
    void sample(int n_samples) {
        if (plm_context_create(PLM_API_VERSION, &context_)) return;
        plm_model *model = nullptr;
        must(context_, scene_to_model(context_, host_, &model), "model");
        model_ = plm::capi::find<plm::capi::ModelHandle>(model)->core;
        plm::SamplerOptions o;
        o.system = host_->dominant_system ? plm::LinearSystem::sliding : plm::LinearSystem::open;
        o.mode = host_->dominant_mode;
        o.n_samples = n_samples;
        sampler_ = std::make_shared<plm::Sampler>(model_, o, plm::Watch());
    }

    scene *host_ = nullptr;
    plm_context *context_ = nullptr;
    std::shared_ptr<const plm::Model> model_;
    std::shared_ptr<const plm::Sampler> sampler_;
};

} // namespace test
