// Event-exact AFT. A coarse grid brackets the zeros of each pair's penetration; cells in which the curve
// turns towards zero and back are searched for a pair of zeros (grazing: without it the force would jump when
// a pair opens and closes inside one cell), and cells that may hold more are halved. Between the zeros the
// indicator is 0 or 1 and its averages are integrals of cosines and sines.
#include "contact/contact_force.hpp"
#include "contact/trig_polynomial.hpp"
#include "linalg/work.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

class EventForce final : public ContactForce {
  public:
    EventForce(std::int64_t n_harmonics, std::int64_t n_pairs)
        : h_(n_harmonics), n_grid_(std::max<std::int64_t>(24, 6 * n_harmonics)), width_(2 * M_PI / n_grid_),
          grid_(trig_grid(n_harmonics, n_grid_)), values_(2 * n_grid_, n_pairs), x_(2 * n_harmonics + 1) {
        roots_.reserve(2 * n_harmonics + 2);
        share_.push_back(0);
        for (std::int64_t k = 1; k <= 2 * n_harmonics; ++k)
            share_.push_back(1 / (2 * M_PI * static_cast<double>(k)));
    }

    void indicator(const Matrix &u, ContactIndicator &out) override {
        const std::int64_t z = u.rows();
        out.reset(h_, z);
        if (z == 0) return;
        gemm('N', 'T', 1.0, grid_, u, 0.0, values_);
        for (std::int64_t i = 0; i < z; ++i) {
            for (std::int64_t c = 0; c < u.cols(); ++c) x_[c] = u(i, c);
            out.state[i] = pair(values_.col(i), out.averages.col(i));
            out.n_switching += out.state[i] == PairState::switching;
            worked(20.0 * static_cast<double>(n_grid_ * u.cols()));
        }
    }

    SwitchingInstants instants(const Matrix &u) {
        SwitchingInstants all;
        if (u.rows() == 0) return all;
        all.first = PairStates::all_open(u.rows());
        gemm('N', 'T', 1.0, grid_, u, 0.0, values_);
        for (std::int64_t i = 0; i < u.rows(); ++i) {
            for (std::int64_t c = 0; c < u.cols(); ++c) x_[c] = u(i, c);
            find_roots(values_.col(i));
            all.first.set(i, ContactLaw::closed(values_(0, i)));
            all.instants.emplace_back();
            for (const TrigInstant &root : roots_) all.instants.back().push_back(root.t);
        }
        return all;
    }

  private:
    PairState pair(const double *value, double *average) {
        const bool closed_first = ContactLaw::closed(value[0]);
        find_roots(value);
        if (roots_.empty()) {
            average[0] = closed_first ? 1 : 0;
            return closed_first ? PairState::closed : PairState::open;
        }
        integrate(closed_first, average);
        return PairState::switching;
    }

    void find_roots(const double *value) {
        double wave = 0; // bound of |u - a0|
        bend_ = twist_ = 0;
        for (std::int64_t h = 1; h <= h_; ++h) {
            const double r = std::abs(x_[2 * h - 1]) + std::abs(x_[2 * h]);
            wave += r;
            bend_ += static_cast<double>(h * h) * r;
            twist_ += static_cast<double>(h * h * h) * r;
        }
        roots_.clear();
        if (std::abs(x_[0]) >= wave) return; // it touches zero at most, or stays there
        const double *slope = value + n_grid_, sagitta = sagitta_of(width_);
        for (std::int64_t i = 0; i < n_grid_; ++i) {
            const std::int64_t j = i + 1 < n_grid_ ? i + 1 : 0;
            if (clears(value[i], value[j], sagitta)) continue; // most cells
            const TrigEnd left{width_ * static_cast<double>(i), value[i], slope[i]};
            search(left, {left.t + width_, value[j], slope[j]}, 12);
        }
    }

    // A chord over a cell is nowhere further from u than its sagitta: cells whose ends clear it hold no zero.
    double sagitta_of(double width) const { return 0.125 * width * width * bend_; }
    static bool clears(double left, double right, double sagitta) {
        return ContactLaw::closed(left) == ContactLaw::closed(right) &&
               std::min(std::abs(left), std::abs(right)) > sagitta;
    }

