#include "structure/rigid_modes.hpp"
#include "linalg/lapack.hpp"
#include "structure/eigs.hpp"
#include "structure/rigid_factor.hpp"
#include "structure/sparse.hpp"
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

namespace plm {
namespace {

using Int = long long; // for printf

/// Does the factor reproduce a vector from K times it? A singular K loses its rigid part altogether, while an
/// ill-conditioned one loses only digits. Every DOF counts: the loose body may be a small one.
bool solves(const TallMatrix &k, const TallFactor &factor) {
    const Field x = k.none().filled(1, {1, 0.5, 0, 0});
    Field y = k.times(x);
    factor.solve(y);
    add(-1, x, y);
    return y.is_finite() && largest_entry(y).size < 1e-3;
}

/// Factor of K, or null when K is singular to working precision, or may be: a host's solver has no other way
/// to say so than to fail, and that failure is kept.
std::unique_ptr<TallFactor> factor_regular(const TallMatrix &k, double least_stiffness, const Solver &solver,
                                           std::optional<Error> &of_host) {
    if (!(least_stiffness > 0)) return nullptr; // no need to try
    try {
        std::unique_ptr<TallFactor> factor = k.factor(solver);
        const double condition = factor->reciprocal_condition();
        if (condition < 1e-14) return nullptr;
        if ((factor->calls_host() || condition < 1e-9) && !solves(k, *factor)) return nullptr;
        return factor;
    } catch (const Error &e) {
        if (e.status() == status::callback && solver.serving_host())
            of_host = e;
        else if (e.status() != status::not_positive_definite && e.status() != status::singular)
            throw;
        return nullptr;
    }
}

/// The lowest modes as far as K in floating point tells: Rayleigh quotients, and what rounding of K and of
/// its products can do to them, u |x|' |K| |x| / x' M x. In any units, for rotations beside translations, and
/// for penalties, whose rounding counts only where a mode moves them.
struct LowModes {
    EigenPairs pairs;
    vector<double> rounding;

    void take(EigenPairs found, const TallMatrix &k, const TallMatrix &m) {
        pairs = std::move(found);
        if (pairs.values.empty()) return;
        // A shift far above the values leaves them no digits: again in the space of the vectors.
        const Matrix stiffness = block_gram(pairs.vectors, k.times(pairs.vectors));
        const Matrix mass = block_gram(pairs.vectors, m.times(pairs.vectors));
        SymmetricEigen ritz = symmetric_eigen_general(stiffness, mass);
        pairs.vectors = combine(pairs.vectors, ritz.vectors);
        rounding.assign(pairs.values.size(), 0.0);
        // beside large ones a small Ritz value has no digits
        for (std::size_t j = 0; j < rounding.size(); ++j) {
            const Energy of = k.energy(pairs.vectors, static_cast<std::int64_t>(j));
            pairs.values[j] = of.sum;
            rounding[j] = 0.5 * std::numeric_limits<double>::epsilon() * of.terms;
        }
    }
    std::int64_t size() const { return static_cast<std::int64_t>(pairs.values.size()); }
    double largest_rounding() const { return *std::max_element(rounding.begin(), rounding.end()); }
};

// Matrices of codes that sum element matrices carry more than the rounding of their entries; measured on
// bricks with internal modes: up to 3 times it. Between these two a mode is rigid when it stands alone.
constexpr double certain = 16, doubtful = 2048, alone = 1e-3;
// Of a usual eigenvalue: where K is zero, what a vector right to 1e-12 holds of other motions.
constexpr double nothing = 1e-24;
// So much larger is the first elastic eigenvalue at least, if it is one. What rounding leaves of it is said.
constexpr double clear = 0.1;

/// How many of the lowest modes are rigid. Negative values are noise, too, unless refused later.
/// scale: the size of a usual eigenvalue.
std::int64_t count_rigid(const LowModes &low, double scale) {
    const vector<double> &value = low.pairs.values;
    const double negative = value.empty() ? 0 : std::max(0.0, -value.front());
    const std::int64_t n = low.size();
    const auto noise = [&](std::int64_t j, double factor) {
        return std::max({factor * low.rounding[j], factor / certain * negative, nothing * scale});
    };
    std::int64_t count = 0;
    while (count < n && value[count] <= noise(count, certain)) ++count;
    std::int64_t beyond = count;
    while (beyond < n && value[beyond] <= noise(beyond, doubtful)) ++beyond;
    if (beyond > count && beyond < n && value[beyond - 1] < alone * value[beyond]) return beyond;
    return count;
}

class RigidModeSearch {
  public:
    RigidModeSearch(const Tall &structure, const TallFacts &facts, double largest_contact,
                    const vector<std::int64_t> &free_dof, const Solver &solver, Watch watch)
        : k_(structure.stiffness()), m_(structure.mass()), facts_(facts), largest_contact_(largest_contact),
          free_dof_(free_dof), solver_(solver), watch_(watch), scale_(facts.typical_eigenvalue) {}

