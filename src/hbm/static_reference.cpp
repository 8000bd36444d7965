#include "hbm/static_reference.hpp"
#include "linalg/error.hpp"

namespace plm {

StaticReference::StaticReference(std::shared_ptr<const ReducedModel> reduced, const LawForm &form)
    : m_(std::move(reduced)), stiffness_(m_->n_pairs(), 0.0) {
    require_balanced(*m_);
    for (double l : m_->lambda_0) is_dense_ = is_dense_ || l <= 0;
    hold_ = MeanHold(*m_);
    if (!is_dense_) return;
    for (std::int64_t i = 0; i < m_->n_pairs(); ++i) stiffness_[i] = share_of(form.stiffness[i], i);
    factor();
}

// No stiffer than the structure at the pair, whose flexibility would drown in the rounding of a stiff
// contact.
double StaticReference::share_of(double contact_stiffness, std::int64_t pair) const {
    double flexibility = 0;
    for (std::int64_t j = 0; j < m_->static_size(); ++j)
        if (m_->lambda_0[j] > 0) flexibility += m_->gap_0(pair, j) * m_->gap_0(pair, j) / m_->lambda_0[j];
    const double half = 0.5 * contact_stiffness;
    return half * flexibility > 1 ? 1 / flexibility : half;
}

void StaticReference::factor() {
    const std::int64_t r0 = m_->static_size();
    Matrix k(r0, r0), scaled = m_->gap_0;
    for (std::int64_t j = 0; j < r0; ++j)
        for (std::int64_t i = 0; i < scaled.rows(); ++i) scaled(i, j) *= stiffness_[i];
    gemm('T', 'N', 1.0, m_->gap_0, scaled, 0.0, k);
    for (std::int64_t j = 0; j < r0; ++j) k(j, j) += m_->lambda_0[j];
    gemm('N', 'T', 1.0, hold_.columns(), hold_.columns(), 1.0, k);
    if (!cholesky_.factor(k))
        throw Error(status::singular, "the structure has rigid-body modes that closed contacts hardly hold; "
                                      "fix DOFs or solve in reduced coordinates (unknowns = modal)")
            .reason(reason::singular);
}

void StaticReference::hold(const ContactIndicator &indicator, const double *mean_load) {
    if (hold_.set(*m_, indicator, mean_load) && is_dense_) factor();
}

void StaticReference::apply(double *v) const {
    const std::int64_t r0 = m_->static_size();
    if (is_dense_) return cholesky_.solve(v, 1, r0);
    for (std::int64_t j = 0; j < r0; ++j) v[j] /= m_->lambda_0[j];
}

void StaticReference::receptance(const Matrix &rows, Matrix &out) {
    const std::int64_t n = rows.rows(), r0 = m_->static_size();
    solved_.reset(r0, n);
    for (std::int64_t j = 0; j < n; ++j)
        for (std::int64_t i = 0; i < r0; ++i) solved_(i, j) = rows(j, i);
    if (is_dense_) {
        cholesky_.solve(solved_.data(), n, r0);
    } else {
        for (std::int64_t j = 0; j < n; ++j)
            for (std::int64_t i = 0; i < r0; ++i) solved_(i, j) /= m_->lambda_0[i];
    }
    out.reset(n, n);
    gemm('N', 'N', 1.0, rows, solved_, 0.0, out);
}

} // namespace plm
