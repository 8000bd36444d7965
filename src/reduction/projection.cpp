#include "reduction/projection.hpp"
#include <algorithm>
#include <cmath>
#include <utility>

namespace plm {
namespace {

vector<double> project_vector(const Matrix &y, const vector<double> &f) {
    if (f.empty()) return {};
    vector<double> reduced(y.cols(), 0.0);
    gemv('T', 1.0, y, f.data(), 0.0, reduced.data());
    return reduced;
}

// Off-diagonal entries that are rounding errors against the diagonal do not count.
bool is_diagonal(const Matrix &c) {
    for (std::int64_t j = 0; j < c.cols(); ++j)
        for (std::int64_t i = 0; i < c.rows(); ++i)
            if (i != j && std::abs(c(i, j)) > 1e-14 * std::sqrt(std::abs(c(i, i) * c(j, j)))) return false;
    return true;
}

ProjectedDamping as_damping(Matrix c) {
    ProjectedDamping d;
    if (!is_diagonal(c)) {
        d.matrix = std::move(c);
        return d;
    }
    d.diagonal.resize(c.cols());
    for (std::int64_t j = 0; j < c.cols(); ++j) d.diagonal[j] = c(j, j);
    return d;
}

} // namespace

ProjectedDamping projected_damping(const Space &space, const Coordinates &to) {
    const Damping &damping = space.model->damping();
    if (!space.damping.empty())
        return as_damping(product('T', 'N', to.y, product('N', 'N', space.damping, to.y)));
    const std::int64_t r = static_cast<std::int64_t>(to.lambda.size()), massive = r - to.n_massless;
    if (damping.modal_ratio.empty()) { // Rayleigh: diagonal wherever m and k are
        ProjectedDamping d;
        for (std::int64_t j = 0; j < r; ++j)
            d.diagonal.push_back((j < massive ? damping.alpha : 0) + damping.beta * to.lambda[j]);
        return d;
    }
    Matrix cy = to.y;
    for (std::int64_t j = 0; j < cy.cols(); ++j)
        for (std::int64_t i = 0; i < cy.rows(); ++i) cy(i, j) *= space.damping_diagonal[i];
    Matrix c = product('T', 'N', to.y, cy); // a ratio of critical damping is nothing without mass
    for (std::int64_t j = 0; j < c.cols(); ++j)
        for (std::int64_t i = 0; i < c.rows(); ++i)
            if (i >= massive || j >= massive) c(i, j) = 0;
    return as_damping(std::move(c));
}

namespace {

// What does not depend on the basis, and the static members repeated from the dynamic ones.
void finish(const Space &space, ReducedModel &reduced) {
    reduced.model = space.model;
    reduced.structural = space.model->damping().structural;
    reduced.contact = space.model->contact();
    if (reduced.same_static) {
        reduced.lambda_0 = reduced.lambda;
        reduced.n_massless_0 = reduced.n_massless;
        reduced.gap_0 = reduced.gap;
    }
    reduced.preload_0.resize(reduced.lambda_0.size(), 0.0);
}

} // namespace

std::shared_ptr<const ReducedModel> project(const Space &space, const Coordinates &dynamic,
                                            const StaticBasis &statics) {
    auto reduced = std::make_shared<ReducedModel>();
    const Matrix &y_0 = statics.same ? dynamic.y : statics.coordinates.y;
    reduced->in_space = y_0;
    reduced->lambda = dynamic.lambda;
    reduced->n_massless = dynamic.n_massless;
    reduced->gap = product('N', 'N', space.gap, dynamic.y);
    reduced->vectors = space.vectors.times(dynamic.y);
    ProjectedDamping damping = projected_damping(space, dynamic);
    reduced->damping_diagonal = std::move(damping.diagonal);
    reduced->damping = std::move(damping.matrix);
    reduced->same_static = statics.same;
    if (!statics.same) {
        reduced->lambda_0 = statics.coordinates.lambda;
        reduced->n_massless_0 = statics.coordinates.n_massless;
        reduced->gap_0 = product('N', 'N', space.gap, y_0);
        reduced->vectors_0 = space.vectors.times(y_0);
        reduced->to_static = coordinates_among(space, dynamic.y, statics.coordinates);
        damping = projected_damping(space, statics.coordinates);
        reduced->damping_diagonal_0 = std::move(damping.diagonal);
        reduced->damping_0 = std::move(damping.matrix);
    }
    reduced->preload_0 = project_vector(y_0, space.preload);
    for (const auto &[part, load] : space.excitation) {
        const Matrix &y = part.harmonic == 0 ? y_0 : dynamic.y;
        reduced->excitation[part] = {project_vector(y, load.real), project_vector(y, load.imag)};
    }
    finish(space, *reduced);
    return reduced;
}

std::shared_ptr<const ReducedModel> project_whole(const Space &space) {
    auto reduced = std::make_shared<ReducedModel>();
    reduced->lambda = space.lambda;
    reduced->n_massless = space.n_massless;
    reduced->gap = space.gap;
    reduced->vectors = space.vectors.whole();
    if (space.damping.empty()) {
        reduced->damping_diagonal = space.damping_diagonal;
    } else {
        ProjectedDamping damping = as_damping(space.damping);
        reduced->damping_diagonal = std::move(damping.diagonal);
        reduced->damping = std::move(damping.matrix);
    }
    reduced->preload_0 = space.preload;
    reduced->excitation = space.excitation;
    finish(space, *reduced);
    return reduced;
}

} // namespace plm
