#include "structure/structure.hpp"
#include "linalg/scale.hpp"
#include "structure/exchanged.hpp"
#include "structure/matrix_input.hpp"
#include "structure/multipliers.hpp"
#include "structure/rigid_modes.hpp"
#include "structure/solver/make_factor.hpp"
#include "structure/tall_operations.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

using Int = long long; // for printf

double bytes_of(const SparseMatrix &a) {
    return 16.0 * static_cast<double>(a.nnz()) + 8.0 * static_cast<double>(a.ptr.size());
}

void require_size(const char *what, std::int64_t size, std::int64_t n_dof) {
    if (size != n_dof)
        throw Error(status::argument,
                    format("%s has %lld entries where the model has %lld DOFs", what, Int(size), Int(n_dof)))
            .argument(what);
}

/// The full symmetric matrix in `input`, over all DOFs.
SparseMatrix over_all_dofs(const char *name, const MatrixInput &input, std::int64_t n_dof) {
    require_size(name, input.layout.n, n_dof);
    return input.to_sparse();
}

/// The constraints, and those that the host's multipliers stand for.
ConstraintRows with_multipliers(const StructureInput &input) {
    ConstraintRows rows = input.constraints;
    if (input.multipliers.empty()) return rows;
    add_multiplier_rows(over_all_dofs("stiffness", *input.stiffness, input.n_dof), input.multipliers, rows);
    return rows;
}

// What needs entries of the matrices, or changes them.
void refuse_beside_operations(const StructureInput &input) {
    const auto refuse = [](bool given, const char *what, const char *instead) {
        if (given)
            throw Error(status::state,
                        format("%s cannot stand beside tall operations: the matrices are the host's, %s",
                               what, instead))
                .argument("model");
    };
    const char *own = "who applies it to them";
    refuse(!input.mass || !input.stiffness || input.mass->behind != input.stiffness->behind ||
               input.damping_matrix,
           "matrices", "all of them");
    refuse(!input.fixed.empty(), "fixed DOFs", own);
    refuse(input.constraints.n_rows() > 0, "constraints, links, couplings and ties", own);
    refuse(!input.multipliers.empty(), "multipliers", own);
    refuse(!input.base_motion.empty(), "a motion of the base", "and with them the supports");
    refuse(!input.elimination_order.empty(), "an elimination order", "and so are their factors");
    refuse(!input.nodes.empty(), "coordinates of nodes", "and what is checked by them is in their entries");
}

// Of all that moves: where constraints add up entries, rounding decides about the sign of a zero.
void require_nonnegative_diagonal(const char *name, const SparseMatrix &a, const DofMap &dofs) {
    for (std::int64_t j = 0; j < a.cols; ++j)
        for (std::int64_t p = a.ptr[j]; p < a.ptr[j + 1]; ++p)
            if (a.idx[p] == j && a.val[p] < 0 && !dofs.is_held(j))
                throw Error(status::matrix,
                            format("the %s matrix has the negative diagonal entry %g at DOF %lld "
                                   "(counted from 0); it must be positive semi-definite",
                                   name, a.val[p], Int(j)))
                    .argument("value")
                    .index(j);
}

// What the parts of a model are made of: the largest entry of each counts.
void require_scale(const char *what, const double *values, std::int64_t n, Status status,
                   const char *argument) {
    const double largest = largest_of(values, n);
    if (!too_large(largest) && !too_small(largest)) return;
    throw Error(status, format("the largest entry of the %s is %g; squares and products overflow or vanish "
                               "outside %g to %g: check its units",
                               what, largest, smallest_scale, largest_scale))
        .argument(argument);
}
void require_scale(const char *what, const SparseMatrix &a) {
    require_scale(what, a.val.data(), a.nnz(), status::matrix, "value");
}

} // namespace

