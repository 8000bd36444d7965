// Periodic motions as equations: their derivatives against differences, their solutions against the tests'
// own orbits, with and without the modes of contact sets that come back.
#include "flows.hpp"
#include "orbits/contact_set.hpp"
#include "orbits/orbit_equations.hpp"
#include "orbits/orbit_work.hpp"
#include "orbits/recorded_motion.hpp"
#include "orbits/shooting.hpp"
#include "paths/newton.hpp"

using namespace test;
using plm::FlowParameter;
using plm::OrbitEquations;

namespace {

FlowState rest_of(const plm::FlowModel &m) {
    const plm::vector<double> zero(static_cast<std::size_t>(m.size()), 0.0);
    return {zero, zero, 0};
}

OrbitEquations equations(const exact::Structure &s, double omega, FlowParameter parameter,
                         std::int64_t periods = 1, const plm::GapMotion &walls = {}, bool grow = false) {
    const auto model = flow_model(s, walls, grow);
    return OrbitEquations(model, rest_of(*model), {omega, 1.0, periods}, parameter);
}

plm::vector<double> residual(OrbitEquations &e, const plm::vector<double> &x, double p) {
    plm::vector<double> r(x.size());
    e.residual(x.data(), p, r.data());
    return r;
}

// By marching and damped steps; Newton's method ends it. Behind impacts, from where marching happens to be it
// may fail, by the last digits: from a little later then.
plm::vector<double> solution(OrbitEquations &e, double p) {
    const plm::vector<double> rest(static_cast<std::size_t>(e.size()), 0.0);
    const plm::OrbitConditions c = e.conditions(p);
    plm::ExactFlow flow(e.shared_model(), c.omega, c.force_scale);
    plm::vector<double> x;
    for (int periods : {40, 43, 46}) {
        plm::ShootingOptions options;
        options.transient_periods = periods;
        options.max_iterations = 6;
        x = e.unknowns(plm::periodic_orbit(flow, e.state(rest.data()), options).state);
        plm::NewtonLimits limits;
        limits.tolerance = 1e-12;
        if (plm::newton_at(e, limits, x, p).converged) break;
    }
    return x;
}

// Largest difference of the derivative by the parameter, and of that along a direction, from central
// differences, as shares.
struct Errors {
    double parameter = 1e300, direction = 1e300, solution = 1e300;
};
Errors derivative_errors(const exact::Structure &s, double omega, FlowParameter parameter, double p,
                         std::int64_t periods = 1, const plm::GapMotion &walls = {}, bool grow = false) {
    OrbitEquations e = equations(s, omega, parameter, periods, walls, grow);
    const plm::vector<double> x = solution(e, p);
    const std::size_t n = x.size();
    Errors out;
    out.solution = plm::norm2(e.size(), residual(e, x, p).data()) / plm::norm2(e.size(), x.data());
    e.linearize();
    plm::vector<double> by_p(n), v = plm::patternless_vector(e.size()), back = v;
    e.parameter_derivative(by_p.data());
    e.solve(back.data(), 1); // x' with J x' = v: J x' is to be v again
    const double h = 1e-6 * p, g = 1e-6 * plm::norm2(e.size(), x.data()) / plm::norm2(e.size(), back.data());
    const plm::vector<double> up = residual(e, x, p + h), down = residual(e, x, p - h);
    plm::vector<double> ahead = x, behind = x;
    for (std::size_t i = 0; i < n; ++i) ahead[i] += g * back[i], behind[i] -= g * back[i];
    const plm::vector<double> there = residual(e, ahead, p), here = residual(e, behind, p);
    double size = 0, far = 0, along = 0;
    for (std::size_t i = 0; i < n; ++i) {
        size = std::max(size, std::abs(by_p[i]));
        far = std::max(far, std::abs((up[i] - down[i]) / (2 * h) - by_p[i]));
        along = std::max(along, std::abs((there[i] - here[i]) / (2 * g) - v[i]));
    }
    out.parameter = far / size;
    out.direction = along;
    return out;
}
// Differences over 1e-6 of the motion: events move by as much, and the force bends there.
void derivatives_are_those_of_differences(void **) {
    const exact::Structure s = damped_chain();
    for (const plm::GapMotion &walls : {plm::GapMotion(), moving_walls()})
        for (double omega : {0.4, 0.9, 1.5}) {
            const Errors w = derivative_errors(s, omega, FlowParameter::frequency, omega, 1, walls),
                         f = derivative_errors(s, omega, FlowParameter::force_scale, 1.3, 1, walls),
                         two = derivative_errors(s, omega, FlowParameter::frequency, omega, 2, walls);
            for (const Errors &e : {w, f, two}) {
                assert_true(below(e.solution, 1e-11));
                assert_true(below(e.parameter, 1e-4));
                assert_true(below(e.direction, 1e-4));
            }
        }
}
void loads_that_grow_have_their_derivatives(void **) {
    const exact::Structure s = damped_chain();
    for (double omega : {0.4, 0.9, 1.5})
        for (const Errors &e :
             {derivative_errors(s, omega, FlowParameter::frequency, omega, 1, moving_walls(), true),
              derivative_errors(s, omega, FlowParameter::force_scale, 1.3, 1, {}, true)}) {
            assert_true(below(e.solution, 1e-11));
            assert_true(below(e.parameter, 1e-4));
            assert_true(below(e.direction, 1e-4));
        }
}
void stiff_contact_has_the_same_derivatives(void **) {
    exact::Structure s = damped_chain();
    for (double &k : s.contact_stiffness) k = 1e5;
    const Errors w = derivative_errors(s, 0.4, FlowParameter::frequency, 0.4);
    assert_true(below(w.solution, 1e-10));
    assert_true(below(w.parameter, 1e-3));
    assert_true(below(w.direction, 1e-3));
}

// How far the tests' own flow takes a solution in a period.
double defect_by_own_flow(double omega, double k_n) {
    exact::Structure s = damped_chain();
    for (double &k : s.contact_stiffness) k = k_n;
    OrbitEquations e = equations(s, omega, FlowParameter::frequency);
    const plm::vector<double> x = solution(e, omega);
    const std::vector<double> start = to_dofs(e.model(), e.state(x.data()));
    return max_difference(exact::period_map(s, omega, start, nullptr), start);
}
void solutions_are_orbits(void **) {
    for (double omega : {0.2, 0.4, 1.5}) assert_true(below(defect_by_own_flow(omega, 3), 1e-12));
    // where the motion is stable: an unstable one would multiply the digits that are not there
    assert_true(below(defect_by_own_flow(0.9, 1e5), 1e-9));
}

// --- the flow by the modes of its contact sets against its series

struct Flows {
    double state = 0, multipliers = 0;
    double passing = 0, roughly = 0; // once the ways between the sets are known; in single precision
    std::int64_t pieces_of_series = 0, pieces_of_modes = 0;
};
class Polynomials final : public plm::FlowRecorder { // makes the flow keep to its series
  public:
    void record(const plm::FlowPiece &) override {}
};
// ground: of a spring that all but fixes the first mass, a mode which hardly moves.
Flows flows(double k_n, double omega, double ground = 0) {
    exact::Structure s = damped_chain();
    for (double &k : s.contact_stiffness) k = k_n;
    s.stiffness[0] += ground;
    const auto model = flow_model(s);
    const auto modes = std::make_shared<plm::ContactModesKept>(model);
    plm::ExactFlow series(model, omega, 1), by_modes(model, omega, 1, plm::Watch(), modes);
    FlowState start = rest_of(*model), a, b;
    for (int k = 0; k < 30; ++k) { // the sets become known
        by_modes.advance(start, by_modes.period());
        start.time = 0;
    }
    Polynomials keep;
    plm::ContactHistory history;
    a = b = start;
    const std::int64_t before = by_modes.n_steps();
    series.advance(a, series.period(), &keep);
    by_modes.advance(b, by_modes.period(), &history);
    Flows out;
    out.pieces_of_series = series.n_steps(), out.pieces_of_modes = by_modes.n_steps() - before;
    const auto x = to_dofs(*model, a), y = to_dofs(*model, b);
    double size = 0;
    for (double v : x) size = std::max(size, std::abs(v));
    out.state = max_difference(x, y) / size;
    const auto largest = [&](double tolerance, plm::ContactModesKept *by) {
        return std::abs(
            plm::multipliers(plm::monodromy(*model, history.intervals(), tolerance, plm::Watch(), by))[0]);
    };
    const double m = largest(1e-15, nullptr);
    out.multipliers = std::abs(largest(1e-15, modes.get()) / m - 1);
    out.roughly = std::abs(largest(1e-5, modes.get()) / m - 1);
    FlowState passed = start;
    by_modes.advance(passed, by_modes.period());
    out.passing = max_difference(x, to_dofs(*model, passed)) / size;
    return out;
}
void modes_give_the_motion_of_the_series(void **) {
    for (double k_n : {3.0, 1e3, 1e6}) {
        const Flows f = flows(k_n, 0.4);
        // an event a rounding earlier is carried on by the multipliers of many impacts
        assert_true(below(f.state, k_n < 1e5 ? 1e-10 : 1e-7));
        assert_true(below(f.passing, k_n < 1e5 ? 1e-10 : 1e-7));
        assert_true(below(f.multipliers, 1e-8));
        assert_true(below(f.roughly, 1e-3));
    }
}
void a_mode_that_hardly_moves_does_not_dictate_the_pieces(void **) {
    const Flows f = flows(3, 0.4, 1e8);
    assert_true(f.pieces_of_modes * 50 < f.pieces_of_series);
    assert_true(below(f.state, 1e-9));
}

// Three coordinates with mass, three without: all follow, two of them relax, or a dashpot between what has
// mass and what has none.
enum class Massless { follow, relax, dashpot };
std::shared_ptr<const plm::FlowModel> massless_model(Massless kind, double k_n,
                                                     const plm::GapMotion &walls = {}) {
    constexpr int n = 6, z = 2;
    auto m = std::make_shared<plm::ReducedModel>();
    m->lambda = m->lambda_0 = {1, 2.5, 6, 5, 9, 14};
    m->n_massless = m->n_massless_0 = 3;
    if (kind == Massless::relax) {
        m->damping_diagonal = {0.05, 0.06, 0.07, 0.3, 0, 0.03};
    } else {
        m->damping_diagonal = {0.05, 0.06, 0.07, 0, 0, 0};
    }
    if (kind == Massless::dashpot) {
        const double w[n] = {0.3, -0.2, 0.1, 0.5, 0, 0};
        m->damping.reset(n, n);
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i)
                m->damping(i, j) = w[i] * w[j] + (i == j ? m->damping_diagonal[i] : 0.0);
        m->damping_diagonal.clear();
    }
    m->gap.reset(z, n);
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < z; ++i) m->gap(i, j) = std::cos(1.7 * j + 2.3 * i + 0.4);
    m->gap_0 = m->gap;
    m->contact.stiffness = {k_n, 2 * k_n};
    m->contact.initial_gap = {0.02, 0.05};
    m->contact.motion = walls;
    m->preload_0 = {0.01, 0, 0.02, 0.03, 0, 0.01};
    m->excitation[1] = {{0.1, 0.2, 0, 0.3, -0.1, 0.2}, {0, 0.05, 0.1, -0.2, 0.1, 0}};
    m->vectors = plm::SpaceVectors(plm::Field(n, n));
    return std::make_shared<plm::FlowModel>(std::move(m));
}

