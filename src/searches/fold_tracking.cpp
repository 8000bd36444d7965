#include "searches/fold_tracking.hpp"
#include "contact/trig_polynomial.hpp"
#include "hbm/branch_path.hpp"
#include "hbm/make_system.hpp"
#include "searches/curve.hpp"
#include "searches/harmonic_choice.hpp"
#include <algorithm>
#include <cmath>

namespace plm {

FoldSystem::FoldSystem(HbmSystem &inner, std::shared_ptr<const ReducedModel> reduced,
                       const BranchPoint &about, double unit)
    : FreeFrequency(about.omega, unit, inner), reduced_(std::move(reduced)), y_(inner.size() + 1),
      scratch_(inner.size()) {
    choose_borders(about);
}

// b and c near the left and right null vectors, by inverse iteration.
void FoldSystem::choose_borders(const BranchPoint &about) {
    const std::int64_t n = inner_.size();
    inner_.set_force_scale(about.force_scale);
    inner_.from_point(about, y_.data());
    inner_.residual(y_.data(), about.omega, scratch_.data());
    inner_.factor_bordered(Border(), linear_);
    border_.reset(n, 1);
    double *b = border_.columns.data(), *c = border_.rows.data();
    std::fill(b, b + n, 1.0);
    std::fill(c, c + n, 1.0);
    for (int k = 0; k < 4; ++k) {
        linear_.solve_transposed(b, 1);
        linear_.solve(c, 1);
        const double left = norm2(n, b), right = norm2(n, c);
        for (std::int64_t i = 0; i < n; ++i) b[i] /= left, c[i] /= right;
    }
    for (std::int64_t i = 0; i < n; ++i) b[i] *= about.omega * about.omega; // like the other equations
}

void FoldSystem::factor_matrix() {
    inner_.factor_bordered(border_, bordered_);
    fresh_ = true;
}

void FoldSystem::residual(const double *y, double force, double *r) {
    const std::int64_t n = inner_.size();
    y_.assign(y, y + n + 1);
    inner_.set_force_scale(force);
    inner_.residual(y, omega_of(y), r);
    factor_matrix();
    v_.assign(n + 1, 0.0);
    v_[n] = 1;
    bordered_.solve(v_.data(), 1);
    r[n] = v_[n];
}

void FoldSystem::linearize() {
    const std::int64_t n = inner_.size();
    if (!fresh_) factor_matrix();
    std::swap(linear_, bordered_);
    fresh_ = false;
    null_ = v_;
    vector<double> w(n + 1, 0.0);
    w[n] = 1;
    linear_.solve_transposed(w.data(), 1);
    gradient_ = contact_gradient(w, v_);
    gradient_.push_back(-dot(n, w.data(), frequency_derivative(v_).data()) / unit());
    frequency_.assign(n + 1, 0.0);
    inner_.parameter_derivative(frequency_.data());
    for (std::int64_t i = 0; i < n; ++i) frequency_[i] /= -unit();
    linear_.solve(frequency_.data(), 1);
    determinant_ = null_[n] * (dot(n, gradient_.data(), frequency_.data()) + gradient_[n]) -
                   frequency_[n] * dot(n, gradient_.data(), null_.data());
}

// x = a + beta v + s z with (a, alpha) = M^-1 (r, 0): J x + s dR/dy_omega = r asks for
// alpha + beta g + s zeta = 0, the last equation for dg/dy . (x, s) = r_last.
void FoldSystem::solve(double *b, std::int64_t columns) {
    const std::int64_t n = inner_.size();
    const double gv = dot(n, gradient_.data(), null_.data()),
                 gz = dot(n, gradient_.data(), frequency_.data()) + gradient_[n];
    for (std::int64_t k = 0; k < columns; ++k) {
        double *x = b + k * (n + 1);
        const double last = x[n];
        x[n] = 0;
        linear_.solve(x, 1);
        const double first = -x[n], second = last - dot(n, gradient_.data(), x);
        const double beta = (first * gz - frequency_[n] * second) / determinant_,
                     s = (null_[n] * second - gv * first) / determinant_;
        for (std::int64_t i = 0; i < n; ++i) x[i] += beta * null_[i] + s * frequency_[i];
        x[n] = s;
    }
}

int FoldSystem::determinant_sign() const {
    return determinant_ < 0 ? -linear_.determinant_sign() : linear_.determinant_sign();
}

// (dJ/domega) v: dR/domega is linear in x and the same matrix.
vector<double> FoldSystem::frequency_derivative(const vector<double> &v) {
    vector<double> change(inner_.size());
    inner_.residual(v.data(), omega_of(y_.data()), scratch_.data());
    inner_.parameter_derivative(change.data());
    inner_.residual(y_.data(), omega_of(y_.data()), scratch_.data());
    return change;
}

// Z x (2H + 1) coefficients of the gaps for unknowns x, without the initial gap; the harmonics times
// `factor`.
Matrix FoldSystem::gap_motion(const vector<double> &x, double factor) const {
    const ReducedModel &m = *reduced_;
    const std::int64_t z = m.n_pairs(), r = m.size(), columns = (inner_.size() - m.static_size()) / r;
    Matrix eta(r, columns), u(z, columns + 1), dynamic(z, columns);
    std::copy(x.data() + m.static_size(), x.data() + inner_.size(), eta.data());
    gemv('N', 1.0, m.gap_0, x.data(), 0.0, u.col(0));
    gemm('N', 'N', factor, m.gap, eta, 0.0, dynamic);
    std::copy(dynamic.data(), dynamic.data() + z * columns, u.col(1));
    return u;
}

// dg = -d(w^T J v), the mean over the period of k_n ds W V with ds = du / |u'| at each switching instant; the
// residual of a harmonic is twice a mean, so that w's harmonics count twice in W(t).
vector<double> FoldSystem::contact_gradient(const vector<double> &w, const vector<double> &v) const {
    const ReducedModel &m = *reduced_;
    const std::int64_t z = m.n_pairs(), r = m.size();
    vector<double> gradient(inner_.size(), 0.0);
    if (z == 0) return gradient;
    Matrix u = gap_motion(y_, 1);
    for (std::int64_t i = 0; i < z; ++i) u(i, 0) -= m.contact.initial_gap[i];
    const SwitchingInstants switching = switching_instants(u);
    const Matrix ut = u.transposed(), vt = gap_motion(v, 1).transposed(), wt = gap_motion(w, 2).transposed();
    const std::int64_t columns = u.cols() - 1, h = columns / 2;
    Matrix change(z, columns + 1);
    for (std::int64_t i = 0; i < z; ++i)
        for (double t : switching.instants[i]) {
            const double speed = std::abs(evaluate_trig(ut.col(i), h, t).slope);
            if (speed == 0) continue;
            const double weight = m.contact.stiffness[i] * evaluate_trig(vt.col(i), h, t).value *
                                  evaluate_trig(wt.col(i), h, t).value / (2 * M_PI * speed);
            change(i, 0) += weight;
            for (std::int64_t k = 1; k <= h; ++k) {
                change(i, 2 * k - 1) += weight * std::cos(static_cast<double>(k) * t);
                change(i, 2 * k) += weight * std::sin(static_cast<double>(k) * t);
            }
        }
    gemv('T', -1.0, m.gap_0, change.col(0), 0.0, gradient.data());
    for (std::int64_t c = 0; c < columns; ++c)
        gemv('T', -1.0, m.gap, change.col(c + 1), 0.0, gradient.data() + m.static_size() + c * r);
    return gradient;
}

namespace {

class FoldPath final : public PathOwner {
  public:
    FoldPath(std::shared_ptr<const ReducedModel> reduced, const FoldOptions &options,
             const BranchPoint &about, Watch watch)
        : options_(options), watch_(watch) {
        HbmOptions &o = options_.hbm;
        o.unknowns = NonlinearUnknowns::modal;
        o.aft = AftKind::event;
        o.n_harmonics = harmonics_of(about, o.period_multiple);
        inner_ = make_system(reduced, o);
        const vector<double> x = unknowns_of(*inner_, about);
        const std::int64_t s = inner_->static_size();
        scale_ = norm2(inner_->size() - s, x.data() + s);
        constexpr double as_much = 0.05; // change of omega that counts like one of the response by itself
        system_ = std::make_unique<FoldSystem>(*inner_, reduced, about, scale_ / (as_much * about.omega));
        branch_ = std::make_shared<Branch>(reduced, o.force_scale, o.period_multiple);
    }

