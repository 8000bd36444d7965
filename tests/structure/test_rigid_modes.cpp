// Structures that are loose while their contacts are open, and stiffness matrices that are none.
#include "linalg/support.hpp"
#include "space/audit.hpp"
#include "support/caught.hpp"
#include "support/spring_models.hpp"
#include "support/test.hpp"
#include <cstring>
#include <ctime>

using plm::ModelInput;

namespace {

// n_bodies free chains of four masses each, side by side.
ModelInput loose_chains(int n_bodies, double k, double m) {
    test::Dense stiffness = test::diagonal(4 * n_bodies, 0);
    const test::Dense one = test::free_chain(4, k);
    for (int b = 0; b < n_bodies; ++b)
        for (int i = 0; i < 4; ++i)
            for (int j = 0; j < 4; ++j) stiffness[4 * b + i][4 * b + j] = one[i][j];
    return test::input(test::diagonal(4 * n_bodies, m), stiffness);
}

double orthonormality_error(const plm::Model &model) {
    const plm::Matrix &r = model.rigid_modes().in_core();
    const plm::Matrix gram = product('T', 'N', r, multiply(model.matrices().mass, r));
    double worst = 0;
    for (std::int64_t i = 0; i < gram.rows(); ++i)
        for (std::int64_t j = 0; j < gram.cols(); ++j)
            worst = std::max(worst, std::abs(gram(i, j) - (i == j)));
    return worst;
}

double largest_force(const plm::Model &model) { // |K r| over the stiffness scale
    const plm::Matrix f = multiply(model.matrices().stiffness, model.rigid_modes().in_core());
    double worst = 0;
    for (std::int64_t i = 0; i < f.rows() * f.cols(); ++i) worst = std::max(worst, std::abs(f.data()[i]));
    return worst / norm_inf(model.matrices().stiffness);
}

void every_loose_body_has_its_mode(void **) {
    for (int bodies : {1, 2, 5, 24})
        for (double k : {1e-6, 1.0, 1e12}) {
            const auto m = test::build(loose_chains(bodies, k, 3));
            assert_int_equal(m->n_rigid(), bodies);
            assert_true(below(orthonormality_error(*m), 1e-9));
            assert_true(below(largest_force(*m), 1e-9));
            const double flexible = k / 3 * (2 - std::sqrt(2.0)); // (k/m) 4 sin^2(pi / 8)
            assert_true(close_to(m->shift(), 1e-2 * flexible, 1e-6));
        }
}

// A row of zeros in K beside a chain of a hundred, held at one end: what a vector of the search holds of the
// chain by rounding is no stiffness.
void a_free_mass_beside_a_structure_is_rigid(void **) {
    for (double mass : {1e-3, 1.0, 1e3}) {
        const int n = 100;
        test::Dense k = test::free_chain(n + 1, 1e7), m = test::diagonal(n + 1, 1);
        k[0][0] += 1e7;
        k[n - 1][n - 1] = 1e7, k[n][n] = k[n][n - 1] = k[n - 1][n] = 0;
        m[n][n] = mass;
        const auto model = test::build(test::input(m, k));
        assert_int_equal(model->n_rigid(), 1);
        assert_true(below(model->uncertainty(), 1e-9));
        const plm::StructureModes modes = model->lowest_modes(6);
        for (int p = 1; p < 6; ++p) {
            const double lambda = 4e7 * std::pow(std::sin((2 * p - 1) * M_PI / (4 * n + 2)), 2);
            assert_true(close_to(modes.values[static_cast<std::size_t>(p)], lambda, 1e-9));
        }
    }
}

// A held chain, a single mass and a body of three masses, and so few DOFs that all modes are looked at at
// once: beside the highest, a Ritz value of the mass has no digits, though its own energy is 0.
void a_free_mass_beside_a_small_free_body_is_rigid(void **) {
    test::Random random(1);
    for (int of = 0; of < 40; ++of) {
        test::Dense k = test::diagonal(9, 0), m = test::diagonal(9, 1);
        const auto tie = [&](int a, int b) {
            const double s = 1e4 * (1.2 + random());
            k[a][a] += s, k[b][b] += s, k[a][b] -= s, k[b][a] -= s;
        };
        for (int i : {0, 1, 2, 3, 6, 7}) tie(i, i + 1);
        k[0][0] += 7e3;
        for (int i = 0; i < 9; ++i) m[i][i] = 1 + 0.5 * random();
        const auto model = test::build(test::input(m, k));
        assert_int_equal(model->n_rigid(), 2);
        assert_true(below(model->uncertainty(), 1e-9));
        double trace = 0; // of M^-1 K
        for (int i = 0; i < 9; ++i) trace += k[i][i] / m[i][i];
        for (double v : model->lowest_modes(9).values) trace -= v;
        assert_true(std::abs(trace) < 1e-9 * k[1][1]);
    }
}

// A free chain with masses of 20 on springs so soft that their frequency is down to 1e-5 of the next one: the
// modes of the chain are not worse for it.
void soft_suspensions_leave_the_elastic_modes_their_digits(void **) {
    const int n = 100, at[3] = {0, 40, 80};
    for (double hz : {3.0, 0.3, 0.1, 0.01, 0.001}) {
        const double soft = 20 * std::pow(2 * M_PI * hz, 2);
        test::Dense k = test::diagonal(n + 3, 0), m = test::diagonal(n + 3, 1);
        const test::Dense chain = test::free_chain(n, 1e9);
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < n; ++j) k[i][j] = chain[i][j];
        for (int a = 0; a < 3; ++a) {
            k[at[a]][at[a]] += soft, k[n + a][n + a] = soft, k[n + a][at[a]] = k[at[a]][n + a] = -soft;
            m[n + a][n + a] = 20;
        }
        const auto model = test::build(test::input(m, k));
        assert_int_equal(model->n_rigid(), 1);
        const plm::StructureModes modes = model->lowest_modes(12);
        // two of the masses against each other, and all against the chain, whose bending is nothing
        const double below_all = soft / 20, all = soft * (1.0 / 20 + 3.0 / n), certain = model->uncertainty();
        assert_true(close_to(modes.values[1], below_all, 1e-3 + certain));
        assert_true(close_to(modes.values[2], below_all, 1e-3 + certain));
        assert_true(close_to(modes.values[3], all, 1e-3 + certain));
        for (int p = 1; p < 9; ++p) {
            const double lambda = 4e9 * std::pow(std::sin(p * M_PI / (2 * n)), 2);
            double share = 0; // of the soft springs, to first order
            for (int d : at) share += 2 * soft / n / lambda * std::pow(std::cos((d + 0.5) * p * M_PI / n), 2);
            assert_true(close_to(modes.values[static_cast<std::size_t>(p + 3)], lambda * (1 + share),
                                 1e-9 + 10 * share * share));
        }
    }
}

