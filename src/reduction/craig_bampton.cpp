// Craig & Bampton (1968): the contact DOFs are retained, the interior is represented by constraint modes and
// by fixed-interface modes.
#include "reduction/craig_bampton.hpp"
#include "linalg/lapack.hpp"
#include "reduction/basis_kind.hpp"
#include "reduction/basis_options.hpp"
#include "space/massless.hpp"
#include "structure/fixed_interface.hpp"
#include <algorithm>
#include <cmath>
#include <utility>

namespace plm {
namespace {

constexpr std::int64_t column_block = 64; // between two looks at the host, where both sides are long

void put(const Matrix &columns, std::int64_t first, Matrix &into) {
    std::copy_n(columns.data(), columns.rows() * columns.cols(), into.data() + first * into.rows());
}

// T^T A T; apply: X -> A X.
template <class Apply> Matrix projection(const Field &t, Apply apply, Watch watch) {
    Matrix out(t.cols(), t.cols());
    for (std::int64_t first = 0; first < t.cols(); first += column_block) {
        watch.step("Craig-Bampton", 0.7);
        const Field block = t.columns(first, std::min(column_block, t.cols() - first));
        put(gram(t, apply(block)), first, out);
    }
    return out;
}

// T Y.
Field combined(const Field &t, const Matrix &y, Watch watch) {
    Field out = t.zeros(y.cols());
    for (std::int64_t first = 0; first < y.cols(); first += column_block) {
        watch.step("Craig-Bampton", 0.9);
        out.put(first, combine(t, y.columns(first, std::min(column_block, y.cols() - first))));
    }
    return out;
}

void symmetrise(Matrix &a) {
    for (std::int64_t j = 0; j < a.cols(); ++j)
        for (std::int64_t i = j + 1; i < a.rows(); ++i) a(i, j) = a(j, i) = 0.5 * (a(i, j) + a(j, i));
}

// Coordinates that diagonalise both; contact DOFs without mass keep their flexibility.
RitzVectors diagonalise(const Matrix &k, const Matrix &m, double sigma, double reach) {
    Matrix shifted = k;
    for (std::int64_t i = 0; i < k.rows() * k.cols(); ++i) shifted.data()[i] += sigma * m.data()[i];
    const SymmetricEigen inertia = symmetric_eigen_general(m, shifted);
    return ritz_vectors(inertia.values, inertia.vectors, sigma, reach);
}

// Rigid-body modes lie in the space (but for too few fixed-interface modes of an interior that is free
// itself).
void clear_rigid_values(std::int64_t n_rigid, vector<double> &lambda) {
    const std::int64_t size = static_cast<std::int64_t>(lambda.size());
    const double flexible = n_rigid < size ? lambda[n_rigid] : 1.0;
    for (std::int64_t j = 0; j < size; ++j)
        if (lambda[j] < 0 || (j < n_rigid && lambda[j] < 1e-7 * flexible)) lambda[j] = 0;
}

} // namespace

std::shared_ptr<const Space> make_craig_bampton_space(std::shared_ptr<const Model> model,
                                                      const CraigBamptonOptions &options, Watch watch) {
    const FixedInterface held(*model, watch);
    Field t = held.constraint_modes(); // T = [I 0; Psi Phi]
    t.append(held.interior_modes(options.n_fixed, options.highest_frequency, options.load_vectors));
    Matrix k = projection(
        t, [&](const Field &x) { return model->stiffness_times(x); }, watch);
    Matrix m = projection(
        t, [&](const Field &x) { return model->mass_times(x); }, watch);
    symmetrise(k);
    symmetrise(m);
    watch.step("Craig-Bampton", 0.8);
    RitzVectors ritz = diagonalise(k, m, model->shift(), options.highest_frequency);

    auto space = std::make_shared<Space>();
    space->model = model;
    Field vectors = combined(t, ritz.vectors, watch);
    space->gap = model->gap_rows().of(vectors);
    space->vectors = SpaceVectors(std::move(vectors));
    space->lambda = std::move(ritz.lambda);
    space->n_massless = ritz.n_massless;
    clear_rigid_values(model->n_rigid(), space->lambda);
    space->highest_frequency = options.highest_frequency;
    const long long n_boundary = static_cast<long long>(held.n_boundary());
    space->description =
        format("Craig-Bampton: %lld contact DOFs and %lld fixed-interface modes and load vectors", n_boundary,
               static_cast<long long>(t.cols()) - n_boundary);
    project_onto(*space);
    watch.log(1, space->description);
    return space;
}

namespace {

constexpr double fixed_mode_margin = 4; // fixed-interface modes up to this multiple: amplitudes to 1e-3

std::shared_ptr<const Space> craig_bampton_space(const std::shared_ptr<const Model> &model,
                                                 const BasisOptions &o, double highest, Watch watch) {
    return make_craig_bampton_space(model, {o.n_fixed_modes, fixed_mode_margin * highest, o.load_vectors},
                                    watch);
}

constexpr BasisKind craig_bampton_kind() {
    BasisKind kind("craig_bampton", "contact DOFs retained");
    kind.own_options = "n_fixed_modes";
    kind.make_space = craig_bampton_space;
    return kind;
}

} // namespace

constexpr BasisKind basis_kinds::craig_bampton = craig_bampton_kind();

} // namespace plm
