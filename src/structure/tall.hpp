// The seam between the method and all that has as many rows as the structure has DOFs: blocks of columns, and
// the structure's matrices and factors that act on them. In core they are arrays of this process
// (tall_in_core.cpp); else they lie wherever the host keeps them, and it does one operation at a time when it
// is told to (tall_by_host.cpp). Above this header nobody knows which.
#pragma once
#include "linalg/dense.hpp"
#include <memory>

namespace plm {

class Factor;
class Field;
struct Energy; // sparse.hpp
struct SparseMatrix;
struct Solver;

/// A DOF with its factor in a sum of them: a constraint, a gap row, a DOF of the caller by free ones.
struct DofTerm {
    std::int64_t dof; // free index, where nothing else is said
    double coefficient;
    bool operator<(const DofTerm &o) const {
        return dof != o.dof ? dof < o.dof : coefficient < o.coefficient;
    }
};
using DofTerms = vector<DofTerm>;

/// Entries of new columns, by DOF i: constant + wave sin(i) + noise r, r in (-1, 1) without a pattern and the
/// same in every run.
struct ColumnFill {
    double constant = 0, wave = 0, noise = 0;
    std::int64_t seed = 0;
};

/// Where the columns, taken together as vectors, are largest at one DOF.
struct LargestEntry {
    std::int64_t row = 0; // free index
    double size = 0;
};

/// Columns of as many rows as there are free DOFs. What is handed in lies in the same place.
class TallBlock {
  public:
    virtual ~TallBlock() = default;
    virtual std::int64_t rows() const = 0;
    virtual std::int64_t cols() const = 0;
    /// The columns as an array; null where they are not in core.
    virtual Matrix *matrix() { return nullptr; }
    const Matrix *matrix() const { return const_cast<TallBlock *>(this)->matrix(); }

    // New blocks in the same place.
    virtual std::unique_ptr<TallBlock> filled(std::int64_t cols, const ColumnFill &entries) const = 0;
    /// One column without a pattern, of entries of one size.
    virtual std::unique_ptr<TallBlock> patternless() const = 0;
    virtual std::unique_ptr<TallBlock> from_column(const vector<double> &column) const = 0;
    virtual std::unique_ptr<TallBlock> columns(std::int64_t first, std::int64_t count) const = 0;
    virtual std::unique_ptr<TallBlock> columns(const vector<std::int64_t> &chosen) const = 0;
    /// This times Y or y; B^T F and B^T of rows B (k x rows()).
    virtual std::unique_ptr<TallBlock> times(const Matrix &y) const = 0;
    virtual std::unique_ptr<TallBlock> times(const vector<double> &y) const = 0;
    virtual std::unique_ptr<TallBlock> from_rows(const SparseMatrix &b, const Matrix &f) const = 0;
    virtual std::unique_ptr<TallBlock> from_rows(const SparseMatrix &b) const = 0;

    // Columns.
    virtual void reserve(std::int64_t cols) = 0;
    virtual void append(const TallBlock &other) = 0;
    virtual void put(std::int64_t first, const TallBlock &other) = 0;
    virtual void copy_column(std::int64_t from, std::int64_t to) = 0;
    virtual void cut(std::int64_t cols) = 0;
    virtual void clear() = 0;

    // This becomes, X: X + factor V Y; the same with the columns of V from `first` on; with one column of X;
    virtual void add_product(double factor, const TallBlock &v, const Matrix &y) = 0;
    virtual void add_product(double factor, const TallBlock &v, std::int64_t first, const Matrix &y) = 0;
    virtual void add_product(double factor, const TallBlock &v, const vector<double> &y,
                             std::int64_t column) = 0;
    /// X Y, the first `count` columns of it in place of the first of X, the others are gone;
    virtual void replace_by_product(const Matrix &y, std::int64_t count) = 0;
    /// X R^-1 or, transposed, X R^-T with a triangular R;
    virtual void divide(char triangle, bool transposed, const Matrix &r) = 0;
    /// X diag(factor) and X diag(divisor)^-1;
    virtual void scale(const vector<double> &factor) = 0;
    virtual void divide(const vector<double> &divisor) = 0;
    /// X + factor V; the sum of factor V over the terms, of which X may be one.
    virtual void add(double factor, const TallBlock &v) = 0;
    virtual void set_sum(const vector<double> &factor, const vector<const TallBlock *> &v) = 0;
    /// X with what the sums say added at their DOFs, one for each column.
    virtual void add_sums(const std::vector<DofTerms> &sums) = 0;

