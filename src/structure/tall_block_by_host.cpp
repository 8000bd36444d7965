#include "structure/tall_block_by_host.hpp"
#include "linalg/blas_lapack.hpp"
#include "linalg/lapack.hpp"
#include "structure/sparse.hpp"
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace plm {
namespace {

namespace op = tall_operation;

vector<std::int64_t> range(std::int64_t first, std::int64_t count) {
    vector<std::int64_t> numbers(static_cast<std::size_t>(count));
    std::iota(numbers.begin(), numbers.end(), first);
    return numbers;
}

/// Gap rows by the few DOFs that they hold.
struct CompactRows {
    vector<std::int64_t> dofs;
    SparseMatrix b; // rows x dofs

    explicit CompactRows(const SparseMatrix &wide) {
        b.rows = wide.rows;
        b.ptr.push_back(0);
        for (std::int64_t j = 0; j < wide.cols; ++j) {
            if (wide.ptr[j] == wide.ptr[j + 1]) continue;
            dofs.push_back(j);
            b.idx.insert(b.idx.end(), wide.idx.begin() + wide.ptr[j], wide.idx.begin() + wide.ptr[j + 1]);
            b.val.insert(b.val.end(), wide.val.begin() + wide.ptr[j], wide.val.begin() + wide.ptr[j + 1]);
            b.ptr.push_back(b.nnz());
        }
        b.cols = static_cast<std::int64_t>(dofs.size());
    }
};

} // namespace

const HostBlock &HostBlock::of(const TallBlock &block) {
    const auto *host = dynamic_cast<const HostBlock *>(&block);
    if (!host)
        throw Error(status::state, "vectors in this process meet those that the host keeps behind its tall "
                                   "operations: they do not belong to one model")
            .argument("model");
    return *host;
}

std::unique_ptr<TallBlock> HostBlock::filled(std::int64_t cols, const ColumnFill &e) const {
    std::unique_ptr<HostBlock> x = fresh();
    if (cols > 0) host_->run(op::fill, {x->handle_, cols, e.seed}, {e.constant, e.wave, e.noise});
    x->cols_ = cols;
    return x;
}

// What is not zero goes over; all of it where that is most.
std::unique_ptr<TallBlock> HostBlock::from_column(const vector<double> &column) const {
    std::unique_ptr<TallBlock> x = filled(1, {});
    vector<std::int64_t> dofs;
    for (std::int64_t i = 0; i < rows_; ++i)
        if (column[i] != 0) dofs.push_back(i);
    if (dofs.empty()) return x;
    if (2 * static_cast<std::int64_t>(dofs.size()) > rows_) {
        host_->run(op::set_rows, {of(*x).handle_, 0, 1, -1}, {0.0}, column.data());
        return x;
    }
    Matrix values(static_cast<std::int64_t>(dofs.size()), 1);
    for (std::size_t i = 0; i < dofs.size(); ++i) values.data()[i] = column[dofs[i]];
    static_cast<HostBlock &>(*x).set_rows(0, dofs, values);
    return x;
}

std::unique_ptr<TallBlock> HostBlock::columns(std::int64_t first, std::int64_t count) const {
    return columns(range(first, count));
}

std::unique_ptr<TallBlock> HostBlock::columns(const vector<std::int64_t> &chosen) const {
    std::unique_ptr<HostBlock> x = fresh();
    x->copy(*this, 0, chosen);
    return x;
}

void HostBlock::copy(const HostBlock &from, std::int64_t first, const vector<std::int64_t> &chosen) {
    const auto count = static_cast<std::int64_t>(chosen.size());
    if (count == 0) return;
    TallOperations::Numbers number{handle_, first, from.handle_, count};
    number.insert(number.end(), chosen.begin(), chosen.end());
    host_->run(op::copy, number);
    cols_ = std::max(cols_, first + count);
}

// X = beta X + alpha V Y for all of X, Y with as many rows as V has columns.
void HostBlock::combine(double beta, double alpha, const HostBlock &v, const double *y, bool diagonal) {
    if (cols_ == 0) return;
    host_->run(op::combine, {handle_, 0, cols_, v.handle_, 0, v.cols_, diagonal}, {beta, alpha}, y);
}

std::unique_ptr<TallBlock> HostBlock::times(const Matrix &y) const {
    require(y.rows() == cols_, "times: shape");
    if (cols_ == 0) return filled(y.cols(), {});
    std::unique_ptr<HostBlock> x = fresh();
    x->cols_ = y.cols();
    x->combine(0, 1, *this, y.data(), false);
    return x;
}

std::unique_ptr<TallBlock> HostBlock::times(const vector<double> &y) const {
    Matrix one(static_cast<std::int64_t>(y.size()), 1);
    std::copy(y.begin(), y.end(), one.data());
    return times(one);
}

std::unique_ptr<TallBlock> HostBlock::from_rows(const SparseMatrix &b, const Matrix &f) const {
    std::unique_ptr<TallBlock> x = filled(f.cols(), {});
    const CompactRows rows(b);
    if (!rows.dofs.empty() && f.cols() > 0)
        static_cast<HostBlock &>(*x).set_rows(0, rows.dofs, multiply_transposed(rows.b, f));
    return x;
}

std::unique_ptr<TallBlock> HostBlock::from_rows(const SparseMatrix &b) const {
    return from_rows(b, identity(b.rows));
}

void HostBlock::append(const TallBlock &other) {
    copy(of(other), cols_, range(0, other.cols()));
}

void HostBlock::put(std::int64_t first, const TallBlock &other) {
    copy(of(other), first, range(0, other.cols()));
}

void HostBlock::copy_column(std::int64_t from, std::int64_t to) {
    if (from != to) copy(*this, to, {from});
}

void HostBlock::clear() {
    if (cols_ > 0) host_->run(op::combine, {handle_, 0, cols_, handle_, 0, 0, 0}, {0.0, 0.0});
}

void HostBlock::add_product(double factor, const TallBlock &v, const Matrix &y) {
    require(y.rows() == v.cols() && y.cols() == cols_, "add_product: shape");
    if (v.cols() > 0) combine(1, factor, of(v), y.data(), false);
}

void HostBlock::add_product(double factor, const TallBlock &v, std::int64_t first, const Matrix &y) {
    if (y.rows() == 0 || cols_ == 0) return;
    host_->run(op::combine, {handle_, 0, cols_, of(v).handle_, first, y.rows(), 0}, {1.0, factor}, y.data());
}

void HostBlock::add_product(double factor, const TallBlock &v, const vector<double> &y, std::int64_t column) {
    if (v.cols() == 0) return;
    host_->run(op::combine, {handle_, column, 1, of(v).handle_, 0, v.cols(), 0}, {1.0, factor}, y.data());
}

void HostBlock::replace_by_product(const Matrix &y, std::int64_t count) {
    require(y.rows() == cols_ && count <= cols_, "replace_by_product: shape");
    if (count > 0) host_->run(op::combine, {handle_, 0, count, handle_, 0, cols_, 0}, {0.0, 1.0}, y.data());
    cols_ = count;
}

void HostBlock::divide(char triangle, bool transposed, const Matrix &r) {
    Matrix inverse = identity(cols_);
    const blas_int n = to_blas(cols_);
    const double one = 1;
    if (n == 0) return;
    dtrsm_("R", &triangle, transposed ? "T" : "N", "N", &n, &n, &one, r.data(), &n, inverse.data(), &n, 1, 1,
           1, 1);
    combine(0, 1, *this, inverse.data(), false);
}

void HostBlock::scale(const vector<double> &factor) {
    combine(0, 1, *this, factor.data(), true);
}

void HostBlock::divide(const vector<double> &divisor) {
    vector<double> factor;
    for (double d : divisor) factor.push_back(1 / d);
    scale(factor);
}

void HostBlock::add(double factor, const TallBlock &v) {
    if (&v == this) return scale(vector<double>(cols_, 1 + factor));
    combine(1, factor, of(v), vector<double>(cols_, 1.0).data(), true);
}

void HostBlock::set_sum(const vector<double> &factor, const vector<const TallBlock *> &v) {
    double own = 0;
    for (std::size_t t = 0; t < v.size(); ++t)
        if (v[t] == this) own += factor[t];
    if (own == 0)
        clear();
    else if (own != 1)
        scale(vector<double>(cols_, own));
    for (std::size_t t = 0; t < v.size(); ++t)
        if (v[t] != this) add(factor[t], *v[t]);
}

void HostBlock::set_rows(double beta, const vector<std::int64_t> &rows, const Matrix &values) {
    if (rows.empty() || cols_ == 0) return;
    TallOperations::Numbers number{handle_, 0, cols_, static_cast<std::int64_t>(rows.size())};
    number.insert(number.end(), rows.begin(), rows.end());
    host_->run(op::set_rows, number, {beta}, values.data());
}

void HostBlock::zero_rows(const vector<std::int64_t> &rows) {
    set_rows(0, rows, Matrix(static_cast<std::int64_t>(rows.size()), cols_));
}

void HostBlock::add_sums(const std::vector<DofTerms> &sums) {
    std::map<std::int64_t, std::int64_t> place;
    for (const DofTerms &sum : sums)
        for (const DofTerm &t : sum) place[t.dof];
    vector<std::int64_t> rows;
    for (auto &[dof, at] : place) at = static_cast<std::int64_t>(rows.size()), rows.push_back(dof);
    Matrix values(static_cast<std::int64_t>(rows.size()), cols_);
    for (std::size_t j = 0; j < sums.size(); ++j)
        for (const DofTerm &t : sums[j]) values(place[t.dof], static_cast<std::int64_t>(j)) += t.coefficient;
    set_rows(1, rows, values);
}

double HostBlock::at(std::int64_t row, std::int64_t column) const {
    double value = 0;
    host_->run(op::rows, {handle_, column, 1, 1, row}, {}, nullptr, &value);
    return value;
}

Matrix HostBlock::rows_at(const vector<std::int64_t> &rows) const {
    Matrix values(static_cast<std::int64_t>(rows.size()), cols_);
    if (values.empty()) return values;
    TallOperations::Numbers number{handle_, 0, cols_, values.rows()};
    number.insert(number.end(), rows.begin(), rows.end());
    host_->run(op::rows, number, {}, nullptr, values.data());
    return values;
}

vector<double> HostBlock::column(std::int64_t j) const {
    vector<double> all(static_cast<std::size_t>(rows_), 0.0);
    host_->run(op::rows, {handle_, j, 1, -1}, {}, nullptr, all.data());
    return all;
}

Matrix HostBlock::gram(const TallBlock &b, bool) const {
    Matrix products(cols_, b.cols());
    if (products.empty()) return products;
    host_->run(op::gram, {handle_, 0, cols_, of(b).handle_, 0, b.cols(), 0, 0}, {}, nullptr, products.data());
    return products;
}

vector<double> HostBlock::products(const TallBlock &b) const {
    vector<double> products(static_cast<std::size_t>(cols_), 0.0);
    if (cols_ > 0)
        host_->run(op::gram, {handle_, 0, cols_, of(b).handle_, 0, cols_, 1, 0}, {}, nullptr,
                   products.data());
    return products;
}

vector<double> HostBlock::absolute_products(const TallBlock &one) const {
    vector<double> products(static_cast<std::size_t>(cols_), 0.0);
    if (cols_ > 0)
        host_->run(op::gram, {handle_, 0, cols_, of(one).handle_, 0, 1, 0, 1}, {}, nullptr, products.data());
    return products;
}

vector<double> HostBlock::norms() const {
    vector<double> norms = products(*this);
    for (double &n : norms) n = std::sqrt(n);
    return norms;
}

Matrix HostBlock::by_rows(const SparseMatrix &b) const {
    const CompactRows rows(b);
    return multiply(rows.b, rows_at(rows.dofs));
}

void HostBlock::by_rows(const SparseMatrix &b, double *u) const {
    const Matrix gaps = by_rows(b);
    std::copy_n(gaps.data(), gaps.rows(), u);
}

Matrix HostBlock::terms_by_rows(const SparseMatrix &b) const {
    CompactRows rows(b);
    Matrix motion = rows_at(rows.dofs);
    for (double &v : rows.b.val) v = std::abs(v);
    for (std::int64_t k = 0; k < motion.rows() * motion.cols(); ++k)
        motion.data()[k] = std::abs(motion.data()[k]);
    return multiply(rows.b, motion);
}

vector<double> HostBlock::look() const {
    vector<double> seen(3, 0.0);
    seen[0] = 1;
    if (cols_ == 0) return seen;
    seen[0] = 0;
    host_->run(op::look, {handle_, 0, cols_}, {}, nullptr, seen.data());
    return seen;
}

LargestEntry HostBlock::largest() const {
    const vector<double> seen = look();
    return {static_cast<std::int64_t>(seen[2]), seen[1]};
}

bool HostBlock::is_finite() const {
    return look()[0] == 1;
}

// By the products of the columns, scaled to one, without what they hold twice; twice for the digits.
double HostBlock::remainder(const TallBlock &q) const {
    const double size = q.norms()[0];
    if (rows_ <= cols_ || !(size > 0)) return 0;
    vector<double> length = norms();
    for (double &l : length) l = l > 0 ? l : 1;
    Matrix products = gram(*this, false);
    for (std::int64_t j = 0; j < cols_; ++j)
        for (std::int64_t i = 0; i < cols_; ++i) products(i, j) /= length[i] * length[j];
    const SymmetricEigen e = symmetric_eigen(products);
    std::unique_ptr<TallBlock> rest = q.columns(0, 1);
    for (int pass = 0; pass < 2; ++pass) {
        Matrix along = gram(*rest, false);
        for (std::int64_t i = 0; i < cols_; ++i) along(i, 0) /= length[i];
        along = product('T', 'N', e.vectors, along);
        for (std::int64_t k = 0; k < cols_; ++k)
            along(k, 0) = e.values[k] > 1e-14 * e.values.back() ? along(k, 0) / e.values[k] : 0.0;
        along = product('N', 'N', e.vectors, along);
        for (std::int64_t i = 0; i < cols_; ++i) along(i, 0) /= length[i];
        rest->add_product(-1, *this, along);
    }
    return rest->norms()[0] / size;
}

} // namespace plm