Structure::Structure(const StructureInput &input, GapSize gap, const Solver &solver)
    : n_dof_(input.n_dof), outputs_(input.outputs), parts_(std::make_shared<Parts>()) {
    parts_->solver = solver;
    parts_->multipliers = input.multipliers;
    assemble(input, gap);
    if (parts_->in_core) parts_->tall = tall_in_core(parts_->mass, parts_->stiffness, parts_->damping);
    for (std::int64_t dof : input.elimination_order)
        if (parts_->dofs.free_index(dof) >= 0) parts_->solver.order.push_back(parts_->dofs.free_index(dof));
    if (input.elimination_order.empty()) return;
    for (std::int64_t i = 0; i < n_free(); ++i) // those that the host does not know, behind its own
        if (parts_->dofs.free_dofs()[i] >= n_dof_) parts_->solver.order.push_back(i);
}

Structure::Structure(const StructureInput &input, GapSize gap, double largest_contact, const Solver &solver,
                     Watch watch)
    : Structure(input, gap, solver) {
    warn_of_printed_constraints(watch);
    factor_stiffness(largest_contact, watch);
    follow_supports(input);
    leave_out_rounding();
    add_base_forces();
    check_unheld_motion(watch);
}

StructureEstimate Structure::estimate(const StructureInput &input, GapSize gap, const Solver &solver) {
    if (input.mass && input.mass->behind)
        throw Error(status::state, "what the model takes is known to its host alone, which keeps it behind "
                                   "its tall operations: there is nothing to estimate")
            .argument("model");
    const Structure structure(input, gap, solver);
    const Parts &parts = *structure.parts_;
    const SparseMatrix sum = add(1.0, parts.stiffness, 1.0, parts.mass);
    StructureEstimate e;
    e.n_free = structure.n_free();
    for (const SparseMatrix *a : {&parts.mass, &parts.stiffness, &parts.damping, &parts.gap_rows.matrix()})
        e.bytes += bytes_of(*a);
    e.bytes += parts.dofs.bytes() + bytes_of(parts.given_gap_rows);
    if (!keeps_pattern({parts.stiffness, 1, parts.mass})) e.counted = bytes_of(sum);
    e.factor = estimate_factor(sum, parts.solver); // with the host's order
    return e;
}

void Structure::assemble(const StructureInput &input, GapSize gap) {
    if (!input.mass || !input.stiffness)
        throw Error(status::state, input.mass
                                       ? "the stiffness matrix is missing; hand it over with PLM_STIFFNESS"
                                       : "the mass matrix is missing; hand it over with PLM_MASS");
    if (input.mass->behind || input.stiffness->behind) refuse_beside_operations(input);
    vector<std::int64_t> held = input.fixed;
    held.insert(held.end(), input.multipliers.begin(), input.multipliers.end());
    const ConstraintRows constraints = with_multipliers(input);
    parts_->base = BaseMotion(input.base_motion, n_dof_, input.fixed, held, constraints);
    assemble_on(held, constraints, input, gap);
    parts_->still_dofs = find_still_dofs();
    if (parts_->still_dofs.dof.empty()) return;
    held.insert(held.end(), parts_->still_dofs.dof.begin(), parts_->still_dofs.dof.end());
    assemble_on(held, constraints, input, gap);
}

void Structure::assemble_on(const vector<std::int64_t> &held, const ConstraintRows &constraints,
                            const StructureInput &input, GapSize gap) {
    for (const WideRows wide : {WideRows::whole, WideRows::in_groups}) {
        map_dofs(held, constraints, wide);
        if (assemble_parts(input, gap)) return;
    }
}

// False where rows over many DOFs fill a matrix: to be done again with groups of them.
bool Structure::assemble_parts(const StructureInput &input, GapSize gap) {
    if (!assemble_matrices(input)) return false;
    require_scale("mass matrix", parts_->mass);
    require_scale("stiffness matrix", parts_->stiffness);
    if (!(parts_->in_core ? trace(parts_->mass) > 0 : parts_->tall->facts().trace_of_mass > 0))
        throw Error(status::matrix, "no free DOF has mass; check the mass matrix and the fixed DOFs")
            .argument("value");
    require_scale("damping matrix", parts_->damping);
    assemble_gap(input, gap);
    assemble_loads(input);
    return true;
}

