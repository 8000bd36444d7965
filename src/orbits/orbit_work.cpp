// In the modes of each contact set, forwards; for the derivative backwards, as the adjoint: a row of the
// coordinates of the present set's modes, to which each interval adds what its motions do in it.
#include "orbits/orbit_work.hpp"
#include "orbits/exponential_integrals.hpp"
#include "orbits/modal_pieces.hpp"
#include <cmath>

namespace plm {
namespace {

using Complex = std::complex<double>;

constexpr std::int64_t make_them = 1000000; // effort: modes of every set

// The row at the end of the interval becomes that at its beginning.
void pass_back(const ContactModes &modes, const HarmonicLoad &load, double omega, double t, double duration,
               vector<double> &row) {
    vector<double> real(row.size()), imaginary(row.size(), 0.0);
    gemv('T', 1.0, modes.displacement(), load.real.data(), 0.0, real.data());
    if (!load.imag.empty()) gemv('T', 1.0, modes.displacement(), load.imag.data(), 0.0, imaginary.data());
    for (const ContactModes::Mode &mode : modes.modes()) {
        const auto j = static_cast<std::size_t>(mode.first);
        const Complex end = std::exp(mode.rate * duration);
        const HarmonicIntegrals w = harmonic_integrals(mode.rate, omega, t, duration);
        if (!mode.is_pair) {
            row[j] = row[j] * end.real() + (real[j] * w.cosine - imaginary[j] * w.sine).real();
            continue;
        }
        const double first = row[j], second = row[j + 1];
        const Complex work =
            Complex(real[j], -real[j + 1]) * w.cosine - Complex(imaginary[j], -imaginary[j + 1]) * w.sine;
        row[j] = first * end.real() + second * end.imag() + work.real();
        row[j + 1] = second * end.real() - first * end.imag() - work.imag();
    }
}

} // namespace

double orbit_work(const FlowModel &model, FlowState state, double excitation, double force_scale,
                  const std::vector<ContactInterval> &intervals, const HarmonicLoad &load, double omega,
                  ContactModesKept &modes) {
    ModalPieces motion(model, excitation, force_scale, FlowParameter::none);
    FlowState no_change;
    double work = 0;
    for (const ContactInterval &interval : intervals) {
        auto here = modes.find(interval.states, make_them);
        if (!here || here->free_block().rows() > 0 || !motion.enter(std::move(here), state, no_change))
            return NAN;
        work += motion.work(load, omega, interval.duration);
        motion.advance(interval.duration);
        motion.leave(state, no_change);
    }
    return work;
}

vector<double> work_gradient(const FlowModel &model, const std::vector<ContactInterval> &intervals,
                             const HarmonicLoad &load, double omega, ContactModesKept &modes) {
    vector<double> row(static_cast<std::size_t>(model.state_size()), 0.0);
    double t = 0;
    for (const ContactInterval &interval : intervals) t += interval.duration;
    for (auto interval = intervals.rbegin(); interval != intervals.rend(); ++interval) {
        t -= interval->duration;
        const auto here = modes.find(interval->states, make_them);
        if (!here || here->free_block().rows() > 0) return {};
        here->enter_row(row);
        pass_back(*here, load, omega, t, interval->duration, row);
        here->leave_row(row);
    }
    return row;
}

} // namespace plm
