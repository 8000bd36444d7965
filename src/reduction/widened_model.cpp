#include "reduction/widened_model.hpp"
#include "linalg/lapack.hpp"
#include "reduction/compression.hpp"
#include <algorithm>

namespace plm {
namespace {

// Largest eigenvalue of the damping matrix, diagonal or not.
double largest_damping(const ReducedModel &m) {
    if (m.size() == 0) return 0;
    if (!m.damping.empty()) return symmetric_eigen(m.damping).values.back();
    return *std::max_element(m.damping_diagonal.begin(), m.damping_diagonal.end());
}

void project_damping(const ReducedModel &m, ReducedModel &wide) {
    const Damping &damping = m.model->damping();
    const std::int64_t n = m.static_size();
    if (damping.modal_ratio.empty() && !damping.has_matrix) {
        for (std::int64_t j = 0; j < n; ++j)
            wide.damping_diagonal.push_back(damping.alpha * m.mass_0(j) + damping.beta * m.lambda_0[j]);
        return;
    }
    if (damping.modal_ratio.empty()) {
        const Field &p_0 = m.vectors_0.formed();
        wide.damping = gram(p_0, m.model->damping_times(p_0));
        for (std::int64_t j = 0; j < n; ++j)
            wide.damping(j, j) += damping.alpha * m.mass_0(j) + damping.beta * m.lambda_0[j];
        return;
    }
    // T C T^T + c_max (M_0 - T M T^T) = T (C - c_max M) T^T + c_max M_0
    const double largest = largest_damping(m);
    Matrix c = m.damping;
    if (c.empty()) {
        c.reset(m.size(), m.size());
        for (std::int64_t j = 0; j < m.size(); ++j) c(j, j) = m.damping_diagonal[j];
    }
    for (std::int64_t j = 0; j < m.size(); ++j) c(j, j) -= largest * m.mass(j);
    wide.damping = product('N', 'T', product('N', 'N', m.to_static, c), m.to_static);
    for (std::int64_t j = 0; j < n; ++j) wide.damping(j, j) += largest * m.mass_0(j);
    clear_massless(m.n_massless_0, wide.damping);
}

ReducedModel widen(const ReducedModel &m) {
    if (!m.model)
        throw Error(PLM_ERR_STATE, "a reduced model with static directions of its own needs its model");
    ReducedModel wide = m;
    wide.same_static = true;
    wide.lambda = m.lambda_0;
    wide.n_massless = m.n_massless_0;
    wide.gap = m.gap_0;
    wide.vectors = m.vectors_0;
    wide.vectors_0 = SpaceVectors();
    wide.to_static = Matrix();
    wide.damping_diagonal.clear();
    wide.damping = Matrix();
    project_damping(m, wide);
    wide.excitation = projected(m.vectors_0, m.model->excitation());
    if (m.all_pairs)
        wide.all_pairs = std::make_shared<const AllPairs>(
            AllPairs{m.all_pairs->gap_0, m.all_pairs->gap_0, m.all_pairs->contact});
    return wide;
}

} // namespace

void clear_massless(std::int64_t n, Matrix &c) {
    for (std::int64_t j = 0; j < c.cols(); ++j)
        for (std::int64_t i = 0; i < c.rows(); ++i)
            if (i >= c.rows() - n || j >= c.cols() - n) c(i, j) = 0;
}

std::shared_ptr<const ReducedModel> widened(const std::shared_ptr<const ReducedModel> &reduced) {
    if (reduced->same_static) return reduced;
    return reduced->widened.get([&] { return widen(*reduced); });
}

bool of_one_basis(const std::shared_ptr<const ReducedModel> &a,
                  const std::shared_ptr<const ReducedModel> &b) {
    const auto one = uncompressed(a), other = uncompressed(b);
    return one == other || widened(one) == other || widened(other) == one;
}

} // namespace plm
