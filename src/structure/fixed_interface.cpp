#include "structure/fixed_interface.hpp"
#include "structure/mode_count.hpp"
#include <algorithm>
#include <cmath>

namespace plm {

class FixedInterface::Interior {
  public:
    Interior(const Structure &structure, std::unique_ptr<HeldTall> held, std::int64_t n_boundary, Watch watch)
        : solver_(structure.solver()), model_shift_(structure.shift()), watch_(watch), n_(held->n_interior()),
          n_boundary_(n_boundary), held_(std::move(held)), k_(held_->stiffness()), m_(held_->mass()) {
        factor_interior();
    }

    const HeldTall &held() const { return *held_; }

    /// -K_ii^-1 K_ib in blocks of columns.
    Field constraint_modes() const {
        Field psi = k_.none();
        const std::int64_t block = 64;
        for (std::int64_t first = 0; first < n_boundary_; first += block) {
            watch_.step("constraint modes", static_cast<double>(first) / static_cast<double>(n_boundary_));
            psi.append(static_response(held_->driving_forces(first, std::min(block, n_boundary_ - first))));
        }
        return psi;
    }

    /// The n_fixed lowest fixed-interface modes, or all below `highest` (rad/s) when n_fixed = 0.
    Field fixed_modes(std::int64_t n_fixed, double highest) const {
        watch_.step("fixed-interface modes", 0.0);
        EigsOptions options;
        options.cancelled = [this] { return watch_.cancelled("fixed-interface modes", 0.5); };
        double limit = highest;
        const std::int64_t counted = n_fixed > 0
                                         ? n_fixed
                                         : count_modes_near(k_, m_, limit, solver_, "fixed-interface modes",
                                                            "highest frequency", watch_);
        std::int64_t wanted = std::min(n_, counted >= 0 ? counted : 20);
        for (;;) {
            if (wanted == 0) return k_.none();
            const EigenPairs pairs = lowest_eigenpairs(k_, m_, *factor_, -shift_, wanted, options);
            const std::int64_t found = static_cast<std::int64_t>(pairs.values.size());
            if (counted > 0 && n_fixed == 0) require_counted(pairs, counted, limit);
            const bool complete = found < wanted || wanted == n_ || pairs.values.back() > highest * highest;
            if (n_fixed > 0) return pairs.vectors;
            if (counted < 0 && !complete) {
                wanted = std::min(n_, 2 * wanted);
                continue;
            }
            std::int64_t below = 0;
            while (below < found && (counted >= 0 || pairs.values[below] <= highest * highest)) ++below;
            return pairs.vectors.columns(0, below);
        }
    }

    /// Static responses of the fixed-interface interior to the loads on it, of unit energy, orthogonal among
    /// themselves and to the fixed-interface modes `phi`, which carry little of the deformation around a
    /// point load, and nothing of it where there is no mass.
    Field load_modes(const Field &loads, const Field &phi) const {
        const std::unique_ptr<TallMatrix> sum = shift_ > 0 ? k_.plus(shift_, m_) : nullptr;
        const TallMatrix &shifted = sum ? *sum : k_;
        Field basis = phi;
        const Field x = static_response(loads);
        to_unit_energy(shifted, basis);
        for (std::int64_t j = 0; j < x.cols(); ++j) {
            Field column = x.columns(j, 1);
            to_unit_energy(shifted, column);
            for (int pass = 0; pass < 2; ++pass) // twice is enough
                add_combination(-1.0, basis, block_gram(basis, shifted.times(column)), column);
            if (!(to_unit_energy(shifted, column) > 1e-8)) continue;
            basis.append(column);
        }
        return basis.columns(phi.cols(), basis.cols() - phi.cols());
    }