    void search(const TrigEnd &left, const TrigEnd &right, int halvings) {
        if (clears(left.value, right.value, sagitta_of(right.t - left.t))) return;
        const bool crosses = ContactLaw::closed(left.value) != ContactLaw::closed(right.value);
        if (halvings > 0 && !simple(left, right)) {
            const double t = 0.5 * (left.t + right.t);
            worked(20.0 * static_cast<double>(h_)); // a gap that hardly opens takes thousands in each cell
            const TrigValue v = evaluate_trig(x_.data(), h_, t);
            const TrigEnd middle{t, v.value, v.slope};
            search(left, middle, halvings - 1);
            search(middle, right, halvings - 1);
            return;
        }
        if (crosses) {
            roots_.push_back(trig_root(x_.data(), h_, left, right));
            return;
        }
        const double towards = ContactLaw::closed(left.value) ? -1.0 : 1.0;
        if (left.slope * towards > 0 && right.slope * towards < 0) grazing_roots(left, right);
    }

    // Is the second derivative certain to keep its sign in the cell, or the first? Then u has no more than
    // two zeros, or one. The slopes at the ends give the mean second derivative, from which it differs by
    // half of the bound of the third times the width at most.
    bool simple(const TrigEnd &left, const TrigEnd &right) const {
        const double width = right.t - left.t, change = 0.5 * width * width * twist_;
        if (std::abs(right.slope - left.slope) > change) return true;
        return left.slope * right.slope > 0 &&
               std::min(std::abs(left.slope), std::abs(right.slope)) > 0.25 * change;
    }

    // The curve turns inside the cell: two zeros if it gets across.
    void grazing_roots(const TrigEnd &left, const TrigEnd &right) {
        const double t = trig_stationary(x_.data(), h_, left, right);
        const TrigValue v = evaluate_trig(x_.data(), h_, t);
        if (ContactLaw::closed(v.value) == ContactLaw::closed(left.value)) return;
        const TrigEnd turn{t, v.value, v.slope};
        roots_.push_back(trig_root(x_.data(), h_, left, turn));
        roots_.push_back(trig_root(x_.data(), h_, turn, right));
    }

    // Of two instants at a time: there are as many of opening as of closing.
    void integrate(bool closed_first, double *average) const {
        const double sign = closed_first ? 1 : -1; // the first event opens or closes
        double closed_time = closed_first ? 2 * M_PI : 0;
        for (std::size_t i = 0; i + 1 < roots_.size(); i += 2) {
            const TrigInstant &first = roots_[i], &second = roots_[i + 1];
            closed_time += sign * (first.t - second.t);
            double c = 1, s = 0, d = 1, e = 0;
            for (std::int64_t k = 1; k <= 2 * h_; ++k) {
                const double next_c = c * first.cosine - s * first.sine,
                             next_d = d * second.cosine - e * second.sine;
                s = s * first.cosine + c * first.sine;
                e = e * second.cosine + d * second.sine;
                c = next_c, d = next_d;
                average[2 * k - 1] += s - e;
                average[2 * k] += d - c;
            }
        }
        average[0] = closed_time / (2 * M_PI);
        for (std::int64_t k = 1; k <= 2 * h_; ++k) {
            average[2 * k - 1] *= sign * share_[k];
            average[2 * k] *= sign * share_[k];
        }
    }

    std::int64_t h_, n_grid_;
    double width_, bend_ = 0, twist_ = 0; // of a grid cell; bounds of the second and third derivative of u
    Matrix grid_, values_;
    vector<double> x_, share_; // share_: 1 / (2 pi k) of harmonic k
    vector<TrigInstant> roots_;
};

} // namespace

SwitchingInstants switching_instants(const Matrix &u) {
    return EventForce((u.cols() - 1) / 2, u.rows()).instants(u);
}

std::unique_ptr<ContactForce> make_event_force(std::int64_t n_harmonics, std::int64_t n_pairs) {
    return std::make_unique<EventForce>(n_harmonics, n_pairs);
}

} // namespace plm
