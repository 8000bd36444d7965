// The structure's matrices as arrays of this process, and the factorizations of solver/ on them.
#include "linalg/blas_lapack.hpp"
#include "structure/field.hpp"
#include "structure/solver/make_factor.hpp"
#include "structure/still_dofs.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

class CoreFactor final : public TallFactor {
  public:
    explicit CoreFactor(std::unique_ptr<Factor> factor) : own_(std::move(factor)), factor_(*own_) {}
    explicit CoreFactor(const Factor &factor) : factor_(factor) {}
    void solve(Field &x) const override { factor_.solve(x.in_core()); }
    double reciprocal_condition() const override { return factor_.reciprocal_condition(); }
    std::int64_t factor_nonzeros() const override { return factor_.factor_nonzeros(); }
    bool calls_host() const override { return factor_.calls_host(); }
    bool multiply_responses(const SparseMatrix &b, const Field &loads, const TallMatrix &m, Matrix &energy,
                            Matrix &inertia) const override {
        SparseMatrix f = transpose(b);
        for (std::int64_t j = 0; j < loads.cols(); ++j) {
            const double *load = loads.in_core().col(j);
            for (std::int64_t i = 0; i < loads.rows(); ++i) {
                if (load[i] == 0) continue;
                f.idx.push_back(i);
                f.val.push_back(load[i]);
            }
            f.ptr.push_back(f.nnz());
            ++f.cols;
        }
        return factor_.multiply_responses(f, m.entries(), energy, inertia);
    }

  private:
    std::unique_ptr<Factor> own_;
    const Factor &factor_;
};

class CoreProducts final : public PairProducts {
  public:
    CoreProducts(const SparseMatrix &k, const Matrix &x) : k_(k), x_(x), kx_(multiply_transposed(k, x)) {
        SparseMatrix sizes = k;
        for (double &a : sizes.val) a = std::fabs(a);
        Matrix motion = x;
        for (std::int64_t i = 0; i < x.rows() * x.cols(); ++i) motion.data()[i] = std::fabs(x.data()[i]);
        terms_ = multiply_transposed(sizes, motion);
    }
    double energy(std::int64_t j) const override { return dot(x_.rows(), x_.col(j), kx_.col(j)); }
    double precise_energy(std::int64_t j) const override { return plm::energy(k_, x_.col(j)).sum; }
    double terms(std::int64_t j) const override {
        double energy = 0;
        for (std::int64_t i = 0; i < terms_.rows(); ++i) energy += std::fabs(x_(i, j)) * terms_(i, j);
        return energy;
    }
    double residual(std::int64_t j, double lambda, const Field &mx, double rounding) const override {
        const std::int64_t n = x_.rows();
        if (!finite(kx_.col(j), n)) return INFINITY;
        const double *inertia = mx.in_core().col(j);
        vector<double> beyond(n);
        for (std::int64_t i = 0; i < n; ++i)
            beyond[i] = std::max(0.0, std::fabs(kx_(i, j) - lambda * inertia[i]) - rounding * terms_(i, j));
        return norm2(n, beyond.data());
    }

  private:
    const SparseMatrix &k_;
    const Matrix &x_;
    Matrix kx_, terms_;
};

