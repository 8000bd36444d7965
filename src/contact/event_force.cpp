// Event-exact AFT: between the zeros of a pair's penetration its indicator is 0 or 1, and its averages are
// integrals of cosines and sines.
#include "contact/contact_force.hpp"
#include "contact/penetration_zeros.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

class EventForce final : public ContactForce {
  public:
    EventForce(std::int64_t n_harmonics, std::int64_t n_pairs)
        : h_(n_harmonics), zeros_(n_harmonics, n_pairs), integrals_(n_lanes * (4 * n_harmonics + 1)) {}

    void indicator(const Matrix &u, ContactIndicator &out) override {
        const std::int64_t z = u.rows();
        out.averages.reshape(4 * h_ + 1, z);
        out.state.resize(z);
        out.n_switching = 0;
        if (z == 0) return;
        zeros_.find(u);
        spans_.clear();
        for (std::int64_t i = 0; i < z; ++i) {
            const std::int64_t n = zeros_.count(i);
            const bool closed = zeros_.closed_first(i);
            double *average = out.averages.col(i);
            std::fill(average, average + (n == 2 ? 1 : 4 * h_ + 1), 0.0);
            average[0] = closed ? 1 : 0;
            out.state[i] = n > 0 ? PairState::switching : closed ? PairState::closed : PairState::open;
            out.n_switching += n > 0;
            // There are as many of opening as of closing.
            for (std::int64_t k = 0; k + 1 < n; k += 2)
                spans_.push_back({i, closed, n == 2, zeros_.of(i) + k});
        }
        const std::int64_t n = static_cast<std::int64_t>(spans_.size());
        for (std::int64_t k = 0; k < n; k += n_lanes) add_spans(k, out.averages);
    }

  private:
    struct Span { // between two instants the pair is open, or closed
        std::int64_t pair;
        bool open, alone;
        const TrigInstant *ends;
    };

    void add_spans(std::int64_t first, Matrix &averages) {
        const std::int64_t last = static_cast<std::int64_t>(spans_.size()) - 1;
        TrigEnds ends;
        for (std::int64_t l = 0; l < n_lanes; ++l) {
            const TrigInstant *t = spans_[std::min(first + l, last)].ends;
            ends.cosine_first[l] = t[0].cosine, ends.sine_first[l] = t[0].sine;
            ends.cosine_second[l] = t[1].cosine, ends.sine_second[l] = t[1].sine;
        }
        integrals_between(h_, ends, integrals_.data());
        for (std::int64_t l = 0; l < std::min(n_lanes, last - first + 1); ++l) {
            const Span &span = spans_[first + l];
            const double share = (span.open ? -1 : 1) / (2 * M_PI);
            double *average = averages.col(span.pair);
            average[0] += share * (span.ends[1].t - span.ends[0].t);
            const double *integral = integrals_.data() + l;
            if (span.alone)
                for (std::int64_t k = 1; k <= 4 * h_; ++k) average[k] = share * integral[k * n_lanes];
            else
                for (std::int64_t k = 1; k <= 4 * h_; ++k) average[k] += share * integral[k * n_lanes];
        }
    }

    std::int64_t h_;
    PenetrationZeros zeros_;
    vector<Span> spans_;
    vector<double> integrals_;
};

} // namespace

std::unique_ptr<ContactForce> make_event_force(std::int64_t n_harmonics, std::int64_t n_pairs) {
    return std::make_unique<EventForce>(n_harmonics, n_pairs);
}

} // namespace plm
