#include "motions/responses.hpp"
#include "reduction/compression.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

void put_scaled(double scale, const Matrix &from, double *to) {
    for (std::int64_t k = 0; k < from.rows() * from.cols(); ++k) to[k] = scale * from.data()[k];
}

} // namespace

Responses responses_of(const std::vector<std::shared_ptr<const Branch>> &branches) {
    Responses out;
    if (branches.empty()) return out;
    out.of = uncompressed(branches.front()->reduced_model());
    const std::int64_t r = out.of->size(), r_0 = out.of->static_size();
    std::int64_t columns = 0, points = 0;
    for (const auto &branch : branches)
        for (const BranchPoint &p : branch->points()) columns += p.eta.cols(), ++points;
    out.dynamic.reset(r, columns);
    out.mean.reset(r_0, points);
    std::int64_t column = 0, point = 0;
    for (const auto &branch : branches) {
        double largest = 0;
        for (const BranchPoint &p : branch->points())
            largest = std::max(largest, norm2(p.eta.rows() * p.eta.cols(), p.eta.data()));
        const double scale = largest > 0 ? 1 / largest : 1;
        const ReducedModel &m = branch->reduced();
        for (const BranchPoint &p : branch->points()) {
            out.omega += p.omega / static_cast<double>(points);
            Matrix mean(static_cast<std::int64_t>(p.eta_0.size()), 1);
            std::copy(p.eta_0.begin(), p.eta_0.end(), mean.data());
            put_scaled(scale, uncompressed(m, p.eta), out.dynamic.col(column));
            put_scaled(scale, uncompressed(m, mean), out.mean.col(point++));
            column += p.eta.cols();
        }
    }
    return out;
}

} // namespace plm