class CoreMatrix final : public TallMatrix {
  public:
    explicit CoreMatrix(const SparseMatrix &a) : a_(a) {}
    explicit CoreMatrix(SparseMatrix &&a) : own_(std::move(a)), a_(own_) {}
    CoreMatrix(const CoreMatrix &) = delete;
    std::int64_t rows() const override { return a_.cols; }
    Field none() const override { return Field(a_.cols, 0); }
    // Symmetric: the form that gathers is the faster one.
    Field times(const Field &x) const override { return Field(multiply_transposed(a_, x.in_core())); }
    void times(const Field &x, Field &y) const override {
        if (x.cols() == 1)
            multiply_transposed(a_, x.in_core().data(), y.in_core().data());
        else
            y = times(x);
    }
    std::unique_ptr<TallMatrix> plus(double factor, const TallMatrix &other) const override {
        return tall_matrix(add(1.0, a_, factor, other.entries()));
    }
    std::unique_ptr<TallMatrix> scaled(double factor) const override {
        SparseMatrix a = a_;
        for (double &v : a.val) v *= factor;
        return tall_matrix(std::move(a));
    }
    // Zeros are among the entries: the order of such a pattern is found once.
    std::unique_ptr<TallMatrix> with_springs(const std::vector<DofTerms> &rows,
                                             const vector<double> &spring) const override {
        vector<std::int64_t> row, column;
        vector<double> value;
        for (std::size_t i = 0; i < rows.size(); ++i)
            for (const DofTerm &a : rows[i])
                for (const DofTerm &b : rows[i]) {
                    row.push_back(a.dof), column.push_back(b.dof);
                    value.push_back(spring[i] * a.coefficient * b.coefficient);
                }
        return tall_matrix(add(1, a_, 1, from_triplets(a_.rows, a_.cols, row, column, value)));
    }
    std::unique_ptr<TallFactor> factor(const Solver &solver) const override {
        return tall_factor(make_factor(a_, solver));
    }
    std::int64_t count_negative(double factor, const TallMatrix &other, const Solver &solver) const override {
        return plm::count_negative({a_, factor, other.entries()}, solver);
    }
    vector<double> diagonal_at(const vector<std::int64_t> &dofs) const override {
        const vector<double> all = diagonal(a_);
        vector<double> some;
        for (std::int64_t dof : dofs) some.push_back(all[dof]);
        return some;
    }
    std::int64_t n_positive() const override {
        std::int64_t count = 0;
        for (std::int64_t j = 0; j < a_.cols; ++j)
            for (std::int64_t p = a_.ptr[j]; p < a_.ptr[j + 1]; ++p) count += a_.idx[p] == j && a_.val[p] > 0;
        return count;
    }
    Energy energy(const Field &x, std::int64_t column) const override {
        return plm::energy(a_, x.in_core().col(column));
    }
    std::unique_ptr<PairProducts> products(const Field &x) const override {
        return std::make_unique<CoreProducts>(a_, x.in_core());
    }
    void require_finite_entries(const char *what) const override {
        require_finite(a_.val.data(), a_.nnz(), what);
    }
    const SparseMatrix &entries() const override { return a_; }

  private:
    SparseMatrix own_;
    const SparseMatrix &a_;
};

class CoreHeld final : public HeldTall {
  public:
    CoreHeld(const SparseMatrix &mass, const SparseMatrix &stiffness, const vector<std::int64_t> &held)
        : n_(mass.cols) {
        vector<std::int64_t> boundary(n_, -1), interior(n_, -1);
        for (std::size_t j = 0; j < held.size(); ++j) boundary[held[j]] = static_cast<std::int64_t>(j);
        for (std::int64_t j = 0; j < n_; ++j) {
            if (boundary[j] >= 0) continue;
            interior[j] = n_interior();
            interior_.push_back(j);
        }
        const std::int64_t n_held = static_cast<std::int64_t>(held.size());
        stiffness_ = tall_matrix(submatrix(stiffness, interior, n_interior(), interior, n_interior()));
        mass_ = tall_matrix(submatrix(mass, interior, n_interior(), interior, n_interior()));
        coupling_ = submatrix(stiffness, interior, n_interior(), boundary, n_held);
    }
    std::int64_t n_interior() const override { return static_cast<std::int64_t>(interior_.size()); }
    const TallMatrix &mass() const override { return *mass_; }
    const TallMatrix &stiffness() const override { return *stiffness_; }
    Field driving_forces(std::int64_t first, std::int64_t count) const override {
        const SparseMatrix &a = coupling_;
        Matrix f(a.rows, count);
        for (std::int64_t j = 0; j < count; ++j)
            for (std::int64_t p = a.ptr[first + j]; p < a.ptr[first + j + 1]; ++p) f(a.idx[p], j) = -a.val[p];
        return Field(std::move(f));
    }
    Field on_all_dofs(const Field &interior) const override {
        Matrix all(n_, interior.cols());
        for (std::int64_t j = 0; j < interior.cols(); ++j)
            for (std::int64_t i = 0; i < n_interior(); ++i) all(interior_[i], j) = interior.in_core()(i, j);
        return Field(std::move(all));
    }
    Field inside(const Field &all) const override { return Field(all.rows_at(interior_)); }

