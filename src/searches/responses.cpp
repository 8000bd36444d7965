#include "searches/responses.hpp"
#include <algorithm>
#include <cmath>

namespace plm {

Responses responses_of(const std::vector<std::shared_ptr<const Branch>> &branches) {
    Responses out;
    if (branches.empty()) return out;
    out.of = branches.front()->reduced_model();
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
            largest = std::max(largest, norm2(r * p.eta.cols(), p.eta.data()));
        const double scale = largest > 0 ? 1 / largest : 1;
        for (const BranchPoint &p : branch->points()) {
            out.omega += p.omega / static_cast<double>(points);
            for (std::int64_t k = 0; k < r * p.eta.cols(); ++k)
                out.dynamic.col(column)[k] = scale * p.eta.data()[k];
            column += p.eta.cols();
            for (std::int64_t j = 0; j < r_0; ++j) out.mean(j, point) = scale * p.eta_0[j];
            ++point;
        }
    }
    return out;
}

} // namespace plm
