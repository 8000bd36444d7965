"""One example of each function, between two comments with its name in brackets: help() shows it, and a test runs them all. Two masses of
1 kg beside a stop (kg, N, m, s) unless said otherwise."""
# ruff: noqa: F841 - an example may show a result by its name alone
import os

import numpy
import plm
import scipy.sparse.linalg

MASS, STIFFNESS = numpy.eye(2), numpy.array([[2e4, -1e4], [-1e4, 1e4]])


def two_masses(stop=5e3):
    """Built, with damping, the stop, and a force of 1 N."""
    model = plm.Model(MASS, STIFFNESS)
    model.set_rayleigh_damping(0, 2e-4)
    model.add_gap_rows([[0, 1]], stiffness=stop)
    model.set_excitation([0, 1])
    return model.build()


def brick_dofs(first):
    """DOFs of the four corners of a square plate of 1 m, four nodes with x, y, z each."""
    return first + numpy.arange(12).reshape(4, 3), numpy.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], dtype=float)


def library(folder):
    # [version] [build_info] [status_text]
    major, minor, patch = plm.version()
    print(plm.build_info())
    print(plm.status_text(plm.WARNING))
    # [version] [build_info] [status_text]
    # [keys]
    options = [key.name for key in plm.keys(plm.KIND_HBM) if key.is_option]
    # [keys]
    # [default_context] [Context.set_effort] [Context.set_threads]
    context = plm.default_context()
    context.set_effort(30)  # seconds of one core that a search may cost
    context.set_threads(2)
    # [default_context] [Context.set_effort] [Context.set_threads]
    context.set_effort(10)
    # [Context]
    context = plm.Context(log=lambda level, text: print(level, text))
    model = plm.Model(MASS, STIFFNESS, context=context)
    # [Context]
    # [Context.set_solver]
    context.set_solver(lambda matrix, positive_definite: scipy.sparse.linalg.splu(matrix).solve)
    # [Context.set_solver]


def matrices(folder):
    # [Model] [Model.build]
    model = plm.Model([[1, 0], [0, 1]], [[20000, -10000], [-10000, 10000]])
    model.build()
    # [Model] [Model.build]
    # [Model.set_mass] [Model.set_stiffness] [Model.set_damping]
    model = plm.Model(n_dof=2)
    model.set_mass(MASS)
    model.set_stiffness(numpy.tril(STIFFNESS), part="lower")
    model.set_damping(1e-4 * STIFFNESS)
    # [Model.set_mass] [Model.set_stiffness] [Model.set_damping]
    # [Model.set_rayleigh_damping]
    model.set_rayleigh_damping(0, 2e-4)  # C = 2e-4 K
    # [Model.set_rayleigh_damping]
    # [Model.set_modal_damping]
    model.set_modal_damping(0.005)  # half a per cent of critical, in every mode
    # [Model.set_modal_damping]
    # [Model.set_structural_damping]
    model.set_structural_damping(0.01)
    # [Model.set_structural_damping]
    # [Model.fix_dofs]
    model.fix_dofs([0])
    # [Model.fix_dofs]
    # [Model.estimate_memory]
    print(f"{model.estimate_memory() / 2**20:.0f} MiB at most")
    # [Model.estimate_memory]
    # [Handle.set] [Handle.get] [Handle.options] [Handle.set_options]
    model.set("solver", "auto")           # the same as model.solver = "auto"
    model.set_options({"max_blocks": 3})
    limit = model.get("memory_limit")     # the same as model.memory_limit
    everything = model.options()          # {name: value}
    # [Handle.set] [Handle.get] [Handle.options] [Handle.set_options]


