#include "structure/exchanged.hpp"
#include "linalg/error.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

using Int = long long; // for printf

// Two nodes that are joined have a negative entry of stiffness between them, and only mass can be without.
bool has_negative_entry(const SparseMatrix &a, const Translation &t) {
    for (std::int64_t j = t.first; j < a.cols; j += t.step)
        for (std::int64_t p = a.ptr[j]; p < a.ptr[j + 1]; ++p)
            if (t.holds(a.idx[p]) && a.val[p] < 0) return true;
    return false;
}

// Most columns cancel where the DOFs of a translation move alike: all but those beside a support.
bool looks_like_stiffness(const SparseMatrix &m, const Translation &t) {
    std::int64_t cancelled = 0, columns = 0;
    for (std::int64_t j = t.first; j < m.cols; j += t.step) {
        double sum = 0, terms = 0;
        for (std::int64_t p = m.ptr[j]; p < m.ptr[j + 1]; ++p)
            if (t.holds(m.idx[p])) sum += m.val[p], terms += std::abs(m.val[p]);
        columns += terms > 0;
        cancelled += terms > 0 && std::abs(sum) < 1e-6 * terms;
    }
    return 2 * cancelled > columns;
}

} // namespace

vector<Translation> without_negative_entries(const SparseMatrix &k) {
    vector<Translation> found;
    for (std::int64_t step : {1, 2, 3, 6})
        for (std::int64_t first = 0; first < std::min(step, k.cols); ++first)
            if (!has_negative_entry(k, {first, step})) found.push_back({first, step});
    return found;
}

void refuse_exchanged(const vector<Translation> &mass_like, const SparseMatrix &m) {
    for (const Translation &t : mass_like)
        if (looks_like_stiffness(m, t))
            throw Error(
                status::matrix,
                format("mass and stiffness are probably exchanged: the entries of the mass matrix "
                       "cancel where DOFs %lld, %lld, ... (%lld per node, counted from 0) move alike, "
                       "as those of a stiffness do, and those of the stiffness matrix are all "
                       "positive there; hand them over the other way round (PLM_MASS, PLM_STIFFNESS)",
                       Int(t.first), Int(t.first + t.step), Int(t.step)))
                .argument("which");
}

} // namespace plm
