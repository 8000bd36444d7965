#include "mpi/mumps_factor.hpp"
#include <algorithm>
#include <cmath>
#include <sys/mman.h>

namespace plm::mpi {
namespace {

MUMPS_INT base_one(std::int64_t dof) {
    return static_cast<MUMPS_INT>(dof + 1);
}

/// MUMPS's own words are numbers. info: of this rank; -1 there means that another one failed.
void require_success(const DMUMPS_STRUC_C &mumps, const char *what) {
    const MUMPS_INT mine = mumps.info[0], all = mumps.infog[0];
    if (all >= 0 || mine == -1) return;
    const MUMPS_INT code = mine < 0 ? mine : all;
    const bool memory =
        code == -13 || code == -19 || code == -9 || code == -8 || code == -7 || code == -5 || code == -11;
    const char *advice = memory ? "out of memory; use more ranks, or nodes with more of it"
                                : "see INFOG(1) in the manual of MUMPS";
    throw Error(memory ? status::memory : status::internal,
                format("MUMPS failed in the %s with INFO(1) = %d, INFO(2) = %d: %s", what, code,
                       mumps.info[1], advice))
        .library_code(code);
}

/// MUMPS gives large numbers in negative millions.
std::size_t counted(MUMPS_INT n) {
    return n < 0 ? static_cast<std::size_t>(-static_cast<std::int64_t>(n)) * 1000000
                 : static_cast<std::size_t>(n);
}

} // namespace

void Workspace::resize(std::size_t bytes) {
    if (data_) munmap(data_, bytes_);
    data_ = nullptr, bytes_ = 0;
    if (bytes == 0) return;
    void *got = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (got == MAP_FAILED) throw std::bad_alloc();
    data_ = got, bytes_ = bytes;
}

void Workspace::keep_first(std::size_t bytes) {
    constexpr std::size_t page = std::size_t(1) << 16; // a multiple of any machine's
    const std::size_t kept = (bytes + page - 1) / page * page;
    if (kept < bytes_) madvise(static_cast<char *>(data_) + kept, bytes_ - kept, MADV_DONTNEED);
}

void MumpsFactor::make(Team &team, const Rows &rows, const Matrices &matrices, const FactorTask &task,
                       KeptOrder &kept) {
    if (kept.added != task.n_added) {
        kept.added = -1;
        kept.order = order_of_nodes(team, rows, matrices, {task.row, task.column, task.n_added});
    }
    team.together([&] { take_entries(team, rows, matrices, task); });
    set_up(team);
    mumps_.n = static_cast<MUMPS_INT>(rows.n_dof());
    try { // what fails, fails on all ranks alike: that is what makes a collective release possible here
        analyse(team, task, kept);
        factorize(team, task);
        judge(task);
        if (!task.count_only && outcome_ == Outcome::factored) make_room(team, rows);
    } catch (...) {
        release();
        throw;
    }
    if (task.count_only || outcome_ != Outcome::factored) release();
}

void MumpsFactor::release() {
    if (!alive_) return;
    alive_ = false;
    mumps_.job = -2;
    dmumps_c(&mumps_);
    workspace_.resize(0);
}

/// The lower triangle of this rank's rows. DOFs that are held keep a diagonal entry alone, of a usual size.
void MumpsFactor::take_entries(Team &team, const Rows &rows, const Matrices &matrices,
                               const FactorTask &task) {
    held_.assign(static_cast<std::size_t>(rows.count()), 0);
    for (std::int64_t i = 0; i < rows.count(); ++i) held_[static_cast<std::size_t>(i)] = matrices.fixed(i);
    std::vector<std::int64_t> held(task.held, task.held + task.n_held);
    std::sort(held.begin(), held.end());
    for (std::int64_t dof : held)
        if (rows.local(dof) >= 0) held_[static_cast<std::size_t>(rows.local(dof))] = 1;
    const auto is_free = [&](std::int64_t dof) { return !std::binary_search(held.begin(), held.end(), dof); };
    const auto add = [&](std::int64_t row, std::int64_t column, double value) {
        if (!std::isfinite(value))
            throw Error(status::matrix,
                        format("entry (%lld, %lld) (base 0) of the matrix to factor is not finite",
                               static_cast<long long>(row), static_cast<long long>(column)))
                .index(row);
        row_.push_back(base_one(row)), column_.push_back(base_one(column)), value_.push_back(value);
    };
    const auto expected = static_cast<std::size_t>(matrices.entries_here() * 6 / 10 + rows.count());
    row_.reserve(expected), column_.reserve(expected), value_.reserve(expected);
    matrices.lower_entries(rows, task.weights, [&](std::int64_t row, std::int64_t column, double value) {
        if (is_free(row) && is_free(column)) add(row, column, value);
    });
    const double usual = matrices.largest(task.weights) > 0 ? matrices.largest(task.weights) : 1;
    for (std::int64_t i = 0; i < rows.count(); ++i) {
        own_dof_.push_back(base_one(rows.owned()[static_cast<std::size_t>(i)]));
        if (is_held(i))
            add(rows.owned()[static_cast<std::size_t>(i)], rows.owned()[static_cast<std::size_t>(i)], usual);
    }
    if (own_dof_.empty()) own_dof_.push_back(0); // MUMPS wants an array, even of a rank without DOFs
    if (team.is_brain())                         // MUMPS sums what the ranks give for one place
        for (std::int64_t k = 0; k < task.n_added; ++k)
            if (is_free(task.row[k]) && is_free(task.column[k]))
                add(task.row[k], task.column[k], task.value[k]);
}

void MumpsFactor::set_up(Team &team) {
    mumps_.par = 1;
    mumps_.sym = 2;
    mumps_.comm_fortran = static_cast<MUMPS_INT>(MPI_Comm_c2f(team.comm()));
    mumps_.job = -1;
    dmumps_c(&mumps_);
    team.together([&] { require_success(mumps_, "start"); });
    alive_ = true;
    control(1) = control(2) = control(3) = -1; // it prints nothing
    control(4) = 0;
    control(18) = 3; // entries are spread over the ranks
    control(13) = 1,
    control(24) = 1; // a root left to ScaLAPACK hides its negative pivots, and vanishing ones
    control(21) = 1; // so are solutions
    control(27) = Exchange::width;
}

void MumpsFactor::run(Team &team, const char *what, MUMPS_INT job) {
    mumps_.job = job;
    dmumps_c(&mumps_);
    team.together([&] { require_success(mumps_, what); });
}

/// An order that is given, and the nodes: the graph on which MUMPS works on the brain has these for vertices.
void MumpsFactor::take_order(NodeOrder &order) {
    if (order.position.empty()) return;
    control(7) = 1, mumps_.perm_in = order.position.data();
    if (order.first.empty()) return;
    control(15) = 1;
    mumps_.nblk = static_cast<MUMPS_INT>(order.first.size()) - 1;
    mumps_.blkptr = order.first.data(), mumps_.blkvar = order.dofs.data();
}

void MumpsFactor::analyse(Team &team, const FactorTask &task, KeptOrder &kept) {
    mumps_.nnz_loc = static_cast<MUMPS_INT8>(value_.size());
    mumps_.irn_loc = row_.data(), mumps_.jcn_loc = column_.data(), mumps_.a_loc = value_.data();
    take_order(kept.order);
    // A definite matrix is factored without pivoting, so that a pivot that is not positive says that it is
    // none.
    if (!task.count_only) mumps_.cntl[0] = 0;
    if (task.count_only) control(31) = 1; // nothing of the factor is kept
    run(team, "analysis", 1);
    team.together([&] { // where MUMPS had to find an order it need not do so again
        if (team.is_brain() && kept.order.position.empty())
            kept.order.position.assign(mumps_.sym_perm, mumps_.sym_perm + mumps_.n);
    });
    kept.added = task.n_added;
}

/// MUMPS works in our memory and leaves the factor at its beginning. Behind it were fronts, a quarter of the
/// whole on one rank and almost half of it on four, which MUMPS itself would keep as long as the factor.
void MumpsFactor::lend_room(Team &team) {
    team.together([&] { workspace_.resize(counted(mumps_.info[7]) * sizeof(double)); });
    mumps_.wk_user = static_cast<double *>(workspace_.data());
    mumps_.lwk_user = mumps_.info[7];
}

/// Pivoting may need more room than the analysis foresaw: then again with more, in memory of MUMPS's own.
void MumpsFactor::factorize(Team &team, const FactorTask &task) {
    if (!task.count_only) lend_room(team);
    for (int attempt = 0; attempt < 3; ++attempt) {
        mumps_.job = 2;
        dmumps_c(&mumps_);
        const MUMPS_INT code = mumps_.infog[0];
        if (code != -9 && code != -8 && code != -11) break;
        mumps_.wk_user = nullptr, mumps_.lwk_user = 0;
        workspace_.resize(0);
        control(14) *= 2;
    }
    if (mumps_.infog[0] >= 0 && workspace_.data())
        workspace_.keep_first(counted(mumps_.info[8]) * sizeof(double));
    if (mumps_.infog[0] == -10 ||
        mumps_.infog[0] == -6) { // the same on all ranks: singular, which is an answer
        outcome_ = Outcome::singular;
        return;
    }
    team.together([&] { require_success(mumps_, "factorization"); });
}

void MumpsFactor::judge(const FactorTask &task) {
    if (outcome_ == Outcome::singular) return;
    if (mumps_.infog[27] > 0) {
        outcome_ = Outcome::singular;
        if (mumps_.pivnul_list) breakdown_ = mumps_.pivnul_list[0] - 1;
    } else if (!task.count_only && mumps_.infog[11] > 0) {
        outcome_ = Outcome::not_positive_definite;
    }
}

double MumpsFactor::entries() const {
    const double n = mumps_.infog[28];
    return n < 0 ? -1e6 * n : n;
}

/// All that solving needs, so that it cannot fail for want of memory but in MUMPS.
void MumpsFactor::make_room(Team &team, const Rows &rows) {
    team.together([&] {
        const auto here = static_cast<std::size_t>(std::max<std::int64_t>(1, rows.count()));
        const auto there = static_cast<std::size_t>(std::max<MUMPS_INT>(1, mumps_.info[22]));
        right_.assign(here * Exchange::width, 0);
        solution_.assign(there * Exchange::width, 0);
        solution_dof_.assign(there, 0);
        direction_.assign(here, 0);
        row_ = {}, column_ = {}, value_ = {}; // MUMPS has them
    });
    mumps_.irn_loc = mumps_.jcn_loc = nullptr, mumps_.a_loc = nullptr, mumps_.nnz_loc = 0;
    mumps_.nloc_rhs = static_cast<MUMPS_INT>(rows.count());
    mumps_.lrhs_loc = std::max<MUMPS_INT>(1, mumps_.nloc_rhs);
    mumps_.irhs_loc = own_dof_.data(), mumps_.rhs_loc = right_.data();
    mumps_.lsol_loc = static_cast<MUMPS_INT>(solution_dof_.size());
    mumps_.isol_loc = solution_dof_.data(), mumps_.sol_loc = solution_.data();
}

void MumpsFactor::solve(Team &team, const Rows &rows, double *x, std::int64_t cols, std::int64_t ld) {
    control(20) = 10; // right-hand sides are spread over the ranks, by rows
    for (std::int64_t first = 0; first < cols; first += Exchange::width) {
        const std::int64_t n = std::min(Exchange::width, cols - first);
        for (std::int64_t j = 0; j < n; ++j)
            for (std::int64_t i = 0; i < rows.count(); ++i)
                right_[static_cast<std::size_t>(i + j * mumps_.lrhs_loc)] =
                    is_held(i) ? 0 : x[i + (first + j) * ld];
        mumps_.nrhs = static_cast<MUMPS_INT>(n);
        run(team, "solution", 3);
        hand_over(team, rows, n, x + first * ld, ld);
    }
}

void MumpsFactor::solve_sparse(Team &team, const Rows &rows, std::vector<MUMPS_INT> &start,
                               std::vector<MUMPS_INT> &row, std::vector<double> &value, std::int64_t cols,
                               double *x, std::int64_t ld) {
    control(20) = 3;
    mumps_.nrhs = static_cast<MUMPS_INT>(cols);
    if (team.is_brain()) { // MUMPS refuses them elsewhere
        mumps_.nz_rhs = static_cast<MUMPS_INT>(row.size());
        mumps_.irhs_ptr = start.data(), mumps_.irhs_sparse = row.data(), mumps_.rhs_sparse = value.data();
    }
    run(team, "solution", 3);
    hand_over(team, rows, cols, x, ld);
}

/// The solution comes in MUMPS's own order, the same for every solution.
void MumpsFactor::hand_over(Team &team, const Rows &rows, std::int64_t cols, double *x, std::int64_t ld) {
    if (!plan_is_made_) {
        std::vector<std::int64_t> dofs;
        team.together([&] {
            for (MUMPS_INT k = 0; k < mumps_.info[22]; ++k)
                dofs.push_back(solution_dof_[static_cast<std::size_t>(k)] - 1);
        });
        to_owners_ = Exchange::push(team, rows, dofs);
        plan_is_made_ = true;
    }
    to_owners_.run(team, cols, solution_.data(), mumps_.lsol_loc, x, ld);
    for (std::int64_t j = 0; j < cols; ++j)
        for (std::int64_t i = 0; i < rows.count(); ++i)
            if (is_held(i)) x[i + j * ld] = 0;
}

double MumpsFactor::reciprocal_condition(Team &team, const Rows &rows, const Matrices &matrices,
                                         const Weights &w) {
    double *v = direction_.data();
    const auto norm2 = [&] {
        double sum = 0;
        for (std::int64_t i = 0; i < rows.count(); ++i) sum += v[i] * v[i];
        return team.sum(sum);
    };
    for (std::int64_t i = 0; i < rows.count(); ++i) // any direction that no mode is likely to miss
        v[i] = is_held(i)
                   ? 0
                   : 1 + 0.5 * std::sin(12.9898 *
                                        static_cast<double>(rows.owned()[static_cast<std::size_t>(i)]));
    double growth = 0;
    for (int iteration = 0; iteration < 3; ++iteration) {
        const double before = norm2();
        if (!(before > 0) || !std::isfinite(before)) return before > 0 ? 0 : 1;
        for (std::int64_t i = 0; i < rows.count(); ++i) v[i] /= std::sqrt(before);
        solve(team, rows, v, 1, rows.count());
        growth = std::sqrt(norm2()); // that of A^-1
    }
    if (!std::isfinite(growth)) return 0;
    double most = 0;
    for (std::int64_t i = 0; i < rows.count(); ++i)
        most = std::max(most, v[i] * v[i] / growth * matrices.diagonal(i, w));
    most = team.largest(most);
    return most > 1 ? 1 / most : 1;
}

} // namespace plm::mpi
