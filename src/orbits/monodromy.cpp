#include "orbits/monodromy.hpp"
#include "linalg/lapack.hpp"
#include "linalg/scale.hpp"
#include "linalg/work.hpp"
#include "orbits/piece_exponential.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

// What the series of a contact set is worth in pieces of the flow, by time (ContactModesKept::find).
constexpr std::int64_t effort_of_series = 4;
// The truncation of a piece, from which on single precision is good enough for it.
constexpr double single_precision = 1e-8;
// The same in modes, for what only leads Newton's method: of multipliers close to the unit circle more digits
// are wanted.
constexpr double single_in_modes = 1e-6;

void check(const FlowModel &model, const ContactInterval &interval, std::int64_t index) {
    if (interval.states.size() != model.n_pairs())
        throw Error(status::argument,
                    format("contact interval %lld has states of %lld pairs where the model has %lld",
                           static_cast<long long>(index), static_cast<long long>(interval.states.size()),
                           static_cast<long long>(model.n_pairs())))
            .argument("intervals")
            .index(index);
    if (!(interval.duration >= 0 && std::isfinite(interval.duration)))
        throw Error(status::argument, format("contact interval %lld has the duration %g",
                                             static_cast<long long>(index), interval.duration))
            .argument("intervals")
            .index(index);
}

// Columns of states in the coordinates of a contact set's modes; those of a transition are products in the
// precision of Real.
template <class Real> class ModalColumns {
  public:
    explicit ModalColumns(ContactModesKept *kept) : kept_(kept) {}

    const std::shared_ptr<const ContactModes> &at() const { return at_; } // null: no columns
    void enter(std::shared_ptr<const ContactModes> modes, Matrix states) {
        at_ = std::move(modes);
        at_->enter(states);
        now_.assign(states.data(), states.data() + states.rows() * states.cols());
    }
    void move(std::shared_ptr<const ContactModes> to) {
        const std::int64_t n = to->size(), columns = static_cast<std::int64_t>(now_.size()) / n;
        const vector<Real> &way = kept_->transition<Real>(at_, to);
        next_.resize(now_.size());
        gemm('N', n, columns, n, 1, way.data(), n, now_.data(), n, 0, next_.data(), n);
        now_.swap(next_);
        at_ = std::move(to);
        worked(static_cast<double>(n * n * columns));
    }
    void turn(double dt) { at_->turn(dt, now_); }
    Matrix leave() {
        Matrix states(at_->size(), static_cast<std::int64_t>(now_.size()) / at_->size());
        std::copy(now_.begin(), now_.end(), states.data());
        at_->leave(states);
        at_ = nullptr;
        return states;
    }

  private:
    ContactModesKept *kept_;
    std::shared_ptr<const ContactModes> at_;
    vector<Real> now_, next_;
};

// Product of the exponentials of the intervals, in the modes of the sets that are known by them.
template <class Real, class ModalReal>
Matrix chain(const FlowModel &model, const std::vector<ContactInterval> &intervals, double tolerance,
             const Watch &watch, ContactModesKept *modes) {
    PieceExponential<Real> exponential(model, tolerance); // has the product so far, unless `modal` has
    exponential.set_identity();
    ModalColumns<ModalReal> modal(modes);
    Matrix m;
    const std::int64_t n = static_cast<std::int64_t>(intervals.size());
    for (std::int64_t i = 0; i < n; ++i) {
        if (i % 16 == 0) watch.step("monodromy", static_cast<double>(i) / static_cast<double>(n));
        auto next = modes ? modes->find(intervals[i].states, effort_of_series) : nullptr;
        if (modal.at() && next) {
            modal.move(std::move(next));
        } else if (modal.at()) {
            exponential.set(modal.leave());
        } else if (next) {
            exponential.get(m);
            modal.enter(std::move(next), std::move(m));
        }
        if (modal.at())
            modal.turn(intervals[i].duration);
        else
            exponential.apply(intervals[i].states, intervals[i].duration);
    }
    if (modal.at()) return modal.leave();
    exponential.get(m);
    return m;
}

// Where events are dense; long pieces are squared in double precision.
bool saves_in_single(const FlowModel &model, const std::vector<ContactInterval> &intervals,
                     double tolerance) {
    constexpr double faster = 2; // a product of the same size
    ContactSet stiffest(model);
    stiffest.assign_stiffest();
    double in_single = 0, in_double = 0;
    for (const ContactInterval &interval : intervals) {
        in_single += PieceExponential<float>::n_products(stiffest, interval.duration, tolerance);
        in_double += PieceExponential<double>::n_products(stiffest, interval.duration, tolerance);
    }
    return in_single < faster * in_double;
}

// The modes that are known by now.
bool bear_single(const std::vector<ContactInterval> &intervals, const ContactModesKept &modes) {
    return std::all_of(intervals.begin(), intervals.end(), [&](const ContactInterval &interval) {
        const auto known = modes.known(interval.states);
        return !known || known->usable_in_single();
    });
}

} // namespace

Matrix monodromy(const FlowModel &model, const std::vector<ContactInterval> &intervals, double tolerance,
                 Watch watch, ContactModesKept *modes) {
    const std::int64_t n = static_cast<std::int64_t>(intervals.size());
    for (std::int64_t i = 0; i < n; ++i) check(model, intervals[i], i);
    if (tolerance >= single_precision && model.n_moving() == model.n_massive() &&
        saves_in_single(model, intervals, tolerance)) {
        Matrix m = chain<float, float>(model, intervals, tolerance, watch, nullptr);
        if (all_finite(m.data(), m.rows() * m.cols()))
            return m; // units of its own may leave the range of single precision
    }
    if (modes && tolerance >= single_in_modes && bear_single(intervals, *modes)) {
        Matrix m = chain<double, float>(model, intervals, tolerance, watch, modes);
        if (all_finite(m.data(), m.rows() * m.cols())) return m;
    }
    return chain<double, double>(model, intervals, tolerance, watch, modes);
}

vector<std::complex<double>> multipliers(const Matrix &monodromy) {
    return general_eigenvalues(monodromy);
}

} // namespace plm
