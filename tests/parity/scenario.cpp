// The scene of scenario.c in C++.
#include <cstdio>
#include <cstdlib>
#include <plm/plm.hpp>

namespace {

constexpr int n_masses = 10, n_harmonics = 5, watched = 7, relative = 10;

void print(double x) {
    std::printf("%.17g\n", x);
}
void print(std::int64_t i) {
    std::printf("%lld\n", static_cast<long long>(i));
}
void print(std::int32_t i) {
    std::printf("%d\n", i);
}
template <class T> void print(const char *name, const std::vector<T> &values) {
    std::puts(name);
    for (T x : values) print(x);
}

plm::Model make_model(const plm::Context &context) {
    std::vector<std::int32_t> diagonal, row, column;
    std::vector<double> stiffness, force(n_masses), preload(n_masses), grows(n_masses), grows_later(n_masses),
        base(n_masses), base_later(n_masses);
    for (int i = 0; i < n_masses; ++i) {
        diagonal.push_back(i);
        row.push_back(i), column.push_back(i), stiffness.push_back(i < n_masses - 1 ? 20000 : 10000);
        if (i > 0) row.push_back(i), column.push_back(i - 1), stiffness.push_back(-10000);
    }
    force[4] = 10;
    preload[8] = 5;
    grows[8] = 4e-4;
    grows_later[7] = 2e-4;
    base[0] = 1e-4;
    base_later[0] = 5e-5;
    plm::Model model(context, n_masses);
    model.set_mass(plm::triplets(diagonal, diagonal, std::vector<double>(n_masses, 1.0)).lower());
    model.set_stiffness(plm::triplets(row, column, stiffness).lower());
    model.set_rayleigh_damping(0.5, 0.0002);
    model.fix_dofs(std::vector<std::int32_t>{0});
    model.add_constraints({0, 3}, {6, 5, 7}, {1, -0.5, -0.5});
    model.add_gap_rows({0, 2, 3}, {2, 5, 8}, {1, -1, 1}, {PLM_AUTO_STIFFNESS, 20000}, {0, 0.001});
    model.set_preload(preload);
    model.set_excitation(1, force);
    model.set_growing_excitation(1, 2, grows, grows_later);
    model.set_gap_motion(2, {0.0, 2e-5}, {0.0, 1e-5});
    model.set_base_motion(PLM_DISPLACEMENT, 1, base, base_later);
    model.build();
    if (model.add_outputs({0, 2}, {2, 5}, {1, -1}) != relative) std::exit(1);
    return model;
}

void print_coupled(const plm::Context &context) {
    std::vector<std::int32_t> row, column;
    std::vector<double> stiffness;
    for (int i = 0; i < 24; ++i)
        if (i != 21) row.push_back(i), column.push_back(i), stiffness.push_back(1000 * (1 + i));
    plm::Model model(context, 24);
    model.set_mass(plm::triplets(row, column, std::vector<double>(23, 1.0)).lower());
    for (int i : {22, 23}) row.push_back(i), column.push_back(21), stiffness.push_back(2 * i - 45);
    model.set_stiffness(plm::triplets(row, column, stiffness).lower());
    const std::vector<double> origin(3), corners{1, 0, 0, 0, 1, 0, 0, 0, 1};
    const std::vector<std::int32_t> hub{0, 1, 2, 3, 4, 5}, face{6, 7, 8, 9, 10, 11, 12, 13, 14};
    model.add_distributing_coupling(hub, origin, face, corners, {1, 2, 3});
    model.add_rigid_link(hub, origin, {15, 16, 17}, {1, 1, 0});
    const std::vector<double> distance =
        model.add_tie({18, 19, 20}, {0.4, 0.4, 0.5}, face, corners, {0, 3}, {0, 1, 2}, 1);
    model.set_multipliers({21});
    const std::vector<double> wall{1.5, 0.5, 0.5, 0.5, 0.5, 1.5, 0.5, 1.5, 0.5};
    const auto slave = model.add_surface(face, corners, {0, 3}, {0, 1, 2});
    const auto master = model.add_surface(std::vector<std::int32_t>(9, -1), wall, {0, 3}, {0, 1, 2});
    model.add_surface_contact(slave, master, PLM_SURFACE_SMOOTH, 50, 2, 0.1);
    model.set_rest_force({3, PLM_KEEP_GAP, 0});
    model.set_coordinates(face, corners);
    model.build();
    print("coupled_n_free", std::vector{model.get_int("n_free")});
    print("coupled_findings", std::vector{static_cast<std::int64_t>(model.audit().size())});
    print("tie_distance", distance);
    print("coupled_hz", model.modes(PLM_SYSTEM_OPEN, 4).frequency_hz);
    model.solve_rest();
    print("surface_gap", model.get_array("surface_gap"));
    print("surface_force", model.get_array("rest_force"));
    print("surface_rest_gap", model.get_array("initial_gap"));
}

void print_model(plm::Model &model) {
    print("n_free", std::vector{model.get_int("n_free")});
    print("contact_stiffness", model.get_array("contact_stiffness"));
    model.solve_rest();
    print("rest_displacement", model.get_array("rest_displacement"));
    print("open_hz", model.modes(PLM_SYSTEM_OPEN, 3).frequency_hz);
    print("sliding_hz", model.modes(PLM_SYSTEM_SLIDING, 3).frequency_hz);
}

plm::Basis make_basis(const plm::Model &model) {
    plm::Sampler sampler(model);
    sampler.set("system", "open").set("mode", 1).set("n_samples", 3).run();
    print("blf_hz", std::vector{sampler.get_double("blf_hz")});
    print("sweep_alpha", sampler.get_array("sweep_alpha"));
    print("selected_samples", sampler.get_int_array("selected_samples"));

    plm::Basis basis(model);
    basis.set_sampler(sampler);
    basis.set("n_harmonics", n_harmonics).build();
    print("singular_values", basis.get_array("singular_values"));
    return basis;
}

void print_point(const plm::Branch &branch, std::int64_t point) {
    print("coefficients", branch.coefficients(point, watched, 1).values);
    print("relative", branch.coefficients(point, relative, 1).values);
    print("relative_history", branch.history(point, relative, 8));
    print("field", branch.field(point, 0.25));
    const plm::Contact contact = branch.contact(point, 8);
    print("penetration", contact.penetration.values);
    print("force", contact.force.values);
    print("closed", contact.closed.values);
    print("closed_share", branch.closed_share(point));
    print("full_residual", std::vector{branch.full_residual(point)});
}

void print(const char *real, const char *imag, const std::vector<std::complex<double>> &values) {
    std::puts(real);
    for (const auto &z : values) print(z.real());
    std::puts(imag);
    for (const auto &z : values) print(z.imag());
}

void print_stability(const plm::Branch &branch, std::int64_t point) {
    print("bifurcation", branch.bifurcation());
    print("stable", branch.stable());
    print("multipliers_real", "multipliers_imag", branch.multipliers(point));
    print("periodicity_defect", std::vector{branch.periodicity_defect(point)});
    const plm::Energy e = branch.energy(point);
    print("energy", std::vector{e.energy, e.contact_area});
}

void print_motion(const plm::Model &model, const plm::Basis &basis, const plm::Branch &branch,
                  std::int64_t point) {
    plm::Transient motion(model, basis);
    motion.set("periods", 2).set("steps_per_period", 16);
    motion.observe({2, watched});
    motion.start_at(branch, point);
    motion.run();
    print("time", motion.get_array("time"));
    print("history", motion.history(1));
    const plm::MotionState now = motion.state();
    print("state_q", now.q);
    print("state_v", now.v);
    motion.set_state(now.q);
    motion.run();
    print("let_go", motion.history(0));
    motion.start_at(branch, point);
    motion.find_periodic();
    print("periodic_multipliers_real", "periodic_multipliers_imag", motion.multipliers());
}

void print_estimate(const plm::Model &model, const plm::Basis &basis, plm::Hbm &hbm, const plm::Branch &curve,
                    const plm::Branch &top) {
    const plm::ErrorEstimate e = hbm.estimate_error(top, 0, watched);
    print("error", std::vector{e.amplitude.basis, e.amplitude.contact, e.amplitude.harmonics,
                               e.frequency_hz.basis, e.frequency_hz.contact, e.frequency_hz.harmonics});
    plm::Basis small(model);
    small.set("kind", "pod").set("pod_tolerance", 1e-3);
    small.set_parent(basis);
    small.set_responses({curve});
    small.build();
    print("pod_lambda", small.get_array("lambda"));
    const plm::Refined refined = hbm.refine_basis(watched, 1e-2);
    print("refined_error", std::vector{refined.error});
    print("refined_lambda", refined.basis.get_array("lambda"));
}

void print_study(const plm::Model &model, const plm::Basis &basis, plm::Hbm &hbm) {
    plm::Transient motion(model, basis);
    motion.set("settled", 1e-4).set("periods", 2000);
    plm::Study study(model);
    study.set("repeats", 1).set("curve_tolerance", 1e-4);
    study.set_output(watched);
    study.set_force_levels({0.5, 1.0});
    study.add_response("three harmonics",
                       hbm.set("max_step", 0.25).set("stability", "off").set("n_harmonics", 3));
    study.add_compressed("compressed", hbm.set("n_harmonics", n_harmonics), 3);
    study.add_refined("refined", hbm, 1e-2);
    const std::int64_t index = study.add_marching("marching", motion, 3);
    study.set_reference(hbm);
    study.run();
    for (const char *key : {"frequency_error", "amplitude_error", "curve_error_l2", "curve_error_max"})
        print(key, study.get_array(key));
    print("basis_size", study.get_int_array("basis_size"));
    print("reference_size", std::vector{study.get_int("reference_size")});
    std::puts(study.name(index).c_str());
    std::puts(study.outcome(plm::Study::reference).c_str());
    print("study_curve", std::vector{study.curve(1, 1).size()});
    const plm::StudyPoints points = study.points(0, 1);
    print("study_hz", points.frequency_hz);
    print("study_amplitude", points.amplitude);
}

void print_written(const plm::Basis &basis, const plm::Branch &curve) {
    double n = 0, sum = 0;
    const auto count = [&](std::string_view piece) {
        n += static_cast<double>(piece.size());
        for (const char c : piece) sum += static_cast<unsigned char>(c);
    };
    basis.write_to(count);
    print("written_basis", std::vector{n}), n = 0;
    curve.write_to(count);
    print("written_curve", std::vector{n}), n = 0, sum = 0;
    curve.write_csv_to(count, watched);
    print("written_table", std::vector{n, sum});
}

void print_read(const plm::Context &context, const plm::Model &model, const plm::Basis &basis,
                const plm::Branch &curve) {
    print_written(basis, curve);
    plm::Basis again = plm::Basis::from_bytes(context, basis.to_bytes());
    again.attach(model);
    const plm::Branch read = again.read_branch(curve.to_bytes());
    print("read_amplitude", read.amplitude(watched));
    print("read_residual", std::vector{read.full_residual(3)});
}

void print_resumed(plm::Hbm &hbm) {
    hbm.set("max_points", 12);
    const plm::Branch part = hbm.sweep();
    hbm.set("max_points", 1000);
    hbm.save_every(5, "parity_cpp.plm");
    print("resumed_amplitude", hbm.resume(part).amplitude(watched));
    hbm.save_every(0);
    if (std::remove("parity_cpp.plm")) std::exit(1);
}

void print_response(const plm::Context &context, const plm::Model &model, const plm::Basis &basis) {
    plm::Hbm hbm(basis);
    hbm.set("n_harmonics", n_harmonics).set("unknowns", "modal").set("max_step", 0.05);
    const plm::Branch curve = hbm.sweep();
    print("n_points", std::vector{curve.size()});
    print("frequency_hz", curve.frequency_hz());
    print("amplitude", curve.amplitude(watched));
    print("level_points", std::vector{hbm.sweep_levels({0.8, 0.5}).back().size()});
    print_resumed(hbm);
    const plm::Peak peak = hbm.find_peak(curve, watched);
    print("peak", std::vector{peak.frequency_hz, peak.amplitude});
    print_read(context, model, basis, curve);
    const plm::Response whole = model.compute_response(watched, PLM_HALF_PEAK_TO_PEAK, 1e-4);
    print("response", std::vector{whole.frequency_hz, whole.amplitude, whole.error});
    print("accuracy", std::vector{whole.hbm.get_double("accuracy")});
    print("basis_size", std::vector{whole.curve.get_int("basis_size")});
    print_estimate(model, basis, hbm, curve, peak.branch);
    print_point(peak.branch, 0);
    print_stability(curve, 5);
    print_motion(model, basis, curve, 5);
    print_study(model, basis, hbm);
}

} // namespace

int main() {
    try {
        const plm::Context context;
        plm::Model model = make_model(context);
        print_model(model);
        print_coupled(plm::Context());
        print_response(context, model, make_basis(model));
    } catch (const plm::Error &e) {
        std::fprintf(stderr, "%s\n", e.what());
        return 1;
    }
}
