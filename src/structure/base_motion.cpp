#include "structure/base_motion.hpp"
#include "linalg/error.hpp"
#include "linalg/scale.hpp"
#include <algorithm>
#include <cmath>
#include <complex>

namespace plm {
namespace {

using Complex = std::complex<double>;
using Int = long long; // for printf

constexpr double left_by_rounding = 1e-12; // of the terms of a force: what rounding leaves of it
constexpr double meant_to_follow =
    1e-6; // of what a gap row makes of the base: solutions of K have fewer digits

// Marks what moves.
void require_fixed(const HarmonicLoad &load, const vector<char> &fixed, vector<char> &moves) {
    for (std::size_t dof = 0; dof < fixed.size(); ++dof) {
        const double size = std::hypot(load.real[dof], load.imag.empty() ? 0.0 : load.imag[dof]);
        if (size == 0) continue;
        moves[dof] = 1;
        if (!fixed[dof])
            throw Error(status::argument,
                        format("the base motion moves DOF %lld (counted from 0), which is not fixed: fix "
                               "it, for a motion can be prescribed to fixed DOFs only; entries of all "
                               "others must be zero",
                               Int(dof)))
                .argument("real")
                .index(static_cast<std::int64_t>(dof));
    }
}

// The displacement that goes with a value: a velocity over i h, an acceleration over -h^2, times
// omega^power.
Complex as_displacement(Complex value, const LoadPart &part) {
    for (int k = 0; k > part.power; --k) value /= Complex(0, part.harmonic);
    return value;
}

// excitation += factor (columns 2p and 2p + 1 of `of`), where there is anything.
void add_part(const LoadPart &part, Complex factor, const Field &of, std::int64_t p,
              HarmonicForces &excitation) {
    const Field real = of.columns(2 * p, 1), imag = of.columns(2 * p + 1, 1);
    if (std::hypot(column_norms(real)[0], column_norms(imag)[0]) == 0) return;
    HarmonicForce &force = excitation[part];
    for (Field *f : {&force.real, &force.imag})
        if (f->empty()) *f = Field(of.rows(), 1);
    add(factor.real(), real, force.real);
    add(-factor.imag(), imag, force.real);
    add(factor.imag(), real, force.imag);
    add(factor.real(), imag, force.imag);
}

// sum += factor x; size: of the terms of each column.
void add_term(double factor, const Field &x, Field &sum, vector<double> &size) {
    add(factor, x, sum);
    const vector<double> norms = column_norms(x);
    for (std::size_t j = 0; j < size.size(); ++j) size[j] = std::max(size[j], std::abs(factor) * norms[j]);
}

void clear_rounding(const vector<double> &size, Field &sum) {
    vector<double> keep = column_norms(sum);
    for (std::size_t j = 0; j < keep.size(); ++j) keep[j] = keep[j] > left_by_rounding * size[j] ? 1.0 : 0.0;
    sum.scale(keep);
}

} // namespace

BaseMotion::BaseMotion(const HarmonicLoads &prescribed, std::int64_t n_dof,
                       const vector<std::int64_t> &fixed_dofs, const vector<std::int64_t> &held,
                       const ConstraintRows &constraints) {
    if (prescribed.empty()) return;
    vector<char> fixed(static_cast<std::size_t>(n_dof), 0), moves(fixed);
    for (std::int64_t dof : fixed_dofs) fixed[static_cast<std::size_t>(dof)] = 1;
    moved_.reset(n_dof, 2 * static_cast<std::int64_t>(prescribed.size()));
    for (const auto &[part, load] : prescribed) {
        require_fixed(load, fixed, moves);
        const std::int64_t column = 2 * static_cast<std::int64_t>(parts_.size());
        for (std::int64_t i = 0; i < n_dof; ++i) {
            const std::size_t k = static_cast<std::size_t>(i);
            const Complex u = as_displacement({load.real[k], load.imag.empty() ? 0.0 : load.imag[k]}, part);
            moved_(i, column) = u.real();
            moved_(i, column + 1) = u.imag();
        }
        parts_.push_back(part);
    }
    if (constraints.n_rows() > 0) carry(moves, held, constraints);
}

// By a map of its own, in which what moves stays and gives what is tied to it, all other DOFs at zero: with
// what the free ones add by theirs, one of the motions that the constraints allow.
void BaseMotion::carry(const vector<char> &moves, const vector<std::int64_t> &held,
                       const ConstraintRows &constraints) {
    vector<std::int64_t> still;
    for (std::int64_t dof : held)
        if (!moves[static_cast<std::size_t>(dof)]) still.push_back(dof);
    const DofMap map(moved_.rows(), still, constraints, moves);
    vector<double> all(moves.size()), size(moves.size(), 0.0);
    for (std::int64_t j = 0; j < columns(); ++j)
        for (std::size_t dof = 0; dof < moves.size(); ++dof)
            size[dof] = std::max(size[dof], std::abs(moved_(static_cast<std::int64_t>(dof), j)));
    for (std::int64_t j = 0; j < columns(); ++j) {
        double *u = moved_.col(j);
        map.expand(map.free_part(u).data(), all.data());
        for (std::size_t dof = 0; dof < moves.size(); ++dof)
            if (moves[dof] && std::abs(all[dof] - u[dof]) > meant_to_follow * size[dof])
                throw Error(status::argument,
                            format("the base motion moves DOF %lld (counted from 0) otherwise than the "
                                   "constraints that tie it to other fixed DOFs let it: move all of these as "
                                   "the constraints say, or take the constraints away",
                                   Int(dof)))
                    .argument("real")
                    .index(static_cast<std::int64_t>(dof));
        std::copy(all.begin(), all.end(), u);
    }
}

void BaseMotion::mark_driven(vector<char> &moves) const {
    for (const Field &through : through_)
        for (std::int64_t j = 0; j < through.cols(); ++j)
            for (std::int64_t i = 0; i < through.rows(); ++i)
                if (through.at(i, j) != 0) moves[static_cast<std::size_t>(i)] = 1;
}

void BaseMotion::act(Through which, const SparseMatrix &all, const DofMap &dofs) {
    if (empty()) return;
    const Matrix forces = multiply_transposed(all, moved_);
    Matrix free(dofs.n_free(), columns());
    for (std::int64_t j = 0; j < columns(); ++j) {
        const vector<double> column = dofs.forces(forces.col(j));
        std::copy(column.begin(), column.end(), free.col(j));
    }
    through_[which] = Field(std::move(free));
}

void BaseMotion::follow(const TallFactor &factor) {
    lift_ = through_[stiffness];
    lift_.scale(vector<double>(static_cast<std::size_t>(columns()), -1.0));
    factor.solve(lift_);
}

void BaseMotion::add_forces(const Matrices &m, HarmonicForces &excitation) const {
    vector<double> size(static_cast<std::size_t>(columns()), 0.0), of_loss(size), of_rest(size);
    Field inertia(lift_.rows(), columns()), loss(inertia), rest(inertia);
    add_term(1, m.structure.mass().times(lift_), inertia, size);
    add_term(1, through_[mass], inertia, size);
    clear_rounding(size, inertia);
    if (m.shift > 0) { // it followed a structure that is held a little
        add_term(1, m.structure.stiffness().times(lift_), rest, of_rest);
        add_term(1, through_[stiffness], rest, of_rest);
        clear_rounding(of_rest, rest);
    }
    add_term(m.alpha, inertia, loss, of_loss);
    add_term(m.beta, rest, loss, of_loss);
    if (!through_[damping].empty()) {
        add_term(1, m.structure.damping()->times(lift_), loss, of_loss);
        add_term(1, through_[damping], loss, of_loss);
    }
    clear_rounding(of_loss, loss);
    for (std::size_t k = 0; k < parts_.size(); ++k) {
        const auto [h, power] = parts_[k];
        const auto p = static_cast<std::int64_t>(k);
        add_part({h, power + 2}, static_cast<double>(h) * h, inertia, p, excitation);
        add_part({h, power + 1}, Complex(0, -h), loss, p, excitation);
        add_part({h, power}, -Complex(1, m.structural), rest, p, excitation);
    }
}

KnownMotion BaseMotion::of(const DofTerms &sum, const DofMap &dofs, double omega) const {
    KnownMotion known;
    const DofTerms free = dofs.terms(sum);
    for (std::size_t k = 0; k < parts_.size(); ++k) {
        const auto column = 2 * static_cast<std::int64_t>(k);
        Complex u = 0;
        for (const DofTerm &t : sum)
            u += t.coefficient * Complex(moved_(t.dof, column), moved_(t.dof, column + 1));
        for (const DofTerm &t : free)
            u += t.coefficient * Complex(lift_.at(t.dof, column), lift_.at(t.dof, column + 1));
        known[parts_[k].harmonic] += parts_[k].growth(omega) * u;
    }
    return known;
}

std::vector<RowMotion> BaseMotion::row_motions(std::int64_t n_rows, const vector<std::int64_t> &row,
                                               const vector<std::int64_t> &dof,
                                               const vector<double> &coefficient, const DofMap &dofs) const {
    std::vector<RowMotion> motions;
    vector<double> all(static_cast<std::size_t>(dofs.n_dof()));
    for (std::size_t k = 0; k < parts_.size(); ++k) {
        vector<double> parts[2];
        bool moves = false;
        for (std::int64_t c = 0; c < 2; ++c) {
            const std::int64_t column = 2 * static_cast<std::int64_t>(k) + c;
            dofs.expand(lift_.column(column).data(), all.data());
            for (std::size_t i = 0; i < all.size(); ++i)
                all[i] += moved_(static_cast<std::int64_t>(i), column);
            const double largest = largest_of(all.data(), dofs.n_dof()); // a term may be rounding as a whole
            vector<double> sum(static_cast<std::size_t>(n_rows), 0.0), size(sum);
            for (std::size_t e = 0; e < row.size(); ++e) {
                const double term = coefficient[e] * all[static_cast<std::size_t>(dof[e])];
                sum[static_cast<std::size_t>(row[e])] -= term;
                size[static_cast<std::size_t>(row[e])] += std::abs(coefficient[e]) * largest;
            }
            for (std::size_t i = 0; i < sum.size(); ++i) {
                if (std::abs(sum[i]) <= meant_to_follow * size[i]) sum[i] = 0;
                moves = moves || sum[i] != 0;
            }
            parts[c] = std::move(sum);
        }
        if (moves) motions.push_back({parts_[k], std::move(parts[0]), std::move(parts[1])});
    }
    return motions;
}

} // namespace plm