// None where damping ratios count the modes, which would be others, nor where nothing else moves.
StillDofs Structure::find_still_dofs() const {
    if (damping_options_.modal_ratio.size() > 1 || !parts_->in_core) return {};
    vector<char> moves(n_free(), 0);
    for (const SparseMatrix *a : {&parts_->stiffness, &parts_->mass, &parts_->damping})
        mark_coupled(*a, moves);
    for (std::int64_t dof : parts_->gap_rows.dofs()) moves[dof] = 1;
    const auto mark_loaded = [&](const Field &load) {
        if (load.empty()) return;
        const double *force = load.in_core().data();
        for (std::int64_t i = 0; i < load.rows(); ++i)
            if (force[i] != 0) moves[i] = 1;
    };
    mark_loaded(preload_);
    for (const auto &entry : excitation_) mark_loaded(entry.second.real), mark_loaded(entry.second.imag);
    parts_->base.mark_driven(moves);
    const bool others_move = std::count(moves.begin(), moves.end(), 1) > 0;
    return others_move ? plm::still_dofs(parts_->stiffness, parts_->mass, moves, parts_->dofs.free_dofs())
                       : StillDofs();
}

void Structure::map_dofs(const vector<std::int64_t> &fixed, const ConstraintRows &constraints,
                         WideRows wide) {
    parts_->dofs = DofMap(n_dof_, fixed, constraints, {}, wide);
    parts_->place = Field(n_free(), 0);
    if (n_free() == 0)
        throw Error(status::argument,
                    constraints.n_rows() > 0
                        ? "the constraints and the fixed DOFs leave nothing to move; take away some of them"
                        : "all DOFs are fixed; nothing is left to move")
            .argument("dof");
}

void Structure::warn_of_printed_constraints(Watch watch) const {
    const EliminatedConstraints &e = parts_->dofs.elimination();
    if (e.largest_miss > cancelled_exactly)
        watch.warn(
            reason::rounded,
            format("constraint row %lld (counted from 0, in the order they were added) repeats what the "
                   "others say but for %.1e of its terms: it is taken to repeat them, as with "
                   "coefficients of more digits",
                   Int(e.missing_row), e.largest_miss));
}

bool Structure::reduce(const char *name, const SparseMatrix &all, BaseMotion::Through which,
                       SparseMatrix &reduced) {
    std::optional<SparseMatrix> sparse = parts_->dofs.reduced(name, all);
    if (!sparse) return false;
    reduced = std::move(*sparse);
    parts_->base.act(which, all, parts_->dofs);
    return true;
}

bool Structure::assemble_matrices(const StructureInput &input) {
    if (input.mass->behind) return take_operations(input), true;
    // one at a time: over all DOFs they are large
    SparseMatrix all = over_all_dofs("stiffness", *input.stiffness, n_dof_);
    parts_->translations = find_translations(all);
    parts_->geometry = Geometry(input.nodes, n_dof_);
    parts_->geometry.take_stiffness(all, input.multipliers);
    const vector<Translation> mass_like =
        parts_->translations.empty() ? without_negative_entries(all) : vector<Translation>();
    parts_->diagonal_twice = parts_->translations.empty() && is_diagonal_twice(all);
    require_nonnegative_diagonal("stiffness", all, parts_->dofs);
    if (!reduce("stiffness", all, BaseMotion::stiffness, parts_->stiffness)) return false;
    // as many codes hand it over: with the pattern of the stiffness, two thirds zero
    all = without_zeros(over_all_dofs("mass", *input.mass, n_dof_));
    if (!mass_like.empty()) refuse_exchanged(mass_like, all);
    weigh(parts_->translations, all);
    parts_->geometry.take_mass(all);
    require_none_at(input.multipliers, "mass", all);
    require_nonnegative_diagonal("mass", all, parts_->dofs);
    if (!reduce("mass", all, BaseMotion::mass, parts_->mass)) return false;
    damping_options_ = input.damping;
    damping_options_.has_matrix = input.damping_matrix != nullptr;
    if (!damping_options_.has_matrix) return true;
    all = over_all_dofs("damping", *input.damping_matrix, n_dof_);
    require_none_at(input.multipliers, "damping", all);
    return reduce("damping", all, BaseMotion::damping, parts_->damping);
}

