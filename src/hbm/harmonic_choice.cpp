#include "hbm/harmonic_choice.hpp"
#include "hbm/make_system.hpp"
#include "hbm/solved_point.hpp"
#include "hbm/start.hpp"
#include "motions/first_harmonics.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

// Allowed share of the next harmonics in the motion of the gaps, as a multiple of harmonic_tolerance: local
// motions of the surfaces that hardly act back on the structure may be left coarse, but not unresolved.
constexpr double tail_allowance = 20;

// Of a step, in terms of HbmOptions::dearest_step: a curve takes some two hundred, all of them about alike.
constexpr double dearest_with_harmonics = 12;

// A step of a first curve, which takes some five hundred of them: three seconds or so.
constexpr double flops_of_look = 1.5e8;

void require_excitation(const ReducedModel &m, const HbmOptions &o) {
    const bool automatic = o.n_harmonics == 0;
    const std::int64_t most = automatic ? o.max_harmonics : o.n_harmonics, needed = highest_excitation(m);
    if (needed <= most) return;
    const char *name = automatic ? "max_harmonics" : "n_harmonics";
    throw Error(
        status::argument,
        format("the excitation has a harmonic %lld, which %s = %lld would leave out; set %s to %lld or "
               "more, or take that load out of the excitation",
               static_cast<long long>(needed), name, static_cast<long long>(most), name,
               static_cast<long long>(needed)))
        .argument(name);
}

} // namespace

std::int64_t harmonics_of_look(const ReducedModel &reduced) {
    const std::int64_t fewest = highest_excitation(reduced);
    std::int64_t h = few_harmonics(reduced);
    while (h > fewest && harmonic_step_flops(reduced, h) > flops_of_look) --h;
    return h;
}

HbmOptions with_affordable_harmonics(const ReducedModel &reduced, HbmOptions options) {
    if (options.n_harmonics != 0) return options;
    const std::int64_t fewest = few_harmonics(reduced), asked = options.max_harmonics;
    const double dearest = dearest_with_harmonics * options.dearest_step;
    const auto per_period = [&](std::int64_t h) { return h * options.period_multiple; };
    while (options.max_harmonics > fewest &&
           harmonic_step_flops(reduced, per_period(options.max_harmonics)) > dearest)
        --options.max_harmonics;
    options.harmonics_by_cost = options.harmonics_by_cost || options.max_harmonics < asked;
    return options;
}

HbmOptions with_first_harmonics(const ReducedModel &reduced, const HbmOptions &options) {
    require_excitation(reduced, options);
    HbmOptions first = options;
    if (first.n_harmonics == 0) first.n_harmonics = std::min(options.max_harmonics, few_harmonics(reduced));
    return first;
}

std::int64_t next_harmonics(const HbmOptions &limits, std::int64_t fewest, std::int64_t now,
                            const HarmonicContent &content, double error) {
    const std::int64_t most = std::max(limits.max_harmonics, now);
    const double over = std::max(error, content.tail / tail_allowance) / limits.allowed_harmonic_error();
    constexpr double far_too_few = 30; // times the tolerance: below, two fifths more are likely to do
    constexpr double too_many = 0.3;   // of the tolerance: no number is to be taken back at the next point
    if (over > far_too_few) return std::min(most, 2 * now);
    if (over > 1) return std::min(most, std::max(now + 2, (7 * now + 4) / 5));
    // without the upper two fifths the tail would grow from `tail` to `tail + top`, and its effect with it
    const double grows = content.tail > 0 ? 1 + content.top / content.tail : 1;
    if (over * grows < too_many &&
        content.tail + content.top < too_many * tail_allowance * limits.allowed_harmonic_error())
        return std::max(fewest, now - (2 * now) / 5);
    return now;
}

std::int64_t harmonics_of(const BranchPoint &point, std::int64_t period_multiple) {
    return std::max<std::int64_t>(1, point.n_harmonics / period_multiple);
}

HbmOptions options_at(const BranchPoint &point, std::int64_t period_multiple, const HbmOptions &options) {
    HbmOptions o = options;
    o.period_multiple = period_multiple;
    o.n_harmonics = harmonics_of(point, period_multiple);
    o.force_scale = point.force_scale;
    if (!point.contact_stiffness) {
        o.formulation = FormulationKind::penalty;
        return o;
    }
    if (o.formulation == FormulationKind::penalty) o.formulation = FormulationKind::automatic;
    if (o.unknowns == NonlinearUnknowns::modal)
        o.unknowns = NonlinearUnknowns::gaps; // all that the compliance form has
    return o;
}

