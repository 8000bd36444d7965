// The cracked plate with an isolated branch, from the host's arrays through the C API to the search: 150 x 60
// x 5 mm, crack at a quarter of the length, 7 of 13 rows deep, closed at rest by an even pressure on its end,
// Q = 500.
#include "capi/handles.hpp"
#include "orbits/recorded_motion.hpp"
#include "orbits/shooting.hpp"
#include "searches/hbm.hpp"
#include "searches/isolated.hpp"
#include "support/test.hpp"
extern "C" {
#include "cracked_plate.h"
#include "scene_model.h"
}
#include <algorithm>
#include <cmath>
#include <vector>

namespace {

constexpr double lowest_hz = 1250, highest_hz = 2100, force = 0.3;

struct Plate {
    plm_context *context = nullptr;
    scene *host = nullptr;
    std::shared_ptr<const plm::ReducedModel> reduced, full; // piecewise-linear modes, the unreduced structure
    ~Plate() {
        plm_context_destroy(&context);
        scene_destroy(&host);
    }
};

bool build(Plate &plate) {
    cracked_plate_params p;
    cracked_plate_isolated(&p);
    plm_model *model = nullptr;
    plm_sampler *sampler = nullptr;
    plm_basis *basis = nullptr, *full = nullptr;
    if (cracked_plate_create(&p, &plate.host) || plm_context_create(PLM_API_VERSION, &plate.context))
        return false;
    plm_context *c = plate.context;
    must(c, scene_to_model(c, plate.host, &model), "model");
    must(c, plm_sampler_create(model, &sampler), "sampler");
    must(c, plm_sampler_set_string(sampler, "system", "open"), "system");
    must(c, plm_sampler_set_int(sampler, "mode", 3), "mode");
    must(c, plm_sampler_set_int(sampler, "n_samples", 6), "n_samples");
    must(c, plm_sampler_run(sampler), "sampler run");
    must(c, plm_basis_create(model, &basis), "basis");
    must(c, plm_basis_set_sampler(basis, sampler), "basis sampler");
    must(c, plm_basis_build(basis), "basis build");
    plate.reduced = plm::capi::find<plm::capi::BasisHandle>(basis)->core->reduced();
    must(c, plm_basis_create(model, &full), "full basis");
    must(c, plm_basis_set_string(full, "kind", "full"), "kind");
    must(c, plm_basis_set_double(full, "frequency_min_hz", lowest_hz), "window");
    must(c, plm_basis_set_double(full, "frequency_max_hz", highest_hz), "window");
    must(c, plm_basis_build(full), "full basis build");
    plate.full = plm::capi::find<plm::capi::BasisHandle>(full)->core->reduced();
    return true;
}

double highest(const plm::Branch &b, std::int64_t dof, double &at) {
    double best = 0;
    for (std::size_t i = 0; i < b.points().size(); ++i) {
        const double a = b.amplitude(static_cast<std::int64_t>(i), dof, plm::Measure::half_peak_to_peak, 0);
        if (a > best) best = a, at = b.points()[i].omega / (2 * M_PI);
    }
    return best;
}

plm::HbmOptions options() {
    plm::HbmOptions o;
    o.n_harmonics = 9;
    o.frequency_min_hz = lowest_hz;
    o.frequency_max_hz = highest_hz;
    o.force_scale = force;
    return o;
}

struct Isola {
    Plate plate;
    bool built = false;
    std::shared_ptr<const plm::Branch> main;
    plm::IsolatedSearch search;
};
const Isola &isola() {
    static Isola all;
    if (all.main) return all;
    all.built = build(all.plate);
    if (!all.built) return all;
    all.main = plm::Hbm(all.plate.reduced, 0, 0, options(), plm::Watch()).sweep();
    all.search = plm::find_isolated(all.plate.reduced, options(), *all.main, 0, plm::Watch());
    return all;
}

struct Found {
    bool closed = false, tracked = false;
    std::size_t count = 0;
    int folds = 0;
    double main = 0, main_hz = 0, top = 0, top_hz = 0, birth = 0, merge = 0, above = 0, below = 0, unborn = 1;
};
Found find() {
    Found f;
    const Isola &all = isola();
    const std::int64_t dof = all.plate.host->output_dof;
    f.main = highest(*all.main, dof, f.main_hz);
    f.count = all.search.branches.size();
    if (f.count != 1) return f;
    const plm::IsolatedBranch &i = all.search.branches[0];
    f.closed = i.closed, f.tracked = i.tracked;
    f.birth = i.birth_force, f.merge = i.merge_force;
    f.top = highest(*i.branch, dof, f.top_hz);
    for (const auto &p : i.branch->points()) f.folds += p.bifurcation == plm::bifurcation::fold;
    plm::HbmOptions o = options();
    double hz = 0;
    o.force_scale = 0.997 * f.merge;
    f.below = highest(*plm::Hbm(all.plate.reduced, 0, 0, o, plm::Watch()).sweep(), dof, hz);
    o.force_scale = 1.003 * f.merge;
    f.above = highest(*plm::Hbm(all.plate.reduced, 0, 0, o, plm::Watch()).sweep(), dof, hz);
    o.force_scale = 0.98 * f.birth;
    const auto early = plm::Hbm(all.plate.reduced, 0, 0, o, plm::Watch()).sweep();
    f.unborn = static_cast<double>(
        plm::find_isolated(all.plate.reduced, o, *early, 0, plm::Watch()).branches.size());
    return f;
}
void the_plates_isola_is_found(void **) {
    assert_true(isola().built);
    const Found f = find();
    std::printf("    %g N: main peak %.2e mm at %.1f Hz, isola %.2e mm at %.1f Hz, exists for %.4f < F < "
                "%.4f N; %.2f s\n"
                "    main peak just below the merger %.2e mm, just above %.2e mm\n",
                force, f.main, f.main_hz, f.top, f.top_hz, f.birth, f.merge, isola().search.seconds, f.below,
                f.above);
    assert_int_equal(f.count, 1);
    assert_true(f.closed && f.tracked);
    assert_int_equal(f.folds, 2);
    assert_true(f.top > 3 * f.main && f.top_hz < 0.95 * f.main_hz);
    // of the force, on the main branch alone: it swallows the isola at the merger, and none is there before
    // the birth
    assert_true(f.below < 1.2 * f.main && f.above > 3 * f.main);
    assert_true(f.unborn == 0);
}

// The main curve is of harmonic balance on a basis with statics of its own. Exact motions widen such a basis:
// what a solver finds beside the curve has the curve's coordinates, and its harmonics.
void a_solver_with_nothing_set_searches_beside_that_curve(void **) {
    const Isola &all = isola();
    assert_true(all.built && !all.plate.reduced->same_static);
    plm::HbmOptions o = options();
    o.n_harmonics = 0;
    const plm::Hbm solver(all.plate.reduced, 0, 0, o, plm::Watch());
    const plm::IsolatedSearch search = solver.find_isolated(*all.main, 0);
    assert_int_equal(search.branches.size(), 1);
    const plm::Branch &b = *search.branches[0].branch;
    double hz = 0, of_nine = 0;
    const double top = highest(b, all.plate.host->output_dof, hz);
    of_nine = highest(*all.search.branches[0].branch, all.plate.host->output_dof, hz);
    std::printf("    its loop reaches %.4e mm, that of nine harmonics %.4e mm\n", top, of_nine);
    assert_true(std::abs(top - of_nine) < 1e-6 * of_nine);
    assert_true(b.full_residual(static_cast<std::int64_t>(b.points().size() / 2)) < 1);
    o.motion = plm::MotionKind::exact;
    const plm::Hbm exact(all.plate.reduced, 0, 0, o, plm::Watch());
    plm_status refusal = plm::status::ok;
    try {
        exact.find_isolated(*all.main, 0);
    } catch (const plm::Error &e) {
        refusal = e.status();
    }
    assert_int_equal(refusal, plm::status::argument);
}

// --- against the full-order loop

struct Curve {
    std::vector<double> hz, amplitude;
    double top = 0;
};
Curve curve_of(const plm::Branch &b, std::int64_t dof) {
    Curve c;
    for (std::size_t i = 0; i < b.points().size(); ++i) {
        c.hz.push_back(b.points()[i].omega / (2 * M_PI));
        c.amplitude.push_back(
            b.amplitude(static_cast<std::int64_t>(i), dof, plm::Measure::half_peak_to_peak, 0));
        c.top = std::max(c.top, c.amplitude.back());
    }
    return c;
}
// Distance of a point to the polyline, frequency relative to itself and amplitude relative to the top.
double distance_to(const Curve &c, double hz, double amplitude) {
    double best = 1e300;
    for (std::size_t i = 1; i < c.hz.size(); ++i) {
        const double x = (c.hz[i] - c.hz[i - 1]) / hz, y = (c.amplitude[i] - c.amplitude[i - 1]) / c.top;
        const double px = (hz - c.hz[i - 1]) / hz, py = (amplitude - c.amplitude[i - 1]) / c.top;
        const double length = x * x + y * y, t = length > 0 ? (px * x + py * y) / length : 0;
        const double s = std::min(1.0, std::max(0.0, t));
        best = std::min(best, std::hypot(px - s * x, py - s * y));
    }
    return best;
}

// The point in the coordinates of another basis, which are orthonormal in M.
plm::BranchPoint in_basis(const plm::ReducedModel &to, const plm::ReducedModel &from,
                          const plm::BranchPoint &p) {
    plm::BranchPoint q = p;
    const plm::Matrix weighted = plm::multiply(from.model->matrices().mass, from.vectors.formed().in_core()),
                      change = plm::product('T', 'N', to.vectors.formed().in_core(), weighted);
    q.eta = plm::product('N', 'N', change, p.eta);
    q.contact_stiffness.reset();
    // static part: rest about the closed contact is close enough to start from
    const plm::Matrix weighted_0 = plm::multiply(from.model->matrices().mass,
                                                 from.static_vectors().formed().in_core()),
                      change_0 = plm::product('T', 'N', to.static_vectors().formed().in_core(), weighted_0);
    q.eta_0.assign(to.static_vectors().cols(), 0.0);
    plm::gemv('N', 1.0, change_0, p.eta_0.data(), 0.0, q.eta_0.data());
    return q;
}

struct Loops {
    bool closed = false;
    std::int64_t full_size = 0;
    double there = 1, back = 1;
};
Loops compare_loops() {
    Loops l;
    const Isola &all = isola();
    if (all.search.branches.size() != 1) return l;
    const std::int64_t dof = all.plate.host->output_dof;
    const plm::Branch &loop = *all.search.branches[0].branch;
    const plm::ReducedModel &full = *all.plate.full;
    l.full_size = full.size();
    plm::HbmOptions o = options();
    o.unknowns = plm::NonlinearUnknowns::gaps; // 14 pairs against hundreds of coordinates
    const std::size_t middle = loop.points().size() / 3;
    plm::HbmOptions here = o;
    const plm::BranchPoint guess = in_basis(full, *all.plate.reduced, loop.points()[middle]);
    plm::Branch start(all.plate.full, force);
    start.append(guess);
    const auto corrected =
        plm::Hbm(all.plate.full, 0, 0, here, plm::Watch()).solve(guess.omega / (2 * M_PI), &start, 0);
    o.max_step = 0.02; // a dense polyline
    const auto whole = plm::trace_through(all.plate.full, o, corrected->points()[0], plm::Watch());
    l.closed = whole->end_reason == plm::reason::loop_closed;
    o.max_step = 0.02;
    const auto dense = plm::trace_through(all.plate.reduced, o, loop.points()[middle], plm::Watch());
    const Curve a = curve_of(*dense, dof), b = curve_of(*whole, dof);
    l.there = l.back = 0;
    for (std::size_t i = 0; i < a.hz.size(); ++i)
        l.there = std::max(l.there, distance_to(b, a.hz[i], a.amplitude[i]));
    for (std::size_t i = 0; i < b.hz.size(); ++i)
        l.back = std::max(l.back, distance_to(a, b.hz[i], b.amplitude[i]));
    return l;
}
void its_loop_is_that_of_the_full_order(void **) {
    const Loops l = compare_loops();
    std::printf("    %lld coordinates against %lld: largest distance of the loops %.1e and back %.1e\n",
                static_cast<long long>(isola().plate.reduced->size()), static_cast<long long>(l.full_size),
                l.there, l.back);
    assert_true(l.closed);
    assert_true(below(l.there, 1e-3));
    assert_true(below(l.back, 1e-3));
}

// --- against time marching

struct Marched {
    int checked = 0, moving = 0;
    double worst = 0;
};
// Amplitude of the last period after 300 marched ones; an unstable or false motion would have been left by
// then.
double marched_peak(const Plate &plate, const plm::BranchPoint &p, std::int64_t dof) {
    const auto model = std::make_shared<const plm::FlowModel>(plate.reduced, p.omega);
    plm::ExactFlow flow(model, p.omega, force);
    plm::PeriodicOrbit orbit;
    orbit.state = model->state(p.eta_0, p.eta, p.omega, 0.0);
    flow.advance(orbit.state, 300 * flow.period());
    const auto row = model->dof_row(dof);
    plm::Matrix rows(1, model->size());
    for (std::int64_t j = 0; j < model->size(); ++j) rows(0, j) = row[j];
    return plm::orbit_peaks(flow, orbit.state, orbit.period_multiple, rows)[0];
}
// Nowhere else does the loop reach higher at the frequency of point i.
bool on_upper_flank(const Curve &c, std::size_t i) {
    for (std::size_t k = 1; k < c.hz.size(); ++k)
        if ((c.hz[k] - c.hz[i]) * (c.hz[k - 1] - c.hz[i]) <= 0 && c.amplitude[k] > 1.02 * c.amplitude[i])
            return false;
    return true;
}
Marched march() {
    Marched out;
    const Isola &all = isola();
    if (all.search.branches.size() != 1) return out;
    const std::int64_t dof = all.plate.host->output_dof;
    const plm::Branch &loop = *all.search.branches[0].branch;
    plm::HbmOptions o = options();
    o.stability = plm::StabilityKind::floquet;
    const plm::Hbm hbm(all.plate.reduced, 0, 0, o, plm::Watch());
    for (std::size_t i = 0; i < loop.points().size() && out.checked < 4; i += 3) {
        if (loop.points()[i].bifurcation != plm::bifurcation::none)
            continue; // no unique solution to come back to
        const auto one = hbm.solve(loop.points()[i].omega / (2 * M_PI), &loop, static_cast<std::int64_t>(i));
        const plm::BranchPoint &p = one->points()[0];
        if (plm::stability_of(p) != 1 || !on_upper_flank(curve_of(loop, dof), i)) continue;
        ++out.checked;
        out.moving += p.n_switching > 0;
        const double marched = marched_peak(all.plate, p, dof),
                     point = one->amplitude(0, dof, plm::Measure::peak, 0);
        out.worst = std::max(out.worst, std::abs(marched / point - 1));
    }
    return out;
}
void stable_points_persist_in_time(void **) {
    const Marched m = march();
    std::printf("    %d stable points marched 300 periods: amplitude within %.1e\n", m.checked, m.worst);
    assert_true(m.checked >= 3 && m.moving == m.checked);
    assert_true(below(m.worst, 2e-2)); // truncation at 9 harmonics
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(the_plates_isola_is_found),
        cmocka_unit_test(a_solver_with_nothing_set_searches_beside_that_curve),
        cmocka_unit_test(its_loop_is_that_of_the_full_order),
        cmocka_unit_test(stable_points_persist_in_time),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
