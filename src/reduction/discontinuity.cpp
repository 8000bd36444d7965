#include "reduction/discontinuity.hpp"
#include "linalg/lapack.hpp"
#include "reduction/basis_kind.hpp"
#include "reduction/residual_responses.hpp"
#include "sampling/dominant_mode.hpp"
#include "sampling/mode_match.hpp"
#include "space/rest.hpp"
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace plm {
namespace {

PairStates reference_contact(const Space &space) {
    if (is_homogeneous(*space.model)) return contact_set(LinearSystem::sliding, space);
    return rest_of(space)->states;
}

// B K_ref^-1 B^T without rigid-body motion, negated: the softest patterns first.
Matrix negative_flexibility(const Space &space, const SpaceModes &all) {
    Matrix scaled = product('N', 'N', space.gap, all.vectors);
    for (std::int64_t j = 0; j < scaled.cols(); ++j) {
        const double root = all.values[j] > 0 ? 1 / std::sqrt(all.values[j]) : 0.0;
        for (std::int64_t p = 0; p < scaled.rows(); ++p) scaled(p, j) *= root;
    }
    if (all.massless.cols() > 0) scaled.append(product('N', 'N', space.gap, all.massless));
    Matrix f(scaled.rows(), scaled.rows());
    gemm('N', 'T', -1.0, scaled, scaled, 0.0, f);
    return f;
}

} // namespace

DiscontinuousModes discontinuous_modes(const Space &space, const SelectionRule &rule, std::int64_t n_vectors,
                                       Watch watch) {
    DiscontinuousModes result;
    watch.step("discontinuity vectors", 0.0);
    result.reference = reference_contact(space);
    const SpaceModes all =
        modes_of_contact_set(space, result.reference, std::numeric_limits<double>::infinity());
    vector<char> kept;
    for (double value : all.values) kept.push_back(rule.keeps(to_hz(value)));
    result.columns = kept_columns(all, kept);
    result.n_modes = result.columns.cols();
    if (result.n_modes == 0) throw no_mode_kept(rule, "no reference system");
    watch.step("discontinuity vectors", 0.5);
    const SymmetricEigen patterns = symmetric_eigen(negative_flexibility(space, all));
    for (double value : patterns.values)
        result.energy.push_back(patterns.values[0] < 0 ? std::max(0.0, value / patterns.values[0]) : 0.0);
    Matrix loads = space.gap.transposed(); // unit forces on every pair
    if (n_vectors > 0) loads = product('N', 'N', loads, patterns.vectors.columns(0, n_vectors));
    result.columns.append(residual_responses(all, kept, loads));
    return result;
}

namespace {

void check_discontinuities(const BasisOptions &o, std::int64_t n_pairs) {
    const long long asked = o.n_discontinuities, pairs = n_pairs;
    if (asked > pairs)
        throw Error(status::argument, format("n_discontinuities is %lld, but the model has %lld contact "
                                             "pairs; 0 takes one vector per pair",
                                             asked, pairs))
            .argument("n_discontinuities");
}

CollectedModes collect_discontinuity(const ColumnSources &from, Watch watch) {
    CollectedModes collected;
    collected.columns =
        discontinuous_modes(from.space, from.rule, from.options.n_discontinuities, watch).columns;
    return collected;
}

constexpr BasisKind discontinuity_kind() {
    BasisKind kind("discontinuity", "linear modes and a static jump per pair");
    kind.own_options = "n_discontinuities";
    kind.needs_pairs = true;
    kind.check = check_discontinuities;
    kind.collect = collect_discontinuity;
    return kind;
}

} // namespace

constexpr BasisKind basis_kinds::discontinuity = discontinuity_kind();

} // namespace plm
