"""A chain of masses along x with three DOFs per node, as in tests/capi/chain.c."""
import numpy
import plm
import scipy.sparse

NODES = 8
DOFS = 3 * NODES
WATCHED = 12


def matrices():
    """Mass and stiffness, CSC, both triangles."""
    diagonal, lower = numpy.empty(DOFS), numpy.zeros(DOFS - 3)
    for j in range(DOFS):
        node, axis = divmod(j, 3)
        diagonal[j] = (1e4 if node == NODES - 1 else 2e4) if axis == 0 else 5e4 * axis + 100 * node
    lower[::3] = -1e4
    stiffness = scipy.sparse.diags([lower, diagonal, lower], [-3, 0, 3], format="csc")
    stiffness.eliminate_zeros()
    return scipy.sparse.identity(DOFS, format="csc"), stiffness


def force():
    f = numpy.zeros(DOFS)
    f[WATCHED] = 10
    return f


def model(**options):
    m = plm.Model(*matrices(), **options)
    m.set_rayleigh_damping(0.5, 2e-4)
    m.add_node_pairs([6, 7, 8], [15, 16, 17], [1, 0, 0])
    m.add_ground_contacts([21, 22, 23], [1, 0, 0], stiffness=2e4, gap=0.0)
    m.set_excitation(force())
    return m


def basis(context=None):
    m = model(context=context).build()
    return plm.Basis(m, plm.Sampler(m, system="open", mode=1).run()).build()


def full(model, low, high):
    """The unreduced structure between two frequencies (Hz)."""
    return plm.Basis(model.build(), kind="full", frequency_min_hz=low, frequency_max_hz=high).build()


def between_stops():
    """An oscillator of 1 kg and 1 N/m between two stops at 0.2 m: it loses its symmetry at a branch point."""
    m = plm.Model(numpy.eye(1), numpy.eye(1), 0.1 * numpy.eye(1))
    m.add_gap_rows([[1.0], [-1.0]], 10.0, 0.2)
    m.set_excitation([1.0])
    return full(m, 0.19, 0.32)


def carrier():
    """A pre-loaded oscillator that opens at large amplitude and carries a light one, three times as fast: at a force scale of
    0.006 an isolated branch lies beside the main one."""
    m = plm.Model(numpy.diag([1, 0.2]), [[3.048, -2.048], [-2.048, 2.048]])
    m.set_rayleigh_damping(0, 0.004)
    m.add_gap_rows([[1.0, 0.0]], 1.0)
    m.set_preload([0.5, 0])
    m.set_excitation([1.0, 0])
    return full(m, 0.14, 0.26)