def constraints(folder):
    model = plm.Model(n_dof=30)
    model.set_mass(numpy.eye(30))
    model.set_stiffness(1e4 * numpy.eye(30))
    plate, xyz = brick_dofs(0)
    # [Model.add_constraints]
    row = numpy.zeros(30)
    row[[0, 3]] = 1, -1
    model.add_constraints([row])  # q[0] - q[3] = 0
    # [Model.add_constraints]
    # [Model.add_rigid_link]
    model.add_rigid_link([24, 25, 26, 27, 28, 29], [0.5, 0.5, 0], plate[2:], xyz[2:])
    # [Model.add_rigid_link]
    # [Model.set_coordinates]
    model.set_coordinates(plate, xyz)
    # [Model.set_coordinates]
    other, _ = brick_dofs(12)
    # [Model.add_tie]
    distance = model.add_tie(other[:1], [[0.5, 0.5, 0.0]], plate, xyz, [[0, 1, 2, 3]], tolerance=1e-3)
    # [Model.add_tie]
    # [Model.set_elimination_order]
    model.set_elimination_order(numpy.arange(30)[::-1])
    # [Model.set_elimination_order]
    model = plm.Model(n_dof=30)
    # [Model.add_distributing_coupling]
    model.add_distributing_coupling([24, 25, 26, 27, 28, 29], [0.5, 0.5, 0], plate, xyz)
    # [Model.add_distributing_coupling]
    # [Model.set_multipliers]
    model = plm.Model(n_dof=3)  # DOF 2 is a multiplier: its row of K says q[0] = q[1]
    model.set_mass(scipy.sparse.diags([1.0, 1.0, 0.0]))
    model.set_stiffness(scipy.sparse.csc_matrix([[1e4, 0, 1], [0, 1e4, -1], [1, -1, 0]]))
    model.set_multipliers([2])
    # [Model.set_multipliers]
    model.build()


def contact(folder):
    model = plm.Model(n_dof=24)
    lower, xyz = brick_dofs(0)
    upper, _ = brick_dofs(12)
    # [Model.add_node_pairs]
    model.add_node_pairs(lower[:2], upper[:2], normal=[0, 0, 1], gap=1e-5)  # z up, out of the lower body
    # [Model.add_node_pairs]
    # [Model.add_ground_contacts]
    model.add_ground_contacts(lower, normal=[0, 0, -1], stiffness=1e6)
    # [Model.add_ground_contacts]
    # [Model.add_gap_rows]
    row = numpy.zeros(24)
    row[23] = 1
    model.add_gap_rows([row], stiffness=5e3, gap=1e-4)  # closes where q[23] > 1e-4
    # [Model.add_gap_rows]
    # [Model.add_surface] [Model.add_surface_contact]
    below = model.add_surface(lower, xyz, [[0, 1, 2, 3]])  # its normal points up, out of the body
    above = model.add_surface(upper, xyz, [[0, 3, 2, 1]])
    model.add_surface_contact(above, below, search=0.1, stiffness=1e9)  # per area
    # [Model.add_surface] [Model.add_surface_contact]
    # [Model.set_gap_motion]
    motion = numpy.zeros(model.n_pairs)
    motion[-1] = 1e-5
    model.set_gap_motion(motion)  # a wall that moves with 1e-5 cos(omega t)
    # [Model.set_gap_motion]


def loads(folder):
    model = plm.Model(MASS, STIFFNESS)
    model.add_gap_rows([[0, 1]], stiffness=5e3)
    # [Model.set_preload]
    model.set_preload([0, -5.0])
    # [Model.set_preload]
    # [Model.set_excitation]
    model.set_excitation([0, 1.0])                     # 1 N cos(omega t) on DOF 1
    model.set_excitation([0, 0.1j], harmonic=2)
    model.set_excitation([0, 1e-4], power=2)           # an unbalance of 1e-4 kg m
    # [Model.set_excitation]
    model.set_preload(None)
    # [Model.set_rest_force]
    model.set_rest_force([2.0])  # the pair presses with 2 N at rest
    # [Model.set_rest_force]
    # [Model.solve_rest]
    model.build().solve_rest()
    print(model.rest_displacement, model.rest_force)
    # [Model.solve_rest]
    # [Model.set_base_motion]
    shaken = plm.Model(MASS, STIFFNESS)
    shaken.fix_dofs([0])
    shaken.set_base_motion([9.81, 0], quantity="acceleration")
    # [Model.set_base_motion]


