#include "transient/flow_model.hpp"
#include "linalg/lapack.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

vector<double> transposed_product(const Matrix &a, const vector<double> &x) {
    if (x.empty()) return {};
    vector<double> y(a.cols(), 0.0);
    gemv('T', 1.0, a, x.data(), 0.0, y.data());
    return y;
}

// Largest eigenvalue of the damping matrix, diagonal or not.
double largest_damping(const ReducedModel &m) {
    if (m.size() == 0) return 0;
    if (!m.damping.empty()) return symmetric_eigen(m.damping).values.back();
    return *std::max_element(m.damping_diagonal.begin(), m.damping_diagonal.end());
}

} // namespace

FlowModel::FlowModel(std::shared_ptr<const ReducedModel> reduced, double omega)
    : reduced_(std::move(reduced)) {
    find_coordinates();
    project_loads();
    project_damping();
    if (reduced_->structural != 0) add_structural_damping(omega);
}

void FlowModel::find_coordinates() {
    lambda_ = reduced_->lambda_0;
    gap_ = &reduced_->gap_0;
    if (reduced_->same_static) return;
    if (!reduced_->model)
        throw Error(PLM_ERR_STATE, "a reduced model with static directions of its own needs its model");
    to_flow_ = product('T', 'N', reduced_->vectors_0, multiply(reduced_->model->mass(), reduced_->vectors));
}

void FlowModel::project_loads() {
    if (reduced_->same_static) {
        excitation_ = reduced_->excitation;
        return;
    }
    for (const auto &[harmonic, load] : reduced_->model->excitation())
        excitation_[harmonic] = {transposed_product(reduced_->vectors_0, load.real),
                                 transposed_product(reduced_->vectors_0, load.imag)};
}

void FlowModel::project_damping() {
    const ReducedModel &m = *reduced_;
    if (m.same_static) {
        damping_diagonal_ = m.damping_diagonal;
        damping_ = m.damping;
        return;
    }
    const Damping &damping = m.model->damping();
    if (damping.modal_ratio.empty() && !damping.has_matrix) {
        for (double l : lambda_) damping_diagonal_.push_back(damping.alpha + damping.beta * l);
        return;
    }
    if (damping.modal_ratio.empty()) {
        damping_ = product('T', 'N', m.vectors_0, multiply(m.model->damping_matrix(), m.vectors_0));
        for (std::int64_t j = 0; j < size(); ++j) damping_(j, j) += damping.alpha + damping.beta * lambda_[j];
        return;
    }
    // T C T^T + c_max (I - T T^T) = T (C - c_max) T^T + c_max
    const double rest = largest_damping(m);
    Matrix c = m.damping;
    if (c.empty()) {
        c.reset(m.size(), m.size());
        for (std::int64_t j = 0; j < m.size(); ++j) c(j, j) = m.damping_diagonal[j];
    }
    for (std::int64_t j = 0; j < m.size(); ++j) c(j, j) -= rest;
    damping_ = product('N', 'T', product('N', 'N', to_flow_, c), to_flow_);
    for (std::int64_t j = 0; j < size(); ++j) damping_(j, j) += rest;
}

void FlowModel::add_structural_damping(double omega) {
    if (!(omega > 0 && std::isfinite(omega)))
        throw Error(PLM_ERR_ARGUMENT, "structural damping in the time domain needs the response frequency at "
                                      "which its viscous equivalent loses the same energy")
            .argument("omega");
    for (std::int64_t j = 0; j < size(); ++j) {
        const double c = reduced_->structural * lambda_[j] / omega;
        if (damping_.empty()) {
            damping_diagonal_[j] += c;
        } else {
            damping_(j, j) += c;
        }
    }
}

double FlowModel::damping_trace() const {
    double sum = 0;
    for (std::int64_t j = 0; j < size(); ++j)
        sum += has_diagonal_damping() ? damping_diagonal_[j] : damping_(j, j);
    return sum;
}

FlowState FlowModel::state(const vector<double> &eta_0, const Matrix &eta, double omega,
                           double fraction) const {
    if (static_cast<std::int64_t>(eta_0.size()) != size() || eta.rows() != reduced_->size() ||
        eta.cols() % 2 != 0)
        throw Error(PLM_ERR_ARGUMENT, "the harmonic coordinates do not belong to this reduced model")
            .argument("eta");
    vector<double> y(eta.rows(), 0.0), v(eta.rows(), 0.0);
    for (std::int64_t h = 1; 2 * h <= eta.cols(); ++h) {
        const double *a = eta.col(2 * h - 2), *b = eta.col(2 * h - 1), k = static_cast<double>(h);
        const double c = std::cos(2 * M_PI * k * fraction), s = std::sin(2 * M_PI * k * fraction);
        for (std::int64_t j = 0; j < eta.rows(); ++j) {
            y[j] += a[j] * c + b[j] * s;
            v[j] += k * omega * (b[j] * c - a[j] * s);
        }
    }
    FlowState state{eta_0, vector<double>(size(), 0.0), 2 * M_PI * fraction / omega};
    if (reduced_->same_static) {
        for (std::int64_t j = 0; j < size(); ++j) state.y[j] += y[j];
        state.v = v;
    } else {
        gemv('N', 1.0, to_flow_, y.data(), 1.0, state.y.data());
        gemv('N', 1.0, to_flow_, v.data(), 0.0, state.v.data());
    }
    return state;
}

vector<double> FlowModel::dof_row(std::int64_t dof) const {
    const Matrix &vectors = reduced_->static_vectors();
    const std::int64_t n_dof = reduced_->model ? reduced_->model->n_dof() : vectors.rows();
    if (dof < 0 || dof >= n_dof)
        throw Error(PLM_ERR_ARGUMENT, format("DOF %lld is not one of 0 .. %lld", static_cast<long long>(dof),
                                             static_cast<long long>(n_dof - 1)))
            .argument("dof")
            .index(dof);
    const std::int64_t row = reduced_->model ? reduced_->model->free_index(dof) : dof;
    vector<double> values(size(), 0.0);
    if (row < 0) return values;
    for (std::int64_t j = 0; j < size(); ++j) values[j] = vectors(row, j);
    return values;
}

vector<double> FlowModel::field(const vector<double> &y) const {
    const Matrix &vectors = reduced_->static_vectors();
    vector<double> free(vectors.rows(), 0.0);
    gemv('N', 1.0, vectors, y.data(), 0.0, free.data());
    if (!reduced_->model) return free;
    vector<double> all(reduced_->model->n_dof());
    reduced_->model->expand(free.data(), all.data());
    return all;
}

} // namespace plm
