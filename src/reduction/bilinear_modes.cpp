#include "reduction/bilinear_modes.hpp"
#include "reduction/basis_kind.hpp"
#include "sampling/dominant_mode.hpp"
#include "sampling/mode_match.hpp"
#include <utility>

namespace plm {

CollectedModes collect_bilinear_modes(const Space &space, const SelectionRule &rule, Watch watch) {
    CollectedModes collected;
    for (const LinearSystem system : {LinearSystem::open, LinearSystem::sliding}) {
        watch.step("modes", system == LinearSystem::open ? 0.0 : 0.5);
        const SpaceModes modes =
            modes_of_contact_set(space, contact_set(system, space), rule.highest_eigenvalue());
        SampleSelection s;
        for (double value : modes.values) {
            s.frequency_hz.push_back(to_hz(value));
            s.kept.push_back(rule.keeps(s.frequency_hz.back()));
        }
        collected.columns.append(kept_columns(modes, s.kept));
        collected.samples.push_back(std::move(s));
    }
    if (collected.columns.cols() == 0) throw no_mode_kept(rule, "neither the open nor the sliding system");
    return collected;
}

namespace {

constexpr BasisKind bilinear_kind() {
    BasisKind kind("bilinear", "modes of the open and of the sliding system");
    kind.needs_pairs = true;
    kind.collect = [](const ColumnSources &from, Watch watch) {
        return collect_bilinear_modes(from.space, from.rule, watch);
    };
    return kind;
}

} // namespace

constexpr BasisKind basis_kinds::bilinear = bilinear_kind();

} // namespace plm
