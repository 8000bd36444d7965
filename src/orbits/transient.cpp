#include "orbits/transient.hpp"
#include <cmath>

namespace plm {

void Transient::advance_clock(std::int64_t periods, double part, double period) {
    time_ += static_cast<double>(periods) * period + part;
    phase_ += part / period;
    phase_ -= std::floor(phase_);
    if (phase_ >= 1) phase_ = 0; // -eps - floor(-eps)
}

void Transient::add_known_motion(const Model &model, const TransientOptions &options,
                                 TransientRun &run) const {
    const double omega = excitation_omega(options);
    for (std::size_t j = 0; j < run.observed.size(); ++j) {
        const KnownMotion known = model.known_motion(run.observed[j], omega, options.force_scale);
        for (std::size_t k = 0; k < run.time.size() && !known.empty(); ++k)
            run.values[k * run.observed.size() + j] +=
                value_at(known, 2 * M_PI * phase_ + omega * (run.time[k] - time_));
    }
}

double excitation_omega(const TransientOptions &options) {
    if (!(options.frequency_hz > 0))
        throw Error(status::state, "\"frequency_hz\" of the excitation is not set; set it, or start at a "
                                   "point of a branch")
            .argument("frequency_hz");
    return 2 * M_PI * options.frequency_hz;
}

} // namespace plm
