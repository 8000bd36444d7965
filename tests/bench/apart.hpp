// What the benchmarks of scale share: clocks, scenes as the core takes them, and steps in processes of their
// own, whose memory is told.
#pragma once
#include "linalg/parallel.hpp"
#include "space/model_input.hpp"
#include "structure/matrix_input.hpp"
extern "C" {
#include "scene.h"
}
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <malloc.h>
#include <memory>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

inline int n_threads = 1;

inline double seconds_now() {
    timespec t;
    clock_gettime(n_threads > 1 ? CLOCK_MONOTONIC : CLOCK_PROCESS_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

template <class Step> double seconds_of(Step step) {
    const double begin = seconds_now();
    step();
    return seconds_now() - begin;
}

inline double peak_mebibytes() {
    rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<double>(usage.ru_maxrss) / 1024;
}

inline double resident_mebibytes() {
    long long pages = 0, resident = 0;
    FILE *file = std::fopen("/proc/self/statm", "r");
    if (!file || std::fscanf(file, "%lld %lld", &pages, &resident) != 2) std::exit(1);
    std::fclose(file);
    return static_cast<double>(resident) * static_cast<double>(sysconf(_SC_PAGESIZE)) / (1 << 20);
}

inline plm::ModelInput input_of(const scene &s) {
    plm::ModelInput input;
    input.n_dof = s.n_dof;
    plm::MatrixFormat format;
    format.n = s.n_dof, format.nnz = s.nnz, format.copy = false;
    input.mass = std::make_shared<plm::MatrixInput>(format, s.col_ptr, s.row, s.m);
    input.stiffness = std::make_shared<plm::MatrixInput>(format, s.col_ptr, s.row, s.k);
    input.fixed.assign(s.fixed, s.fixed + s.n_fixed);
    for (std::int64_t pair = 0; pair < s.n_pairs; ++pair) {
        for (int c = 0; c < 3; ++c)
            for (int side = 0; side < 2; ++side) {
                input.gap_row.push_back(pair);
                input.gap_dof.push_back((side ? s.dof_b : s.dof_a)[3 * pair + c]);
                input.gap_coefficient.push_back(s.normal[3 * pair + c] * (side ? -1 : 1));
            }
        input.contact.stiffness.push_back(s.contact_stiffness[pair]);
        input.contact.initial_gap.push_back(0);
    }
    return input;
}

/// Of each DOF: its number among the free ones, or -1.
inline plm::vector<std::int64_t> free_numbers(const plm::ModelInput &input) {
    plm::vector<std::int64_t> number(input.n_dof, 0);
    for (std::int64_t dof : input.fixed) number[dof] = -1;
    std::int64_t n = 0;
    for (std::int64_t &k : number)
        if (k == 0) k = n++;
    return number;
}

inline plm::SparseMatrix free_matrix(const plm::ModelInput &input, const plm::MatrixInput &matrix) {
    const plm::vector<std::int64_t> number = free_numbers(input);
    const auto n =
        static_cast<std::int64_t>(std::count_if(number.begin(), number.end(), [](auto k) { return k >= 0; }));
    return plm::submatrix(matrix.to_sparse(), number, n, number, n);
}

/// From here on memory given back stays with the process, this much of it touched before: the first touch of
/// a page is the machine's doing, and on a virtual one may take as long as what is measured.
inline void warm_memory([[maybe_unused]] double mebibytes) {
#ifdef __GLIBC__
    mallopt(M_MMAP_MAX, 0);
    mallopt(M_TRIM_THRESHOLD, -1);
    const auto bytes = static_cast<std::size_t>(mebibytes * (1 << 20));
    auto *block = static_cast<volatile char *>(std::malloc(bytes));
    if (!block) std::exit(1);
    for (std::size_t i = 0; i < bytes; i += 1024) block[i] = 1;
    std::free(const_cast<char *>(block));
#endif
}

/// What `step` returns, from a process of its own; `mebibytes`: the most it held beside what there was.
template <class Result, class Step> Result apart(Step step, double &mebibytes) {
    struct {
        Result result;
        double mebibytes;
    } answer;
    int ends[2];
    if (pipe(ends) != 0) std::exit(1);
    const pid_t child = fork();
    if (child == 0) {
        const double before = resident_mebibytes();
        const plm::ThreadsScope threads(n_threads);
        answer.result = step();
        answer.mebibytes = peak_mebibytes() - before;
        _exit(write(ends[1], &answer, sizeof answer) == sizeof answer ? 0 : 1);
    }
    close(ends[1]);
    const bool told = child > 0 && read(ends[0], &answer, sizeof answer) == sizeof answer;
    close(ends[0]);
    int status = 1;
    if (child > 0) waitpid(child, &status, 0);
    if (!told || status != 0) std::exit(1);
    mebibytes = answer.mebibytes;
    return answer.result;
}
