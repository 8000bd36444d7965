#include "structure/sprung_structure.hpp"
#include <algorithm>
#include <cmath>

namespace plm {

SprungStructure::SprungStructure(const Structure &structure) : structure_(structure) {}

double SprungStructure::digits_lost(const vector<double> &springs) const {
    const std::vector<DofTerms> rows = structure_.gap_rows().rows();
    vector<std::int64_t> dofs;
    for (const DofTerms &row : rows)
        for (const DofTerm &t : row) dofs.push_back(t.dof);
    const vector<double> k = structure_.tall().stiffness().diagonal_at(dofs);
    double digits = 0;
    std::size_t next = 0;
    for (std::size_t i = 0; i < rows.size(); ++i)
        for (const DofTerm &t : rows[i])
            digits = std::max(digits, std::log10(springs[i] * t.coefficient * t.coefficient / k[next++]));
    return digits;
}

void SprungStructure::factor(const vector<double> &springs) {
    factor_.reset(); // first: not three at once
    matrix_ = structure_.tall().stiffness().with_springs(structure_.gap_rows().rows(), springs);
    factor_ = matrix_->factor(structure_.solver());
}

StructureModes SprungStructure::lowest_modes(std::int64_t n, const ModeSearch &search) const {
    return plm::lowest_modes(*matrix_, structure_.tall().mass(), *factor_, 0, n, search);
}

} // namespace plm
