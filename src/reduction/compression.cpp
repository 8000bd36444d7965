#include "reduction/compression.hpp"
#include "linalg/blas_lapack.hpp"
#include "linalg/lapack.hpp"
#include "reduction/basis_kind.hpp"
#include "reduction/basis_options.hpp"
#include "reduction/projection.hpp"
#include "space/linear_contact.hpp"
#include "space/massless.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

void put_damping(const vector<double> &diagonal, const Matrix &matrix, Space &s) {
    s.damping_diagonal = diagonal;
    s.damping = matrix;
    if (!s.model->damping().has_matrix || !matrix.empty()) return;
    s.damping.reset(s.size(), s.size()); // diagonal in these coordinates, not in others
    for (std::int64_t j = 0; j < s.size(); ++j) s.damping(j, j) = diagonal[j];
}

// The reduced model as a space of its own, to project again.
Space as_space(const ReducedModel &m) {
    Space s;
    s.model = m.model;
    s.vectors = m.vectors;
    s.lambda = m.lambda;
    s.n_massless = m.n_massless;
    s.gap = m.whole_gap();
    put_damping(m.damping_diagonal, m.damping, s);
    for (const auto &[part, load] : m.excitation)
        if (part.harmonic > 0) s.excitation[part] = load;
    return s;
}

// Its static directions as one.
Space as_static_space(const ReducedModel &m) {
    Space s;
    s.model = m.model;
    s.lambda = m.lambda_0;
    s.n_massless = m.n_massless_0;
    if (m.same_static)
        put_damping(m.damping_diagonal, m.damping, s);
    else
        put_damping(m.damping_diagonal_0, m.damping_0, s);
    return s;
}

constexpr double rounding = 1e-14;

// Energy norm: elastic and kinetic at a typical frequency.
vector<double> energy_weights(const vector<double> &lambda, std::int64_t n_massless, double omega) {
    vector<double> weight;
    for (double l : lambda) weight.push_back(std::sqrt(l + omega * omega));
    for (std::size_t j = lambda.size() - n_massless; j < lambda.size(); ++j) weight[j] = std::sqrt(lambda[j]);
    return weight;
}

// Left singular vectors and singular values of motions in the energy norm.
struct Decomposition {
    Decomposition(const Matrix &motions, vector<double> weights) : weight(std::move(weights)) {
        Matrix weighted = motions;
        for (std::int64_t k = 0; k < weighted.cols(); ++k)
            for (std::int64_t j = 0; j < weighted.rows(); ++j) weighted(j, k) *= weight[j];
        svd = thin_svd(weighted);
        for (double s : svd.values) energy += s * s;
    }
    /// How many leave out at most `left_out` of the energy, none of them below `smallest`.
    std::int64_t needed(double left_out, double smallest) const {
        std::int64_t kept = static_cast<std::int64_t>(svd.values.size());
        for (double dropped = 0; kept > 0; --kept) {
            const double s = svd.values[kept - 1];
            dropped += s * s;
            if (dropped > left_out && s > smallest) break;
        }
        return kept;
    }
    /// The first n as an orthonormal basis.
    Matrix directions(std::int64_t n) const {
        Matrix y(svd.u.rows(), n);
        for (std::int64_t k = 0; k < n; ++k)
            for (std::int64_t j = 0; j < y.rows(); ++j) y(j, k) = svd.u(j, k) / weight[j];
        return thin_svd(y).u;
    }

    vector<double> weight;
    Svd svd;
    double energy = 0;
};

// The dynamic coordinates y among the static ones, whose basis P_0 holds P.
Matrix among_statics(const ReducedModel &m, const Matrix &y) {
    return m.same_static ? y : product('N', 'N', m.to_static, y);
}

// What is left of motions outside the orthonormal y.
Matrix remainder(const Matrix &motions, const Matrix &y) {
    Matrix outside = motions;
    for (int pass = 0; pass < 2; ++pass) gemm('N', 'N', -1.0, y, product('T', 'N', y, outside), 1.0, outside);
    return outside;
}

