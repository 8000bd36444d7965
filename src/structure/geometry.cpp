#include "structure/geometry.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

double median(vector<double> &values) { // 0 of none
    if (values.empty()) return 0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

// The six of every DOF: a matrix has some eighty entries to a row.
template <class Value> vector<std::array<double, 6>> motions_by(std::int64_t n, Value value) {
    vector<std::array<double, 6>> all(static_cast<std::size_t>(n));
    for (std::int64_t dof = 0; dof < n; ++dof)
        for (std::size_t motion = 0; motion < 6; ++motion) all[dof][motion] = value(dof, motion);
    return all;
}

} // namespace

Geometry::Geometry(const vector<CoupledNode> &nodes, std::int64_t n_dof)
    : nodes_(nodes), places_(static_cast<std::size_t>(nodes.empty() ? 0 : n_dof)) {
    if (nodes.empty()) return;
    low_ = high_ = nodes.front().at;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        std::size_t count = 0;
        for (std::size_t c = 0; c < 6; ++c)
            if (nodes[i].dof[c] != no_dof)
                places_[nodes[i].dof[c]] = {static_cast<std::int64_t>(i), c}, ++count;
        ++nodes_of_dofs_[count];
        for (std::size_t k = 0; k < 3; ++k) {
            low_[k] = std::min(low_[k], nodes[i].at[k]);
            high_[k] = std::max(high_[k], nodes[i].at[k]);
        }
    }
    n_others_ = std::count_if(places_.begin(), places_.end(), [](const Place &p) { return p.node < 0; });
    for (std::size_t k = 0; k < 3; ++k) middle_[k] = 0.5 * (low_[k] + high_[k]);
}

double Geometry::value(std::int64_t dof, std::size_t motion) const {
    const Place &p = places_[dof];
    if (p.node < 0) return 0;
    if (motion < 3 || p.component >= 3) return p.component == motion ? 1 : 0;
    Point axis{};
    axis[motion - 3] = 1;
    return cross(axis, difference(at(dof), middle_))[p.component];
}

void Geometry::take_stiffness(const SparseMatrix &k, const vector<std::int64_t> &multipliers) {
    if (!is_known()) return;
    constexpr double rounding = 1e-6; // of printed matrices
    vector<char> is_multiplier(places_.size(), 0);
    for (std::int64_t dof : multipliers) is_multiplier[dof] = 1;
    stiffness_.assign(nodes_.size(), 0.0);
    nearest_.assign(nodes_.size(), INFINITY);
    strains_ = {};
    const auto moves =
        motions_by(k.cols, [&](std::int64_t dof, std::size_t motion) { return value(dof, motion); });
    for (std::int64_t j = 0; j < k.cols; ++j) {
        const Place &place = places_[j];
        if (is_multiplier[j] || place.node < 0) continue;
        std::array<double, 6> force{}, size{};
        for (std::int64_t p = k.ptr[j]; p < k.ptr[j + 1]; ++p) {
            const std::int64_t i = k.idx[p];
            if (is_multiplier[i] || places_[i].node < 0 || k.val[p] == 0) continue;
            for (std::size_t motion = 0; motion < 6; ++motion) {
                const double term = k.val[p] * moves[i][motion];
                force[motion] += term, size[motion] += std::abs(term);
            }
            if (places_[i].node == place.node || place.component >= 3) continue;
            const double apart = length(difference(at(i), at(j)));
            if (apart > 0) nearest_[place.node] = std::min(nearest_[place.node], apart);
        }
        for (std::int64_t p = k.ptr[j]; p < k.ptr[j + 1]; ++p)
            if (k.idx[p] == j && place.component < 3)
                stiffness_[place.node] = std::max(stiffness_[place.node], k.val[p]);
        for (std::size_t motion = 0; motion < 6; ++motion) {
            Strain &s = strains_[motion];
            s.moves = s.moves || moves[j][motion] != 0;
            if (std::abs(force[motion]) <= rounding * size[motion]) continue;
            if (s.count++ == 0) s.first = j;
            s.largest = std::max(s.largest, std::abs(force[motion]) / size[motion]);
        }
    }
}

