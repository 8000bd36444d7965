#include "motions/branch.hpp"
#include "contact/contact_measures.hpp"
#include "contact/trig_polynomial.hpp"
#include "linalg/blas_lapack.hpp"
#include "linalg/scale.hpp"
#include "motions/penetration.hpp"
#include <algorithm>
#include <cmath>

namespace plm {

std::string end_text(std::int32_t reason, bool sampled) {
    if (sampled && (reason == reason::step_minimum || reason == reason::contact_chatter ||
                    reason == reason::turned_back))
        return "sampled contact forces have a corner at every sample that switches, and the curve could not "
               "be followed round one; raise time_samples or set aft to event";
    switch (reason) {
    case reason::none:
        return "complete";
    case reason::range_end:
        return "reached the end of its range";
    case reason::loop_closed:
        return "came back to its first point";
    case reason::point_limit:
        return "max_points reached; raise it or max_step";
    case reason::unfinished:
        return "written while it was followed; resume goes on with it";
    case reason::cancelled:
        return "cancelled by the progress callback";
    case reason::effort:
        return "the effort allowed is spent; raise the effort of the context";
    case reason::step_minimum:
        return "the step fell below min_step; try more harmonics or a softer contact";
    case reason::contact_chatter:
        return "Newton cycled between contact sets";
    case reason::singular_tangent:
        return "the tangent is singular";
    case reason::start_failed:
        return "no solution was found at the first frequency; start elsewhere or with less force";
    case reason::basis_too_small:
        return "the basis is too small for this response";
    case reason::harmonics_too_few:
        return "its points have far too few harmonics, and no solution with more was found beside them; make "
               "the "
               "basis for more harmonics, the contact softer or the damping larger";
    case reason::turned_back:
        return "ran back to where it began without having passed a fold; give the sweep the other direction, "
               "a smaller "
               "max_step or more harmonics";
    case reason::crossed_over:
        return "goes round a closed curve onto which one of its steps had crossed; give the sweep a smaller "
               "max_step";
    case reason::not_finite:
        return "the response overflowed; check the units of matrices, loads and frequencies";
    default:
        return format("ended for reason %d", reason);
    }
}

namespace {

bool is_motion(const BranchPoint &p) {
    return std::isfinite(p.omega) && std::isfinite(p.arclength) && std::isfinite(p.residual) &&
           std::isfinite(p.force_scale) &&
           all_finite(p.eta_0.data(), static_cast<std::int64_t>(p.eta_0.size())) &&
           all_finite(p.eta.data(), p.eta.rows() * p.eta.cols());
}

// Throws for a motion that is not finite; what is not finite beside it becomes unknown, with a warning.
void drop_what_is_not_finite(BranchPoint &p, Warnings &warnings) {
    if (!is_motion(p))
        throw Error(status::convergence, "a point of the branch is not finite: its equations overflow; " +
                                             std::string(sizes_apart))
            .reason(reason::not_finite);
    const bool stability = std::all_of(p.multipliers.begin(), p.multipliers.end(), [](const auto &m) {
        return std::isfinite(m.real()) && std::isfinite(m.imag());
    });
    if (!stability) p.multipliers.clear();
    bool harmonics = true;
    for (double *indicator : {&p.harmonic_tail, &p.harmonic_error})
        if (!std::isfinite(*indicator)) *indicator = -1, harmonics = false;
    if (!stability || !harmonics)
        warnings.add(reason::not_finite, std::string(stability ? "harmonic_error" : "stability") +
                                             " is unknown at some points, since it overflows there; " +
                                             sizes_apart);
}

} // namespace

void Branch::prepend(const Branch &piece) {
    if (piece.points_.empty()) return;
    const double length = piece.points_.back().arclength;
    std::vector<BranchPoint> old;
    old.swap(points_);
    for (std::size_t i = piece.points_.size(); i-- > 1;) {
        append(piece.points_[i]);
        points_.back().arclength = length - piece.points_[i].arclength;
    }
    for (BranchPoint &point : old) {
        point.arclength += length;
        append(std::move(point));
    }
}

void Branch::continue_with(const Branch &piece) {
    const double length = points_.empty() ? 0 : points_.back().arclength;
    for (std::size_t i = 1; i < piece.points_.size(); ++i) {
        append(piece.points_[i]);
        points_.back().arclength += length;
    }
}

void Branch::append(BranchPoint point) {
    require(point.eta.rows() == reduced_->size() || point.eta.cols() == 0,
            "append: coordinates of the branch");
    drop_what_is_not_finite(point, warnings);
    const std::int64_t n = point.eta.cols() / 2;
    if (n > n_harmonics_) {
        n_harmonics_ = n;
        for (BranchPoint &p : points_) set_harmonics(p.eta, n);
    } else {
        set_harmonics(point.eta, n_harmonics_);
    }
    points_.push_back(std::move(point));
}

vector<double> Branch::coefficients(std::int64_t point, std::int64_t dof) const {
    const DofTerms row = reduced_->model->terms(dof);
    vector<double> c = coefficients(point, {reduced_->vectors.row(row), reduced_->static_vectors().row(row)});
    for (const auto &[harmonic, u] : known_motion(point, dof)) {
        const auto cosine = static_cast<std::size_t>(2 * harmonic * period_multiple_ - 1);
        if (cosine < c.size()) c[cosine] += u.real(), c[cosine + 1] -= u.imag();
    }
    return c;
}

KnownMotion Branch::known_motion(std::int64_t point, std::int64_t dof) const {
    const BranchPoint &p = points_[static_cast<std::size_t>(point)];
    return is_mode ? KnownMotion() : reduced_->model->known_motion(dof, p.omega, p.force_scale);
}

vector<double> Branch::coefficients(std::int64_t point, const DofInBasis &dof) const {
    const BranchPoint &p = points_[point];
    const vector<double> &v = dof.of_dynamic, &v0 = dof.of_static;
    vector<double> c(2 * n_harmonics_ + 1, 0.0);
    for (std::size_t j = 0; j < v0.size(); ++j) c[0] += v0[j] * p.eta_0[j];
    for (std::int64_t k = 0; k < 2 * n_harmonics_; ++k)
        for (std::int64_t j = 0; j < reduced_->size(); ++j) c[k + 1] += v[j] * p.eta(j, k);
    return c;
}

double amplitude_of(const ValueRange &range, Measure measure) {
    if (measure == Measure::half_peak_to_peak) return 0.5 * (range.maximum - range.minimum);
    return std::max(std::abs(range.maximum), std::abs(range.minimum));
}

namespace {

// Beyond what its harmonics say.
bool has_own_extrema(const BranchPoint &p, Measure measure) {
    return p.motion && (measure == Measure::peak || measure == Measure::half_peak_to_peak);
}

} // namespace

double amplitude_of(const vector<double> &c, Measure measure, std::int64_t harmonic) {
    const std::int64_t n = static_cast<std::int64_t>(c.size()) / 2;
    if (measure == Measure::harmonic) {
        if (harmonic > n) return 0;
        return harmonic == 0 ? c[0] : std::hypot(c[2 * harmonic - 1], c[2 * harmonic]);
    }
    if (measure == Measure::rms) {
        double s = c[0] * c[0];
        for (std::size_t k = 1; k < c.size(); ++k) s += 0.5 * c[k] * c[k];
        return std::sqrt(s);
    }
    return amplitude_of(trig_range(c.data(), n), measure);
}

double Branch::amplitude(std::int64_t point, std::int64_t dof, Measure measure, std::int64_t harmonic) const {
    const BranchPoint &p = points_[static_cast<std::size_t>(point)];
    if (has_own_extrema(p, measure)) return amplitude_of(p.motion->range(dof), measure);
    return amplitude_of(coefficients(point, dof), measure, harmonic);
}

double Branch::amplitude(std::int64_t point, const DofInBasis &dof, Measure measure,
                         std::int64_t harmonic) const {
    const BranchPoint &p = points_[static_cast<std::size_t>(point)];
    if (has_own_extrema(p, measure)) return amplitude_of(p.motion->range_of(dof.of_static), measure);
    return amplitude_of(coefficients(point, dof), measure, harmonic);
}

// Extrema take a search, those of an exact motion a run through its period. The sum of the harmonics spares
// the search where it tells that the point is far from the top, by a tenth; they themselves the run, by what
// the upper half of them adds.
std::int64_t Branch::highest_point(std::int64_t dof, Measure measure, std::int64_t harmonic) const {
    constexpr double far_below = 0.9;
    struct Known {
        std::int64_t point;
        vector<double> harmonics;
        double reach, tail; // of all harmonics and of the upper half, at most
    };
    std::vector<Known> all;
    for (std::int64_t i = 0; i < static_cast<std::int64_t>(points_.size()); ++i) {
        Known k{i, coefficients(i, dof), 0, 0};
        k.reach = std::abs(k.harmonics[0]);
        for (std::int64_t h = 1; h <= n_harmonics_; ++h) {
            const double size = std::hypot(k.harmonics[2 * h - 1], k.harmonics[2 * h]);
            k.reach += size;
            if (2 * h > points_[i].n_harmonics) k.tail += size;
        }
        all.push_back(std::move(k));
    }
    std::stable_sort(all.begin(), all.end(),
                     [](const Known &a, const Known &b) { return a.reach + a.tail > b.reach + b.tail; });
    std::int64_t top = 0;
    double highest = -1, most = 0;
    for (const Known &k : all) {
        if (k.reach + k.tail < far_below * most) break;
        double height = std::abs(amplitude_of(k.harmonics, measure, harmonic));
        most = std::max(most, height);
        if (height + k.tail < far_below * most) continue;
        if (has_own_extrema(points_[k.point], measure))
            height = std::abs(amplitude(k.point, dof, measure, harmonic));
        if (height > highest || (height == highest && k.point < top)) highest = height, top = k.point;
    }
    return top;
}

vector<double> Branch::history(std::int64_t point, std::int64_t dof, std::int64_t n) const {
    const BranchPoint &p = points_[static_cast<std::size_t>(point)];
    if (p.motion) {
        vector<double> values =
            p.motion->history(reduced_->static_vectors().row(reduced_->model->terms(dof)), n);
        const KnownMotion known = known_motion(point, dof);
        for (std::int64_t k = 0; k < n; ++k)
            values[k] += value_at(known, 2 * M_PI * static_cast<double>(period_multiple_ * k) /
                                             static_cast<double>(n));
        return values;
    }
    const vector<double> c = coefficients(point, dof);
    vector<double> values;
    for (std::int64_t k = 0; k < n; ++k)
        values.push_back(
            evaluate_trig(c.data(), n_harmonics_, 2 * M_PI * static_cast<double>(k) / static_cast<double>(n))
                .value);
    return values;
}

Field Branch::field(std::int64_t point, double fraction) const {
    const BranchPoint &p = points_[point];
    if (p.motion) return combine(reduced_->static_vectors(), p.motion->displacement(fraction));
    vector<double> eta(reduced_->size(), 0.0);
    for (std::int64_t h = 1; h <= n_harmonics_; ++h) {
        const double angle = 2 * M_PI * fraction * static_cast<double>(h), c = std::cos(angle),
                     s = std::sin(angle);
        for (std::int64_t j = 0; j < reduced_->size(); ++j)
            eta[j] += c * p.eta(j, 2 * h - 2) + s * p.eta(j, 2 * h - 1);
    }
    if (reduced_->same_static) {
        for (std::int64_t j = 0; j < reduced_->size(); ++j) eta[j] += p.eta_0[j];
        return combine(reduced_->vectors, eta);
    }
    Field q = combine(reduced_->static_vectors(), p.eta_0);
    add_combination(1.0, reduced_->vectors, eta, q);
    return q;
}

Matrix Branch::penetration_coefficients(std::int64_t point) const {
    return whole_penetration_of(*reduced_, points_[point], n_harmonics_).transposed();
}

vector<double> Branch::closed_share(std::int64_t point) const {
    const BranchPoint &p = points_[static_cast<std::size_t>(point)];
    if (p.motion && !reduced_->all_pairs) return p.motion->closed_shares();
    return closed_shares(whole_contact_motion(*reduced_, points_[point]).u);
}

bool was_stopped(const Branch &branch) {
    return branch.end_reason == reason::cancelled || branch.end_reason == reason::effort;
}

void require_unstopped(const Branch &branch) {
    if (was_stopped(branch))
        throw Error(status::cancelled, end_text(branch.end_reason)).reason(branch.end_reason);
}

} // namespace plm