// What a flow shows of two periods. `by_modes`: else it is made to keep to its series.
class Shown final : public plm::FlowRecorder {
  public:
    explicit Shown(bool by_modes) : by_modes_(by_modes) {}
    bool only_polynomials() const override { return !by_modes_; }
    void record(const plm::FlowPiece &piece) override {
        motion.record(piece);
        history.record(piece);
    }
    plm::RecordedMotion motion;
    plm::ContactHistory history;

  private:
    bool by_modes_;
};

// Means, displacements and velocities of all coordinates, and the parameter's effect on those in the state.
struct Run {
    std::vector<double> state, change, dofs;
    std::vector<double> end; // by stays, which show no motion
    plm::Matrix monodromy;
    std::int64_t n_events = 0;
};
Run two_periods(const std::shared_ptr<const plm::FlowModel> &model, FlowParameter parameter, bool by_modes) {
    constexpr double omega = 0.7;
    const auto n = static_cast<std::size_t>(model->size());
    const FlowState start{plm::vector<double>(n, 0.0), plm::vector<double>(n, 0.0), 0};
    const auto modes = std::make_shared<plm::ContactModesKept>(model);
    plm::ExactFlow passing(model, omega, 1, plm::Watch(), modes), flow(model, omega, 1, plm::Watch(), modes);
    for (int k = 0; k < 30 && by_modes; ++k) { // the sets become known
        FlowState state = start;
        passing.advance(state, 2 * passing.period());
    }
    if (by_modes) { // and the ways between them
        plm::ContactHistory history;
        FlowState state = start;
        passing.advance(state, 2 * passing.period(), &history);
        plm::monodromy(*model, history.intervals(), 1e-15, plm::Watch(), modes.get());
    }
    Shown shown(by_modes);
    flow.differentiate(parameter);
    FlowState end = start;
    flow.advance(end, 2 * flow.period(), &shown);
    Run out;
    out.n_events = flow.n_events();
    const auto add = [](const plm::vector<double> &x, std::int64_t count, std::vector<double> &to) {
        to.insert(to.end(), x.begin(), x.begin() + count);
    };
    for (const plm::vector<double> &x : {shown.motion.mean(), end.y, end.v}) add(x, model->size(), out.state);
    out.dofs = test::to_dofs(*model, end);
    flow.advance(end = start, 2 * flow.period());
    for (const plm::vector<double> &x : {end.y, end.v}) add(x, model->size(), out.end);
    add(flow.change().y, model->n_moving(), out.change);
    add(flow.change().v, model->n_massive(), out.change);
    out.monodromy = plm::monodromy(*model, shown.history.intervals(), 1e-15, plm::Watch(),
                                   by_modes ? modes.get() : nullptr);
    return out;
}
void series_and_modes_agree(const std::shared_ptr<const plm::FlowModel> &model, FlowParameter by,
                            std::int64_t fewest_events = 10) {
    const Run series = two_periods(model, by, false), modes = two_periods(model, by, true);
    assert_true(series.n_events >
                fewest_events); // a pair that only just touches and parts may be seen or not
    assert_true(std::abs(series.n_events - modes.n_events) <= 2);
    assert_true(below(max_difference(series.state, modes.state), 1e-9));
    assert_true(below(max_difference(series.end, modes.end), 1e-9));
    assert_true(below(max_difference(series.change, modes.change), 1e-8));
    assert_true(below(max_difference(series.monodromy, modes.monodromy), 1e-8));
}
void modes_know_what_has_no_mass(void **) {
    for (Massless kind : {Massless::follow, Massless::relax, Massless::dashpot})
        for (double k_n : {3.0, 1e2})
            for (FlowParameter by : {FlowParameter::frequency, FlowParameter::force_scale}) {
                series_and_modes_agree(massless_model(kind, k_n), by);
                series_and_modes_agree(massless_model(kind, k_n, moving_walls()), by);
            }
}
// The second harmonic of the load, over two periods, by the Fourier coefficients of what a series shows.
double error_of_work(const std::shared_ptr<const plm::FlowModel> &model) {
    constexpr double omega = 0.7;
    const auto n = static_cast<std::size_t>(model->size());
    const FlowState start{plm::vector<double>(n, 0.0), plm::vector<double>(n, 0.0), 0};
    plm::HarmonicLoad load;
    for (std::size_t j = 0; j < n; ++j) {
        load.real.push_back(1 + 0.3 * static_cast<double>(j));
        load.imag.push_back(std::sin(static_cast<double>(j) + 1));
    }
    plm::ExactFlow flow(model, omega, 1);
    Shown shown(false);
    FlowState end = start;
    flow.advance(end, 2 * flow.period(), &shown);
    const plm::Matrix q = shown.motion.harmonics(4, 1);
    double by_coefficient = 0;
    for (std::int64_t j = 0; j < q.rows(); ++j)
        by_coefficient += flow.period() * (load.real[j] * q(j, 0) - load.imag[j] * q(j, 1));
    plm::ContactModesKept modes(model);
    const double work =
        plm::orbit_work(*model, start, omega, 1, shown.history.intervals(), load, 2 * omega, modes);
    return std::abs(work - by_coefficient) / std::abs(by_coefficient);
}
void modes_know_the_work(void **) {
    for (Massless kind : {Massless::follow, Massless::relax, Massless::dashpot})
        for (double k_n : {3.0, 1e2}) {
            assert_true(below(error_of_work(massless_model(kind, k_n)), 1e-9));
            assert_true(below(error_of_work(massless_model(kind, k_n, moving_walls())), 1e-9));
        }
}
void modes_know_how_walls_move(void **) {
    for (FlowParameter by : {FlowParameter::frequency, FlowParameter::force_scale})
        for (bool grow : {false, true})
            series_and_modes_agree(flow_model(damped_chain(), moving_walls(), grow), by, 4);
}

