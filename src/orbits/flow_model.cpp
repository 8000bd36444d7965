#include "orbits/flow_model.hpp"
#include "linalg/lapack.hpp"
#include "reduction/widened_model.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

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

FlowModel::FlowModel(std::shared_ptr<const ReducedModel> reduced, double omega) : reduced_(widened(reduced)) {
    if (reduced_ != reduced) to_flow_ = reduced->to_static;
    lambda_ = reduced_->lambda;
    gap_ = reduced_->gap;
    preload_ = reduced_->preload_0;
    n_following_ = reduced_->n_massless;
    excitation_ = reduced_->excitation;
    walls_move_ = contact().moves();
    for (const auto &entry : contact().motion) {
        HarmonicLoad &load = excitation_[entry.first];
        load.real.resize(lambda_.size(), 0.0);
        if (entry.first.harmonic > 0) load.imag.resize(lambda_.size(), 0.0);
    }
    damping_diagonal_ = reduced_->damping_diagonal;
    damping_ = reduced_->damping;
    if (reduced_->structural != 0) add_structural_damping(omega);
    if (reduced_->n_massless > 0) sort_massless();
    gap_by_pair_ = gap_.transposed();
}

void FlowModel::add_structural_damping(double omega) {
    if (!(omega > 0 && std::isfinite(omega)))
        throw Error(status::argument, "structural damping in the time domain needs the response frequency at "
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
        throw Error(status::argument, "the damping matrix has a negative eigenvalue where there is no mass: "
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
    const std::int64_t massive = size() - reduced_->n_massless;
    const double reach = std::sqrt(lambda_.back()); // sqrt(k m) to compare with, for a mass of 1
    double least = 0, largest = 0;
    for (std::int64_t j = 0; j < size(); ++j) {
        const double c = own_damping(j);
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
    if (static_cast<std::int64_t>(eta_0.size()) != size() ||
        eta.rows() != (to_flow_.empty() ? size() : to_flow_.cols()) || eta.cols() % 2 != 0)
        throw Error(status::argument, "the harmonic coordinates do not belong to this reduced model")
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
    if (to_flow_.empty()) {
        y = from_static_coordinates(y);
        for (std::int64_t j = 0; j < size(); ++j) state.y[j] += y[j];
        state.v = from_static_coordinates(v);
    } else {
        gemv('N', 1.0, to_flow_, y.data(), 1.0, state.y.data());
        gemv('N', 1.0, to_flow_, v.data(), 0.0, state.v.data());
    }
    return state;
}

vector<double> FlowModel::constant_load(const vector<double> &springs) const {
    vector<double> load = preload_;
    for (std::int64_t i = 0; i < n_pairs(); ++i)
        for (std::int64_t j = 0; springs[i] > 0 && j < size(); ++j)
            load[j] += gap_(i, j) * springs[i] * initial_gap()[i];
    return load;
}

vector<std::complex<double>> FlowModel::gap_motion(const LoadPart &part) const {
    vector<std::complex<double>> g(static_cast<std::size_t>(n_pairs()), 0.0);
    const auto found = contact().motion.find(part);
    if (found == contact().motion.end()) return g;
    for (std::int64_t i = 0; i < n_pairs(); ++i) g[i] = Contact::moved(found->second, i);
    return g;
}

vector<double> FlowModel::dof_row(std::int64_t dof) const {
    const SpaceVectors &vectors = reduced_->vectors;
    const std::int64_t n_outputs = reduced_->model ? reduced_->model->n_outputs() : vectors.rows();
    if (dof < 0 || dof >= n_outputs)
        throw Error(status::argument, format("DOF %lld is not one of 0 .. %lld", static_cast<long long>(dof),
                                             static_cast<long long>(n_outputs - 1)))
            .argument("dof")
            .index(dof);
    const DofTerms row = reduced_->model ? reduced_->model->terms(dof) : DofTerms{{dof, 1.0}};
    return from_static_coordinates(vectors.row(row));
}

Field FlowModel::field(const vector<double> &y) const {
    return combine(reduced_->vectors, in_static_coordinates(y));
}

} // namespace plm
