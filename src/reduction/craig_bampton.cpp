// Craig & Bampton (1968): the contact DOFs are retained, the interior is represented by constraint modes and
// by fixed-interface modes.
#include "reduction/craig_bampton.hpp"
#include "linalg/lapack.hpp"
#include "reduction/basis_kind.hpp"
#include "reduction/basis_options.hpp"
#include "space/massless.hpp"
#include "structure/eigs.hpp"
#include "structure/solver/make_factor.hpp"
#include <algorithm>
#include <cmath>
#include <utility>

namespace plm {
namespace {

struct Partition {
    vector<std::int64_t> boundary, interior; // free index -> position, -1 if in the other part
    vector<std::int64_t> boundary_dof, interior_dof;
};

Partition partition(const Model &model) {
    const SparseMatrix &b = model.gap_matrix();
    Partition p;
    p.boundary.assign(model.n_free(), -1);
    p.interior.assign(model.n_free(), -1);
    for (std::int64_t j = 0; j < model.n_free(); ++j) {
        const bool retained = model.n_pairs() > 0 && b.ptr[j + 1] > b.ptr[j];
        auto &dofs = retained ? p.boundary_dof : p.interior_dof;
        (retained ? p.boundary : p.interior)[j] = static_cast<std::int64_t>(dofs.size());
        dofs.push_back(j);
    }
    return p;
}

class Interior {
  public:
    Interior(const Model &model, const Partition &p, Watch watch)
        : model_(model), watch_(watch), n_(static_cast<std::int64_t>(p.interior_dof.size())),
          n_boundary_(static_cast<std::int64_t>(p.boundary_dof.size())),
          k_(submatrix(model.stiffness(), p.interior, n_, p.interior, n_)),
          m_(submatrix(model.mass(), p.interior, n_, p.interior, n_)),
          k_boundary_(submatrix(model.stiffness(), p.interior, n_, p.boundary, n_boundary_)) {
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
        const std::int64_t counted = n_fixed > 0 ? n_fixed : count_below(limit);
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
                gemm('N', 'N', -1.0, basis, product('T', 'N', basis, multiply(shifted, column)), 1.0, column);
            if (!(to_unit_energy(shifted, column.data()) > 1e-8)) continue;
            basis.append(column);
        }
        return basis.columns(phi.cols(), basis.cols() - phi.cols());
    }

  private:
    // The root of what its energy was.
    double to_unit_energy(const SparseMatrix &stiffness, double *x) const {
        vector<double> force(n_);
        multiply(stiffness, x, force.data());
        const double size = std::sqrt(std::max(0.0, dot(n_, x, force.data())));
        for (std::int64_t i = 0; i < n_ && size > 0; ++i) x[i] /= size;
        return size;
    }

    // K_ii is singular when a part of the interior is held by nothing but the contact: then K_ii + sigma
    // M_ii.
    void factor_interior() {
        try {
            factor_ = make_factor(k_, FactorKind::positive_definite, model_.host_solver());
            if (model_.shift() == 0 || factor_->reciprocal_condition() > 1e-12) return;
        } catch (const Error &e) {
            if (model_.shift() == 0) throw;
            if (e.status() != PLM_ERR_NOT_POSITIVE_DEFINITE && e.status() != PLM_ERR_SINGULAR) throw;
        }
        shift_ = model_.shift();
        factor_ = make_factor(add(1.0, k_, shift_, m_), FactorKind::positive_definite, model_.host_solver());
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
            Matrix residual = multiply(k_, x);
            for (std::int64_t k = 0; k < residual.rows() * residual.cols(); ++k)
                residual.data()[k] = loads.data()[k] - residual.data()[k];
            factor_->solve(residual);
            for (std::int64_t k = 0; k < x.rows() * x.cols(); ++k) x.data()[k] += residual.data()[k];
        }
        return x;
    }

