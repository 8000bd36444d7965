#include "hbm/system.hpp"
#include "linalg/lapack.hpp"
#include <algorithm>
#include <cmath>

namespace plm {

std::unique_ptr<ContactForce> make_contact_force(const HbmOptions &options, std::int64_t n_pairs) {
    return options.aft == AftKind::event
               ? make_event_force(options.n_harmonics, n_pairs)
               : make_sampled_force(options.n_harmonics, options.time_samples, n_pairs);
}

namespace {

// Rigid-body modes that even closed contact does not hold have no static receptance to condense with.
bool can_condense(const ReducedModel &m) {
    if (m.n_pairs() == 0) return false;
    std::int64_t n_rigid = 0;
    while (n_rigid < m.static_size() && m.lambda_0[n_rigid] <= 0) ++n_rigid;
    if (n_rigid == 0) return true;
    const Svd held = thin_svd(m.gap_0.columns(0, n_rigid));
    double size = 0;
    for (std::int64_t k = 0; k < m.gap_0.rows() * m.gap_0.cols(); ++k)
        size = std::max(size, std::abs(m.gap_0.data()[k]));
    return m.n_pairs() >= n_rigid && held.values.back() > 1e-9 * size;
}

} // namespace

std::unique_ptr<HbmSystem> make_system(std::shared_ptr<const ReducedModel> reduced, const HbmOptions &options,
                                       std::string *kind) {
    // The dense factorization dominates both; its order is r (2H + 1) or, at the most, Z (2H + 1).
    bool modal = options.unknowns == UnknownSpace::modal || reduced->n_pairs() == 0;
    if (options.unknowns == UnknownSpace::automatic && !modal)
        modal = reduced->size() <= reduced->n_pairs() || !can_condense(*reduced);
    *kind = modal ? "modal" : "gaps";
    return modal ? make_modal_system(std::move(reduced), options)
                 : make_gap_system(std::move(reduced), options);
}

} // namespace plm
