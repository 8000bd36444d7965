#include "structure/rigid_modes.hpp"
#include "linalg/lapack.hpp"
#include "structure/eigs.hpp"
#include "structure/rigid_factor.hpp"
#include "structure/solver/make_factor.hpp"
#include "structure/still_dofs.hpp"
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
bool solves(const SparseMatrix &k, const Factor &factor) {
    vector<double> x(k.cols), y(k.cols);
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = 1 + 0.5 * std::sin(static_cast<double>(i));
    multiply_transposed(k, x.data(), y.data());
    factor.solve(y.data(), 1, k.cols);
    for (std::size_t i = 0; i < x.size(); ++i)
        if (!(std::abs(y[i] - x[i]) < 1e-3)) return false;
    return true;
}

/// Factor of K, or null when K is singular to working precision, or may be: a host's solver has no other way
/// to say so than to fail, and that failure is kept.
std::unique_ptr<Factor> factor_regular(const SparseMatrix &k, const Solver &solver,
                                       std::optional<Error> &of_host) {
    for (double d : diagonal(k))
        if (!(d > 0)) return nullptr; // no need to try
    try {
        std::unique_ptr<Factor> factor = make_factor(k, solver);
        const double condition = factor->reciprocal_condition();
        if (condition < 1e-14) return nullptr;
        if ((solver.serving_host() || condition < 1e-9) && !solves(k, *factor)) return nullptr;
        return factor;
    } catch (const Error &e) {
        if (e.status() == status::callback)
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

    void take(EigenPairs found, const SparseMatrix &k, const SparseMatrix &m) {
        pairs = std::move(found);
        if (pairs.values.empty()) return;
        // A shift far above the values leaves them no digits: again in the space of the vectors.
        const Matrix stiffness = product('T', 'N', pairs.vectors, multiply_transposed(k, pairs.vectors));
        const Matrix mass = product('T', 'N', pairs.vectors, multiply_transposed(m, pairs.vectors));
        SymmetricEigen ritz = symmetric_eigen_general(stiffness, mass);
        pairs.vectors = product('N', 'N', pairs.vectors, ritz.vectors);
        rounding.assign(pairs.values.size(), 0.0);
        // beside large ones a small Ritz value has no digits
        for (std::size_t j = 0; j < rounding.size(); ++j) {
            const Energy of = energy(k, pairs.vectors.col(static_cast<std::int64_t>(j)));
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
    RigidModeSearch(const SparseMatrix &k, const SparseMatrix &m, double largest_contact,
                    const vector<std::int64_t> &free_dof, const Solver &solver, Watch watch)
        : k_(k), m_(m), largest_contact_(largest_contact), free_dof_(free_dof), solver_(solver),
          watch_(watch), scale_(typical_eigenvalue()) {}

    FactoredStiffness run() {
        refuse_free_massless_dofs();
        if (!(scale_ > 0))
            return all_rigid(largest_contact_ > 0 ? largest_contact_ * k_.cols / trace(m_) : 1.0);
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
        result.rigid_modes = Field(low_.pairs.vectors.columns(0, n_rigid_));
        result.factor =
            make_rigid_factor(std::move(result.factor), result.rigid_modes.in_core(), m_, result.shift);
        watch_.log(1,
                   format("the structure has %lld rigid-body modes while its contacts are open; K + %g M is "
                          "factored instead of K",
                          Int(n_rigid_), result.shift));
        return result;
    }

  private:
    /// Median of K_ii / M_ii: no penalty and no unit of rotations moves it.
    double typical_eigenvalue() const {
        const vector<double> dk = diagonal(k_), dm = diagonal(m_);
        vector<double> ratio;
        for (std::int64_t i = 0; i < k_.cols; ++i)
            if (dk[i] > 0 && dm[i] > 0) ratio.push_back(dk[i] / dm[i]);
        if (ratio.empty()) return trace(k_) / trace(m_);
        const auto middle = ratio.begin() + static_cast<std::ptrdiff_t>(ratio.size() / 2);
        std::nth_element(ratio.begin(), middle, ratio.end());
        return *middle;
    }

    struct Effort {
        std::int64_t restarts, attempts;
    };
    EigenPairs lowest(const Factor &factor, double shift, std::int64_t count,
                      Effort effort = {300, 3}) const {
        EigsOptions options;
        options.max_restarts = effort.restarts;
        options.max_attempts = effort.attempts;
        options.cancelled = [this] { return watch_.cancelled("rigid-body modes", 0.4); };
        return lowest_eigenpairs(k_, m_, factor, -shift, std::min(count, k_.cols), options);
    }

    // Bodies without any stiffness: all modes are rigid, and only the contact gives sigma a scale.
    FactoredStiffness all_rigid(double scale) {
        FactoredStiffness result;
        result.shift = 1e-2 * scale;
        result.factor = factor_shifted(result.shift, result.shift);
        EigenPairs all = lowest(*result.factor, result.shift, k_.cols);
        result.rigid_modes = Field(std::move(all.vectors));
        return result;
    }

    // A shift far above the first elastic eigenvalue makes them all look alike, one below the rounding of K
    // has no factor: down from where a usual mesh has neither trouble. Next to a factorization the iteration
    // is dear, so that it gives up soon where a lower shift may do.
    void search() {
        double shift = 1e-10 * scale_;
        std::unique_ptr<Factor> factor = factor_shifted(shift, 1e-4 * scale_);
        while (!find_low_modes(*factor, shift, Effort{10, 1})) {
            std::unique_ptr<Factor> lower = 1e-2 * shift > 1e-17 * scale_ ? factor_at(1e-2 * shift) : nullptr;
            if (!lower) {
                if (find_low_modes(*factor, shift, Effort{40, 3})) return;
                throw too_fine();
            }
            shift *= 1e-2;
            factor = std::move(lower);
        }
    }

    // Null: not positive definite.
    std::unique_ptr<Factor> factor_at(double shift) const {
        try {
            return factor_shifted(shift, shift);
        } catch (const Error &e) {
            if (e.status() != status::not_positive_definite) throw;
            return nullptr;
        }
    }

    // At most six rigid modes per body, but the number of bodies is not known: more are taken until there is
    // a flexible one. False: they do not come apart.
    bool find_low_modes(const Factor &factor, double shift, Effort effort) {
        for (std::int64_t count = std::min<std::int64_t>(8, k_.cols);; count = std::min(k_.cols, 2 * count)) {
            watch_.step("rigid-body modes", 0.3);
            try {
                low_.take(lowest(factor, shift, count, effort), k_, m_);
            } catch (const Error &e) {
                const bool slow = e.status() == status::eigensolver && e.library_code() == eigs_too_few;
                if (!slow) throw;
                return false;
            }
            n_rigid_ = count_rigid(low_, scale_);
            if (n_rigid_ < low_.size() || low_.size() < count || count == k_.cols) return true;
        }
    }

    // Rounding of K may exceed a small shift (penalties): up to `largest` it grows until the factor exists.
    std::unique_ptr<Factor> factor_shifted(double &shift, double largest) const {
        for (;; shift = std::min(100 * shift, largest)) {
            watch_.step("factorization", 0.2);
            try {
                return make_factor(add(1.0, k_, shift, m_), solver_);
            } catch (const Error &e) {
                if (e.status() != status::not_positive_definite && e.status() != status::singular) throw;
                if (!(shift < largest)) throw not_positive_definite(e, shift);
            }
        }
    }

    Error not_positive_definite(const Error &e, double shift) const {
        const std::int64_t column = e.index();
        const bool known = column >= 0 && column < k_.cols;
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
        const vector<double> dk = diagonal(k_), dm = diagonal(m_);
        vector<char> coupled(k_.cols, 0);
        mark_coupled(k_, coupled);
        Int multipliers = 0;
        std::int64_t first = -1;
        for (std::int64_t i = 0; i < k_.cols; ++i) {
            if (dk[i] > 0 || dm[i] > 0) continue;
            if (!coupled[i])
                throw unfit(i, format("DOF %lld (counted from 0) has neither stiffness nor mass; fix it or "
                                      "give it one",
                                      Int(free_dof_[i])));
            if (multipliers++ == 0) first = i;
        }
        if (multipliers > 0)
            throw unfit(
                first,
                format(
                    "%lld rows of the stiffness matrix (the first: DOF %lld, counted from 0) are "
                    "coupled to others, but have zero on the diagonal and no mass: they look like "
                    "Lagrange multipliers of constraints, which leave K indefinite. Hand their DOFs over as "
                    "multipliers of the model, and their rows become constraints",
                    multipliers, Int(free_dof_[first])));
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

    const SparseMatrix &k_, &m_;
    double largest_contact_;
    const vector<std::int64_t> &free_dof_;
    const Solver &solver_;
    Watch watch_;
    double scale_; // the size of a usual eigenvalue
    LowModes low_;
    std::int64_t n_rigid_ = 0;
};

} // namespace

FactoredStiffness factor_with_rigid_modes(const SparseMatrix &k, const SparseMatrix &m,
                                          double largest_contact, const vector<std::int64_t> &free_dof,
                                          const Solver &solver, Watch watch) {
    std::optional<Error> of_host;
    if (std::unique_ptr<Factor> factor = factor_regular(k, solver, of_host))
        return {std::move(factor), 0.0, Field()};
    FactoredStiffness found = RigidModeSearch(k, m, largest_contact, free_dof, solver, watch).run();
    if (of_host && found.rigid_modes.cols() == 0) throw *of_host; // K is regular: it was a failure
    return found;
}

} // namespace plm
