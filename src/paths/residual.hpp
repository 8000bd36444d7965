// Equations R(x, p) = 0, as many as unknowns x, with one parameter p (a frequency, a force, the logarithm of
// an amplitude): all that Newton's method and the continuation know of them.
#pragma once
#include "linalg/memory.hpp"
#include <cstdint>

namespace plm {

/// What linearize_roughly() has made.
enum class Tangent {
    exact,
    rough,  // nearly as good for Newton's method
    guessed // from other points: better than theirs, but no reason to shorten a step by
};

class Residual {
  public:
    virtual ~Residual() = default;
    virtual std::int64_t size() const = 0;
    /// The first static_size() unknowns are mean values: they do not count in the size of a solution.
    virtual std::int64_t static_size() const { return 0; }
    /// r = R(x, p); remembers the smooth piece of R at x for linearize().
    virtual void residual(const double *x, double p, double *r) = 0;
    /// Factors dR/dx at the x and p of the last residual().
    virtual void linearize() = 0;
    /// The same as nearly as Newton's method needs it, where that costs less: it is good for solve() alone
    /// then.
    virtual Tangent linearize_roughly() {
        linearize();
        return Tangent::exact;
    }
    /// Overwrites n right-hand sides (leading dimension size()) by (dR/dx)^-1 b.
    virtual void solve(double *b, std::int64_t n) = 0;
    /// Sign of det(dR/dx) at the last linearize(), up to a factor constant along a path.
    virtual int determinant_sign() const = 0;
    /// dR/dp at the x and p of the last residual().
    virtual void parameter_derivative(double *r) = 0;
    /// What a residual is small or large against.
    virtual double residual_scale() const = 0;
    /// False: there is no solution where residual() was last evaluated, whatever rounding leaves of it.
    virtual bool in_balance() const { return true; }
    /// A new tangent costs less than a residual: that of another point is not used but for the last
    /// correction, and Newton's method makes that one without looking at the residual again.
    virtual bool is_cheap_to_linearize() const { return false; }
    /// How much the square of each unknown counts in a length along the path; null: all alike.
    virtual const vector<double> *weights() const { return nullptr; }
    /// Keeps what linearize() has made of the present x and p, until the next remember(); recall() is back
    /// there, where false says that this system has to do it again.
    virtual void remember() {}
    virtual bool recall() { return false; }
    /// A number for the smooth piece of R at the last residual(): where it goes to and fro, Newton's method
    /// cycles.
    virtual std::int64_t piece() const { return 0; }
};

} // namespace plm
