"""The scene of scenario.c in Python."""
import os
import sys
import warnings

import numpy
import plm
import scipy.sparse

N, H, WATCHED, RELATIVE = 10, 5, 7, 10


def show(name, values):
    print(name)
    for x in numpy.ravel(values, order="F"):
        print("%d" % x if isinstance(x, numpy.integer) else "%.17g" % x)


def make_model():
    stiffness = scipy.sparse.diags([[20000.0] * (N - 1) + [10000.0], [-10000.0] * (N - 1)], [0, -1], format="coo")
    model = plm.Model(scipy.sparse.identity(N, format="coo"), stiffness, part="lower")
    model.set_rayleigh_damping(0.5, 0.0002)
    model.fix_dofs([0])
    middle = numpy.zeros((1, N))
    middle[0, [6, 5, 7]] = 1, -0.5, -0.5
    model.add_constraints(middle)
    rows = numpy.zeros((2, N))
    rows[0, [2, 5]] = 1, -1
    rows[1, 8] = 1
    model.add_gap_rows(rows, [plm.AUTO_STIFFNESS, 20000], [0, 0.001])
    force, preload, grows = numpy.zeros(N), numpy.zeros(N), numpy.zeros(N, complex)
    force[4], preload[8] = 10, 5
    grows[[7, 8]] = 2e-4j, 4e-4
    model.set_preload(preload)
    model.set_excitation(force)
    model.set_excitation(grows, power=2)
    model.set_gap_motion([0, 2e-5 + 1e-5j], harmonic=2)
    model.set_base_motion((1e-4 + 5e-5j) * (numpy.arange(N) == 0))
    model.build()
    assert model.add_outputs(rows[:1]) == range(RELATIVE, RELATIVE + 1)
    return model


def show_coupled():
    numbers = [i for i in range(24) if i != 21]
    stiffness = scipy.sparse.lil_matrix((24, 24))
    for i in numbers:
        stiffness[i, i] = 1000 * (1 + i)
    stiffness[22, 21], stiffness[23, 21] = -1, 1
    mass = scipy.sparse.coo_matrix((numpy.ones(23), (numbers, numbers)), (24, 24))
    model = plm.Model(mass, stiffness.tocoo(), part="lower")
    face, corners = numpy.arange(6, 15).reshape(3, 3), numpy.eye(3)
    model.add_distributing_coupling(range(6), [0, 0, 0], face, corners, [1, 2, 3])
    model.add_rigid_link(range(6), [0, 0, 0], [15, 16, 17], [1, 1, 0])
    distance = model.add_tie([18, 19, 20], [0.4, 0.4, 0.5], face, corners, [[0, 1, 2]], 1)
    model.set_multipliers([21])
    slave = model.add_surface(face, corners, [[0, 1, 2]])
    master = model.add_surface(None, [[1.5, 0.5, 0.5], [0.5, 0.5, 1.5], [0.5, 1.5, 0.5]], [[0, 1, 2]])
    model.add_surface_contact(slave, master, search=2, stiffness=50, closed=0.1, smooth=True)
    model.set_rest_force([3, numpy.nan, 0])
    model.set_coordinates(face, corners)
    model.build()
    show("coupled_n_free", numpy.int64(model.n_free))
    show("coupled_findings", numpy.int64(len(model.audit())))
    show("tie_distance", distance)
    show("coupled_hz", model.modes(4))
    model.solve_rest()
    show("surface_gap", model.surface_gap)
    show("surface_force", model.rest_force)
    show("surface_rest_gap", model.initial_gap)


def show_model(model):
    show("n_free", numpy.int64(model.n_free))
    show("contact_stiffness", model.contact_stiffness)
    show("rest_displacement", model.solve_rest().rest_displacement)
    show("open_hz", model.modes(3))
    show("sliding_hz", model.modes(3, "sliding"))


def make_basis(model):
    sampler = plm.Sampler(model, system="open", mode=1, n_samples=3).run()
    show("blf_hz", sampler.blf_hz)
    show("sweep_alpha", sampler.sweep_alpha)
    show("selected_samples", sampler.selected_samples)
    basis = plm.Basis(model, sampler, n_harmonics=H).build()
    show("singular_values", basis.singular_values)
    return basis


def show_point(branch, point):
    show("coefficients", branch.coefficients(point, WATCHED))
    show("relative", branch.coefficients(point, RELATIVE))
    show("relative_history", branch.history(point, RELATIVE, 8))
    show("field", branch.field(point, 0.25))
    contact = branch.contact(point, 8)
    show("penetration", contact.penetration)
    show("force", contact.force)
    show("closed", contact.closed)
    show("closed_share", branch.closed_share(point))
    show("full_residual", branch.full_residual(point))


