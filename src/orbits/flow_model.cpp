#include "orbits/flow_model.hpp"
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

// Coordinates without mass and without damping of their own have none with others either, where the damping
// takes energy at all.
void clear_massless(std::int64_t n, Matrix &c) {
    for (std::int64_t j = 0; j < c.cols(); ++j)
        for (std::int64_t i = 0; i < c.rows(); ++i)
            if (i >= c.rows() - n || j >= c.cols() - n) c(i, j) = 0;
}

// The last rows of x become turn^T times them.
void turn_rows(const Matrix &turn, Matrix &x) {
    const std::int64_t n = turn.rows(), first = x.rows() - n;
    vector<double> before(n);
    for (std::int64_t j = 0; j < x.cols(); ++j) {
        std::copy_n(x.col(j) + first, n, before.data());
        gemv('T', 1.0, turn, before.data(), 0.0, x.col(j) + first);
    }
}

} // namespace

FlowModel::FlowModel(std::shared_ptr<const ReducedModel> reduced, double omega)
    : reduced_(std::move(reduced)) {
    find_coordinates();
    project_loads();
    project_damping();
    if (reduced_->structural != 0) add_structural_damping(omega);
    if (reduced_->n_massless_0 > 0) sort_massless();
}

void FlowModel::find_coordinates() {
    lambda_ = reduced_->lambda_0;
    gap_ = reduced_->gap_0;
    preload_ = reduced_->preload_0;
    n_following_ = reduced_->n_massless_0;
    if (reduced_->same_static) return;
    if (!reduced_->model)
        throw Error(PLM_ERR_STATE, "a reduced model with static directions of its own needs its model");
    to_flow_ = static_coordinates_of(*reduced_, reduced_->vectors);
}