// A chain that nothing holds, pressed against a stop that throws it off: in flight its centre goes by
// polynomials, with coinciding eigenvectors, beside what rings.
void modes_know_what_is_free(void **) {
    for (double k_n : {3.0, 1e3})
        for (double drag : {0.0, 0.02})
            for (FlowParameter by : {FlowParameter::frequency, FlowParameter::force_scale}) {
                exact::Structure s = test::chain(4, 0.03, k_n, 0.05, 0.6, 0.2, {3});
                s.stiffness[0] -= 1; // the spring to the ground, with its damping
                s.damping[0] = -s.damping[1];
                for (int i = 0; i < s.n; ++i) s.damping[i * (s.n + 1)] += drag * s.mass[i];
                const auto model = test::flow_model(s);
                const plm::ContactModes flight(*model, plm::PairStates::all_open(1));
                assert_true(flight.usable() && flight.free_block().rows() == (drag > 0 ? 1 : 2));
                const Run series = two_periods(model, by, false), modes = two_periods(model, by, true);
                assert_true(series.n_events > 3 && series.n_events == modes.n_events);
                assert_true(below(max_difference(series.state, modes.state), 1e-10));
                assert_true(below(max_difference(series.end, modes.end), 1e-9));
                assert_true(below(max_difference(series.change, modes.change), 1e-8));
                // two ways to sum up two periods of growth by 1e3: their rounding, 1.3e-9 with another
                // compiler
                assert_true(below(max_difference(series.monodromy, modes.monodromy), 1e-8));
                std::vector<double> truth(2 * s.n, 0.0);
                for (int k = 0; k < 2; ++k) truth = exact::period_map(s, 0.7, truth, nullptr);
                assert_true(below(max_difference(modes.dofs, truth), 1e-9));
            }
}

