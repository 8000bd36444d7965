// The steady answers of the modes to the loads, which a piece of the flow has beside its free motion.
#include "orbits/modal_pieces.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

constexpr double nearest_resonance = 1e-7; // of the rate

} // namespace

// z' = lambda z + beta, beta = P B e^{iht} / 2 + P conj(B) e^{-iht} / 2, P = row c_1 + i row c_2 of the way
// into the coordinates.
bool ModalPieces::set_steady() {
    const std::size_t size = static_cast<std::size_t>(modes_->size());
    constant_.assign(size, 0.0);
    changed_constant_.assign(size, 0.0);
    const auto add_constant = [&](const vector<double> &load, double factor, vector<double> &to) {
        for (const ContactModes::Mode &m : modes_->modes()) {
            const std::size_t j = static_cast<std::size_t>(m.first);
            const Complex z = -factor * Complex(load[j], m.is_pair ? load[j + 1] : 0.0) / m.rate;
            to[j] += z.real();
            if (m.is_pair) to[j + 1] += z.imag();
        }
    };
    add_constant(modes_->constant_load().coordinates, 1.0, constant_);
    steady_.assign(modes_->loads().size(), {});
    for (std::size_t l = 0; l < steady_.size(); ++l) {
        const ContactModes::Harmonic &load = modes_->loads()[l];
        const vector<double> &cosine = load.real.coordinates, &sine = load.imag.coordinates;
        const double growth = load.part.growth(omega_), rate = load.part.growth_rate(omega_);
        if (load.part.harmonic == 0) {
            add_constant(cosine, scale(load), constant_);
            if (parameter_ == FlowParameter::force_scale) add_constant(cosine, growth, changed_constant_);
            if (parameter_ == FlowParameter::frequency)
                add_constant(cosine, force_scale_ * rate, changed_constant_);
            continue;
        }
        const double w = load.frequency(omega_);
        for (const ContactModes::Mode &m : modes_->modes()) {
            const std::size_t j = static_cast<std::size_t>(m.first);
            const Complex real(cosine[j], m.is_pair ? cosine[j + 1] : 0.0),
                imag(sine[j], m.is_pair ? sine[j + 1] : 0.0), i(0, 1);
            const Complex up = i * w - m.rate, down = -i * w - m.rate;
            if (std::min(std::abs(up), std::abs(down)) < nearest_resonance * std::abs(m.rate)) return false;
            Steady s;
            s.plus = 0.5 * (real + i * imag) / up;
            s.minus = 0.5 * (real - i * imag) / down;
            if (parameter_ == FlowParameter::frequency) {
                const Complex turn = i * (load.part.harmonic * scale(load));
                s.plus_slope = turn * s.plus;
                s.minus_slope = -turn * s.minus;
            }
            s.size = std::abs(s.plus) + std::abs(s.minus);
            steady_[l].push_back(s);
        }
    }
    return true;
}

void ModalPieces::steady_at(double time, vector<double> &motion, vector<double> *change) const {
    motion = constant_;
    if (change) *change = changed_constant_;
    for (std::size_t l = 0; l < steady_.size(); ++l) {
        if (steady_[l].empty()) continue;
        const ContactModes::Harmonic &load = modes_->loads()[l];
        const double w = load.frequency(omega_), size = scale(load);
        const double changed_size = parameter_ == FlowParameter::frequency
                                        ? force_scale_ * load.part.growth_rate(omega_)
                                        : load.part.growth(omega_);
        const Complex e = std::polar(1.0, w * time), back = std::conj(e);
        for (std::size_t k = 0; k < steady_[l].size(); ++k) {
            const ContactModes::Mode &m = modes_->modes()[k];
            const Steady &s = steady_[l][k];
            const std::size_t j = static_cast<std::size_t>(m.first);
            const Complex answer = s.plus * e + s.minus * back, z = size * answer;
            motion[j] += z.real();
            if (m.is_pair) motion[j + 1] += z.imag();
            if (!change) continue;
            Complex c = changed_size * answer;
            if (parameter_ == FlowParameter::frequency) { // (a t + b) e^{iht}: b = -a / (i h w - lambda)
                const Complex i(0, 1);
                c += s.plus_slope * e * (time - 1.0 / (i * w - m.rate)) +
                     s.minus_slope * back * (time - 1.0 / (-i * w - m.rate));
            }
            (*change)[j] += c.real();
            if (m.is_pair) (*change)[j + 1] += c.imag();
        }
    }
}

// plus exp(iwt) + minus exp(-iwt) of all modes: (iw duration)^k / k! is real for even k, imaginary for odd.
void ModalPieces::add_steady_powers(std::size_t load, double duration) {
    const double w = modes_->loads()[load].frequency(omega_);
    const Complex turned = scale(modes_->loads()[load]) * std::polar(1.0, w * now_);
    const std::size_t size = static_cast<std::size_t>(powers_.rows());
    even_.assign(size, 0.0);
    odd_.assign(size, 0.0);
    for (std::size_t j = 0; j < modes_->modes().size(); ++j) {
        const ContactModes::Mode &m = modes_->modes()[j];
        const std::size_t first = static_cast<std::size_t>(m.first);
        const Complex a = steady_[load][j].plus * turned, b = steady_[load][j].minus * std::conj(turned),
                      sum = a + b, way = a - b;
        even_[first] = sum.real();
        odd_[first] = -way.imag();
        if (!m.is_pair) continue;
        even_[first + 1] = sum.imag();
        odd_[first + 1] = way.real();
    }
    double power = 1;
    for (std::int64_t k = 0; k < n_terms_; ++k) {
        const double *part = (k % 2 == 0 ? even_ : odd_).data();
        double *sum = powers_.col(k);
        for (std::size_t j = 0; j < size; ++j) sum[j] += power * part[j];
        power *= w * duration * inverse_[static_cast<std::size_t>(k)] * (k % 2 == 0 ? 1 : -1);
    }
}

} // namespace plm