void FlowModel::project_loads() {
    if (reduced_->same_static) {
        excitation_ = reduced_->excitation;
        return;
    }
    excitation_ = projected(reduced_->vectors_0, reduced_->model->excitation());
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
        for (std::int64_t j = 0; j < size(); ++j)
            damping_diagonal_.push_back(damping.alpha * m.mass_0(j) + damping.beta * lambda_[j]);
        return;
    }
    if (damping.modal_ratio.empty()) {
        damping_ = gram(m.vectors_0, m.model->damping_times(m.vectors_0));
        for (std::int64_t j = 0; j < size(); ++j)
            damping_(j, j) += damping.alpha * m.mass_0(j) + damping.beta * lambda_[j];
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
    damping_ = product('N', 'T', product('N', 'N', to_flow_, c), to_flow_);
    for (std::int64_t j = 0; j < size(); ++j) damping_(j, j) += largest * m.mass_0(j);
    clear_massless(m.n_massless_0, damping_);
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

// The coordinates without mass in the directions of their own damping, the damped ones first.
void FlowModel::sort_massless() {
    const std::int64_t n = n_following_, first = size() - n;
    Matrix own(n, n); // minus: the largest first
    for (std::int64_t j = 0; j < n; ++j)
        for (std::int64_t i = 0; i < n; ++i)
            own(i, j) = !damping_.empty() ? -damping_(first + i, first + j)
                        : i == j          ? -damping_diagonal_[first + i]
                                          : 0.0;
    const double least = least_damping();
    const SymmetricEigen e = symmetric_eigen(own);
    if (-e.values.back() < -least)
        throw Error(PLM_ERR_ARGUMENT, "the damping matrix has a negative eigenvalue where there is no mass: "
                                      "motion in time has no meaning then; check the damping matrix")
            .argument("C");
    n_relaxing_ = std::count_if(e.values.begin(), e.values.end(), [&](double v) { return -v > least; });
    n_following_ = n - n_relaxing_;
    turn_ = e.vectors;
    turn_rows(turn_, to_flow_);
    gap_ = gap_.transposed();
    turn_rows(turn_, gap_);
    gap_ = gap_.transposed();
    preload_ = from_static_coordinates(preload_);
    for (auto &entry : excitation_) {
        HarmonicLoad &load = entry.second;
        load.real = from_static_coordinates(load.real);
        if (!load.imag.empty()) load.imag = from_static_coordinates(load.imag);
    }
    if (damping_.empty()) {
        for (std::int64_t j = 0; j < n; ++j) damping_diagonal_[first + j] = -e.values[j];
    } else {
        turn_damping();
    }
    if (n_following_ == 0 || n_pairs() == 0) return;
    Matrix rows = gap_.columns(n_moving(), n_following_);
    for (std::int64_t j = 0; j < n_following_; ++j)
        for (std::int64_t i = 0; i < n_pairs(); ++i) rows(i, j) /= std::sqrt(lambda_[n_moving() + j]);
    flexibility_ = product('N', 'T', rows, rows);
}

// Damping that is nothing beside that of the motions of interest. Its time constant would be as short.
double FlowModel::least_damping() const {
    constexpr double negligible = 1e-5;
    const std::int64_t massive = size() - reduced_->n_massless_0;
    const double reach = std::sqrt(lambda_.back()); // sqrt(k m) to compare with, for a mass of 1
    double least = 0, largest = 0;
    for (std::int64_t j = 0; j < size(); ++j) {
        const double c = damping_.empty() ? damping_diagonal_[j] : damping_(j, j);
        largest = std::max(largest, c);
        if (j >= massive || !(lambda_[j] > 0) || lambda_[j] > lambda_.back() || !(c > 0)) continue;
        const double ratio = c / std::sqrt(lambda_[j]);
        least = least > 0 ? std::min(least, ratio) : ratio;
    }
    return std::max(negligible * least * reach, 1e-13 * largest);
}

void FlowModel::turn_damping() {
    turn_rows(turn_, damping_);
    damping_ = damping_.transposed();
    turn_rows(turn_, damping_);
    clear_massless(n_following_, damping_);
    for (std::int64_t j = n_massive(); j < n_moving(); ++j) // rounding
        for (std::int64_t i = n_massive(); i < n_moving(); ++i)
            if (i != j) damping_(i, j) = 0;
}

vector<double> FlowModel::in_static_coordinates(const vector<double> &y) const {
    vector<double> out(y);
    if (turn_.cols() > 0)
        gemv('N', 1.0, turn_, y.data() + size() - turn_.cols(), 0.0, out.data() + size() - turn_.cols());
    return out;
}

vector<double> FlowModel::from_static_coordinates(const vector<double> &y) const {
    vector<double> out(y);
    if (turn_.cols() > 0)
        gemv('T', 1.0, turn_, y.data() + size() - turn_.cols(), 0.0, out.data() + size() - turn_.cols());
    return out;
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
    FlowState state{from_static_coordinates(eta_0), vector<double>(size(), 0.0), 2 * M_PI * fraction / omega};
    if (reduced_->same_static) {
        y = from_static_coordinates(y);
        for (std::int64_t j = 0; j < size(); ++j) state.y[j] += y[j];
        state.v = from_static_coordinates(v);
    } else {
        gemv('N', 1.0, to_flow_, y.data(), 1.0, state.y.data());
        gemv('N', 1.0, to_flow_, v.data(), 0.0, state.v.data());
    }
    return state;
}

vector<double> FlowModel::dof_row(std::int64_t dof) const {
    const Field &vectors = reduced_->static_vectors();
    const std::int64_t n_dof = reduced_->model ? reduced_->model->n_dof() : vectors.rows();
    if (dof < 0 || dof >= n_dof)
        throw Error(PLM_ERR_ARGUMENT, format("DOF %lld is not one of 0 .. %lld", static_cast<long long>(dof),
                                             static_cast<long long>(n_dof - 1)))
            .argument("dof")
            .index(dof);
    const std::int64_t row = reduced_->model ? reduced_->model->free_index(dof) : dof;
    if (row < 0) return vector<double>(size(), 0.0);
    return from_static_coordinates(vectors.row(row));
}

Field FlowModel::field(const vector<double> &y) const {
    return combine(reduced_->static_vectors(), in_static_coordinates(y));
}

} // namespace plm
