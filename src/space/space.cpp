#include "space/space.hpp"
#include "space/linear_contact.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

// Rayleigh and modal damping are diagonal here because V diagonalises M and K and starts with the exact
// modes.
vector<double> diagonal_damping(const Space &space, const Damping &damping) {
    vector<double> c(space.size());
    for (std::int64_t j = 0; j < space.size(); ++j) {
        c[j] = damping.alpha * space.mass(j) + damping.beta * space.lambda[j];
        if (damping.modal_ratio.empty() || space.mass(j) == 0) continue; // 2 D sqrt(k m)
        std::int64_t last = static_cast<std::int64_t>(damping.modal_ratio.size()) - 1;
        c[j] += 2 * damping.modal_ratio[std::min(j, last)] * std::sqrt(space.lambda[j]);
    }
    return c;
}

// V^T C V by blocks of columns.
Matrix damping_matrix(const Space &space) {
    const std::int64_t m = space.size();
    Matrix c(m, 0);
    for (std::int64_t first = 0; first < m; first += solved_at_once) {
        Matrix some(m, std::min(solved_at_once, m - first));
        for (std::int64_t j = 0; j < some.cols(); ++j) some(first + j, j) = 1;
        c.append(gram(space.vectors, space.model->damping_times(combine(space.vectors, some))));
    }
    return c;
}

} // namespace

void project_onto(Space &space) {
    const Model &model = *space.model;
    space.damping_diagonal = diagonal_damping(space, model.damping());
    if (model.damping().has_matrix) {
        space.damping = damping_matrix(space);
        for (std::int64_t j = 0; j < space.size(); ++j) space.damping(j, j) += space.damping_diagonal[j];
        space.damping_diagonal.clear();
    }
    if (model.has_preload()) space.preload = projected(space.vectors, model.preload());
    space.excitation = projected(space.vectors, model.excitation());
}

SpaceModes modes_of_contact_set(const Space &space, const PairStates &states, double upper) {
    return modes_with_springs(space.lambda, space.n_massless, space.gap,
                              space.model->contact().springs(states), upper);
}

} // namespace plm
