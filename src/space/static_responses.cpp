#include "space/static_responses.hpp"
#include "linalg/lapack.hpp"
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

namespace plm {
namespace {

Matrix unit_columns(std::int64_t rows, const vector<std::int64_t> &chosen) {
    Matrix e(rows, static_cast<std::int64_t>(chosen.size()));
    for (std::int64_t j = 0; j < e.cols(); ++j) e(chosen[j], j) = 1;
    return e;
}

void put_columns(const Matrix &columns, const vector<std::int64_t> &chosen, Matrix &into) {
    for (std::int64_t j = 0; j < columns.cols(); ++j)
        std::copy_n(columns.col(j), columns.rows(), into.col(chosen[j]));
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
      loads_(load_columns(structure.preload(), structure.excitation(), structure.zeros(0))) {}

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

namespace {

/// Some columns of the matrices, by two solutions each.
void solve_for(const vector<std::int64_t> &chosen, const Structure &structure, const ActingForces &forces,
               StaticResponses &r, Watch watch) {
    const std::int64_t n = forces.count(), all = static_cast<std::int64_t>(chosen.size());
    for (std::int64_t first = 0; first < all; first += solved_at_once) {
        watch.step("contact flexibility", static_cast<double>(first) / static_cast<double>(all));
        const vector<std::int64_t> some(chosen.begin() + first,
                                        chosen.begin() + std::min(all, first + solved_at_once));
        Field x = forces.combine(unit_columns(n, some));
        put_columns(gram(r.modes->vectors, x), some, r.modal);
        r.modes->take_from_forces(x);
        const Field f = x;
        respond_outside(structure, *r.modes, x);
        put_columns(forces.products(x), some, r.energy);
        const vector<double> own = column_products(f, x); // exact where the modes are nearly all of it
        for (std::size_t j = 0; j < some.size(); ++j) r.energy(some[j], some[j]) = own[j];
        x = structure.mass_times(x);
        respond_outside(structure, *r.modes, x);
        put_columns(forces.products(x), some, r.inertia);
    }
}

/// Of the matrix of those columns: its rows become the same.
void mirror(const vector<std::int64_t> &columns, Matrix &a) {
    for (std::int64_t j : columns)
        for (std::int64_t i = 0; i < a.rows(); ++i) a(j, i) = a(i, j);
}

/// Energies scaled to one that are as independent as rounding of what was taken from them asks for.
bool are_independent(const Matrix &energy) {
    constexpr double least = 1e-8;
    Matrix scaled = energy;
    for (std::int64_t j = 0; j < energy.cols(); ++j)
        for (std::int64_t i = 0; i < energy.rows(); ++i)
            scaled(i, j) = energy(i, i) > 0 && energy(j, j) > 0
                               ? energy(i, j) / std::sqrt(energy(i, i)) / std::sqrt(energy(j, j))
                               : 0;
    for (std::int64_t j = 0; j < energy.cols(); ++j) scaled(j, j) = 1 - least;
    return DenseCholesky().factor(scaled);
}

/// Of what there was: when less is left, the modes were nearly all of it.
constexpr double least_energy = 1e-3, least_inertia = 1e-6;

/// Columns of which they were.
vector<std::int64_t> columns_lost(const StaticResponses &before, const StaticResponses &after) {
    vector<std::int64_t> lost;
    for (std::int64_t j = 0; j < after.energy.cols(); ++j)
        if (!(after.energy(j, j) >= least_energy * before.energy(j, j) &&
              after.inertia(j, j) >= least_inertia * before.inertia(j, j)))
            lost.push_back(j);
    return lost;
}

/// Whether the modes are nearly all of some responses, picked evenly: then of most others, too.
bool modes_prevail(const Structure &structure, const ActingForces &forces,
                   const std::shared_ptr<const ExactModes> &modes, Watch watch) {
    constexpr std::int64_t picked = 16, worth_a_look = 256; // forces: below it products are cheap
    const std::int64_t n = forces.count();
    if (n < worth_a_look) return false;
    vector<std::int64_t> some(picked);
    for (std::int64_t k = 0; k < picked; ++k) some[k] = k * n / picked;
    StaticResponses r{modes, Matrix(modes->count(), n), Matrix(n, n), Matrix(n, n)};
    solve_for(some, structure, forces, r, watch);
    const vector<double> whole = r.whole_energies(structure.shift());
    const auto lost = std::count_if(some.begin(), some.end(), [&](std::int64_t j) {
        return !(r.energy(j, j) >= least_energy * whole[j]);
    });
    return 2 * lost > picked;
}

/// From the matrices of the responses with the modes in them. Nothing where these are not to be had, or the
/// modes, soft ones among them, leave too few digits.
std::optional<StaticResponses> less_the_modes(const Structure &structure, const ActingForces &forces,
                                              std::shared_ptr<const ExactModes> modes, Watch watch) {
    watch.step("contact flexibility", 0);
    StaticResponses whole;
    if (structure.n_rigid() > 0 || modes_prevail(structure, forces, modes, watch)) return {};
    if (!forces.multiply_responses(whole.energy, whole.inertia)) return {};
    StaticResponses r{modes, forces.products(modes->vectors).transposed(), whole.energy, whole.inertia};
    add_modal(-1.0, r.modal, compliances(*modes, structure.shift(), 1), r.energy);
    add_modal(-1.0, r.modal, compliances(*modes, structure.shift(), 2), r.inertia);
    const vector<std::int64_t> lost = columns_lost(whole, r);
    if (4 * static_cast<std::int64_t>(lost.size()) > forces.count()) return {};
    solve_for(lost, structure, forces, r, watch);
    mirror(lost, r.energy);
    mirror(lost, r.inertia);
    if (!are_independent(r.energy)) return {};
    return r;
}

} // namespace

StaticResponses static_responses(const Structure &structure, std::shared_ptr<const ExactModes> modes,
                                 Watch watch) {
    const ActingForces forces(structure);
    const std::int64_t n = forces.count();
    if (std::optional<StaticResponses> r = less_the_modes(structure, forces, modes, watch)) return *r;
    StaticResponses r{modes, Matrix(modes->count(), n), Matrix(n, n), Matrix(n, n)};
    vector<std::int64_t> all(n);
    std::iota(all.begin(), all.end(), 0);
    solve_for(all, structure, forces, r, watch);
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