void rigid_motion_does_not_soften_the_contact(void **) {
    // Two loose chains meet: the elastic flexibility of a free chain of four at its end is known in closed
    // form.
    ModelInput in = loose_chains(2, 100, 3);
    test::add_pair(in, {0, 0, 0, 1, -1, 0, 0, 0}, plm::auto_stiffness);
    const auto m = test::build(in);
    double end = 0; // sum phi_end^2 / lambda over the elastic modes of one chain
    for (int p = 1; p < 4; ++p) {
        const double lambda = 100.0 / 3 * 4 * std::pow(std::sin(p * M_PI / 8), 2);
        const double phi = std::sqrt(2.0 / 4 / 3) * std::cos(p * M_PI / 8);
        end += phi * phi / lambda;
    }
    assert_true(
        close_to(m->local_stiffness(), 1 / (2 * end), 0.02)); // sigma is 1 % of the first elastic eigenvalue
    assert_true(close_to(m->contact_stiffness()[0], 10 * m->local_stiffness(), 1e-12));
}

void bodies_without_stiffness_need_a_given_one(void **) {
    ModelInput in = test::input({{2}}, {{0}});
    test::add_pair(in, {1}, 50);
    const auto m = test::build(in);
    assert_int_equal(m->n_rigid(), 1);
    assert_true(m->shift() > 0 && close_to(std::abs(m->rigid_modes().at(0, 0)), std::sqrt(0.5), 1e-12));
    in.contact.stiffness[0] = plm::auto_stiffness;
    const Caught c = caught([&] { test::build(in); });
    assert_int_equal(c.status, plm::status::argument);
    assert_true(c.argument == "stiffness" && c.index == 0 && c.says("give k_n"));
}

