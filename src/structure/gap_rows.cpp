#include "structure/gap_rows.hpp"

namespace plm {

Matrix GapRows::of(const Field &v) const {
    Matrix u = v.block().by_rows(matrix_);
    if (!momenta_.empty()) gemm('N', 'N', -1.0, left_out_, gram(momenta_, v), 1.0, u);
    return u;
}

void GapRows::of(const Field &v, vector<double> &u) const {
    v.block().by_rows(matrix_, u.data());
    if (!momenta_.empty()) gemv('N', -1.0, left_out_, gram(momenta_, v).data(), 1.0, u.data());
}

void GapRows::leave_out(const Field &motions, Field momenta) {
    left_out_ = of(motions);
    momenta_ = std::move(momenta);
}

Matrix GapRows::terms_of(const Field &v) const {
    return v.block().terms_by_rows(matrix_);
}

Field GapRows::forces(const Matrix &f) const {
    Field on_dofs(place_.block().from_rows(matrix_, f));
    if (!momenta_.empty()) add_combination(-1.0, momenta_, product('T', 'N', left_out_, f), on_dofs);
    return on_dofs;
}

Field GapRows::columns() const {
    Field all(place_.block().from_rows(matrix_));
    if (!momenta_.empty()) add_combination(-1.0, momenta_, left_out_.transposed(), all);
    return all;
}

std::vector<DofTerms> GapRows::rows() const {
    std::vector<DofTerms> rows(static_cast<std::size_t>(n_rows()));
    for (std::int64_t j = 0; j < matrix_.cols; ++j)
        for (std::int64_t p = matrix_.ptr[j]; p < matrix_.ptr[j + 1]; ++p)
            rows[static_cast<std::size_t>(matrix_.idx[p])].push_back({j, matrix_.val[p]});
    return rows;
}

vector<std::int64_t> GapRows::dofs_of(const vector<std::int64_t> &pairs) const {
    vector<char> chosen(size_.n_pairs, 0);
    for (std::int64_t i : pairs) chosen[i] = 1;
    return dofs_where(chosen);
}

vector<std::int64_t> GapRows::dofs() const {
    return dofs_where(vector<char>(size_.n_pairs, 1));
}

vector<std::int64_t> GapRows::dofs_where(const vector<char> &chosen) const {
    vector<std::int64_t> found;
    for (std::int64_t j = 0; j < matrix_.cols; ++j)
        for (std::int64_t p = matrix_.ptr[j]; p < matrix_.ptr[j + 1]; ++p)
            if (matrix_.val[p] != 0 && chosen[size_.pair_of(matrix_.idx[p])]) {
                found.push_back(j);
                break;
            }
    return found;
}

} // namespace plm
