#include "space/set_modes.hpp"
#include "space/spring_compliance.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

// Of a mode's energy, what its residual may hold: the vector is right to the root of it, the value to it.
constexpr double allowed = 1e-12;
constexpr int most_rounds = 12;
constexpr std::int64_t guards = 4; // modes beyond those wanted, which let these converge faster

// A = K + sigma M + B^T S B of the pairs on springs, by the factorization of the open structure and small
// matrices: A^-1 R = X - (A_0^-1 B^T) (S^-1 + B A_0^-1 B^T)^-1 B X with X = A_0^-1 R.
class SprungSolver {
  public:
    SprungSolver(const Model &model, const StaticResponses &responses, const vector<double> &springs)
        : model_(model), springs_(springs) {
        for (std::size_t i = 0; i < springs.size(); ++i)
            if (springs[i] > 0) active_.push_back(static_cast<std::int64_t>(i));
        const auto n = static_cast<std::int64_t>(active_.size());
        Matrix compliance(n, n);
        vector<double> active_springs;
        for (std::int64_t j = 0; j < n; ++j) {
            for (std::int64_t i = 0; i < n; ++i)
                compliance(i, j) = flexibility(responses, active_[i], active_[j]);
            active_springs.push_back(springs[active_[j]]);
        }
        compliance_ = with_springs(std::move(compliance), active_springs);
    }

    void solve(Field &r) const {
        Field x = r;
        model_.solve(x);
        const Matrix u = model_.gap_rows().of(x);
        Matrix some = select_rows(u, active_), all(u.rows(), u.cols());
        compliance_.solve(some.data(), some.cols(), some.rows());
        for (std::int64_t j = 0; j < all.cols(); ++j)
            for (std::size_t i = 0; i < active_.size(); ++i)
                all(active_[i], j) = some(static_cast<std::int64_t>(i), j);
        add(-1.0, model_.gap_rows().forces(all), r);
        model_.solve(r);
    }

    /// (K + B^T S B) X.
    Field stiffness_times(const Field &x) const {
        Matrix f = model_.gap_rows().of(x);
        for (std::int64_t j = 0; j < f.cols(); ++j)
            for (std::int64_t i = 0; i < f.rows(); ++i) f(i, j) *= springs_[i];
        Field y = model_.stiffness_times(x);
        add(1.0, model_.gap_rows().forces(f), y);
        return y;
    }

  private:
    double flexibility(const StaticResponses &r, std::int64_t i, std::int64_t j) const {
        double sum = r.energy(i, j);
        for (std::int64_t k = 0; k < r.modal.rows(); ++k)
            sum += r.modal(k, i) * r.modal(k, j) / (r.modes->values[k] + model_.shift());
        return sum;
    }

    const Model &model_;
    vector<double> springs_;
    vector<std::int64_t> active_;
    DenseCholesky compliance_;
};

// Combinations of the columns that are M-orthonormal; those that the others contain are left out.
void orthonormalise(const Model &model, Field &x) {
    constexpr double independent = 1e-12;
    for (int pass = 0; pass < 2; ++pass) { // the second one takes off what rounding of the first has left
        Matrix g = gram(x, model.mass_times(x));
        vector<double> scale(g.cols());
        for (std::int64_t j = 0; j < g.cols(); ++j) scale[j] = g(j, j) > 0 ? 1 / std::sqrt(g(j, j)) : 0;
        for (std::int64_t j = 0; j < g.cols(); ++j)
            for (std::int64_t i = 0; i < g.rows(); ++i) g(i, j) *= scale[i] * scale[j];
        const SymmetricEigen e = symmetric_eigen(g);
        const std::int64_t n = g.cols(),
                           first = std::lower_bound(e.values.begin(), e.values.end(), independent) -
                                   e.values.begin();
        Matrix t = e.vectors.columns(first, n - first);
        for (std::int64_t j = 0; j < t.cols(); ++j)
            for (std::int64_t i = 0; i < n; ++i) t(i, j) *= scale[i] / std::sqrt(e.values[first + j]);
        x = combine(x, t);
    }
}

// The lowest modes by Rayleigh and Ritz's method in the space of X, and what A^-1 makes of their residuals.
class SetModes {
  public:
    SetModes(const Model &model, const SprungSolver &solver, Field x, std::int64_t n_rigid)
        : model_(model), solver_(solver), x_(std::move(x)), count_(x_.cols()), n_rigid_(n_rigid) {
        look();
    }

    /// Relative to the energy of each mode.
    const vector<double> &residuals() const { return residual_; }
    void go_on() {
        x_.append(step_);
        orthonormalise(model_, x_);
        const SymmetricEigen e = symmetric_eigen(gram(x_, solver_.stiffness_times(x_)));
        x_ = combine(x_, e.vectors.columns(0, std::min(count_, e.vectors.cols())));
        look();
    }
    StructureModes first(std::int64_t n) const {
        return {vector<double>(values_.begin(), values_.begin() + n), x_.columns(0, n), nullptr};
    }

  private:
    void look() {
        const Field stiff = solver_.stiffness_times(x_), momenta = model_.mass_times(x_);
        values_ = column_products(x_, stiff);
        std::fill(values_.begin(), values_.begin() + n_rigid_, 0.0);
        step_ = momenta;
        vector<double> minus;
        for (double value : values_) minus.push_back(-value);
        step_.scale(minus);
        add(1.0, stiff, step_);
        const Field r = step_;
        solver_.solve(step_);
        residual_ = column_products(r, step_);
        for (std::size_t j = 0; j < residual_.size(); ++j)
            residual_[j] = std::abs(residual_[j]) / (values_[j] + model_.shift());
    }

    const Model &model_;
    const SprungSolver &solver_;
    Field x_, step_;
    std::int64_t count_, n_rigid_;
    vector<double> values_, residual_;
};

} // namespace

StructureModes exact_set_modes(const Space &space, const PairStates &states, const SpaceModes &ritz,
                               std::int64_t n, Watch watch) {
    const auto found = static_cast<std::int64_t>(ritz.values.size());
    n = std::min(n, found);
    const auto n_rigid = std::count(ritz.values.begin(), ritz.values.begin() + n, 0.0);
    const Model &model = *space.model;
    const Field x = combine(space.vectors, ritz.vectors.columns(0, std::min(found, n + guards)));
    const SprungSolver solver(model, *space.responses, model.contact().springs(states));
    const StructureModes as_found{vector<double>(ritz.values.begin(), ritz.values.begin() + n),
                                  x.columns(0, n), nullptr};
    SetModes modes(model, solver, x, n_rigid);
    const vector<double> first = modes.residuals();
    vector<double> before(first.size(), INFINITY);
    const auto any_falls = [&] {
        for (std::size_t j = 0; j < as_found.values.size(); ++j)
            if (modes.residuals()[j] > allowed && modes.residuals()[j] < 0.5 * before[j]) return true;
        return false;
    };
    for (int round = 0; round < most_rounds && any_falls(); ++round) {
        watch.step("modes", 0.5);
        before = modes.residuals();
        modes.go_on();
    }
    StructureModes exact = modes.first(n);
    // where there was only rounding to take off the value of the space has more digits
    for (std::size_t j = 0; j < exact.values.size(); ++j)
        if (!(modes.residuals()[j] < 0.1 * first[j])) exact.values[j] = as_found.values[j];
    return exact;
}

} // namespace plm
