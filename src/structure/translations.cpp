#include "structure/translations.hpp"
#include <algorithm>
#include <array>
#include <cmath>

namespace plm {
namespace {

constexpr std::int64_t classes = 6; // every number of DOFs per node looked at divides it
// Matrices come from files with seven digits at worst.
constexpr double unstrained = 1e-6;

using Sums = std::array<double, classes>; // over the DOFs of a class: those with the same remainder

// What a column of a symmetric matrix gives when all DOFs of a class move by one.
Sums column_sums(const SparseMatrix &a, std::int64_t column, double share_of_diagonal) {
    Sums sums{};
    for (std::int64_t p = a.ptr[column]; p < a.ptr[column + 1]; ++p)
        sums[a.idx[p] % classes] += (a.idx[p] == column ? share_of_diagonal : 1) * a.val[p];
    return sums;
}

double over_class(const Sums &sums, std::int64_t first, std::int64_t step) {
    double sum = 0;
    for (std::int64_t c = first; c < classes; c += step) sum += sums[c];
    return sum;
}

// The largest force that the motions (first, step) need anywhere, one pass over K for all of them.
std::array<Sums, classes + 1> largest_forces(const SparseMatrix &k, double share_of_diagonal) {
    std::array<Sums, classes + 1> largest{};
    for (std::int64_t j = 0; j < k.cols; ++j) {
        const Sums sums = column_sums(k, j, share_of_diagonal);
        for (std::int64_t step : {1, 2, 3, 6})
            for (std::int64_t first = 0; first < step; ++first)
                largest[step][first] =
                    std::max(largest[step][first], std::abs(over_class(sums, first, step)));
    }
    return largest;
}

// Motion of DOFs that have no stiffness strains nothing, whatever they are.
bool has_stiffness(const SparseMatrix &k, std::int64_t first, std::int64_t step) {
    for (std::int64_t j = first; j < k.cols; j += step)
        for (std::int64_t p = k.ptr[j]; p < k.ptr[j + 1]; ++p)
            if (k.val[p] != 0) return true;
    return false;
}

// least: DOFs per node.
vector<Translation> unstrained_motions(const SparseMatrix &k, double share_of_diagonal, std::int64_t least) {
    const auto largest = largest_forces(k, share_of_diagonal);
    const double strained = unstrained * norm_inf(k);
    vector<Translation> found;
    for (std::int64_t step : {6, 3, 2, 1}) {
        if (step < least || k.cols % step != 0 || k.cols < 2 * step) continue;
        for (std::int64_t first = 0; first < step; ++first)
            if (largest[step][first] <= strained && has_stiffness(k, first, step))
                found.push_back({first, step, 0.0});
        if (!found.empty()) return found;
    }
    return found;
}

} // namespace

vector<Translation> find_translations(const SparseMatrix &k) {
    return unstrained_motions(k, 1, 1);
}

bool is_diagonal_twice(const SparseMatrix &k) {
    constexpr std::int64_t nodes = 4; // what fewer do may be chance
    const vector<Translation> found = unstrained_motions(k, 0.5, 2);
    return !found.empty() && k.cols >= nodes * found.front().step;
}

void weigh(vector<Translation> &translations, const SparseMatrix &m) {
    for (Translation &t : translations) {
        t.mass = 0;
        for (std::int64_t j = t.first; j < m.cols; j += t.step)
            for (std::int64_t p = m.ptr[j]; p < m.ptr[j + 1]; ++p)
                if (t.holds(m.idx[p])) t.mass += m.val[p];
    }
}

} // namespace plm
