// The block Lanczos method alone: multiple and clustered eigenvalues, blocks that lose rank, known vectors
// and pairs, small spaces; and the making of an M-orthonormal block.
#include "matrices.hpp"
#include "structure/eigs.hpp"
#include "structure/eigs_block.hpp"
#include "structure/eigs_internal.hpp"
#include "structure/solver/make_factor.hpp"

using namespace test;

namespace {

constexpr double pi = 3.141592653589793238463;

/// A factor that says that it calls the host: all problems go to the Lanczos method.
class HostLike : public plm::Factor {
  public:
    HostLike(const SparseMatrix &k) : inner_(plm::make_factor(k)) {}
    void solve(double *x, std::int64_t nrhs, std::int64_t ldx) const override {
        solved += nrhs;
        inner_->solve(x, nrhs, ldx);
    }
    double reciprocal_condition() const override { return 1; }
    std::int64_t factor_nonzeros() const override { return -1; }
    bool calls_host() const override { return true; }
    mutable std::int64_t solved = 0;

  private:
    std::unique_ptr<plm::Factor> inner_;
};

/// A pencil with all that belongs to it; shift 0.
struct Problem {
    SparseMatrix k, m;
    HostLike factor;
    plm::EigsOptions options;
    Problem(SparseMatrix stiffness, SparseMatrix mass)
        : k(std::move(stiffness)), m(std::move(mass)), factor(k) {}
    plm::EigenPairs lowest(std::int64_t wanted) const {
        return plm::lowest_eigenpairs(k, m, factor, 0, wanted, options);
    }
    plm::KrylovResult lanczos(const plm::KrylovRequest &request) const {
        const auto stiffness = plm::tall_matrix(k), mass = plm::tall_matrix(m);
        const auto behind = plm::tall_factor(factor);
        return plm::run_lanczos({*stiffness, *mass, *behind, 0, options, mass->n_positive(), mass->none()},
                                request);
    }
};

/// n_wanted pairs in a space of n_lanczos by blocks of `width`, to machine precision.
plm::KrylovRequest request(std::int64_t n_wanted, std::int64_t n_lanczos, std::int64_t width) {
    plm::KrylovRequest r{n_wanted, n_lanczos, 0, 300, 1};
    r.width = width;
    return r;
}

/// Largest of: relative difference of the values (in any order) to the lowest exact ones, residual over |K|,
/// distance from M-orthonormality. Rounding of the factor's solves is amplified by the spread of the values.
double worst_error(const Problem &p, const plm::EigenPairs &pairs, vector<double> exact) {
    const auto count = static_cast<std::int64_t>(pairs.values.size());
    if (pairs.vectors.cols() != count || count > static_cast<std::int64_t>(exact.size())) return INFINITY;
    vector<double> values = pairs.values;
    std::sort(values.begin(), values.end());
    std::sort(exact.begin(), exact.end());
    const Matrix kx = plm::multiply(p.k, pairs.vectors.in_core()),
                 mx = plm::multiply(p.m, pairs.vectors.in_core());
    double worst = distance_from_identity(pairs.vectors.in_core(), mx);
    for (std::int64_t j = 0; j < count; ++j) {
        worst = std::max(worst, std::fabs(values[j] / exact[j] - 1));
        for (std::int64_t i = 0; i < kx.rows(); ++i)
            worst = std::max(worst, std::fabs(kx(i, j) - pairs.values[j] * mx(i, j)) / plm::norm_inf(p.k));
    }
    return worst;
}

/// Equal strings without connection: each of the `length` values comes `copies` times.
Problem strings(std::int64_t copies, std::int64_t length) {
    const std::int64_t n = copies * length;
    vector<std::int64_t> i, j;
    vector<double> v;
    for (std::int64_t a = 0; a < n; ++a) {
        i.push_back(a), j.push_back(a), v.push_back(2);
        if (a % length == 0) continue;
        i.push_back(a), j.push_back(a - 1), v.push_back(-1);
        i.push_back(a - 1), j.push_back(a), v.push_back(-1);
    }
    return Problem(plm::from_triplets(n, n, i, j, v), diagonal(vector<double>(n, 1.0)));
}

vector<double> string_values(std::int64_t copies, std::int64_t length) {
    vector<double> values;
    for (std::int64_t s = 1; s <= length; ++s)
        values.insert(values.end(), copies,
                      2 - 2 * std::cos(pi * static_cast<double>(s) / static_cast<double>(length + 1)));
    return values;
}

void a_block_sees_as_many_copies_as_it_has_columns(void **) {
    for (std::int64_t width = 1; width <= 8; ++width) {
        const Problem p = strings(width, 40);
        plm::KrylovRequest r = request(3 * width, 10 * width, width);
        r.tolerance = 1e-9; // too loose for rounding to show a copy
        const auto result = p.lanczos(r);
        assert_true(result.end == plm::KrylovEnd::converged);
        assert_int_equal(result.pairs.values.size(), 3 * width);
        assert_true(worst_error(p, result.pairs, string_values(width, 40)) < 1e-8);
    }
}

/// Wider than a block, too; one more and one less wanted than there are copies.
void all_copies_are_found(void **) {
    for (std::int64_t copies = 2; copies <= 10; ++copies)
        for (std::int64_t wanted : {copies - 1, 2 * copies, 3 * copies + 1}) {
            const Problem p = strings(copies, 60);
            const auto pairs = p.lowest(wanted);
            assert_int_equal(pairs.values.size(), wanted);
            assert_true(worst_error(p, pairs, string_values(copies, 60)) < 1e-10);
        }
}

/// Three values of a hundred copies each: every block closes the space in itself after three.
void a_space_that_closes_is_opened_by_a_new_block(void **) {
    vector<double> values(300);
    for (std::size_t i = 0; i < 300; ++i) values[i] = 1 + static_cast<double>(i % 3);
    const Problem p(diagonal(values), diagonal(vector<double>(300, 1.0)));
    const auto all_found = p.lowest(40); // forty times 1
    assert_int_equal(all_found.values.size(), 40);
    assert_true(worst_error(p, all_found, values) < 1e-11);
    for (std::int64_t width : {1, 3, 8}) { // as many as there are, each in its place
        const auto result = p.lanczos(request(298, 300, width));
        assert_true(result.end == plm::KrylovEnd::converged);
        assert_int_equal(result.pairs.values.size(), 298);
        assert_true(worst_error(p, result.pairs, values) < 1e-11);
    }
}

void a_low_rank_of_the_masses_exhausts_the_space(void **) {
    vector<double> mass(400, 0.0);
    for (std::size_t i : {3, 77, 150, 151, 399}) mass[i] = 1 + 0.1 * static_cast<double>(i);
    const Problem p(membrane(20, 20), diagonal(mass));
    vector<double> reference;
    for (std::int64_t width : {1, 2, 5, 8}) {
        const auto short_of = p.lanczos(request(10, 30, width));
        assert_true(short_of.end == plm::KrylovEnd::exhausted);
        assert_true(short_of.pairs.values.size() == 5);
        const auto all = p.lanczos(request(5, 30, width)), some = p.lanczos(request(3, 4, width));
        assert_true(all.end == plm::KrylovEnd::converged && some.end == plm::KrylovEnd::converged);
        if (width == 1) reference = all.pairs.values;
        assert_true(worst_error(p, all.pairs, reference) < 1e-11);
        assert_true(worst_error(p, some.pairs, reference) < 1e-11);
    }
}

void vectors_are_kept_apart(void **) {
    const Problem p = strings(4, 50);
    const auto first = p.lanczos(request(10, 60, 4)).pairs;
    const plm::Field m_first(plm::multiply(p.m, first.vectors.in_core()));
    vector<double> exact = string_values(4, 50);
    exact.erase(exact.begin(), exact.begin() + 10);
    for (std::int64_t width : {2, 4, 8}) {
        plm::KrylovRequest r = request(7, 70, width);
        r.apart = &first.vectors;
        r.m_apart = &m_first;
        if (width < 4) r.n_wanted = 2; // the two copies left of the third value
        const auto rest = p.lanczos(r);
        assert_true(rest.end == plm::KrylovEnd::converged);
        assert_true(worst_error(p, rest.pairs, exact) < 1e-10);
        const Matrix overlap = plm::block_gram(m_first, rest.pairs.vectors);
        for (std::int64_t j = 0; j < overlap.cols(); ++j)
            for (std::int64_t i = 0; i < overlap.rows(); ++i) assert_true(std::fabs(overlap(i, j)) < 1e-12);
    }
}

struct Found {
    double error;
    std::int64_t solved;
    plm::EigenPairs pairs;
};
Found lowest_of(Problem &p, std::int64_t wanted, plm::KnownPairs known, const vector<double> &exact) {
    p.options.known = known;
    const std::int64_t before = p.factor.solved;
    plm::EigenPairs pairs = p.lowest(wanted);
    return {worst_error(p, pairs, exact), p.factor.solved - before, std::move(pairs)};
}

/// Where an earlier search stopped another goes on: fewer solutions than from nothing, the same pairs. What
/// the first one left is used up then; the pairs alone help less.
void a_search_goes_on_from_known_pairs(void **) {
    Problem p = strings(3, 400);
    const vector<double> exact = string_values(3, 400);
    p.options.look_for_missed = false;
    const Found all = lowest_of(p, 60, {}, exact);
    p.options.keep_rest = true;
    Found first = lowest_of(p, 20, {}, exact);
    assert_true(first.pairs.rest.w.cols() > 0);
    const plm::KnownPairs known{&first.pairs.values, &first.pairs.vectors, &first.pairs.rest};
    const Found more = lowest_of(p, 60, known, exact);
    assert_int_equal(first.pairs.rest.w.cols(), 0);
    const Found without_rest = lowest_of(p, 60, known, exact);
    const Found *const results[] = {&all, &first, &more, &without_rest};
    for (const Found *found : results) assert_true(found->error < 1e-10);
    std::printf("    20 pairs %lld solutions, 60 pairs %lld, %lld more, %lld from the pairs alone\n",
                static_cast<long long>(first.solved), static_cast<long long>(all.solved),
                static_cast<long long>(more.solved), static_cast<long long>(without_rest.solved));
    assert_true(first.solved + more.solved < 1.1 * all.solved);
    assert_true(without_rest.solved < all.solved);
    const Found fewer = lowest_of(p, 5, known, exact); // known ones in plenty are of no use
    assert_true(fewer.error < 1e-10);
}

/// Six values within 1e-6 of each other, then ten decades.
void clusters_and_a_wide_spectrum_are_resolved(void **) {
    vector<double> values(240);
    for (std::size_t i = 0; i < 240; ++i)
        values[i] =
            i < 6 ? 1 + 2e-7 * static_cast<double>(i) : std::pow(10, 10 * static_cast<double>(i - 5) / 234);
    const Problem p(diagonal(values), diagonal(vector<double>(240, 1.0)));
    for (std::int64_t width : {1, 4, 8}) {
        const auto result = p.lanczos(request(30, 120, width));
        assert_true(result.end == plm::KrylovEnd::converged);
        assert_true(worst_error(p, result.pairs, values) < 1e-10);
    }
}

/// Room for one block beside the pairs wanted: restart after restart.
void a_small_space_needs_restarts_only(void **) {
    const Problem p(membrane(30, 29), diagonal(vector<double>(870, 1.0)));
    const auto exact = p.lanczos(request(12, 200, 1)).pairs.values;
    for (std::int64_t width : {1, 2, 5, 8})
        for (std::int64_t room : {1, 3, 8, 11}) {
            plm::KrylovRequest r = request(12, 12 + room, width);
            r.max_restarts = 2000;
            const auto result = p.lanczos(r);
            assert_true(result.end == plm::KrylovEnd::converged);
            assert_int_equal(result.pairs.values.size(), 12);
            assert_true(worst_error(p, result.pairs, exact) < 1e-10);
        }
}

void massless_dofs_leave_no_trace_in_the_vectors(void **) {
    vector<double> mass(900);
    for (std::size_t i = 0; i < 900; ++i) mass[i] = i % 3 == 0 ? 0 : 1 + 0.1 * static_cast<double>(i % 7);
    const Problem p(membrane(30, 30), diagonal(mass));
    const auto exact = p.lanczos(request(15, 100, 1)).pairs.values;
    for (std::int64_t width : {1, 3, 8}) {
        const auto result = p.lanczos(request(15, 40, width));
        assert_true(result.end == plm::KrylovEnd::converged);
        assert_true(worst_error(p, result.pairs, exact) < 1e-10);
    }
}

/// What is below the value of interest need not be exact, what is above must.
void a_glance_suffices_for_what_is_of_no_interest(void **) {
    const Problem p(membrane(30, 29), diagonal(vector<double>(870, 1.0)));
    plm::KrylovRequest r = request(1, 40, 4);
    const double lowest = p.lanczos(r).pairs.values[0];
    r.of_interest = 1.5 / lowest;
    const auto seen = p.lanczos(r);
    r.of_interest = 0.99 / lowest;
    const auto exact = p.lanczos(r);
    assert_true(seen.end == plm::KrylovEnd::converged && exact.end == plm::KrylovEnd::converged);
    assert_true(std::fabs(seen.pairs.values[0] / lowest - 1) < 1e-2);
    assert_true(std::fabs(exact.pairs.values[0] / lowest - 1) < 1e-12);
}

/// Columns: random; in the basis; copies; copies but for 1e-4, 1e-9, 1e-13; zero; of all sizes.
void a_block_keeps_what_is_independent(void **) {
    const std::int64_t n = 200;
    const SparseMatrix m = random_definite(n, 5);
    const auto mass = plm::tall_matrix(m);
    plm::LanczosBlock basis, block;
    basis.x = plm::Field(random_matrix(n, 6, 1));
    basis.orthonormalize(*mass, mass->none(), vector<double>(6, 0.0));
    assert_int_equal(basis.width(), 6);
    Matrix x = random_matrix(n, 8, 2);
    const Matrix noise = random_matrix(n, 3, 3);
    for (std::int64_t i = 0; i < n; ++i) {
        x(i, 1) = basis.x.at(i, 0) - 3 * basis.x.at(i, 5);
        x(i, 2) = 1e9 * x(i, 0);
        x(i, 3) = x(i, 0) + 1e-4 * noise(i, 0);
        x(i, 4) = x(i, 0) + 1e-9 * noise(i, 1);
        x(i, 5) = x(i, 0) + 1e-13 * noise(i, 2);
        x(i, 6) = 0;
        x(i, 7) *= 1e-20;
    }
    block.x = plm::Field(x);
    block.orthonormalize(*mass, basis.x, vector<double>(8, 0.0));
    assert_true(block.width() >= 5 &&
                block.width() <= 7); // rounding of columns 1 and 2 may be taken for more
    assert_true(distance_from_identity(block.x.in_core(), plm::multiply(m, block.x.in_core())) < 1e-13);
    assert_true(max_difference(block.mx.in_core(), plm::multiply(m, block.x.in_core())) < 1e-12);
    const Matrix overlap = plm::product('T', 'N', basis.mx.in_core(), block.x.in_core());
    for (std::int64_t j = 0; j < overlap.cols(); ++j)
        for (std::int64_t i = 0; i < overlap.rows(); ++i) assert_true(std::fabs(overlap(i, j)) < 1e-13);
    Matrix again = plm::product('N', 'N', basis.x.in_core(), block.taken());
    plm::gemm('N', 'N', 1, block.x.in_core(), block.rest(), 1, again);
    for (std::int64_t j = 0; j < 8; ++j) {
        double size = 0, difference = 0;
        for (std::int64_t i = 0; i < n; ++i) {
            size = std::max(size, std::fabs(x(i, j)));
            difference = std::max(difference, std::fabs(x(i, j) - again(i, j)));
        }
        assert_true(difference <= 1e-14 * size);
    }
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(a_block_sees_as_many_copies_as_it_has_columns),
        cmocka_unit_test(all_copies_are_found),
        cmocka_unit_test(a_space_that_closes_is_opened_by_a_new_block),
        cmocka_unit_test(a_low_rank_of_the_masses_exhausts_the_space),
        cmocka_unit_test(vectors_are_kept_apart),
        cmocka_unit_test(a_search_goes_on_from_known_pairs),
        cmocka_unit_test(clusters_and_a_wide_spectrum_are_resolved),
        cmocka_unit_test(a_small_space_needs_restarts_only),
        cmocka_unit_test(massless_dofs_leave_no_trace_in_the_vectors),
        cmocka_unit_test(a_glance_suffices_for_what_is_of_no_interest),
        cmocka_unit_test(a_block_keeps_what_is_independent),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
