// What acts on the flow over a piece of its series, as powers of the time: loads, springs, damping.
#include "orbits/exact_flow.hpp"
#include <algorithm>
#include <cmath>

namespace plm {

std::int64_t ExactFlow::n_force_terms() const {
    return model_->n_massive() < model_->size() ? n_terms_ : std::max<std::int64_t>(n_terms_ - 2, 1);
}

// Taylor coefficients of all forces but K y. The gaps act through the springs of the pairs, too, and so does
// what the forces do at the contact by themselves where there is no mass.
void ExactFlow::expand_forces(double time, double duration, Series &series) {
    series.force.reset(model_->size(), n_terms_);
    if (&series == &derivative_)
        expand_change_of_loads(time, duration, series.force);
    else
        expand_loads(time, duration, series.force);
    expand_offsets(series);
    if (&series == &derivative_ && model_->n_following() == 0)
        return; // the gaps stay, and so do their forces
    series.still.reset(model_->n_pairs(), model_->n_following() > 0 ? n_terms_ : 1);
    if (model_->n_pairs() == 0) return;
    std::copy_n(series.offset.data(), series.still.rows() * series.still.cols(), series.still.data());
    set_->add_contact(series.still, contact_force_);
    for (std::int64_t k = 0; k < series.still.cols(); ++k) {
        gemv('T', -1.0, model_->gap(), contact_force_.col(k), 0.0, following_.data());
        for (std::int64_t j = 0; j < model_->n_moving(); ++j) series.force(j, k) += following_[j];
    }
}

// Re(F_h exp(i h w t)) has F_h exp(i h w t_0) (i h w duration)^k / k!.
void ExactFlow::expand_loads(double time, double duration, Matrix &force) const {
    const std::int64_t n = model_->size(), count = n_force_terms();
    for (std::int64_t j = 0; j < n; ++j) force(j, 0) = model_->preload()[j];
    for (const auto &[harmonic, load] : model_->excitation()) {
        const double step = static_cast<double>(harmonic) * omega_ * duration;
        std::complex<double> z =
            force_scale_ * std::polar(1.0, static_cast<double>(harmonic) * omega_ * time);
        for (std::int64_t k = 0; k < count; ++k) {
            double *f = force.col(k);
            for (std::int64_t j = 0; j < n; ++j) f[j] += z.real() * load.real[j];
            if (harmonic == 0) break;
            for (std::int64_t j = 0; j < n; ++j) f[j] -= z.imag() * load.imag[j];
            z *= std::complex<double>(0.0, step / static_cast<double>(k + 1));
        }
    }
}

// By the force scale: f / force_scale. By the frequency: with x = w - (t / omega) x', w' = A w + (t / omega)
// df/dt, so t Re(i h F_h exp(i h w t)), whose powers of s are those of the exponential times t_0 and, one on,
// the duration.
void ExactFlow::expand_change_of_loads(double time, double duration, Matrix &force) const {
    const std::int64_t n = model_->size(), count = n_force_terms();
    const bool by_frequency = parameter_ == FlowParameter::frequency;
    for (const auto &[harmonic, load] : model_->excitation()) {
        if (by_frequency && harmonic == 0) continue;
        const double h = static_cast<double>(harmonic), step = h * omega_ * duration;
        std::complex<double> z = std::polar(1.0, h * omega_ * time), before = 0;
        if (by_frequency) z *= std::complex<double>(0.0, force_scale_ * h);
        for (std::int64_t k = 0; k < count; ++k) {
            const std::complex<double> now = by_frequency ? time * z + duration * before : z;
            double *f = force.col(k);
            for (std::int64_t j = 0; j < n; ++j) f[j] += now.real() * load.real[j];
            if (harmonic == 0) break;
            for (std::int64_t j = 0; j < n; ++j) f[j] -= now.imag() * load.imag[j];
            before = z;
            z *= std::complex<double>(0.0, step / static_cast<double>(k + 1));
        }
    }
}

// Penetrations with the moving coordinates at zero, without contact forces.
void ExactFlow::expand_offsets(Series &series) {
    const std::int64_t moving = model_->n_moving(), n = model_->n_following(), z = model_->n_pairs();
    series.offset.reset(z, n > 0 ? n_terms_ : 1);
    std::fill(following_.begin(), following_.end(), 0.0);
    for (std::int64_t k = 0; k < series.offset.cols() && n > 0 && z > 0; ++k) {
        for (std::int64_t j = moving; j < moving + n; ++j)
            following_[j] = series.force(j, k) / model_->lambda()[j];
        gemv('N', 1.0, model_->gap(), following_.data(), 0.0, series.offset.col(k));
    }
    if (&series == &derivative_) return; // the gaps stay
    for (std::int64_t i = 0; i < z; ++i) series.offset(i, 0) -= model_->initial_gap()[i];
}

bool ExactFlow::correct_sides(const FlowState &state, double duration,
                              const PiecePenetrations &penetrations) {
    const std::int64_t n = model_->size();
    return events_.correct(penetrations, norm2(n, state.y.data()) + duration * norm2(n, state.v.data()));
}

} // namespace plm
