// Whatever fails on one rank fails on all: nobody waits, all have one status, and the next team works. Faults
// come from operator new, at any allocation of a team's life on any rank, and from numbers and memory that a
// rank lacks.
#include "tests/mpi/grid.hpp"
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <malloc.h>
#include <random>
#include <sys/resource.h>
#include <unistd.h>

using namespace plm::mpi;
using namespace plm::mpi::test;

namespace {

enum class Kind { none, memory, error, standard, unknown, nan, kinds };

std::int64_t allocations = 0, fails_at = -1; // the fault comes at this allocation; -1: never
Kind kind = Kind::none;

void allocate_or_fail() {
    if (++allocations != fails_at) return;
    switch (kind) {
    case Kind::error:
        throw plm::Error(plm::status::matrix, "an error of its own").index(3);
    case Kind::standard:
        throw std::runtime_error("a standard exception");
    case Kind::unknown:
        throw 5;
    default:
        throw std::bad_alloc();
    }
}

} // namespace

void *operator new(std::size_t n) {
    allocate_or_fail();
    if (void *p = std::malloc(n ? n : 1)) return p;
    throw std::bad_alloc();
}
void *operator new(std::size_t n, const std::nothrow_t &) noexcept { // who asks so does without
    return std::malloc(n ? n : 1);
}
void operator delete(void *p) noexcept {
    std::free(p);
}
void operator delete(void *p, std::size_t) noexcept {
    std::free(p);
}

