#include "structure/dof_map.hpp"
#include "linalg/error.hpp"
#include <algorithm>
#include <cmath>
#include <map>

namespace plm {
namespace {

using Int = long long; // for printf

/// A symmetric matrix from its upper triangle, the diagonal with it.
SparseMatrix mirrored(const SparseMatrix &upper) {
    const SparseMatrix lower = transpose(upper);
    SparseMatrix a;
    a.rows = a.cols = upper.cols;
    a.ptr.assign(1, 0);
    a.idx.reserve(2 * upper.nnz()), a.val.reserve(2 * upper.nnz());
    const auto take = [&](const SparseMatrix &from, std::int64_t p) {
        a.idx.push_back(from.idx[p]);
        a.val.push_back(from.val[p]);
    };
    for (std::int64_t j = 0; j < a.cols; ++j) {
        for (std::int64_t p = upper.ptr[j]; p < upper.ptr[j + 1]; ++p) take(upper, p);
        for (std::int64_t p = lower.ptr[j]; p < lower.ptr[j + 1]; ++p)
            if (lower.idx[p] != j) take(lower, p);
        a.ptr.push_back(a.nnz());
    }
    return a;
}

} // namespace

DofMap::DofMap(std::int64_t n_dof, const vector<std::int64_t> &fixed, const ConstraintRows &constraints,
               const vector<char> &kept, WideRows wide)
    : n_dof_(n_dof), wide_(wide) {
    if (wide == WideRows::in_groups) grouped_ = in_groups(constraints, n_dof);
    const std::size_t all = static_cast<std::size_t>(n_dof) + grouped_.within.size();
    vector<char> is_fixed(all, 0), stays(kept);
    place_.assign(all, 0);
    for (std::int64_t dof : fixed) is_fixed[dof] = 1, place_[dof] = held;
    if (!grouped_.within.empty()) {
        stays.resize(static_cast<std::size_t>(n_dof), 0);
        stays.resize(all, 1); // or nothing is gained
        elimination_ = eliminate(grouped_.rows, is_fixed, stays);
        for (auto &d : elimination_.dependent) d.row = grouped_.given[d.row];
        if (elimination_.missing_row >= 0)
            elimination_.missing_row = grouped_.given[elimination_.missing_row];
    } else {
        elimination_ = eliminate(constraints, is_fixed, stays);
    }
    number_free();
}

void DofMap::number_free() {
    for (const auto &d : elimination_.dependent) place_[d.dof] = held;
    for (std::size_t i = 0; i < place_.size(); ++i)
        if (place_[i] != held) {
            place_[i] = n_free();
            free_dof_.push_back(static_cast<std::int64_t>(i));
        }
    dependent_.rows = n_free();
    dependent_.ptr.assign(1, 0);
    for (auto &d : elimination_.dependent) {
        if (!d.terms.empty()) place_[d.dof] = held - 1 - dependent_.cols++;
        for (const DofTerm &t : d.terms) {
            dependent_.idx.push_back(place_[t.dof]); // of a DOF that stays: its place is its index
            dependent_.val.push_back(t.coefficient);
        }
        if (!d.terms.empty()) dependent_.ptr.push_back(dependent_.nnz());
        d.terms = {};
    }
}

template <class F> void DofMap::for_terms(std::int64_t dof, F f) const {
    const std::int64_t place = place_[dof];
    if (place >= 0) return f(place, 1.0);
    if (place == held) return;
    const std::int64_t k = held - 1 - place;
    for (std::int64_t p = dependent_.ptr[k]; p < dependent_.ptr[k + 1]; ++p)
        f(dependent_.idx[p], dependent_.val[p]);
}

DofTerms DofMap::terms(std::int64_t dof) const {
    DofTerms terms;
    for_terms(dof, [&](std::int64_t free, double c) { terms.push_back({free, c}); });
    return terms;
}

DofTerms DofMap::terms(const DofTerms &sum) const {
    std::map<std::int64_t, double> by_free;
    for (const DofTerm &given : sum)
        for_terms(given.dof, [&](std::int64_t free, double c) { by_free[free] += given.coefficient * c; });
    DofTerms terms;
    for (const auto &[free, c] : by_free)
        if (c != 0) terms.push_back({free, c});
    return terms;
}

vector<std::int64_t> DofMap::told_dofs() const {
    vector<std::int64_t> dofs;
    for (std::int64_t i = 0; i < n_free(); ++i) dofs.push_back(told(i));
    return dofs;
}

bool DofMap::is_held(std::int64_t dof) const {
    return place_[dof] == held;
}

double DofMap::bytes() const {
    return 8.0 * static_cast<double>(place_.size() + free_dof_.size() + dependent_.ptr.size()) +
           16.0 * static_cast<double>(dependent_.nnz() + grouped_.rows.ptr.back());
}

void DofMap::expand(const double *free, double *all) const {
    for (std::int64_t i = 0; i < n_dof(); ++i) {
        double sum = 0;
        for_terms(i, [&](std::int64_t j, double c) { sum += c * free[j]; });
        all[i] = sum;
    }
}

vector<double> DofMap::forces(const double *all) const {
    vector<double> free(free_dof_.size(), 0.0);
    for (std::int64_t i = 0; i < n_dof(); ++i)
        for_terms(i, [&](std::int64_t j, double c) { free[j] += c * all[i]; });
    return free;
}

vector<double> DofMap::free_part(const double *all) const {
    vector<double> free, sums;
    const auto value = [&](std::int64_t dof) { return dof < n_dof_ ? all[dof] : sums[dof - n_dof_]; };
    const ConstraintRows &rows = grouped_.rows;
    const std::int64_t n_sums = static_cast<std::int64_t>(grouped_.within.size());
    for (std::int64_t i = rows.n_rows() - n_sums; i < rows.n_rows(); ++i) {
        double sum = 0;
        for (std::int64_t p = rows.ptr[i]; p + 1 < rows.ptr[i + 1]; ++p) // the last term is the sum itself
            sum += rows.coefficient[p] * value(rows.dof[p]);
        sums.push_back(sum);
    }
    for (std::int64_t dof : free_dof_) free.push_back(value(dof));
    return free;
}

// column(j, rows, sum, size) for each column of the upper triangle of T^T A T: the rows in which it has
// terms, in no order, and by row their sum and that of their absolute values; as long as it returns true.
// dependents: T of the dependent DOFs.
template <class F>
void DofMap::for_upper(const SparseMatrix &a, const SparseMatrix &dependents, F column) const {
    vector<double> sum(n_free(), 0.0), size(n_free(), 0.0);
    vector<std::int64_t> seen(n_free(), -1), rows, dof_of(dependent_.cols);
    for (std::size_t i = 0; i < place_.size(); ++i)
        if (place_[i] < held) dof_of[held - 1 - place_[i]] = static_cast<std::int64_t>(i);
    for (std::int64_t j = 0; j < n_free(); ++j) {
        rows.assign(1, j); // the diagonal is stored, zero or not
        seen[j] = j, sum[j] = size[j] = 0;
        const auto add = [&](std::int64_t dof, double factor) {
            if (dof >= n_dof_) return; // nothing stands at a sum
            for (std::int64_t p = a.ptr[dof]; p < a.ptr[dof + 1]; ++p)
                if (a.val[p] != 0)
                    for_terms(a.idx[p], [&](std::int64_t i, double c) {
                        if (i > j) return;
                        if (seen[i] != j) seen[i] = j, rows.push_back(i), sum[i] = size[i] = 0;
                        const double term = factor * a.val[p] * c;
                        sum[i] += term, size[i] += std::abs(term);
                    });
        };
        add(free_dof_[j], 1.0);
        for (std::int64_t p = dependents.ptr[j]; p < dependents.ptr[j + 1]; ++p)
            add(dof_of[dependents.idx[p]], dependents.val[p]);
        if (!column(j, rows, sum, size)) return;
    }
}

// Counted before anything is formed, and not much beyond the limit.
std::int64_t DofMap::count_reduced(const SparseMatrix &a, const SparseMatrix &dependents,
                                   std::int64_t limit) const {
    std::int64_t upper = 0;
    for_upper(
        a, dependents,
        [&](std::int64_t, const vector<std::int64_t> &rows, const vector<double> &, const vector<double> &) {
            upper += static_cast<std::int64_t>(rows.size());
            return 2 * upper <= limit;
        });
    return 2 * upper;
}

std::optional<SparseMatrix> DofMap::reduced(const char *name, const SparseMatrix &a) const {
    if (!has_dependent()) { // one entry for each that stays
        vector<std::int64_t> free(place_);
        return submatrix(a, free, n_free(), free, n_free());
    }
    // A factorization of what is filled would take far more than of what it was; little is soon factored.
    constexpr std::int64_t little = 1'000'000, times = 4, many = 50'000'000;
    constexpr double rounding = 1e-14; // of sums of a few terms: what would be noise where nothing is
    const SparseMatrix dependents = transpose(dependent_);
    const bool is_whole = wide_ == WideRows::whole;
    const std::int64_t most = std::max(is_whole ? little : many, times * a.nnz()),
                       entries = count_reduced(a, dependents, most);
    if (entries > most) {
        if (is_whole) return std::nullopt;
        refuse_filled(name, a, most);
    }
    SparseMatrix upper;
    upper.rows = upper.cols = n_free();
    upper.ptr.assign(1, 0);
    upper.idx.reserve(entries / 2), upper.val.reserve(entries / 2);
    for_upper(a, dependents,
              [&](std::int64_t j, vector<std::int64_t> &rows, const vector<double> &sum,
                  const vector<double> &size) {
                  std::sort(rows.begin(), rows.end());
                  for (std::int64_t i : rows) {
                      const bool is_zero = std::abs(sum[i]) <= rounding * size[i];
                      if (is_zero && i != j) continue;
                      upper.idx.push_back(i);
                      upper.val.push_back(is_zero ? 0.0 : sum[i]);
                  }
                  upper.ptr.push_back(upper.nnz());
                  return true;
              });
    return mirrored(upper);
}

void DofMap::refuse_filled(const char *name, const SparseMatrix &a, std::int64_t most) const {
    const auto widest = std::max_element(
        elimination_.dependent.begin(), elimination_.dependent.end(),
        [&](const auto &x, const auto &y) { return terms(x.dof).size() < terms(y.dof).size(); });
    throw Error(
        status::memory,
        format("with the constraints eliminated the %s matrix would have more than %lld entries, where it "
               "has %lld: "
               "row %lld (counted from 0, in the order they were added) makes a DOF a sum of %lld others, "
               "and what stands at that DOF couples all of them. Couple fewer nodes, or number the DOFs of "
               "neighbouring nodes one after another",
               name, Int(most), Int(a.nnz()), Int(widest->row), Int(terms(widest->dof).size())))
        .argument("dof")
        .index(widest->row);
}

SparseMatrix DofMap::reduced_rows(std::int64_t n_rows, const vector<std::int64_t> &row,
                                  const vector<std::int64_t> &dof, const vector<double> &coefficient) const {
    vector<std::int64_t> i, j;
    vector<double> v;
    for (std::size_t k = 0; k < row.size(); ++k)
        for_terms(dof[k], [&](std::int64_t free, double c) {
            i.push_back(row[k]), j.push_back(free), v.push_back(coefficient[k] * c);
        });
    return from_triplets(n_rows, n_free(), i, j, v);
}

} // namespace plm