// The host's own matrices, supports and constraints: what it does with them is asked, not what they are.
void Structure::take_operations(const StructureInput &input) {
    parts_->in_core = false;
    parts_->tall = tall_by_host(input.mass->behind, n_dof_);
    parts_->place = parts_->tall->stiffness().none();
    const TallScales scales = scales_of(*parts_->tall);
    require_scale("mass matrix", &scales.mass, 1, status::matrix, "fn");
    require_scale("stiffness matrix", &scales.stiffness, 1, status::matrix, "fn");
    require_scale("damping matrix", &scales.damping, 1, status::matrix, "fn");
    damping_options_ = input.damping;
    damping_options_.has_matrix = parts_->tall->damping() != nullptr;
}

void Structure::assemble_gap(const StructureInput &input, GapSize size) {
    const std::int64_t n_rows = size.n_rows();
    SparseMatrix gap = parts_->dofs.reduced_rows(n_rows, input.gap_row, input.gap_dof, input.gap_coefficient);
    vector<double> weight(n_rows, 0.0), given(n_rows, 0.0);
    for (std::size_t k = 0; k < input.gap_row.size(); ++k)
        given[input.gap_row[k]] += std::abs(input.gap_coefficient[k]);
    for (std::int64_t p = 0; p < gap.nnz(); ++p) weight[gap.idx[p]] += std::abs(gap.val[p]);
    for (std::int64_t i = 0; i < n_rows; ++i)
        if (!(weight[i] > 0 && weight[i] > cancelled_exactly * given[i]))
            throw Error(status::argument,
                        format("contact pair %lld (counted from 0, in the order they were added) "
                               "touches %s: its penetration can never change; leave it "
                               "out or release a DOF (a contact of surfaces leaves out "
                               "what is fixed by then)",
                               Int(size.pair_of(i)),
                               parts_->dofs.has_dependent()
                                   ? "only DOFs that are fixed or tied to one another"
                                   : "fixed DOFs only"))
                .argument("pair")
                .index(size.pair_of(i));
    parts_->gap_rows = GapRows(std::move(gap), size, parts_->place);
    if (parts_->dofs.has_dependent())
        parts_->given_gap_rows =
            from_triplets(n_rows, n_dof_, input.gap_row, input.gap_dof, input.gap_coefficient);
}

void Structure::assemble_loads(const StructureInput &input) {
    const auto on_free_dofs = [&](const char *what, const char *name, const vector<double> &all) {
        if (all.empty()) return zeros(1);
        require_size(what, static_cast<std::int64_t>(all.size()), n_dof_);
        require_none_at(parts_->multipliers, name, all);
        const vector<double> free = parts_->dofs.forces(all.data());
        require_scale(name, free.data(), n_free(), status::argument, "force");
        return parts_->place.from(free);
    };
    excitation_on_supports_ = 0;
    preload_ = on_free_dofs("preload", "pre-load", input.preload);
    if (largest_entry(preload_).size == 0) preload_ = Field(); // none: nobody downstream pays for it
    for (const auto &[part, load] : input.excitation) {
        HarmonicForce &mine = excitation_[part];
        mine.real = on_free_dofs("excitation", "excitation", load.real);
        if (part.harmonic == 0) continue;
        mine.imag = on_free_dofs("excitation", "excitation", load.imag);
        for (const vector<double> *values : {&load.real, &load.imag})
            for (std::int64_t dof = 0; dof < n_dof_ && !values->empty(); ++dof)
                if (parts_->dofs.is_held(dof))
                    excitation_on_supports_ = std::hypot(excitation_on_supports_, (*values)[dof]);
    }
}

void Structure::factor_stiffness(double largest_contact, Watch watch) {
    watch.step("factorization", 0.1);
    FactoredStiffness result = factor_with_rigid_modes(*parts_->tall, largest_contact,
                                                       parts_->dofs.told_dofs(), parts_->solver, watch);
    parts_->factor = std::move(result.factor);
    parts_->shift = result.shift;
    if (parts_->shift > 0)
        parts_->shifted = parts_->tall->stiffness().plus(parts_->shift, parts_->tall->mass());
    parts_->rigid_modes = std::move(result.rigid_modes);
    parts_->n_rigid = parts_->rigid_modes.cols();
    parts_->uncertainty = result.uncertainty;
}