// Back where they were linearised, with all that belongs to that place, unless other equations have come.
struct Recalled {
    double solution = 1e300, derivative = 1e300, multiplier = 1e300;
    bool known = false, still_known = true;
};
Recalled recalled() {
    OrbitEquations e = equations(damped_chain(), 0.4, FlowParameter::frequency);
    const plm::vector<double> x = solution(e, 0.4);
    plm::vector<double> elsewhere = x, b(x.size(), 1.0), c = b, by_p(x.size()), again = by_p;
    elsewhere[0] *= 1.1;
    residual(e, x, 0.4);
    e.linearize();
    e.remember();
    e.solve(b.data(), 1);
    e.parameter_derivative(by_p.data());
    const auto multiplier = e.multipliers()[0];
    residual(e, elsewhere, 0.41);
    e.linearize();
    e.multipliers();
    Recalled out;
    out.known = e.recall();
    e.solve(c.data(), 1);
    e.parameter_derivative(again.data());
    out.solution = max_difference({b.begin(), b.end()}, {c.begin(), c.end()});
    out.derivative = max_difference({by_p.begin(), by_p.end()}, {again.begin(), again.end()});
    out.multiplier = std::abs(e.multipliers()[0] - multiplier);
    e.set_other(2);
    out.still_known = e.recall();
    return out;
}
void a_place_that_is_remembered_is_there_again(void **) {
    const Recalled r = recalled();
    assert_true(r.known);
    assert_true(r.solution == 0 && r.derivative == 0 && r.multiplier == 0);
    assert_false(r.still_known);
}

