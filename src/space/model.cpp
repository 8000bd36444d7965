#include "space/model.hpp"
#include "linalg/scale.hpp"
#include "structure/eigs.hpp"
#include "structure/matrix_input.hpp"
#include "structure/rigid_modes.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

using Int = long long; // for printf

bool all_zero(const vector<double> &x) {
    return std::all_of(x.begin(), x.end(), [](double v) { return v == 0; });
}

void require_size(const char *what, std::int64_t size, std::int64_t n_dof) {
    if (size != n_dof)
        throw Error(PLM_ERR_ARGUMENT,
                    format("%s has %lld entries where the model has %lld DOFs", what, Int(size), Int(n_dof)))
            .argument(what);
}

/// The full symmetric matrix in `input`, over all DOFs.
SparseMatrix over_all_dofs(const char *name, const MatrixInput &input, std::int64_t n_dof) {
    require_size(name, input.layout.n, n_dof);
    return input.to_sparse();
}

void require_nonnegative_diagonal(const char *name, const SparseMatrix &a,
                                  const vector<std::int64_t> &free_dof) {
    for (std::int64_t j = 0; j < a.cols; ++j)
        for (std::int64_t p = a.ptr[j]; p < a.ptr[j + 1]; ++p)
            if (a.idx[p] == j && a.val[p] < 0)
                throw Error(PLM_ERR_MATRIX,
                            format("the %s matrix has the negative diagonal entry %g at DOF %lld "
                                   "(counted from 0); it must be positive semi-definite",
                                   name, a.val[p], Int(free_dof[j])))
                    .argument("value")
                    .index(free_dof[j]);
}

// What the parts of a model are made of: the largest entry of each counts.
void require_scale(const char *what, const double *values, std::int64_t n, plm_status status,
                   const char *argument) {
    const double largest = largest_of(values, n);
    if (!too_large(largest) && !too_small(largest)) return;
    throw Error(status, format("the largest entry of the %s is %g; squares and products overflow or vanish "
                               "outside %g to %g: check its units",
                               what, largest, smallest_scale, largest_scale))
        .argument(argument);
}
void require_scale(const char *what, const SparseMatrix &a) {
    require_scale(what, a.val.data(), a.nnz(), PLM_ERR_MATRIX, "value");
}
void require_scale(const char *what, const vector<double> &load) {
    require_scale(what, load.data(), static_cast<std::int64_t>(load.size()), PLM_ERR_ARGUMENT, "force");
}

// By blocks of columns: the host is heard between them.
void solve_in_blocks(const Factor &factor, Matrix &columns, Watch watch) {
    constexpr std::int64_t block = 64;
    const std::int64_t n = columns.cols();
    for (std::int64_t first = 0; first < n; first += block) {
        watch.step("contact flexibility", 0.8 + 0.2 * static_cast<double>(first) / static_cast<double>(n));
        Matrix some = columns.columns(first, std::min(block, n - first));
        factor.solve(some);
        std::copy_n(some.data(), some.rows() * some.cols(), columns.col(first));
    }
}

} // namespace

Model::Model(const ModelInput &input, const SpaceOptions &options, const HostSolver *host, Watch watch)
    : n_dof_(input.n_dof), space_options_(options) {
    if (host) {
        host_copy_ = *host;
        host_ = &host_copy_;
    }
    assemble(input);
    factor_stiffness(watch);
    attachment_ = to_dense(transpose(gap_matrix_));
    solve_in_blocks(*factor_, attachment_, watch);
    resolve_contact_stiffness();
}

Model::~Model() = default;

void Model::expand(const double *free, double *all) const {
    for (std::int64_t i = 0; i < n_dof_; ++i) all[i] = free_of_[i] < 0 ? 0.0 : free[free_of_[i]];
}

void Model::restrict_to_free(const double *all, double *free) const {
    for (std::int64_t k = 0; k < n_free(); ++k) free[k] = all[free_dof_[k]];
}

void Model::assemble(const ModelInput &input) {
    if (!input.mass || !input.stiffness)
        throw Error(PLM_ERR_STATE, input.mass
                                       ? "the stiffness matrix is missing; hand it over with PLM_STIFFNESS"
                                       : "the mass matrix is missing; hand it over with PLM_MASS");
    constexpr std::int64_t fixed = -1;
    free_of_.assign(n_dof_, 0);
    for (std::int64_t dof : input.fixed) free_of_[dof] = fixed;
    for (std::int64_t i = 0; i < n_dof_; ++i)
        if (free_of_[i] != fixed) {
            free_of_[i] = n_free();
            free_dof_.push_back(i);
        }
    if (free_dof_.empty())
        throw Error(PLM_ERR_ARGUMENT, "all DOFs are fixed; nothing is left to move").argument("dof");

    assemble_matrices(input);
    require_nonnegative_diagonal("mass", mass_, free_dof_);
    require_nonnegative_diagonal("stiffness", stiffness_, free_dof_);
    require_scale("mass matrix", mass_);
    require_scale("stiffness matrix", stiffness_);
    if (!(trace(mass_) > 0))
        throw Error(PLM_ERR_MATRIX, "no free DOF has mass; check the mass matrix and the fixed DOFs")
            .argument("value");
    require_scale("damping matrix", damping_matrix_);
    assemble_gap(input);
    assemble_loads(input);
}