    // By Sylvester's law of inertia; -1 when the solver cannot tell. `limit` moves a little where it hits a
    // mode.
    std::int64_t count_below(double &limit) const {
        if (!tells_inertia(model_.host_solver())) return -1;
        for (int attempt = 0; attempt < 4; ++attempt) {
            if (attempt > 0) limit *= 1.003;
            watch_.step("count of fixed-interface modes", 0.1); // a factorization, which hears nobody
            try {
                const SparseMatrix shifted = add(1.0, k_, -limit * limit, m_);
                return make_factor(shifted, FactorKind::indefinite, model_.host_solver())
                    ->negative_eigenvalues();
            } catch (const Error &e) {
                if (e.status() != PLM_ERR_SINGULAR) throw;
            }
        }
        watch_.warn(
            PLM_REASON_UNVERIFIED,
            format("the number of fixed-interface modes below %.6g Hz could not be verified: K - w^2 M "
                   "is singular there and just above; compare with another highest frequency",
                   limit / (2 * M_PI)));
        return -1;
    }

    static void require_counted(const EigenPairs &pairs, std::int64_t counted, double limit) {
        constexpr double rounding = 1e-8;
        const auto below = std::count_if(pairs.values.begin(), pairs.values.end(), [&](double value) {
            return value <= (1 + rounding) * limit * limit;
        });
        if (below < counted)
            throw Error(PLM_ERR_EIGENSOLVER, format("%lld fixed-interface modes were found below %.6g Hz "
                                                    "where the Sturm sequence counts %lld",
                                                    static_cast<long long>(below), limit / (2 * M_PI),
                                                    static_cast<long long>(counted)));
    }

    const Model &model_;
    Watch watch_;
    std::int64_t n_, n_boundary_;
    SparseMatrix k_, m_, k_boundary_;
    std::unique_ptr<Factor> factor_;
    double shift_ = 0;
};

// The loads on the interior DOFs as columns: pre-load and excitation.
Matrix interior_loads(const Model &model, const Partition &p) {
    Matrix loads(static_cast<std::int64_t>(p.interior_dof.size()), 0);
    const auto append = [&](const vector<double> &load) {
        if (load.empty()) return;
        Matrix column(loads.rows(), 1);
        for (std::int64_t i = 0; i < loads.rows(); ++i) column(i, 0) = load[p.interior_dof[i]];
        if (norm2(column.rows(), column.data()) > 0) loads.append(column);
    };
    append(model.preload());
    for (const auto &entry : model.excitation()) {
        append(entry.second.real);
        append(entry.second.imag);
    }
    return loads;
}

// T = [I 0; Psi Phi] on the free DOFs.
Matrix transformation(const Model &model, const Partition &p, const CraigBamptonOptions &o, Watch watch) {
    const std::int64_t n_boundary = static_cast<std::int64_t>(p.boundary_dof.size());
    Matrix t(model.n_free(), n_boundary);
    for (std::int64_t j = 0; j < n_boundary; ++j) t(p.boundary_dof[j], j) = 1;
    if (p.interior_dof.empty()) return t;
    const Interior interior(model, p, watch);
    const Matrix psi = interior.constraint_modes();
    for (std::int64_t j = 0; j < n_boundary; ++j)
        for (std::size_t i = 0; i < p.interior_dof.size(); ++i)
            t(p.interior_dof[i], j) = psi(static_cast<std::int64_t>(i), j);
    Matrix phi = interior.fixed_modes(o.n_fixed, o.highest_frequency);
    if (o.load_vectors) phi.append(interior.load_modes(interior_loads(model, p), phi));
    Matrix fixed(model.n_free(), phi.cols());
    for (std::int64_t j = 0; j < phi.cols(); ++j)
        for (std::size_t i = 0; i < p.interior_dof.size(); ++i)
            fixed(p.interior_dof[i], j) = phi(static_cast<std::int64_t>(i), j);
    t.append(fixed);
    return t;
}

constexpr std::int64_t column_block = 64; // between two looks at the host, where both sides are long

void put(const Matrix &columns, std::int64_t first, Matrix &into) {
    std::copy_n(columns.data(), columns.rows() * columns.cols(), into.data() + first * into.rows());
}