// h = 0: P_0' holds P', as motions in time need it, and what the rest under pre-load and the mean parts of
// the motions have beside it.
void reduce_statics(const ReducedModel &from, Matrix y, const Matrix &beside, ReducedModel &to) {
    to.same_static = beside.cols() == 0;
    if (!to.same_static) {
        const Space statics = as_static_space(from);
        Matrix all = y;
        all.append(beside);
        const Coordinates c = diagonalise(statics, thin_svd(all).u);
        to.to_static = coordinates_among(statics, y, c);
        to.lambda_0 = c.lambda;
        to.n_massless_0 = c.n_massless;
        to.gap_0 = product('N', 'N', from.whole_gap_0(), c.y);
        to.vectors_0 = from.static_vectors().times(c.y);
        ProjectedDamping damping = projected_damping(statics, c);
        to.damping_diagonal_0 = std::move(damping.diagonal);
        to.damping_0 = std::move(damping.matrix);
        y = c.y;
    }
    to.in_space = from.in_space.empty() ? y : product('N', 'N', from.in_space, y);
    const auto projected = [&](const vector<double> &f) {
        vector<double> g(y.cols(), 0.0);
        if (!f.empty()) gemv('T', 1.0, y, f.data(), 0.0, g.data());
        return g;
    };
    to.preload_0 = projected(from.preload_0);
    for (const auto &[part, load] : from.excitation)
        if (part.harmonic == 0) to.excitation[part] = {projected(load.real), {}};
}

} // namespace

Compressed compress(const Responses &responses, double tolerance, std::int64_t size) {
    const ReducedModel &from = *responses.of;
    const Space space = as_space(from);
    const Decomposition dynamic(responses.dynamic,
                                energy_weights(from.lambda, from.n_massless, responses.omega));
    if (!(dynamic.energy > 0))
        throw Error(status::state, "nothing moves in the responses; they give no basis")
            .argument("responses");
    const double largest = dynamic.svd.values[0], left_out = tolerance * tolerance;
    const std::int64_t kept = size > 0 ? std::min(size, dynamic.needed(0, rounding * largest))
                                       : dynamic.needed(left_out * dynamic.energy, rounding * largest);
    const Matrix directions = dynamic.directions(std::max<std::int64_t>(kept, 1)); // orthonormal
    const Coordinates coordinates = diagonalise(space, rigid_apart(space, directions, rounding));
    const auto reduced = std::make_shared<ReducedModel>(*project(space, coordinates, StaticBasis()));

    // mean parts: to the same tolerance, of themselves and of the motions about them
    const vector<double> weights = energy_weights(from.lambda_0, from.n_massless_0, responses.omega);
    const Matrix y_0 = among_statics(from, coordinates.y);
    const Decomposition mean(responses.mean, weights),
        beside(remainder(responses.mean, orthonormal_span(y_0, from.n_massless_0)), weights);
    const std::int64_t n = beside.needed(left_out * std::min(mean.energy, dynamic.energy),
                                         rounding * std::sqrt(std::max(mean.energy, dynamic.energy)));
    reduce_statics(from, y_0, beside.directions(n), *reduced);

    Compressed c;
    c.reduced = reduced;
    for (double s : dynamic.svd.values) c.singular_values.push_back(s / largest);
    return c;
}

