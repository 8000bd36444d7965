#include "space/linear_contact.hpp"
#include "linalg/lapack.hpp"
#include "space/spring_compliance.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

vector<std::int64_t> active_pairs(const vector<double> &spring) {
    vector<std::int64_t> active;
    for (std::size_t i = 0; i < spring.size(); ++i)
        if (spring[i] > 0) active.push_back(static_cast<std::int64_t>(i));
    return active;
}

// The pairs on springs, in coordinates whose pivots D do not differ without bound.
struct ActivePairs {
    Matrix gap;             // G_A
    DenseCholesky cholesky; // of T = 1/spring + G_A D^-1 G_A^T

    ActivePairs(const vector<double> &pivot, Matrix rows, const vector<double> &spring)
        : gap(std::move(rows)) {
        Matrix root = gap;
        for (std::int64_t j = 0; j < root.cols(); ++j) {
            const double scale = 1 / std::sqrt(pivot[j]);
            for (std::int64_t i = 0; i < root.rows(); ++i) root(i, j) *= scale;
        }
        Matrix t(gap.rows(), gap.rows());
        gemm('N', 'T', 1.0, root, root, 0.0, t);
        cholesky = with_springs(std::move(t), spring);
    }
};

Matrix entries(const Matrix &a, const vector<std::int64_t> &rows, const vector<std::int64_t> &columns) {
    Matrix b(static_cast<std::int64_t>(rows.size()), static_cast<std::int64_t>(columns.size()));
    for (std::int64_t j = 0; j < b.cols(); ++j)
        for (std::int64_t i = 0; i < b.rows(); ++i) b(i, j) = a(rows[i], columns[j]);
    return b;
}

vector<double> entries(const vector<double> &a, const vector<std::int64_t> &chosen) {
    vector<double> b;
    for (std::int64_t i : chosen) b.push_back(a[i]);
    return b;
}

vector<std::int64_t> all_below(std::int64_t n) {
    vector<std::int64_t> all(n);
    for (std::int64_t j = 0; j < n; ++j) all[j] = j;
    return all;
}

// What is added to lambda so that it can be inverted, and taken off the eigenvalues again. Where it is 0, an
// eigenvalue is exact to eps lambda / lambda_1; with it, to eps (1 + lambda / sigma), and a small one to
// eps sigma / lambda_1.
double shift_of(const vector<double> &lambda, const Matrix &gap, const vector<double> &spring) {
    constexpr double far = 1e6, massless = 1e14; // of neighbours: a body held softly; no inertia at all
    std::size_t first = 0;
    while (first < lambda.size() && !(lambda[first] > 0)) ++first;
    if (first == lambda.size()) { // rigid bodies on springs
        double largest = 0;
        for (std::int64_t j = 0; j < gap.cols(); ++j) {
            double k = 0;
            for (std::int64_t i = 0; i < gap.rows(); ++i) k += spring[i] * gap(i, j) * gap(i, j);
            largest = std::max(largest, k);
        }
        return 1e-2 * largest;
    }
    if (first > 0) return 1e-2 * lambda[first];
    for (std::size_t j = 1; j < lambda.size(); ++j) {
        const double apart = lambda[j] / lambda[j - 1];
        if (apart > massless) break;
        if (apart > far) return std::sqrt(lambda[j - 1] * lambda[j]);
    }
    return 0;
}

// No springs: the coordinates themselves.
SpaceModes coordinate_modes(const vector<double> &lambda, std::int64_t n_massless, double upper) {
    SpaceModes modes;
    const std::int64_t m = static_cast<std::int64_t>(lambda.size()), massive = m - n_massless;
    const auto last = lambda.begin() + massive;
    const std::int64_t count = std::upper_bound(lambda.begin(), last, upper) - lambda.begin();
    modes.values.assign(lambda.begin(), lambda.begin() + count);
    modes.vectors.reset(m, count);
    for (std::int64_t j = 0; j < count; ++j) modes.vectors(j, j) = 1;
    if (std::isfinite(upper)) return modes;
    modes.massless.reset(m, n_massless);
    for (std::int64_t j = 0; j < n_massless; ++j)
        modes.massless(massive + j, j) = 1 / std::sqrt(lambda[massive + j]);
    return modes;
}

