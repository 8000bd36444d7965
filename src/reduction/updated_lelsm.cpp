#include "reduction/updated_lelsm.hpp"
#include "contact/describing_function.hpp"
#include "reduction/basis_kind.hpp"
#include "reduction/residual_responses.hpp"
#include "sampling/mode_clusters.hpp"
#include "sampling/mode_match.hpp"
#include "space/linear_contact.hpp"
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace plm {
namespace {

void append_load(const vector<double> &load, Matrix &loads) {
    if (load.empty()) return;
    Matrix column(static_cast<std::int64_t>(load.size()), 1);
    std::copy(load.begin(), load.end(), column.data());
    loads.append(column);
}

// G^T N_h: what harmonic h of the contact forces of the motion does to the structure.
void append_contact_forces(const Space &space, const EquivalentMotion &motion, std::int64_t h,
                           Matrix &loads) {
    vector<double> force(space.n_pairs()), load(space.size(), 0.0);
    for (std::size_t p = 0; p < force.size(); ++p)
        force[p] =
            force_coefficient(space.model->contact_stiffness()[p], motion.mean[p], motion.amplitude[p], h);
    gemv('T', 1.0, space.gap, force.data(), 0.0, load.data());
    append_load(load, loads);
}

} // namespace

UpdatedModes updated_lelsm_modes(const Space &space, const SelectionRule &rule, double amplitude,
                                 bool with_loads, Watch watch) {
    UpdatedModes result;
    const double middle = M_PI * (rule.min_hz + rule.max_hz);
    result.motion = equivalent_motion(space, {middle, rule.highest_eigenvalue(), amplitude}, watch);
    const SpaceModes all = modes_with_springs(space.lambda, space.n_massless, space.gap, result.motion.spring,
                                              std::numeric_limits<double>::infinity());
    vector<char> kept;
    for (double value : all.values) kept.push_back(rule.keeps(to_hz(value)));
    result.columns = kept_columns(all, kept);
    result.n_modes = result.columns.cols();
    if (result.n_modes == 0) throw no_mode_kept(rule, "no equivalent system");
    Matrix loads(space.size(), 0);
    if (with_loads)
        for (const auto &entry : drive_of(space)) {
            append_load(entry.second.real, loads);
            append_load(entry.second.imag, loads);
        }
    for (std::int64_t h = 0; h <= rule.n_harmonics; ++h)
        append_contact_forces(space, result.motion, h, loads);
    result.columns.append(residual_responses(all, kept, loads));
    return result;
}

namespace {

CollectedModes collect_updated_lelsm(const ColumnSources &from, Watch watch) {
    const BasisOptions &o = from.options;
    UpdatedModes modes =
        updated_lelsm_modes(from.space, from.rule, o.equivalent_amplitude, o.load_vectors, watch);
    CollectedModes collected;
    collected.columns = std::move(modes.columns);
    collected.equivalent_share = std::move(modes.motion.coupling);
    if (!modes.motion.settled)
        watch.warn(reason::no_contraction,
                   format("the equivalent stiffnesses did not settle in %lld iterations; the last "
                          "ones are used. Set equivalent_amplitude or choose another kind",
                          static_cast<long long>(modes.motion.iterations) - 1));
    return collected;
}

constexpr BasisKind updated_lelsm_kind() {
    BasisKind kind("lelsm_updated",
                   "modes and Ritz vectors of the system equivalent at the resonance's amplitude");
    kind.own_options = "equivalent_amplitude";
    kind.needs_pairs = true;
    kind.has_load_vectors = true;
    kind.collect = collect_updated_lelsm;
    return kind;
}

} // namespace

constexpr BasisKind basis_kinds::lelsm_updated = updated_lelsm_kind();

} // namespace plm
