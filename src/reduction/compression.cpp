#include "reduction/compression.hpp"
#include "linalg/lapack.hpp"
#include "reduction/projection.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

// The reduced model as a space of its own, to project again.
Space as_space(const ReducedModel &m) {
    Space s;
    s.model = m.model;
    s.vectors = m.vectors;
    s.lambda = m.lambda;
    s.gap = m.gap;
    s.damping_diagonal = m.damping_diagonal;
    s.damping = m.damping;
    if (m.model->damping().has_matrix && m.damping.empty()) { // diagonal in these coordinates, not in others
        s.damping.reset(m.size(), m.size());
        for (std::int64_t j = 0; j < m.size(); ++j) s.damping(j, j) = m.damping_diagonal[j];
    }
    for (const auto &[harmonic, load] : m.excitation)
        if (harmonic > 0) s.excitation[harmonic] = load;
    return s;
}

struct Directions {
    Matrix y; // orthonormal
    vector<double> singular_values;
};

Directions dominant_directions(const Matrix &snapshots, const vector<double> &lambda, double omega,
                               double tolerance, std::int64_t size) {
    const std::int64_t r = snapshots.rows();
    vector<double> weight(r);
    for (std::int64_t j = 0; j < r; ++j) weight[j] = std::sqrt(lambda[j] + omega * omega);
    Matrix weighted = snapshots;
    for (std::int64_t k = 0; k < weighted.cols(); ++k)
        for (std::int64_t j = 0; j < r; ++j) weighted(j, k) *= weight[j];
    const Svd svd = thin_svd(weighted);
    Directions d;
    double all = 0, rest = 0;
    for (double s : svd.values) all += s * s;
    const std::int64_t most = static_cast<std::int64_t>(svd.values.size());
    std::int64_t kept = most;
    while (kept > 0 && svd.values[kept - 1] <= 1e-14 * svd.values[0]) --kept; // rounding errors
    if (size > 0) {
        kept = std::min(kept, size);
    } else {
        while (kept > 1 && rest + svd.values[kept - 1] * svd.values[kept - 1] <= tolerance * tolerance * all)
            rest += svd.values[kept - 1] * svd.values[kept - 1], --kept;
    }
    for (double s : svd.values) d.singular_values.push_back(svd.values[0] > 0 ? s / svd.values[0] : 0);
    Matrix y(r, kept);
    for (std::int64_t k = 0; k < kept; ++k)
        for (std::int64_t j = 0; j < r; ++j) y(j, k) = svd.u(j, k) / weight[j];
    d.y = thin_svd(y).u;
    return d;
}

// h = 0: the rest under pre-load and the mean parts of the motions.
void reduce_statics(const ReducedModel &from, const Matrix &y, ReducedModel &to) {
    Space statics;
    statics.lambda = from.lambda_0;
    const Coordinates c = diagonalise_stiffness(statics, y);
    to.same_static = false;
    to.lambda_0 = c.lambda;
    to.gap_0 = product('N', 'N', from.gap_0, c.y);
    to.vectors_0 = product('N', 'N', from.static_vectors(), c.y);
    const auto projected = [&](const vector<double> &f) {
        vector<double> g(c.y.cols(), 0.0);
        if (!f.empty()) gemv('T', 1.0, c.y, f.data(), 0.0, g.data());
        return g;
    };
    to.preload_0 = projected(from.preload_0);
    const auto mean_load = from.excitation.find(0);
    if (mean_load != from.excitation.end()) to.excitation[0] = {projected(mean_load->second.real), {}};
}

} // namespace

Compressed compress(const Responses &responses, double tolerance, std::int64_t size) {
    const ReducedModel &from = *responses.of;
    const Space space = as_space(from);
    const Directions dynamic =
        dominant_directions(responses.dynamic, from.lambda, responses.omega, tolerance, size);
    if (dynamic.y.cols() == 0)
        throw Error(PLM_ERR_STATE, "nothing moves in the responses; they give no basis")
            .argument("responses");
    const auto reduced = std::make_shared<ReducedModel>(
        *project(space, diagonalise_stiffness(space, dynamic.y), StaticBasis()));
    // mean parts are few; they are kept to the same tolerance
    const Directions mean = dominant_directions(responses.mean, from.lambda_0, responses.omega, tolerance, 0);
    reduce_statics(from, mean.y, *reduced);
    return {reduced, dynamic.singular_values};
}

} // namespace plm
