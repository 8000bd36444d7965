"""cracked_beam.py: a cantilever whose crack opens and closes, assembled with SciPy and handed over in process.

    PYTHONPATH=bindings/python PLM_LIBRARY=build/dev/src/libplm.so python3 examples/python/cracked_beam.py [figure.png]

Euler beam elements (m, kg, N, s): deflection w and rotation r per node. At the crack the rotations of the two faces are
joined by a weak spring (the ligament); where the faces meet, a contact pair carries the moment: it closes when the crack
is bent shut. Printed: the modes, the peak from the piecewise-linear modes, and the peak without reduction.
"""
import sys

import numpy
import plm
import scipy.sparse

LENGTH, WIDTH, HEIGHT = 1.0, 0.02, 0.01
YOUNG, DENSITY = 2.1e11, 7850.0
N_ELEMENTS, CRACK = 30, 10  # the crack stands after this element
FORCE = 0.01  # N at the tip


def element():
    """Mass and stiffness of one beam element; DOFs w, r at its two ends."""
    h = LENGTH / N_ELEMENTS
    stiffness = YOUNG * WIDTH * HEIGHT**3 / 12 / h**3 * numpy.array(
        [[12, 6 * h, -12, 6 * h], [6 * h, 4 * h * h, -6 * h, 2 * h * h],
         [-12, -6 * h, 12, -6 * h], [6 * h, 2 * h * h, -6 * h, 4 * h * h]])
    mass = DENSITY * WIDTH * HEIGHT * h / 420 * numpy.array(
        [[156, 22 * h, 54, -13 * h], [22 * h, 4 * h * h, 13 * h, -3 * h * h],
         [54, 13 * h, 156, -22 * h], [-13 * h, -3 * h * h, -22 * h, 4 * h * h]])
    return mass, stiffness


def assemble():
    """M and K, the number of DOFs, and the rotations of the two faces of the crack."""
    n_dof = 2 * (N_ELEMENTS + 1) + 1
    second_face = n_dof - 1  # the rotation behind the crack has a DOF of its own
    first_face = 2 * CRACK + 1
    dofs = numpy.arange(4) + 2 * numpy.arange(N_ELEMENTS)[:, None]
    dofs[CRACK, 1] = second_face
    rows, columns = numpy.repeat(dofs, 4, axis=1).ravel(), numpy.tile(dofs, 4).ravel()
    mass, stiffness = (scipy.sparse.coo_matrix((numpy.tile(m.ravel(), N_ELEMENTS), (rows, columns)), (n_dof, n_dof)).tolil()
                       for m in element())
    ligament = 0.02 * YOUNG * WIDTH * HEIGHT**2
    for i, j, sign in ((0, 0, 1), (1, 1, 1), (0, 1, -1), (1, 0, -1)):
        faces = (first_face, second_face)
        stiffness[faces[i], faces[j]] += sign * ligament
    return mass.tocsc(), stiffness.tocsc(), first_face, second_face


def make_model():
    mass, stiffness, first_face, second_face = assemble()
    n_dof = mass.shape[0]
    model = plm.Model(mass, stiffness)  # used where they are, no copy
    model.fix_dofs([0, 1])  # the clamp
    model.set_rayleigh_damping(0, 2e-4)
    # one pair: u = h/2 (r_1 - r_2) > 0 closes the faces; the library chooses the stiffness
    half = HEIGHT / 2
    model.add_gap_rows(scipy.sparse.csr_matrix(([half, -half], ([0, 0], [first_face, second_face])), shape=(1, n_dof)))
    force = numpy.zeros(n_dof)
    tip = 2 * N_ELEMENTS
    force[tip] = FORCE
    model.set_excitation(force)
    return model.build(), tip


def peak_of(basis, dof, name):
    hbm = plm.Hbm(basis, n_harmonics=7)
    curve = hbm.sweep(progress=sys.stderr.isatty())
    peak = hbm.find_peak(curve, dof)
    print(f"{name:22s} {basis.size:3d} columns, {len(curve):3d} points: peak {1e3 * peak.amplitude:.4f} mm "
          f"at {peak.frequency_hz:.4f} Hz")
    return curve, peak


def draw(curve, peak, dof, path):
    from matplotlib import pyplot
    figure, ax = pyplot.subplots(1, 3, figsize=(15, 4.5), layout="constrained")
    plm.plot.response(curve, dof, peaks=[peak], ax=ax[0])
    plm.plot.contact_over_frequency(curve, ax=ax[1])
    plm.plot.harmonics(peak.branch, 0, dof, labels=["tip"], ax=ax[2])
    figure.savefig(path)


def main():
    model, tip = make_model()
    print("crack open:   ", model.modes(3), "Hz")
    print("crack closed: ", model.modes(3, "sliding"), "Hz")
    sampler = plm.Sampler(model, system="open", mode=1).run()
    print(f"bilinear frequency: {sampler.blf_hz:.4f} Hz ({sampler.window_why})")
    curve, peak = peak_of(plm.Basis(model, sampler, n_harmonics=7).build(), tip, "piecewise-linear modes")
    _, reference = peak_of(plm.Basis(model, sampler, kind="full", n_harmonics=7).build(), tip, "unreduced")
    error = abs(peak.amplitude / reference.amplitude - 1)
    print(f"error of the reduction at the peak: {100 * error:.3f} %")
    if len(sys.argv) > 1:
        draw(curve, peak, tip, sys.argv[1])
    return 0 if error < 0.05 else 1


if __name__ == "__main__":
    sys.exit(main())
