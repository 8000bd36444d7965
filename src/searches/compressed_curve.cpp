#include "searches/compressed_curve.hpp"
#include "linalg/lapack.hpp"
#include "reduction/compression.hpp"
#include "searches/harmonic_choice.hpp"
#include "searches/orbit_points.hpp"
#include "searches/wider_range.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

// Below, a step on the basis itself takes some hundredths of a second, and a curve few seconds.
constexpr double dear_step = 2e7; // flops
constexpr std::int64_t many_coordinates = 30;
// What is left out of the motions, in the energy norm: at first, and how much less each time that was too
// much. The amplitudes that follow are nearer.
constexpr double left_out_at_first = 1e-3, less = 0.3;
// Of the accuracy: the basis takes its share, too.
constexpr double share_of_accuracy = 0.3;
// Modes below so many times the highest frequency of the range stay whole: they are those that internal
// resonances of low order can set in motion, and whose multipliers die out slowly.
constexpr double slow = 3;
// A model that is not smaller than this share of the whole saves nothing.
constexpr double much_smaller = 0.7;
constexpr std::int64_t motions_looked_at = 6; // of the first curve, besides its highest
constexpr std::int64_t most_rounds = 6;
constexpr std::int64_t corrected_harmonics = 24; // those above hardly move
// Of the first curve: some two hundred solutions that together take a second or two.
constexpr double flops_of_look = 1e9;

constexpr double negligible = 1e-6; // stiffness, of omega^2

using complex = std::complex<double>;

Matrix mean_of(const BranchPoint &p) {
    Matrix column(static_cast<std::int64_t>(p.eta_0.size()), 1);
    std::copy(p.eta_0.begin(), p.eta_0.end(), column.data());
    return column;
}

vector<double> as_vector(const Matrix &column) {
    return vector<double>(column.data(), column.data() + column.rows());
}

BranchPoint with_coordinates(const BranchPoint &p, const Matrix &mean, Matrix eta) {
    BranchPoint out;
    out.omega = p.omega;
    out.force_scale = p.force_scale;
    out.eta_0 = as_vector(mean);
    out.n_harmonics = eta.cols() / 2;
    out.eta = std::move(eta);
    return out;
}

BranchPoint in_whole(const ReducedModel &m, const BranchPoint &p) {
    return with_coordinates(p, uncompressed(m, mean_of(p)), uncompressed(m, p.eta));
}

// The coordinates of a compressed model that come nearest to motions of the whole one, by their energy.
class NearestCoordinates {
  public:
    NearestCoordinates(const ReducedModel &model, double omega) : weighted_(model.from->coordinates) {
        const ReducedModel &whole = *model.from->model;
        const Matrix y = weighted_;
        for (std::int64_t j = 0; j < y.cols(); ++j)
            for (std::int64_t i = 0; i < y.rows(); ++i)
                weighted_(i, j) *= whole.lambda[i] + omega * omega * whole.mass(i);
        Matrix gram = product('T', 'N', y, weighted_);
        known_ = gram_.factor(gram);
    }
    bool known() const { return known_; }
    Matrix of(const Matrix &motions) const {
        Matrix c = product('T', 'N', weighted_, motions);
        gram_.solve(c.data(), c.cols(), c.rows());
        return c;
    }

  private:
    Matrix weighted_;
    DenseCholesky gram_;
    bool known_ = false;
};

// B^T diag(s) B of the pairs' springs weighted by the share of the period in which they act.
Matrix mean_springs(const ReducedModel &m, const vector<double> &closed_shares) {
    Matrix weighted = m.gap;
    for (std::int64_t i = 0; i < weighted.rows(); ++i) {
        const double s = m.contact.stiffness[i] * closed_shares[i];
        for (std::int64_t j = 0; j < weighted.cols(); ++j) weighted(i, j) *= s;
    }
    return product('T', 'N', m.gap, weighted);
}

// -Omega^2 M + i Omega C + K + S at one harmonic, column by column.
vector<complex> dynamic_stiffness(const ReducedModel &m, const Matrix &springs, double omega) {
    const std::int64_t r = m.size();
    vector<complex> a(static_cast<std::size_t>(r * r));
    for (std::int64_t j = 0; j < r; ++j)
        for (std::int64_t i = 0; i < r; ++i)
            a[i + j * r] = complex(springs(i, j), m.damping.empty() ? 0.0 : omega * m.damping(i, j));
    for (std::int64_t j = 0; j < r; ++j) {
        a[j + j * r] += m.lambda[j] - omega * omega * m.mass(j);
        if (m.damping.empty()) a[j + j * r] += complex(0, omega * m.damping_diagonal[j]);
    }
    return a;
}

// Of harmonic h, as Re(x exp(i h omega t)); h = 0: the mean.
vector<complex> motion_of(const BranchPoint &p, std::int64_t h) {
    vector<complex> x(p.eta_0.begin(), p.eta_0.end());
    for (std::int64_t j = 0; h > 0 && j < p.eta.rows(); ++j)
        x[j] = {p.eta(j, 2 * h - 2), -p.eta(j, 2 * h - 1)};
    return x;
}

