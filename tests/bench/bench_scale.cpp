// What the phases of a set-up cost against the size of the structure: cracked cantilevers of bricks, a solid
// block (4:2:1) and a plate of three bricks' thickness, contact pairs growing with the cracked section or as
// many as are asked for. Seconds of the processor, or with several threads of the clock on the wall, and MiB.
// Not a test: prints Markdown.
//
//     bench_scale solid|plate [--threads N] [--pairs Z] [--space] DOFS...
//
// --space: the contact space, too, with all its pairs. Modal analysis and set-up of each size run in
// processes of their own; the memory is what they hold at most beside the matrices handed over.
#include "apart.hpp"
#include "cantilever.h"
#include "space/memory_estimate.hpp"
#include "space/space.hpp"
#include "structure/eigs.hpp"
#include "structure/solver/make_factor.hpp"
#include "structure/solver/ordering.hpp"
#include <cstring>

namespace {

constexpr int n_modes = 30;

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
    t.count = seconds_of([&] { plm::count_negative({k, -1.01 * pairs.values.back(), m}, solver); });
    return t;
}

Modal modal_analysis(const plm::ModelInput &input) {
    return measure(free_matrix(input, *input.stiffness), free_matrix(input, *input.mass));
}

/// Matrices to the contact space of just below half of the highest mode: its modes reach far enough.
struct SetUp {
    double model, space;
};
SetUp set_up(const plm::ModelInput &input, double highest) {
    SetUp t;
    std::shared_ptr<const plm::Model> model;
    t.model = seconds_of([&] {
        model = std::make_shared<const plm::Model>(input, plm::SpaceOptions(), nullptr, plm::Watch());
    });
    t.space = seconds_of([&] { plm::make_contact_space(model, 0.499 * highest, n_modes, plm::Watch()); });
    return t;
}

void print_row(bool solid, double dofs, double pairs, bool with_space) {
    const cracked_plate_params p = cantilever(solid, dofs, pairs);
    scene *s = nullptr;
    if (cracked_plate_create(&p, &s) != SCENE_OK) std::exit(1);
    const plm::ModelInput input = input_of(*s);
    double mebibytes;
    const Modal t = apart<Modal>([&] { return modal_analysis(input); }, mebibytes);
    const double modal = t.analysis + t.factor + t.modes;
    std::printf("| %lld | %lld | %.3g | %.3g | %.2f | %.2f | %.4f, %.4f, %.4f, %.4f | %.2f | %.2f |",
                static_cast<long long>(s->n_dof - s->n_fixed), static_cast<long long>(s->n_pairs),
                t.estimate.nonzeros, t.estimate.flops, t.analysis, t.factor, t.solve[0], t.solve[1],
                t.solve[2], t.solve[3], t.modes, t.count);
    if (with_space) {
        double its_own;
        const double told = apart<double>(
            [&] { return plm::estimate_memory(input, plm::SpaceOptions(), nullptr).peak() / (1 << 20); },
            its_own);
        const SetUp u = apart<SetUp>([&] { return set_up(input, t.highest); }, mebibytes);
        std::printf(" %.2f | %.2f | %.2f | %.2f | %.0f |", u.model, u.space, u.model + u.space,
                    (u.model + u.space) / modal, told);
    }
    std::printf(" %.0f |\n", mebibytes);
    std::fflush(stdout);
    scene_destroy(&s);
}

} // namespace

int main(int n_arguments, char **argument) {
    const bool solid = n_arguments > 1 && std::strcmp(argument[1], "solid") == 0;
    bool with_space = false,
         asked_well = solid || (n_arguments > 1 && std::strcmp(argument[1], "plate") == 0);
    int first = 2;
    double pairs = 0;
    for (; first < n_arguments && argument[first][0] == '-'; ++first)
        if (std::strcmp(argument[first], "--space") == 0)
            with_space = true;
        else if (std::strcmp(argument[first], "--threads") == 0 && first + 1 < n_arguments)
            n_threads = std::atoi(argument[++first]);
        else if (std::strcmp(argument[first], "--pairs") == 0 && first + 1 < n_arguments)
            pairs = std::atof(argument[++first]);
        else
            asked_well = false;
    if (first >= n_arguments || !asked_well || n_threads < 1) {
        std::fprintf(stderr, "usage: bench_scale solid|plate [--threads N] [--pairs Z] [--space] DOFS...\n");
        return 2;
    }
    std::printf(
        "| DOFs | pairs | nnz(L) | flops | ordering, analysis | factor with its analysis | a solve in blocks "
        "of 1, 8, 32, 64 | %d modes | count |%s peak MiB |\n|--%s\n",
        n_modes,
        with_space ? " model | contact space | set-up | set-up / modal analysis | MiB told before |" : "",
        with_space ? "|--|--|--|--|--|--|--|--|--|--|--|--|--|--|" : "|--|--|--|--|--|--|--|--|--|");
    std::fflush(stdout);
    for (int i = first; i < n_arguments; ++i) print_row(solid, std::atof(argument[i]), pairs, with_space);
    return 0;
}