Field Structure::damping_times(const Field &x) const {
    const TallMatrix *c = tall().damping();
    return c ? c->times(x) : zeros(x.cols());
}

bool Structure::multiply_responses(const Field &loads, Matrix &energy, Matrix &inertia) const {
    return whole().factor->multiply_responses(parts_->gap_rows.matrix(), loads, parts_->tall->mass(), energy,
                                              inertia);
}

StructureModes lowest_modes(const TallMatrix &k, const TallMatrix &m, const TallFactor &factor, double shift,
                            std::int64_t n, const ModeSearch &search) {
    EigsOptions options;
    options.cancelled = search.cancelled;
    options.look_for_missed = search.look_for_missed;
    options.keep_rest = search.keep_rest;
    if (search.known) {
        const StructureModes &known = *search.known;
        options.known = {&known.values, &known.vectors, known.rest.get()};
    }
    EigenPairs pairs = lowest_eigenpairs(k, m, factor, shift, n, options);
    StructureModes found{std::move(pairs.values), std::move(pairs.vectors), nullptr, !search.look_for_missed};
    if (!pairs.rest.theta.empty()) found.rest = std::make_shared<SearchRest>(std::move(pairs.rest));
    return found;
}

StructureModes Structure::lowest_modes(std::int64_t n, const ModeSearch &search) const {
    return plm::lowest_modes(tall().stiffness(), tall().mass(), *parts_->factor, -parts_->shift, n, search);
}

// Inverse iteration, and the Rayleigh quotient of what it comes to.
double Structure::rough_lowest_elastic() const {
    if (n_rigid() == n_free()) return 0;
    Field x = parts_->place.patternless();
    double square = 0;
    for (int step = 0; step < 3; ++step) {
        Field force = mass_times(x);
        if (n_rigid() > 0)
            add_combination(-1, mass_times(parts_->rigid_modes), gram(parts_->rigid_modes, force), force);
        x = force;
        solve(x);
        const double energy = column_products(x, force)[0], inertia = column_products(x, mass_times(x))[0];
        if (!(energy > 0 && inertia > 0)) return 0;
        square = energy / inertia - parts_->shift;
        x.divide(vector<double>{std::sqrt(inertia)});
    }
    return std::sqrt(std::max(0.0, square));
}

std::int64_t Structure::count_modes_below(double omega) const {
    return count_modes(tall().stiffness(), tall().mass(), omega, parts_->solver);
}

std::int64_t Structure::count_modes_near(double &omega, Watch watch) const {
    return plm::count_modes_near(tall().stiffness(), tall().mass(), omega, parts_->solver, "open modes",
                                 "cutoff_factor", watch);
}

double Structure::trace_of_mass() const {
    return parts_->in_core ? trace(whole().mass) : tall().facts().trace_of_mass;
}

std::int64_t Structure::n_massless_dofs() const {
    const std::int64_t n = parts_->in_core ? n_free() : tall().facts().n_dof;
    return n - tall().mass().n_positive();
}

vector<double> Structure::expanded(const Field &x) const {
    vector<double> all(n_dof_);
    expand(x, 0, all.data());
    return all;
}

Field Structure::restricted(const double *all) const {
    return parts_->place.from(parts_->dofs.free_part(all));
}

std::vector<DofTerms> Structure::given_gap_rows() const {
    const bool as_given = parts_->dofs.has_dependent();
    std::vector<DofTerms> rows =
        as_given ? GapRows(parts_->given_gap_rows, parts_->gap_rows.size()).rows() : parts_->gap_rows.rows();
    for (DofTerms &row : rows) {
        if (as_given)
            row.erase(std::remove_if(row.begin(), row.end(),
                                     [&](const DofTerm &t) { return parts_->dofs.is_held(t.dof); }),
                      row.end());
        else
            for (DofTerm &t : row) t.dof = dof(t.dof);
    }
    return rows;
}

} // namespace plm