    // What is asked.
    virtual double at(std::int64_t row, std::int64_t column) const = 0;
    virtual Matrix rows_at(const vector<std::int64_t> &rows) const = 0;
    virtual vector<double> column(std::int64_t j) const = 0;
    /// This^T B; by_columns: as suits one column of B best.
    virtual Matrix gram(const TallBlock &b, bool by_columns) const = 0;
    /// Products of the columns with those of B, one by one; of their absolute values with one column.
    virtual vector<double> products(const TallBlock &b) const = 0;
    virtual vector<double> absolute_products(const TallBlock &one) const = 0;
    virtual vector<double> norms() const = 0;
    /// B X of rows B, of one column into u, and |B| |X|.
    virtual Matrix by_rows(const SparseMatrix &b) const = 0;
    virtual void by_rows(const SparseMatrix &b, double *u) const = 0;
    virtual Matrix terms_by_rows(const SparseMatrix &b) const = 0;
    virtual LargestEntry largest() const = 0;
    virtual bool is_finite() const = 0;
    /// |q - X y| over |q|, one column q, with y by least squares.
    virtual double remainder(const TallBlock &q) const = 0;
};

class TallMatrix;

/// A factorization of one matrix, for as many right-hand sides as there are.
class TallFactor {
  public:
    virtual ~TallFactor() = default;
    /// X becomes A^-1 X.
    virtual void solve(Field &x) const = 0;
    /// As in Factor (solver/factor.hpp).
    virtual double reciprocal_condition() const = 0;
    virtual std::int64_t factor_nonzeros() const = 0;
    virtual bool calls_host() const = 0;
    /// For F = [B^T loads]: F^T A^-1 F and F^T A^-1 M A^-1 F; false where that is not to be had for less than
    /// a solution of each.
    virtual bool multiply_responses(const SparseMatrix & /*b*/, const Field & /*loads*/,
                                    const TallMatrix & /*m*/, Matrix & /*energy*/,
                                    Matrix & /*inertia*/) const {
        return false;
    }
};

/// What pairs miss K x = lambda M x by, with the terms of each row, of which rounding is a share: with
/// penalties rounding of theirs exceeds lambda M x.
class PairProducts {
  public:
    virtual ~PairProducts() = default;
    /// x' K x, as it is and summed in twice the digits, and |x|' |K| |x|, of which rounding leaves eps in it.
    virtual double energy(std::int64_t j) const = 0;
    virtual double precise_energy(std::int64_t j) const = 0;
    virtual double terms(std::int64_t j) const = 0;
    /// Of K x - lambda M x, what is more than this share of the terms in its row; infinite where K x is not
    /// finite.
    virtual double residual(std::int64_t j, double lambda, const Field &mx, double rounding) const = 0;
};

/// A symmetric matrix over the free DOFs: one of the structure's, or a sum of them.
class TallMatrix {
  public:
    virtual ~TallMatrix() = default;
    virtual std::int64_t rows() const = 0;
    /// No columns, in the place of those that it acts on.
    virtual Field none() const = 0;
    /// Y = A X, of X's shape.
    virtual void times(const Field &x, Field &y) const = 0;
    virtual Field times(const Field &x) const = 0;
    /// A + factor B; factor A; A + B^T diag(spring) B with rows B, one pattern for all springs.
    virtual std::unique_ptr<TallMatrix> plus(double factor, const TallMatrix &other) const = 0;
    virtual std::unique_ptr<TallMatrix> scaled(double factor) const = 0;
    virtual std::unique_ptr<TallMatrix> with_springs(const std::vector<DofTerms> &rows,
                                                     const vector<double> &spring) const = 0;
    /// Throws as make_factor() does.
    virtual std::unique_ptr<TallFactor> factor(const Solver &solver) const = 0;
    /// Of A + factor B; negative: its factorization cannot tell.
    virtual std::int64_t count_negative(double factor, const TallMatrix &other,
                                        const Solver &solver) const = 0;
    virtual vector<double> diagonal_at(const vector<std::int64_t> &dofs) const = 0;
    /// How many entries of the diagonal are positive: as many finite eigenvalues at most beside a mass.
    virtual std::int64_t n_positive() const = 0;
    /// Of one column, summed in twice the digits.
    virtual Energy energy(const Field &x, std::int64_t column) const = 0;
    virtual std::unique_ptr<PairProducts> products(const Field &x) const = 0;
    /// PLM_ERR_MATRIX where an entry is not finite, as far as they are at hand.
    virtual void require_finite_entries(const char *what) const = 0;
    /// Its entries, for what a dense or a small problem is solved by.
    virtual const SparseMatrix &entries() const = 0;
};

/// What a search for rigid-body motion asks of K and M once.
struct TallFacts {
    std::int64_t n_dof = 0; // that are not held
    std::int64_t n_massive = 0;
    double trace_of_mass = 0, trace_of_stiffness = 0;
    double least_stiffness = 0; // on the diagonal; not positive or NaN where one is not
    /// The median of K_ii / M_ii: no penalty and no unit of rotations moves it. 0: there is none.
    double typical_eigenvalue = 0;
    /// DOFs with neither stiffness nor mass on the diagonal: the first that nothing couples to others, and
    /// the first of those that are coupled, -1: none.
    std::int64_t loose = -1, multiplier = -1, n_multipliers = 0;
};
TallFacts facts_of(const SparseMatrix &k, const SparseMatrix &m);

/// A structure some of whose DOFs are held at zero: the others are its interior.
class HeldTall {
  public:
    virtual ~HeldTall() = default;
    virtual std::int64_t n_interior() const = 0;
    virtual const TallMatrix &mass() const = 0;
    virtual const TallMatrix &stiffness() const = 0;
    /// The forces on the interior by which it follows unit motions of some of the DOFs held: -K_ib.
    virtual Field driving_forces(std::int64_t first, std::int64_t count) const = 0;
    virtual Field on_all_dofs(const Field &interior) const = 0;
    virtual Field inside(const Field &all) const = 0;
};

/// The structure behind the seam.
class Tall {
  public:
    virtual ~Tall() = default;
    virtual const TallMatrix &mass() const = 0;
    virtual const TallMatrix &stiffness() const = 0;
    virtual const TallMatrix *damping() const = 0; // null: none
    virtual TallFacts facts() const = 0;
    virtual std::unique_ptr<HeldTall> held(const vector<std::int64_t> &dofs) const = 0;
};

// In core. Matrices are borrowed, or moved in.
std::unique_ptr<TallBlock> tall_block(Matrix columns);
std::unique_ptr<TallMatrix> tall_matrix(const SparseMatrix &a);
std::unique_ptr<TallMatrix> tall_matrix(SparseMatrix &&a);
std::unique_ptr<TallFactor> tall_factor(std::unique_ptr<Factor> factor);
/// A factor that somebody else keeps.
std::unique_ptr<TallFactor> tall_factor(const Factor &factor);
/// damping: 0 x 0 without one.
std::unique_ptr<Tall> tall_in_core(const SparseMatrix &mass, const SparseMatrix &stiffness,
                                   const SparseMatrix &damping);

} // namespace plm
