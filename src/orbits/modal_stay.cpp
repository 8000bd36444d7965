// Stays in a contact set by their ends alone: where the motion is known in closed form, the zero of one pair
// is found by Newton's method, and what the others do between two instants follows from their values and
// rates there (contact/piece_events.hpp). No polynomials.
#include "linalg/work.hpp"
#include "orbits/modal_pieces.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

using Complex = std::complex<double>;

constexpr int most_tangents = 12;                // of Newton's method
constexpr double at_the_zero = 4e-16;            // of the time, of the last step
constexpr double square_root_of_rounding = 1e-8; // of the duration: the next step would be rounding

} // namespace

bool ModalPieces::begin_stay() {
    if (modes_->free_block().rows() > 0) return false;
    sum_rounding();
    ahead_.reset(modes_->size(), 2);
    return true;
}

void ModalPieces::look(double duration, Matrix &u) {
    const std::int64_t z = modes_->gap_by_pair().cols(), n = modes_->size();
    worked(static_cast<double>(4 * n * z + flops_of_mode * n));
    const double time = now_ + duration;
    double *c = ahead_.col(0), *rate = ahead_.col(1);
    for (std::size_t k = 0; k < modes_->modes().size(); ++k) {
        const ContactModes::Mode &m = modes_->modes()[k];
        const std::size_t j = static_cast<std::size_t>(m.first);
        const Complex q = std::exp(m.rate * duration) *
                          Complex(present_[j], m.is_pair ? present_[j + 1] : 0.0),
                      v = m.rate * q;
        c[j] = constant_[j] + q.real();
        rate[j] = v.real();
        if (!m.is_pair) continue;
        c[j + 1] = constant_[j + 1] + q.imag();
        rate[j + 1] = v.imag();
    }
    for (std::size_t l = 0; l < steady_.size(); ++l) {
        const double w = modes_->loads()[l].frequency(omega_);
        const Complex e = scale(modes_->loads()[l]) * std::polar(1.0, w * time), turning = Complex(0, w);
        for (std::size_t k = 0; k < steady_[l].size(); ++k) {
            const ContactModes::Mode &m = modes_->modes()[k];
            const Complex a = steady_[l][k].plus * e, b = steady_[l][k].minus * std::conj(e), q = a + b,
                          v = turning * (a - b);
            c[m.first] += q.real();
            rate[m.first] += v.real();
            if (!m.is_pair) continue;
            c[m.first + 1] += q.imag();
            rate[m.first + 1] += v.imag();
        }
    }
    u.reset(z, 2);
    put_aside(&ContactModes::Load::gap, time, aside_);
    std::copy(aside_.begin(), aside_.end(), u.col(0));
    for (const ContactModes::Harmonic &load : modes_->loads()) {
        if (!puts_aside_) break;
        const double w = load.frequency(omega_);
        const Complex v = Complex(0, w) * scale(load) * std::polar(1.0, w * time);
        for (std::int64_t i = 0; i < z; ++i)
            u(i, 1) += v.real() * load.real.gap[i] - v.imag() * load.imag.gap[i];
    }
    if (z > 0) gemm('T', 'N', 1.0, modes_->gap_by_pair(), ahead_, 1.0, u);
}

const vector<double> &ModalPieces::fourth(double duration) {
    const auto power = [](double w) { return w * w * w * w; };
    way_.assign(modes_->modes().size(), 0.0);
    for (std::size_t k = 0; k < way_.size(); ++k) {
        const ContactModes::Mode &m = modes_->modes()[k];
        const double grows = m.rate.real() > 0 ? std::exp(m.rate.real() * duration) : 1.0;
        way_[k] = size_[k] * grows * power(m.speed);
        for (std::size_t l = 0; l < steady_.size(); ++l)
            if (!steady_[l].empty())
                way_[k] += std::abs(scale(modes_->loads()[l])) * steady_[l][k].size *
                           power(modes_->loads()[l].frequency(omega_));
    }
    worked(static_cast<double>(2 * way_.size() * tiny_.size()));
    fourth_.assign(tiny_.size(), 0.0);
    if (!tiny_.empty()) gemv('N', 1.0, modes_->reach(), way_.data(), 0.0, fourth_.data());
    for (const ContactModes::Harmonic &load : modes_->loads())
        for (std::size_t i = 0; puts_aside_ && i < fourth_.size(); ++i)
            fourth_[i] += std::abs(scale(load)) * power(load.frequency(omega_)) *
                          (std::abs(load.real.gap[i]) + std::abs(load.imag.gap[i]));
    return fourth_;
}

// Re(P e^{iwt}) of each load, and of each mode Re(g z) with g = row c_1 - i row c_2.
double ModalPieces::zero_of(std::int64_t pair, double guess) const {
    const double *row = modes_->gap_by_pair().col(pair);
    const auto gap_of = [&](const ContactModes::Mode &m) {
        return Complex(row[m.first], m.is_pair ? -row[m.first + 1] : 0.0);
    };
    std::vector<Complex> of_load(steady_.size()), of_mode;
    double constant = modes_->constant_load().gap[static_cast<std::size_t>(pair)];
    for (std::size_t j = 0; j < constant_.size(); ++j) constant += row[j] * constant_[j];
    for (std::size_t k = 0; k < modes_->modes().size(); ++k) {
        const ContactModes::Mode &m = modes_->modes()[k];
        const Complex g = gap_of(m);
        of_mode.push_back(g * Complex(present_[m.first], m.is_pair ? present_[m.first + 1] : 0.0));
        for (std::size_t l = 0; l < steady_.size(); ++l)
            if (!steady_[l].empty())
                of_load[l] +=
                    scale(modes_->loads()[l]) * (g * steady_[l][k].plus + std::conj(g * steady_[l][k].minus));
    }
    for (std::size_t l = 0; puts_aside_ && l < of_load.size(); ++l) {
        const ContactModes::Harmonic &load = modes_->loads()[l];
        const std::size_t i = static_cast<std::size_t>(pair);
        of_load[l] += scale(load) * Complex(load.real.gap[i], load.imag.gap[i]);
    }
    double at = guess;
    for (int step = 0; step < most_tangents; ++step) {
        worked(static_cast<double>(flops_of_mode * modes_->size()));
        double u = constant, rate = 0;
        for (std::size_t l = 0; l < of_load.size(); ++l) {
            const double w = modes_->loads()[l].frequency(omega_);
            const Complex q = of_load[l] * std::polar(1.0, w * (now_ + at));
            u += q.real();
            rate -= w * q.imag();
        }
        for (std::size_t k = 0; k < of_mode.size(); ++k) {
            const Complex &lambda = modes_->modes()[k].rate, q = of_mode[k] * std::exp(lambda * at);
            u += q.real();
            rate += (lambda * q).real();
        }
        const double change = u / rate;
        at -= change;
        if (!(std::abs(change) <= 2 * M_PI / omega_)) break;
        if (std::abs(change) <= at_the_zero * (now_ + std::abs(at)) ||
            std::abs(change) <= square_root_of_rounding * std::abs(at))
            return at;
    }
    return NAN;
}

} // namespace plm