def superelement(folder):
    transformation = numpy.array([[1.0, 0.0], [0.5, 0.5], [0.0, 1.0]])  # three DOFs of the structure by two
    model = plm.Model(MASS, STIFFNESS)
    # [Model.set_recovery] [Model.recover]
    model.set_recovery(lambda q: transformation @ q, n_full=3)
    model.add_gap_rows([[0, 1]], stiffness=5e3)
    model.set_excitation([0, 1])
    model.set_rayleigh_damping(0, 2e-4)
    model.build()
    full = model.recover([1e-3, 2e-3])
    # [Model.set_recovery] [Model.recover]
    curve = model.compute_response(dof=1).curve
    # [Model.recover_amplitude]
    amplitude = model.recover_amplitude(curve, full_dof=1)
    # [Model.recover_amplitude]


def built(folder):
    model = two_masses()
    # [Model.modes]
    hz, shapes = model.modes(2, shapes=True)
    closed = model.modes(1, "sliding")
    # [Model.modes]
    # [Model.count_modes]
    n = model.count_modes(20.0)
    # [Model.count_modes]
    # [Model.audit]
    for finding in model.audit():
        print(finding.severity, finding.text)
    # [Model.audit]
    # [Model.add_outputs]
    stretch, = model.add_outputs([[-1, 1]])  # how much the second spring is stretched
    response = model.compute_response(dof=stretch)
    # [Model.add_outputs]
    # [Model.compute_response]
    response = model.compute_response(dof=1, accuracy=1e-4)
    print(f"{1e3 * response.amplitude:.4f} mm at {response.frequency_hz:.3f} Hz, wrong by {response.error:.1e}")
    # [Model.compute_response]


def reduction(folder):
    model = two_masses()
    # [Sampler] [Sampler.run] [Sampler.add_dominant_mode]
    sampler = plm.Sampler(model, mode=1)
    sampler.add_dominant_mode("open", 2)
    sampler.run()
    # [Sampler] [Sampler.run] [Sampler.add_dominant_mode]
    # [Basis] [Basis.build]
    basis = plm.Basis(model, sampler).build()
    # [Basis] [Basis.build]
    # [Basis.set_sampler]
    other = plm.Basis(model)
    other.set_sampler(sampler)
    # [Basis.set_sampler]
    # [Basis.vectors] [Basis.residual]
    columns = basis.vectors()  # n_dof x size
    error = basis.residual(columns[:, 0])
    # [Basis.vectors] [Basis.residual]
    curve = plm.Hbm(basis, n_harmonics=5).sweep()
    # [Basis.set_parent] [Basis.set_responses]
    small = plm.Basis(model, kind="pod")
    small.set_parent(basis)
    small.set_responses([curve])
    small.build()
    # [Basis.set_parent] [Basis.set_responses]
    # [Basis.to_bytes] [Basis.from_bytes] [Basis.attach]
    data = basis.to_bytes()  # to be kept in a file
    again = plm.Basis.from_bytes(data)
    again.attach(model)
    # [Basis.to_bytes] [Basis.from_bytes] [Basis.attach]
    # [Branch.to_bytes] [Branch.from_bytes]
    curve = plm.Branch.from_bytes(basis, curve.to_bytes())
    # [Branch.to_bytes] [Branch.from_bytes]
    # [Basis.write_to] [Branch.write_to] [Branch.write_csv_to]
    with open(os.path.join(folder, "basis.plm"), "wb") as file:
        basis.write_to(file.write)
    pieces = []  # or to a socket, a database, an archive
    curve.write_to(pieces.append)
    curve.write_csv_to(pieces.append, dof=1)
    # [Basis.write_to] [Branch.write_to] [Branch.write_csv_to]