void Model::assemble_matrices(const ModelInput &input) {
    // one at a time: over all DOFs they are large
    SparseMatrix all = over_all_dofs("stiffness", *input.stiffness, n_dof_);
    translations_ = find_translations(all);
    stiffness_ = submatrix(all, free_of_, n_free(), free_of_, n_free());
    all = over_all_dofs("mass", *input.mass, n_dof_);
    weigh(translations_, all);
    mass_ = submatrix(all, free_of_, n_free(), free_of_, n_free());
    damping_ = input.damping;
    damping_.has_matrix = input.damping_matrix != nullptr;
    if (!damping_.has_matrix) return;
    all = over_all_dofs("damping", *input.damping_matrix, n_dof_);
    damping_matrix_ = submatrix(all, free_of_, n_free(), free_of_, n_free());
}

void Model::assemble_gap(const ModelInput &input) {
    const std::int64_t z = input.contact.n_pairs();
    vector<std::int64_t> all_pairs(z);
    for (std::int64_t i = 0; i < z; ++i) all_pairs[i] = i;
    gap_matrix_ = submatrix(from_triplets(z, n_dof_, input.gap_pair, input.gap_dof, input.gap_coefficient),
                            all_pairs, z, free_of_, n_free());
    contact_ = input.contact;
    vector<double> weight(z, 0.0);
    for (std::int64_t p = 0; p < gap_matrix_.nnz(); ++p)
        weight[gap_matrix_.idx[p]] += std::abs(gap_matrix_.val[p]);
    for (std::int64_t i = 0; i < z; ++i)
        if (!(weight[i] > 0))
            throw Error(PLM_ERR_ARGUMENT,
                        format("contact pair %lld (counted from 0, in the order they were added) "
                               "touches fixed DOFs only: its penetration can never change; leave it "
                               "out or release a DOF",
                               Int(i)))
                .argument("pair")
                .index(i);
}

void Model::assemble_loads(const ModelInput &input) {
    const auto restricted = [&](const char *what, const vector<double> &all) {
        vector<double> free(n_free(), 0.0);
        if (all.empty()) return free;
        require_size(what, static_cast<std::int64_t>(all.size()), n_dof_);
        restrict_to_free(all.data(), free.data());
        return free;
    };
    preload_ = restricted("preload", input.preload);
    require_scale("pre-load", preload_);
    if (all_zero(preload_)) preload_.clear(); // no pre-load: nobody downstream pays for it
    for (const auto &[harmonic, load] : input.excitation) {
        HarmonicLoad &mine = excitation_[harmonic];
        mine.real = restricted("excitation", load.real);
        if (harmonic > 0) mine.imag = restricted("excitation", load.imag);
        require_scale("excitation", mine.real);
        require_scale("excitation", mine.imag);
        if (harmonic == 0) continue;
        for (std::int64_t dof : input.fixed)
            for (const vector<double> *part : {&load.real, &load.imag})
                if (!part->empty())
                    excitation_on_supports_ = std::hypot(excitation_on_supports_, (*part)[dof]);
    }
}

void Model::factor_stiffness(Watch watch) {
    watch.step("factorization", 0.1);
    FactoredStiffness result = factor_with_rigid_modes(
        stiffness_, mass_, largest_stiffness(contact_.stiffness), free_dof_, host_, watch);
    factor_ = std::move(result.factor);
    shift_ = result.shift;
    rigid_modes_ = std::move(result.rigid_modes);
    uncertainty_ = result.uncertainty;
}

void Model::resolve_contact_stiffness() {
    const std::int64_t z = n_pairs();
    if (z == 0) return;
    const SparseMatrix rows = transpose(gap_matrix_); // column i: gap row i
    const Matrix rigid_gap = rigid_modes_.cols() > 0 ? multiply(gap_matrix_, rigid_modes_) : Matrix(z, 0);
    vector<double> flexibility;
    for (std::int64_t i = 0; i < z; ++i) {
        double whole = 0, rigid = 0;
        for (std::int64_t p = rows.ptr[i]; p < rows.ptr[i + 1]; ++p)
            whole += rows.val[p] * attachment_(rows.idx[p], i);
        for (std::int64_t j = 0; j < rigid_gap.cols(); ++j)
            rigid += rigid_gap(i, j) * rigid_gap(i, j) / shift_;
        // below 1e-13 the difference is rounding: this pair sees rigid motion only
        if (whole - rigid > 1e-13 * whole) flexibility.push_back(whole - rigid);
    }
    if (!flexibility.empty()) {
        const std::size_t n = flexibility.size();
        std::sort(flexibility.begin(), flexibility.end());
        local_stiffness_ = 2 / (flexibility[(n - 1) / 2] + flexibility[n / 2]);
    }
    for (std::int64_t i = 0; i < z; ++i) {
        if (contact_.stiffness[i] != PLM_AUTO_STIFFNESS) continue;
        if (!(local_stiffness_ > 0))
            throw Error(PLM_ERR_ARGUMENT,
                        format("PLM_AUTO_STIFFNESS of pair %lld: the bodies are rigid at the "
                               "contact, so there is no local stiffness to go by; give k_n",
                               Int(i)))
                .argument("stiffness")
                .index(i);
        contact_.stiffness[i] = 10 * local_stiffness_;
    }
}

} // namespace plm