  private:
    std::int64_t n_;
    vector<std::int64_t> interior_; // free indices
    std::unique_ptr<TallMatrix> stiffness_, mass_;
    SparseMatrix coupling_; // interior x held
};

class CoreTall final : public Tall {
  public:
    CoreTall(const SparseMatrix &mass, const SparseMatrix &stiffness, const SparseMatrix &damping)
        : m_(mass), k_(stiffness), mass_(mass), stiffness_(stiffness), damping_(damping) {}
    const TallMatrix &mass() const override { return mass_; }
    const TallMatrix &stiffness() const override { return stiffness_; }
    const TallMatrix *damping() const override { return damping_.entries().cols > 0 ? &damping_ : nullptr; }
    TallFacts facts() const override { return facts_of(k_, m_); }
    std::unique_ptr<HeldTall> held(const vector<std::int64_t> &dofs) const override {
        return std::make_unique<CoreHeld>(m_, k_, dofs);
    }

  private:
    const SparseMatrix &m_, &k_;
    CoreMatrix mass_, stiffness_, damping_;
};

// Median of K_ii / M_ii.
double typical_eigenvalue(const vector<double> &dk, const vector<double> &dm, double otherwise) {
    vector<double> ratio;
    for (std::size_t i = 0; i < dk.size(); ++i)
        if (dk[i] > 0 && dm[i] > 0) ratio.push_back(dk[i] / dm[i]);
    if (ratio.empty()) return otherwise;
    const auto middle = ratio.begin() + static_cast<std::ptrdiff_t>(ratio.size() / 2);
    std::nth_element(ratio.begin(), middle, ratio.end());
    return *middle;
}

} // namespace

TallFacts facts_of(const SparseMatrix &k, const SparseMatrix &m) {
    const vector<double> dk = diagonal(k), dm = diagonal(m);
    vector<char> coupled(k.cols, 0);
    mark_coupled(k, coupled);
    TallFacts f;
    f.n_dof = k.cols;
    f.trace_of_mass = trace(m), f.trace_of_stiffness = trace(k);
    f.least_stiffness = INFINITY;
    f.typical_eigenvalue = typical_eigenvalue(dk, dm, f.trace_of_stiffness / f.trace_of_mass);
    for (std::int64_t i = 0; i < k.cols; ++i) {
        f.n_massive += dm[i] > 0;
        if (!(dk[i] >= f.least_stiffness)) f.least_stiffness = dk[i];
        if (dk[i] > 0 || dm[i] > 0) continue;
        if (!coupled[i] && f.loose < 0) f.loose = i;
        if (coupled[i] && f.n_multipliers++ == 0) f.multiplier = i;
    }
    return f;
}

std::unique_ptr<TallMatrix> tall_matrix(const SparseMatrix &a) {
    return std::make_unique<CoreMatrix>(a);
}

std::unique_ptr<TallMatrix> tall_matrix(SparseMatrix &&a) {
    return std::make_unique<CoreMatrix>(std::move(a));
}

std::unique_ptr<TallFactor> tall_factor(std::unique_ptr<Factor> factor) {
    return std::make_unique<CoreFactor>(std::move(factor));
}

std::unique_ptr<TallFactor> tall_factor(const Factor &factor) {
    return std::make_unique<CoreFactor>(factor);
}

std::unique_ptr<Tall> tall_in_core(const SparseMatrix &mass, const SparseMatrix &stiffness,
                                   const SparseMatrix &damping) {
    return std::make_unique<CoreTall>(mass, stiffness, damping);
}

} // namespace plm
