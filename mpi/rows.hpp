// Which rank owns which DOF. No rank knows all of it: who owns a DOF is asked of the rank that keeps that
// part of the directory.
#pragma once
#include "mpi/messages.hpp"

namespace plm::mpi {

class Rows {
  public:
    Rows() = default;
    /// Collective. owned: what this rank owns, base 0, in any order; every DOF has one owner. Throws on all
    /// ranks.
    Rows(Team &team, std::int64_t n_dof, const std::vector<std::int64_t> &owned);

    std::int64_t n_dof() const { return n_dof_; }
    /// The DOFs of this rank, ascending: its local rows.
    const std::vector<std::int64_t> &owned() const { return owned_; }
    std::int64_t count() const { return static_cast<std::int64_t>(owned_.size()); }
    /// The local row of a DOF, -1 for one of another rank.
    std::int64_t local(std::int64_t dof) const;
    /// Collective: the owner of each of these DOFs, in any order, repeated or not.
    std::vector<int> owners_of(Team &team, const std::vector<std::int64_t> &dofs) const;

  private:
    int keeper(std::int64_t dof) const { return static_cast<int>(dof / part_); }

    std::int64_t n_dof_ = 0, part_ = 1, first_ = 0; // this rank's part of the directory begins at first_
    struct Run {                                    // DOFs of this rank without a gap between them
        std::int64_t first, place, length;
    };
    std::vector<std::int64_t> owned_;
    std::vector<Run> runs_; // ascending
    std::vector<int> directory_;
};

} // namespace plm::mpi