// The loads less the contact's forces and those of inertia, damping and stiffness. contact: on the
// coordinates, r x (2H + 1).
vector<complex> missing_force(const ReducedModel &m, const BranchPoint &p, const Matrix &contact,
                              std::int64_t h) {
    const std::int64_t r = m.size();
    const vector<complex> x = motion_of(p, h),
                          open = dynamic_stiffness(m, Matrix(r, r), static_cast<double>(h) * p.omega);
    vector<complex> f(r);
    for (std::int64_t i = 0; i < r; ++i)
        f[i] = h == 0 ? complex(m.preload_0[i] - contact(i, 0))
                      : complex(-contact(i, 2 * h - 1), contact(i, 2 * h));
    if (const auto load = m.excitation.find(static_cast<int>(h)); load != m.excitation.end())
        for (std::int64_t i = 0; i < r; ++i)
            f[i] += p.force_scale *
                    complex(load->second.real[i], load->second.imag.empty() ? 0 : load->second.imag[i]);
    for (std::int64_t j = 0; j < r; ++j)
        for (std::int64_t i = 0; i < r; ++i) f[i] -= open[i + j * r] * x[j];
    return f;
}

} // namespace

bool worth_compressing(const ReducedModel &whole, const HbmOptions &options) {
    return whole.same_static && !whole.all_pairs && !whole.from && whole.model &&
           options.period_multiple == 1 && whole.size() >= many_coordinates &&
           exact_step_flops(whole, options) > dear_step;
}

CurveCompression::CurveCompression(std::shared_ptr<const ReducedModel> whole, const HbmOptions &options,
                                   double highest, Watch watch)
    : whole_(std::move(whole)), options_(options), highest_(highest), left_out_(left_out_at_first),
      watch_(watch) {}

std::int64_t CurveCompression::harmonics_of_look() const {
    for (std::int64_t h : {5, 4, 3, 2}) {
        const double n = static_cast<double>(std::min(whole_->size(), whole_->n_pairs()) * (2 * h + 1));
        if (2.0 / 3 * n * n * n < flops_of_look) return h;
    }
    return 1;
}

double CurveCompression::tolerance() const {
    return share_of_accuracy * options_.accuracy;
}

std::shared_ptr<const ReducedModel> CurveCompression::compressed() const {
    return compress_beside_modes(whole_, motions_, omega_, left_out_, slow * highest_);
}

// point: in the coordinates of the whole basis.
void CurveCompression::take(const BranchPoint &point, Matrix &motions) const {
    Matrix columns = mean_of(point);
    columns.append(point.eta);
    for (std::int64_t k = 0; k < columns.rows() * columns.cols(); ++k) columns.data()[k] /= scale_;
    motions.append(columns);
}

double CurveCompression::amplitude(const std::shared_ptr<const ReducedModel> &model,
                                   const BranchPoint &point) const {
    Branch one(model, options_.force_scale);
    one.append(point);
    return one.amplitude(0, output_.dof, Measure::peak, 0);
}

bool CurveCompression::make_exact_on(const std::shared_ptr<const ReducedModel> &model,
                                     BranchPoint &point) const {
    const NearestCoordinates nearest(*model, point.omega);
    if (!nearest.known()) return false;
    BranchPoint guess = with_coordinates(point, nearest.of(mean_of(point)), nearest.of(point.eta));
    NewtonWork work;
    if (!make_exact(model, options_, watch_.quiet(), guess, work)) return false;
    point = std::move(guess);
    return true;
}

// What the whole basis misses of equilibrium in an exact motion of the compressed one, harmonic by harmonic
// (the mean first), answers with the contact's springs at their mean over the period.
BranchPoint CurveCompression::corrected(const std::shared_ptr<const ReducedModel> &model,
                                        const BranchPoint &exact) const {
    BranchPoint p = in_whole(*model, exact);
    const std::int64_t n = std::min(p.eta.cols() / 2, corrected_harmonics), r = whole_->size();
    const Matrix forces = product('T', 'N', whole_->gap, exact.motion->contact_forces(n)),
                 springs = mean_springs(*whole_, exact.motion->closed_shares());
    ComplexLu lu;
    for (std::int64_t h = 0; h <= n; ++h) {
        vector<complex> change = missing_force(*whole_, p, forces, h),
                        stiffness = dynamic_stiffness(*whole_, springs, static_cast<double>(h) * p.omega);
        if (h == 0) // where nothing but contact holds the structure
            for (std::int64_t j = 0; j < r; ++j) stiffness[j + j * r] += negligible * p.omega * p.omega;
        lu.factor(r, stiffness);
        lu.solve(change.data(), 1, r);
        for (std::int64_t j = 0; j < r; ++j)
            if (h == 0)
                p.eta_0[j] += change[j].real();
            else
                p.eta(j, 2 * h - 2) += change[j].real(), p.eta(j, 2 * h - 1) -= change[j].imag();
    }
    return p;
}

