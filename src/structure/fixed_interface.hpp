// The structure with the DOFs of its contact held: constraint modes, fixed-interface modes and static
// responses to loads, as Craig & Bampton (1968) take them.
#pragma once
#include "structure/structure.hpp"

namespace plm {

class FixedInterface {
  public:
    FixedInterface(const Structure &structure, Watch watch);
    ~FixedInterface();

    /// DOFs of the gap rows.
    std::int64_t n_boundary() const { return static_cast<std::int64_t>(boundary_dof_.size()); }
    /// Unit motion of each of them, the interior following statically.
    Field constraint_modes() const;
    /// The n_fixed lowest modes with all of them held, or all below `highest` (rad/s) when n_fixed = 0; when
    /// asked for, also the static responses to the loads on the interior, of unit energy, orthogonal to those
    /// modes and to each other.
    Field interior_modes(std::int64_t n_fixed, double highest, bool with_load_responses) const;

  private:
    class Interior;
    Field interior_loads() const;

    const Structure &structure_;
    vector<std::int64_t> boundary_dof_;  // free indices
    std::unique_ptr<Interior> interior_; // null without interior DOFs
};

} // namespace plm
