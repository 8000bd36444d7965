#include "orbits/periodicity.hpp"
#include "orbits/orbit_point.hpp"
#include "orbits/shooting.hpp"

namespace plm {

double periodicity_defect(const Branch &branch, std::int64_t point) {
    const BranchPoint &p = branch.points()[static_cast<std::size_t>(point)];
    const auto model = std::make_shared<const FlowModel>(branch.reduced_model(), p.omega);
    ExactFlow flow(model, p.omega, p.force_scale);
    return periodicity_defect(flow, start_of(*model, p, branch.period_multiple()), branch.period_multiple());
}

} // namespace plm