void massless_dofs_are_allowed_where_they_are_held(void **) {
    ModelInput in = test::input({{1, 0, 0}, {0, 0, 0}, {0, 0, 1}}, test::free_chain(3, 10));
    assert_int_equal(test::build(in)->n_rigid(), 1);
    in.stiffness = test::matrix({{10, 0, 0}, {0, 0, 0}, {0, 0, 10}});
    const Caught c = caught([&] { test::build(in); });
    assert_int_equal(c.status, plm::status::not_positive_definite);
    assert_int_equal(c.index, 1);
    assert_true(c.says("DOF 1"));
}

// A spring of 10 on either side of a rigid link, kept together by the third row.
void lagrange_multipliers_are_named(void **) {
    ModelInput in = test::input({{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 0}},
                                {{10, 0, 1, 0}, {0, 10, -1, 1}, {1, -1, 0, 0}, {0, 1, 0, 0}});
    const Caught c = caught([&] { test::build(in); });
    assert_int_equal(c.status, plm::status::not_positive_definite);
    assert_int_equal(c.index, 2);
    assert_true(c.says("2 rows") && c.says("Lagrange multipliers") && c.says("DOF 2"));
}

void loose_massless_part_is_refused(void **) {
    // DOFs 1 and 2 hang together by a spring, but on nothing, and have no mass.
    ModelInput in = test::input({{1, 0, 0}, {0, 0, 0}, {0, 0, 0}}, {{5, 0, 0}, {0, 10, -10}, {0, -10, 10}});
    assert_int_equal(caught([&] { test::build(in); }).status, plm::status::not_positive_definite);
}

void negative_stiffness_is_refused(void **) {
    ModelInput in = test::input(test::diagonal(3, 1), {{1, 2, 0}, {2, 1, 0}, {0, 0, 4}});
    const Caught c = caught([&] { test::build(in); });
    assert_int_equal(c.status, plm::status::not_positive_definite);
    assert_true(c.says("negative eigenvalue"));
}

// A host solver for one DOF that has no idea of conditioning: it divides.
int host_factor(std::int64_t n, const std::int64_t *, const std::int64_t *, const double *value, int,
                void **handle, void *) {
    if (n != 1) return 5;
    *handle = new double(*value);
    return 0;
}
int host_solve(void *handle, std::int64_t nrhs, double *x, std::int64_t ldx, void *) {
    for (std::int64_t j = 0; j < nrhs; ++j) x[j * ldx] /= *static_cast<double *>(handle);
    return 0;
}
void host_release(void *handle, void *) {
    delete static_cast<double *>(handle);
}

void singular_stiffness_shows_with_any_solver(void **) {
    const plm::HostSolver host{host_factor, host_solve, host_release, nullptr};
    ModelInput in = test::input({{2}}, {{0}});
    test::add_pair(in, {1}, 50);
    const plm::Model model(in, plm::SpaceOptions(), &host, plm::Watch());
    assert_int_equal(model.n_rigid(), 1);
}

