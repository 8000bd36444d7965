// Time integration of full models: against the exact flow of the same structure, by its order, its damping
// and its energy, and on a finite-element scene against the flow of its reduced model.
#include "flows.hpp"
#include "orbits/newmark.hpp"
#include "reduction/basis.hpp"
#include "structure/matrix_input.hpp"
#include "support/spring_models.hpp"
#include <limits>
extern "C" {
#include "scene.h"
}

using namespace test;

namespace {

/// Displacements of chosen DOFs at every step.
class DofRecorder final : public plm::NewmarkObserver {
  public:
    DofRecorder(const std::shared_ptr<const plm::Model> &model, std::initializer_list<std::int64_t> dofs) {
        for (std::int64_t dof : dofs) rows_.push_back(model->terms(dof));
    }
    void step(const plm::NewmarkStep &step) override {
        times_.push_back(step.time);
        for (const plm::DofTerms &row : rows_) values_.push_back(step.q.at(row));
    }
    const std::vector<double> &times() const { return times_; }
    /// One step after the other.
    const std::vector<double> &values() const { return values_; }

  private:
    std::vector<plm::DofTerms> rows_;
    std::vector<double> times_, values_;
};

std::vector<double> numbers(const plm::Field &x) {
    return std::vector<double>(x.in_core().data(), x.in_core().data() + x.rows());
}

constexpr double beta_of_chain = 0.02;

exact::Structure structure(double k_n, double damping) {
    exact::Structure s = chain(5, 0, k_n, 0.05, 0.3, 0.05, {1, 4});
    s.damping = s.stiffness;
    for (double &c : s.damping) c *= damping;
    return s;
}

// Displacements after two periods from rest, by Newmark and by the exact flow.
double newmark_error(const exact::Structure &s, double damping, bool explicit_damping, double alpha,
                     std::int64_t steps) {
    const double omega = 0.4;
    ModelExtras extras;
    extras.beta = explicit_damping ? 0 : damping;
    extras.explicit_damping = explicit_damping;
    const auto model = make_model(s, extras);
    plm::NewmarkOptions o;
    o.alpha = alpha;
    o.steps_per_period = steps;
    o.max_periods = 2;
    plm::Newmark newmark(model, omega, o);
    const plm::FullState start = newmark.rest();
    const plm::NewmarkResult r = newmark.run(start);
    const auto flow_of = flow_model(s);
    plm::ExactFlow flow(flow_of, omega, 1);
    std::vector<double> x = numbers(start.q);
    x.resize(2 * s.n, 0.0);
    FlowState state = to_state(*flow_of, s, x);
    flow.advance(state, 2 * flow.period());
    const std::vector<double> want = to_dofs(*flow_of, state);
    double worst = 0;
    for (int i = 0; i < s.n; ++i)
        worst =
            std::max({worst, std::abs(r.state.q.at(i) - want[i]), std::abs(r.state.v.at(i) - want[s.n + i])});
    return worst;
}

void it_converges_with_second_order(void **) {
    for (double alpha : {0.0, 0.1, 1.0 / 3}) {
        const exact::Structure s = structure(5, beta_of_chain);
        const double coarse = newmark_error(s, beta_of_chain, false, alpha, 1000);
        const double fine = newmark_error(s, beta_of_chain, false, alpha, 16000);
        const double order = std::log2(coarse / fine) / 4;
        std::printf("    alpha = %.2f: errors %.1e, %.1e, order %.2f\n", alpha, coarse, fine, order);
        assert_true(order > 1.8 && order < 2.3);
        assert_true(below(fine, 1e-5));
    }
    assert_true(below(newmark_error(structure(5, beta_of_chain), beta_of_chain, true, 0.05, 8000), 1e-5));
    assert_true(below(newmark_error(structure(1e4, beta_of_chain), beta_of_chain, false, 0, 20000), 5e-3));
}

// Free vibration without damping: the trapezoidal rule keeps the energy of a linear structure to rounding,
// HHT takes it out of the highest mode and hardly of the lowest.
double energy_left(double alpha, int mode) {
    exact::Structure s = chain(8, 0, 1, 1e3, 0, 0, {7}); // never in contact
    const auto model = make_model(s);
    plm::NewmarkOptions o;
    o.alpha = alpha;
    o.steps_per_period = 20;
    o.max_periods = 10;
    const plm::SymmetricEigen modes = dense_modes(s, plm::PairStates::all_open(1));
    const double omega = 0.1845; // near the lowest frequency
    plm::Newmark newmark(model, omega, o);
    plm::FullState x = newmark.rest();
    for (int i = 0; i < s.n; ++i) x.q.in_core()(i, 0) = modes.vectors(i, mode);
    const plm::NewmarkResult r = newmark.run(x);
    double e = 0;
    for (int i = 0; i < s.n; ++i) {
        e += r.state.v.at(i) * r.state.v.at(i);
        for (int j = 0; j < s.n; ++j) e += s.stiffness[i * s.n + j] * r.state.q.at(i) * r.state.q.at(j);
    }
    return e / modes.values[mode];
}
void hht_damps_what_it_cannot_resolve(void **) {
    assert_true(near(energy_left(0, 0), 1, 1e-11));
    assert_true(near(energy_left(0, 7), 1, 1e-11));
    const double low = energy_left(0.3, 0), high = energy_left(0.3, 7);
    std::printf("    energy left after 10 periods: lowest mode %.3f, highest %.1e\n", low, high);
    assert_true(low > 0.7 && low < 1);
    assert_true(high < 1e-6);
}

// Under contact the energy of the trapezoidal rule stays bounded: it returns after every impact.
struct Bounded {
    double lowest = 1e300, highest = 0;
};
struct EnergyWatch : plm::NewmarkObserver {
    EnergyWatch(const exact::Structure &structure) : s(structure) {}
    void step(const plm::NewmarkStep &x) override {
        double e = 0;
        for (int i = 0; i < s.n; ++i) {
            e += 0.5 * s.mass[i] * x.v.at(i) * x.v.at(i);
            for (int j = 0; j < s.n; ++j) e += 0.5 * s.stiffness[i * s.n + j] * x.q.at(i) * x.q.at(j);
        }
        for (int p = 0; p < s.z; ++p) e += plm::ContactLaw::energy(s.contact_stiffness[p], x.penetration[p]);
        range.lowest = std::min(range.lowest, e);
        range.highest = std::max(range.highest, e);
    }
    const exact::Structure &s;
    Bounded range;
};
Bounded energy_under_contact() {
    const exact::Structure s = chain(5, 0, 20, 0, 0, 0, {1, 4});
    plm::NewmarkOptions o;
    o.steps_per_period = 2000;
    o.max_periods = 20;
    plm::Newmark newmark(make_model(s), 0.3, o);
    plm::FullState x = newmark.rest();
    x.v.in_core()(4, 0) = 1; // energy 1 / 2
    EnergyWatch watch(s);
    newmark.run(x, &watch);
    return watch.range;
}
void energy_stays_bounded_under_contact(void **) {
    const Bounded b = energy_under_contact();
    assert_true(near(b.lowest, 0.5, 5e-3) && near(b.highest, 0.5, 5e-3));
}

struct Settled {
    bool settled = false;
    std::int64_t periods = 0;
    double defect = 1e300;
};
Settled settle() {
    const exact::Structure s = structure(5, 0.2);
    ModelExtras extras;
    extras.beta = 0.2;
    plm::NewmarkOptions o;
    o.steps_per_period = 2000;
    o.max_periods = 400;
    o.settled = 1e-7;
    plm::Newmark newmark(make_model(s, extras), 0.4, o);
    const plm::NewmarkResult r = newmark.run();
    const auto model = flow_model(s);
    plm::ExactFlow flow(model, 0.4, 1);
    std::vector<double> x = numbers(r.state.q);
    const std::vector<double> v = numbers(r.state.v);
    x.insert(x.end(), v.begin(), v.end());
    return {r.settled, r.periods, plm::periodicity_defect(flow, to_state(*model, s, x))};
}
void it_stops_when_settled(void **) {
    const Settled s = settle();
    assert_true(s.settled);
    assert_true(s.periods > 2 && s.periods < 400);
    assert_true(below(s.defect, 1e-4)); // of the step size: periodic for Newmark, not quite for the flow
}

// Many pairs, some equal, pressed together: the step's contact problem against its definition.
struct StepCheck {
    double law = 0, compatibility = 0;
};
StepCheck contact_problem(double k_n) {
    const int z = 60, n = 25; // more pairs than flexible directions: W is singular
    Matrix root(n, z);
    for (int j = 0; j < z; ++j)
        for (int i = 0; i < n; ++i) root(i, j) = std::sin(1.3 * i * (j / 2) + i + 0.2 * (j / 2)); // in pairs
    const Matrix w = plm::product('T', 'N', root, root);
    const plm::vector<double> k(z, k_n);
    plm::ContactStep step(w, k);
    plm::vector<double> force(z, 0.0), u_free(z);
    StepCheck c;
    for (int trial = 0; trial < 20; ++trial) {
        for (int i = 0; i < z; ++i) u_free[i] = std::cos(2.1 * (i / 2) + 0.7 * trial);
        step.solve(u_free, force);
        plm::vector<double> u = u_free;
        plm::gemv('N', -1.0, w, force.data(), 1.0, u.data());
        for (int i = 0; i < z; ++i) {
            c.compatibility = std::max(c.compatibility, std::abs(u[i] - step.penetration()[i]));
            c.law = std::max(c.law, std::abs(force[i] / k_n - std::max(u[i], 0.0)));
        }
    }
    return c;
}
void the_contact_forces_of_a_step_obey_the_law(void **) {
    for (double k_n : {1e-3, 1.0, 1e3, 1e6}) {
        const StepCheck c = contact_problem(k_n);
        assert_true(below(c.law, 1e-12));
        assert_true(below(c.compatibility, 1e-12));
    }
}

// DOFs without mass follow statically.
double massless_error() {
    exact::Structure s = structure(5, beta_of_chain);
    s.mass[2] = 0;
    exact::Structure light = s;
    light.mass[2] = 1e-7;
    double difference = 0;
    plm::NewmarkOptions o;
    o.max_periods = 1;
    o.alpha = 0.1;
    plm::Field ends[2];
    for (const exact::Structure *which : {&s, &light}) {
        ModelExtras extras;
        extras.beta = beta_of_chain;
        plm::Newmark newmark(make_model(*which, extras), 0.4, o);
        ends[which == &light] = newmark.run().state.q;
    }
    for (int i = 0; i < s.n; ++i) difference = std::max(difference, std::abs(ends[0].at(i) - ends[1].at(i)));
    return difference;
}
void massless_dofs_follow(void **) {
    assert_true(below(massless_error(), 1e-5));
}

std::shared_ptr<const plm::Model> model_of(const scene &s) {
    plm::MatrixFormat f;
    f.n = s.n_dof;
    f.nnz = s.nnz;
    plm::ModelInput in;
    in.n_dof = s.n_dof;
    in.mass = std::make_shared<plm::MatrixInput>(f, s.col_ptr, s.row, s.m);
    in.stiffness = std::make_shared<plm::MatrixInput>(f, s.col_ptr, s.row, s.k);
    in.damping.alpha = s.mass_damping;
    in.damping.beta = s.stiffness_damping;
    in.fixed.assign(s.fixed, s.fixed + s.n_fixed);
    for (std::int64_t k = 0; k < 3 * s.n_pairs; ++k)
        for (int side = 0; side < 2; ++side) {
            const std::int64_t dof = side ? s.dof_b[k] : s.dof_a[k];
            if (dof < 0 || s.normal[k] == 0) continue;
            in.gap_row.push_back(k / 3);
            in.gap_dof.push_back(dof);
            in.gap_coefficient.push_back(side ? -s.normal[k] : s.normal[k]);
        }
    in.contact.stiffness.assign(s.contact_stiffness, s.contact_stiffness + s.n_pairs);
    for (double &k : in.contact.stiffness)
        if (k < 0) k = plm::auto_stiffness;
    in.contact.initial_gap.assign(s.gap, s.gap + s.n_pairs);
    if (s.preload) in.preload.assign(s.preload, s.preload + s.n_dof);
    in.excitation[1].real.assign(s.force, s.force + s.n_dof);
    in.excitation[1].imag.assign(s.n_dof, 0.0);
    return std::make_shared<plm::Model>(in, plm::SpaceOptions(), nullptr, plm::Watch());
}

// Cracked plate of bricks under pre-load, excited near its bending resonance: some periods from rest by both
// ways, watched at the tip.
struct Scene {
    double error = 1e300, largest = 0;
    std::int64_t unknowns = 0, coordinates = 0, events = 0;
    bool ran = false;
};
Scene plate(bool with_preload) {
    scene *s = nullptr;
    if (scene_create("cracked_plate", "quick", with_preload, &s) != SCENE_OK) return {};
    const auto model = model_of(*s);
    const std::int64_t dof = s->output_dof;
    scene_destroy(&s);
    plm::BasisOptions b;
    b.kind = &plm::basis_kinds::full;
    b.frequency_min_hz = 100;
    b.frequency_max_hz = 3000;
    b.n_harmonics = 5;
    const plm::Basis basis(model, nullptr, nullptr, b, plm::Watch());
    const double omega = std::sqrt(basis.reduced()->lambda[3]) * 0.97;
    plm::NewmarkOptions o;
    o.steps_per_period = 2000;
    o.max_periods = 3;
    plm::Newmark newmark(model, omega, o);
    DofRecorder watch(model, {dof});
    const plm::FullState start = newmark.rest();
    newmark.run(start, &watch);
    const auto flow_of = std::make_shared<plm::FlowModel>(basis.reduced());
    plm::ExactFlow flow(flow_of, omega, 1);
    FlowState x{plm::vector<double>(flow_of->size()), plm::vector<double>(flow_of->size()), 0};
    plm::vector<double> momentum(model->n_free());
    plm::multiply(model->matrices().mass, start.q.in_core().data(), momentum.data());
    plm::gemv('T', 1.0, basis.reduced()->static_vectors().formed().in_core(), momentum.data(), 0.0,
              x.y.data());
    const plm::vector<double> row = flow_of->dof_row(dof);
    Scene r{0, 0, model->n_free(), flow_of->size(), 0, true};
    for (std::size_t k = 0; k < watch.times().size(); k += 50) {
        flow.advance(x, watch.times()[k]);
        const double q = plm::dot(flow_of->size(), row.data(), x.y.data());
        r.error = std::max(r.error, std::abs(q - watch.values()[k]));
        r.largest = std::max(r.largest, std::abs(q));
    }
    r.events = flow.n_events();
    return r;
}
void a_brick_plate_agrees_with_its_reduced_flow(void **) {
    for (bool with_preload : {false, true}) {
        const Scene r = plate(with_preload);
        std::printf("    %d DOFs against %d coordinates, %d contact events, error %.1e of %.3g\n",
                    int(r.unknowns), int(r.coordinates), int(r.events), r.error, r.largest);
        assert_true(r.ran);
        assert_true(r.events > 0);
        assert_true(below(r.error, 2e-3 * r.largest));
    }
}

// Re(i F exp(i w t)) is Re(F exp(i w t)) a quarter of a period later; under contact, from the same state.
double phase_error() {
    const double omega = 0.4, quarter = 0.5 * M_PI / omega;
    plm::ModelInput input =
        test::input(test::diagonal(3, 1), {{2.0, -1.0, 0.0}, {-1.0, 2.0, -1.0}, {0.0, -1.0, 1.0}});
    test::add_pair(input, {0, 0, 1}, 5, 0.05);
    input.damping.beta = 0.02;
    const plm::vector<double> force({0.1, 0, 0.3}), none(3, 0.0);
    plm::ModelInput later = input;
    input.excitation[1].real = none, input.excitation[1].imag = force;
    later.excitation[1].real = force, later.excitation[1].imag = none;
    plm::NewmarkOptions o;
    o.steps_per_period = 400, o.max_periods = 3;
    plm::Newmark by_phase(test::build(input), omega, o), by_time(test::build(later), omega, o);
    plm::FullState begin = by_time.rest();
    begin.time = quarter;
    const plm::NewmarkResult one = by_phase.run(by_phase.rest()), other = by_time.run(begin);
    double worst = 0, largest = 0;
    for (int i = 0; i < 3; ++i) {
        worst = std::max(worst, std::abs(one.state.q.at(i) - other.state.q.at(i)));
        largest = std::max(largest, std::abs(other.state.q.at(i)));
    }
    return worst / largest;
}
void an_imaginary_load_is_a_quarter_of_a_period_ahead(void **) {
    assert_true(below(phase_error(), 1e-10)); // rounding of the phase, 1e3 steps
}

void wrong_input_is_refused(void **) {
    const exact::Structure s = structure(5, 0);
    const auto model = make_model(s);
    for (double omega : {0.0, std::numeric_limits<double>::quiet_NaN()})
        assert_int_equal(failure_of([&] { plm::Newmark(model, omega, {}); }).status, plm::status::argument);
    ModelExtras extras;
    extras.modal_ratio = {0.01};
    const auto modal = make_model(s, extras);
    const Failure f = failure_of([&] { plm::Newmark(modal, 1, {}); });
    assert_int_equal(f.status, plm::status::argument);
    assert_string_equal(f.argument.c_str(), "modal_ratio");
    const Failure size = failure_of([&] {
        plm::Newmark(model, 1, {}).run(plm::FullState{plm::Field(1, 1), plm::Field(1, 1), 0});
    });
    assert_int_equal(size.status, plm::status::argument);
}

struct Stopper : plm::Monitor {
    void log(int, const std::string &) override {}
    bool progress(const char *, double) override { return ++calls > 40; }
    int calls = 0;
};
void the_host_can_stop_it(void **) {
    Stopper stopper;
    const auto model = make_model(structure(5, 0));
    DofRecorder recorder(model, {4});
    const plm::NewmarkResult r = plm::Newmark(model, 0.4, {}, plm::Watch(&stopper)).run(&recorder);
    assert_true(r.cancelled && !r.settled && r.periods == 0);
    assert_true(r.state.time == recorder.times().back() && r.state.q.at(4) == recorder.values().back());
    assert_int_equal(stopper.calls, 41);
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(it_converges_with_second_order),
        cmocka_unit_test(hht_damps_what_it_cannot_resolve),
        cmocka_unit_test(energy_stays_bounded_under_contact),
        cmocka_unit_test(it_stops_when_settled),
        cmocka_unit_test(the_contact_forces_of_a_step_obey_the_law),
        cmocka_unit_test(massless_dofs_follow),
        cmocka_unit_test(a_brick_plate_agrees_with_its_reduced_flow),
        cmocka_unit_test(an_imaginary_load_is_a_quarter_of_a_period_ahead),
        cmocka_unit_test(wrong_input_is_refused),
        cmocka_unit_test(the_host_can_stop_it),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
