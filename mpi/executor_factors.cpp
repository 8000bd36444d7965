// Factorizations and what is solved with them.
#include "linalg/blas_lapack.hpp"
#include "mpi/executor.hpp"
#include <algorithm>
#include <numeric>

namespace plm::mpi {

void Executor::make_factor(const Call &call) {
    const std::int64_t *v = call.number;
    FactorTask task;
    task.weights = {call.factor[0], call.factor[1], call.factor[2]};
    task.count_only = v[1] != 0;
    task.n_held = v[2], task.held = v + 4;
    task.n_added = v[3], task.row = v + 4 + v[2], task.column = task.row + v[3], task.value = call.in;
    std::unique_ptr<MumpsFactor> *made = nullptr;
    double condition = 1;
    bool lasts = false;
    try { // fails on all ranks alike
        team_.together([&] { (made = &factors_[v[0]])->reset(new MumpsFactor); });
        (*made)->make(team_, rows_, matrices_, task, order_);
        lasts = !task.count_only && (*made)->outcome() == MumpsFactor::Outcome::factored;
        if (lasts) condition = (*made)->reciprocal_condition(team_, rows_, matrices_, task.weights);
    } catch (...) {
        if (made && *made) (*made)->release();
        factors_.erase(v[0]);
        throw;
    }
    if (team_.is_brain()) {
        call.out[0] = static_cast<double>((*made)->negative());
        call.out[1] = condition;
        call.out[2] = (*made)->entries();
        call.out[3] = static_cast<double>((*made)->outcome());
        call.out[4] = static_cast<double>((*made)->breakdown());
    }
    if (!lasts) factors_.erase(v[0]);
}

void Executor::solve(const Call &call) {
    const std::int64_t *v = call.number;
    MumpsFactor *f = nullptr;
    double *x = nullptr;
    team_.together([&] { f = &factor(v[0]), x = columns(v[1], v[2], v[3]); });
    f->solve(team_, rows_, x, v[3], n());
}

namespace {

/// Columns F of RESPONSES: sparse ones, sorted by column, then those of a block.
struct Forces {
    std::int64_t sparse, all; // how many
    std::vector<std::int64_t> start;
    std::vector<MUMPS_INT> row; // base 1, each once in a column
    std::vector<double> value;

    Forces(std::int64_t n_sparse, std::int64_t n_all, std::int64_t n, const std::int64_t *dof,
           const std::int64_t *column, const double *v)
        : sparse(n_sparse), all(n_all), start(static_cast<std::size_t>(n_sparse) + 1, 0) {
        std::vector<std::int64_t> order(static_cast<std::size_t>(n));
        std::iota(order.begin(), order.end(), 0);
        std::stable_sort(order.begin(), order.end(), [&](std::int64_t a, std::int64_t b) {
            return column[a] != column[b] ? column[a] < column[b] : dof[a] < dof[b];
        });
        for (std::size_t p = 0; p < order.size(); ++p) {
            const std::int64_t k = order[p];
            if (p > 0 && column[order[p - 1]] == column[k] && dof[order[p - 1]] == dof[k])
                value.back() += v[k];
            else
                row.push_back(static_cast<MUMPS_INT>(dof[k] + 1)), value.push_back(v[k]);
            start[static_cast<std::size_t>(column[k]) + 1] = static_cast<std::int64_t>(row.size());
        }
        for (std::size_t c = 1; c < start.size(); ++c) start[c] = std::max(start[c], start[c - 1]);
    }
};

/// The columns [first, first + count) of F as MUMPS takes them.
struct SparseColumns {
    std::vector<MUMPS_INT> start, row;
    std::vector<double> value;

    void take(const Forces &f, std::int64_t first, std::int64_t count) {
        const std::int64_t begin = f.start[static_cast<std::size_t>(first)];
        const std::int64_t end = f.start[static_cast<std::size_t>(first + count)];
        start.clear();
        for (std::int64_t c = first; c <= first + count; ++c)
            start.push_back(static_cast<MUMPS_INT>(f.start[static_cast<std::size_t>(c)] - begin + 1));
        row.assign(f.row.begin() + begin, f.row.begin() + end);
        value.assign(f.value.begin() + begin, f.value.begin() + end);
    }
};

} // namespace

/// For every block of columns of F: X = A^-1 F, its products with F, and Z = A^-1 M X, whose products with F
/// are those of X with M X. Two solutions a column, and no X is kept.
void Executor::responses(const Call &call) {
    const std::int64_t *v = call.number, y_cols = v[3], s = v[4], count = v[5], t = s + y_cols;
    MumpsFactor *f = nullptr;
    const double *y = nullptr;
    std::unique_ptr<Forces> forces;
    std::vector<double> x, mx, products;
    SparseColumns sparse;
    team_.together([&] {
        f = &factor(v[0]);
        y = y_cols > 0 ? columns(v[1], v[2], y_cols) : nullptr;
        forces = std::make_unique<Forces>(s, t, count, v + 6, v + 6 + count, call.in);
        x.resize(static_cast<std::size_t>(n() * Exchange::width)), mx.resize(x.size());
        products.resize(static_cast<std::size_t>(t * Exchange::width));
    });
    const auto multiply = [&](const std::vector<double> &z, std::int64_t cols) { // F^T Z of this rank's rows
        std::fill(products.begin(), products.end(), 0);
        for (std::int64_t c = 0; c < s; ++c)
            for (std::int64_t k = forces->start[static_cast<std::size_t>(c)]; k < forces->start[c + 1]; ++k) {
                const std::int64_t i = rows_.local(forces->row[k] - 1);
                for (std::int64_t j = 0; i >= 0 && j < cols; ++j)
                    products[c + j * t] += forces->value[k] * z[i + j * n()];
            }
        const blas_int a = static_cast<blas_int>(y_cols), b = static_cast<blas_int>(cols),
                       rows = static_cast<blas_int>(n()), ld = static_cast<blas_int>(t);
        const double one = 1, zero = 0;
        if (a > 0 && rows > 0)
            dgemm_("T", "N", &a, &b, &rows, &one, y, &rows, z.data(), &rows, &zero, products.data() + s, &ld,
                   1, 1);
    };
    const auto hand_in = [&](std::int64_t first, std::int64_t cols, std::int64_t offset) {
        team_.sum_to_brain(products.data(), static_cast<std::size_t>(t * cols));
        if (team_.is_brain()) std::copy_n(products.data(), t * cols, call.out + offset + first * t);
    };
    for (std::int64_t first = 0; first < t;) {
        const std::int64_t cols = std::min(Exchange::width, (first < s ? s : t) - first);
        if (first < s) {
            team_.together([&] { sparse.take(*forces, first, cols); });
            f->solve_sparse(team_, rows_, sparse.start, sparse.row, sparse.value, cols, x.data(), n());
        } else {
            std::copy_n(y + (first - s) * n(), cols * n(), x.data());
            f->solve(team_, rows_, x.data(), cols, n());
        }
        multiply(x, cols);
        hand_in(first, cols, 1);
        matrices_.apply(team_, {1, 0, 0}, cols, x.data(), n(), mx.data(), n());
        f->solve(team_, rows_, mx.data(), cols, n());
        multiply(mx, cols);
        hand_in(first, cols, 1 + t * t);
        first += cols;
    }
    if (team_.is_brain()) call.out[0] = 1;
}

} // namespace plm::mpi
