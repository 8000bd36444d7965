#include "reduction/load_vectors.hpp"
#include "sampling/mode_clusters.hpp"

namespace plm {
namespace {

void append_response(const Space &space, const vector<double> &load, Matrix &columns) {
    if (load.empty()) return;
    const std::int64_t m = space.size();
    Matrix column(m, 1);
    for (std::int64_t j = 0; j < m; ++j) column(j, 0) = space.lambda[j] > 0 ? load[j] / space.lambda[j] : 0.0;
    const double size = norm2(m, column.data());
    if (!(size > 0)) return;
    for (std::int64_t j = 0; j < m; ++j) column(j, 0) /= size;
    columns.append(column);
}

} // namespace

Matrix load_vectors(const Space &space) {
    Matrix columns;
    for (const auto &entry : drive_of(space)) {
        append_response(space, entry.second.real, columns);
        append_response(space, entry.second.imag, columns);
    }
    return columns;
}

} // namespace plm
