// A block of tall vectors over the free DOFs of a structure. Above this room nothing has as many rows as the
// structure has DOFs, except through a Field and the short list of operations below: where its columns are
// kept, and in which precision, is this room's affair.
#pragma once
#include "linalg/dense.hpp"
#include <initializer_list>

namespace plm {

/// A DOF with its factor in a sum of them: a constraint, a gap row, a DOF of the caller by free ones.
struct DofTerm {
    std::int64_t dof; // free index, where nothing else is said
    double coefficient;
    bool operator<(const DofTerm &o) const {
        return dof != o.dof ? dof < o.dof : coefficient < o.coefficient;
    }
};
using DofTerms = vector<DofTerm>;

class Field {
  public:
    Field() = default;
    /// Zeros.
    Field(std::int64_t rows, std::int64_t cols) : columns_(rows, cols) {}
    explicit Field(Matrix columns) : columns_(std::move(columns)) {}
    /// One vector.
    explicit Field(const vector<double> &column);

    std::int64_t rows() const { return columns_.rows(); }
    std::int64_t cols() const { return columns_.cols(); }
    bool empty() const { return columns_.empty(); }

    Field columns(std::int64_t first, std::int64_t count) const;
    Field columns(const vector<std::int64_t> &chosen) const;
    void append(const Field &other);
    /// Room for so many columns in all, so that they are not copied as they come.
    void reserve(std::int64_t cols) { columns_.reserve(rows(), cols); }
    /// Its columns from `first` on become those of `other`.
    void put(std::int64_t first, const Field &other);
    /// Entry of one DOF (free index) in a column.
    double at(std::int64_t row, std::int64_t column = 0) const { return columns_(row, column); }
    /// A sum of DOFs in all columns, and in one.
    vector<double> row(const DofTerms &sum) const;
    double at(const DofTerms &sum, std::int64_t column = 0) const;
    /// Entries of some DOFs in all columns, k x cols().
    Matrix rows_at(const vector<std::int64_t> &rows) const { return select_rows(columns_, rows); }
    /// Column j times factor[j].
    void scale(const vector<double> &factor);
    /// All of it becomes zero; the shape stays.
    void clear();

    /// The columns themselves: for this room, and for tests.
    const Matrix &in_core() const { return columns_; }
    Matrix &in_core() { return columns_; }

  private:
    Matrix columns_;
};

/// V Y and V y.
Field combine(const Field &v, const Matrix &y);
Field combine(const Field &v, const vector<double> &y);
/// X += factor V Y.
void add_combination(double factor, const Field &v, const Matrix &y, Field &x);
void add_combination(double factor, const Field &v, const vector<double> &y, Field &x);
/// X += factor V, of one shape.
void add(double factor, const Field &v, Field &x);
/// X = the sum of factor V over the terms, all of one shape; X may be among them.
struct Scaled {
    double factor;
    const Field &field;
};
void set_sum(std::initializer_list<Scaled> terms, Field &x);
/// A^T B.
Matrix gram(const Field &a, const Field &b);
/// Products of the columns of A with those of B, one by one.
vector<double> column_products(const Field &a, const Field &b);
/// Of the columns, Euclidean.
vector<double> column_norms(const Field &a);

/// Where the columns, taken together as vectors, are largest at one DOF.
struct LargestEntry {
    std::int64_t row = 0; // free index
    double size = 0;
};
LargestEntry largest_entry(const Field &v);

/// PLM_REASON_NOT_FINITE where an entry is not.
void require_finite_result(const Field &x, const char *what);

/// |q - P eta| / |q| in the Euclidean norm with eta by least squares, q one column; 0 when P spans all.
double euclidean_remainder(const Field &p, const Field &q);

} // namespace plm