// T^T A T.
Matrix projection(const Matrix &t, const SparseMatrix &a, Watch watch) {
    Matrix out(t.cols(), t.cols());
    for (std::int64_t first = 0; first < t.cols(); first += column_block) {
        watch.step("Craig-Bampton", 0.7);
        const Matrix block = t.columns(first, std::min(column_block, t.cols() - first));
        put(product('T', 'N', t, multiply(a, block)), first, out);
    }
    return out;
}

// T Y.
Matrix combined(const Matrix &t, const Matrix &y, Watch watch) {
    Matrix out(t.rows(), y.cols());
    for (std::int64_t first = 0; first < y.cols(); first += column_block) {
        watch.step("Craig-Bampton", 0.9);
        put(product('N', 'N', t, y.columns(first, std::min(column_block, y.cols() - first))), first, out);
    }
    return out;
}

void symmetrise(Matrix &a) {
    for (std::int64_t j = 0; j < a.cols(); ++j)
        for (std::int64_t i = j + 1; i < a.rows(); ++i) a(i, j) = a(j, i) = 0.5 * (a(i, j) + a(j, i));
}

// Coordinates that diagonalise both; contact DOFs without mass keep their flexibility.
RitzVectors diagonalise(const Matrix &k, const Matrix &m, double sigma, double reach) {
    Matrix shifted = k;
    for (std::int64_t i = 0; i < k.rows() * k.cols(); ++i) shifted.data()[i] += sigma * m.data()[i];
    const SymmetricEigen inertia = symmetric_eigen_general(m, shifted);
    return ritz_vectors(inertia.values, inertia.vectors, sigma, reach);
}

// Rigid-body modes lie in the space (but for too few fixed-interface modes of an interior that is free
// itself).
void clear_rigid_values(std::int64_t n_rigid, vector<double> &lambda) {
    const std::int64_t size = static_cast<std::int64_t>(lambda.size());
    const double flexible = n_rigid < size ? lambda[n_rigid] : 1.0;
    for (std::int64_t j = 0; j < size; ++j)
        if (lambda[j] < 0 || (j < n_rigid && lambda[j] < 1e-7 * flexible)) lambda[j] = 0;
}

} // namespace

std::shared_ptr<const Space> make_craig_bampton_space(std::shared_ptr<const Model> model,
                                                      const CraigBamptonOptions &options, Watch watch) {
    const Partition p = partition(*model);
    const Matrix t = transformation(*model, p, options, watch);
    Matrix k = projection(t, model->stiffness(), watch);
    Matrix m = projection(t, model->mass(), watch);
    symmetrise(k);
    symmetrise(m);
    watch.step("Craig-Bampton", 0.8);
    RitzVectors ritz = diagonalise(k, m, model->shift(), options.highest_frequency);

    auto space = std::make_shared<Space>();
    space->model = model;
    space->vectors = combined(t, ritz.vectors, watch);
    space->lambda = std::move(ritz.lambda);
    space->n_massless = ritz.n_massless;
    clear_rigid_values(model->rigid_modes().cols(), space->lambda);
    space->highest_frequency = options.highest_frequency;
    const long long n_boundary = static_cast<long long>(p.boundary_dof.size());
    space->description =
        format("Craig-Bampton: %lld contact DOFs and %lld fixed-interface modes and load vectors", n_boundary,
               static_cast<long long>(t.cols()) - n_boundary);
    project_onto(*space);
    watch.log(1, space->description);
    return space;
}

namespace {

constexpr double fixed_mode_margin = 4; // fixed-interface modes up to this multiple: amplitudes to 1e-3

std::shared_ptr<const Space> craig_bampton_space(const std::shared_ptr<const Model> &model,
                                                 const BasisOptions &o, double highest, Watch watch) {
    return make_craig_bampton_space(model, {o.n_fixed_modes, fixed_mode_margin * highest, o.load_vectors},
                                    watch);
}

constexpr BasisKind craig_bampton_kind() {
    BasisKind kind("craig_bampton", "contact DOFs retained");
    kind.own_options = "n_fixed_modes";
    kind.make_space = craig_bampton_space;
    return kind;
}

} // namespace

constexpr BasisKind basis_kinds::craig_bampton = craig_bampton_kind();

} // namespace plm