namespace {

/// What a model asks of its team, each operation once.
void program(Service &s, std::int64_t n) {
    Parts all;
    s.assemble(all);
    perform(s, Operation::facts, {}, {}, {}, 16);
    perform(s, Operation::fill, {1, 3, 1}, {0, 0, 1});
    perform(s, Operation::copy, {2, 0, 1, 2, 1, 0});
    perform(s, Operation::combine, {2, 1, 2, 1, 0, 2, 0}, {0, 1}, {1, 2, 3, 4});
    perform(s, Operation::gram, {1, 0, 3, 2, 0, 3, 0, 0}, {}, {}, 9);
    perform(s, Operation::apply, {3, 0, 1, 0, 3}, {1, 2, 0});
    perform(s, Operation::energy, {1, 0, 3}, {0, 1, 0}, {}, 6);
    perform(s, Operation::residual, {1, 0, 3, 0, 2}, {1e-16}, {1, 2}, 2);
    perform(s, Operation::diagonal, {2, 1, 4}, {0, 1, 0}, {}, 2);
    perform(s, Operation::factor, {9, 0, 1, 1, 3, 5, 4}, {0, 1, 0}, {0.5}, 8);
    perform(s, Operation::solve, {9, 1, 0, 3});
    perform(s, Operation::responses, {9, 1, 0, 1, 2, 2, 4, 6, 0, 1}, {}, {1, 1}, 19);
    perform(s, Operation::factor, {10, 1, 0, 0}, {-1, 1, 0}, {}, 8);
    perform(s, Operation::rows, {1, 0, 3, 1, 4}, {}, {}, 3);
    perform(s, Operation::set_rows, {1, 0, 1, 1, 4}, {0}, {1});
    perform(s, Operation::rows, {1, 0, 1, -1}, {}, {}, n);
    perform(s, Operation::look, {1, 0, 3}, {}, {}, 3);
    s.deliver_field(std::vector<double>(static_cast<std::size_t>(n)).data());
    perform(s, Operation::free, {2, 9, 1});
}

/// One team's life, as a host writes it. Its outcome on this rank.
Verdict life(const Grid &grid, int rank, int size, int faulty) {
    Service s;
    Verdict mine;
    const std::int64_t before = allocations;
    if (rank == faulty && kind != Kind::nan && fails_at > 0) fails_at += before;
    try {
        s.start(MPI_COMM_WORLD, grid.n(), {});
        try {
            s.parts = grid.parts(rank, size);
            for (std::int32_t k = 0; rank == faulty && kind == Kind::nan && k < grid.n(); ++k)
                s.parts.matrices.entries[1].add({k, k, NAN, 0}); // all: those of supports are of no account
        } catch (...) {
            s.remember(Team::describe_failure());
        }
        if (rank > 0)
            mine = s.serve();
        else {
            try {
                program(s, grid.n());
            } catch (...) {
                mine = Team::describe_failure();
            }
            s.dismiss(mine);
        }
        s.close();
    } catch (...) {
        mine = Team::describe_failure();
    }
    fails_at = -1;
    return mine;
}

/// All ranks have one status; it is wanted, or any failure.
int check(const Verdict &mine, bool fails, const char *what) {
    const int status = mine.status;
    int least = 0, most = 0;
    MPI_Allreduce(&status, &least, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD);
    MPI_Allreduce(&status, &most, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
    if (least == most && (least < 0) == fails) return 0;
    std::printf("%s: this rank has %d (%s), of all %d to %d\n", what, status, mine.text, least, most);
    return 1;
}

int random_faults(int rank, int size, int count) {
    const Grid grid{4, 3, 3};
    int failures = check(life(grid, rank, size, -1), false, "without a fault");
    const std::int64_t before = allocations;
    failures += check(life(grid, rank, size, -1), false, "without a fault");
    std::int64_t last = allocations - before, least = 0;
    MPI_Allreduce(&last, &least, 1, MPI_INT64_T, MPI_MIN, MPI_COMM_WORLD);
    std::mt19937 chance(7); // the same on all ranks
    for (int k = 0; k < count; ++k) {
        const int faulty = static_cast<int>(chance() % static_cast<unsigned>(size));
        kind = static_cast<Kind>(1 + chance() % (static_cast<unsigned>(Kind::kinds) - 1));
        const auto at = static_cast<std::int64_t>(1 + chance() % static_cast<unsigned long>(least * 9 / 10));
        fails_at = rank == faulty && kind != Kind::nan ? at : -1;
        const Verdict mine = life(grid, rank, size, faulty);
        failures += check(mine, true, "a fault");
    }
    kind = Kind::none;
    return failures + check(life(grid, rank, size, -1), false, "after all faults");
}

/// An allocation that fails on every rank in turn, at each step of a small run. `stride`: of how many one is
/// taken.
int every_step(int rank, int size, std::int64_t stride) {
    const Grid grid{2, 2, 3};
    int failures = 0;
    kind = Kind::memory;
    for (int faulty = 0; faulty < size; ++faulty) {
        const std::int64_t before = allocations;
        fails_at = -1;
        life(grid, rank, size, -1);
        std::int64_t all = allocations - before;
        MPI_Bcast(&all, 1, MPI_INT64_T, faulty, MPI_COMM_WORLD);
        for (std::int64_t at = 1 + faulty; at < all; at += stride) {
            fails_at = rank == faulty ? at : -1;
            failures += check(life(grid, rank, size, faulty), true, "an allocation");
        }
    }
    kind = Kind::none;
    return failures;
}

/// The last rank may have no more than `room` bytes beyond what it has now.
void limit_memory(double room) {
    long pages = 0;
    malloc_trim(0); // what was given back before is no reserve
    if (std::FILE *f = std::fopen("/proc/self/statm", "r")) {
        if (std::fscanf(f, "%ld", &pages) != 1) pages = 0;
        std::fclose(f);
    }
    rlimit limit;
    getrlimit(RLIMIT_AS, &limit);
    limit.rlim_cur = room > 0
                         ? static_cast<rlim_t>(
                               static_cast<double>(pages) * static_cast<double>(sysconf(_SC_PAGESIZE)) + room)
                         : limit.rlim_max;
    setrlimit(RLIMIT_AS, &limit);
}

/// MUMPS gets no memory on one rank: all say so, and name it. With memory the same team goes on.
int starved(int rank, int size) {
    const Grid grid{26, 25, 24};
    Service s;
    Verdict mine;
    s.start(MPI_COMM_WORLD, grid.n(), {});
    s.parts = grid.parts(rank, size);
    s.receiver = [&](const auto &, const double *value) { // told by the values of a field
        if (rank == size - 1) limit_memory(value[0]);
        return 0;
    };
    if (rank > 0)
        s.serve();
    else {
        Parts all;
        s.assemble(all);
        s.deliver_field(std::vector<double>(static_cast<std::size_t>(grid.n()), 4e6).data());
        try {
            perform(s, Operation::factor, {1, 0, 0, 0}, {0, 1, 0}, {}, 8);
        } catch (...) {
            mine = Team::describe_failure();
        }
        s.deliver_field(std::vector<double>(static_cast<std::size_t>(grid.n()), 0.0).data());
        const std::vector<double> again = perform(s, Operation::factor, {1, 0, 0, 0}, {0, 1, 0}, {}, 8);
        if (again[3] != 0) mine.status = 1;
        s.dismiss({});
    }
    s.close();
    if (rank > 0 || (mine.status == plm::status::memory && mine.rank == size - 1)) return 0;
    std::printf("a rank without memory: status %d of rank %d (%s)\n", mine.status, mine.rank, mine.text);
    return 1;
}

} // namespace

int main(int argc, char **argv) {
    MPI_Init(&argc, &argv);
    int rank = 0, size = 1;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &size);
    int failures = random_faults(rank, size, argc > 1 ? std::atoi(argv[1]) : 25) +
                   every_step(rank, size, argc > 2 ? std::atoi(argv[2]) : 400) + starved(rank, size),
        all = 0;
    MPI_Allreduce(&failures, &all, 1, MPI_INT, MPI_SUM, MPI_COMM_WORLD);
    if (rank == 0) std::printf("%d failures\n", all);
    MPI_Finalize();
    return all > 0;
}
