// The seam between equations of periodic motions, of harmonic balance or of the exact flow, and what follows
// their solutions: curves, folds, phase resonance.
#pragma once
#include "contact/pair_states.hpp"
#include "linalg/dense.hpp"
#include "linalg/monitor.hpp"
#include "motions/branch_point.hpp"
#include "paths/newton.hpp"

namespace plm {

/// [J columns; rows' corner] with k >= 0 columns, rows (as columns of `rows`) and k x k corner.
struct Border {
    /// Zeros beside n equations.
    void reset(std::int64_t n, std::int64_t k) {
        columns.reset(n, k);
        rows.reset(n, k);
        corner.reset(k, k);
    }
    Matrix columns, rows, corner;
};

/// Such a matrix, factored: J itself is singular at a fold and nearly so at a resonance.
class BorderedTangent {
  public:
    virtual ~BorderedTangent() = default;
    /// Overwrites n right-hand sides (leading dimension: all equations).
    virtual void solve(double *b, std::int64_t n) = 0;
    virtual void solve_transposed(double *b, std::int64_t n) = 0;
    virtual int determinant_sign() const = 0;
};

/// Of a number that the motion, its frequency and its force scale have.
struct MotionGradient {
    vector<double> by_unknowns;
    double by_frequency = 0, by_force = 0;
};

/// What else a path may be followed in: the force scale, or the logarithm of a factor on the stiffness of
/// every pair.
enum class PathParameter { force, stiffness };

/// What equations keep of the points before, as far as the numbers of the next ones depend on it.
struct EquationsMemory {
    struct Tangent {
        vector<double> x;
        double parameter = 0;
        Matrix change; // over a period
    };
    std::vector<PairStates> contact_sets; // whose modes are known, the last used ones last
    Tangent before, last;                 // of no unknowns: none
    bool guessed = false;                 // from these two
    vector<double> beside;                // PointMultipliers::settle()
};

/// Floquet multipliers of points, which harmonic balance leaves to others.
class PointMultipliers {
  public:
    virtual ~PointMultipliers() = default;
    /// Empty: not known.
    virtual vector<std::complex<double>> multipliers(const BranchPoint &point) = 0;
    /// Forgets the points before but for what is returned, with which take() goes on as from here.
    virtual vector<double> settle() = 0;
    virtual void take(const vector<double> &known) = 0;
};
using MultipliersOf = std::shared_ptr<PointMultipliers>;

/// Their parameter is the frequency (rad/s, of the excitation).
class PeriodicEquations : public Residual {
  public:
    /// From the next residual() on. PLM_ERR_ARGUMENT for what they cannot change.
    virtual void set(PathParameter parameter, double value) = 0;
    /// dR/d(parameter) at the last residual().
    virtual void derivative(PathParameter parameter, double *r) = 0;

    virtual vector<double> unknowns(const BranchPoint &point) const = 0;
    /// Of a solution just found.
    virtual BranchPoint solved_point(const PathState &at, double residual, std::int64_t iterations) = 0;
    /// A solution at omega by other means, where the equations cannot be followed there; x is the last one on
    /// entry. False: none.
    virtual bool find(double omega, Watch watch, vector<double> &x, NewtonWork &work) = 0;

    /// Forgets all of the points before but what it returns: from then on others that take() it give the same
    /// numbers, to the last bit. PLM_ERR_ARGUMENT where it is not of these equations.
    virtual EquationsMemory settle() = 0;
    virtual void take(const EquationsMemory &memory) = 0;

    /// Whether the options ask for Floquet multipliers.
    virtual bool has_multipliers() const = 0;
    /// Those of a solution beside which the equations were linearised last; empty: not known.
    virtual vector<std::complex<double>> multipliers(const vector<double> &x, double omega) = 0;

    /// Factors dR/dx at the last residual() with rows and columns beside it. out: null, or one that these
    /// equations have made before.
    virtual void factor_bordered(const Border &border, std::unique_ptr<BorderedTangent> &out) = 0;
    /// What the equations are measured by, of unknowns near 1.
    virtual double row_size(double omega) const = 0;
    /// -w . (dJ) v: how much of J v, seen by w, changes, J the tangent factored last at the last residual().
    /// Leaves that elsewhere.
    virtual MotionGradient tangent_change(const vector<double> &w, const vector<double> &v) = 0;

    /// Work in phase with the lowest harmonic of the excitation in the motion of the last residual(), in the
    /// size of the equations: zero at phase resonance.
    virtual double phase() = 0;
    /// After phase(). False: it has none here.
    virtual bool phase_gradient(MotionGradient &gradient) = 0;
};

} // namespace plm