// Between two nodes at a distance h, with half the mass of what is between each and its neighbours, k = E A /
// h each way and m = rho A h: k / m = 2 (c / h)^2.
void Geometry::take_mass(const SparseMatrix &m) {
    if (!is_known()) return;
    inertia_.reset(6, 6);
    const auto moves =
        motions_by(m.cols, [&](std::int64_t dof, std::size_t motion) { return value(dof, motion); });
    vector<double> mass(nodes_.size(), 0.0);
    for (std::int64_t j = 0; j < m.cols; ++j) {
        const Place &place = places_[j];
        if (place.node < 0) continue;
        std::array<double, 6> force{};
        double sum = 0;
        for (std::int64_t p = m.ptr[j]; p < m.ptr[j + 1]; ++p) {
            for (std::size_t motion = 0; motion < 6; ++motion)
                force[motion] += m.val[p] * moves[m.idx[p]][motion];
            const Place &other = places_[m.idx[p]];
            if (other.node >= 0 && other.component == place.component) sum += m.val[p];
        }
        for (std::size_t a = 0; a < 6; ++a)
            for (std::size_t b = 0; b < 6; ++b) inertia_(a, b) += moves[j][a] * force[b];
        if (place.component < 3) mass[place.node] = std::max(mass[place.node], sum);
    }
    vector<double> speeds, densities;
    for (std::size_t i = 0; i < nodes_.size(); ++i)
        if (mass[i] > 0 && stiffness_[i] > 0 && std::isfinite(nearest_[i]))
            speeds.push_back(nearest_[i] * std::sqrt(0.5 * stiffness_[i] / mass[i])),
                densities.push_back(mass[i] / (nearest_[i] * nearest_[i] * nearest_[i]));
    wave_speed_ = median(speeds);
    const auto &count = nodes_of_dofs_;
    density_ = count[4] + count[5] + count[6] > 0 ? 0 : median(densities);
}

// A velocity t + w x r: the momentum of a rotation is the mass times w x (centre - middle).
Geometry::Body Geometry::body() const {
    Body b{};
    for (std::size_t k = 0; k < 3; ++k) b.mass[k] = inertia_(k, k);
    Point offset{};
    for (std::size_t k = 0; k < 3; ++k) {
        // e_i . (e_j x r) = r_k for (i, j, k) cyclic, and -r_k with i and j exchanged
        const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
        double moment = 0, mass = 0;
        if (b.mass[i] > 0) moment += inertia_(i, 3 + j), mass += b.mass[i];
        if (b.mass[j] > 0) moment -= inertia_(j, 3 + i), mass += b.mass[j];
        offset[k] = mass > 0 ? moment / mass : 0;
        b.centre[k] = middle_[k] + offset[k];
    }
    const auto &m = b.mass;
    const auto &r = offset;
    b.inertia = {inertia_(3, 3) - m[1] * r[2] * r[2] - m[2] * r[1] * r[1],
                 inertia_(4, 4) - m[0] * r[2] * r[2] - m[2] * r[0] * r[0],
                 inertia_(5, 5) - m[0] * r[1] * r[1] - m[1] * r[0] * r[0],
                 inertia_(3, 4) + m[2] * r[0] * r[1],
                 inertia_(3, 5) + m[1] * r[0] * r[2],
                 inertia_(4, 5) + m[0] * r[1] * r[2]};
    return b;
}

double Geometry::moved(const DofTerms &row, std::size_t motion) const {
    double sum = 0;
    for (const DofTerm &t : row) sum += t.coefficient * value(t.dof, motion);
    return sum;
}

double Geometry::size_moved(const DofTerms &row, std::size_t motion) const {
    double sum = 0;
    for (const DofTerm &t : row)
        if (places_[t.dof].node >= 0)
            sum += std::abs(t.coefficient) * (motion < 3 || places_[t.dof].component >= 3 ? 1 : size());
    return sum;
}

bool Geometry::distance(const DofTerms &row, double &apart) const {
    apart = 0;
    Point sum{}, most{};
    for (const DofTerm &t : row) {
        const Place &p = places_[t.dof];
        if (p.node < 0 || p.component >= 3) return false;
        apart += t.coefficient * (at(t.dof)[p.component] - middle_[p.component]);
        sum[p.component] += t.coefficient;
        most[p.component] = std::max(most[p.component], std::abs(t.coefficient));
    }
    for (std::size_t k = 0; k < 3; ++k)
        if (std::abs(sum[k]) > 1e-6 * most[k]) return false;
    return true;
}

double Geometry::sideways(const DofTerms &row) const {
    std::int64_t nodes[2] = {-1, -1};
    Point normal{};
    for (const DofTerm &t : row) {
        const Place &p = places_[t.dof];
        if (p.node < 0 || p.component >= 3) return 0;
        if (nodes[0] < 0) nodes[0] = p.node;
        if (p.node != nodes[0] && nodes[1] < 0) nodes[1] = p.node;
        if (p.node != nodes[0] && p.node != nodes[1]) return 0;
        if (p.node == nodes[0]) normal[p.component] += t.coefficient;
    }
    const double size = length(normal);
    if (nodes[1] < 0 || !(size > 0)) return 0;
    const Point between = difference(nodes_[static_cast<std::size_t>(nodes[0])].at,
                                     nodes_[static_cast<std::size_t>(nodes[1])].at);
    return length(cross(between, normal)) / size;
}

} // namespace plm