    FactoredStiffness run() {
        refuse_free_massless_dofs();
        if (!(scale_ > 0))
            return all_rigid(largest_contact_ > 0
                                 ? largest_contact_ * static_cast<double>(n()) / facts_.trace_of_mass
                                 : 1.0);
        search();
        if (n_rigid_ == low_.size()) return all_rigid(scale_);
        const double flexible = low_.pairs.values[n_rigid_];
        refuse_negative(flexible);
        refuse_too_fine(flexible);
        FactoredStiffness result;
        result.shift = std::max(1e-2 * flexible, 1e3 * low_.largest_rounding());
        result.factor = factor_shifted(result.shift, 1e-4 * scale_);
        result.uncertainty = low_.largest_rounding() / flexible;
        if (n_rigid_ == 0) {
            watch_.log(1,
                       format("the stiffness is singular to working precision, though no rigid-body mode was "
                              "found; K + %g M is factored instead of K",
                              result.shift));
            return result;
        }
        // again with the better shift: the modes are as orthogonal to the flexible ones as K allows
        low_.take(lowest(*result.factor, result.shift, n_rigid_ + 1), k_, m_);
        result.rigid_modes = low_.pairs.vectors.columns(0, n_rigid_);
        result.factor = make_rigid_factor(std::move(result.factor), result.rigid_modes, m_, result.shift);
        watch_.log(1,
                   format("the structure has %lld rigid-body modes while its contacts are open; K + %g M is "
                          "factored instead of K",
                          Int(n_rigid_), result.shift));
        return result;
    }

  private:
    std::int64_t n() const { return facts_.n_dof; }

    struct Effort {
        std::int64_t restarts, attempts;
    };
    EigenPairs lowest(const TallFactor &factor, double shift, std::int64_t count,
                      Effort effort = {300, 3}) const {
        EigsOptions options;
        options.max_restarts = effort.restarts;
        options.max_attempts = effort.attempts;
        options.cancelled = [this] { return watch_.cancelled("rigid-body modes", 0.4); };
        return lowest_eigenpairs(k_, m_, factor, -shift, std::min(count, n()), options);
    }

    // Bodies without any stiffness: all modes are rigid, and only the contact gives sigma a scale.
    FactoredStiffness all_rigid(double scale) {
        FactoredStiffness result;
        result.shift = 1e-2 * scale;
        result.factor = factor_shifted(result.shift, result.shift);
        EigenPairs all = lowest(*result.factor, result.shift, n());
        result.rigid_modes = std::move(all.vectors);
        return result;
    }

    // A shift far above the first elastic eigenvalue makes them all look alike, one below the rounding of K
    // has no factor: down from where a usual mesh has neither trouble. Next to a factorization the iteration
    // is dear, so that it gives up soon where a lower shift may do.
    void search() {
        double shift = 1e-10 * scale_;
        std::unique_ptr<TallFactor> factor = factor_shifted(shift, 1e-4 * scale_);
        while (!find_low_modes(*factor, shift, Effort{10, 1})) {
            std::unique_ptr<TallFactor> lower =
                1e-2 * shift > 1e-17 * scale_ ? factor_at(1e-2 * shift) : nullptr;
            if (!lower) {
                if (find_low_modes(*factor, shift, Effort{40, 3})) return;
                throw too_fine();
            }
            shift *= 1e-2;
            factor = std::move(lower);
        }
    }

    // Null: not positive definite.
    std::unique_ptr<TallFactor> factor_at(double shift) const {
        try {
            return factor_shifted(shift, shift);
        } catch (const Error &e) {
            if (e.status() != status::not_positive_definite) throw;
            return nullptr;
        }
    }

    // At most six rigid modes per body, but the number of bodies is not known: more are taken until there is
    // a flexible one. False: they do not come apart.
    bool find_low_modes(const TallFactor &factor, double shift, Effort effort) {
        for (std::int64_t count = std::min<std::int64_t>(8, n());; count = std::min(n(), 2 * count)) {
            watch_.step("rigid-body modes", 0.3);
            try {
                low_.take(lowest(factor, shift, count, effort), k_, m_);
            } catch (const Error &e) {
                const bool slow = e.status() == status::eigensolver && e.library_code() == eigs_too_few;
                if (!slow) throw;
                return false;
            }
            n_rigid_ = count_rigid(low_, scale_);
            if (n_rigid_ < low_.size() || low_.size() < count || count == n()) return true;
        }
    }

