// What acts on a structure: loads that its rigid-body motion cannot carry, and others put in their place when
// everything else is known.
#include "linalg/scale.hpp"
#include "structure/structure.hpp"

namespace plm {

using Int = long long; // for printf

Structure::Structure(const Structure &built, const StructureInput &loads, Watch watch)
    : n_dof_(built.n_dof_), outputs_(built.outputs_), parts_(built.parts_), damping_options_(loads.damping) {
    refuse_what_would_move_still_dofs(loads);
    damping_options_.has_matrix = built.damping_options_.has_matrix;
    assemble_loads(loads);
    add_base_forces();
    warn_of_printed_constraints(watch);
    check_unheld_motion(watch);
}

// They were held because nothing acted on them: a build with these loads would leave them free.
void Structure::refuse_what_would_move_still_dofs(const StructureInput &loads) const {
    constexpr const char *what_to_do = "; make a new model with it";
    for (std::int64_t dof : parts_->still_dofs.dof) {
        if (loads.damping.modal_ratio.size() > 1)
            throw Error(status::state,
                        format("DOF %lld is held since nothing holds or moves it, and modes are not counted "
                               "with it as several damping ratios would count them%s",
                               Int(dof), what_to_do))
                .argument("ratio");
        const auto require_none = [&](const char *name, const vector<double> &load) {
            if (!load.empty() && load[dof] != 0)
                throw Error(status::state,
                            format("the load acts on DOF %lld (counted from 0), which the build held since "
                                   "nothing held or moved it%s",
                                   Int(dof), what_to_do))
                    .argument(name)
                    .index(dof);
        };
        require_none("force", loads.preload);
        for (const auto &entry : loads.excitation)
            require_none("real", entry.second.real), require_none("imag", entry.second.imag);
    }
}

void Structure::follow_supports(const StructureInput &in) {
    if (parts_->base.empty()) return;
    parts_->base.follow(*parts_->factor);
    parts_->row_motions = parts_->base.row_motions(parts_->gap_rows.n_rows(), in.gap_row, in.gap_dof,
                                                   in.gap_coefficient, parts_->dofs);
}

void Structure::add_base_forces() {
    if (parts_->base.empty()) return;
    const Damping &d = damping_options_;
    parts_->base.add_forces({tall(), parts_->shift, d.alpha, d.beta, d.structural}, excitation_);
}

// Also what is too small to be said: what carries no force has moved far before a tiny one is felt.
void Structure::leave_out_rounding() {
    constexpr double eps = 1e-15;
    parts_->unheld = unheld_motion(parts_->gap_rows, parts_->rigid_modes);
    parts_->n_unheld = parts_->unheld.cols();
    if (parts_->n_unheld == 0) return;
    parts_->unheld_momenta = mass_times(parts_->unheld);
    const RowMiss &miss = parts_->miss = largest_miss(parts_->gap_rows, parts_->unheld, parts_->rigid_modes);
    if (miss.size > eps) parts_->gap_rows.leave_out(parts_->unheld, parts_->unheld_momenta);
}

void Structure::check_unheld_motion(Watch watch) {
    if (parts_->unheld.cols() == 0) return;
    const RowMiss &miss = parts_->miss;
    if (miss.size > exactly_zero)
        watch.warn(
            reason::rounded,
            format("the gap rows miss rigid-body motion by up to %.1e of their terms (pair %lld): they "
                   "are taken to leave it free, as with coordinates and weights of more digits",
                   miss.size, Int(parts_->gap_rows.size().pair_of(miss.row))));
    preload_resultant_ = balance(preload_, "pre-load", watch);
    for (auto &[part, load] : excitation_)
        if (part.harmonic == 0 && mean_resultant_.empty())
            mean_resultant_ = balance(load.real, "mean of the excitation", watch);
}

// A load that is meant to balance becomes one that does, by the inertia of the structure.
std::string Structure::balance(Field &load, const char *name, Watch watch) const {
    const RowMiss &miss = parts_->miss;
    const Resultant r = resultant(load, parts_->unheld, parts_->rigid_modes);
    std::string fact = format("its resultant is %.3g, %.1e of its forces, along the one in which DOF %lld "
                              "(counted from 0) moves most",
                              r.force, r.relative, Int(dof(r.dof)));
    if (r.relative > meant_as_zero) {
        if (miss.size > exactly_zero)
            fact += format("; the row nearest to holding it is that of pair %lld, by %.1e of its terms",
                           Int(parts_->gap_rows.size().pair_of(miss.row)), miss.size);
        return fact;
    }
    if (r.relative > 0) add_combination(-1.0, parts_->unheld_momenta, gram(parts_->unheld, load), load);
    if (r.relative > exactly_zero)
        watch.warn(
            reason::rounded,
            format("the %s acts on rigid-body motion that neither supports nor contact hold: %s; it is "
                   "taken as balanced, and that much left out through the masses: balance it, or fix DOFs",
                   name, fact.c_str()));
    return {};
}

} // namespace plm