// Minus (diag(pivot) + G_A^T k G_A)^-1 = Y^T T^-1 Y - D^-1, Y = G_A D^-1, symmetric to the last bit. The
// lowest modes come first in it.
Matrix negative_compliance(const vector<double> &pivot, Matrix gap, const vector<double> &spring) {
    const std::int64_t m = gap.cols(), a = gap.rows();
    const ActivePairs pairs(pivot, std::move(gap), spring);
    Matrix y = pairs.gap;
    for (std::int64_t j = 0; j < m; ++j)
        for (std::int64_t i = 0; i < a; ++i) y(i, j) /= pivot[j];
    Matrix ty = y, inverse(m, m);
    pairs.cholesky.solve(ty.data(), m, a);
    gemm('T', 'N', 1.0, y, ty, 0.0, inverse);
    for (std::int64_t j = 0; j < m; ++j) {
        for (std::int64_t i = j; i < m; ++i) {
            const double s = 0.5 * (inverse(i, j) + inverse(j, i));
            inverse(i, j) = inverse(j, i) = s;
        }
        inverse(j, j) -= 1 / pivot[j];
    }
    return inverse;
}

Matrix block(const Matrix &a, std::int64_t first_row, std::int64_t rows, std::int64_t first_column,
             std::int64_t columns) {
    Matrix b(rows, columns);
    for (std::int64_t j = 0; j < columns; ++j)
        for (std::int64_t i = 0; i < rows; ++i) b(i, j) = a(first_row + i, first_column + j);
    return b;
}

// What has no mass follows: (K + sigma M) v = (lambda + sigma) M v.
Matrix with_followers(const Matrix &massive, const vector<double> &values, double sigma,
                      const Matrix &inverse) {
    const std::int64_t n = massive.rows(), m = inverse.rows();
    if (m == n) return massive;
    const Matrix follow = product('N', 'N', block(inverse, n, m - n, 0, n), massive);
    Matrix whole(m, massive.cols());
    for (std::int64_t j = 0; j < whole.cols(); ++j) {
        std::copy_n(massive.col(j), n, whole.col(j));
        for (std::int64_t i = n; i < m; ++i) whole(i, j) = -(values[j] + sigma) * follow(i - n, j);
    }
    return whole;
}

// An orthonormal basis, in the stiffness with springs, of the directions without mass.
Matrix massless_directions(const vector<double> &lambda, std::int64_t n_massless, const Matrix &gap,
                           const vector<double> &spring) {
    const std::int64_t m = gap.cols(), first = m - n_massless;
    Matrix directions(m, n_massless);
    if (n_massless == 0) return directions;
    const vector<double> pivot(lambda.begin() + first, lambda.end());
    const SymmetricEigen e =
        symmetric_eigen(negative_compliance(pivot, gap.columns(first, n_massless), spring));
    for (std::int64_t j = 0; j < n_massless; ++j) {
        const double root = std::sqrt(std::max(0.0, -e.values[j]));
        for (std::int64_t i = 0; i < n_massless; ++i) directions(first + i, j) = root * e.vectors(i, j);
    }
    return directions;
}

} // namespace

