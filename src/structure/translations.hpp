// How the DOFs of a structure are numbered, as far as its matrices tell: translations leave the stiffness
// without strain.
#pragma once
#include "structure/sparse.hpp"

namespace plm {

/// DOFs first, first + step, first + 2 step, ... are the same component of the nodes: moved by one together,
/// nothing is strained.
struct Translation {
    std::int64_t first = 0, step = 1;
    double mass = 0; // of the whole structure in this motion, supports included
    bool holds(std::int64_t dof) const { return dof % step == first; }
};

/// Those of nodes with 1, 2, 3 or 6 DOFs each, numbered node by node; the largest number of DOFs per node
/// that gives any. K over all DOFs, before supports are applied. Empty where K holds supports or springs to
/// the ground already, or the DOFs are numbered otherwise: then nothing is known.
vector<Translation> find_translations(const SparseMatrix &k);
/// Whether they would be there if the diagonal of K was half of what it is: a triangle and its mirror image,
/// each with the diagonal, were added up. Of nodes with 2 DOFs or more, for of springs in a row to the ground
/// and to one another that may be meant.
bool is_diagonal_twice(const SparseMatrix &k);
/// Their masses, from M over all DOFs.
void weigh(vector<Translation> &translations, const SparseMatrix &m);

} // namespace plm
