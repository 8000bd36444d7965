#include "motions/free_motion.hpp"
#include "linalg/lapack.hpp"
#include "space/rest.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

// Rows and loads of a model that miss a rigid-body motion by rounding have been mended (unheld_motion.hpp):
// between these and what acts there is nothing but rounding of our own.
constexpr double least_hold = 1e-9, least_load = 1e-8;

bool acts_along(const Matrix &directions, const double *load) {
    if (directions.cols() == 0) return false;
    double along = 0;
    for (std::int64_t k = 0; k < directions.cols(); ++k)
        along = std::hypot(along, dot(directions.rows(), directions.col(k), load));
    return along > least_load * norm2(directions.rows(), load);
}

} // namespace

Matrix free_motion(const ReducedModel &m) {
    return free_motion(m, vector<char>(m.n_pairs(), 1));
}

Matrix free_motion(const ReducedModel &m, const vector<char> &holding) {
    std::int64_t n_rigid = 0;
    while (n_rigid < m.static_size() && m.lambda_0[n_rigid] <= 0) ++n_rigid;
    if (n_rigid == 0) return Matrix(m.static_size(), 0);
    const std::int64_t z = m.n_pairs();
    Matrix gap(std::max(z, n_rigid), n_rigid); // rows of zeros below: the SVD is to have all directions
    double size = 0;
    for (std::int64_t i = 0; i < z; ++i) {
        for (std::int64_t j = 0; j < n_rigid; ++j) gap(i, j) = holding[i] ? m.gap_0(i, j) : 0.0;
        for (std::int64_t j = 0; j < m.static_size(); ++j) size = std::max(size, std::abs(m.gap_0(i, j)));
    }
    const Svd held = thin_svd(gap);
    std::int64_t n_held = 0;
    while (n_held < n_rigid && held.values[n_held] > least_hold * size) ++n_held;
    Matrix free(m.static_size(), n_rigid - n_held);
    for (std::int64_t k = n_held; k < n_rigid; ++k)
        for (std::int64_t j = 0; j < n_rigid; ++j) free(j, k - n_held) = held.vt(k, j);
    return free;
}

MeanHold::MeanHold(const ReducedModel &m) : always_(free_motion(m)) {
    depends_ = free_motion(m, vector<char>(m.n_pairs(), 0)).cols() > always_.cols();
    assign(m, always_);
}

void MeanHold::assign(const ReducedModel &m, Matrix directions) {
    const auto flexible = std::find_if(m.lambda_0.begin(), m.lambda_0.end(), [](double l) { return l > 0; });
    const double root = flexible == m.lambda_0.end() ? 1 : std::sqrt(*flexible);
    columns_ = std::move(directions);
    for (std::int64_t k = 0; k < columns_.rows() * columns_.cols(); ++k) columns_.data()[k] *= root;
}

bool MeanHold::set(const ReducedModel &m, const ContactIndicator &indicator, const double *mean_load) {
    if (!depends_) return false;
    now_.resize(m.n_pairs());
    for (std::int64_t i = 0; i < m.n_pairs(); ++i) now_[i] = indicator.acts(i);
    const bool others = now_ != holding_;
    if (others) directions_ = free_motion(m, now_);
    const bool pushed = acts_along(directions_, mean_load);
    if (!others && pushed == pushed_) return false;
    holding_ = now_;
    pushed_ = pushed;
    assign(m, pushed ? always_ : directions_);
    return true;
}

void require_balanced(const ReducedModel &m) {
    const Matrix free = free_motion(m);
    if (m.model && !m.model->preload_resultant().empty())
        throw no_equilibrium("pre-load", m.model->preload_resultant());
    if (m.model && !m.model->mean_resultant().empty())
        throw no_equilibrium("mean of the excitation", m.model->mean_resultant());
    if (acts_along(free, m.preload_0.data())) throw no_equilibrium("pre-load");
    for (const auto &[part, load] : m.excitation)
        if (part.harmonic == 0 && acts_along(free, load.real.data()))
            throw no_equilibrium("mean of the excitation");
}

std::string drift_hint(const ReducedModel &m) {
    if (!MeanHold(m).depends_on_contact()) return {};
    return "; nothing but its contacts holds the structure, and the mean of the loads may carry it out of "
           "their reach: support it, or press the contacts together by a pre-load";
}

} // namespace plm
