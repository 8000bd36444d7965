#include "structure/sprung_structure.hpp"
#include "structure/solver/make_factor.hpp"
#include <algorithm>
#include <cmath>

namespace plm {

SprungStructure::SprungStructure(const Structure &structure) : structure_(structure) {}

// One pattern for all springs, zeros among them: its order is found once.
SparseMatrix SprungStructure::with(const vector<double> &springs) const {
    const SparseMatrix &k = structure_.matrices().stiffness;
    const std::vector<DofTerms> rows = structure_.gap_rows().rows();
    vector<std::int64_t> row, column;
    vector<double> value;
    for (std::size_t i = 0; i < rows.size(); ++i)
        for (const DofTerm &a : rows[i])
            for (const DofTerm &b : rows[i]) {
                row.push_back(a.dof), column.push_back(b.dof);
                value.push_back(springs[i] * a.coefficient * b.coefficient);
            }
    return add(1, k, 1, from_triplets(k.rows, k.cols, row, column, value));
}

double SprungStructure::digits_lost(const vector<double> &springs) const {
    const vector<double> k = diagonal(structure_.matrices().stiffness);
    const std::vector<DofTerms> rows = structure_.gap_rows().rows();
    double digits = 0;
    for (std::size_t i = 0; i < rows.size(); ++i)
        for (const DofTerm &t : rows[i])
            digits = std::max(digits, std::log10(springs[i] * t.coefficient * t.coefficient / k[t.dof]));
    return digits;
}

void SprungStructure::factor(const vector<double> &springs) {
    factor_.reset(); // first: not three at once
    matrix_ = with(springs);
    factor_ = make_factor(matrix_, structure_.matrices().solver);
}

StructureModes SprungStructure::lowest_modes(std::int64_t n, const ModeSearch &search) const {
    return plm::lowest_modes(matrix_, structure_.matrices().mass, *factor_, 0, n, search);
}

} // namespace plm
