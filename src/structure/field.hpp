// A block of tall vectors over the free DOFs of a structure. Above this room nothing has as many rows as the
// structure has DOFs, except through a Field and the short list of operations below: where its columns are
// kept is behind tall.hpp.
#pragma once
#include "structure/tall.hpp"
#include <initializer_list>

namespace plm {

class Field {
  public:
    Field() = default;
    /// In core: zeros, the columns themselves, one vector. Of a structure: Structure::zeros() ...
    Field(std::int64_t rows, std::int64_t cols) : Field(Matrix(rows, cols)) {}
    explicit Field(Matrix columns) : block_(tall_block(std::move(columns))) {}
    explicit Field(const vector<double> &column);
    explicit Field(std::unique_ptr<TallBlock> block) : block_(std::move(block)) {}
    Field(const Field &other) : block_(other.copy()) {}
    Field(Field &&) noexcept = default;
    Field &operator=(const Field &other) {
        if (this != &other) block_ = other.copy();
        return *this;
    }
    Field &operator=(Field &&) noexcept = default;
    ~Field() = default;

    std::int64_t rows() const { return block_ ? block_->rows() : 0; }
    std::int64_t cols() const { return block_ ? block_->cols() : 0; }
    bool empty() const { return rows() * cols() == 0; }

    // Others that lie where this one does: zeros, other entries, one column, and columns of which each is a
    // sum of DOFs.
    Field zeros(std::int64_t cols) const { return filled(cols, {}); }
    Field filled(std::int64_t cols, const ColumnFill &entries) const {
        return Field(block().filled(cols, entries));
    }
    Field patternless() const { return Field(block().patternless()); }
    Field from(const vector<double> &column) const { return Field(block().from_column(column)); }
    Field sums(const std::vector<DofTerms> &sums) const;

    Field columns(std::int64_t first, std::int64_t count) const {
        return Field(block().columns(first, count));
    }
    Field columns(const vector<std::int64_t> &chosen) const { return Field(block().columns(chosen)); }
    void append(const Field &other);
    /// Room for so many columns in all, so that they are not copied as they come.
    void reserve(std::int64_t cols) { block().reserve(cols); }
    /// Its columns from `first` on become those of `other`.
    void put(std::int64_t first, const Field &other);
    void copy_column(std::int64_t from, std::int64_t to) { block().copy_column(from, to); }
    /// The first so many columns stay.
    void cut(std::int64_t cols) { block().cut(cols); }
    /// Entry of one DOF (free index) in a column.
    double at(std::int64_t row, std::int64_t column = 0) const { return block().at(row, column); }
    /// A sum of DOFs in all columns, and in one.
    vector<double> row(const DofTerms &sum) const;
    double at(const DofTerms &sum, std::int64_t column = 0) const;
    /// Entries of some DOFs in all columns, k x cols().
    Matrix rows_at(const vector<std::int64_t> &rows) const { return block().rows_at(rows); }
    /// One column, of all DOFs.
    vector<double> column(std::int64_t j) const { return block().column(j); }
    /// Column j times factor[j], and over divisor[j].
    void scale(const vector<double> &factor) { block().scale(factor); }
    void divide(const vector<double> &divisor) { block().divide(divisor); }
    /// X R^-1 or, transposed, X R^-T in place of X with a triangle R, 'U' or 'L', of a matrix.
    void divide(char triangle, bool transposed, const Matrix &r) { block().divide(triangle, transposed, r); }
    /// The first `count` columns of X Y in place of X.
    void replace_by_product(const Matrix &y, std::int64_t count) { block().replace_by_product(y, count); }
    /// All of it becomes zero; the shape stays.
    void clear() { block().clear(); }
    bool is_finite() const { return block().is_finite(); }

    /// The columns as an array: for this room where they are in core, and for tests.
    const Matrix &in_core() const;
    Matrix &in_core();
    /// For this room.
    const TallBlock &block() const { return block_ ? *block_ : nothing(); }
    TallBlock &block();

  private:
    static const TallBlock &nothing();
    std::unique_ptr<TallBlock> copy() const { return block_ ? block_->columns(0, cols()) : nullptr; }
    std::unique_ptr<TallBlock> block_; // null: 0 x 0
};

/// V Y and V y.
Field combine(const Field &v, const Matrix &y);
Field combine(const Field &v, const vector<double> &y);
/// X += factor V Y; the same with the columns of V from `first` on, and in one column of X.
void add_combination(double factor, const Field &v, const Matrix &y, Field &x);
void add_combination(double factor, const Field &v, const vector<double> &y, Field &x);
void add_combination_of_columns(double factor, const Field &v, std::int64_t first, const Matrix &y, Field &x);
void add_to_column(double factor, const Field &v, const vector<double> &y, Field &x, std::int64_t column);
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
/// The same by BLAS 3 whatever the width, as the iterations of eigensolvers take it.
Matrix block_gram(const Field &a, const Field &b);
/// Products of the columns of A with those of B, one by one.
vector<double> column_products(const Field &a, const Field &b);
/// Of the columns, Euclidean.
vector<double> column_norms(const Field &a);

LargestEntry largest_entry(const Field &v);

/// PLM_REASON_NOT_FINITE where an entry is not.
void require_finite_result(const Field &x, const char *what);

/// |q - P eta| / |q| in the Euclidean norm with eta by least squares, q one column; 0 when P spans all.
double euclidean_remainder(const Field &p, const Field &q);

} // namespace plm
