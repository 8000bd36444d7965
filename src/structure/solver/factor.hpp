// Factorization of sparse symmetric positive definite matrices behind one seam: CHOLMOD, Eigen's LDLT, or the
// host's own through callbacks, chosen by name at run time. Nothing above this header knows which one serves.
#pragma once
#include "structure/sparse.hpp"
#include <memory>
#include <optional>

namespace plm {

class KeptOrders; // structure/solver/ordering.hpp

/// A factorization of one such matrix; read-only after construction, except for its workspace.
class Factor {
  public:
    virtual ~Factor() = default;
    /// X = A^-1 X in place; X is n x nrhs column-major with leading dimension ldx.
    virtual void solve(double *x, std::int64_t nrhs, std::int64_t ldx) const = 0;
    /// Rough reciprocal condition number from the factor's diagonal; 1 when the solver cannot tell.
    virtual double reciprocal_condition() const = 0;
    virtual std::int64_t factor_nonzeros() const = 0; // -1 when unknown
    virtual bool calls_host() const { return false; } // solve() does
    /// For X = A^-1 F with sparse forces F, n x s: energy becomes F^T X, inertia X^T M X, for less than s
    /// solutions. False, and nothing is done, where that is not to be had.
    virtual bool multiply_responses(const SparseMatrix & /*f*/, const SparseMatrix & /*m*/,
                                    Matrix & /*energy*/, Matrix & /*inertia*/) const {
        return false;
    }
    void solve(Matrix &x) const { solve(x.data(), x.cols(), x.rows()); }
};

/// The host's own solver: status 0 is success, anything else fails with that code (PLM_ERR_CALLBACK). The
/// arrays given to `factor` are valid during that call only; `release` is called once for each success of
/// `factor`.
struct HostSolver {
    // factor: column pointers n + 1, rows, values of the lower triangle (base 0, sorted). *handle is the
    // host's.
    int (*factor)(std::int64_t n, const std::int64_t *ptr, const std::int64_t *row, const double *val,
                  int positive_definite, void **handle, void *user) = nullptr;
    int (*solve)(void *handle, std::int64_t nrhs, double *x, std::int64_t ldx, void *user) = nullptr;
    void (*release)(void *handle, void *user) = nullptr;
    void *user = nullptr;
    // the number of negative eigenvalues, or -1: cannot tell; null: never can
    int (*inertia)(void *handle, std::int64_t *negative, void *user) = nullptr;
};

/// In the order of the choices of the option "solver".
enum class SolverName { automatic, cholmod, eigen, host };

/// Of the numbers that a factorization keeps. Single ones are the double ones rounded, and every solve is
/// refined until its residual is one of double precision.
enum class FactorPrecision { full, single };

/// What a factorization takes, known from the pattern alone. Bytes: kept, and at most at once while it is
/// made.
struct FactorEstimate {
    double nonzeros = 0, flops = 0; // of L; of its computation
    double kept_full = 0, peak_full = 0;
    double kept_single = 0, peak_single = 0; // infinite: the solver has none
    double at_work = 0;                      // of a count of negative eigenvalues, which keeps nothing
};

/// Who factors. automatic: the host's where there is one, else LAPACK where every entry is stored, else the
/// first of the library's own that was built.
struct Solver {
    /// given: the host's own, or null.
    Solver(SolverName asked = SolverName::automatic, const HostSolver *given = nullptr) : name(asked) {
        if (given) host = *given;
    }
    Solver(const HostSolver *given) : Solver(SolverName::automatic, given) {}
    /// The host's, if it is to serve; throws where it is asked for and there is none.
    const HostSolver *serving_host() const;
    /// False: count_negative() cannot tell, and factors in vain.
    bool tells_inertia() const { return !serving_host() || serving_host()->inertia; }

    SolverName name = SolverName::automatic;
    std::optional<HostSolver> host;
    // of factorizations by CHOLMOD:
    FactorPrecision precision = FactorPrecision::full; // the others have one alone, and refuse single
    vector<std::int64_t> order;         // the host's: a row for each in the new order; empty: the library's
    std::shared_ptr<KeptOrders> orders; // of the library, found once for each pattern; null: found again
};

/// The two ways in which a factorization breaks down; `column` is the DOF in the order of the caller.
[[noreturn]] void throw_not_positive_definite(std::int64_t column);
[[noreturn]] void throw_singular(std::int64_t column);

} // namespace plm