  private:
    // Each column; the root of what the energy of the last was.
    static double to_unit_energy(const TallMatrix &stiffness, Field &x) {
        vector<double> size = column_products(x, stiffness.times(x));
        double last = 0;
        for (double &one : size) {
            last = std::sqrt(std::max(0.0, one));
            one = last > 0 ? last : 1;
        }
        x.divide(size);
        return last;
    }

    // K_ii is singular when a part of the interior is held by nothing but the contact: then K_ii + sigma
    // M_ii.
    void factor_interior() {
        try {
            factor_ = k_.factor(solver_);
            if (model_shift_ == 0 || factor_->reciprocal_condition() > 1e-12) return;
        } catch (const Error &e) {
            if (model_shift_ == 0) throw;
            if (e.status() != status::not_positive_definite && e.status() != status::singular) throw;
        }
        shift_ = model_shift_;
        factor_ = k_.plus(shift_, m_)->factor(solver_);
    }

    // K_ii^-1 F for loads that do no work on interior rigid-body motion. With the shifted factor this is an
    // iteration that converges by sigma / (lambda + sigma) per step; what is slow lies in the fixed-interface
    // modes anyway.
    Field static_response(const Field &loads) const {
        Field x = loads;
        factor_->solve(x);
        for (int step = 0; shift_ > 0 && step < 10; ++step) {
            Field residual = k_.times(x);
            set_sum({{1.0, loads}, {-1.0, residual}}, residual);
            factor_->solve(residual);
            add(1.0, residual, x);
        }
        return x;
    }

    static void require_counted(const EigenPairs &pairs, std::int64_t counted, double limit) {
        const auto below = std::count_if(pairs.values.begin(), pairs.values.end(), [&](double value) {
            return value <= (1 + count_rounding) * limit * limit;
        });
        if (below < counted)
            throw Error(status::eigensolver, format("%lld fixed-interface modes were found below %.6g Hz "
                                                    "where the Sturm sequence counts %lld",
                                                    static_cast<long long>(below), limit / (2 * M_PI),
                                                    static_cast<long long>(counted)));
    }

    const Solver &solver_;
    double model_shift_; // sigma of the whole structure
    Watch watch_;
    std::int64_t n_, n_boundary_;
    std::unique_ptr<HeldTall> held_;
    const TallMatrix &k_, &m_;
    std::unique_ptr<TallFactor> factor_;
    double shift_ = 0;
};

FixedInterface::FixedInterface(const Structure &structure, Watch watch)
    : structure_(structure), boundary_dof_(structure.gap_rows().dofs()) {
    std::unique_ptr<HeldTall> held = structure.tall().held(boundary_dof_);
    if (held->n_interior() > 0)
        interior_ = std::make_unique<Interior>(structure, std::move(held), n_boundary(), watch);
}

FixedInterface::~FixedInterface() = default;

Field FixedInterface::constraint_modes() const {
    Field modes = interior_ && n_boundary() > 0 ? interior_->held().on_all_dofs(interior_->constraint_modes())
                                                : structure_.zeros(n_boundary());
    std::vector<DofTerms> units;
    for (std::int64_t dof : boundary_dof_) units.push_back({{dof, 1.0}});
    modes.block().add_sums(units);
    return modes;
}

Field FixedInterface::interior_modes(std::int64_t n_fixed, double highest, bool with_load_responses) const {
    if (!interior_) return structure_.zeros(0);
    Field phi = interior_->fixed_modes(n_fixed, highest);
    if (with_load_responses) phi.append(interior_->load_modes(interior_loads(), phi));
    return interior_->held().on_all_dofs(phi);
}

Field FixedInterface::interior_loads() const {
    const Field inside = interior_->held().inside(
        load_columns(structure_.preload(), structure_.excitation(), structure_.zeros(0)));
    const vector<double> size = column_norms(inside);
    vector<std::int64_t> kept;
    for (std::int64_t j = 0; j < inside.cols(); ++j)
        if (size[j] > 0) kept.push_back(j);
    return inside.columns(kept);
}

} // namespace plm