// Damping of the wrong sign and size, where rounding grows beyond all numbers within a period: no motion, in
// finite time, and no error.
void what_overflows_ends_newton_s_method(void **) {
    exact::Structure s = damped_chain();
    for (int i = 0; i < s.n; ++i) s.damping[i * s.n + i] -= 400;
    std::fill(s.gap.begin(), s.gap.end(), 1e3);
    std::fill(s.preload.begin(), s.preload.end(), 0.0);
    const auto model = flow_model(s);
    for (double force_scale : {0.0, 1.0}) {
        OrbitEquations e(model, rest_of(*model), {0.4, force_scale, 1}, FlowParameter::frequency);
        plm::vector<double> x(static_cast<std::size_t>(e.size()), 0.0);
        double p = 0.4;
        assert_false(plm::newton_at(e, plm::NewtonLimits(), x, p).converged);
    }
}

// --- what is read from a motion, against dense samples of it

struct Reading {
    double harmonics = 0, mean = 0, range = 0, square = 0;
};
Reading reading(double k_n, double ground = 0) {
    exact::Structure s = damped_chain();
    for (double &k : s.contact_stiffness) k = k_n;
    s.stiffness[0] += ground;
    OrbitEquations e = equations(s, 0.4, FlowParameter::frequency);
    const plm::vector<double> x = solution(e, 0.4);
    plm::ExactFlow flow(e.shared_model(), 0.4, 1, plm::Watch(), e.modes());
    plm::RecordedMotion motion;
    FlowState state = e.state(x.data());
    flow.advance(state, flow.period(), &motion);
    // five in a period of the stiffest contact's ringing, of which 3e-4 of the motion are left
    const int n_samples = k_n > 1e6 ? 1 << 17 : 4096;
    constexpr int top = 12;
    Matrix rows(1, e.model().size());
    for (std::int64_t j = 0; j < rows.cols(); ++j) rows(0, j) = e.model().dof_row(3)[j];
    std::vector<double> samples(n_samples);
    FlowState now = e.state(x.data());
    plm::ExactFlow second(e.shared_model(), 0.4, 1);
    for (int k = 0; k < n_samples; ++k) {
        second.advance(now, second.period() * k / n_samples);
        samples[k] = plm::dot(rows.cols(), rows.data(), now.y.data());
    }
    Reading r;
    const auto range = motion.ranges(rows)[0];
    const double high = *std::max_element(samples.begin(), samples.end()),
                 low = *std::min_element(samples.begin(), samples.end()), size = high - low;
    r.range = std::max(std::abs(range.maximum - high), std::abs(range.minimum - low)) / size;
    double mean = 0, square = 0;
    for (double v : samples) mean += v / n_samples;
    for (double v : samples) square += (v - mean) * (v - mean) / n_samples;
    const plm::vector<double> got = motion.mean();
    r.mean = std::abs(plm::dot(rows.cols(), rows.data(), got.data()) - mean) / size;
    const Matrix at_rows = plm::product('N', 'N', rows, motion.covariance());
    r.square = std::abs(plm::dot(rows.cols(), at_rows.data(), rows.data()) / square - 1);
    const Matrix h = motion.harmonics(1, top), later = motion.harmonics(5, 2);
    for (int k = 1; k <= top; ++k) {
        double a = 0, b = 0;
        for (int i = 0; i < n_samples; ++i) {
            a += 2 * samples[i] * std::cos(2 * M_PI * k * i / n_samples) / n_samples;
            b += 2 * samples[i] * std::sin(2 * M_PI * k * i / n_samples) / n_samples;
        }
        const double ga = plm::dot(rows.cols(), rows.data(), h.col(2 * k - 2)),
                     gb = plm::dot(rows.cols(), rows.data(), h.col(2 * k - 1));
        r.harmonics = std::max(r.harmonics, std::hypot(ga - a, gb - b) / size);
        if (k == 6) // a block that begins elsewhere is the same
            r.harmonics = std::max(r.harmonics, std::abs(later(0, 2) - h(0, 10)) / size);
    }
    return r;
}
// Sums over samples alias what is beyond half of their number; an extremum between two is a little higher,
// that of the ringing after an impact more.
void readings_are_those_of_dense_samples(void **) {
    struct Case {
        double k_n, ground;
    };
    for (const Case &c : {Case{3.0, 0}, Case{1e4, 0}, Case{1e8, 0}, Case{3.0, 300}}) {
        const double k_n = c.k_n;
        const Reading r = reading(k_n, c.ground);
        assert_true(below(r.harmonics, 1e-6));
        assert_true(below(r.mean, 1e-6));
        assert_true(below(r.range, k_n < 1e6 ? 1e-5 : 1e-4));
        assert_true(below(r.square, 1e-4)); // of samples that do not resolve the ringing
    }
}

