#include "contact/penetration_zeros.hpp"
#include "linalg/work.hpp"
#include <algorithm>
#include <cmath>

namespace plm {

PenetrationZeros::PenetrationZeros(std::int64_t n_harmonics, std::int64_t n_pairs)
    : h_(n_harmonics), n_grid_(std::max<std::int64_t>(24, 6 * n_harmonics)), width_(2 * M_PI / n_grid_),
      grid_(trig_grid(n_harmonics, n_grid_)), values_(n_pairs, n_grid_), bound_(n_pairs), bend_(n_pairs),
      twist_(n_pairs), lanes_(n_lanes * (2 * n_harmonics + 1)), x_(2 * n_harmonics + 1), first_(n_pairs + 1) {
}

void PenetrationZeros::find(const Matrix &u) {
    gemm('N', 'T', 1.0, u, grid_, 0.0, values_);
    bound_derivatives(u);
    collect_cells();
    worked(20.0 * static_cast<double>(values_.rows() * n_grid_ * u.cols()));
    zeros_.clear();
    std::fill(first_.begin(), first_.end(), 0);
    const std::int64_t n = static_cast<std::int64_t>(cells_.size());
    for (std::int64_t k = 0; k < n; k += n_lanes) search_cells(u, k);
    for (std::int64_t i = 0; i < u.rows(); ++i) first_[i + 1] += first_[i];
}

// The second and third derivative of each pair's penetration, and its sagitta in a cell: a chord is nowhere
// further from the curve. Cells whose ends clear that hold no zero.
void PenetrationZeros::bound_derivatives(const Matrix &u) {
    const std::int64_t z = u.rows();
    for (vector<double> *v : {&bound_, &bend_, &twist_}) std::fill(v->begin(), v->end(), 0.0);
    for (std::int64_t h = 1; h <= h_; ++h) {
        const double *a = u.col(2 * h - 1), *b = u.col(2 * h), k = static_cast<double>(h);
        for (std::int64_t i = 0; i < z; ++i) {
            const double wave = std::abs(a[i]) + std::abs(b[i]);
            bound_[i] += wave;
            bend_[i] += k * k * wave;
            twist_[i] += k * k * k * wave;
        }
    }
    const double *mean = u.col(0);
    for (std::int64_t i = 0; i < z; ++i) // below the mean: it touches zero at most, or stays there
        bound_[i] = std::abs(mean[i]) >= bound_[i] ? -HUGE_VAL : 0.125 * width_ * width_ * bend_[i];
}

// Those that may hold zeros, by pair and then by time.
void PenetrationZeros::collect_cells() {
    const std::int64_t z = values_.rows();
    unclear_.resize(n_grid_ * z);
    n_unclear_.resize(n_grid_);
    std::fill(first_.begin(), first_.end(), 0);
    std::int64_t n = 0;
    for (std::int64_t i = 0; i < n_grid_; ++i) {
        std::int64_t *out = unclear_.data() + n;
        n_unclear_[i] = indices_unclear(z, values_.col(i), values_.col(after(i)), bound_.data(), out);
        n += n_unclear_[i];
        for (std::int64_t k = 0; k < n_unclear_[i]; ++k) ++first_[out[k] + 1];
    }
    for (std::int64_t i = 0; i < z; ++i) first_[i + 1] += first_[i];
    cells_.resize(n);
    const std::int64_t *pair = unclear_.data();
    for (std::int64_t i = 0; i < n_grid_; ++i)
        for (std::int64_t k = 0; k < n_unclear_[i]; ++k, ++pair) cells_[first_[*pair]++] = {*pair, i};
}

// Most cells hold one zero near to where a cubic has it: those go side by side.
void PenetrationZeros::search_cells(const Matrix &u, std::int64_t first) {
    const std::int64_t last = static_cast<std::int64_t>(cells_.size()) - 1;
    TrigCells in;
    in.width = width_;
    std::int64_t pairs[n_lanes];
    for (std::int64_t l = 0; l < n_lanes; ++l) {
        const auto [pair, i] = cells_[std::min(first + l, last)];
        const std::int64_t j = after(i);
        in.cosine_low[l] = grid_(i, 1), in.sine_low[l] = grid_(i, 2);
        in.cosine_high[l] = grid_(j, 1), in.sine_high[l] = grid_(j, 2);
        in.low[l] = values_(pair, i), in.high[l] = values_(pair, j);
        in.twist[l] = twist_[pair];
        pairs[l] = pair;
    }
    for (std::int64_t c = 0; c < u.cols(); ++c) {
        const double *x = u.col(c);
        for (std::int64_t l = 0; l < n_lanes; ++l) lanes_[c * n_lanes + l] = x[pairs[l]];
    }
    TrigZeros out;
    zeros_in_cells(h_, lanes_.data(), in, out);
    worked(20.0 * static_cast<double>(n_lanes * u.cols()));
    for (std::int64_t l = 0; l < std::min(n_lanes, last - first + 1); ++l) {
        const Cell &cell = cells_[first + l];
        const std::int64_t before = static_cast<std::int64_t>(zeros_.size());
        if (out.found[l])
            zeros_.push_back(
                {width_ * static_cast<double>(cell.instant) + out.after_low[l], out.cosine[l], out.sine[l]});
        else
            search_cell(u, cell);
        first_[cell.pair + 1] += static_cast<std::int64_t>(zeros_.size()) - before;
    }
}

void PenetrationZeros::search_cell(const Matrix &u, const Cell &cell) {
    pair_ = cell.pair;
    for (std::int64_t c = 0; c < u.cols(); ++c) x_[c] = u(pair_, c);
    const auto end = [&](std::int64_t instant, double t) {
        return TrigEnd{t, values_(pair_, instant), evaluate_trig(x_.data(), h_, t).slope};
    };
    const double left = width_ * static_cast<double>(cell.instant);
    search(end(cell.instant, left), end(after(cell.instant), left + width_), 12);
}

bool PenetrationZeros::clears(const TrigEnd &left, const TrigEnd &right) const {
    return ContactLaw::closed(left.value) == ContactLaw::closed(right.value) &&
           std::min(std::abs(left.value), std::abs(right.value)) > sagitta(right.t - left.t);
}

void PenetrationZeros::search(const TrigEnd &left, const TrigEnd &right, int halvings) {
    if (clears(left, right)) return;
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
        zeros_.push_back(trig_root(x_.data(), h_, left, right));
        return;
    }
    const double towards = ContactLaw::closed(left.value) ? -1.0 : 1.0;
    if (left.slope * towards > 0 && right.slope * towards < 0) search_turn(left, right);
}