def response(folder):
    basis = plm.Basis(two_masses(), kind="full", frequency_min_hz=9, frequency_max_hz=14).build()
    # [Hbm] [Hbm.sweep]
    hbm = plm.Hbm(basis, n_harmonics=7)
    curve = hbm.sweep()
    print(curve.end_text, curve.n_points)
    # [Hbm] [Hbm.sweep]
    # [Hbm.save_every] [Hbm.resume]
    hbm.save_every(10, os.path.join(folder, "curve.plm"))
    hbm.set("max_points", 5)
    begun = hbm.sweep()
    hbm.set("max_points", 1000)
    whole = hbm.resume(begun)
    # [Hbm.save_every] [Hbm.resume]
    hbm.save_every(0)
    # [Branch.describe]
    print(curve.describe())
    # [Branch.describe]
    # [Hbm.find_peak]
    peak = hbm.find_peak(curve, dof=1)
    print(peak.amplitude, peak.frequency_hz)
    # [Hbm.find_peak]
    # [Hbm.solve]
    point = hbm.solve(11.0)
    near = hbm.solve(11.1, start=point, point=-1)
    # [Hbm.solve]
    # [Hbm.sweep_levels]
    half, whole = hbm.sweep_levels([0.5, 1.0])
    # [Hbm.sweep_levels]
    # [Hbm.estimate_error]
    estimate = hbm.estimate_error(peak.branch, 0, dof=1)
    print(estimate.amplitude.total, estimate.frequency_hz.total)
    # [Hbm.estimate_error]
    # [Hbm.refine_basis]
    refined = hbm.refine_basis(dof=1, tolerance=1e-3)
    print(refined.basis.size, refined.error)
    # [Hbm.refine_basis]


def beside(folder):
    """A pre-loaded oscillator that carries a light one: isolated branches and backbones."""
    model = plm.Model(numpy.diag([1, 0.2]), [[3.048, -2.048], [-2.048, 2.048]])
    model.set_rayleigh_damping(0, 0.004)
    model.add_gap_rows([[-1.0, 0]], stiffness=4.0)
    model.set_preload([-1.0, 0])
    model.set_excitation([1.0, 0])
    basis = plm.Basis(model.build(), kind="full", frequency_min_hz=0.2, frequency_max_hz=0.5).build()
    hbm = plm.Hbm(basis, n_harmonics=5, force_scale=0.05, stability="off")
    curve = hbm.sweep()
    # [Hbm.find_isolated]
    for found in hbm.find_isolated(curve):
        print(found.branch, found.force_range)
    # [Hbm.find_isolated]
    # [Hbm.find_backbones]
    for backbone in hbm.find_backbones():
        print(backbone.frequency_hz, backbone.point_force_scale)
    # [Hbm.find_backbones]
    # [Hbm.find_by_marching]
    others = hbm.find_by_marching([curve], n_frequencies=4, n_states=2)
    # [Hbm.find_by_marching]
    # [Hbm.nonlinear_mode]
    mode = hbm.nonlinear_mode(1, dof=0)
    print(mode.frequency_hz, mode.damping_ratio)
    # [Hbm.nonlinear_mode]


def special_points(folder):
    """An oscillator of 1 kg and 1 N/m between two stops: it loses its symmetry at a branch point. A soft stop with a gap makes folds."""
    model = plm.Model(numpy.eye(1), numpy.eye(1), 0.1 * numpy.eye(1))
    model.add_gap_rows([[1.0], [-1.0]], 10.0, 0.2)
    model.set_excitation([1.0])
    basis = plm.Basis(model.build(), kind="full", frequency_min_hz=0.19, frequency_max_hz=0.32).build()
    hbm = plm.Hbm(basis)
    curve = hbm.sweep()
    # [Hbm.switch_branch]
    for found in curve.bifurcations:
        if found.kind == "branch point":
            other = hbm.switch_branch(curve, found.point)
    # [Hbm.switch_branch]
    model = plm.Model(numpy.eye(1), numpy.eye(1), 0.02 * numpy.eye(1))
    model.add_gap_rows([[1.0]], 2.0, 1.0)
    model.set_excitation([0.1])
    basis = plm.Basis(model.build(), kind="full", frequency_min_hz=0.12, frequency_max_hz=0.3).build()
    hbm = plm.Hbm(basis, n_harmonics=5, stability="off")
    curve = hbm.sweep()
    # [Hbm.track_fold]
    for found in curve.bifurcations:
        if found.kind == "fold":
            folds = hbm.track_fold(curve, found.point, force_min=0.8, force_max=1.2)
    # [Hbm.track_fold]
    assert other.n_points > 1 and folds.n_points > 1