// --- fine meshes: the first elastic eigenvalue comes near the rounding of the matrices

struct Triplets {
    std::vector<std::int32_t> i, j;
    std::vector<double> v;
    void add(int row, int column, double value) { // lower triangle
        i.push_back(std::max(row, column)), j.push_back(std::min(row, column)), v.push_back(value);
    }
    std::shared_ptr<const plm::MatrixInput> matrix(int n) const {
        plm::MatrixFormat f;
        f.n = n, f.nnz = static_cast<std::int64_t>(v.size());
        f.storage = plm::storage::triplets, f.part = plm::part::lower, f.negative_diagonal = true;
        return std::make_shared<const plm::MatrixInput>(f, i.data(), j.data(), v.data());
    }
};

struct Body {
    Triplets m, k;
    int n = 0;
    // n masses in a row, springs k; returns the first DOF
    int chain(int masses, double stiffness, double mass = 1) {
        const int first = n;
        for (int a = 0; a < masses; ++a) m.add(first + a, first + a, mass);
        for (int a = 0; a + 1 < masses; ++a) spring(first + a, first + a + 1, stiffness);
        n += masses;
        return first;
    }
    void spring(int a, int b, double stiffness) {
        k.add(a, a, stiffness), k.add(b, b, stiffness), k.add(a, b, -stiffness);
    }
    // Euler-Bernoulli elements of a free beam of length 1: deflection and rotation at every node
    void beam(int elements, double bending, double mass, double length) {
        const double h = length / elements, a = bending / (h * h * h), b = mass * h / 420;
        const double ke[4][4] = {{12, 6, -12, 6}, {6, 4, -6, 2}, {-12, -6, 12, -6}, {6, 2, -6, 4}};
        const double me[4][4] = {{156, 22, 54, -13}, {22, 4, 13, -3}, {54, 13, 156, -22}, {-13, -3, -22, 4}};
        for (int e = 0; e < elements; ++e)
            for (int r = 0; r < 4; ++r)
                for (int c = 0; c <= r; ++c) {
                    const double turn = (r % 2 ? h : 1) * (c % 2 ? h : 1);
                    k.add(2 * e + r, 2 * e + c, a * turn * ke[r][c]);
                    m.add(2 * e + r, 2 * e + c, b * turn * me[r][c]);
                }
        n = 2 * (elements + 1);
    }
    ModelInput input() const {
        ModelInput in;
        in.n_dof = n;
        in.mass = m.matrix(n), in.stiffness = k.matrix(n);
        return in;
    }
};

double first_of_chain(int n, double k) {
    return 4 * k * std::pow(std::sin(M_PI / (2 * n)), 2);
}

void a_free_chain_of_ten_thousand_masses(void **) {
    const int n = 10000;
    Body body;
    body.chain(n, 1e9);
    ModelInput in = body.input();
    std::vector<double> first(n);
    first[0] = 1;
    test::add_pair(in, first, plm::auto_stiffness);
    const auto m = test::build(in);
    assert_int_equal(m->n_rigid(), 1);
    assert_true(close_to(m->shift(), 1e-2 * first_of_chain(n, 1e9), 1e-6));
    double end = 0; // elastic flexibility of the end, sum phi^2 / lambda
    for (int p = 1; p < n; ++p) {
        const double lambda = 4e9 * std::pow(std::sin(p * M_PI / (2 * n)), 2);
        end += 2.0 / n * std::pow(std::cos(p * M_PI / (2 * n)), 2) / lambda;
    }
    assert_true(
        close_to(m->local_stiffness(), 1 / end, 0.02)); // sigma is 1 % of the first elastic eigenvalue
}

std::int64_t rigid_modes_held_by(int n, double share) {
    Body body;
    body.chain(n, 1e9);
    body.k.add(0, 0, share * 1e9);
    return test::build(body.input())->n_rigid();
}
void a_soft_support_is_one(void **) {
    for (int n : {10, 1000, 10000}) assert_int_equal(rigid_modes_held_by(n, 1e-6), 0);
    assert_int_equal(rigid_modes_held_by(10, 1e-10), 0);
}

