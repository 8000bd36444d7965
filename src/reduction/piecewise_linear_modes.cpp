// The piecewise-linear modes of the paper: the modes of the linear systems that a sweep of the contact area
// meets.
#include "reduction/basis_kind.hpp"
#include "reduction/mode_selection.hpp"
#include "sampling/sampler.hpp"

namespace plm {
namespace {

CollectedModes collect_piecewise_linear(const ColumnSources &from, Watch watch) {
    return collect_modes(from.space, from.sampler->samples(), from.dominant, from.rule, watch);
}

constexpr BasisKind piecewise_linear_kind() {
    BasisKind kind("plm", "piecewise-linear modes");
    kind.needs_sampler = true;
    kind.collect = collect_piecewise_linear;
    return kind;
}

} // namespace

constexpr BasisKind basis_kinds::plm = piecewise_linear_kind();

} // namespace plm
