// Each tall operation against the same in dense matrices, on as many ranks as it is started with.
#include "linalg/blas_lapack.hpp"
#include "mpi/team.hpp"
#include "tests/mpi/grid.hpp"
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>

extern "C" void dsysv_(const char *, const int *, const int *, double *, const int *, int *, double *,
                       const int *, double *, const int *, int *, std::size_t);
extern "C" void dsyev_(const char *, const char *, const int *, double *, const int *, double *, double *,
                       const int *, int *, std::size_t, std::size_t);

using namespace plm::mpi;
using namespace plm::mpi::test;
using Vector = std::vector<double>;
using Numbers = std::vector<std::int64_t>;

namespace {

int failures = 0;

void close_to(const char *what, const Vector &got, const Vector &wanted, double tolerance) {
    double size = 1e-300, error = got.size() == wanted.size() ? 0 : 1e300;
    for (double w : wanted) size = std::max(size, std::abs(w));
    for (std::size_t k = 0; k < std::min(got.size(), wanted.size()); ++k) {
        const double e = std::abs(got[k] - wanted[k]);
        if (!(e <= error)) error = e;
    }
    if (error <= tolerance * size) return;
    ++failures;
    std::printf("%s: off by %g of %g\n", what, error, size);
}

void expect(const char *what, bool holds) {
    if (holds) return;
    ++failures;
    std::printf("%s\n", what);
}

/// Dense counterparts on the brain; blocks are n x cols.
struct Reference {
    Grid grid;
    std::int64_t n;
    Vector m, k, c;

