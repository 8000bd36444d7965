#include "hbm/system.hpp"

namespace plm {

std::unique_ptr<ContactForce> make_contact_force(const HbmOptions &options, std::int64_t n_pairs) {
    return options.aft == AftKind::event
               ? make_event_force(options.n_harmonics, n_pairs)
               : make_sampled_force(options.n_harmonics, options.time_samples, n_pairs);
}

std::unique_ptr<HbmSystem> make_system(std::shared_ptr<const ReducedModel> reduced, const HbmOptions &options,
                                       std::string *kind) {
    // The dense factorization dominates both; its order is r (2H + 1) or, at the most, Z (2H + 1).
    const bool modal = options.unknowns == UnknownSpace::modal ||
                       (options.unknowns == UnknownSpace::automatic && reduced->size() <= reduced->n_pairs()) ||
                       reduced->n_pairs() == 0;
    *kind = modal ? "modal" : "gaps";
    return modal ? make_modal_system(std::move(reduced), options) : make_gap_system(std::move(reduced), options);
}

} // namespace plm