    // Rounding of K may exceed a small shift (penalties): up to `largest` it grows until the factor exists.
    std::unique_ptr<TallFactor> factor_shifted(double &shift, double largest) const {
        for (;; shift = std::min(100 * shift, largest)) {
            watch_.step("factorization", 0.2);
            try {
                return k_.plus(shift, m_)->factor(solver_);
            } catch (const Error &e) {
                if (e.status() != status::not_positive_definite && e.status() != status::singular) throw;
                if (!(shift < largest)) throw not_positive_definite(e, shift);
            }
        }
    }

    Error not_positive_definite(const Error &e, double shift) const {
        const std::int64_t column = e.index();
        const bool known = column >= 0 && column < k_.rows();
        return Error(
                   status::not_positive_definite,
                   format("K + %g M is not positive definite%s: the stiffness has a negative eigenvalue, or "
                          "mass-less DOFs can move without deformation; check the stiffness matrix and the "
                          "supports",
                          shift,
                          known ? format(" at DOF %lld (counted from 0)", Int(free_dof_[column])).c_str()
                                : ""))
            .reason(reason::not_positive_definite)
            .argument("K")
            .index(known ? free_dof_[column] : -1)
            .library_code(e.library_code());
    }

    void refuse_free_massless_dofs() const {
        if (facts_.loose >= 0)
            throw unfit(facts_.loose,
                        format("DOF %lld (counted from 0) has neither stiffness nor mass; fix it or "
                               "give it one",
                               Int(free_dof_[facts_.loose])));
        if (facts_.n_multipliers > 0)
            throw unfit(
                facts_.multiplier,
                format(
                    "%lld rows of the stiffness matrix (the first: DOF %lld, counted from 0) are "
                    "coupled to others, but have zero on the diagonal and no mass: they look like "
                    "Lagrange multipliers of constraints, which leave K indefinite. Hand their DOFs over as "
                    "multipliers of the model, and their rows become constraints",
                    Int(facts_.n_multipliers), Int(free_dof_[facts_.multiplier])));
    }

    Error unfit(std::int64_t column, const std::string &text) const {
        return Error(status::not_positive_definite, text)
            .reason(reason::not_positive_definite)
            .argument("K")
            .index(free_dof_[column]);
    }

    void refuse_negative(double flexible) const {
        const double value = low_.pairs.values.front();
        if (value >= -std::max(1e-6 * flexible, doubtful * low_.rounding.front())) return;
        throw Error(
            status::not_positive_definite,
            format("the stiffness matrix has the negative eigenvalue %g (the first elastic one is %g): it is "
                   "not positive semi-definite; check element signs and geometric stiffness",
                   value, flexible))
            .reason(reason::not_positive_definite)
            .argument("K");
    }

    // Rigid-body modes stand clear of the elastic ones, or some of them are elastic.
    void refuse_too_fine(double flexible) const {
        double largest = 0;
        for (std::int64_t j = 0; j < n_rigid_; ++j)
            largest = std::max(largest, std::abs(low_.pairs.values[j]));
        if (largest > clear * flexible) throw too_fine();
    }

    Error too_fine() const {
        return Error(status::singular,
                     "the lowest elastic modes lie below what rounding makes of the stiffness matrix, and "
                     "cannot be "
                     "told from rigid-body motion: the mesh is too fine, or a penalty too stiff, for double "
                     "precision; use larger elements, a softer penalty, or supports")
            .reason(reason::singular)
            .argument("K");
    }

    const TallMatrix &k_, &m_;
    const TallFacts &facts_;
    double largest_contact_;
    const vector<std::int64_t> &free_dof_;
    const Solver &solver_;
    Watch watch_;
    double scale_; // the size of a usual eigenvalue
    LowModes low_;
    std::int64_t n_rigid_ = 0;
};

} // namespace

FactoredStiffness factor_with_rigid_modes(const Tall &structure, double largest_contact,
                                          const vector<std::int64_t> &free_dof, const Solver &solver,
                                          Watch watch) {
    std::optional<Error> of_host;
    const TallFacts facts = structure.facts();
    if (std::unique_ptr<TallFactor> factor =
            factor_regular(structure.stiffness(), facts.least_stiffness, solver, of_host))
        return {std::move(factor), 0.0, Field()};
    FactoredStiffness found =
        RigidModeSearch(structure, facts, largest_contact, free_dof, solver, watch).run();
    if (of_host && found.rigid_modes.cols() == 0) throw *of_host; // K is regular: it was a failure
    return found;
}

} // namespace plm
