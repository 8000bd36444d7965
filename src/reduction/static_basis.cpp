#include "reduction/static_basis.hpp"
#include "space/massless.hpp"
#include <algorithm>

namespace plm {
namespace {

void orthogonalise(const Matrix &y, vector<double> &q) {
    vector<double> c(y.cols());
    for (int pass = 0; pass < 2; ++pass) { // twice is enough
        gemv('T', 1.0, y, q.data(), 0.0, c.data());
        gemv('N', -1.0, y, c.data(), 1.0, q.data());
    }
}

} // namespace

double relative_remainder(const Coordinates &dynamic, const vector<double> &q) {
    const std::int64_t n = static_cast<std::int64_t>(q.size());
    const double size = norm2(n, q.data());
    if (!(size > 0)) return 0;
    vector<double> remainder(q);
    orthogonalise(orthonormal_span(dynamic.y, dynamic.n_massless), remainder);
    return norm2(n, remainder.data()) / size;
}

StaticBasis make_static_basis(const Space &space, const Coordinates &dynamic, const vector<double> &q_ps) {
    StaticBasis basis;
    const std::int64_t n = static_cast<std::int64_t>(q_ps.size());
    const double size = norm2(n, q_ps.data());
    if (!(size > 0)) return basis;
    vector<double> unit(q_ps);
    for (double &v : unit) v /= size;
    Matrix extended = orthonormal_span(dynamic.y, dynamic.n_massless);
    orthogonalise(extended, unit);
    const double remainder = norm2(n, unit.data());
    if (remainder < 1e-10) return basis;
    Matrix column(n, 1);
    for (std::int64_t i = 0; i < n; ++i) column(i, 0) = unit[i] / remainder;
    extended.append(column);
    basis.same = false;
    basis.coordinates = diagonalise(space, extended);
    return basis;
}

} // namespace plm