    bool correct(double force, BranchPoint &point) {
        vector<double> y = unknowns_of(*system_, point);
        const NewtonOutcome out = newton_at(*system_, newton_limits(options_.hbm), y, force);
        if (!out.converged) return false;
        put_solution(*system_, {y, force}, out.residual, out.iterations, point);
        return point.omega > 0;
    }

    std::shared_ptr<Branch> follow(const BranchPoint &start) {
        PathOptions range = path_options(options_.hbm, options_.force_min, options_.force_max);
        range.upward = options_.upward;
        constexpr double first = 0.05; // an extremum may be close
        range.initial_step = first * range.max_step;
        range.locate = true;
        PathStart from;
        from.at = {unknowns_of(*system_, start), start.force_scale};
        from.residual = start.residual;
        from.scale = scale_;
        take_outcome(follow_path(*system_, range, from, *this), *branch_);
        branch_->unknowns_used = "modal";
        return branch_;
    }

    void record(const PathPoint &p) override {
        turned_ = turned_ || p.bifurcation == PLM_BIFURCATION_FOLD;
        branch_->append(solved_point(*system_, p));
    }
    bool cancelled(double fraction) override {
        watch_.step("folds", fraction);
        return false;
    }
    bool rescue(double, vector<double> &) override { return false; }
    bool interrupt() override { return options_.stop_at_turn && turned_; }

