#include "space/memory_estimate.hpp"
#include "space/exact_modes.hpp"
#include "structure/solver/ordering.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

constexpr double mebibyte = 1 << 20;

// What nobody knows before the sampler has run: a usual number of each.
constexpr double n_modes = 60, n_basis = 40;
// Vectors of a contact space beside its modes: in proportion to a few pairs, and hardly more for many.
constexpr double further_per_pair = 0.5, most_further = 300;
// Columns of the structure's size: what the model keeps of its own modes, their momenta and the search for
// them; a search for n_modes, with its blocks and the modes it hands over; a block of right-hand sides with
// its workspace.
constexpr double own_columns = 2 * modes_anyhow + most_rest;
constexpr double lanczos_columns = 2 * n_modes + 26 * 8 + n_modes;
constexpr double solve_columns = 4 * 64;
// Of each contact row: what the products of the responses hold of a column at once, above the subtrees and in
// those at work.
constexpr double response_columns = 0.25;

Solver solver_of(const SpaceOptions &options, const HostSolver *host) {
    Solver solver(options.solver, host);
    solver.orders = std::make_shared<KeptOrders>();
    if (options.precision == PrecisionChoice::single) solver.precision = FactorPrecision::single;
    return solver;
}

StructureEstimate estimate_structure(const ModelInput &input, const Solver &solver) {
    return Structure::estimate(input, {input.contact.n_pairs(), Contact::n_directions}, solver);
}

struct Fit {
    FactorPrecision precision;
    MemoryEstimate memory;
};

Fit fit(const StructureEstimate &structure, std::int64_t n_pairs, const SpaceOptions &options) {
    const bool may_be_single = structure.factor && std::isfinite(structure.factor->peak_single);
    const double limit = options.memory_limit * mebibyte;
    const Fit full{FactorPrecision::full, estimate_memory(structure, n_pairs, FactorPrecision::full)};
    const Fit single{FactorPrecision::single, estimate_memory(structure, n_pairs, FactorPrecision::single)};
    const auto fits = [&](const Fit &one) { return !(limit > 0) || one.memory.peak() <= limit; };
    const bool asks_single = options.precision == PrecisionChoice::single;
    if (!asks_single && fits(full)) return full;
    if (options.precision != PrecisionChoice::full && (asks_single || may_be_single) && fits(single))
        return single;
    const auto in_mebibytes = [](const Fit &one) { return std::ceil(one.memory.peak() / mebibyte); };
    const std::string other = may_be_single
                                  ? format(" (%.0f MiB with factor_precision = single)", in_mebibytes(single))
                                  : std::string();
    throw Error(status::memory,
                format("the model needs about %.0f MiB in double precision%s, and memory_limit is %g MiB: "
                       "raise it, or hand over fewer DOFs or contact pairs",
                       in_mebibytes(full), other.c_str(), options.memory_limit))
        .argument("memory_limit");
}

} // namespace

double MemoryEstimate::peak() const {
    return structure + std::max(factorization, factor + std::max({modes, contact_space, basis}));
}

MemoryEstimate estimate_memory(const StructureEstimate &s, std::int64_t n_pairs, FactorPrecision precision) {
    const double column = 8.0 * static_cast<double>(s.n_free), z = static_cast<double>(n_pairs);
    const bool single = precision == FactorPrecision::single;
    MemoryEstimate e;
    e.structure = s.bytes;
    if (s.factor) {
        e.factor = single ? s.factor->kept_single : s.factor->kept_full;
        e.factorization = single ? s.factor->peak_single : s.factor->peak_full;
    }
    // the count of modes eliminates the shifted matrix front by front, and keeps nothing
    const double count = s.factor ? s.factor->at_work + s.counted : 0;
    const double responses =
        single ? solve_columns : response_columns * z; // products, or solved for in blocks
    e.modes = std::max({(2 * modes_anyhow + lanczos_columns) * column, own_columns * column + count,
                        (own_columns + responses) * column});
    const double further = std::min(further_per_pair * z, most_further);
    const double space = (2 * modes_anyhow + 2 * n_modes + further) * column; // modes and momenta
    e.contact_space = space + (solve_columns + further) * column; // as many again of the directions at work
    e.basis = space + (solve_columns + n_basis) * column;
    return e;
}

MemoryEstimate estimate_memory(const ModelInput &input, const SpaceOptions &options, const HostSolver *host) {
    const StructureEstimate structure = estimate_structure(input, solver_of(options, host));
    SpaceOptions unlimited = options;
    unlimited.memory_limit = 0;
    return fit(structure, input.contact.n_pairs(), unlimited).memory;
}

Solver fitting_solver(const ModelInput &input, const SpaceOptions &options, const HostSolver *host,
                      Watch watch) {
    Solver solver = solver_of(options, host);
    if (!(options.memory_limit > 0)) return solver;
    watch.step("memory", 0.0);
    const Fit chosen = fit(estimate_structure(input, solver), input.contact.n_pairs(), options);
    if (chosen.precision != solver.precision)
        watch.log(
            1,
            format("the factor is kept in single precision, and every solve refined: about %.0f MiB in all",
                   std::ceil(chosen.memory.peak() / mebibyte)));
    solver.precision = chosen.precision;
    return solver;
}

} // namespace plm
