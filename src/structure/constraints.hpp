// Linear constraints among the DOFs of a structure, sum c_j q_j = 0, and their elimination: each row gives
// one DOF, the dependent one, by others that stay.
#pragma once
#include "structure/field.hpp"

namespace plm {

/// Compressed rows over all DOFs, base 0.
struct ConstraintRows {
    vector<std::int64_t> ptr{0}, dof;
    vector<double> coefficient;
    std::int64_t n_rows() const { return static_cast<std::int64_t>(ptr.size()) - 1; }
};

/// Of what cancels when rows are combined, relative to its terms: what double precision leaves, and what
/// coefficients of printed decks still miss zero by. A row of which no more is left repeats the others.
constexpr double cancelled_exactly = 1e-10, cancelled_as_printed = 1e-6;

struct EliminatedConstraints {
    struct Dependent {
        std::int64_t dof, row; // row: of the constraints, that gave it
        DofTerms terms;        // by DOFs that stay, base 0 over all of them; none: held at zero
    };
    std::vector<Dependent> dependent;
    std::int64_t n_redundant = 0; // rows that say nothing that the others and the fixed DOFs do not say
    /// Of redundant rows, the one that misses most, relative to its terms.
    std::int64_t missing_row = -1;
    double largest_miss = 0;
};

/// Sparse Gaussian elimination, short rows first. In a row the dependent DOF is one with a coefficient that
/// is not small there, by which few other rows are changed, and among such one of a large coefficient.
/// fixed[dof]: held at zero, so that its terms drop out. kept[dof]: dependent only where a row has no other;
/// empty: none.
EliminatedConstraints eliminate(const ConstraintRows &rows, const vector<char> &fixed,
                                const vector<char> &kept = {});

} // namespace plm
