#include "model/rigid_modes.hpp"
#include "linalg/eigs.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

using Int = long long; // for printf

vector<double> diagonal(const SparseMatrix &a) {
    vector<double> d(a.cols, 0.0);
    for (std::int64_t j = 0; j < a.cols; ++j)
        for (std::int64_t p = a.ptr[j]; p < a.ptr[j + 1]; ++p)
            if (a.idx[p] == j) d[j] = a.val[p];
    return d;
}

/// Does the factor reproduce a vector from K times it? A singular K loses its rigid part altogether, while an
/// ill- conditioned one loses only digits. Needed where the condition estimate is missing (host solvers) or
/// undecided.
bool solves(const SparseMatrix &k, const Factor &factor) {
    vector<double> x(k.cols), y(k.cols);
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = 1 + 0.5 * std::sin(static_cast<double>(i));
    multiply(k, x.data(), y.data());
    factor.solve(y.data(), 1, k.cols);
    for (std::size_t i = 0; i < x.size(); ++i) {
        if (!std::isfinite(y[i])) return false;
        y[i] -= x[i];
    }
    return norm2(k.cols, y.data()) < 1e-3 * norm2(k.cols, x.data());
}

/// Factor of K, or null when K is singular to working precision.
std::unique_ptr<Factor> factor_regular(const SparseMatrix &k, const HostSolver *host) {
    for (double d : diagonal(k))
        if (!(d > 0)) return nullptr; // no need to try
    try {
        std::unique_ptr<Factor> factor = make_factor(k, FactorKind::positive_definite, host);
        const double condition = factor->reciprocal_condition();
        if (condition < 1e-14) return nullptr;
        if ((host || condition < 1e-9) && !solves(k, *factor)) return nullptr;
        return factor;
    } catch (const Error &e) {
        // a host's solver has no other way than its failure code to say "singular"
        if (e.status() == PLM_ERR_NOT_POSITIVE_DEFINITE || e.status() == PLM_ERR_SINGULAR ||
            e.status() == PLM_ERR_CALLBACK)
            return nullptr;
        throw;
    }
}

class RigidModeSearch {
  public:
    RigidModeSearch(const SparseMatrix &k, const SparseMatrix &m, double largest_contact,
                    const vector<std::int64_t> &free_dof, const HostSolver *host, Watch watch)
        : k_(k), m_(m), largest_contact_(largest_contact), free_dof_(free_dof), host_(host), watch_(watch),
          scale_(trace(k) / trace(m)) {}

    FactoredStiffness run() {
        refuse_free_massless_dofs();
        FactoredStiffness result;
        if (!(scale_ > 0))
            return all_rigid(largest_contact_ > 0 ? largest_contact_ * k_.cols / trace(m_) : 1.0);
        result.shift = 1e-8 * scale_;
        result.factor = factor_shifted(result.shift);
        find_gap(*result.factor, result.shift);
        if (n_rigid_ == static_cast<std::int64_t>(pairs_.values.size())) return all_rigid(scale_);
        const double flexible = pairs_.values[n_rigid_];
        result.shift = 1e-2 * flexible;
        result.factor = factor_shifted(result.shift);
        refuse_negative(flexible);
        if (n_rigid_ == 0) return result;
        // again with the better shift: the modes are as orthogonal to the flexible ones as K allows
        const EigenPairs final = lowest(*result.factor, result.shift, n_rigid_ + 1);
        result.rigid_modes = final.vectors.columns(0, n_rigid_);
        watch_.log(1,
                   format("the structure has %lld rigid-body modes while its contacts are open; K + %g M is "
                          "factored instead of K",
                          Int(n_rigid_), result.shift));
        return result;
    }

  private:
    EigenPairs lowest(const Factor &factor, double shift, std::int64_t count) const {
        EigsOptions options;
        options.cancelled = [this] { return watch_.cancelled("rigid-body modes", 0.4); };
        return lowest_eigenpairs(k_, m_, factor, -shift, std::min(count, k_.cols), options);
    }

    // Bodies without any stiffness: all modes are rigid, and only the contact gives sigma a scale.
    FactoredStiffness all_rigid(double scale) {
        FactoredStiffness result;
        result.shift = 1e-2 * scale;
        result.factor = factor_shifted(result.shift);
        EigenPairs all = lowest(*result.factor, result.shift, k_.cols);
        result.rigid_modes = std::move(all.vectors);
        return result;
    }

