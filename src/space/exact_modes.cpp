#include "space/exact_modes.hpp"
#include <algorithm>

namespace plm {

ExactModes ExactModes::first(std::int64_t count) const {
    ExactModes some;
    some.values.assign(values.begin(), values.begin() + count);
    some.vectors = vectors.columns(0, count);
    some.momenta = momenta.columns(0, count);
    some.are_all = are_all && count == this->count();
    return some;
}

void ExactModes::take_from_forces(Field &f) const {
    if (count() > 0) add_combination(-1.0, momenta, gram(vectors, f), f);
}

void ExactModes::take_from_motions(Field &x) const {
    if (count() > 0) add_combination(-1.0, vectors, gram(momenta, x), x);
}

ExactModes exact_modes(const Structure &structure, StructureModes found, bool are_all) {
    ExactModes modes;
    static_cast<StructureModes &>(modes) = std::move(found);
    const std::int64_t n_rigid = std::min(structure.n_rigid(), modes.count());
    std::fill(modes.values.begin(), modes.values.begin() + n_rigid, 0.0); // exactly
    modes.momenta = structure.mass_times(modes.vectors);
    modes.are_all = are_all;
    return modes;
}

void respond_outside(const Structure &structure, const ExactModes &modes, Field &f) {
    if (f.empty()) return;
    structure.solve(f);
    modes.take_from_motions(f);
    if (structure.n_rigid() > 0) modes.take_from_motions(f); // of these, a soft shift makes much of little
}

} // namespace plm
