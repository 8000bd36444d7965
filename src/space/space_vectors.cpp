#include "space/space_vectors.hpp"
#include <algorithm>

namespace plm {
namespace {

Matrix identity(std::int64_t n) {
    Matrix one(n, n);
    for (std::int64_t j = 0; j < n; ++j) one(j, j) = 1;
    return one;
}

bool has_responses(const SpaceVectors::Parts &p) {
    return p.of_responses.rows() > 0;
}

Field combine_some(const SpaceVectors::Parts &p, const Matrix &y) {
    Field x(p.further.rows(), y.cols());
    if (has_responses(p)) {
        x = ActingForces(*p.structure).combine(product('N', 'N', p.of_responses, y));
        p.modes->take_from_forces(x);
        respond_outside(*p.structure, *p.modes, x);
    }
    if (p.of_modes.rows() > 0) add_combination(1.0, p.modes->vectors, product('N', 'N', p.of_modes, y), x);
    if (p.of_further.rows() > 0) add_combination(1.0, p.further, product('N', 'N', p.of_further, y), x);
    return x;
}

Matrix gram_some(const SpaceVectors::Parts &p, const Field &f) {
    Matrix c = product('T', 'N', p.of_further, gram(p.further, f));
    if (p.of_modes.rows() > 0) gemm('T', 'N', 1.0, p.of_modes, gram(p.modes->vectors, f), 1.0, c);
    if (!has_responses(p)) return c;
    Field x = f;
    p.modes->take_from_forces(x);
    respond_outside(*p.structure, *p.modes, x);
    gemm('T', 'N', 1.0, p.of_responses, ActingForces(*p.structure).products(x), 1.0, c);
    return c;
}

} // namespace

SpaceVectors::SpaceVectors(Field vectors) {
    parts_.of_further = identity(vectors.cols());
    parts_.further = std::move(vectors);
}

std::int64_t SpaceVectors::bytes() const {
    const auto entries = [](const auto &a) { return a.rows() * a.cols(); };
    std::int64_t n = entries(parts_.further) + entries(parts_.of_further) + entries(parts_.of_modes) +
                     entries(parts_.of_responses);
    if (parts_.modes) n += entries(parts_.modes->vectors) + entries(parts_.modes->momenta);
    return static_cast<std::int64_t>(sizeof(double)) * n;
}

Field combine(const SpaceVectors &v, const Matrix &y) {
    if (y.cols() <= solved_at_once) return combine_some(v.parts(), y);
    Field x(v.rows(), y.cols());
    for (std::int64_t first = 0; first < y.cols(); first += solved_at_once)
        x.put(first, combine_some(v.parts(), y.columns(first, std::min(solved_at_once, y.cols() - first))));
    return x;
}

Field combine(const SpaceVectors &v, const vector<double> &y) {
    Matrix column(static_cast<std::int64_t>(y.size()), 1);
    std::copy(y.begin(), y.end(), column.data());
    return combine(v, column);
}

Matrix gram(const SpaceVectors &v, const Field &f) {
    if (f.cols() <= solved_at_once) return gram_some(v.parts(), f);
    Matrix c(v.cols(), 0);
    for (std::int64_t first = 0; first < f.cols(); first += solved_at_once)
        c.append(gram_some(v.parts(), f.columns(first, std::min(solved_at_once, f.cols() - first))));
    return c;
}

Field all_columns(const SpaceVectors &v) {
    return combine(v, identity(v.cols()));
}

vector<double> projected(const SpaceVectors &v, const Field &load) {
    if (load.empty()) return {};
    const Matrix c = gram(v, load);
    return vector<double>(c.data(), c.data() + c.rows());
}

HarmonicLoads projected(const SpaceVectors &v, const std::map<int, HarmonicForce> &loads) {
    HarmonicLoads reduced;
    for (const auto &[harmonic, load] : loads)
        reduced[harmonic] = {projected(v, load.real), projected(v, load.imag)};
    return reduced;
}

} // namespace plm
