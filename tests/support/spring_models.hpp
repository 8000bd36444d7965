// Small models written down entry by entry.
#pragma once
#include "space/model.hpp"
#include "structure/matrix_input.hpp"

namespace test {

using Dense = std::vector<std::vector<double>>;

/// Lower triangle of a dense symmetric matrix as triplets, base 0.
inline std::shared_ptr<const plm::MatrixInput> matrix(const Dense &a) {
    std::vector<std::int32_t> i, j;
    std::vector<double> v;
    for (std::size_t r = 0; r < a.size(); ++r)
        for (std::size_t c = 0; c <= r; ++c)
            if (a[r][c] != 0)
                i.push_back(static_cast<int>(r)), j.push_back(static_cast<int>(c)), v.push_back(a[r][c]);
    plm::MatrixFormat f;
    f.n = static_cast<std::int64_t>(a.size()), f.nnz = static_cast<std::int64_t>(v.size());
    f.storage = plm::storage::triplets, f.part = plm::part::lower, f.negative_diagonal = true;
    return std::make_shared<const plm::MatrixInput>(f, i.data(), j.data(), v.data());
}

inline plm::ModelInput input(const Dense &m, const Dense &k) {
    plm::ModelInput in;
    in.n_dof = static_cast<std::int64_t>(m.size());
    in.mass = matrix(m), in.stiffness = matrix(k);
    return in;
}

/// u = sum coefficient[d] q[d] - gap
inline void add_pair(plm::ModelInput &in, const std::vector<double> &row, double stiffness, double gap = 0) {
    const std::int64_t pair = static_cast<std::int64_t>(in.contact.stiffness.size());
    for (std::size_t d = 0; d < row.size(); ++d)
        if (row[d] != 0)
            in.gap_row.push_back(pair), in.gap_dof.push_back(static_cast<std::int64_t>(d)),
                in.gap_coefficient.push_back(row[d]);
    in.contact.stiffness.push_back(stiffness);
    in.contact.initial_gap.push_back(gap);
}

inline std::shared_ptr<const plm::Model> build(const plm::ModelInput &in) {
    return std::make_shared<const plm::Model>(in, plm::SpaceOptions(), nullptr, plm::Watch());
}

/// Chain of n equal masses m and springs k between them, free at both ends.
inline Dense free_chain(int n, double k) {
    Dense a(n, std::vector<double>(n, 0.0));
    for (int i = 0; i + 1 < n; ++i) a[i][i] += k, a[i + 1][i + 1] += k, a[i][i + 1] -= k, a[i + 1][i] -= k;
    return a;
}
inline Dense diagonal(int n, double m) {
    Dense a(n, std::vector<double>(n, 0.0));
    for (int i = 0; i < n; ++i) a[i][i] = m;
    return a;
}

} // namespace test
