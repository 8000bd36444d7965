#include "structure/fixed_interface.hpp"
#include "structure/mode_count.hpp"
#include "structure/solver/make_factor.hpp"
#include <algorithm>
#include <cmath>

namespace plm {

class FixedInterface::Interior {
  public:
    // position: of each free DOF among its part, -1 if in the other
    Interior(const Structure &structure, const vector<std::int64_t> &position, std::int64_t n,
             const vector<std::int64_t> &boundary_position, std::int64_t n_boundary, Watch watch)
        : solver_(structure.matrices().solver), model_shift_(structure.shift()), watch_(watch), n_(n),
          n_boundary_(n_boundary), k_(submatrix(structure.matrices().stiffness, position, n, position, n)),
          m_(submatrix(structure.matrices().mass, position, n, position, n)),
          k_boundary_(submatrix(structure.matrices().stiffness, position, n, boundary_position, n_boundary)) {
        factor_interior();
    }

    /// -K_ii^-1 K_ib in blocks of columns.
    Matrix constraint_modes() const {
        Matrix psi;
        const std::int64_t block = 64;
        for (std::int64_t first = 0; first < n_boundary_; first += block) {
            watch_.step("constraint modes", static_cast<double>(first) / static_cast<double>(n_boundary_));
            psi.append(static_response(columns_of(k_boundary_, first, std::min(block, n_boundary_ - first))));
        }
        return psi;
    }

    /// The n_fixed lowest fixed-interface modes, or all below `highest` (rad/s) when n_fixed = 0.
    Matrix fixed_modes(std::int64_t n_fixed, double highest) const {
        watch_.step("fixed-interface modes", 0.0);
        EigsOptions options;
        options.cancelled = [this] { return watch_.cancelled("fixed-interface modes", 0.5); };
        double limit = highest;
        const std::int64_t counted = n_fixed > 0
                                         ? n_fixed
                                         : count_modes_near(k_, m_, limit, solver_, "fixed-interface modes",
                                                            "highest frequency", watch_);
        std::int64_t wanted = std::min(n_, counted >= 0 ? counted : 20);
        for (;;) {
            if (wanted == 0) return Matrix(n_, 0);
            const EigenPairs pairs = lowest_eigenpairs(k_, m_, *factor_, -shift_, wanted, options);
            const std::int64_t found = static_cast<std::int64_t>(pairs.values.size());
            if (counted > 0 && n_fixed == 0) require_counted(pairs, counted, limit);
            const bool complete = found < wanted || wanted == n_ || pairs.values.back() > highest * highest;
            if (n_fixed > 0) return pairs.vectors;
            if (counted < 0 && !complete) {
                wanted = std::min(n_, 2 * wanted);
                continue;
            }
            std::int64_t below = 0;
            while (below < found && (counted >= 0 || pairs.values[below] <= highest * highest)) ++below;
            return pairs.vectors.columns(0, below);
        }
    }

    /// Static responses of the fixed-interface interior to the loads on it, of unit energy, orthogonal among
    /// themselves and to the fixed-interface modes `phi`, which carry little of the deformation around a
    /// point load, and nothing of it where there is no mass.
    Matrix load_modes(const Matrix &loads, const Matrix &phi) const {
        const SparseMatrix shifted = shift_ > 0 ? add(1.0, k_, shift_, m_) : k_;
        Matrix basis = phi, x = static_response(loads);
        for (std::int64_t j = 0; j < basis.cols(); ++j) to_unit_energy(shifted, basis.col(j));
        for (std::int64_t j = 0; j < x.cols(); ++j) {
            Matrix column = x.columns(j, 1);
            to_unit_energy(shifted, column.data());
            for (int pass = 0; pass < 2; ++pass) // twice is enough
                gemm('N', 'N', -1.0, basis, product('T', 'N', basis, multiply_transposed(shifted, column)),
                     1.0, column);
            if (!(to_unit_energy(shifted, column.data()) > 1e-8)) continue;
            basis.append(column);
        }
        return basis.columns(phi.cols(), basis.cols() - phi.cols());
    }

  private:
    // The root of what its energy was.
    double to_unit_energy(const SparseMatrix &stiffness, double *x) const {
        vector<double> force(n_);
        multiply_transposed(stiffness, x, force.data());
        const double size = std::sqrt(std::max(0.0, dot(n_, x, force.data())));
        for (std::int64_t i = 0; i < n_ && size > 0; ++i) x[i] /= size;
        return size;
    }

    // K_ii is singular when a part of the interior is held by nothing but the contact: then K_ii + sigma
    // M_ii.
    void factor_interior() {
        try {
            factor_ = make_factor(k_, solver_);
            if (model_shift_ == 0 || factor_->reciprocal_condition() > 1e-12) return;
        } catch (const Error &e) {
            if (model_shift_ == 0) throw;
            if (e.status() != status::not_positive_definite && e.status() != status::singular) throw;
        }
        shift_ = model_shift_;
        factor_ = make_factor(add(1.0, k_, shift_, m_), solver_);
    }