// Is the second derivative certain to keep its sign in the cell, or the first? Then u has no more than two
// zeros, or one. The slopes at the ends give the mean second derivative, from which it differs by half of the
// bound of the third times the width at most.
bool PenetrationZeros::simple(const TrigEnd &left, const TrigEnd &right) const {
    const double width = right.t - left.t, change = 0.5 * width * width * twist_[pair_];
    if (std::abs(right.slope - left.slope) > change) return true;
    return left.slope * right.slope > 0 &&
           std::min(std::abs(left.slope), std::abs(right.slope)) > 0.25 * change;
}

// The curve turns inside the cell: two zeros if it gets across.
void PenetrationZeros::search_turn(const TrigEnd &left, const TrigEnd &right) {
    const double t = trig_stationary(x_.data(), h_, left, right);
    const TrigValue v = evaluate_trig(x_.data(), h_, t);
    if (ContactLaw::closed(v.value) == ContactLaw::closed(left.value)) return;
    const TrigEnd turn{t, v.value, v.slope};
    zeros_.push_back(trig_root(x_.data(), h_, left, turn));
    zeros_.push_back(trig_root(x_.data(), h_, turn, right));
}

SwitchingInstants switching_instants(const Matrix &u) {
    SwitchingInstants all;
    if (u.rows() == 0) return all;
    PenetrationZeros zeros((u.cols() - 1) / 2, u.rows());
    zeros.find(u);
    all.first = PairStates::all_open(u.rows());
    for (std::int64_t i = 0; i < u.rows(); ++i) {
        all.first.set(i, zeros.closed_first(i));
        all.instants.emplace_back();
        for (std::int64_t k = 0; k < zeros.count(i); ++k) all.instants.back().push_back(zeros.of(i)[k].t);
    }
    return all;
}

} // namespace plm