// Works on the inverse S = (diag(lambda) + G_A^T k G_A + sigma M)^-1, whose part with mass has the
// compliances 1 / (lambda + sigma) as eigenvalues. A direct eigenproblem would lose the low modes to rounding
// (eps times the stiffest attachment vector, or spring); the compliance form keeps them to eps and has the
// rigid limit k -> infinity.
SpaceModes modes_with_springs(const vector<double> &lambda, std::int64_t n_massless, const Matrix &gap,
                              const vector<double> &spring, double upper) {
    const vector<std::int64_t> active = active_pairs(spring);
    const std::int64_t m = static_cast<std::int64_t>(lambda.size()), massive = m - n_massless;
    if (active.empty() || massive == 0) return coordinate_modes(lambda, n_massless, upper);
    const Matrix rows = entries(gap, active, all_below(m));
    const vector<double> springs = entries(spring, active);
    const double sigma = shift_of(vector<double>(lambda.begin(), lambda.begin() + massive), gap, spring);
    vector<double> pivot(lambda);
    for (std::int64_t j = 0; j < massive; ++j) pivot[j] += sigma;
    const Matrix inverse = negative_compliance(pivot, rows, springs);
    const Matrix inertial = n_massless == 0 ? inverse : block(inverse, 0, massive, 0, massive);
    SymmetricEigen eigen = std::isfinite(upper) ? symmetric_eigen_below(inertial, -1 / (upper + sigma))
                                                : symmetric_eigen(inertial);
    SpaceModes modes;
    for (double mu : eigen.values) {
        if (!(mu < 0)) break; // compliance below rounding: no dynamics
        const double value = -1 / mu - sigma;
        modes.values.push_back(std::abs(value) < 1e-9 * sigma ? 0.0 : value);
    }
    modes.vectors = with_followers(eigen.vectors.columns(0, static_cast<std::int64_t>(modes.values.size())),
                                   modes.values, sigma, inverse);
    if (!std::isfinite(upper)) modes.massless = massless_directions(lambda, n_massless, rows, springs);
    return modes;
}

namespace {

// Pivots below this share of the largest are soft: of rigid-body motion that nothing but contact holds. Their
// compliance would bury that of the springs and of the structure under its rounding.
constexpr double soft_pivot = 1e-6;

struct Coordinates {
    vector<std::int64_t> soft, firm;
};

Coordinates sorted_by_pivot(const vector<double> &pivot) {
    const double limit = soft_pivot * *std::max_element(pivot.begin(), pivot.end());
    Coordinates c;
    for (std::size_t j = 0; j < pivot.size(); ++j)
        (pivot[j] < limit ? c.soft : c.firm).push_back(static_cast<std::int64_t>(j));
    return c;
}

// X becomes S^-1 X for S = diag(pivot) + G^T Z, symmetric. A direction that nothing holds has the pivots
// alone, which rounding of the rest may exceed: it is held no less than that.
void solve_soft(const vector<double> &pivot, const Matrix &gap, const Matrix &z, Matrix &x) {
    Matrix s = product('T', 'N', gap, z);
    const std::int64_t n = s.cols();
    for (std::int64_t j = 0; j < n; ++j) {
        for (std::int64_t i = j; i < n; ++i) s(i, j) = 0.5 * (s(i, j) + s(j, i));
        s(j, j) += pivot[j];
    }
    const SymmetricEigen e = symmetric_eigen(s);
    const double least = *std::min_element(pivot.begin(), pivot.end());
    Matrix along = product('T', 'N', e.vectors, x);
    for (std::int64_t k = 0; k < along.cols(); ++k)
        for (std::int64_t j = 0; j < n; ++j) along(j, k) /= std::max(e.values[j], least);
    gemm('N', 'N', 1.0, e.vectors, along, 0.0, x);
}

void divide_rows(const vector<double> &pivot, Matrix &x) {
    for (std::int64_t k = 0; k < x.cols(); ++k)
        for (std::int64_t j = 0; j < x.rows(); ++j) x(j, k) /= pivot[j];
}

void put_rows(const Matrix &part, const vector<std::int64_t> &rows, Matrix &x) {
    for (std::int64_t k = 0; k < x.cols(); ++k)
        for (std::int64_t j = 0; j < part.rows(); ++j) x(rows[j], k) = part(j, k);
}

} // namespace

