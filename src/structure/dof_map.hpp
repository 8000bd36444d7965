// How the DOFs of the caller follow from those that are free: q = T q_r. A free DOF is itself, a fixed one
// zero, a dependent one a sum of free ones by the constraints.
#pragma once
#include "structure/sparse.hpp"
#include "structure/wide_rows.hpp"
#include <optional>

namespace plm {

class ByteReader;
class ByteWriter;
/// How constraint rows over very many DOFs are eliminated: as they are, which is best where nothing stands at
/// the DOF that they give; or by way of sums over groups of them (wide_rows.hpp).
enum class WideRows { whole, in_groups };

class DofMap {
  public:
    DofMap() = default;
    /// Fixed DOFs, in any order, some perhaps twice. kept[dof]: stays if it can (constraints.hpp).
    DofMap(std::int64_t n_dof, const vector<std::int64_t> &fixed, const ConstraintRows &constraints,
           const vector<char> &kept = {}, WideRows wide = WideRows::whole);

    std::int64_t n_dof() const { return n_dof_; }
    std::int64_t n_free() const { return static_cast<std::int64_t>(free_dof_.size()); }
    /// The free ones, ascending; sums over groups are numbered on from n_dof.
    const vector<std::int64_t> &free_dofs() const { return free_dof_; }
    /// One of them to tell it by: of a sum, one that it is taken over.
    std::int64_t told(std::int64_t free_index) const {
        const std::int64_t dof = free_dof_[free_index];
        return dof < n_dof_ ? dof : grouped_.within[dof - n_dof_];
    }
    vector<std::int64_t> told_dofs() const;
    /// Place among them, or -1.
    std::int64_t free_index(std::int64_t dof) const { return place_[dof] >= 0 ? place_[dof] : -1; }
    /// Its row of T over free indices, empty where it is held at zero.
    DofTerms terms(std::int64_t dof) const;
    /// The same of a sum over all DOFs, by ascending free index.
    DofTerms terms(const DofTerms &sum) const;
    bool is_held(std::int64_t dof) const;
    bool has_dependent() const { return dependent_.cols > 0; }
    /// What became of the constraints; the terms of the dependent DOFs are here, no longer there.
    const EliminatedConstraints &elimination() const { return elimination_; }
    double bytes() const;
    /// Its bytes (linalg/bytes.hpp), and from them: what was eliminated in which row is not among them.
    void write(ByteWriter &bytes) const;
    void read(ByteReader &bytes);

    /// q = T q_r; T^T F; and the free DOFs of a motion, by which the others are given.
    void expand(const double *free, double *all) const;
    vector<double> forces(const double *all) const;
    vector<double> free_part(const double *all) const;
    /// T^T A T of a symmetric matrix over all DOFs, symmetric to the last bit. None where wide rows would
    /// fill it and groups may not; PLM_ERR_MEMORY where these would, too.
    std::optional<SparseMatrix> reduced(const char *name, const SparseMatrix &a) const;
    /// B T of the rows in these triplets.
    SparseMatrix reduced_rows(std::int64_t n_rows, const vector<std::int64_t> &row,
                              const vector<std::int64_t> &dof, const vector<double> &coefficient) const;

  private:
    template <class Map, class Bytes> static void pass(Map &map, Bytes &bytes);
    template <class Groups, class Bytes>
    static void pass_groups(Groups &groups, std::int64_t n_dof, Bytes &bytes);
    void number_free();
    template <class F> void for_terms(std::int64_t dof, F f) const;
    template <class F> void for_upper(const SparseMatrix &a, const SparseMatrix &dependents, F column) const;
    std::int64_t count_reduced(const SparseMatrix &a, const SparseMatrix &dependents,
                               std::int64_t limit) const;
    [[noreturn]] void refuse_filled(const char *name, const SparseMatrix &a, std::int64_t most) const;

    static constexpr std::int64_t held = -1; // below: column -2 - place of dependent_
    std::int64_t n_dof_ = 0;
    GroupedRows grouped_; // none where rows are whole
    WideRows wide_ = WideRows::whole;
    vector<std::int64_t> free_dof_, place_; // place_: of the sums, too
    SparseMatrix dependent_;                // n_free x dependent DOFs, T^T of them
    EliminatedConstraints elimination_;
};

} // namespace plm
