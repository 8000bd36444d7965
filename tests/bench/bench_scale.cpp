// What the phases of a set-up cost against the size of the structure: cracked cantilevers of bricks, a solid
// block (4:2:1) and a plate of three bricks' thickness, contact pairs growing with the cracked section.
// Seconds of the processor and MiB. Not a test: prints Markdown.
//
//     bench_scale solid|plate [--space] DOFS...     (--space: the contact space, too, with all its pairs)
//
// Each size runs in a process of its own, so that the most memory it ever held is its own.
#include "space/memory_estimate.hpp"
#include "space/space.hpp"
#include "structure/eigs.hpp"
#include "structure/matrix_input.hpp"
#include "structure/solver/make_factor.hpp"
#include "structure/solver/ordering.hpp"
extern "C" {
#include "cracked_plate.h"
}
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <memory>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace {

constexpr int n_modes = 30;

double processor_seconds() {
    timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

template <class Step> double seconds_of(Step step) {
    const double begin = processor_seconds();
    step();
    return processor_seconds() - begin;
}

double peak_mebibytes() {
    rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<double>(usage.ru_maxrss) / 1024;
}

/// About so many DOFs, the crack over half of the section at mid length.
cracked_plate_params cantilever(bool solid, double dofs) {
    cracked_plate_params p;
    cracked_plate_paper(&p);
    p.n_loads = 0;
    const double nodes = dofs / 3, side = solid ? std::cbrt(nodes / 8) : std::sqrt(nodes / 8);
    p.nz = solid ? static_cast<std::int32_t>(side) : 3;
    p.ny = static_cast<std::int32_t>(solid ? 2 * side : side);
    p.nx = static_cast<std::int32_t>(nodes / ((p.ny + 1.0) * (p.nz + 1)));
    p.length = p.nx, p.width = p.ny, p.thickness = p.nz;
    p.crack_position = 0.5 * p.length;
    p.crack_rows = p.ny / 2;
    return p;
}

plm::ModelInput input_of(const scene &s) {
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

/// The lowest modes as any shift-invert code would compute them, and what they are made of.
struct Modal {
    double analysis, factor, solve[4], modes, count, highest;
    plm::FactorEstimate estimate;
};

Modal measure(const plm::SparseMatrix &k, const plm::SparseMatrix &m) {
    Modal t;
    plm::Solver solver;
    solver.orders = std::make_shared<plm::KeptOrders>();
    t.analysis = seconds_of([&] { t.estimate = *plm::estimate_factor(k, solver); });
    std::unique_ptr<plm::Factor> factor;
    t.factor = seconds_of([&] { factor = plm::make_factor(k, solver); });
    const std::int64_t widths[] = {1, 8, 32, 64};
    for (int i = 0; i < 4; ++i) {
        plm::Matrix x(k.cols, widths[i]);
        for (std::int64_t j = 0; j < k.cols * widths[i]; ++j) x.data()[j] = std::sin(static_cast<double>(j));
        t.solve[i] = seconds_of([&] { factor->solve(x); }) / static_cast<double>(widths[i]);
    }
    plm::EigenPairs pairs;
    t.modes = seconds_of([&] { pairs = plm::lowest_eigenpairs(k, m, *factor, 0, n_modes); });
    t.highest = std::sqrt(pairs.values.back());
    factor.reset();
    t.count =
        seconds_of([&] { plm::count_negative(plm::add(1, k, -1.01 * pairs.values.back(), m), solver); });
    return t;
}

void print_row(bool solid, double dofs, bool with_space) {
    const cracked_plate_params p = cantilever(solid, dofs);
    scene *s = nullptr;
    if (cracked_plate_create(&p, &s) != SCENE_OK) std::exit(1);
    plm::ModelInput input = input_of(*s);
    const plm::GapSize gap{s->n_pairs, plm::Contact::n_directions};
    std::int64_t n;
    Modal t;
    {
        const auto free_matrix = [&](const plm::MatrixInput &matrix) {
            plm::vector<std::int64_t> keep(s->n_dof, 0);
            for (std::int64_t dof : input.fixed) keep[dof] = -1;
            n = 0;
            for (std::int64_t &k : keep)
                if (k == 0) k = n++;
            return plm::submatrix(matrix.to_sparse(), keep, n, keep, n);
        };
        t = measure(free_matrix(*input.stiffness), free_matrix(*input.mass));
    }
    const double modal = t.analysis + t.factor + t.modes;
    std::printf("| %lld | %lld | %.3g | %.3g | %.2f | %.2f | %.4f, %.4f, %.4f, %.4f | %.2f | %.2f |",
                static_cast<long long>(n), static_cast<long long>(gap.n_pairs), t.estimate.nonzeros,
                t.estimate.flops, t.analysis, t.factor, t.solve[0], t.solve[1], t.solve[2], t.solve[3],
                t.modes, t.count);
    if (with_space) {
        std::shared_ptr<const plm::Model> model;
        const double build = seconds_of([&] {
            model = std::make_shared<const plm::Model>(input, plm::SpaceOptions(), nullptr, plm::Watch());
        });
        const double space =
            seconds_of([&] { plm::make_contact_space(model, 0.5 * t.highest, n_modes, plm::Watch()); });
        const double told = plm::estimate_memory(input, plm::SpaceOptions(), nullptr).peak();
        std::printf(" %.2f | %.2f | %.2f | %.0f |", build, space, (build + space) / modal, told / (1 << 20));
    }
    std::printf(" %.0f |\n", peak_mebibytes());
    scene_destroy(&s);
}

} // namespace

int main(int n_arguments, char **argument) {
    const bool solid = n_arguments > 1 && std::strcmp(argument[1], "solid") == 0;
    const bool with_space = n_arguments > 2 && std::strcmp(argument[2], "--space") == 0;
    const int first = with_space ? 3 : 2;
    if (n_arguments <= first || (!solid && std::strcmp(argument[1], "plate") != 0)) {
        std::fprintf(stderr, "usage: bench_scale solid|plate [--space] DOFS...\n");
        return 2;
    }
    std::printf(
        "| DOFs | pairs | nnz(L) | flops | ordering, analysis | factor with its analysis | a solve in blocks "
        "of 1, 8, 32, 64 | %d modes | count |%s peak MiB |\n|--%s\n",
        n_modes, with_space ? " model | contact space | set-up / modal analysis | MiB told before |" : "",
        with_space ? "|--|--|--|--|--|--|--|--|--|--|--|--|--|" : "|--|--|--|--|--|--|--|--|--|");
    std::fflush(stdout);
    for (int i = first; i < n_arguments; ++i) {
        const pid_t child = fork();
        if (child == 0) {
            print_row(solid, std::atof(argument[i]), with_space);
            return 0;
        }
        int status = 1;
        if (child < 0 || waitpid(child, &status, 0) != child || status != 0) return 1;
    }
    return 0;
}
