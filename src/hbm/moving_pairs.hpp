// The contact equations u + G T u = b of the pairs whose tangent T varies over the period: G, their
// receptance with all other pairs eliminated, couples the pairs of one harmonic; T couples the harmonics of
// one pair. Unknown (coefficient c, pair p) stands at c s + p.
#pragma once
#include "hbm/pair_elimination.hpp"
#include "linalg/gmres.hpp"

namespace plm {

/// Solved by the LU of the whole matrix, or, where that is large, by GMRES: preconditioned by the LU of the
/// low harmonics, which carry most of the coupling, and by one block for each harmonic above, in which every
/// pair has the mean of its stiffness. Their number of steps hardly depends on H (measured: 25 to 1e-6).
class MovingPairs final : private LinearEquations {
  public:
    enum class Method { automatic, whole, iterated };

    explicit MovingPairs(std::int64_t n_harmonics);
    /// G of a harmonic h: it must live as long as this.
    PairElimination &elimination(std::int64_t h) { return elimination_[h]; }
    /// T: column p holds the (2H + 1) x (2H + 1) block of pair p.
    Matrix &tangent() { return tangent_; }
    std::int64_t n_pairs() const { return tangent_.cols(); }

    void factor(Method method = Method::automatic);
    /// Overwrites b. Where GMRES does not converge the whole matrix is factored, and the next times, too.
    void solve(double *b);
    /// y = T u
    void force(const double *u, double *y) const;
    int determinant_sign();
    bool is_iterated() const { return iterated_; }

  private:
    struct Costs { // flops; of a step as if they were those of a factorization
        double whole, blocks, step;
    };
    Costs costs() const;
    bool pays() const;
    std::int64_t allowed_steps() const;
    bool factor_blocks();
    void factor_whole();
    void keep_sign();
    void assemble(std::int64_t n_harmonics);
    void product(const double *u, double *r) override;
    void precondition(double *v) override;

    std::int64_t h_, n_;
    std::vector<PairElimination> elimination_;
    Matrix tangent_;
    bool iterated_ = false;
    int refused_ = 0, patience_; // times that the whole matrix is factored without a trial, now and after the
                                 // next failure
    Matrix matrix_;              // of the harmonics up to low_, or of all
    RealLu lu_;
    std::int64_t low_ = 0;
    std::vector<ComplexLu> above_; // of the harmonics above low_
    vector<PairElimination::Complex> block_;
    Gmres gmres_;
    int sign_ = 1;
    std::int64_t steps_ = 0; // of the solution by GMRES since the last factorization that the sign is from
    // of one call to the next: no iteration allocates
    vector<double> force_;
    Matrix real_, imag_;
};

} // namespace plm
