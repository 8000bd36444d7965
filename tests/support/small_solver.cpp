#include "support/small_solver.hpp"
#include "contact/trig_polynomial.hpp"
#include <algorithm>
#include <cmath>

namespace test {

plm::Hbm solver(std::shared_ptr<const plm::ReducedModel> m, const plm::HbmOptions &o, double low,
                double high) {
    return plm::Hbm(std::move(m), low / (2 * M_PI), high / (2 * M_PI), o, plm::Watch());
}

double peak_at(const plm::ReducedModel &m, const plm::BranchPoint &p, int dof) {
    const auto q = displacement(m, p.eta_0, p.eta, dof);
    const plm::ValueRange range = plm::trig_range(q.data(), p.eta.cols() / 2);
    return std::max(std::abs(range.maximum), std::abs(range.minimum));
}

} // namespace test
