// The structure with springs along its gap rows, as a matrix that is factored by itself: a contact set
// without a space and without its solutions for every pair.
#pragma once
#include "structure/structure.hpp"

namespace plm {

/// Of structures without rigid-body modes (shift() is 0): borrowed.
class SprungStructure {
  public:
    explicit SprungStructure(const Structure &structure);

    /// In a solution, at most: the springs are that much stiffer than what they hold on to.
    double digits_lost(const vector<double> &springs) const;
    /// springs: by gap row, >= 0. Whatever stood before is forgotten, also where this throws.
    void factor(const vector<double> &springs);
    /// X becomes (K + B^T S B)^-1 X; after factor().
    void solve(Field &x) const { factor_->solve(x); }
    /// The n lowest modes of it, fewer when there are fewer of finite frequency.
    StructureModes lowest_modes(std::int64_t n, const ModeSearch &search) const;

  private:
    const Structure &structure_;
    std::unique_ptr<TallMatrix> matrix_;
    std::unique_ptr<TallFactor> factor_;
};

} // namespace plm