    explicit Reference(const Grid &g) : grid(g), n(g.n()), m(g.dense(0)), k(g.dense(1)), c(g.dense(2)) {}
    Vector sum(double fm, double fk, double fc) const {
        Vector a(m.size());
        for (std::size_t p = 0; p < a.size(); ++p) a[p] = fm * m[p] + fk * k[p] + fc * c[p];
        return a;
    }
    static Vector product(const Vector &a, const Vector &b, std::int64_t rows, std::int64_t inner,
                          std::int64_t cols, bool transposed) {
        Vector x(static_cast<std::size_t>(rows * cols), 0);
        for (std::int64_t j = 0; j < cols; ++j)
            for (std::int64_t p = 0; p < inner; ++p)
                for (std::int64_t i = 0; i < rows; ++i)
                    x[static_cast<std::size_t>(i + j * rows)] +=
                        a[static_cast<std::size_t>(transposed ? p + i * inner : i + p * rows)] *
                        b[static_cast<std::size_t>(p + j * inner)];
        return x;
    }
    /// A^-1 B with held DOFs at zero.
    Vector solution(Vector a, Vector b, const Numbers &held) const {
        const int order = static_cast<int>(n), cols = static_cast<int>(b.size()) / order;
        for (std::int64_t h : held) {
            for (std::int64_t i = 0; i < n; ++i)
                a[static_cast<std::size_t>(i + h * n)] = a[static_cast<std::size_t>(h + i * n)] = 0;
            a[static_cast<std::size_t>(h + h * n)] = 1;
            for (int j = 0; j < cols; ++j) b[static_cast<std::size_t>(h + j * n)] = 0;
        }
        std::vector<int> pivot(a.size());
        Vector work(static_cast<std::size_t>(64 * order));
        const int lwork = 64 * order;
        int info = 0;
        dsysv_("L", &order, &cols, a.data(), &order, pivot.data(), b.data(), &order, work.data(), &lwork,
               &info, 1);
        expect("the reference is singular", info == 0);
        return b;
    }
    double negative_eigenvalues(Vector a, const Numbers &held) const {
        for (std::int64_t h : held) {
            for (std::int64_t i = 0; i < n; ++i)
                a[static_cast<std::size_t>(i + h * n)] = a[static_cast<std::size_t>(h + i * n)] = 0;
            a[static_cast<std::size_t>(h + h * n)] = 1;
        }
        const int order = static_cast<int>(n), lwork = 64 * order;
        Vector w(static_cast<std::size_t>(n)), work(static_cast<std::size_t>(lwork));
        int info = 0;
        dsyev_("N", "L", &order, a.data(), &order, w.data(), work.data(), &lwork, &info, 1, 1);
        return static_cast<double>(std::count_if(w.begin(), w.end(), [](double x) { return x < 0; }));
    }
};

Numbers with(Numbers head, const Numbers &tail) {
    head.insert(head.end(), tail.begin(), tail.end());
    return head;
}

Vector whole(Service &s, std::int64_t block, std::int64_t first, std::int64_t cols, std::int64_t n) {
    Vector x;
    for (std::int64_t j = 0; j < cols; ++j) {
        const Vector column = perform(s, Operation::rows, {block, first + j, 1, -1}, {}, {}, n);
        x.insert(x.end(), column.begin(), column.end());
    }
    return x;
}

Vector part(const Vector &x, std::int64_t n, std::int64_t first, std::int64_t cols) {
    return Vector(x.begin() + first * n, x.begin() + (first + cols) * n);
}

void columns(Service &s, const Reference &r) {
    const std::int64_t n = r.n;
    perform(s, Operation::fill, {1, 5, 3}, {0.5, 2, 1});
    Vector x = whole(s, 1, 0, 5, n);
    const auto fixed = r.grid.fixed();
    const auto is_fixed = [&](std::int64_t i) {
        return std::find(fixed.begin(), fixed.end(), i) != fixed.end();
    };
    for (std::int64_t j = 0; j < 5; ++j)
        for (std::int64_t i = 0; i < n; ++i) {
            const double v = x[static_cast<std::size_t>(i + j * n)],
                         random = v - 0.5 - 2 * std::sin(static_cast<double>(i));
            expect("FILL", is_fixed(i) ? v == 0 : std::abs(random) < 1);
        }
    expect("FILL: columns differ", part(x, n, 0, 1) != part(x, n, 1, 1));
    perform(s, Operation::copy, {2, 0, 1, 3, 4, 0, 4});
    const Vector y = whole(s, 2, 0, 3, n);
    expect("COPY", part(y, n, 0, 1) == part(x, n, 4, 1) && part(y, n, 1, 1) == part(x, n, 0, 1) &&
                       part(y, n, 2, 1) == part(x, n, 4, 1));
    perform(s, Operation::copy, {2, 1, 2, 2, 0, 1});
    expect("COPY within", part(whole(s, 2, 0, 3, n), n, 1, 2) == part(y, n, 0, 2));

    const Vector coefficient = {1, 2, -1, 0.5, 3, 4};
    perform(s, Operation::combine, {2, 2, 2, 1, 1, 3, 0}, {0, 2}, coefficient); // column 3 is new
    Vector wanted = r.product(part(x, n, 1, 3), coefficient, n, 3, 2, false);
    for (double &v : wanted) v *= 2;
    close_to("COMBINE", whole(s, 2, 2, 2, n), wanted, 1e-14);
    const Vector before = whole(s, 2, 0, 2, n);
    perform(s, Operation::combine, {2, 0, 2, 1, 0, 2, 1}, {3, 1}, {5, 7});
    wanted = before;
    for (std::int64_t k = 0; k < 2 * n; ++k)
        wanted[static_cast<std::size_t>(k)] =
            3 * before[static_cast<std::size_t>(k)] + (k < n ? 5 : 7) * x[static_cast<std::size_t>(k)];
    close_to("COMBINE, diagonal", whole(s, 2, 0, 2, n), wanted, 1e-14);
    perform(s, Operation::combine, {1, 1, 2, 1, 1, 3, 0}, {0, 1}, coefficient);
    close_to("COMBINE in place", whole(s, 1, 1, 2, n),
             r.product(part(x, n, 1, 3), coefficient, n, 3, 2, false), 1e-14);
    perform(s, Operation::combine, {1, 0, 1, 1, 1, 0, 0}, {-2, 1});
    close_to("COMBINE of nothing", whole(s, 1, 0, 1, n), r.product(part(x, n, 0, 1), {-2}, n, 1, 1, false),
             1e-15);

    x = whole(s, 1, 0, 3, n);
    const Vector z = whole(s, 2, 0, 4, n);
    close_to("GRAM", perform(s, Operation::gram, {1, 0, 3, 2, 1, 3, 0, 0}, {}, {}, 9),
             r.product(x, part(z, n, 1, 3), 3, n, 3, true), 1e-13);
    const Vector all = r.product(x, part(z, n, 0, 3), 3, n, 3, true);
    close_to("GRAM, diagonal", perform(s, Operation::gram, {1, 0, 3, 2, 0, 3, 1, 0}, {}, {}, 3),
             {all[0], all[4], all[8]}, 1e-13);
    Vector ax = x, az = part(z, n, 0, 3);
    for (double &v : ax) v = std::abs(v);
    for (double &v : az) v = std::abs(v);
    close_to("GRAM, absolute", perform(s, Operation::gram, {1, 0, 3, 2, 0, 3, 0, 1}, {}, {}, 9),
             r.product(ax, az, 3, n, 3, true), 1e-13);
}

void some_rows(Service &s, const Reference &r) {
    const std::int64_t n = r.n;
    const Vector x = whole(s, 1, 0, 2, n);
    const Vector got = perform(s, Operation::rows, {1, 0, 2, 3, n - 2, 1, 0}, {}, {}, 6);
    close_to("ROWS", got,
             {x[static_cast<std::size_t>(n - 2)], x[1], 0, x[static_cast<std::size_t>(2 * n - 2)],
              x[static_cast<std::size_t>(n + 1)], 0},
             0);
    perform(s, Operation::set_rows, {1, 0, 2, 2, 1, 0}, {2}, {10, 20, 30, 40}); // DOF 0 is a support
    const Vector now = perform(s, Operation::rows, {1, 0, 2, 2, 1, 0}, {}, {}, 4);
    close_to("SET_ROWS", now, {2 * x[1] + 10, 0, 2 * x[static_cast<std::size_t>(n + 1)] + 30, 0}, 1e-15);
    Vector all(static_cast<std::size_t>(n));
    for (std::int64_t i = 0; i < n; ++i) all[static_cast<std::size_t>(i)] = static_cast<double>(i) + 0.5;
    perform(s, Operation::set_rows, {1, 1, 1, -1}, {0}, all);
    for (std::int64_t f : r.grid.fixed()) all[static_cast<std::size_t>(f)] = 0;
    close_to("SET_ROWS of all", whole(s, 1, 1, 1, n), all, 0);
    const Vector look = perform(s, Operation::look, {1, 1, 1}, {}, {}, 3);
    close_to("LOOK", look, {1, static_cast<double>(n) - 1.5, static_cast<double>(n) - 2}, 1e-15);
    perform(s, Operation::set_rows, {1, 1, 1, 1, 3}, {0}, {NAN});
    expect("LOOK for NaN", perform(s, Operation::look, {1, 1, 1}, {}, {}, 3)[0] == 0);
}

void matrices(Service &s, const Reference &r) {
    const std::int64_t n = r.n, cols = 35; // more than go at once
    perform(s, Operation::fill, {3, cols, 9}, {0, 0, 1});
    const Vector x = whole(s, 3, 0, cols, n);
    for (const auto &w : {Vector{1, 0, 0}, Vector{0, 1, 0}, Vector{-0.3, 2, 0.7}}) {
        perform(s, Operation::apply, {4, 0, 3, 0, cols}, w);
        const Vector a = r.sum(w[0], w[1], w[2]), ax = r.product(a, x, n, n, cols, false);
        close_to("APPLY", whole(s, 4, 0, cols, n), ax, 1e-14);
        const Vector energy = perform(s, Operation::energy, {3, 0, cols}, w, {}, 2 * cols);
        Vector wanted;
        for (std::int64_t j = 0; j < cols; ++j) {
            double e = 0, size = 0;
            for (std::int64_t i = 0; i < n; ++i) {
                e += x[static_cast<std::size_t>(i + j * n)] * ax[static_cast<std::size_t>(i + j * n)];
                for (std::int64_t p = 0; p < n; ++p)
                    size += std::abs(x[static_cast<std::size_t>(i + j * n)] *
                                     a[static_cast<std::size_t>(i + p * n)] *
                                     x[static_cast<std::size_t>(p + j * n)]);
            }
            wanted.push_back(e), wanted.push_back(size);
        }
        close_to("ENERGY", energy, wanted, 1e-13);
        const Vector diagonal = perform(s, Operation::diagonal, {3, 5, n - 2, 0}, w, {}, 3);
        close_to(
            "DIAGONAL", diagonal,
            {a[static_cast<std::size_t>(5 * (n + 1))], a[static_cast<std::size_t>((n - 2) * (n + 1))], 0},
            1e-15);
    }
    perform(s, Operation::apply, {4, 0, 3, 0, 3}, {1, 0, 0});
    const Vector mx = whole(s, 4, 0, 3, n), kx = r.product(r.k, part(x, n, 0, 3), n, n, 3, false),
                 lambda = {0.5, 2, 40};
    Vector wanted;
    for (std::int64_t j = 0; j < 3; ++j) {
        double sum = 0;
        for (std::int64_t i = 0; i < n; ++i) {
            double size = 0;
            for (std::int64_t p = 0; p < n; ++p)
                size += std::abs(r.k[static_cast<std::size_t>(i + p * n)] *
                                 x[static_cast<std::size_t>(p + j * n)]);
            const double left =
                std::abs(kx[static_cast<std::size_t>(i + j * n)] -
                         lambda[static_cast<std::size_t>(j)] * mx[static_cast<std::size_t>(i + j * n)]) -
                0.1 * size;
            if (left > 0) sum += left * left;
        }
        wanted.push_back(std::sqrt(sum));
    }
    close_to("RESIDUAL", perform(s, Operation::residual, {3, 0, 4, 0, 3}, {0.1}, lambda, 3), wanted, 1e-13);
}

void what_is_known(Service &s, const Reference &r) {
    const Vector facts = perform(s, Operation::facts, {}, {}, {}, 16);
    double m = 0, k = 0, least = 1e300, most[3] = {0, 0, 0};
    Vector ratio;
    for (std::int64_t i = 0; i < r.n; ++i) {
        const double mi = r.m[static_cast<std::size_t>(i * (r.n + 1))],
                     ki = r.k[static_cast<std::size_t>(i * (r.n + 1))];
        m += mi, k += ki;
        if (mi > 0) least = std::min(least, ki), ratio.push_back(ki / mi);
    }
    for (std::size_t p = 0; p < r.m.size(); ++p)
        most[0] = std::max(most[0], std::abs(r.m[p])), most[1] = std::max(most[1], std::abs(r.k[p])),
        most[2] = std::max(most[2], std::abs(r.c[p]));
    std::sort(ratio.begin(), ratio.end());
    const double count = static_cast<double>(ratio.size());
    close_to("FACTS", part(facts, 1, 0, 5), {count, count, m, k, least}, 1e-13);
    close_to("FACTS, median", {facts[5]}, {ratio[ratio.size() / 2]}, 0.05);
    close_to("FACTS, the rest", part(facts, 1, 6, 7), {-1, -1, 0, 1, most[0], most[1], most[2]}, 1e-13);
}

void factorizations(Service &s, const Reference &r) {
    const std::int64_t n = r.n, cols = 35;
    perform(s, Operation::fill, {5, cols, 4}, {0, 0, 1});
    const Vector b = whole(s, 5, 0, cols, n);
    const Numbers held = {3, n - 4}, none;
    const Numbers row = {7, 7, 9, 7, 3}, column = {7, 2, 2, 7, 2}; // twice one place, and one of a held DOF
    const Vector value = {2, -1, 0.5, 1, 8};
    Vector a = r.sum(0.2, 1, 0);
    const auto fixed = r.grid.fixed();
    for (std::size_t e = 0; e < row.size(); ++e) {
        a[static_cast<std::size_t>(row[e] + column[e] * n)] += value[e];
        if (row[e] != column[e]) a[static_cast<std::size_t>(column[e] + row[e] * n)] += value[e];
    }
    const Vector f = perform(s, Operation::factor, with(with(with({10, 0, 2, 5}, held), row), column),
                             {0.2, 1, 0}, value, 8);
    expect("FACTOR: there is one", f[3] == 0 && f[4] == -1 && f[2] > 0 && f[1] > 1e-4 && f[1] <= 1);
    perform(s, Operation::solve, {10, 5, 1, cols - 1});
    close_to("SOLVE", whole(s, 5, 1, cols - 1, n), r.solution(a, part(b, n, 1, cols - 1), with(held, fixed)),
             1e-12);
    expect("SOLVE: a column before stays", whole(s, 5, 0, 1, n) == part(b, n, 0, 1));

    // RESPONSES with more sparse columns than go at once, and two of a block
    const std::int64_t sparse = 40, t = sparse + 2;
    Numbers dof, of;
    Vector coefficient, forces(static_cast<std::size_t>(n * t), 0);
    for (std::int64_t c = sparse - 1; c >= 0; --c)
        for (int e = 0; e < 3; ++e) {
            dof.push_back((c * 5 + e * 11 + 1) % n), of.push_back(c),
                coefficient.push_back(1 + 0.1 * static_cast<double>(c) - e);
            forces[static_cast<std::size_t>(dof.back() + c * n)] += coefficient.back();
        }
    std::copy_n(b.begin(), n, forces.begin() + sparse * n);
    std::copy_n(whole(s, 5, 1, 1, n).begin(), n, forces.begin() + (sparse + 1) * n);
    const auto size = static_cast<std::int64_t>(dof.size());
    const Vector said = perform(s, Operation::responses, with(with({10, 5, 0, 2, sparse, size}, dof), of), {},
                                coefficient, 1 + 2 * t * t);
    const Vector x = r.solution(a, forces, with(held, fixed));
    expect("RESPONSES: done", said[0] == 1);
    close_to("RESPONSES, flexibility", part(said, 1, 1, t * t), r.product(forces, x, t, n, t, true), 1e-11);
    close_to("RESPONSES, inertia", part(said, 1, 1 + t * t, t * t),
             r.product(x, r.product(r.m, x, n, n, t, false), t, n, t, true), 1e-11);

    for (double shift : {0.02, 1.0, 7.0}) {
        const Vector count = perform(s, Operation::factor, {11, 1, 0, 0}, {-shift, 1, 0}, {}, 8);
        close_to("FACTOR: negative eigenvalues", {count[0], count[3]},
                 {r.negative_eigenvalues(r.sum(-shift, 1, 0), fixed), 0}, 0);
    }
    const Vector indefinite = perform(s, Operation::factor, {12, 0, 0, 0}, {-1, 1, 0}, {}, 8);
    expect("FACTOR: an indefinite matrix is none", indefinite[3] == 1);
    perform(s, Operation::free, {3, 10, 5, 12345}, {}, {});
    try {
        perform(s, Operation::solve, {10, 3, 0, 1});
        expect("SOLVE with a factorization that was given up", false);
    } catch (const std::exception &e) {
        expect("the error says which", std::strstr(e.what(), "factorization 10"));
    }
}

/// A free chain: its stiffness is singular, and that must be told.
void singular(Service &s, std::int64_t) {
    const Vector f = perform(s, Operation::factor, {10, 0, 0, 0}, {0, 1, 0}, {}, 8);
    expect("FACTOR: a free structure", f[3] != 0 || f[1] < 1e-13);
    const Vector shifted = perform(s, Operation::factor, {11, 0, 0, 0}, {1e-3, 1, 0}, {}, 8);
    expect("FACTOR: with a shift", shifted[3] == 0 && shifted[1] > 1e-7);
}

void with_a_team(const Grid &grid, bool supports,
                 const std::function<void(Service &, const Reference &)> &work) {
    Service s;
    s.start(MPI_COMM_WORLD, grid.n(), {});
    s.parts = grid.parts(s.team().rank(), s.team().size());
    if (!supports) s.parts.matrices.fixed.clear();
    failures += lead(s, [&] {
        Parts all;
        s.assemble(all);
        work(s, Reference(grid));
    });
}

} // namespace

int main(int argc, char **argv) {
    MPI_Init(&argc, &argv);
    for (bool idle : {false, true})
        with_a_team({5, 4, 6, 0.01, idle}, true, [](Service &s, const Reference &r) {
            columns(s, r);
            some_rows(s, r);
            matrices(s, r);
            what_is_known(s, r);
            factorizations(s, r);
        });
    with_a_team({5, 4, 6, 0, false}, false, [](Service &s, const Reference &r) { singular(s, r.n); });
    with_a_team({2, 1, 2, 0.01, false}, true,
                [](Service &s, const Reference &r) { what_is_known(s, r); }); // fewer DOFs than ranks
    int rank = 0;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    if (rank == 0) std::printf("%d failures\n", failures);
    MPI_Finalize();
    return rank == 0 && failures > 0;
}
