// Compressed rows over the DOFs of a model, as gap rows and constraints come.
#pragma once
#include "capi/model_input.hpp"
#include <algorithm>
#include <numeric>

namespace plm::capi {

/// what: the name of a row in texts.
template <class Index> struct SparseRows {
    const char *what, *when_zero;
    std::int64_t n, base;
    const Index *row_ptr, *dof;
    const double *coefficient;
};

/// name: of the argument; what: one of the n things that it has the entries of.
template <class Index>
void check_pointers(const Index *pointer, const char *name, std::int64_t n, std::int64_t base,
                    const char *what) {
    using Int = long long;
    require_pointer(pointer, name);
    if (pointer[0] != base)
        bad_argument(name, 0,
                     format("%s[0] = %lld must be the index base %lld", name, Int(pointer[0]), Int(base)));
    for (std::int64_t i = 0; i < n; ++i)
        if (pointer[i + 1] <= pointer[i])
            bad_argument(name, i + 1,
                         format("%s[%lld] = %lld: every %s needs at least one entry, so "
                                "the pointers must increase",
                                name, Int(i + 1), Int(pointer[i + 1]), what));
}

template <class Index> void check_row_pointers(const SparseRows<Index> &x) {
    check_pointers(x.row_ptr, "row_ptr", x.n, x.base, x.what);
}

/// Positions of one row, its DOFs in order, so that a repeated one is found in rows of any length.
template <class Index>
void refuse_repeated_dof(const SparseRows<Index> &x, std::int64_t row, vector<std::int64_t> &order) {
    order.resize(static_cast<std::size_t>(x.row_ptr[row + 1] - x.row_ptr[row]));
    std::iota(order.begin(), order.end(), x.row_ptr[row] - x.base);
    std::sort(order.begin(), order.end(), [&](std::int64_t a, std::int64_t b) {
        return x.dof[a] != x.dof[b] ? x.dof[a] < x.dof[b] : a < b;
    });
    const auto same = std::adjacent_find(
        order.begin(), order.end(), [&](std::int64_t a, std::int64_t b) { return x.dof[a] == x.dof[b]; });
    if (same != order.end())
        bad_argument("dof", same[1],
                     format("dof[%lld] = %lld stands twice in %s %lld; sum its coefficients",
                            static_cast<long long>(same[1]), static_cast<long long>(x.dof[same[1]]), x.what,
                            static_cast<long long>(row)));
}

/// take(row, dof, coefficient) for every entry, base 0; the row pointers are checked already.
template <class Index, class Take>
void for_entries(const SparseRows<Index> &x, std::int64_t n_dof, Take take) {
    const std::int64_t nnz = x.row_ptr[x.n] - x.base;
    if (nnz > 0) require_pointer(x.dof, "dof");
    require_finite_array(x.coefficient, nnz, "coefficient");
    for (std::int64_t p = 0; p < nnz; ++p) require_dof(x.dof[p], x.base, n_dof, "dof", p);
    vector<std::int64_t> order;
    for (std::int64_t i = 0; i < x.n; ++i) {
        refuse_repeated_dof(x, i, order);
        double largest = 0;
        for (std::int64_t p = x.row_ptr[i] - x.base; p < x.row_ptr[i + 1] - x.base; ++p) {
            take(i, static_cast<std::int64_t>(x.dof[p]) - x.base, x.coefficient[p]);
            largest = std::max(largest, std::abs(x.coefficient[p]));
        }
        if (!(largest > 0))
            bad_argument("coefficient", x.row_ptr[i] - x.base,
                         format("%s %lld is zero; %s", x.what, static_cast<long long>(i), x.when_zero));
    }
}

} // namespace plm::capi
