// The harmonic-balance equations in the form that the options ask for.
#pragma once
#include "hbm/options.hpp"
#include "hbm/system.hpp"
#include "reduction/reduced_model.hpp"

namespace plm {

/// The form options.unknowns asks for, automatic: the smaller one when all pairs move. options.n_harmonics >
/// 0 counts per period of the excitation; with options.period_multiple the system repeats after that many
/// periods.
std::unique_ptr<HbmSystem> make_system(std::shared_ptr<const ReducedModel> reduced,
                                       const HbmOptions &options);
/// Reduced coordinates (true) or contact gaps when all pairs move.
bool prefers_modal(const ReducedModel &reduced, const HbmOptions &options);
/// What a step of Newton's method costs at the most: the dense factorization of the smaller form.
double harmonic_step_flops(const ReducedModel &reduced, std::int64_t n_harmonics);
std::unique_ptr<HbmSystem> make_modal_system(std::shared_ptr<const ReducedModel> reduced,
                                             const HbmOptions &options);
std::unique_ptr<HbmSystem> make_gap_system(std::shared_ptr<const ReducedModel> reduced,
                                           const HbmOptions &options);
std::unique_ptr<ContactForce> make_contact_force(const HbmOptions &options, std::int64_t n_pairs);

} // namespace plm
