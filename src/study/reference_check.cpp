#include "study/reference_check.hpp"
#include "hbm/harmonic_choice.hpp"
#include "hbm/make_system.hpp"
#include "searches/curve.hpp"
#include "study/curve_point.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

constexpr std::int64_t beside = 3; // points on either side of the highest one

} // namespace

HarmonicCheck check_harmonics(const Branch &branch, const Peak &peak, const HbmOptions &options,
                              const Output &output, Watch watch) {
    const BranchPoint &summit = peak.branch->points()[0];
    if (summit.motion) return {}; // an exact motion: nothing is cut off
    HbmOptions finer = options_at(summit, branch.period_multiple(), options);
    finer.n_harmonics *= 2;
    const auto system = make_system(branch.reduced_model(), finer);
    const std::int64_t n = static_cast<std::int64_t>(branch.points().size()),
                       top = branch.highest_point(output.dof, output.measure, output.harmonic),
                       first = std::max<std::int64_t>(0, top - beside), last = std::min(n - 1, top + beside);
    auto around = std::make_shared<Branch>(branch.reduced_model(), finer.force_scale, finer.period_multiple);
    for (std::int64_t i = first; i <= last; ++i) {
        watch.step("reference", 0.5);
        const auto at = [&](std::int64_t k) {
            return load(*system,
                        branch.points()[static_cast<std::size_t>(std::clamp<std::int64_t>(k, 0, n - 1))]);
        };
        PathState point = at(i);
        const PathState direction = difference(at(i + 1), at(i - 1));
        if (!correct_across(*system, curve_metric(point, finer), finer, direction, point)) continue;
        BranchPoint corrected;
        system->to_point(point.x.data(), point.parameter, corrected);
        around->append(std::move(corrected));
    }
    if (around->points().size() < 3)
        throw Error(status::convergence,
                    "the peak of the reference could not be solved with twice the harmonics");
    const Peak better = Hbm(branch.reduced_model(), 0, 0, finer, watch)
                            .find_peak(*around, output.dof, output.measure, output.harmonic);
    return {std::abs(better.frequency_hz / peak.frequency_hz - 1),
            std::abs(better.amplitude / peak.amplitude - 1)};
}

} // namespace plm
