#include "hbm/formulation.hpp"
#include <algorithm>

namespace plm {
namespace {

constexpr double stiff = 3e3; // k_n over the local stiffness: beyond, few harmonics follow their own ripples
constexpr double moderate =
    100; // e over the local stiffness: softer converges more slowly in H, stiffer takes more steps

} // namespace

double local_stiffness(const ReducedModel &m) {
    vector<double> flexibility(m.n_pairs(), 0.0);
    for (std::int64_t j = 0; j < m.static_size(); ++j) {
        if (m.lambda_0[j] <= 0) return 0;
        for (std::int64_t i = 0; i < m.n_pairs(); ++i)
            flexibility[i] += m.gap_0(i, j) * m.gap_0(i, j) / m.lambda_0[j];
    }
    if (flexibility.empty()) return 0;
    const auto middle = flexibility.begin() + static_cast<std::ptrdiff_t>(flexibility.size() / 2);
    std::nth_element(flexibility.begin(), middle, flexibility.end());
    return *middle > 0 ? 1 / *middle : 0;
}

LawForm make_formulation(const ReducedModel &m, const HbmOptions &options) {
    const bool possible = options.unknowns != NonlinearUnknowns::modal;
    if (!possible || options.formulation == FormulationKind::penalty) return penalty_form(m.contact);
    const double local = local_stiffness(m);
    if (local == 0) return penalty_form(m.contact); // which the static reference of rigid-body modes needs
    const double limit = options.formulation == FormulationKind::compliance ? moderate : stiff;
    return compliance_form(m.contact, limit * local, moderate * local);
}

} // namespace plm
