// What acts on the flow over a piece of its series, as powers of the time: loads, springs, damping.
#include "orbits/exact_flow.hpp"
#include "orbits/load_powers.hpp"
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
    expand_offsets(time, duration, series);
    if (&series == &derivative_ && !offsets_move()) return; // the gaps stay, and so do their forces
    series.still.reset(model_->n_pairs(), offsets_move() ? n_terms_ : 1);
    if (model_->n_pairs() == 0) return;
    std::copy_n(series.offset.data(), series.still.rows() * series.still.cols(), series.still.data());
    set_->add_contact(series.still, contact_force_);
    for (std::int64_t k = 0; k < series.still.cols(); ++k) {
        gemv('T', -1.0, model_->gap(), contact_force_.col(k), 0.0, following_.data());
        for (std::int64_t j = 0; j < model_->n_moving(); ++j) series.force(j, k) += following_[j];
    }
}

namespace {

void add_load(const HarmonicLoad &load, const vector<std::complex<double>> &powers, Matrix &force) {
    const std::int64_t n = force.rows();
    for (std::size_t k = 0; k < powers.size(); ++k) {
        double *f = force.col(static_cast<std::int64_t>(k));
        for (std::int64_t j = 0; j < n; ++j) f[j] += powers[k].real() * load.real[j];
        for (std::int64_t j = 0; j < n && !load.imag.empty(); ++j) f[j] -= powers[k].imag() * load.imag[j];
    }
}

} // namespace

vector<std::complex<double>> ExactFlow::powers_of_load(bool changed, const LoadPart &part, double time,
                                                       double duration, std::int64_t count) const {
    return changed ? changed_load_powers(parameter_, part, omega_, force_scale_, time, duration, count)
                   : load_powers(part, omega_, force_scale_, time, duration, count);
}

void ExactFlow::expand_loads(double time, double duration, Matrix &force) const {
    std::copy_n(model_->preload().data(), model_->size(), force.col(0));
    for (const auto &[part, load] : model_->excitation())
        add_load(load, powers_of_load(false, part, time, duration, n_force_terms()), force);
}

void ExactFlow::expand_change_of_loads(double time, double duration, Matrix &force) const {
    for (const auto &[part, load] : model_->excitation())
        add_load(load, powers_of_load(true, part, time, duration, n_force_terms()), force);
}

// Penetrations with the moving coordinates at zero, without contact forces.
void ExactFlow::expand_offsets(double time, double duration, Series &series) {
    const std::int64_t moving = model_->n_moving(), n = model_->n_following(), z = model_->n_pairs();
    series.offset.reset(z, offsets_move() ? n_terms_ : 1);
    std::fill(following_.begin(), following_.end(), 0.0);
    for (std::int64_t k = 0; k < series.offset.cols() && n > 0 && z > 0; ++k) {
        for (std::int64_t j = moving; j < moving + n; ++j)
            following_[j] = series.force(j, k) / model_->lambda()[j];
        gemv('N', 1.0, model_->gap(), following_.data(), 0.0, series.offset.col(k));
    }
    const auto powers_of = [&](const LoadPart &part) {
        return powers_of_load(&series == &derivative_, part, time, duration, series.offset.cols());
    };
    add_wall_powers(model_->contact(), -1, powers_of, series.offset);
    if (&series == &derivative_) return; // the initial gaps stay
    for (std::int64_t i = 0; i < z; ++i) series.offset(i, 0) -= model_->initial_gap()[i];
}

bool ExactFlow::correct_sides(const FlowState &state, double duration,
                              const PiecePenetrations &penetrations) {
    const std::int64_t n = model_->size();
    return events_.correct(penetrations, norm2(n, state.y.data()) + duration * norm2(n, state.v.data()));
}

} // namespace plm