namespace {

double energy_of(const vector<double> &weight, const double *motion) {
    double energy = 0;
    for (std::size_t j = 0; j < weight.size(); ++j) energy += std::pow(weight[j] * motion[j], 2);
    return energy;
}

// The modes below a frequency in contact, each of the same energy.
Matrix modes_in_contact(const ReducedModel &from, const std::vector<vector<double>> &springs,
                        const vector<double> &weight, double kept, double energy) {
    Matrix modes(from.size(), 0);
    for (const vector<double> &spring : springs)
        modes.append(modes_with_springs(from.lambda, from.n_massless, from.gap, spring, kept * kept).vectors);
    for (std::int64_t k = 0; k < modes.cols(); ++k) {
        const double factor = std::sqrt(energy / energy_of(weight, modes.col(k)));
        for (std::int64_t j = 0; j < modes.rows(); ++j) modes(j, k) *= factor;
    }
    return modes;
}

// The modes below a frequency, as unit vectors, and the best directions for the rest of the motions and of
// the modes in contact.
Matrix modes_and_directions(const ReducedModel &from, Matrix motions,
                            const std::vector<vector<double>> &springs, double omega, double tolerance,
                            double kept, std::int64_t most) {
    const vector<double> weight = energy_weights(from.lambda, from.n_massless, omega);
    const std::int64_t r = from.size();
    std::int64_t slow = 0;
    while (slow < r - from.n_massless && from.lambda[slow] < kept * kept) ++slow;
    double energy = 0, largest = 0;
    for (std::int64_t k = 0; k < motions.cols(); ++k) {
        const double one = energy_of(weight, motions.col(k));
        energy += one, largest = std::max(largest, one);
    }
    motions.append(modes_in_contact(from, springs, weight, kept, largest));
    for (std::int64_t k = 0; k < motions.cols(); ++k) std::fill_n(motions.col(k), slow, 0.0);
    Matrix y(r, slow);
    for (std::int64_t j = 0; j < slow; ++j) y(j, j) = 1;
    const Decomposition rest(motions, weight);
    const std::int64_t needed = rest.needed(tolerance * tolerance * energy, rounding * std::sqrt(energy));
    y.append(rest.directions(std::min(needed, std::max<std::int64_t>(most - slow, 0))));
    return y;
}

} // namespace

std::shared_ptr<const ReducedModel> compress_beside_modes(std::shared_ptr<const ReducedModel> from,
                                                          const Matrix &motions,
                                                          const std::vector<vector<double>> &springs,
                                                          double omega, double tolerance, double kept,
                                                          std::int64_t most) {
    require(from->same_static && !from->all_pairs, "compress_beside_modes: the model's statics");
    const Space space = as_space(*from);
    Coordinates coordinates =
        diagonalise(space, modes_and_directions(*from, motions, springs, omega, tolerance, kept, most));
    const auto reduced = std::make_shared<ReducedModel>(*project(space, coordinates, StaticBasis()));
    reduce_statics(*from, coordinates.y, Matrix(from->size(), 0), *reduced);
    reduced->from =
        std::make_shared<const CompressedFrom>(CompressedFrom{std::move(from), std::move(coordinates.y)});
    return reduced;
}

Matrix uncompressed(const ReducedModel &m, const Matrix &coordinates) {
    return m.from ? product('N', 'N', m.from->coordinates, coordinates) : coordinates;
}

std::shared_ptr<const ReducedModel> uncompressed(const std::shared_ptr<const ReducedModel> &m) {
    return m->from ? m->from->model : m;
}

std::shared_ptr<const ReducedModel> as_part_of(std::shared_ptr<const ReducedModel> whole,
                                               const ReducedModel &part) {
    auto model = std::make_shared<ReducedModel>(part);
    Matrix coordinates = part.in_space;
    if (coordinates.empty()) { // the whole itself
        coordinates.reset(whole->size(), whole->size());
        for (std::int64_t j = 0; j < whole->size(); ++j) coordinates(j, j) = 1;
    }
    model->from =
        std::make_shared<const CompressedFrom>(CompressedFrom{std::move(whole), std::move(coordinates)});
    return model;
}

namespace {

constexpr BasisKind pod_kind() {
    BasisKind kind("pod", "the parent compressed to what its responses need");
    kind.own_options = "pod_tolerance,pod_size";
    kind.any_parent = true;
    kind.compress = [](const Responses &responses, const BasisOptions &o) {
        return compress(responses, o.pod_tolerance, o.pod_size);
    };
    return kind;
}

} // namespace

constexpr BasisKind basis_kinds::pod = pod_kind();

} // namespace plm