    // Rigid modes: those below 1e-6 of the next eigenvalue. At most six per body, but the number of bodies is
    // not known: when no gap shows among the modes found, more are taken.
    void find_gap(const Factor &factor, double shift) {
        const double noise =
            1e-13 * scale_; // eps times the largest eigenvalues: what K q_rigid is in floating point
        for (std::int64_t count = std::min<std::int64_t>(8, k_.cols);; count = std::min(k_.cols, 2 * count)) {
            watch_.step("rigid-body modes", 0.3);
            pairs_ = lowest(factor, shift, count);
            const std::int64_t found = static_cast<std::int64_t>(pairs_.values.size());
            n_rigid_ = 0;
            for (std::int64_t r = 1; r < found && n_rigid_ == 0; ++r)
                if (std::max(std::abs(pairs_.values[r - 1]), noise) < 1e-6 * pairs_.values[r]) n_rigid_ = r;
            if (n_rigid_ > 0) return;
            const double highest = found > 0 ? pairs_.values[found - 1] : 0;
            if (highest > 1e3 * noise) return; // flexible modes without a gap: K is only ill-conditioned
            if (found < count || count == k_.cols) {
                n_rigid_ = found;
                return;
            }
        }
    }

    std::unique_ptr<Factor> factor_shifted(double shift) const {
        try {
            return make_factor(add(1.0, k_, shift, m_), FactorKind::positive_definite, host_);
        } catch (const Error &e) {
            if (e.status() != PLM_ERR_NOT_POSITIVE_DEFINITE && e.status() != PLM_ERR_SINGULAR) throw;
            const std::int64_t column = e.index();
            const bool known = column >= 0 && column < k_.cols;
            throw Error(
                PLM_ERR_NOT_POSITIVE_DEFINITE,
                format("K + %g M is not positive definite%s: the stiffness has a negative eigenvalue, or "
                       "mass-less DOFs can move without deformation; check the stiffness matrix and the "
                       "supports",
                       shift,
                       known ? format(" at DOF %lld (counted from 0)", Int(free_dof_[column])).c_str() : ""))
                .reason(PLM_REASON_NOT_POSITIVE_DEFINITE)
                .argument("K")
                .index(known ? free_dof_[column] : -1)
                .library_code(e.library_code());
        }
    }

    void refuse_free_massless_dofs() const {
        const vector<double> dk = diagonal(k_), dm = diagonal(m_);
        for (std::int64_t i = 0; i < k_.cols; ++i)
            if (!(dk[i] > 0) && !(dm[i] > 0))
                throw Error(
                    PLM_ERR_NOT_POSITIVE_DEFINITE,
                    format("DOF %lld (counted from 0) has neither stiffness nor mass; fix it or give it one",
                           Int(free_dof_[i])))
                    .reason(PLM_REASON_NOT_POSITIVE_DEFINITE)
                    .argument("K")
                    .index(free_dof_[i]);
    }

    void refuse_negative(double flexible) const {
        const double noise = 1e-11 * scale_;
        const double lowest = pairs_.values.front();
        if (lowest >= -std::max(1e-6 * flexible, noise)) return;
        throw Error(
            PLM_ERR_NOT_POSITIVE_DEFINITE,
            format("the stiffness matrix has the negative eigenvalue %g (the first elastic one is %g): it is "
                   "not positive semi-definite; check element signs and geometric stiffness",
                   lowest, flexible))
            .reason(PLM_REASON_NOT_POSITIVE_DEFINITE)
            .argument("K");
    }

    const SparseMatrix &k_, &m_;
    double largest_contact_;
    const vector<std::int64_t> &free_dof_;
    const HostSolver *host_;
    Watch watch_;
    double scale_; // trace(K) / trace(M), the size of the large eigenvalues
    EigenPairs pairs_;
    std::int64_t n_rigid_ = 0;
};

} // namespace

double largest_stiffness(const vector<double> &contact_stiffness) {
    double largest = 0;
    for (double k : contact_stiffness) largest = std::max(largest, k);
    return largest;
}

FactoredStiffness factor_with_rigid_modes(const SparseMatrix &k, const SparseMatrix &m,
                                          double largest_contact, const vector<std::int64_t> &free_dof,
                                          const HostSolver *host, Watch watch) {
    if (std::unique_ptr<Factor> factor = factor_regular(k, host)) return {std::move(factor), 0.0, Matrix()};
    return RigidModeSearch(k, m, largest_contact, free_dof, host, watch).run();
}

} // namespace plm
