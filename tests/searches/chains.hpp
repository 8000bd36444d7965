// Two chains in contact, driven at the end of one of them.
#pragma once
#include "reduction/basis.hpp"
#include "sampling/small_models.hpp"

namespace test {

constexpr int n_chain = 12, watched = n_chain - 1;

// The unreduced structure, and piecewise-linear modes below a limit.
struct Chains {
    std::shared_ptr<const plm::Basis> full, reduced;
    double low_hz = 0, high_hz = 0;
};
inline Chains chains(double contact_stiffness, bool with_preload, std::int64_t basis_harmonics) {
    exact::Structure s = two_chains(n_chain, 4, contact_stiffness, true);
    s.force.assign(s.n, 0.0);
    s.force[watched] = 0.05;
    if (with_preload) {
        s.preload.assign(s.n, 0.0);
        s.preload[watched] = 0.02;
        s.preload[2 * n_chain - 1] = -0.02;
    }
    const auto model = make_model(s, {{}, 0, 0.3, false});
    plm::SamplerOptions so;
    so.system = plm::LinearSystem::open;
    so.mode = 2;
    so.n_samples = 2;
    const auto sampler = std::make_shared<const plm::Sampler>(model, so, plm::Watch());
    plm::BasisOptions o;
    o.n_harmonics = basis_harmonics;
    Chains c;
    c.reduced = std::make_shared<const plm::Basis>(model, sampler, nullptr, o, plm::Watch());
    c.full = plm::unreduced_basis(c.reduced, plm::Watch());
    c.low_hz = c.full->window_min_hz(), c.high_hz = c.full->window_max_hz();
    return c;
}

} // namespace test
