"""cracked_beam.py: a cantilever whose crack opens and closes, assembled with SciPy and handed over in process.

    PYTHONPATH=bindings/python PLM_LIBRARY=build/dev/src/libplm.so python3 examples/python/cracked_beam.py [figure.png]

Euler beam elements (m, kg, N, s): deflection w and rotation r per node. At the crack the rotations of the two faces are
joined by a weak spring (the ligament); where the faces meet, a contact pair carries the moment: it closes when the crack
is bent shut. Printed: the modes, the library's page about the response, and the peak without reduction, 1e-3 away at most.
It takes a second.
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


def draw(response, peak, dof, path):
    figure, (curve, contact) = plm.plot.figure(1, 2, width=plm.plot.PAGE)
    plm.plot.response(response.curve, dof, peaks=[response], name="the tip", ax=curve)
    plm.plot.harmonics(peak.branch, 0, dof, labels=["the tip"], ax=contact)
    print("pictures:", *plm.plot.save(figure, path))


def main():
    model, tip = make_model()
    print("crack open:   ", model.modes(3), "Hz")
    print("crack closed: ", model.modes(3, "sliding"), "Hz")
    response = model.compute_response(dof=tip)  # nothing is set: basis, harmonics and range follow from the accuracy, 1e-3
    print(response.report())
    peak = response.hbm.find_peak(response.curve, tip)
    # kind "full": the structure without reduction, to compare with; all else as by default
    whole = plm.Hbm(plm.Basis(model, plm.Sampler(model).run(), kind="full").build())
    reference = whole.find_peak(whole.sweep(), tip)
    error = abs(response.amplitude / reference.amplitude - 1)
    print(f"without reduction: {reference.amplitude:.6g} at {reference.frequency_hz:.6g} Hz, {100 * error:.4f} % away")
    if len(sys.argv) > 1:
        draw(response, peak, tip, sys.argv[1])
    return 0 if error < 1e-3 else 1


if __name__ == "__main__":
    sys.exit(main())
