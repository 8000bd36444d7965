// The work of the motion in the modes of a contact set against a harmonic load: every part of the motion is
// one exponential, with which the cosine and the sine of the load are integrated in closed form.
#include "linalg/work.hpp"
#include "orbits/exponential_integrals.hpp"
#include "orbits/modal_pieces.hpp"

namespace plm {
namespace {

using Complex = std::complex<double>;

// A part Re(z exp(rate t)) of the motion, seen by the load's real and imaginary part.
struct Seen {
    Complex real, imaginary;

    double work(const HarmonicIntegrals &w) const { return (real * w.cosine - imaginary * w.sine).real(); }
};

// A row of the coordinates; Re((row_j - i row_j+1) z) is what the coordinates (Re z, Im z) of a mode do in
// it.
Complex seen_by(const vector<double> &row, const ContactModes::Mode &m, Complex z) {
    return Complex(row[m.first], m.is_pair ? -row[m.first + 1] : 0.0) * z;
}

} // namespace

double ModalPieces::work(const HarmonicLoad &load, double frequency, double duration) const {
    const std::size_t size = static_cast<std::size_t>(modes_->size()),
                      following = static_cast<std::size_t>(model_.n_moving());
    worked(static_cast<double>(2 * flops_of_mode * modes_->size() + 4 * model_.size() * modes_->size()));
    vector<double> real(size), imaginary(size, 0.0);
    gemv('T', 1.0, modes_->displacement(), load.real.data(), 0.0, real.data());
    if (!load.imag.empty()) gemv('T', 1.0, modes_->displacement(), load.imag.data(), 0.0, imaginary.data());
    const auto of_mode = [&](const ContactModes::Mode &m, Complex z) -> Seen {
        return {seen_by(real, m, z), seen_by(imaginary, m, z)};
    };
    const auto add_aside = [&](const vector<double> &at_once, Complex factor, Seen &sum) {
        for (std::size_t i = 0; i < at_once.size(); ++i) {
            sum.real += load.real[following + i] * at_once[i] * factor;
            if (!load.imag.empty()) sum.imaginary += load.imag[following + i] * at_once[i] * factor;
        }
    };
    const auto integrals = [&](Complex rate) { return harmonic_integrals(rate, frequency, now_, duration); };
    Seen still = {dot(static_cast<std::int64_t>(size), real.data(), constant_.data()),
                  dot(static_cast<std::int64_t>(size), imaginary.data(), constant_.data())};
    add_aside(modes_->constant_load().following, 1.0, still);
    double sum = still.work(integrals(0));
    for (const ContactModes::Mode &m : modes_->modes())
        sum +=
            of_mode(m, {present_[m.first], m.is_pair ? present_[m.first + 1] : 0.0}).work(integrals(m.rate));
    for (std::size_t l = 0; l < steady_.size(); ++l) {
        const ContactModes::Harmonic &of = modes_->loads()[l];
        const double w = of.frequency(omega_);
        const Complex z = scale(of) * std::polar(1.0, w * now_);
        Seen ahead, back;
        for (std::size_t k = 0; k < steady_[l].size(); ++k) {
            const Seen plus = of_mode(modes_->modes()[k], z * steady_[l][k].plus),
                       minus = of_mode(modes_->modes()[k], std::conj(z) * steady_[l][k].minus);
            ahead.real += plus.real, ahead.imaginary += plus.imaginary;
            back.real += minus.real, back.imaginary += minus.imaginary;
        }
        if (puts_aside_) {
            add_aside(of.real.following, z, ahead);
            add_aside(of.imag.following, Complex(0, 1) * z, ahead);
        }
        sum += ahead.work(integrals({0, w})) + back.work(integrals({0, -w}));
    }
    return sum;
}

} // namespace plm