def points(folder):
    response = two_masses().compute_response(dof=1)
    curve, top = response.curve, int(numpy.argmax(response.curve.amplitude(1)))
    # [Branch.amplitude]
    amplitude = curve.amplitude(dof=1)                  # at every point of curve.frequency_hz
    first = curve.amplitude(1, "harmonic", harmonic=1)
    # [Branch.amplitude]
    # [Branch.coefficients] [Branch.harmonics]
    a0, a1, b1 = curve.coefficients(top, dof=1)[:3]
    magnitudes = curve.harmonics(top, dof=1)
    # [Branch.coefficients] [Branch.harmonics]
    # [Branch.history] [Branch.field]
    q = curve.history(top, dof=1, n_times=256)
    everywhere = curve.field(top, time_fraction=0.25)
    # [Branch.history] [Branch.field]
    # [Branch.contact] [Branch.closed_share]
    cycle = curve.contact(top, n_times=256)             # .time, .penetration, .force, .closed
    share = curve.closed_share(top)
    # [Branch.contact] [Branch.closed_share]
    # [Branch.energy]
    mean = curve.energy(top)
    print(mean.energy, mean.contact_area)
    # [Branch.energy]
    # [Branch.multipliers]
    print(abs(curve.multipliers(top)))                  # below 1: stable
    # [Branch.multipliers]
    # [Branch.periodicity_defect] [Branch.full_residual]
    print(curve.periodicity_defect(top), curve.full_residual(top))
    # [Branch.periodicity_defect] [Branch.full_residual]
    # [Branch.write_csv]
    curve.write_csv(os.path.join(folder, "curve.csv"), dof=1)
    # [Branch.write_csv]


def in_time(folder):
    model = two_masses()
    basis = plm.Basis(model, kind="full", frequency_min_hz=9, frequency_max_hz=14).build()
    curve = plm.Hbm(basis, n_harmonics=5).sweep()
    # [Transient] [Transient.observe] [Transient.run] [Transient.history]
    motion = plm.Transient(basis, frequency_hz=11.0, periods=50)
    motion.observe([1])
    motion.run()
    q = motion.history(1)                               # at the instants motion.time
    # [Transient] [Transient.observe] [Transient.run] [Transient.history]
    # [Transient.set_state] [Transient.state]
    motion.set_state(q=[0, 1e-3])
    now = motion.state()                                # .q, .v
    # [Transient.set_state] [Transient.state]
    # [Transient.start_at] [Transient.find_periodic] [Transient.multipliers]
    motion.start_at(curve, 10)
    if motion.find_periodic():
        print(abs(motion.multipliers()))
    # [Transient.start_at] [Transient.find_periodic] [Transient.multipliers]


def study(folder):
    model = two_masses()
    sampler = plm.Sampler(model, mode=1)
    hbm = plm.Hbm(plm.Basis(model, sampler), n_harmonics=3, stability="off")
    # [Study] [Study.set_output] [Study.add_response] [Study.add_compressed] [Study.add_refined]
    study = plm.Study(model, repeats=1)
    study.set_output(dof=1)
    study.add_response("modes", hbm)                    # nothing need be built or run
    study.add_compressed("compressed", hbm, size=2)
    study.add_refined("for 1e-2", hbm, tolerance=1e-2)
    # [Study] [Study.set_output] [Study.add_response] [Study.add_compressed] [Study.add_refined]
    # [Study.add_marching]
    study.add_marching("marching", plm.Transient(plm.Basis(model, sampler), settled=1e-2, periods=200), n_frequencies=3)
    # [Study.add_marching]
    # [Study.set_force_levels] [Study.set_reference]
    study.set_force_levels([1.0, 0.5])
    study.set_reference(plm.Hbm(plm.Basis(model, sampler, kind="full"), n_harmonics=5, stability="off"))
    # [Study.set_force_levels] [Study.set_reference]
    # [Study.run] [Study.outcome] [Study.curve] [Study.points]
    study.run()
    for name in study.names:
        print(name, study.outcome(name))
    curve = study.curve("modes", level=1)
    hz, amplitude = study.points("marching")
    # [Study.run] [Study.outcome] [Study.curve] [Study.points]
    # [Study.write]
    study.write(os.path.join(folder, "report"))
    # [Study.write]


ALL = (library, matrices, constraints, contact, loads, superelement, built, reduction, response, beside, special_points, points, in_time, study)
