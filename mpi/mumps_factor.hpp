// A factorization of the matrices of a team by MUMPS, spread over its ranks.
#pragma once
#include "mpi/node_order.hpp"
#include <dmumps_c.h>

namespace plm::mpi {

/// An order of elimination found once, on the brain; the same for all matrices of a pattern.
struct KeptOrder {
    std::int64_t added = -1; // of how many entries beside the matrices' it was made; -1: there is none
    NodeOrder order;
};

/// What is to be factored: A with some DOFs held, and entries added to it (lower triangle, base 0).
struct FactorTask {
    Weights weights;
    bool count_only = false; // of a matrix that may be indefinite: nothing is kept
    const std::int64_t *held = nullptr;
    std::int64_t n_held = 0;
    const std::int64_t *row = nullptr, *column = nullptr;
    const double *value = nullptr;
    std::int64_t n_added = 0;
};

/// Memory whose end can be given back to the system while the beginning stays.
class Workspace {
  public:
    Workspace() = default;
    ~Workspace() { resize(0); }
    Workspace(const Workspace &) = delete;
    Workspace &operator=(const Workspace &) = delete;
    /// What it held is gone.
    void resize(std::size_t bytes);
    void keep_first(std::size_t bytes);
    void *data() const { return data_; }

  private:
    void *data_ = nullptr;
    std::size_t bytes_ = 0;
};

class MumpsFactor {
  public:
    enum class Outcome { factored = 0, not_positive_definite = 1, singular = 2 };

    MumpsFactor() = default;
    /// Collective, once. Throws on all ranks alike, and leaves nothing behind then.
    void make(Team &team, const Rows &rows, const Matrices &matrices, const FactorTask &task,
              KeptOrder &kept);
    MumpsFactor(const MumpsFactor &) = delete;
    MumpsFactor &operator=(const MumpsFactor &) = delete;
    /// Collective, therefore not the destructor's: a factor that is not released keeps its memory.
    void release();

    Outcome outcome() const { return outcome_; }
    std::int64_t negative() const { return mumps_.infog[11]; }
    double entries() const;
    /// On the brain: the DOF (base 0) of a pivot that vanished, -1: not known.
    std::int64_t breakdown() const { return breakdown_; }

    /// Collective. Own rows of X = A^-1 X, in place. Throws on all ranks alike.
    void solve(Team &team, const Rows &rows, double *x, std::int64_t cols, std::int64_t ld);
    /// Collective. Own rows of X = A^-1 F, of sparse columns that the brain has: starts (base 1, cols + 1),
    /// rows (base 1).
    void solve_sparse(Team &team, const Rows &rows, std::vector<MUMPS_INT> &start,
                      std::vector<MUMPS_INT> &row, std::vector<double> &value, std::int64_t cols, double *x,
                      std::int64_t ld);
    /// Collective. Smallest pivot over largest, roughly, each over its diagonal entry: of the last DOF to be
    /// eliminated the pivot is 1 / (A^-1)_ii, which two inverse iterations find.
    double reciprocal_condition(Team &team, const Rows &rows, const Matrices &matrices, const Weights &w);

  private:
    void set_up(Team &team);
    void take_entries(Team &team, const Rows &rows, const Matrices &matrices, const FactorTask &task);
    void run(Team &team, const char *what, MUMPS_INT job);
    void analyse(Team &team, const FactorTask &task, KeptOrder &kept);
    void take_order(NodeOrder &order);
    void lend_room(Team &team);
    void factorize(Team &team, const FactorTask &task);
    void judge(const FactorTask &task);
    void make_room(Team &team, const Rows &rows);
    void hand_over(Team &team, const Rows &rows, std::int64_t cols, double *x, std::int64_t ld);
    MUMPS_INT &control(int k) { return mumps_.icntl[k - 1]; }
    bool is_held(std::int64_t row) const { return held_[static_cast<std::size_t>(row)] != 0; }

    DMUMPS_STRUC_C mumps_{};
    bool alive_ = false;
    Workspace workspace_; // MUMPS's, where it lies here
    Outcome outcome_ = Outcome::factored;
    std::int64_t breakdown_ = -1;
    std::vector<char> held_; // own rows: by the host's supports or for this factorization
    std::vector<MUMPS_INT> row_, column_, own_dof_, solution_dof_;
    std::vector<double> value_, right_, solution_, direction_;
    Exchange to_owners_;
    bool plan_is_made_ = false;
};

} // namespace plm::mpi
