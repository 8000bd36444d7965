#include "structure/field.hpp"
#include "linalg/blas_lapack.hpp"
#include "linalg/scale.hpp"
#include <algorithm>

namespace plm {
namespace {

const Matrix &array_of(const Matrix *columns) {
    if (!columns) throw Error(status::internal, "columns that are not in core were asked for as an array");
    return *columns;
}

} // namespace

const TallBlock &Field::nothing() {
    static const std::unique_ptr<TallBlock> none = tall_block(Matrix());
    return *none;
}

TallBlock &Field::block() {
    if (!block_) block_ = tall_block(Matrix());
    return *block_;
}

const Matrix &Field::in_core() const {
    return array_of(block().matrix());
}

Matrix &Field::in_core() {
    return const_cast<Matrix &>(array_of(block().matrix()));
}

Field::Field(const vector<double> &column) : Field(static_cast<std::int64_t>(column.size()), 1) {
    std::copy(column.begin(), column.end(), in_core().data());
}

void Field::append(const Field &other) {
    if (!block_)
        block_ = other.copy();
    else if (other.block_)
        block_->append(other.block());
}

void Field::put(std::int64_t first, const Field &other) {
    require(other.rows() == rows() && first >= 0 && first + other.cols() <= cols(), "Field::put: shape");
    block().put(first, other.block());
}

Field Field::sums(const std::vector<DofTerms> &sums) const {
    Field some = zeros(static_cast<std::int64_t>(sums.size()));
    some.block().add_sums(sums);
    return some;
}

vector<double> Field::row(const DofTerms &sum) const {
    vector<std::int64_t> dofs;
    for (const DofTerm &t : sum) dofs.push_back(t.dof);
    const Matrix entries = rows_at(dofs);
    vector<double> values(cols(), 0.0);
    for (std::int64_t j = 0; j < cols(); ++j)
        for (std::size_t i = 0; i < sum.size(); ++i)
            values[j] += sum[i].coefficient * entries(static_cast<std::int64_t>(i), j);
    return values;
}

double Field::at(const DofTerms &sum, std::int64_t column) const {
    double value = 0;
    for (const DofTerm &t : sum) value += t.coefficient * at(t.dof, column);
    return value;
}

Field combine(const Field &v, const Matrix &y) {
    return Field(v.block().times(y));
}

Field combine(const Field &v, const vector<double> &y) {
    require(static_cast<std::int64_t>(y.size()) == v.cols(), "combine: shape");
    return Field(v.block().times(y));
}

void add_combination(double factor, const Field &v, const Matrix &y, Field &x) {
    x.block().add_product(factor, v.block(), y);
}

void add_combination(double factor, const Field &v, const vector<double> &y, Field &x) {
    require(x.cols() == 1, "add_combination: shape");
    add_to_column(factor, v, y, x, 0);
}

void add_combination_of_columns(double factor, const Field &v, std::int64_t first, const Matrix &y,
                                Field &x) {
    require(first >= 0 && first + y.rows() <= v.cols() && y.cols() == x.cols(),
            "add_combination_of_columns: shape");
    x.block().add_product(factor, v.block(), first, y);
}

void add_to_column(double factor, const Field &v, const vector<double> &y, Field &x, std::int64_t column) {
    require(static_cast<std::int64_t>(y.size()) == v.cols() && v.rows() == x.rows(), "add_to_column: shape");
    x.block().add_product(factor, v.block(), y, column);
}

void add(double factor, const Field &v, Field &x) {
    require(v.rows() == x.rows() && v.cols() == x.cols(), "add: shape");
    x.block().add(factor, v.block());
}

void set_sum(std::initializer_list<Scaled> terms, Field &x) {
    vector<double> factor;
    vector<const TallBlock *> v;
    for (const Scaled &t : terms) {
        require(t.field.rows() == x.rows() && t.field.cols() == x.cols(), "set_sum: shape");
        factor.push_back(t.factor), v.push_back(&t.field.block());
    }
    x.block().set_sum(factor, v);
}

Matrix gram(const Field &a, const Field &b) {
    require(a.rows() == b.rows(), "gram: shape");
    return a.block().gram(b.block(), true);
}

Matrix block_gram(const Field &a, const Field &b) {
    require(a.rows() == b.rows(), "block_gram: shape");
    return a.block().gram(b.block(), false);
}

vector<double> column_products(const Field &a, const Field &b) {
    require(a.rows() == b.rows() && a.cols() == b.cols(), "column_products: shape");
    return a.block().products(b.block());
}

vector<double> column_norms(const Field &a) {
    return a.block().norms();
}

LargestEntry largest_entry(const Field &v) {
    return v.block().largest();
}

void require_finite_result(const Field &x, const char *what) {
    if (const Matrix *columns = x.block().matrix())
        return require_finite_result(columns->data(), x.rows() * x.cols(), what);
    const double wrong = x.is_finite() ? 0 : NAN;
    require_finite_result(&wrong, 1, what);
}

double euclidean_remainder(const Field &p, const Field &q) {
    return p.block().remainder(q.block());
}

} // namespace plm
