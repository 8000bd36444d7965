// Lowest eigenpairs: choice of the method, repair of what an iterative method may miss, and verification.
#include "structure/eigs.hpp"
#include "linalg/blas_lapack.hpp"
#include "linalg/lapack.hpp"
#include "structure/eigs_internal.hpp"
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace plm {

namespace {

Pencil make_pencil(const TallMatrix &k, const TallMatrix &m, const TallFactor &factor, double shift,
                   const EigsOptions &options) {
    require(k.rows() == m.rows(), "lowest_eigenpairs: shapes");
    require(std::isfinite(shift), "lowest_eigenpairs: shift");
    m.require_finite_entries("eigensolver, M");
    k.require_finite_entries("eigensolver, K");
    return {k, m, factor, shift, options, m.n_positive(), k.none()};
}

/// The rest of the search goes with pairs that are all there in the order found.
void sort_and_cut(EigenPairs &pairs, std::int64_t count) {
    const std::int64_t total = pairs.vectors.cols();
    vector<std::int64_t> order(total);
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::int64_t a, std::int64_t b) { return pairs.values[a] < pairs.values[b]; });
    order.resize(std::min(count, total));
    if (count < total || !std::is_sorted(order.begin(), order.end())) pairs.rest = SearchRest();
    EigenPairs sorted{{}, pairs.vectors.columns(order), {}};
    for (std::int64_t from : order) sorted.values.push_back(pairs.values[from]);
    sorted.rest = std::move(pairs.rest);
    pairs = std::move(sorted);
}

/// Where M has a lower rank than asked for, the noise found beside may pass for eigenvectors.
bool are_dependent(const TallMatrix &m, const Field &x) {
    Matrix gram = block_gram(x, m.times(x));
    return !DenseCholesky().factor(gram);
}

/// The same of one vector that a search found apart from others (M times them), and thinks of unit length.
bool is_noise(const TallMatrix &m, const Field &one, const Field &m_others) {
    constexpr double nearly = 1e-6; // eigenvectors are orthonormal to more digits, noise to none
    const Matrix along = block_gram(m_others, one), own = block_gram(one, m.times(one));
    return !(norm2(along.rows(), along.data()) < nearly && std::abs(own(0, 0) - 1) < nearly);
}

bool needs_dense(const Pencil &pencil, std::int64_t n_wanted) {
    const std::int64_t rank = pencil.rank();
    return rank <= 64 || n_wanted > rank - 2 || (rank <= 1000 && 3 * n_wanted > rank);
}

/// M may have a lower rank than its diagonal tells. Then the Lanczos process breaks down, or fills up with
/// theta ~ 0, and the direct way is the better one as long as it is affordable.
constexpr std::int64_t dense_limit = 2000;

EigenPairs finite_ones(const Pencil &pencil, EigenPairs pairs, std::int64_t n_wanted) {
    sort_and_cut(pairs, n_wanted);
    vector<double> theta;
    for (double value : pairs.values) theta.push_back(1 / (value - pencil.shift));
    const double zero = 1e-13 * *std::max_element(theta.begin(), theta.end());
    const auto count = std::count_if(theta.begin(), theta.end(), [zero](double t) { return t > zero; });
    if (count == n_wanted) return pairs;
    if (pencil.rank() <= dense_limit) return dense_eigenpairs(pencil, n_wanted);
    for (std::int64_t j = 0; j < n_wanted; ++j) // the noise goes to the end of the order, and off
        if (!(theta[j] > zero)) pairs.values[j] = std::numeric_limits<double>::infinity();
    sort_and_cut(pairs, count);
    return pairs;
}

constexpr std::int64_t widest_block = 8; // columns that a solve takes at once

/// ARPACK holds its lock for the whole problem, so that it gets those of an instant only: some 0.1 s, most
/// far less (about five solutions per Lanczos vector at 1e9 operations a second).
bool suits_arpack(const Pencil &pencil, const KrylovRequest &request) {
    const auto vectors = static_cast<double>(request.n_lanczos), n = static_cast<double>(pencil.size());
    const auto nonzeros = static_cast<double>(pencil.factor.factor_nonzeros()); // negative: not known
    return !pencil.factor.calls_host() && nonzeros >= 0 &&
           5 * vectors * (4 * nonzeros + 4 * n * vectors) < 1e8;
}

/// ARPACK within few restarts where it suits; else, and where it did not converge, the Lanczos method of our
/// own. `times`: as large a space as usual.
KrylovResult run(const Pencil &pencil, std::int64_t n_wanted, std::int64_t times) {
    KrylovRequest request{n_wanted, 0, pencil.options.tolerance, pencil.options.max_restarts, 1};
    const auto dimension = [&](std::int64_t usual) { return std::min(times * usual, pencil.rank()); };
    request.n_lanczos = dimension(std::max(2 * n_wanted + 1, n_wanted + 20));
    if (suits_arpack(pencil, request)) {
        pencil.poll();
        KrylovRequest quick = request;
        quick.tolerance = 0; // it is measured by theta alone
        quick.max_restarts = std::min<std::int64_t>(request.max_restarts, 20);
        KrylovResult result = run_arpack(pencil, quick);
        if (result.end == KrylovEnd::converged) return result;
    }
    // Eight columns at once cost a solve what two or three cost one by one. But a block takes about as many
    // steps whatever its width, so that a few pairs are found sooner by a narrow one.
    request.width = std::clamp<std::int64_t>(n_wanted / 2, 1, widest_block);
    request.n_lanczos = dimension(2 * n_wanted + 20 * request.width);
    const KnownPairs &known = pencil.options.known;
    if (known.values && known.vectors->cols() < n_wanted) request.known = known;
    request.keep_rest = pencil.options.keep_rest;
    return run_lanczos(pencil, request);
}

