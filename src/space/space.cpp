#include "space/space.hpp"
#include "space/linear_contact.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

vector<double> project(const Matrix &v, const vector<double> &f) {
    vector<double> y(v.cols(), 0.0);
    if (!f.empty()) gemv('T', 1.0, v, f.data(), 0.0, y.data());
    return y;
}

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

} // namespace

void project_onto(Space &space) {
    const Model &model = *space.model;
    space.gap = multiply(model.gap_matrix(), space.vectors);
    space.damping_diagonal = diagonal_damping(space, model.damping());
    if (model.damping().has_matrix) {
        space.damping = product('T', 'N', space.vectors, multiply(model.damping_matrix(), space.vectors));
        for (std::int64_t j = 0; j < space.size(); ++j) space.damping(j, j) += space.damping_diagonal[j];
        space.damping_diagonal.clear();
    }
    if (model.has_preload()) space.preload = project(space.vectors, model.preload());
    for (const auto &[harmonic, load] : model.excitation()) {
        HarmonicLoad &reduced = space.excitation[harmonic];
        reduced.real = project(space.vectors, load.real);
        if (harmonic > 0) reduced.imag = project(space.vectors, load.imag);
    }
}

SpaceModes modes_of_contact_set(const Space &space, const PairStates &states, double upper) {
    return modes_with_springs(space.lambda, space.n_massless, space.gap,
                              space.model->contact().springs(states), upper);
}

} // namespace plm
