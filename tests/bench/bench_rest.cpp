// Modes at rest of a bolted beam, two leaves pressed together, nearly all pairs closed: the library's way
// from matrices to modes (as plm_model_get_modes) against one shift-invert run for as many modes by the same
// factorization and eigensolver, with the closed pairs as springs in the stiffness. Seconds of the processor,
// the medians of three runs in turn, each in memory touched before, and MiB at most beside the matrices
// handed over. Not a test: prints Markdown.
//
//     bench_rest [DOFS]
#include "apart.hpp"
#include "median.hpp"
#include "space/spaceless.hpp"
#include "structure/eigs.hpp"
#include "structure/matrix_input.hpp"
#include "structure/solver/make_factor.hpp"
#include "structure/solver/ordering.hpp"
extern "C" {
#include "cracked_plate.h"
}
#include <vector>

namespace {

constexpr int n_modes = 30, nodes_across = 6;

/// Along y, clamped at y = 0; the leaves lie along x, apart over half of the length, and are pressed together
/// by bolts, a pair of forces a row in ten.
struct Beam {
    scene *s = nullptr;
    plm::ModelInput input;

    explicit Beam(double dofs) {
        cracked_plate_params p;
        cracked_plate_paper(&p);
        p.n_loads = 0;
        p.nx = static_cast<std::int32_t>(std::sqrt(dofs / 3 / nodes_across / 6));
        p.nz = nodes_across - 1;
        p.ny = static_cast<std::int32_t>(dofs / 3 / nodes_across / (p.nx + 1)) - 1;
        p.crack_rows = 600 / nodes_across;
        p.length = p.nx, p.width = p.ny, p.thickness = p.nz;
        p.crack_position = 0.5 * p.length;
        p.contact_stiffness = 1e5;
        if (cracked_plate_create(&p, &s) != SCENE_OK) std::exit(1);
        input = input_of(*s);
        const auto at = [&](int x, int y, int z) { return (x * (p.ny + 1) + y) * (p.nz + 1) + z; };
        input.fixed.clear();
        for (int x = 0; x <= p.nx; ++x)
            for (int z = 0; z <= p.nz; ++z)
                for (int c = 0; c < 3; ++c) input.fixed.push_back(3 * at(x, 0, z) + c);
        input.preload.assign(static_cast<std::size_t>(s->n_dof), 0.0);
        for (int y = p.ny + 1 - p.crack_rows; y <= p.ny; ++y)
            for (int z = 0; z <= p.nz; ++z) {
                const double force = y % 10 == 5 ? 100 : 10; // bolts, and the washers between them
                input.preload[static_cast<std::size_t>(3 * at(0, y, z))] = force;
                input.preload[static_cast<std::size_t>(3 * at(p.nx, y, z))] = -force;
            }
    }
};

struct Found {
    double seconds, frequency[n_modes];
    std::int64_t n_closed;
};

Found modes_at_rest(const plm::ModelInput &input) {
    Found found{};
    found.seconds = seconds_of([&] {
        const auto model =
            std::make_shared<const plm::Model>(input, plm::SpaceOptions(), nullptr, plm::Watch());
        const auto without = plm::Spaceless::if_worth(model, n_modes, plm::Watch());
        const auto rest = without->rest();
        found.n_closed = rest->states.n_closed();
        const plm::StructureModes modes = without->modes(rest->states, n_modes);
        for (int j = 0; j < n_modes; ++j) found.frequency[j] = std::sqrt(modes.values[j]) / (2 * M_PI);
    });
    return found;
}

Found shift_invert(const plm::ModelInput &input) {
    Found found{};
    const plm::SparseMatrix k = free_matrix(input, *input.stiffness), m = free_matrix(input, *input.mass);
    plm::vector<std::int64_t> keep = free_numbers(input);
    plm::vector<std::int64_t> row, column;
    plm::vector<double> value;
    for (std::size_t a = 0; a < input.gap_row.size(); ++a)
        for (std::size_t b = 0; b < input.gap_row.size(); ++b) {
            if (input.gap_row[a] != input.gap_row[b]) continue;
            row.push_back(keep[static_cast<std::size_t>(input.gap_dof[a])]);
            column.push_back(keep[static_cast<std::size_t>(input.gap_dof[b])]);
            value.push_back(input.contact.stiffness[input.gap_row[a]] * input.gap_coefficient[a] *
                            input.gap_coefficient[b]);
        }
    found.seconds = seconds_of([&] {
        const plm::SparseMatrix closed =
            plm::add(1, k, 1, plm::from_triplets(k.rows, k.cols, row, column, value));
        plm::Solver solver;
        const auto factor = plm::make_factor(closed, solver);
        const plm::EigenPairs pairs = plm::lowest_eigenpairs(closed, m, *factor, 0, n_modes);
        for (int j = 0; j < n_modes; ++j) found.frequency[j] = std::sqrt(pairs.values[j]) / (2 * M_PI);
    });
    return found;
}

} // namespace

int main(int n_arguments, char **argument) {
    const Beam beam(n_arguments > 1 ? std::atof(argument[1]) : 120000);
    double its_own, mebibytes, none;
    const Found reference = apart<Found>([&] { return shift_invert(beam.input); }, its_own);
    const Found found = apart<Found>([&] { return modes_at_rest(beam.input); }, mebibytes);
    std::vector<double> of_reference, of_rest, ratio;
    for (int run = 0; run < 3; ++run) {
        const auto seconds = [&](Found (*way)(const plm::ModelInput &)) {
            return apart<double>(
                [&] {
                    warm_memory(1.2 * mebibytes);
                    return way(beam.input).seconds;
                },
                none);
        };
        of_reference.push_back(seconds(shift_invert));
        of_rest.push_back(seconds(modes_at_rest));
        ratio.push_back(of_rest.back() / of_reference.back());
    }
    double differ = 0;
    for (int j = 0; j < n_modes; ++j)
        differ = std::max(differ, std::abs(found.frequency[j] / reference.frequency[j] - 1));
    std::printf(
        "| DOFs | pairs | closed at rest | shift-invert, all closed, %d modes | MiB | modes at rest | MiB | "
        "ratio | frequencies differ by |\n|--|--|--|--|--|--|--|--|--|\n",
        n_modes);
    std::printf("| %lld | %lld | %lld | %.2f | %.0f | %.2f | %.0f | %.2f | %.1e |\n",
                static_cast<long long>(beam.input.n_dof - static_cast<std::int64_t>(beam.input.fixed.size())),
                static_cast<long long>(beam.s->n_pairs), static_cast<long long>(found.n_closed),
                median(of_reference), its_own, median(of_rest), mebibytes, median(ratio), differ);
    return 0;
}
