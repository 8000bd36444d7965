#include "study/recipe.hpp"
#include "reduction/basis_kind.hpp"

namespace plm {
namespace {

std::shared_ptr<const Sampler> run_sampler(const std::shared_ptr<const Model> &model,
                                           const SamplerOptions &options, Watch watch, KnownSpace &space) {
    if (model->n_pairs() == 0)
        throw Error(status::state,
                    "the model has no contact pair, so there is no contact area to sample; use a basis "
                    "of kind full or craig_bampton")
            .argument("sampler");
    auto sampler = std::make_shared<const Sampler>(model, options, watch, space);
    space = sampler->space();
    return sampler;
}

// A basis that is not of kind plm takes nothing but the window from a sampler.
BasisOptions with_window(const std::shared_ptr<const Model> &model, BasisOptions basis,
                         const std::optional<SamplerOptions> &sampler, Watch watch, KnownSpace &space) {
    if (!sampler || (basis.frequency_min_hz > 0 && basis.frequency_max_hz > 0)) return basis;
    const FrequencyWindow window = run_sampler(model, *sampler, watch, space)->window();
    if (!(basis.frequency_min_hz > 0)) basis.frequency_min_hz = window.min_hz;
    if (!(basis.frequency_max_hz > 0)) basis.frequency_max_hz = window.max_hz;
    return basis;
}

} // namespace

void take_accuracy(double accuracy, HbmOptions &hbm) {
    if (hbm.accuracy == HbmOptions().accuracy) hbm.accuracy = accuracy;
}

Recipe with_window(const std::shared_ptr<const Model> &model, const Recipe &recipe, Watch watch,
                   KnownSpace &space) {
    Recipe r = recipe;
    if (r.basis.kind->needs_sampler) return r;
    r.basis = with_window(model, r.basis, r.sampler, watch, space);
    r.sampler.reset();
    r.parent.reset();
    return r;
}

FrequencyRange range_of(const std::shared_ptr<const Model> &model, const Recipe &recipe, Watch watch,
                        KnownSpace &space) {
    const BasisOptions basis = with_window(model, recipe.basis, recipe.sampler, watch, space);
    const HbmOptions &hbm = recipe.hbm;
    const FrequencyRange range{hbm.frequency_min_hz > 0 ? hbm.frequency_min_hz : basis.frequency_min_hz,
                               hbm.frequency_max_hz > 0 ? hbm.frequency_max_hz : basis.frequency_max_hz};
    if (!(range.low_hz > 0 && range.high_hz > range.low_hz))
        throw Error(status::state,
                    format("the frequency range [%g, %g] Hz of the study is empty or not positive; set "
                           "frequency_min_hz and frequency_max_hz of the reference's hbm or basis, or "
                           "give its basis a sampler",
                           range.low_hz, range.high_hz))
            .argument("frequency_min_hz");
    return range;
}

std::shared_ptr<const Basis> build(const std::shared_ptr<const Model> &model, const Recipe &recipe,
                                   Watch watch, KnownSpace &space) {
    if (recipe.basis.kind->needs_sampler && !recipe.sampler)
        throw Error(status::state,
                    format("a basis of kind %s needs a sampler; give the basis one", recipe.basis.kind->name))
            .argument("sampler");
    std::shared_ptr<const Basis> parent;
    if (recipe.parent) {
        const BasisOptions basis =
            with_window(model, recipe.parent->basis, recipe.parent->sampler, watch, space);
        parent = std::make_shared<const Basis>(model, nullptr, nullptr, basis, watch, nullptr, space);
    }
    const auto sampler = recipe.sampler ? run_sampler(model, *recipe.sampler, watch, space) : nullptr;
    auto basis = std::make_shared<const Basis>(model, sampler, parent, recipe.basis, watch, nullptr, space);
    if (KnownSpace used = contact_space_of(*basis)) space = std::move(used);
    return basis;
}

KnownSpace contact_space_of(const Basis &basis) {
    if (basis.space()->is_contact_space) return basis.space();
    return basis.sampler() ? basis.sampler()->space() : nullptr;
}

std::int64_t bytes_of(const Space &space) {
    const auto entries = [](const auto &a) { return a.rows() * a.cols(); };
    return space.vectors.bytes() +
           static_cast<std::int64_t>(sizeof(double)) * (entries(space.gap) + entries(space.damping));
}

} // namespace plm