// Exact motions on a model beside the points, which become theirs, and their corrections: what a model needs
// to have. Returns the largest change of an amplitude since the last call, over the peak; infinite where none
// can be compared.
double CurveCompression::settle(const std::shared_ptr<const ReducedModel> &model, std::vector<Point> &points,
                                Matrix &motions) const {
    double change = -1;
    for (Point &point : points) {
        BranchPoint exact = point.motion;
        if (!make_exact_on(model, exact)) continue;
        const double now = amplitude(model, exact);
        if (point.amplitude >= 0) change = std::max(change, std::abs(now - point.amplitude) / peak_);
        point.amplitude = now;
        take(in_whole(*model, exact), motions);
        point.motion = corrected(model, exact);
        take(point.motion, motions);
    }
    return change >= 0 ? change : INFINITY;
}

bool CurveCompression::begin_with(const Branch &look) {
    const std::int64_t top = largest_response(look);
    output_ = most_moving(look, top);
    peak_ = look.amplitude(top, output_.dof, Measure::peak, 0);
    omega_ = look.points()[static_cast<std::size_t>(top)].omega;
    for (const BranchPoint &p : look.points())
        scale_ = std::max(scale_, norm2(p.eta.rows() * p.eta.cols(), p.eta.data()));
    if (!(peak_ > 0 && scale_ > 0)) return false;
    for (const BranchPoint &p : look.points()) take(p, motions_);
    std::vector<Point> points;
    vector<std::int64_t> at = spread_over(look, motions_looked_at);
    at.push_back(top);
    for (std::int64_t i : at) points.push_back({look.points()[static_cast<std::size_t>(i)]});
    const auto is_found = [](const Point &p) { return p.amplitude >= 0; };
    std::shared_ptr<const ReducedModel> before;
    for (std::int64_t round = 0; round < most_rounds; ++round) {
        const auto smaller = compressed();
        if (static_cast<double>(smaller->size()) > much_smaller * static_cast<double>(whole_->size()))
            return false;
        Matrix motions;
        const double change = settle(smaller, points, motions);
        // they know more than those before, unless they are few
        if (2 * std::count_if(points.begin(), points.end(), is_found) < motions_looked_at)
            motions.append(motions_);
        motions_ = std::move(motions);
        watch_.log(1, format("compressed to %lld of %lld coordinates: amplitudes change by %.2g of the peak",
                             static_cast<long long>(smaller->size()), static_cast<long long>(whole_->size()),
                             change));
        // the change is what the model before made wrong, this one's error is a part of it
        if (change <= options_.accuracy) {
            model_ = change <= tolerance() ? before : smaller;
            return true;
        }
        before = smaller;
        if (round > 0 && !std::isfinite(change)) return false;
        left_out_ *= less;
    }
    return false;
}

bool CurveCompression::confirms(const Branch &curve) {
    const std::int64_t top = largest_response(curve);
    const BranchPoint &exact = curve.points()[static_cast<std::size_t>(top)];
    if (!exact.motion) return false;
    std::vector<Point> one{{in_whole(curve.reduced(), exact), amplitude(curve.reduced_model(), exact)}};
    take(one[0].motion, motions_);
    one[0].motion = corrected(curve.reduced_model(), exact);
    take(one[0].motion, motions_);
    left_out_ *= less;
    const auto better = compressed();
    const double change = settle(better, one, motions_);
    watch_.log(1, format("whole basis: the highest motion changes by %.2g of itself", change));
    if (change <= tolerance()) return true;
    model_ = better;
    return false;
}

std::shared_ptr<const Branch> on_whole_basis(const Branch &branch, const HbmOptions &options,
                                             std::int64_t first, std::int64_t last) {
    const ReducedModel &m = branch.reduced();
    if (!m.from) return {std::shared_ptr<const Branch>(), &branch};
    auto whole = std::make_shared<Branch>(m.from->model, branch.force_scale(), branch.period_multiple());
    whole->end_reason = branch.end_reason;
    for (std::int64_t i = 0; i < static_cast<std::int64_t>(branch.points().size()); ++i) {
        const BranchPoint &p = branch.points()[static_cast<std::size_t>(i)];
        BranchPoint q = p;
        q.motion = nullptr;
        q.eta_0 = as_vector(uncompressed(m, mean_of(p)));
        q.eta = uncompressed(m, p.eta);
        if (p.motion && i >= first && i <= last) {
            const HbmOptions o = options_at(p, branch.period_multiple(), options);
            const OrbitEquations equations =
                orbit_equations(m.from->model, o, p.omega, FlowParameter::frequency);
            const BranchPoint exact =
                orbit_point(equations, o, {equations.unknowns(start_of(branch, i).state), p.omega},
                            p.residual, p.iterations);
            q.eta_0 = exact.eta_0, q.eta = exact.eta, q.motion = exact.motion;
        }
        whole->append(std::move(q));
    }
    return whole;
}

} // namespace plm
