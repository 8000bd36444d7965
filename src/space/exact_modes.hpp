// Exact modes of the open structure and what is outside them: forces that do not act on them, motions that do
// not contain them.
#pragma once
#include "structure/structure.hpp"

namespace plm {

constexpr std::int64_t solved_at_once = 64; // right-hand sides

/// Modes of the open structure that are found anyhow: what is asked of it later seldom needs fewer.
constexpr std::int64_t modes_anyhow = 30;

/// Phi, n_free x p; values of rigid-body modes: exactly 0.
struct ExactModes : StructureModes {
    Field momenta;        // M Phi
    bool are_all = false; // there are no others of finite frequency

    std::int64_t count() const { return static_cast<std::int64_t>(values.size()); }
    ExactModes first(std::int64_t count) const;
    /// F becomes the part of it that leaves the modes at rest, X the part outside them.
    void take_from_forces(Field &f) const;
    void take_from_motions(Field &x) const;
};

ExactModes exact_modes(const Structure &structure, StructureModes found, bool are_all);

/// F, outside the modes, becomes (K + sigma M)^-1 F. What solving leaves of the modes, which may be soft, is
/// taken off.
void respond_outside(const Structure &structure, const ExactModes &modes, Field &f);

} // namespace plm