def show_stability(branch, point):
    show("bifurcation", branch.bifurcation)
    show("stable", branch.stable)
    multipliers = branch.multipliers(point)
    show("multipliers_real", multipliers.real)
    show("multipliers_imag", multipliers.imag)
    show("periodicity_defect", branch.periodicity_defect(point))
    show("energy", branch.energy(point))


def show_motion(basis, branch, point):
    motion = plm.Transient(basis, periods=2, steps_per_period=16)
    motion.observe([2, WATCHED])
    motion.start_at(branch, point)
    show("time", motion.run().time)
    show("history", motion.history(WATCHED))
    q, v = motion.state()
    show("state_q", q)
    show("state_v", v)
    motion.set_state(q)
    show("let_go", motion.run().history(2))
    motion.start_at(branch, point)
    motion.find_periodic()
    multipliers = motion.multipliers()
    show("periodic_multipliers_real", multipliers.real)
    show("periodic_multipliers_imag", multipliers.imag)


def show_study(basis, hbm):
    study = plm.Study(basis.model, repeats=1, curve_tolerance=1e-4)
    study.set_output(WATCHED)
    study.set_force_levels([0.5, 1])
    hbm.set_options({"max_step": 0.25, "stability": "off", "n_harmonics": 3})
    study.add_response("three harmonics", hbm)
    hbm.n_harmonics = H
    study.add_compressed("compressed", hbm, 3)
    study.add_refined("refined", hbm, 1e-2)
    index = study.add_marching("marching", plm.Transient(basis, settled=1e-4, periods=2000), 3)
    study.set_reference(hbm)
    study.run()
    for key in ("frequency_error", "amplitude_error", "curve_error_l2", "curve_error_max", "basis_size"):
        show(key, study[key])
    show("reference_size", numpy.int64(study.reference_size))
    print(study.names[index])
    print(study.outcome("reference"))
    show("study_curve", numpy.int64(len(study.curve("compressed", 1))))
    points = study.points("three harmonics", 1)
    show("study_hz", points.frequency_hz)
    show("study_amplitude", points.amplitude)


def show_resumed(hbm):
    hbm.max_points = 12
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        part = hbm.sweep()
    hbm.max_points = 1000
    hbm.save_every(5, "parity_py.plm")
    show("resumed_amplitude", hbm.resume(part).amplitude(WATCHED))
    hbm.save_every(0)
    os.remove("parity_py.plm")


def show_response(basis):
    hbm = plm.Hbm(basis, n_harmonics=H, unknowns="modal", max_step=0.05)
    curve = hbm.sweep()
    show("n_points", numpy.int64(len(curve)))
    show("frequency_hz", curve.frequency_hz)
    show("amplitude", curve.amplitude(WATCHED))
    show("level_points", numpy.int64(len(hbm.sweep_levels([0.8, 0.5])[-1])))
    show_resumed(hbm)
    peak = hbm.find_peak(curve, WATCHED)
    show("peak", [peak.frequency_hz, peak.amplitude])
    for name, write, count in (("basis", basis.write_to, 1), ("curve", curve.write_to, 1),
                               ("table", lambda f: curve.write_csv_to(f, WATCHED), 2)):
        pieces = []
        write(pieces.append)
        show(f"written_{name}", [float(len(b"".join(pieces))), float(sum(b"".join(pieces)))][:count])
    again = plm.Basis.from_bytes(basis.to_bytes(), basis.context).attach(basis.model)
    read = plm.Branch.from_bytes(again, curve.to_bytes())
    show("read_amplitude", read.amplitude(WATCHED))
    show("read_residual", read.full_residual(3))
    whole = basis.model.compute_response(WATCHED, accuracy=1e-4)
    show("response", [whole.frequency_hz, whole.amplitude, whole.error])
    show("accuracy", [whole.hbm.accuracy])
    show("basis_size", numpy.int64(whole.curve.basis_size))
    error = hbm.estimate_error(peak.branch, 0, WATCHED)
    show("error", [*error.amplitude, *error.frequency_hz])
    small = plm.Basis(basis.model, parent=basis, responses=curve, kind="pod", pod_tolerance=1e-3).build()
    show("pod_lambda", small.lambda_)
    refined = hbm.refine_basis(WATCHED, 1e-2)
    show("refined_error", [refined.error])
    show("refined_lambda", refined.basis.lambda_)
    show_point(peak.branch, 0)
    show_stability(curve, 5)
    show_motion(basis, curve, 5)
    show_study(basis, hbm)


def main():
    model = make_model()
    show_model(model)
    show_coupled()
    show_response(make_basis(model))


if __name__ == "__main__":
    sys.exit(main())
