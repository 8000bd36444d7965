// What the transient tests share: flows of small structures, and the tests' own linear algebra on states.
#pragma once
#include "orbits/shooting.hpp"
#include "sampling/small_models.hpp"
#include "support/small_reduced.hpp"
#include "support/test.hpp"
#include <algorithm>

namespace test {

using plm::FlowState;
using plm::Matrix;

/// grow: with loads beside, in the harmonic of the force, in another and a mean, that grow with the
/// frequency.
inline std::shared_ptr<const plm::FlowModel> flow_model(const exact::Structure &s,
                                                        const plm::GapMotion &walls = {}, bool grow = false) {
    const auto reduced = reduce_exactly(s);
    reduced->contact.motion = walls;
    const plm::HarmonicLoad force = reduced->excitation.at(1);
    for (int power : {1, 2})
        if (grow) reduced->excitation[{power, power}] = force;
    for (double f : force.real)
        if (grow) reduced->excitation[{0, 2}].real.push_back(0.1 * f);
    return std::make_shared<plm::FlowModel>(reduced);
}

/// Of two pairs' walls: of the harmonic of the excitation and of one that it does not have, and one of which
/// the acceleration is given.
inline plm::GapMotion moving_walls() {
    return {{0, {{0.01}, {}}},
            {1, {{0.04, -0.03}, {0.02, 0.05}}},
            {3, {{0, 0.01}, {0.015}}},
            {{2, -2}, {{0.003}, {0.002, 0.004}}}};
}

/// A chain of four masses with pairs on two of them.
inline exact::Structure damped_chain() {
    exact::Structure s = chain(4, 0.03, 3, 0.05, 0.3, 0.02, {1, 3});
    s.damping[0] += 0.02;
    return s;
}

/// Modal state of q, q' given over the DOFs: the vectors are M-orthonormal.
inline FlowState to_state(const plm::FlowModel &m, const exact::Structure &s, const std::vector<double> &x) {
    FlowState state{plm::vector<double>(s.n), plm::vector<double>(s.n), 0};
    for (int j = 0; j < s.n; ++j)
        for (int i = 0; i < s.n; ++i) {
            state.y[j] += m.reduced().vectors.formed().at(i, j) * s.mass[i] * x[i];
            state.v[j] += m.reduced().vectors.formed().at(i, j) * s.mass[i] * x[s.n + i];
        }
    return state;
}

/// Trace of the damping, over a mass of 1.
inline double damping_trace(const plm::FlowModel &m) {
    double sum = 0;
    for (std::int64_t j = 0; j < m.n_massive(); ++j)
        sum += m.has_diagonal_damping() ? m.damping_diagonal()[j] : m.damping()(j, j);
    return sum;
}

/// q and q' over the DOFs.
inline std::vector<double> to_dofs(const plm::FlowModel &m, const FlowState &state) {
    std::vector<double> x;
    for (const plm::vector<double> &y : {state.y, state.v}) {
        const plm::Field q = m.field(y);
        for (std::int64_t i = 0; i < q.rows(); ++i) x.push_back(q.at(i));
    }
    return x;
}

inline double max_difference(const std::vector<double> &a, const std::vector<double> &b) {
    double d = a.size() == b.size() ? 0 : 1e300;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) d = std::max(d, std::abs(a[i] - b[i]));
    return d;
}

inline double max_difference(const Matrix &a, const Matrix &b) {
    double d = a.rows() == b.rows() && a.cols() == b.cols() ? 0 : 1e300;
    for (std::int64_t k = 0; k < a.rows() * a.cols(); ++k)
        d = std::max(d, std::abs(a.data()[k] - b.data()[k]));
    return d;
}

/// Energy of motion, springs and contact.
inline double energy(const plm::FlowModel &m, const FlowState &x) {
    double e = 0;
    for (std::int64_t j = 0; j < m.size(); ++j)
        e += 0.5 * x.v[j] * x.v[j] + 0.5 * m.lambda()[j] * x.y[j] * x.y[j] - m.preload()[j] * x.y[j];
    for (std::int64_t i = 0; i < m.n_pairs(); ++i) {
        double u = -m.initial_gap()[i];
        for (std::int64_t j = 0; j < m.size(); ++j) u += m.gap()(i, j) * x.y[j];
        e += plm::ContactLaw::energy(m.contact_stiffness()[i], u);
    }
    return e;
}

} // namespace test
