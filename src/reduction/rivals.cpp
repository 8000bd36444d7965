#include "reduction/rivals.hpp"
#include "reduction/bilinear_modes.hpp"
#include "reduction/discontinuity.hpp"
#include "reduction/lelsm.hpp"
#include "reduction/updated_lelsm.hpp"
#include <algorithm>
#include <utility>

namespace plm {
namespace {

CollectedModes collect_lelsm(const Space &space, const SelectionRule &rule, Watch watch) {
    EquivalentModes modes = lelsm_modes(space, rule, watch);
    CollectedModes collected;
    collected.columns = std::move(modes.columns);
    collected.equivalent_share = std::move(modes.share);
    return collected;
}

CollectedModes collect_updated_lelsm(const Space &space, const SelectionRule &rule, const BasisOptions &o,
                                     Watch watch) {
    UpdatedModes modes = updated_lelsm_modes(space, rule, o.equivalent_amplitude, o.load_vectors, watch);
    CollectedModes collected;
    collected.columns = std::move(modes.columns);
    collected.equivalent_share = std::move(modes.motion.share);
    if (!modes.motion.settled)
        watch.warn(PLM_REASON_NO_CONTRACTION,
                   format("the equivalent stiffnesses did not settle in %lld iterations; the last "
                          "ones are used. Set equivalent_amplitude or choose another kind",
                          static_cast<long long>(modes.motion.iterations) - 1));
    return collected;
}

CollectedModes collect_discontinuity(const Space &space, const SelectionRule &rule, const BasisOptions &o,
                                     Watch watch) {
    CollectedModes collected;
    collected.columns = discontinuous_modes(space, rule, o.n_discontinuities, watch).columns;
    return collected;
}

} // namespace

CollectedModes collect_rival_modes(const Space &space, const SelectionRule &rule, const BasisOptions &options,
                                   Watch watch) {
    switch (options.kind) {
    case BasisKind::bilinear:
        return collect_bilinear_modes(space, rule, watch);
    case BasisKind::lelsm:
        return collect_lelsm(space, rule, watch);
    case BasisKind::lelsm_updated:
        return collect_updated_lelsm(space, rule, options, watch);
    case BasisKind::discontinuity:
        return collect_discontinuity(space, rule, options, watch);
    default:
        throw Error(PLM_ERR_INTERNAL, "not a kind of rival modes");
    }
}

} // namespace plm
