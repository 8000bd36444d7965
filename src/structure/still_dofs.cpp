#include "structure/still_dofs.hpp"
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace plm {

void mark_coupled(const SparseMatrix &a, vector<char> &moves) {
    for (std::int64_t j = 0; j < a.cols; ++j)
        for (std::int64_t p = a.ptr[j]; p < a.ptr[j + 1]; ++p)
            if (a.idx[p] != j && a.val[p] != 0) moves[j] = 1;
}

StillDofs still_dofs(const SparseMatrix &k, const SparseMatrix &m, const vector<char> &moves,
                     const vector<std::int64_t> &free_dof) {
    const vector<double> stiffness = diagonal(k), mass = diagonal(m);
    std::map<std::pair<double, double>, vector<std::int64_t>> alone; // by their two numbers
    for (std::size_t j = 0; j < free_dof.size(); ++j) // without stiffness it is refused, or rigid
        if (!moves[j] && stiffness[j] > 0) alone[{stiffness[j], mass[j]}].push_back(free_dof[j]);
    StillDofs still;
    for (const auto &[numbers, dofs] : alone) {
        if (dofs.size() < 2) continue;
        const double hz = std::sqrt(numbers.first / numbers.second) / (2 * M_PI);
        still.low_hz = still.dof.empty() ? hz : std::min(still.low_hz, hz);
        still.high_hz = std::max(still.high_hz, hz);
        still.dof.insert(still.dof.end(), dofs.begin(), dofs.end());
    }
    std::sort(still.dof.begin(), still.dof.end());
    return still;
}

} // namespace plm
