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


def chain_with_a_loop():
    """Nine masses (kg, N/m, s), one of them against a stop without gap; four harmonics of loads."""
    between = numpy.array([4138.54, 17549.8, 10484.3, 24292.7, 6992.12, 20824.5, 8799.79, 25044.8])
    to_ground = numpy.array([4741.59, 0, 0, 0, 0, 0, 0, 0, 8794.38])
    stiffness = numpy.diag(to_ground)
    for i, k in enumerate(between):
        stiffness[i:i + 2, i:i + 2] += k * numpy.array([[1, -1], [-1, 1]])
    m = plm.Model(numpy.diag([1.04226, 2.30371, 2.23371, 0.973192, 0.546982, 0.372734, 1.74499, 0.848973, 2.24706]), stiffness)
    m.set_rayleigh_damping(0.194518, 0.000342893)
    m.add_gap_rows(numpy.eye(9)[6:7], 49360.5)
    loads = {
        1: ([-0.0445585, 0.0237861, 0.0278688, -0.0661016, 0.234496, -0.0585426, -0.109204, 0.00311814, -0.109548],
            [-0.10085, 0.0918369, 0.0283251, -0.111779, -0.0840631, 0.0348429, -0.00918742, -0.159914, -0.108808]),
        2: ([0.0947004, 0.0739447, -0.129457, 0.0434274, 0.250084, 0.172261, 0.0105597, -0.0724364, -0.187726],
            [-0.102315, 0.130301, 0.055124, 0.169857, 0.0328004, -0.0634536, -0.0885025, -0.0453464, -0.219181]),
        4: ([0.0235428, -0.0330795, -0.00927949, -0.0156485, -0.0221261, -0.0245689, -0.0525303, 0.017132, 0.00340794],
            [-0.0016586, 0.0130358, -0.00507278, 0.0173906, -0.0209081, -0.00168733, 0.0177704, -0.00210531, -0.0444596]),
        5: ([0.0427516, 0.0155659, -0.0317551, -0.00853107, 0.0158102, -0.047008, -0.0208266, 0.0310259, 0.0416106],
            [0.0174857, -0.0190105, -0.00458834, 0.119728, -0.0151802, 0.0185008, 0.0451852, 0.0501483, 0.00359349]),
    }
    for harmonic, (real, imaginary) in loads.items():
        m.set_excitation(numpy.array(real) + 1j * numpy.array(imaginary), harmonic)
    return m.build()


def damped_chain(ratio):
    """Seven masses between two walls, the fifth against a stop without gap, driven at the first."""
    between = 1e3 * numpy.array([9.047, 5.615, 5.248, 17.2, 18.69, 14.1, 15.94, 13.15])
    stiffness = numpy.diag(between[:-1] + between[1:]) - numpy.diag(between[1:-1], 1) - numpy.diag(between[1:-1], -1)
    m = plm.Model(numpy.diag([1.903, 1.724, 0.5041, 1.786, 0.5504, 1.594, 0.7635]), stiffness)
    m.set_modal_damping(ratio)
    m.add_gap_rows(numpy.eye(7)[4:5], 1 / numpy.linalg.inv(stiffness)[4, 4])
    m.set_excitation(numpy.eye(7)[0])
    return m.build()


def pressed_chain():
    """Two hundred masses between a wall and stops, which the pre-load presses upon: the statics have directions of their own (P_0 is another
    one than P), and one damping ratio for all modes couples them."""
    n = 200
    stiffness = 1e4 * (2 * numpy.eye(n) - numpy.eye(n, k=1) - numpy.eye(n, k=-1))
    m = plm.Model(numpy.diag(numpy.linspace(0.8, 1.2, n)), stiffness)
    m.set_modal_damping(0.01)
    m.add_gap_rows(numpy.eye(n)[[50, 100, 150]], 1e4)
    m.set_preload(numpy.linspace(-1, 3, n))
    m.set_excitation(5 * numpy.eye(n)[75])
    m.build()
    return plm.Basis(m, plm.Sampler(m).run()).build()


def stopped_chain():
    """Sixty masses between two walls, every fifth one with a stop a little off: too many coordinates and stops to follow a curve of
    exact motions on all of them, so that it is followed on compressed models, the second one by what the first one's curve lacked."""
    n, stopped = 60, range(4, 60, 5)
    m = plm.Model(numpy.diag(numpy.linspace(0.8, 1.2, n)), 1e4 * (2 * numpy.eye(n) - numpy.eye(n, k=1) - numpy.eye(n, k=-1)))
    m.set_modal_damping(0.02)
    m.add_gap_rows(numpy.eye(n)[list(stopped)], 1e3, 0.01)
    m.set_excitation(2 * numpy.eye(n)[20])
    return full(m, 0.9, 1.15)