const char *meaning(KrylovEnd end) {
    return end == KrylovEnd::too_few
               ? "the rest did not converge within the allowed restarts"
               : "the mass matrix has too low a rank for more; ask for fewer, or check the masses";
}

EigenPairs first_of(const KnownPairs &known, std::int64_t count) {
    return {vector<double>(known.values->begin(), known.values->begin() + count),
            known.vectors->columns(0, count),
            {}};
}

EigenPairs search(const Pencil &pencil, std::int64_t n_wanted) {
    const KnownPairs &known = pencil.options.known;
    if (known.values && known.vectors->cols() >= n_wanted) return first_of(known, n_wanted);
    KrylovResult result{};
    for (std::int64_t attempt = 0, times = 1; attempt < pencil.options.max_attempts; ++attempt, times *= 2) {
        result = run(pencil, n_wanted, times);
        if (result.end == KrylovEnd::converged) return finite_ones(pencil, std::move(result.pairs), n_wanted);
        if (result.end == KrylovEnd::exhausted) break;
    }
    if (result.end == KrylovEnd::exhausted && pencil.rank() <= dense_limit)
        return dense_eigenpairs(pencil, n_wanted);
    throw Error(status::eigensolver, format("%lld of %lld eigenpairs were found: %s",
                                            static_cast<long long>(result.pairs.values.size()),
                                            static_cast<long long>(n_wanted), meaning(result.end)))
        .library_code(result.end == KrylovEnd::too_few ? eigs_too_few : 0);
}

/// A block Lanczos process sees as many copies of a multiple eigenvalue as it has columns, and more by its
/// rounding errors only, so that it may end without one. A search in the M-complement of what was found shows
/// a missing one as an eigenvalue below the largest kept; it is put in, until nothing is missing. What is
/// above need not be exact. Returns M X.
Field add_missed(const Pencil &pencil, EigenPairs &pairs) {
    Field m_vectors = orthonormalize(pencil.m, pairs.vectors);
    const auto wanted = static_cast<std::int64_t>(pairs.values.size());
    KrylovRequest request{1, std::min<std::int64_t>(64, pencil.rank() - wanted), pencil.options.tolerance,
                          pencil.options.max_restarts, 2};
    request.apart = &pairs.vectors;
    request.m_apart = &m_vectors;
    request.width = widest_block;
    for (std::int64_t round = 0; round < wanted && request.n_lanczos >= 3; ++round) {
        const double missed = (1 - 1e-9) * (pairs.values.back() - pencil.shift);
        request.of_interest = 1 / missed;
        const KrylovResult others = run_lanczos(pencil, request);
        if (others.end != KrylovEnd::converged) break;
        const double distance = others.pairs.values[0] - pencil.shift;
        if (!(distance > 0 && distance < missed)) break; // below the shift: rounding noise around theta = 0
        if (is_noise(pencil.m, others.pairs.vectors, m_vectors)) break;
        pairs.values.push_back(others.pairs.values[0]);
        pairs.vectors.append(others.pairs.vectors);
        sort_and_cut(pairs, wanted);
        m_vectors = orthonormalize(pencil.m, pairs.vectors);
    }
    return m_vectors;
}

EigenPairs all_by_dense(const Pencil &pencil, std::int64_t n_wanted) {
    EigenPairs pairs = dense_eigenpairs(pencil, n_wanted);
    sort_and_cut(pairs, n_wanted);
    improve(pencil, pairs, orthonormalize(pencil.m, pairs.vectors));
    sort_and_cut(pairs, n_wanted);
    return pairs;
}

} // namespace

EigenPairs lowest_eigenpairs(const SparseMatrix &k, const SparseMatrix &m, const Factor &factor, double shift,
                             std::int64_t n_wanted, const EigsOptions &options) {
    require(k.rows == k.cols && m.rows == m.cols, "lowest_eigenpairs: shapes");
    return lowest_eigenpairs(*tall_matrix(k), *tall_matrix(m), *tall_factor(factor), shift, n_wanted,
                             options);
}

EigenPairs lowest_eigenpairs(const TallMatrix &k, const TallMatrix &m, const TallFactor &factor, double shift,
                             std::int64_t n_wanted, const EigsOptions &options) {
    require(n_wanted >= 0, "lowest_eigenpairs: number wanted");
    const Pencil pencil = make_pencil(k, m, factor, shift, options);
    if (n_wanted == 0 || pencil.rank() == 0) return {{}, pencil.place, {}};
    if (needs_dense(pencil, n_wanted)) return all_by_dense(pencil, n_wanted);
    EigenPairs pairs = search(pencil, n_wanted);
    sort_and_cut(pairs, n_wanted);
    if (pencil.rank() <= dense_limit && are_dependent(m, pairs.vectors))
        return all_by_dense(pencil, n_wanted);
    try {
        improve(pencil, pairs,
                options.look_for_missed ? add_missed(pencil, pairs)
                                        : orthonormalize(pencil.m, pairs.vectors));
    } catch (const Error &e) {
        // Copies of a multiple eigenvalue come into a Krylov space of one vector by rounding alone: the last
        // of dozens may be the worse for it.
        if (e.status() != status::eigensolver || pencil.rank() > dense_limit) throw;
        return all_by_dense(pencil, n_wanted);
    }
    sort_and_cut(pairs, n_wanted);
    return pairs;
}

} // namespace plm
