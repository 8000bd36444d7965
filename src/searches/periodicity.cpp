#include "searches/periodicity.hpp"
#include "orbits/shooting.hpp"

namespace plm {

double periodicity_defect(const Branch &branch, std::int64_t point) {
    const BranchPoint &p = branch.points()[static_cast<std::size_t>(point)];
    const auto model = std::make_shared<const FlowModel>(branch.reduced_model(), p.omega);
    ExactFlow flow(model, p.omega, p.force_scale);
    const double response_omega = p.omega / static_cast<double>(branch.period_multiple());
    return periodicity_defect(flow, model->state(p.eta_0, p.eta, response_omega, 0.0),
                              branch.period_multiple());
}

} // namespace plm
