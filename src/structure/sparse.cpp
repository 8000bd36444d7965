// Construction and rearrangement of sparse matrices.
#include "structure/sparse.hpp"
#include "linalg/blas_lapack.hpp"
#include <algorithm>

namespace plm {
namespace {

SparseMatrix shaped(std::int64_t rows, std::int64_t cols, std::int64_t nnz) {
    SparseMatrix a;
    a.rows = rows;
    a.cols = cols;
    a.ptr.assign(cols + 1, 0);
    a.idx.resize(nnz);
    a.val.resize(nnz);
    return a;
}

/// Turns counts in ptr[j + 1] into offsets, and returns a copy to be used as insertion points.
vector<std::int64_t> offsets(vector<std::int64_t> &ptr) {
    for (std::size_t j = 1; j < ptr.size(); ++j) ptr[j] += ptr[j - 1];
    return vector<std::int64_t>(ptr.begin(), ptr.end() - 1);
}

bool sorted(const SparseMatrix &a) {
    for (std::int64_t j = 0; j < a.cols; ++j)
        for (std::int64_t p = a.ptr[j] + 1; p < a.ptr[j + 1]; ++p)
            if (a.idx[p - 1] >= a.idx[p]) return false;
    return true;
}

} // namespace

SparseMatrix from_triplets(std::int64_t rows, std::int64_t cols, const vector<std::int64_t> &i,
                           const vector<std::int64_t> &j, const vector<double> &v) {
    const auto count = static_cast<std::int64_t>(v.size());
    require(rows >= 0 && cols >= 0 && i.size() == v.size() && j.size() == v.size(), "from_triplets: sizes");
    // Two stable counting sorts, by row and then by column: duplicates meet in the order given, so that the
    // rounding of their sum does not depend on anything else.
    vector<std::int64_t> by_row(count), row_ptr(rows + 1, 0);
    SparseMatrix a = shaped(rows, cols, count);
    for (std::int64_t t = 0; t < count; ++t) {
        if (i[t] < 0 || i[t] >= rows || j[t] < 0 || j[t] >= cols)
            throw Error(status::argument, "triplet index out of range").index(t);
        ++row_ptr[i[t] + 1];
        ++a.ptr[j[t] + 1];
    }
    vector<std::int64_t> next_in_row = offsets(row_ptr), next = offsets(a.ptr);
    for (std::int64_t t = 0; t < count; ++t) by_row[next_in_row[i[t]]++] = t;
    for (std::int64_t t : by_row) {
        const std::int64_t p = next[j[t]]++;
        a.idx[p] = i[t];
        a.val[p] = v[t];
    }
    std::int64_t kept = 0;
    for (std::int64_t c = 0, p = 0; c < cols; ++c) {
        const std::int64_t begin = kept, end = a.ptr[c + 1];
        for (; p < end; ++p) {
            if (kept > begin && a.idx[kept - 1] == a.idx[p]) {
                a.val[kept - 1] += a.val[p];
            } else {
                a.idx[kept] = a.idx[p];
                a.val[kept++] = a.val[p];
            }
        }
        a.ptr[c + 1] = kept;
    }
    a.idx.resize(kept);
    a.val.resize(kept);
    return a;
}

SparseMatrix transpose(const SparseMatrix &a) {
    SparseMatrix t = shaped(a.cols, a.rows, a.nnz());
    for (std::int64_t i : a.idx) ++t.ptr[i + 1];
    vector<std::int64_t> next = offsets(t.ptr);
    for (std::int64_t j = 0; j < a.cols; ++j)
        for (std::int64_t p = a.ptr[j]; p < a.ptr[j + 1]; ++p) {
            const std::int64_t q = next[a.idx[p]]++;
            t.idx[q] = j;
            t.val[q] = a.val[p];
        }
    return t;
}

namespace {

/// entry(p, q) for each entry of either matrix, column by column: its place in A and in B, or -1; column(j)
/// at the end of column j.
template <class Entry, class Column>
void merge(const SparseMatrix &a, const SparseMatrix &b, const Entry &entry, const Column &column) {
    for (std::int64_t j = 0; j < a.cols; ++j) {
        std::int64_t p = a.ptr[j], q = b.ptr[j];
        const std::int64_t p_end = a.ptr[j + 1], q_end = b.ptr[j + 1];
        while (p < p_end || q < q_end) {
            const bool from_a = p < p_end && (q >= q_end || a.idx[p] <= b.idx[q]);
            const bool from_b = q < q_end && (p >= p_end || b.idx[q] <= a.idx[p]);
            entry(from_a ? p : -1, from_b ? q : -1);
            p += from_a;
            q += from_b;
        }
        column(j);
    }
}

} // namespace

SparseMatrix add(double alpha, const SparseMatrix &a, double beta, const SparseMatrix &b) {
    require(a.rows == b.rows && a.cols == b.cols, "sparse add: shapes differ");
    std::int64_t count = 0, n = 0; // counted first: the sum takes no more than it needs
    merge(
        a, b, [&](std::int64_t, std::int64_t) { ++count; }, [](std::int64_t) {});
    SparseMatrix c = shaped(a.rows, a.cols, count);
    merge(
        a, b,
        [&](std::int64_t p, std::int64_t q) {
            c.idx[n] = p >= 0 ? a.idx[p] : b.idx[q];
            c.val[n++] = (p >= 0 ? alpha * a.val[p] : 0) + (q >= 0 ? beta * b.val[q] : 0);
        },
        [&](std::int64_t j) { c.ptr[j + 1] = n; });
    return c;
}

SparseMatrix submatrix(const SparseMatrix &a, const vector<std::int64_t> &keep_row, std::int64_t n_rows,
                       const vector<std::int64_t> &keep_col, std::int64_t n_cols) {
    require(static_cast<std::int64_t>(keep_row.size()) == a.rows &&
                static_cast<std::int64_t>(keep_col.size()) == a.cols,
            "submatrix: one entry per row and per column");
    vector<std::int64_t> source(n_cols, -1); // the column of `a` that becomes column j
    for (std::int64_t j = 0; j < a.cols; ++j) {
        if (keep_col[j] < 0) continue;
        require(keep_col[j] < n_cols && source[keep_col[j]] < 0, "submatrix: column numbers");
        source[keep_col[j]] = j;
    }
    const auto is_kept = [&](std::int64_t i) { return keep_row[i] >= 0; };
    std::int64_t kept = 0;
    for (std::int64_t j : source)
        if (j >= 0) kept += std::count_if(a.idx.begin() + a.ptr[j], a.idx.begin() + a.ptr[j + 1], is_kept);
    SparseMatrix s = shaped(n_rows, n_cols, 0);
    s.idx.reserve(kept), s.val.reserve(kept); // grown step by step, they would take twice the memory
    for (std::int64_t j = 0; j < n_cols; ++j) {
        const std::int64_t from = source[j];
        for (std::int64_t p = from < 0 ? 0 : a.ptr[from]; from >= 0 && p < a.ptr[from + 1]; ++p) {
            const std::int64_t i = keep_row[a.idx[p]];
            if (i < 0) continue;
            require(i < n_rows, "submatrix: row numbers");
            s.idx.push_back(i);
            s.val.push_back(a.val[p]);
        }
        s.ptr[j + 1] = s.nnz();
    }
    if (sorted(s)) return s;
    return transpose(transpose(s)); // the rows were permuted: transposing twice sorts them
}

SparseMatrix without_zeros(SparseMatrix a) {
    constexpr std::int64_t good_part = 4; // one of so many
    const auto is_needed = [&](std::int64_t j, std::int64_t p) { return a.val[p] != 0 || a.idx[p] == j; };
    std::int64_t needed = 0;
    for (std::int64_t j = 0; j < a.cols; ++j)
        for (std::int64_t p = a.ptr[j]; p < a.ptr[j + 1]; ++p) needed += is_needed(j, p);
    if (is_dense(a) || (a.nnz() - needed) * good_part < a.nnz()) return a;
    SparseMatrix s = shaped(a.rows, a.cols, needed);
    std::int64_t k = 0;
    for (std::int64_t j = 0; j < a.cols; ++j) {
        for (std::int64_t p = a.ptr[j]; p < a.ptr[j + 1]; ++p)
            if (is_needed(j, p)) s.idx[k] = a.idx[p], s.val[k] = a.val[p], ++k;
        s.ptr[j + 1] = k;
    }
    return s;
}

Matrix to_dense(const SparseMatrix &a) {
    Matrix d(a.rows, a.cols);
    for (std::int64_t j = 0; j < a.cols; ++j)
        for (std::int64_t p = a.ptr[j]; p < a.ptr[j + 1]; ++p) d(a.idx[p], j) = a.val[p];
    return d;
}

bool is_dense(const SparseMatrix &a) {
    constexpr std::int64_t few = 64; // rows or columns, below which a pass over a sparse matrix is as fast
    return a.rows >= few && a.cols >= few && a.nnz() == a.rows * a.cols;
}

double norm_inf(const SparseMatrix &a) {
    vector<double> sum(a.rows, 0.0);
    for (std::int64_t p = 0; p < a.nnz(); ++p) sum[a.idx[p]] += std::fabs(a.val[p]);
    double largest = 0;
    for (double s : sum) largest = s > largest || std::isnan(s) ? s : largest;
    return largest;
}

vector<double> diagonal(const SparseMatrix &a) {
    vector<double> d(a.cols, 0.0);
    for (std::int64_t j = 0; j < a.cols; ++j) {
        const auto begin = a.idx.begin() + a.ptr[j], end = a.idx.begin() + a.ptr[j + 1];
        const auto at = std::lower_bound(begin, end, j);
        if (at != end && *at == j) d[j] = a.val[at - a.idx.begin()];
    }
    return d;
}

double trace(const SparseMatrix &a) {
    double sum = 0;
    for (double d : diagonal(a)) sum += d;
    return sum;
}

} // namespace plm