  private:
    FoldOptions options_;
    Watch watch_;
    std::unique_ptr<HbmSystem> inner_;
    std::unique_ptr<FoldSystem> system_;
    std::shared_ptr<Branch> branch_;
    double scale_ = 0;
    bool turned_ = false;
};

} // namespace

bool correct_fold(std::shared_ptr<const ReducedModel> reduced, const HbmOptions &options, double force,
                  BranchPoint &point) {
    FoldOptions o;
    o.hbm = options;
    return FoldPath(std::move(reduced), o, point, Watch()).correct(force, point);
}

std::shared_ptr<Branch> follow_folds(std::shared_ptr<const ReducedModel> reduced, const FoldOptions &options,
                                     const BranchPoint &fold, Watch watch) {
    FoldPath path(std::move(reduced), options, fold, watch);
    BranchPoint start = fold;
    if (!path.correct(fold.force_scale, start)) return nullptr;
    return path.follow(start);
}

namespace {

bool ends_well(const Branch &b) {
    return b.end_reason == PLM_REASON_RANGE_END || b.end_reason == PLM_REASON_LOOP_CLOSED;
}

} // namespace

std::shared_ptr<Branch> follow_folds_both_ways(std::shared_ptr<const ReducedModel> reduced,
                                               FoldOptions options, const BranchPoint &fold, Watch watch) {
    options.upward = false;
    const auto below = follow_folds(reduced, options, fold, watch);
    if (!below || below->end_reason == PLM_REASON_LOOP_CLOSED) return below;
    const std::int64_t used = static_cast<std::int64_t>(below->points().size());
    options.upward = true;
    options.hbm.max_points = std::max<std::int64_t>(1, options.hbm.max_points - used + 1);
    const auto above = follow_folds(std::move(reduced), options, fold, watch);
    if (!above) return below;
    const auto whole = joined(*below, *above);
    if (!ends_well(*below)) whole->end_reason = below->end_reason;
    return whole;
}

} // namespace plm
