// The classical AFT: the indicator is sampled, its averages are its discrete Fourier transform.
#include "contact/contact_force.hpp"
#include "linalg/error.hpp"
#include "linalg/work.hpp"

namespace plm {
namespace {

class SampledForce final : public ContactForce {
  public:
    SampledForce(std::int64_t n_harmonics, std::int64_t n_samples, std::int64_t n_pairs)
        : h_(n_harmonics), displacement_(n_harmonics, n_samples), averages_(2 * n_harmonics, n_samples),
          coefficients_(2 * n_harmonics + 1, n_pairs), samples_(n_samples, n_pairs) {}

    void indicator(const Matrix &u, ContactIndicator &out) override {
        const std::int64_t z = u.rows();
        out.reset(h_, z);
        if (z == 0) return;
        for (std::int64_t i = 0; i < z; ++i)
            for (std::int64_t c = 0; c < u.cols(); ++c) coefficients_(c, i) = u(i, c);
        displacement_.to_time(coefficients_, samples_);
        for (std::int64_t i = 0; i < z; ++i) {
            std::int64_t n_closed = 0;
            worked(100.0 * static_cast<double>(samples_.rows())); // there and back, about
            for (std::int64_t t = 0; t < samples_.rows(); ++t) {
                const bool closed = ContactLaw::closed(samples_(t, i));
                samples_(t, i) = closed ? 1 : 0;
                n_closed += closed;
            }
            out.state[i] = n_closed == 0                 ? PairState::open
                           : n_closed == samples_.rows() ? PairState::closed
                                                         : PairState::switching;
            out.n_switching += out.state[i] == PairState::switching;
        }
        averages_.to_frequency(samples_, out.averages);
        // Fourier coefficients of s are twice its averages, but for the mean.
        for (std::int64_t i = 0; i < z; ++i)
            for (std::int64_t k = 1; k <= 4 * h_; ++k) out.averages(k, i) *= 0.5;
    }

  private:
    std::int64_t h_;
    Dft displacement_, averages_;
    Matrix coefficients_, samples_;
};

} // namespace

std::unique_ptr<ContactForce> make_sampled_force(std::int64_t n_harmonics, std::int64_t time_samples,
                                                 std::int64_t n_pairs) {
    if (time_samples < 4 * n_harmonics + 1)
        throw Error(status::argument,
                    format("time_samples = %lld is too few for %lld harmonics; take at least %lld",
                           static_cast<long long>(time_samples), static_cast<long long>(n_harmonics),
                           static_cast<long long>(4 * n_harmonics + 1)))
            .argument("time_samples");
    return std::make_unique<SampledForce>(n_harmonics, time_samples, n_pairs);
}

} // namespace plm
