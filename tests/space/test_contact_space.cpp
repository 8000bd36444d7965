// The contact space against the whole structure: receptances, vectors, and what making it takes.
#include "linalg/lapack.hpp"
#include "linalg/memory_count.hpp"
#include "space/space.hpp"
#include "structure/solver/make_factor.hpp"
#include "support/spring_models.hpp"
#include "support/test.hpp"

using plm::Field;
using plm::Matrix;

namespace {

using SpacePtr = std::shared_ptr<const plm::Space>;

std::shared_ptr<const plm::MatrixInput> lower(std::int64_t n, const std::vector<std::int64_t> &i,
                                              const std::vector<std::int64_t> &j,
                                              const std::vector<double> &v) {
    plm::MatrixFormat f;
    f.n = n, f.nnz = static_cast<std::int64_t>(v.size());
    f.storage = plm::storage::triplets, f.part = plm::part::lower;
    return std::make_shared<const plm::MatrixInput>(f, i.data(), j.data(), v.data());
}

// A lattice of unit masses and springs, nx wide and ny high, its left side held; `held`: each node's spring
// to ground. A pair at every node of the lowest rows.
plm::ModelInput lattice(std::int64_t nx, std::int64_t ny, std::int64_t n_pairs, double held = 0) {
    const std::int64_t n = nx * ny;
    std::vector<std::int64_t> mass_at, i, j;
    std::vector<double> mass(static_cast<std::size_t>(n), 1.0), v;
    const auto spring = [&](std::int64_t a, std::int64_t b) {
        for (std::int64_t d : {a, b}) i.push_back(d), j.push_back(d), v.push_back(1);
        i.push_back(std::max(a, b)), j.push_back(std::min(a, b)), v.push_back(-1);
    };
    for (std::int64_t a = 0; a < n; ++a) {
        mass_at.push_back(a);
        if (a % nx + 1 < nx) spring(a, a + 1);
        if (a + nx < n) spring(a, a + nx);
        if (a % nx == 0 || held > 0)
            i.push_back(a), j.push_back(a), v.push_back(a % nx == 0 && held == 0 ? 1 : held);
    }
    plm::ModelInput in;
    in.n_dof = n;
    in.mass = lower(n, mass_at, mass_at, mass);
    in.stiffness = lower(n, i, j, v);
    for (std::int64_t p = 0; p < n_pairs; ++p) {
        in.gap_row.push_back(p), in.gap_dof.push_back(p), in.gap_coefficient.push_back(1);
        in.contact.stiffness.push_back(10);
        in.contact.initial_gap.push_back(0);
    }
    in.preload.assign(static_cast<std::size_t>(n), 0.0);
    in.preload[static_cast<std::size_t>(n / 2)] = 0.01;
    in.excitation[1].real.assign(static_cast<std::size_t>(n), 0.0);
    in.excitation[1].real[static_cast<std::size_t>(n - 1)] = 1;
    return in;
}

SpacePtr space_of(const std::shared_ptr<const plm::Model> &model, double highest,
                  SpacePtr previous = nullptr) {
    return plm::make_contact_space(model, highest, 10, plm::Watch(), std::move(previous));
}

// B (K - omega^2 M)^-1 B^T, by the whole matrices and in the space; the largest difference, relative to the
// largest static one.
double receptance_error(const plm::Space &space, double omega) {
    const plm::Model &model = *space.model;
    const auto of = [&](double frequency) {
        Matrix a =
            to_dense(plm::add(1, model.matrices().stiffness, -frequency * frequency, model.matrices().mass));
        Field x = model.gap_rows().columns();
        plm::RealLu lu;
        lu.factor(a);
        lu.solve(x.in_core().data(), x.cols(), x.rows());
        return model.gap_rows().of(x);
    };
    const Matrix want = of(omega), scale = of(0);
    Matrix scaled = space.gap;
    for (std::int64_t j = 0; j < space.size(); ++j)
        for (std::int64_t i = 0; i < scaled.rows(); ++i)
            scaled(i, j) /= space.lambda[j] - space.mass(j) * omega * omega;
    const Matrix got = plm::product('N', 'T', scaled, space.gap);
    double worst = 0, largest = 0;
    for (std::int64_t k = 0; k < want.rows() * want.cols(); ++k) {
        worst = std::max(worst, std::abs(want.data()[k] - got.data()[k]));
        largest = std::max(largest, std::abs(scale.data()[k]));
    }
    return worst / largest;
}

// What is asked for holds for a few loads; a pair alone may be some times worse.
void receptances_are_those_of_the_structure(void **) {
    const auto model = test::build(lattice(30, 20, 60));
    for (double highest : {0.15, 0.5, 1.0}) {
        const SpacePtr space = space_of(model, highest);
        assert_true(space->error_estimate <= 1e-7);
        assert_true(below(receptance_error(*space, highest), 1e-6));
        assert_true(below(receptance_error(*space, 0), 1e-11)); // exact in statics
        assert_true(space->size() - space->n_exact_modes < 2 * model->n_pairs());
    }
}

void a_looser_tolerance_makes_a_smaller_space(void **) {
    const plm::ModelInput in = lattice(30, 20, 60);
    plm::SpaceOptions loose;
    loose.tolerance = 1e-4;
    const auto model = std::make_shared<const plm::Model>(in, loose, nullptr, plm::Watch());
    const SpacePtr space = space_of(model, 1.0), fine = space_of(test::build(in), 1.0);
    assert_true(space->size() < fine->size());
    assert_true(fine->error_estimate < space->error_estimate && space->error_estimate <= 1e-4);
    assert_true(below(receptance_error(*space, 1.0), 1e-3));
}

// A load on one node, whose own directions are fast, does not make those of all the pairs be followed as far.
void a_load_asks_for_its_own_directions(void **) {
    plm::ModelInput in = lattice(30, 20, 60);
    const SpacePtr loaded = space_of(test::build(in), 1.0);
    in.excitation.clear();
    const SpacePtr alone = space_of(test::build(in), 1.0);
    assert_true(loaded->error_estimate <= 1e-7 && alone->error_estimate <= 1e-7);
    assert_in_range(loaded->size(), alone->size() + 1, alone->size() + 8);
}

double largest_of(const Matrix &a) {
    double largest = 0;
    for (std::int64_t k = 0; k < a.rows() * a.cols(); ++k) largest = std::max(largest, std::abs(a.data()[k]));
    return largest;
}

Matrix difference(Matrix a, const Matrix &b) {
    for (std::int64_t k = 0; k < a.rows() * a.cols(); ++k) a.data()[k] -= b.data()[k];
    return a;
}

// V^T M V = 1 and V^T K V = diag(lambda) of the recovered vectors; the gap and the loads are B V and V^T F.
// Directions of which others have all but 1e-9 of the energy keep seven digits, and matter to as many less.
void recovered_vectors_are_what_the_small_matrices_say(void **) {
    const auto model = test::build(lattice(30, 20, 60));
    const SpacePtr space = space_of(model, 0.8);
    const Field v = all_columns(space->vectors);
    Matrix m = gram(v, model->mass_times(v)), k = gram(v, model->stiffness_times(v));
    for (std::int64_t j = 0; j < space->size(); ++j) m(j, j) -= 1, k(j, j) -= space->lambda[j];
    assert_true(below(largest_of(m), 1e-6));
    assert_true(below(largest_of(k) / space->lambda.back(), 1e-6));
    assert_true(below(largest_of(difference(model->gap_rows().of(v), space->gap)), 1e-11));
    const Matrix load = gram(v, model->excitation().at(1).real);
    for (std::int64_t j = 0; j < space->size(); ++j)
        assert_true(std::abs(load(j, 0) - space->excitation.at(1).real[j]) < 1e-11);
    const Matrix works = gram(space->vectors, model->mass_times(v.columns(40, 70)));
    assert_true(below(largest_of(difference(works, gram(v, model->mass_times(v.columns(40, 70))))), 1e-9));
}

// The library's own factorization as the host's, to count what is solved for.
int factor_counted(std::int64_t n, const std::int64_t *ptr, const std::int64_t *row, const double *val, int,
                   void **handle, void *) {
    plm::vector<std::int64_t> i, j;
    plm::vector<double> v;
    for (std::int64_t c = 0; c < n; ++c)
        for (std::int64_t p = ptr[c]; p < ptr[c + 1]; ++p) {
            i.push_back(row[p]), j.push_back(c), v.push_back(val[p]);
            if (row[p] != c) i.push_back(c), j.push_back(row[p]), v.push_back(val[p]);
        }
    *handle = plm::make_factor(plm::from_triplets(n, n, i, j, v), plm::Solver()).release();
    return 0;
}
long solutions = 0;
int solve_counted(void *handle, std::int64_t nrhs, double *x, std::int64_t ldx, void *) {
    solutions += static_cast<long>(nrhs);
    static_cast<plm::Factor *>(handle)->solve(x, nrhs, ldx);
    return 0;
}
void release_counted(void *handle, void *) {
    delete static_cast<plm::Factor *>(handle);
}

// The responses to contact forces are solved for once a model, by its first space; another one that is exact
// in statics takes none of it again, and one for higher frequencies the slow directions alone.
void contact_forces_are_solved_for_once(void **) {
    constexpr std::int64_t n_pairs = 200;
    plm::HostSolver host;
    host.factor = factor_counted, host.solve = solve_counted, host.release = release_counted;
    plm::SpaceOptions options;
    options.verify_counts = false;
    const auto model =
        std::make_shared<const plm::Model>(lattice(200, 10, n_pairs), options, &host, plm::Watch());
    assert_true(solutions < n_pairs); // k_n is given: some tell the local stiffness
    const SpacePtr first = space_of(model, 0);
    assert_true(solutions >= 2 * n_pairs);
    long before = solutions;
    space_of(model, 0);
    assert_true(solutions - before < 10);
    before = solutions;
    const SpacePtr second = space_of(model, 0.02, first);
    assert_true(second->n_exact_modes == first->n_exact_modes && second->error_estimate <= 1e-7);
    assert_true(solutions - before < n_pairs);
}

// The count there is one of rounding: with the mode or without it.
void a_cutoff_may_fall_on_a_mode(void **) {
    const auto model = test::build(lattice(40, 12, 6));
    const double factor = model->space_options().cutoff_factor;
    const auto modes = model->exact_modes_up_to(12, 0, plm::Watch());
    const std::vector<double> values(modes->values.begin(), modes->values.begin() + 10);
    for (double value : values)
        for (double aside : {-1e-11, -1e-13, 0.0, 1e-13, 1e-11})
            assert_true(space_of(model, std::sqrt(value) * (1 + aside) / factor)->counts_verified);
}

// No array of as many rows as the structure and as many columns as there are pairs exists at any time.
void nothing_of_the_size_of_rows_times_pairs_is_ever_held(void **) {
    constexpr std::int64_t nx = 1000, ny = 40, n_pairs = 1000;
    constexpr std::int64_t rows_times_pairs = 8 * nx * ny * n_pairs;
    const plm::ModelInput in = lattice(nx, ny, n_pairs, 0.01);
    std::int64_t peak = 0, held = 0, before = 0;
    {
        const plm::CountingScope scope;
        const auto model = test::build(in);
        before = scope.held();
        const SpacePtr space = space_of(model, 0.015);
        held = scope.held() - before;
        peak = scope.peak();
        assert_true(space->size() > n_pairs);
    }
    assert_true(peak < rows_times_pairs);
    assert_true(held < rows_times_pairs / 2);
}

// Chains that do not touch each other, each with the same frequencies: far more copies than a block of the
// eigensolver has columns.
plm::ModelInput equal_chains(std::int64_t count, std::int64_t length) {
    plm::ModelInput in = lattice(length, count, 1);
    std::vector<std::int64_t> i, j;
    std::vector<double> v;
    for (std::int64_t a = 0; a < count * length; ++a) {
        const bool last = a % length + 1 == length;
        i.push_back(a), j.push_back(a), v.push_back(last ? 1 : 2);
        if (!last) i.push_back(a + 1), j.push_back(a), v.push_back(-1);
    }
    in.stiffness = lower(in.n_dof, i, j, v);
    return in;
}

// The modes that a model has at hand are counted by a space with a highest frequency; one without looks for
// missed copies by itself.
void copies_of_a_frequency_are_all_there(void **) {
    constexpr std::int64_t chains = 20, length = 200;
    const auto model = test::build(equal_chains(chains, length));
    const auto value = [](double k) { return 2 - 2 * std::cos((2 * k - 1) * M_PI / (2 * length + 1)); };
    for (double highest : {0.0, 0.4 * std::sqrt(value(2))}) {
        const SpacePtr space = space_of(model, highest);
        assert_true(space->counts_verified == (highest > 0));
        assert_true(space->n_exact_modes >= chains);
        for (std::int64_t j = 0; j < chains; ++j)
            assert_true(std::abs(space->lambda[j] / value(1) - 1) < 1e-9);
    }
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(receptances_are_those_of_the_structure),
        cmocka_unit_test(a_looser_tolerance_makes_a_smaller_space),
        cmocka_unit_test(a_load_asks_for_its_own_directions),
        cmocka_unit_test(recovered_vectors_are_what_the_small_matrices_say),
        cmocka_unit_test(contact_forces_are_solved_for_once),
        cmocka_unit_test(a_cutoff_may_fall_on_a_mode),
        cmocka_unit_test(copies_of_a_frequency_are_all_there),
        cmocka_unit_test(nothing_of_the_size_of_rows_times_pairs_is_ever_held),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