namespace {

// By the springs' forces F, which are returned (those of active pairs). Firm coordinates: D X + G^T F = B, so
// that T F = G D^-1 B + G_soft X_soft with T = 1/spring + G D^-1 G^T: stable for any spring. What is left for
// the soft ones has no difference of large numbers.
Matrix solve_for_forces(const vector<double> &pivot, const Matrix &gap, const vector<double> &spring,
                        const vector<std::int64_t> &active, Matrix &x) {
    const vector<std::int64_t> columns = all_below(x.cols());
    const Coordinates c = sorted_by_pivot(pivot);
    const vector<double> firm_pivot = entries(pivot, c.firm), soft_pivots = entries(pivot, c.soft);
    const ActivePairs pairs(firm_pivot, entries(gap, active, c.firm), entries(spring, active));
    Matrix x_firm = entries(x, c.firm, columns);
    divide_rows(firm_pivot, x_firm);
    Matrix force = product('N', 'N', pairs.gap, x_firm);
    pairs.cholesky.solve(force.data(), force.cols(), force.rows());
    if (!c.soft.empty()) {
        const Matrix soft = entries(gap, active, c.soft);
        Matrix z = soft, x_soft = entries(x, c.soft, columns); // z: forces per unit of the soft coordinates
        pairs.cholesky.solve(z.data(), z.cols(), z.rows());
        gemm('T', 'N', -1.0, soft, force, 1.0, x_soft);
        solve_soft(soft_pivots, soft, z, x_soft);
        gemm('N', 'N', 1.0, z, x_soft, 1.0, force);
        put_rows(x_soft, c.soft, x);
    }
    Matrix back = product('T', 'N', pairs.gap, force);
    divide_rows(firm_pivot, back);
    for (std::int64_t k = 0; k < back.rows() * back.cols(); ++k) x_firm.data()[k] -= back.data()[k];
    put_rows(x_firm, c.firm, x);
    return force;
}

} // namespace

void solve_with_springs(const vector<double> &pivot, const Matrix &gap, const vector<double> &spring,
                        Matrix &x) {
    const vector<std::int64_t> active = active_pairs(spring);
    if (active.empty()) return divide_rows(pivot, x);
    solve_for_forces(pivot, gap, spring, active, x);
}

void solve_with_springs(const vector<double> &pivot, const Matrix &gap, const vector<double> &spring,
                        vector<double> &x) {
    Matrix column(static_cast<std::int64_t>(x.size()), 1);
    std::copy(x.begin(), x.end(), column.data());
    solve_with_springs(pivot, gap, spring, column);
    std::copy(column.data(), column.data() + x.size(), x.begin());
}

// Once more with what the tiny stiffness of rigid-body motion has carried: its square is nothing.
vector<double> spring_forces(const vector<double> &lambda, const Matrix &gap, const vector<double> &spring,
                             const vector<double> &x) {
    vector<double> forces(spring.size(), 0.0);
    const vector<std::int64_t> active = active_pairs(spring);
    if (active.empty()) return forces;
    const vector<double> pivot = held_pivots(lambda);
    Matrix motion(static_cast<std::int64_t>(x.size()), 1);
    std::copy(x.begin(), x.end(), motion.data());
    solve_for_forces(pivot, gap, spring, active, motion);
    for (std::int64_t j = 0; j < motion.rows(); ++j)
        motion(j, 0) = x[j] + (pivot[j] - lambda[j]) * motion(j, 0);
    const Matrix found = solve_for_forces(pivot, gap, spring, active, motion);
    for (std::size_t a = 0; a < active.size(); ++a)
        forces[active[a]] = found(static_cast<std::int64_t>(a), 0);
    return forces;
}

vector<double> held_pivots(const vector<double> &lambda) {
    constexpr double tiny = 1e-10; // nothing to the elastic motion, and far above rounding
    const auto elastic = std::find_if(lambda.begin(), lambda.end(), [](double l) { return l > 0; });
    const double least = tiny * (elastic == lambda.end() ? 1 : *elastic);
    vector<double> pivot(lambda);
    for (double &p : pivot) p = std::max(p, least);
    return pivot;
}

} // namespace plm
