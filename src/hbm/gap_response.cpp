#include "hbm/gap_response.hpp"

namespace plm {

GapResponse::GapResponse(std::shared_ptr<const ReducedModel> reduced, const LawForm &form,
                         std::int64_t n_harmonics)
    : m_(std::move(reduced)), slack_(form.slack), mean_(m_, form), harmonic_(n_harmonics + 1),
      real_(m_->size()), imag_(m_->size()) {}

void GapResponse::set_frequency(double omega) {
    if (omega == omega_) return;
    omega_ = -1; // an update may throw, and not all of them would be of one frequency
    for (std::size_t h = 1; h < harmonic_.size(); ++h)
        harmonic_[h].update(*m_, static_cast<std::int64_t>(h), omega, self_excitation_);
    omega_ = omega;
}

void GapResponse::set_self_excitation(double xi) {
    if (xi != self_excitation_) omega_ = -1;
    self_excitation_ = xi;
}

void GapResponse::gather(const double *c, const double *s, double factor, vector<Complex> &v) {
    gemv('T', factor, m_->gap, c, 0.0, real_.data());
    gemv('T', -factor, m_->gap, s, 0.0, imag_.data());
    v.resize(real_.size());
    for (std::size_t j = 0; j < v.size(); ++j) v[j] = Complex(real_[j], imag_[j]);
}

void GapResponse::write_gaps(const vector<Complex> &v, double factor, double *out) {
    for (std::size_t j = 0; j < v.size(); ++j) {
        real_[j] = v[j].real();
        imag_[j] = -v[j].imag();
    }
    gemv('N', factor, m_->gap, real_.data(), 0.0, out);
    gemv('N', factor, m_->gap, imag_.data(), 0.0, out + m_->n_pairs());
}

void GapResponse::receptance_of(std::int64_t h, const vector<std::int64_t> &pairs, Matrix &real,
                                Matrix &imag) {
    select_rows(h == 0 ? m_->gap_0 : m_->gap, pairs, rows_);
    if (h > 0) {
        harmonic_[h].contact_receptance(rows_, real, imag);
    } else {
        mean_.receptance(rows_, real);
        imag.reset(rows_.rows(), rows_.rows());
    }
    for (std::size_t p = 0; p < pairs.size(); ++p) real(p, p) -= slack_[pairs[p]];
}

void GapResponse::subtract(std::int64_t h, const vector<double> &c, const vector<double> &s, double *b) {
    const std::int64_t z = m_->n_pairs();
    if (h == 0) {
        vector<double> &v = mean_response_;
        v.resize(m_->static_size());
        gemv('T', 1.0, m_->gap_0, c.data(), 0.0, v.data());
        mean_.apply(v.data());
        gemv('N', -1.0, m_->gap_0, v.data(), 1.0, b);
        for (std::int64_t i = 0; i < z; ++i) b[i] += slack_[i] * c[i];
        return;
    }
    vector<Complex> &v = response_;
    gather(c.data(), s.data(), 1.0, v);
    harmonic_[h].apply(v.data());
    gaps_.resize(2 * z);
    write_gaps(v, 1.0, gaps_.data());
    double *cosine = b + (2 * h - 1) * z, *sine = cosine + z;
    for (std::int64_t k = 0; k < 2 * z; ++k) cosine[k] -= gaps_[k];
    for (std::int64_t i = 0; i < z; ++i) {
        cosine[i] += slack_[i] * c[i];
        sine[i] += slack_[i] * s[i];
    }
}

} // namespace plm