MeasuredHarmonics measure_harmonics(std::shared_ptr<const ReducedModel> reduced, const HbmOptions &options,
                                    BranchPoint &point) {
    const auto system = make_system(reduced, options_at(point, options.period_multiple, options));
    vector<double> x(system->size()), residual(system->size());
    system->from_point(point, x.data());
    system->residual(x.data(), point.omega, residual.data());
    system->linearize();
    MeasuredHarmonics out;
    out.content = harmonic_content(*reduced, point, options.period_multiple);
    out.change = harmonic_change(*reduced, point, options.period_multiple, out.content, *system, x.data());
    point.harmonic_tail = out.content.tail;
    point.harmonic_error = harmonic_error(*reduced, point, out.change);
    return out;
}

// --- more harmonics at one frequency

namespace {

// The point with options.n_harmonics harmonics: from itself (warm), or by all means of a first solution.
bool solved_with(std::shared_ptr<const ReducedModel> reduced, const HbmOptions &options, bool warm,
                 Watch watch, BranchPoint &point) {
    const auto system = make_system(reduced, options);
    vector<double> x(system->size());
    system->from_point(point, x.data());
    const StartOutcome out = warm ? correct_at(*system, options, point.omega, watch, x)
                                  : find_start(*system, *reduced, options, point.omega, false, watch, x);
    if (!out.converged) return false;
    put_solution(*system, {x, point.omega}, out.residual, point.iterations + out.iterations, point);
    return true;
}

} // namespace

bool climb_harmonics(std::shared_ptr<const ReducedModel> reduced, const HbmOptions &options,
                     std::int64_t wanted, BranchPoint &point, Watch watch) {
    HbmOptions now = options;
    std::int64_t reached = harmonics_of(point, options.period_multiple),
                 stride = std::max<std::int64_t>(1, reached);
    for (int failures = 0; reached < wanted && failures < 5;) {
        now.n_harmonics = std::min(wanted, reached + stride);
        if (solved_with(reduced, now, true, watch, point)) {
            reached = now.n_harmonics;
            stride = std::max(stride, reached / 2);
        } else {
            if (stride == 1) break; // the same again would be found no more
            ++failures;
            stride = std::max<std::int64_t>(1, stride / 3);
        }
    }
    return reached >= wanted;
}

namespace {

// Of the points found on the way to more harmonics the first one whose error is not much larger than the
// least: where the tolerance cannot be reached (hard impacts, a basis that carries no high harmonics), many
// harmonics cost time and may be further from the solution than few.
const BranchPoint &most_useful(const std::vector<BranchPoint> &tried) {
    const auto less = [](const BranchPoint &a, const BranchPoint &b) {
        return a.harmonic_error < b.harmonic_error;
    };
    const double least = std::min_element(tried.begin(), tried.end(), less)->harmonic_error;
    return *std::find_if(tried.begin(), tried.end(),
                         [&](const BranchPoint &p) { return p.harmonic_error <= 2 * least; });
}

} // namespace

void settle_harmonics(std::shared_ptr<const ReducedModel> reduced, const HbmOptions &options,
                      BranchPoint &point, Watch watch) {
    HbmOptions now = options;
    std::vector<BranchPoint> tried;
    for (;;) {
        now.n_harmonics = harmonics_of(point, options.period_multiple);
        const MeasuredHarmonics measured = measure_harmonics(reduced, now, point);
        std::int64_t more = now.n_harmonics;
        if (options.n_harmonics == 0)
            more = next_harmonics(options, more, more, measured.content, point.harmonic_error);
        tried.push_back(point);
        if (more <= now.n_harmonics) break;
        climb_harmonics(reduced, options, more, point, watch);
        if (harmonics_of(point, options.period_multiple) > now.n_harmonics) continue;
        // nothing near: where the point says little anyhow, from the beginning
        now.n_harmonics = more;
        if (point.harmonic_error < worthless_error || !solved_with(reduced, now, false, watch, point)) break;
    }
    if (options.n_harmonics == 0 && !(point.harmonic_error <= options.allowed_harmonic_error()))
        point = most_useful(tried);
    if (options.tail_correction)
        point.eta.append(harmonic_content(*reduced, point, options.period_multiple).tail_response);
}

// --- what is said