    static Matrix columns_of(const SparseMatrix &a, std::int64_t first, std::int64_t count) {
        Matrix x(a.rows, count);
        for (std::int64_t j = 0; j < count; ++j)
            for (std::int64_t p = a.ptr[first + j]; p < a.ptr[first + j + 1]; ++p) x(a.idx[p], j) = -a.val[p];
        return x;
    }

    // K_ii^-1 F for loads that do no work on interior rigid-body motion. With the shifted factor this is an
    // iteration that converges by sigma / (lambda + sigma) per step; what is slow lies in the fixed-interface
    // modes anyway.
    Matrix static_response(const Matrix &loads) const {
        Matrix x = loads;
        factor_->solve(x);
        for (int step = 0; shift_ > 0 && step < 10; ++step) {
            Matrix residual = multiply_transposed(k_, x);
            for (std::int64_t k = 0; k < residual.rows() * residual.cols(); ++k)
                residual.data()[k] = loads.data()[k] - residual.data()[k];
            factor_->solve(residual);
            for (std::int64_t k = 0; k < x.rows() * x.cols(); ++k) x.data()[k] += residual.data()[k];
        }
        return x;
    }

    static void require_counted(const EigenPairs &pairs, std::int64_t counted, double limit) {
        const auto below = std::count_if(pairs.values.begin(), pairs.values.end(), [&](double value) {
            return value <= (1 + count_rounding) * limit * limit;
        });
        if (below < counted)
            throw Error(status::eigensolver, format("%lld fixed-interface modes were found below %.6g Hz "
                                                    "where the Sturm sequence counts %lld",
                                                    static_cast<long long>(below), limit / (2 * M_PI),
                                                    static_cast<long long>(counted)));
    }

    const Solver &solver_;
    double model_shift_; // sigma of the whole structure
    Watch watch_;
    std::int64_t n_, n_boundary_;
    SparseMatrix k_, m_, k_boundary_;
    std::unique_ptr<Factor> factor_;
    double shift_ = 0;
};

FixedInterface::FixedInterface(const Structure &structure, Watch watch)
    : structure_(structure), boundary_dof_(structure.gap_rows().dofs()) {
    const std::int64_t n = structure.n_free();
    vector<std::int64_t> boundary(n, -1), interior(n, -1);
    for (std::int64_t j = 0; j < n_boundary(); ++j) boundary[boundary_dof_[j]] = j;
    for (std::int64_t j = 0; j < n; ++j) {
        if (boundary[j] >= 0) continue;
        interior[j] = static_cast<std::int64_t>(interior_dof_.size());
        interior_dof_.push_back(j);
    }
    if (!interior_dof_.empty())
        interior_ =
            std::make_unique<Interior>(structure, interior, static_cast<std::int64_t>(interior_dof_.size()),
                                       boundary, n_boundary(), watch);
}

FixedInterface::~FixedInterface() = default;

Field FixedInterface::on_all_dofs(const Matrix &interior) const {
    Field all(structure_.n_free(), interior.cols());
    for (std::int64_t j = 0; j < interior.cols(); ++j)
        for (std::size_t i = 0; i < interior_dof_.size(); ++i)
            all.in_core()(interior_dof_[i], j) = interior(static_cast<std::int64_t>(i), j);
    return all;
}

Field FixedInterface::constraint_modes() const {
    Field modes = interior_ && n_boundary() > 0 ? on_all_dofs(interior_->constraint_modes())
                                                : Field(structure_.n_free(), n_boundary());
    for (std::int64_t j = 0; j < n_boundary(); ++j) modes.in_core()(boundary_dof_[j], j) = 1;
    return modes;
}

Field FixedInterface::interior_modes(std::int64_t n_fixed, double highest, bool with_load_responses) const {
    if (!interior_) return Field(structure_.n_free(), 0);
    Matrix phi = interior_->fixed_modes(n_fixed, highest);
    if (with_load_responses) phi.append(interior_->load_modes(interior_loads(), phi));
    return on_all_dofs(phi);
}

Matrix FixedInterface::interior_loads() const {
    const Field loads = load_columns(structure_.preload(), structure_.excitation(), structure_.n_free());
    const Matrix inside = loads.rows_at(interior_dof_);
    Matrix kept(inside.rows(), 0);
    for (std::int64_t j = 0; j < inside.cols(); ++j)
        if (norm2(inside.rows(), inside.col(j)) > 0) kept.append(inside.columns(j, 1));
    return kept;
}

} // namespace plm