std::int64_t rigid_modes_of_beam(int elements, double bending, double mass, double length) {
    Body body;
    body.beam(elements, bending, mass, length);
    return test::build(body.input())->n_rigid();
}
void rotations_beside_translations_in_any_units(void **) {
    for (int elements : {10, 300, 1000}) {
        assert_int_equal(rigid_modes_of_beam(elements, 175, 0.78, 1), 2);         // m, N, kg
        assert_int_equal(rigid_modes_of_beam(elements, 175e6, 0.78e-6, 1000), 2); // mm, N, t
    }
}

// Bodies of rubber and steel; two of them joined by a penalty.
std::int64_t rigid_modes_of_three(double penalty) {
    Body body;
    const int first = body.chain(50, 1), second = body.chain(80, 1e4, 5);
    body.chain(30, 1e8, 0.1);
    if (penalty > 0) body.spring(first + 49, second, penalty);
    return test::build(body.input())->n_rigid();
}
void bodies_of_any_stiffness_and_penalties(void **) {
    assert_int_equal(rigid_modes_of_three(0), 3);
    assert_int_equal(rigid_modes_of_three(1), 2);
    assert_int_equal(rigid_modes_of_three(1e10), 2);
}

// Elastic modes below the rounding of the matrix cannot be told from rigid ones: said, and soon. (Once it
// took minutes.) With half of the elements there is an answer, and the audit says how good it is.
void a_mesh_too_fine_is_said(void **) {
    Body body;
    body.beam(12000, 175, 0.78, 1);
    const ModelInput in = body.input();
    const std::clock_t begin = std::clock();
    const Caught c = caught([&] { test::build(in); });
    const double seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    assert_int_equal(c.status, plm::status::singular);
    assert_true(c.says("mesh is too fine") && c.says("use larger elements"));
    assert_true(below(seconds, 60)); // 4 s; the sanitizers' take their time
}

bool uncertain(int elements) {
    Body body;
    body.beam(elements, 175, 0.78, 1);
    const auto m = test::build(body.input());
    assert_int_equal(m->n_rigid(), 2);
    for (const plm::Finding &f : plm::quick_audit(*m))
        if (f.severity == 2 && f.text.find("rounding of the stiffness matrix") != std::string::npos)
            return true;
    return false;
}
void a_mesh_nearly_too_fine_is_said(void **) {
    assert_true(uncertain(6000));
    assert_false(uncertain(1000));
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(every_loose_body_has_its_mode),
        cmocka_unit_test(a_free_mass_beside_a_structure_is_rigid),
        cmocka_unit_test(a_free_mass_beside_a_small_free_body_is_rigid),
        cmocka_unit_test(soft_suspensions_leave_the_elastic_modes_their_digits),
        cmocka_unit_test(rigid_motion_does_not_soften_the_contact),
        cmocka_unit_test(bodies_without_stiffness_need_a_given_one),
        cmocka_unit_test(massless_dofs_are_allowed_where_they_are_held),
        cmocka_unit_test(lagrange_multipliers_are_named),
        cmocka_unit_test(loose_massless_part_is_refused),
        cmocka_unit_test(negative_stiffness_is_refused),
        cmocka_unit_test(singular_stiffness_shows_with_any_solver),
        cmocka_unit_test(a_free_chain_of_ten_thousand_masses),
        cmocka_unit_test(a_soft_support_is_one),
        cmocka_unit_test(rotations_beside_translations_in_any_units),
        cmocka_unit_test(bodies_of_any_stiffness_and_penalties),
        cmocka_unit_test(a_mesh_too_fine_is_said),
        cmocka_unit_test(a_mesh_nearly_too_fine_is_said),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