namespace {

// ", where DOF 12 moves most (1.2e-3)": what an engineer looks the point up by.
std::string most_moved(const Branch &branch, const BranchPoint &p) {
    const ReducedModel &m = branch.reduced();
    if (!m.model || p.eta.cols() < 2) return {};
    const LargestEntry most = largest_entry(combine(m.vectors, p.eta.columns(0, 2)));
    return format(", where DOF %lld moves most, by %.4g", static_cast<long long>(m.model->dof(most.row)),
                  most.size);
}

std::string remedy(const HbmOptions &o, const BranchPoint &p) {
    const char *others =
        "make the basis for more harmonics (n_harmonics of sampler and basis) or the contact "
        "softer, and compare with the exact periodic motion that a transient finds";
    if (o.harmonics_by_cost && harmonics_of(p, o.period_multiple) >= o.max_harmonics)
        return format(
                   "a curve of more than %lld harmonics takes longer than is allowed here. Set n_harmonics "
                   "for more or, if that is accurate enough, harmonic_tolerance; otherwise ",
                   static_cast<long long>(o.max_harmonics)) +
               others;
    if (harmonics_of(p, o.period_multiple) >= o.max_harmonics)
        return format("raise max_harmonics (%lld) or, if that is accurate enough, harmonic_tolerance; "
                      "otherwise ",
                      static_cast<long long>(o.max_harmonics)) +
               others;
    return std::string("more harmonics lead to no solution near it, or to none that is better; ") + others;
}

void warn(const HbmOptions &o, std::int64_t over, std::int64_t worst, double error, Branch &branch) {
    const auto &points = branch.points();
    const BranchPoint &p = points[static_cast<std::size_t>(worst)];
    branch.warnings.add(
        reason::harmonics_too_few,
        format("harmonic_tolerance (%.2g) was not reached at %lld of %lld points; the largest error is "
               "estimated as %.2g at point %lld (%.6g Hz, %lld harmonics%s)%s: %s",
               o.allowed_harmonic_error(), static_cast<long long>(over),
               static_cast<long long>(points.size()), error, static_cast<long long>(worst),
               p.omega / (2 * M_PI), static_cast<long long>(p.n_harmonics), most_moved(branch, p).c_str(),
               error < worthless_error ? "" : ", so that it need not be near any motion",
               remedy(o, p).c_str()));
}

} // namespace

namespace {

// Of a solution of harmonic balance; an exact motion has all harmonics, whatever its coefficients leave out.
double balance_error(const BranchPoint &p) {
    return p.motion ? 0 : p.harmonic_error;
}

} // namespace

bool is_worthless(const Branch &curve) {
    const auto &points = curve.points();
    const auto over = std::count_if(points.begin(), points.end(),
                                    [](const BranchPoint &p) { return balance_error(p) >= worthless_error; });
    return 2 * over > static_cast<std::ptrdiff_t>(points.size());
}

void warn_of_harmonics(const HbmOptions &options, Branch &branch) {
    if (options.n_harmonics != 0) return;
    const auto &points = branch.points();
    std::int64_t over = 0, worst = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (balance_error(points[i]) > balance_error(points[static_cast<std::size_t>(worst)]))
            worst = static_cast<std::int64_t>(i);
        over += balance_error(points[i]) > options.allowed_harmonic_error();
    }
    if (over > 0) warn(options, over, worst, balance_error(points[static_cast<std::size_t>(worst)]), branch);
}

void warn_of_harmonics(const HbmOptions &options, double error, Branch &branch) {
    if (options.n_harmonics == 0 && error > options.allowed_harmonic_error())
        warn(options, 1, 0, error, branch);
}

void warn_of_given_harmonics(std::shared_ptr<const ReducedModel> reduced, const HbmOptions &options,
                             std::int64_t dof, Measure measure, std::int64_t harmonic, Branch &one) {
    // whoever gives a number has a reason; what is far off is none
    constexpr double far_off = 0.1;
    BranchPoint point = one.points()[0];
    const MeasuredHarmonics next =
        measure_harmonics(reduced, options_at(point, one.period_multiple(), options), point);
    const double error = harmonic_error_at(*reduced, point, next.change, dof, measure, harmonic);
    if (error < far_off) return;
    one.warnings.add(
        reason::harmonics_too_few,
        format("n_harmonics = %lld is too few for this peak: the next harmonics would change it by %s. Raise "
               "n_harmonics, or set it to 0, and each point gets as many as it needs",
               static_cast<long long>(harmonics_of(point, one.period_multiple())),
               error < 1 ? format("about %.2g of itself", error).c_str() : "more than itself"));
}

void warn_of_backbone(const HbmOptions &options, Watch watch, Branch &backbone) {
    double worst = 0, hz = 0;
    for (BranchPoint point : backbone.points()) {
        measure_harmonics(backbone.reduced_model(), options, point);
        if (!(point.harmonic_error > worst)) continue;
        worst = point.harmonic_error;
        hz = point.omega / (2 * M_PI);
    }
    if (worst <= options.allowed_harmonic_error() || backbone.points().empty()) return;
    watch.keeping(backbone.warnings)
        .warn(
            reason::harmonics_too_few,
            format(
                "this backbone has %lld harmonics at every point, and the next ones would change it by about "
                "%.2g of itself at %.6g Hz. Set n_harmonics to as many as it needs, or motion to exact",
                static_cast<long long>(backbone.n_harmonics()), worst, hz));
}

} // namespace plm