// A parabola from 1 over 1.5 back to 1, ripples of 1e9 rad on it, and what dies away as fast.
void crests_of_fast_motion_are_found_at_once(void **) {
    Matrix slow(1, 3);
    slow(0, 0) = 1, slow(0, 1) = 2, slow(0, 2) = -2;
    plm::FastMotion fast;
    fast.rate = {{0, 1e9}, {-1e-3, 2.7e8}, {-1e9, 0}};
    fast.cosine.reset(1, 3), fast.sine.reset(1, 3);
    fast.cosine(0, 0) = 0.01, fast.sine(0, 1) = 1e-4, fast.cosine(0, 2) = 0.1;
    const plm::PairStates none;
    plm::RecordedMotion motion;
    motion.record({0, 1, slow, none, &fast});
    Matrix row(1, 1);
    row(0, 0) = -3;
    const plm::ValueRange range = motion.ranges(row)[0];
    assert_true(below(std::abs(range.minimum + 3 * 1.5101), 1e-5));
    assert_true(below(std::abs(range.maximum + 3 * 0.9899), 1e-5));
}

// What relaxes, k / c of each coordinate alone, is no faster than the bound.
void the_rate_bounds_what_relaxes(void **) {
    for (Massless kind : {Massless::relax, Massless::dashpot}) {
        const auto model = massless_model(kind, 2);
        plm::ContactSet set(*model);
        set.assign_stiffest();
        for (std::int64_t j = model->n_massive(); j < model->n_moving(); ++j)
            assert_true(set.rate() >= set.stiffness()(j, j) / model->own_damping(j));
    }
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(what_overflows_ends_newton_s_method),
        cmocka_unit_test(a_place_that_is_remembered_is_there_again),
        cmocka_unit_test(derivatives_are_those_of_differences),
        cmocka_unit_test(loads_that_grow_have_their_derivatives),
        cmocka_unit_test(stiff_contact_has_the_same_derivatives),
        cmocka_unit_test(solutions_are_orbits),
        cmocka_unit_test(modes_give_the_motion_of_the_series),
        cmocka_unit_test(a_mode_that_hardly_moves_does_not_dictate_the_pieces),
        cmocka_unit_test(modes_know_what_has_no_mass),
        cmocka_unit_test(modes_know_the_work),
        cmocka_unit_test(modes_know_how_walls_move),
        cmocka_unit_test(modes_know_what_is_free),
        cmocka_unit_test(crests_of_fast_motion_are_found_at_once),
        cmocka_unit_test(readings_are_those_of_dense_samples),
        cmocka_unit_test(the_rate_bounds_what_relaxes),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
