// Operations that each rank does on its own rows, and sums of small numbers over them.
#include "linalg/blas_lapack.hpp"
#include "mpi/executor.hpp"
#include <algorithm>
#include <cmath>

namespace plm::mpi {
namespace {

/// A number in (-1, 1) from a DOF, a column and a seed: the same on any number of ranks.
double pseudo_random(std::uint64_t dof, std::uint64_t column, std::uint64_t seed) {
    std::uint64_t z =
        dof * 0x9e3779b97f4a7c15u + column * 0xd1b54a32d192ed03u + seed * 0x8cb92ba72f3d8dd7u + 1;
    for (std::uint64_t factor : {0xbf58476d1ce4e5b9u, 0x94d049bb133111ebu}) z = (z ^ (z >> 29)) * factor;
    z ^= z >> 32;
    return (static_cast<double>(z >> 11) + 0.5) * 0x1p-52 - 1;
}

struct Combination {
    std::int64_t rows, x_cols, y_cols;
    double beta, alpha;
    const double *s;
};

void multiply(const Combination &c, std::int64_t rows, const double *y, std::int64_t ld_y, double *x,
              std::int64_t ld_x) {
    const blas_int m = static_cast<blas_int>(rows), n = static_cast<blas_int>(c.x_cols),
                   k = static_cast<blas_int>(c.y_cols), ldx = static_cast<blas_int>(ld_x),
                   ldy = static_cast<blas_int>(ld_y), lds = std::max(k, 1);
    if (m > 0 && n > 0) dgemm_("N", "N", &m, &n, &k, &c.alpha, y, &ldy, c.s, &lds, &c.beta, x, &ldx, 1, 1);
}

/// X = alpha X S where X stands: a band of rows at a time, which is copied first.
void multiply_in_place(const Combination &c, double *x) {
    constexpr std::int64_t band = 256;
    std::vector<double> copy(static_cast<std::size_t>(band * c.y_cols));
    for (std::int64_t first = 0; first < c.rows; first += band) {
        const std::int64_t rows = std::min(band, c.rows - first);
        for (std::int64_t j = 0; j < c.y_cols; ++j)
            std::copy_n(x + first + j * c.rows, rows, copy.data() + j * band);
        multiply(c, rows, copy.data(), band, x + first, c.rows);
    }
}

void combine_diagonal(const Combination &c, const double *y, double *x) {
    for (std::int64_t j = 0; j < c.x_cols; ++j)
        for (std::int64_t i = j * c.rows; i < (j + 1) * c.rows; ++i)
            x[i] = (c.beta != 0 ? c.beta * x[i] : 0) + c.alpha * c.s[j] * y[i];
}

} // namespace

void Executor::fill(const Call &call) {
    const double *f = call.factor;
    team_.together([&] {
        double *x = written(call.number[0], 0, call.number[1]);
        for (std::int64_t j = 0; j < call.number[1]; ++j)
            for (std::int64_t i = 0; i < n(); ++i) {
                const auto dof = rows_.owned()[static_cast<std::size_t>(i)];
                double value = f[0];
                if (f[1] != 0) value += f[1] * std::sin(static_cast<double>(dof));
                if (f[2] != 0)
                    value +=
                        f[2] * pseudo_random(static_cast<std::uint64_t>(dof), static_cast<std::uint64_t>(j),
                                             static_cast<std::uint64_t>(call.number[2]));
                x[i + j * n()] = fixed(i) ? 0 : value;
            }
    });
}

void Executor::copy(const Call &call) {
    const std::int64_t *v = call.number;
    team_.together([&] {
        std::vector<double> kept; // where x is y a column may be written before it is read
        if (v[0] == v[2]) kept.reserve(static_cast<std::size_t>(v[3] * n()));
        for (std::int64_t k = 0; k < v[3]; ++k) {
            const double *from = columns(v[2], v[4 + k], 1);
            if (v[0] == v[2]) kept.insert(kept.end(), from, from + n());
        }
        double *to = written(v[0], v[1], v[3]);
        for (std::int64_t k = 0; k < v[3]; ++k)
            std::copy_n(v[0] == v[2] ? kept.data() + k * n() : columns(v[2], v[4 + k], 1), n(), to + k * n());
    });
}

void Executor::combine(const Call &call) {
    const std::int64_t *v = call.number;
    const Combination c{n(), v[2], v[5], call.factor[0], call.factor[1], call.in};
    team_.together([&] {
        double *x = c.beta != 0 ? columns(v[0], v[1], v[2]) : written(v[0], v[1], v[2]);
        if (v[5] == 0) {
            for (std::int64_t i = 0; i < v[2] * n(); ++i) x[i] = c.beta != 0 ? c.beta * x[i] : 0;
            return;
        }
        const double *y = columns(v[3], v[4], v[5]);
        if (v[6])
            combine_diagonal(c, y, x);
        else if (x == y && n() > 0)
            multiply_in_place(c, x);
        else
            multiply(c, n(), y, std::max<std::int64_t>(1, n()), x, std::max<std::int64_t>(1, n()));
    });
}

void Executor::gram(const Call &call) {
    const std::int64_t *v = call.number;
    const bool is_diagonal = v[6] != 0, absolute = v[7] != 0;
    const std::int64_t size = is_diagonal ? v[2] : v[2] * v[5];
    team_.together([&] {
        const double *x = columns(v[0], v[1], v[2]), *y = columns(v[3], v[4], v[5]);
        std::fill_n(call.out, size, 0);
        const blas_int m = static_cast<blas_int>(v[2]), k = static_cast<blas_int>(v[5]),
                       rows = static_cast<blas_int>(n());
        if (rows == 0 || m == 0 || k == 0) return;
        if (!is_diagonal && !absolute) {
            const double one = 1, zero = 0;
            dgemm_("T", "N", &m, &k, &rows, &one, x, &rows, y, &rows, &zero, call.out, &m, 1, 1);
            return;
        }
        for (std::int64_t j = 0; j < v[5]; ++j)
            for (std::int64_t i = is_diagonal ? j : 0; i < (is_diagonal ? j + 1 : v[2]); ++i) {
                double sum = 0;
                const double *a = x + i * n(), *b = y + j * n();
                for (std::int64_t r = 0; r < n(); ++r) sum += absolute ? std::abs(a[r] * b[r]) : a[r] * b[r];
                call.out[is_diagonal ? j : i + j * v[2]] = sum;
            }
    });
    team_.sum_to_brain(call.out, static_cast<std::size_t>(size));
}

void Executor::rows(const Call &call) {
    const std::int64_t *v = call.number;
    team_.together([&] {
        const double *x = columns(v[0], v[1], v[2]);
        std::fill_n(call.out, v[3] * v[2], 0);
        for (std::int64_t k = 0; k < v[3]; ++k) {
            const std::int64_t i = rows_.local(v[4 + k]);
            for (std::int64_t j = 0; i >= 0 && j < v[2]; ++j) call.out[k + j * v[3]] = x[i + j * n()];
        }
    });
    team_.sum_to_brain(call.out, static_cast<std::size_t>(v[3] * v[2]));
}

void Executor::set_rows(const Call &call) {
    const std::int64_t *v = call.number;
    const double beta = call.factor[0];
    team_.together([&] {
        double *x = columns(v[0], v[1], v[2]);
        for (std::int64_t k = 0; k < v[3]; ++k) {
            const std::int64_t i = rows_.local(v[4 + k]);
            for (std::int64_t j = 0; i >= 0 && !fixed(i) && j < v[2]; ++j) {
                double &value = x[i + j * n()];
                value = (beta != 0 ? beta * value : 0) + call.in[k + j * v[3]];
            }
        }
    });
}

namespace {
struct DofValue {
    std::int64_t dof;
    double value;
};
} // namespace

void Executor::all_rows(const Call &call) {
    const std::int64_t *v = call.number;
    for (std::int64_t j = 0; j < v[2]; ++j) {
        std::vector<DofValue> mine;
        std::vector<int> to;
        team_.together([&] {
            const double *x = columns(v[0], v[1] + j, 1);
            for (std::int64_t i = 0; i < n(); ++i)
                mine.push_back({rows_.owned()[static_cast<std::size_t>(i)], x[i]});
            to.assign(mine.size(), 0);
        });
        for (const DofValue &d : deliver(team_, mine, to)) call.out[d.dof + j * rows_.n_dof()] = d.value;
    }
}

void Executor::set_all_rows(const Call &call) {
    const std::int64_t *v = call.number;
    std::vector<std::int64_t> dofs;
    team_.together([&] {
        columns(v[0], v[1], v[2]);
        for (std::int64_t dof = 0; team_.is_brain() && dof < rows_.n_dof(); ++dof) dofs.push_back(dof);
    });
    const std::vector<int> owner = rows_.owners_of(team_, dofs);
    for (std::int64_t j = 0; j < v[2]; ++j) {
        std::vector<DofValue> all;
        team_.together([&] {
            for (std::int64_t dof : dofs) all.push_back({dof, call.in[dof + j * rows_.n_dof()]});
        });
        double *x = columns(v[0], v[1] + j, 1); // they exist, see above
        for (const DofValue &d : deliver(team_, all, owner)) {
            const std::int64_t i = rows_.local(d.dof);
            if (!fixed(i)) x[i] = (call.factor[0] != 0 ? call.factor[0] * x[i] : 0) + d.value;
        }
    }
}

void Executor::look(const Call &call) {
    const std::int64_t *v = call.number;
    std::vector<double> all;
    team_.together([&] {
        const double *x = columns(v[0], v[1], v[2]);
        double finite = 1, largest = -1, dof = 0;
        for (std::int64_t i = 0; i < n(); ++i) {
            double sum = 0;
            for (std::int64_t j = 0; j < v[2]; ++j) sum += x[i + j * n()] * x[i + j * n()];
            for (std::int64_t j = 0; j < v[2]; ++j)
                if (!std::isfinite(x[i + j * n()])) finite = 0;
            if (std::sqrt(sum) > largest)
                largest = std::sqrt(sum),
                dof = static_cast<double>(rows_.owned()[static_cast<std::size_t>(i)]);
        }
        call.out[0] = finite, call.out[1] = largest, call.out[2] = dof;
        if (team_.is_brain()) all.resize(static_cast<std::size_t>(3 * team_.size()));
    });
    const double mine[3] = {call.out[0], call.out[1], call.out[2]};
    require_mpi(MPI_Gather(mine, 3, MPI_DOUBLE, all.data(), 3, MPI_DOUBLE, 0, team_.comm()), "MPI_Gather");
    for (std::size_t r = 0; 3 * r < all.size(); ++r) {
        const double *one = all.data() + 3 * r;
        call.out[0] = std::min(call.out[0], one[0]);
        if (one[1] > call.out[1] || (one[1] == call.out[1] && one[2] < call.out[2]))
            call.out[1] = one[1], call.out[2] = one[2];
    }
    call.out[1] = std::max(call.out[1], 0.0);
}

} // namespace plm::mpi
