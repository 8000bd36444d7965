#include "structure/field.hpp"
#include "linalg/blas_lapack.hpp"
#include "linalg/lapack.hpp"
#include "linalg/scale.hpp"
#include <algorithm>
#include <cmath>

namespace plm {

Field::Field(const vector<double> &column) : columns_(static_cast<std::int64_t>(column.size()), 1) {
    std::copy(column.begin(), column.end(), columns_.data());
}

Field Field::columns(std::int64_t first, std::int64_t count) const {
    return Field(columns_.columns(first, count));
}

Field Field::columns(const vector<std::int64_t> &chosen) const {
    Field some(rows(), static_cast<std::int64_t>(chosen.size()));
    for (std::int64_t j = 0; j < some.cols(); ++j)
        std::copy_n(columns_.col(chosen[j]), rows(), some.columns_.col(j));
    return some;
}

void Field::append(const Field &other) {
    columns_.append(other.columns_);
}

void Field::put(std::int64_t first, const Field &other) {
    require(other.rows() == rows() && first >= 0 && first + other.cols() <= cols(), "Field::put: shape");
    std::copy_n(other.columns_.data(), rows() * other.cols(), columns_.col(first));
}

vector<double> Field::row(const DofTerms &sum) const {
    vector<double> entries(cols());
    for (std::int64_t j = 0; j < cols(); ++j) entries[j] = at(sum, j);
    return entries;
}

double Field::at(const DofTerms &sum, std::int64_t column) const {
    double value = 0;
    for (const DofTerm &t : sum) value += t.coefficient * columns_(t.dof, column);
    return value;
}

void Field::scale(const vector<double> &factor) {
    for (std::int64_t j = 0; j < cols(); ++j)
        for (std::int64_t i = 0; i < rows(); ++i) columns_(i, j) *= factor[j];
}

void Field::clear() {
    columns_.reset(rows(), cols());
}

Field combine(const Field &v, const Matrix &y) {
    return Field(product('N', 'N', v.in_core(), y));
}

Field combine(const Field &v, const vector<double> &y) {
    require(static_cast<std::int64_t>(y.size()) == v.cols(), "combine: shape");
    Field x(v.rows(), 1);
    if (v.cols() > 0) gemv('N', 1.0, v.in_core(), y.data(), 0.0, x.in_core().data());
    return x;
}

void add_combination(double factor, const Field &v, const Matrix &y, Field &x) {
    gemm('N', 'N', factor, v.in_core(), y, 1.0, x.in_core());
}

void add_combination(double factor, const Field &v, const vector<double> &y, Field &x) {
    require(static_cast<std::int64_t>(y.size()) == v.cols() && x.cols() == 1, "add_combination: shape");
    gemv('N', factor, v.in_core(), y.data(), 1.0, x.in_core().data());
}

void add(double factor, const Field &v, Field &x) {
    require(v.rows() == x.rows() && v.cols() == x.cols(), "add: shape");
    const double *from = v.in_core().data();
    double *to = x.in_core().data();
    for (std::int64_t k = 0; k < x.rows() * x.cols(); ++k) to[k] += factor * from[k];
}

void set_sum(std::initializer_list<Scaled> terms, Field &x) {
    for (const Scaled &t : terms)
        require(t.field.rows() == x.rows() && t.field.cols() == x.cols(), "set_sum: shape");
    double *to = x.in_core().data();
    for (std::int64_t k = 0; k < x.rows() * x.cols(); ++k) {
        double sum = 0;
        for (const Scaled &t : terms) sum += t.factor * t.field.in_core().data()[k];
        to[k] = sum;
    }
}

Matrix gram(const Field &a, const Field &b) {
    if (b.cols() != 1) return product('T', 'N', a.in_core(), b.in_core());
    require(a.rows() == b.rows(), "gram: shape");
    Matrix c(a.cols(), 1);
    if (a.cols() > 0) gemv('T', 1.0, a.in_core(), b.in_core().data(), 0.0, c.data());
    return c;
}

vector<double> column_products(const Field &a, const Field &b) {
    require(a.rows() == b.rows() && a.cols() == b.cols(), "column_products: shape");
    vector<double> products(a.cols());
    for (std::int64_t j = 0; j < a.cols(); ++j)
        products[j] = dot(a.rows(), a.in_core().col(j), b.in_core().col(j));
    return products;
}

vector<double> column_norms(const Field &a) {
    vector<double> norms(a.cols());
    for (std::int64_t j = 0; j < a.cols(); ++j) norms[j] = norm2(a.rows(), a.in_core().col(j));
    return norms;
}

LargestEntry largest_entry(const Field &v) {
    LargestEntry largest;
    for (std::int64_t i = 0; i < v.rows(); ++i) {
        double size = 0;
        for (std::int64_t j = 0; j < v.cols(); ++j) size = std::hypot(size, v.at(i, j));
        if (size > largest.size) largest = {i, size};
    }
    return largest;
}

void require_finite_result(const Field &x, const char *what) {
    require_finite_result(x.in_core().data(), x.rows() * x.cols(), what);
}

double euclidean_remainder(const Field &p, const Field &q) {
    if (p.rows() <= p.cols()) return 0; // P spans everything
    const double size = column_norms(q)[0];
    if (!(size > 0)) return 0;
    Field remainder = q;
    add_combination(-1.0, p, least_squares(p.in_core(), q.in_core()), remainder);
    return column_norms(remainder)[0] / size;
}

} // namespace plm
