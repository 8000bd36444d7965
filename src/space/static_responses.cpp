#include "space/static_responses.hpp"
#include <algorithm>

namespace plm {
namespace {

Matrix unit_columns(std::int64_t rows, std::int64_t first, std::int64_t count) {
    Matrix e(rows, count);
    for (std::int64_t j = 0; j < count; ++j) e(first + j, j) = 1;
    return e;
}

void put_columns(const Matrix &columns, std::int64_t first, Matrix &into) {
    std::copy_n(columns.data(), columns.rows() * columns.cols(), into.col(first));
}

void symmetrise(Matrix &a) {
    for (std::int64_t j = 0; j < a.cols(); ++j)
        for (std::int64_t i = j + 1; i < a.rows(); ++i) a(i, j) = a(j, i) = 0.5 * (a(i, j) + a(j, i));
}

// A += factor G^T diag(weight) G.
void add_modal(double factor, const Matrix &g, const vector<double> &weight, Matrix &a) {
    Matrix weighted = g;
    for (std::int64_t j = 0; j < g.cols(); ++j)
        for (std::int64_t k = 0; k < g.rows(); ++k) weighted(k, j) *= weight[k];
    gemm('T', 'N', factor, g, weighted, 1.0, a);
}

// Of the modes from `first` on: powers of their compliance 1 / (lambda + sigma).
vector<double> compliances(const ExactModes &modes, double shift, int power, std::int64_t first = 0) {
    vector<double> c(modes.count(), 0.0);
    for (std::int64_t k = first; k < modes.count(); ++k) {
        const double one = 1 / (modes.values[k] + shift);
        c[k] = power == 1 ? one : one * one;
    }
    return c;
}

vector<double> energies_with(const StaticResponses &r, const vector<double> &compliance) {
    vector<double> e(r.energy.cols());
    for (std::int64_t j = 0; j < r.energy.cols(); ++j) {
        e[j] = r.energy(j, j);
        for (std::int64_t k = 0; k < r.modal.rows(); ++k)
            e[j] += compliance[k] * r.modal(k, j) * r.modal(k, j);
    }
    return e;
}

// Differences of which so little is left have lost too many digits.
bool has_lost_digits(const Matrix &before, const Matrix &after) {
    constexpr double least = 1e-6;
    for (std::int64_t j = 0; j < after.cols(); ++j)
        if (!(after(j, j) >= least * before(j, j))) return true;
    return false;
}

} // namespace

ActingForces::ActingForces(const Structure &structure)
    : structure_(structure),
      loads_(load_columns(structure.preload(), structure.excitation(), structure.n_free())) {}

Field ActingForces::combine(const Matrix &t) const {
    const std::int64_t contact = n_contact(), loads = loads_.cols();
    Matrix on_contact(contact, t.cols()), on_loads(loads, t.cols());
    for (std::int64_t j = 0; j < t.cols(); ++j) {
        std::copy_n(t.col(j), contact, on_contact.col(j));
        std::copy_n(t.col(j) + contact, loads, on_loads.col(j));
    }
    Field f = structure_.gap_rows().forces(on_contact);
    if (loads > 0) add_combination(1.0, loads_, on_loads, f);
    return f;
}

Matrix ActingForces::products(const Field &x) const {
    const Matrix gaps = structure_.gap_rows().of(x), works = gram(loads_, x);
    Matrix p(count(), x.cols());
    for (std::int64_t j = 0; j < x.cols(); ++j) {
        std::copy_n(gaps.col(j), gaps.rows(), p.col(j));
        std::copy_n(works.col(j), works.rows(), p.col(j) + gaps.rows());
    }
    return p;
}

vector<double> StaticResponses::whole_energies(double shift) const {
    return energies_with(*this, compliances(*modes, shift, 1));
}

vector<double> StaticResponses::elastic_energies(double shift) const {
    std::int64_t first = 0;
    while (first < modes->count() && modes->values[first] == 0) ++first;
    return energies_with(*this, compliances(*modes, shift, 1, first));
}

StaticResponses static_responses(const Structure &structure, std::shared_ptr<const ExactModes> modes,
                                 Watch watch) {
    const ActingForces forces(structure);
    const std::int64_t n = forces.count();
    StaticResponses r{modes, Matrix(modes->count(), n), Matrix(n, n), Matrix(n, n)};
    for (std::int64_t first = 0; first < n; first += solved_at_once) {
        watch.step("contact flexibility", static_cast<double>(first) / static_cast<double>(n));
        const std::int64_t count = std::min(solved_at_once, n - first);
        Field x = forces.combine(unit_columns(n, first, count));
        put_columns(gram(modes->vectors, x), first, r.modal);
        modes->take_from_forces(x);
        const Field f = x;
        respond_outside(structure, *modes, x);
        put_columns(forces.products(x), first, r.energy);
        const vector<double> own = column_products(f, x); // exact where the modes are nearly all of it
        for (std::int64_t j = 0; j < count; ++j) r.energy(first + j, first + j) = own[j];
        x = structure.mass_times(x);
        respond_outside(structure, *modes, x);
        put_columns(forces.products(x), first, r.inertia);
    }
    symmetrise(r.energy);
    symmetrise(r.inertia);
    return r;
}

StaticResponses outside_more_modes(const Structure &structure, const StaticResponses &earlier,
                                   std::shared_ptr<const ExactModes> modes, Watch watch) {
    const ActingForces forces(structure);
    StaticResponses r{modes, forces.products(modes->vectors).transposed(), earlier.energy, earlier.inertia};
    Matrix beyond = r.modal; // of the forces outside the earlier modes
    if (earlier.modes->count() > 0)
        gemm('N', 'N', -1.0, gram(modes->vectors, earlier.modes->momenta), earlier.modal, 1.0, beyond);
    const double shift = structure.shift();
    add_modal(-1.0, beyond, compliances(*modes, shift, 1), r.energy);
    add_modal(-1.0, beyond, compliances(*modes, shift, 2), r.inertia);
    if (has_lost_digits(earlier.energy, r.energy) || has_lost_digits(earlier.inertia, r.inertia))
        return static_responses(structure, std::move(modes), watch);
    symmetrise(r.energy);
    symmetrise(r.inertia);
    return r;
}

StaticResponses outside_first_modes(const Structure &structure, const StaticResponses &earlier,
                                    std::int64_t count) {
    StaticResponses r = earlier;
    r.modes = std::make_shared<const ExactModes>(earlier.modes->first(count));
    const double shift = structure.shift();
    add_modal(1.0, earlier.modal, compliances(*earlier.modes, shift, 1, count), r.energy);
    add_modal(1.0, earlier.modal, compliances(*earlier.modes, shift, 2, count), r.inertia);
    r.modal.reset(count, earlier.modal.cols());
    for (std::int64_t j = 0; j < r.modal.cols(); ++j)
        std::copy_n(earlier.modal.col(j), count, r.modal.col(j));
    return r;
}

} // namespace plm
