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

void check(const FlowModel &model, const ContactInterval &interval, std::int64_t index) {
    if (interval.states.size() != model.n_pairs())
        throw Error(PLM_ERR_ARGUMENT,
                    format("contact interval %lld has states of %lld pairs where the model has %lld",
                           static_cast<long long>(index), static_cast<long long>(interval.states.size()),
                           static_cast<long long>(model.n_pairs())))
            .argument("intervals")
            .index(index);
    if (!(interval.duration >= 0 && std::isfinite(interval.duration)))
        throw Error(PLM_ERR_ARGUMENT, format("contact interval %lld has the duration %g",
                                             static_cast<long long>(index), interval.duration))
            .argument("intervals")
            .index(index);
}

double cube_of(const Matrix &m) {
    return static_cast<double>(m.rows()) * static_cast<double>(m.rows()) * static_cast<double>(m.cols());
}

// Product of the exponentials of the intervals, in the modes of the sets that are known by them.
template <class Real>
Matrix chain(const FlowModel &model, const std::vector<ContactInterval> &intervals, double tolerance,
             const Watch &watch, ContactModesKept *modes) {
    PieceExponential<Real> exponential(model, tolerance); // has the product so far, unless `at` has
    exponential.set_identity();
    Matrix m, scratch;
    std::shared_ptr<const ContactModes> at; // in whose coordinates m is
    const std::int64_t n = static_cast<std::int64_t>(intervals.size());
    for (std::int64_t i = 0; i < n; ++i) {
        if (i % 16 == 0) watch.step("monodromy", static_cast<double>(i) / static_cast<double>(n));
        const auto next = modes ? modes->find(intervals[i].states, effort_of_series) : nullptr;
        if (modes && at && next) {
            const Matrix &way = modes->transition(at, next);
            scratch.reset(m.rows(), m.cols());
            gemm('N', 'N', 1.0, way, m, 0.0, scratch);
            std::swap(m, scratch);
            worked(cube_of(m));
        } else if (at) {
            at->leave(m);
            exponential.set(m);
        } else if (next) {
            exponential.get(m);
            next->enter(m);
        }
        at = next;
        if (at)
            at->turn(intervals[i].duration, m);
        else
            exponential.apply(intervals[i].states, intervals[i].duration);
    }
    if (at)
        at->leave(m);
    else
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

} // namespace

Matrix monodromy(const FlowModel &model, const std::vector<ContactInterval> &intervals, double tolerance,
                 Watch watch, ContactModesKept *modes) {
    const std::int64_t n = static_cast<std::int64_t>(intervals.size());
    for (std::int64_t i = 0; i < n; ++i) check(model, intervals[i], i);
    if (tolerance >= single_precision && model.n_moving() == model.n_massive() &&
        saves_in_single(model, intervals, tolerance)) {
        Matrix m = chain<float>(model, intervals, tolerance, watch, nullptr);
        if (all_finite(m.data(), m.rows() * m.cols()))
            return m; // units of its own may leave the range of single precision
    }
    return chain<double>(model, intervals, tolerance, watch, modes);
}

vector<std::complex<double>> multipliers(const Matrix &monodromy) {
    return general_eigenvalues(monodromy);
}

} // namespace plm
