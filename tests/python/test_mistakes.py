"""What engineers get wrong, and what they are told: each answer names the cause and the remedy.

The structure is a steel cantilever of 1 m, two DOFs per node (deflection, slope), with a stop 0.1 mm from its tip. Each
mistake is one change of that. Its answer is all that a host is given: the exception, the warnings, and the findings of the
audit that are worth a look."""
import unittest
import warnings

import numpy
import plm
import scipy.sparse

ELEMENTS = 20
DOFS = 2 * (ELEMENTS + 1)
TIP = DOFS - 2


def beam():
    """Mass and stiffness of the free beam, 10 x 10 mm, kg, N, m."""
    h, bending, mass_per_length = 1 / ELEMENTS, 2.1e11 * 0.01**4 / 12, 7800 * 0.01**2
    k = bending / h**3 * numpy.array([[12, 6 * h, -12, 6 * h], [6 * h, 4 * h * h, -6 * h, 2 * h * h],
                                      [-12, -6 * h, 12, -6 * h], [6 * h, 2 * h * h, -6 * h, 4 * h * h]])
    m = mass_per_length * h / 420 * numpy.array([[156, 22 * h, 54, -13 * h], [22 * h, 4 * h * h, 13 * h, -3 * h * h],
                                                 [54, 13 * h, 156, -22 * h], [-13 * h, -3 * h * h, -22 * h, 4 * h * h]])
    mass, stiffness = numpy.zeros((2, DOFS, DOFS))
    for e in range(ELEMENTS):
        mass[2 * e:2 * e + 4, 2 * e:2 * e + 4] += m
        stiffness[2 * e:2 * e + 4, 2 * e:2 * e + 4] += k
    return scipy.sparse.csr_matrix(mass), scipy.sparse.csr_matrix(stiffness)


MASS, STIFFNESS = beam()


def unit(dof, value=1.0):
    vector = numpy.zeros(DOFS)
    vector[dof] = value
    return vector


def model(mass=MASS, stiffness=STIFFNESS, fixed=(0, 1), damping=0.01, row=unit(TIP), contact=2e4, gap=1e-4, force=unit(TIP, 3e-3),
          preload=None, build=True, part="full"):
    m = plm.Model(mass, stiffness, part=part)
    if fixed:
        m.fix_dofs(list(fixed))
    if damping:
        m.set_modal_damping(damping)
    if row is not None:
        m.add_gap_rows([row], contact, gap)
    if preload is not None:
        m.set_preload(preload)
    if force is not None:
        m.set_excitation(force)
    return m.build() if build else m


def curve_and_peak(m, **options):
    sampler = plm.Sampler(m).run()
    hbm = plm.Hbm(plm.Basis(m, sampler).build(), **{"n_harmonics": 15, **options})
    return hbm.find_peak(hbm.sweep(), TIP, "peak")


def run(m=None, options=None, **changes):
    """The whole way from the model to the peak; returns the model, whose audit belongs to the answer."""
    m = m or model(**changes)
    curve_and_peak(m, **(options or {}))
    return m



def set_matrix(base, storage, a, b):
    a, b, values = numpy.array(a, dtype=numpy.int32), numpy.array(b, dtype=numpy.int32), numpy.ones(2)
    plm.Model(n_dof=2)._call("set_matrix_i32", plm.MASS, storage, plm.FULL, base, 1, 2, a.ctypes.data, b.ctypes.data,
                             values.ctypes.data)


def same_dof_twice_in_a_row():
    pointers, dofs = numpy.array([0, 2], dtype=numpy.int32), numpy.array([TIP, TIP], dtype=numpy.int32)
    ones, contact = numpy.ones(2), numpy.array([2e4])
    model(build=False)._call("add_gap_rows_i32", 0, 1, pointers.ctypes.data, dofs.ctypes.data, ones.ctypes.data,
                             contact.ctypes.data, None)


def pair_twice():
    m = model(build=False)
    m.add_gap_rows([unit(TIP)], 2e4, 1e-4)
    return m.build()


def two_beams():
    """The force on a beam that has no contact, beside the one that has."""
    m = plm.Model(scipy.sparse.block_diag([MASS, MASS]).tocsr(), scipy.sparse.block_diag([STIFFNESS, 1.3 * STIFFNESS]).tocsr())
    m.fix_dofs([0, 1, DOFS, DOFS + 1])
    m.set_modal_damping(0.01)
    m.add_gap_rows([numpy.concatenate([unit(TIP), numpy.zeros(DOFS)])], 2e4, 1e-4)
    m.set_excitation(numpy.concatenate([numpy.zeros(DOFS), unit(TIP, 2e-3)]))
    return run(m.build())


def unsymmetric():
    k = STIFFNESS.tolil()
    k[10, 12] *= 1.01
    model(stiffness=k)


def without_build(step):
    m = model()
    sampler = plm.Sampler(m)
    if step == "sampler":
        plm.Basis(m, sampler).build()
    plm.Hbm(plm.Basis(m, sampler.run())).sweep()


def other_model():
    plm.Basis(model(), plm.Sampler(model()))


def no_contact():
    run(model(row=None))


# (mistake, what is done, the cause and the remedy in the answer)
MISTAKES = [
    ("index base 1 said, 0 given", lambda: set_matrix(1, plm.CSR, [0, 1, 2], [0, 1]), "a.0. = 0 must be the index base 1", "check index_base"),
    ("index base 0 said, 1 given", lambda: set_matrix(0, plm.CSR, [1, 2, 3], [1, 2]), "a.0. = 1 must be the index base 0", "check index_base"),
    ("index base 1 said for triplets", lambda: set_matrix(1, plm.TRIPLETS, [0, 1], [0, 1]), "a.0. = 0 is no row number", "1..2; check index_base"),
    ("a slope for a deflection", lambda: run(row=unit(TIP + 1)), "touch no DOF of a translation", "off by one.*Translations are DOFs 0, 2"),
    ("the system in place of the number of modes", lambda: model().modes("open", 2), "n is .open.; the number of modes comes first", "modes.2, .open.\\)"),
    ("a DOF that is none", lambda: model(fixed=(0, DOFS)), f"dof.1. = {DOFS} is no DOF number", f"must lie in 0..{DOFS - 1}"),
    ("a DOF twice in a row, summed up", lambda: model(row=unit(TIP, 2.0)), "far from unit length", "a DOF given twice adds up"),
    ("a DOF twice in a row", same_dof_twice_in_a_row, "stands twice in gap row 0", "sum its coefficients"),
    ("a pair twice", pair_twice, "pair 1 repeats pair 0.*counts twice", "add each pair once"),
    ("a node against itself", lambda: model(build=False).add_node_pairs([TIP, -1, -1], [TIP, -1, -1], [1, 0, 0]),
     "both sides of pair 0 have the same DOFs", "give the DOFs of the two nodes"),
    ("no support", lambda: model(fixed=None), "2 rigid-body modes.*1 of them whatever contact closes", "Fix DOFs; where free flight"),
    ("no support under a pre-load", lambda: run(fixed=None, preload=unit(TIP, -1e-2)), "drives a rigid-body motion",
     "fix DOFs or check the direction of the pre-load"),
    ("the stop on the other side", lambda: model(row=unit(TIP, -1.0)), "motion of DOF 40 in its negative direction closes pair 0", ""),
    ("a normal reversed under a pre-load", lambda: model(row=unit(TIP, -1.0), gap=0, preload=unit(TIP, 0.2)),
     "under the pre-load all 1 pairs are open", "its sign, the normals .* or the gaps are wrong"),
    ("E in MPa, the rest in kg and m", lambda: model(stiffness=STIFFNESS * 1e-6), "of the local stiffness", "are k_n and K in the same units"),
    ("density in kg/m3, the rest in mm and N", lambda: model(mass=MASS * 1e12), "lowest elastic frequency .* outside 1e-3..1e7 Hz",
     "do the units of mass and stiffness belong together"),
    ("one entry without its mirror", unsymmetric, "not symmetric: .* at row 12, column 10", "pass plm.LOWER or plm.UPPER"),
    ("one triangle as full", lambda: model(stiffness=scipy.sparse.tril(STIFFNESS).tocsr()), "not symmetric", "pass plm.LOWER or plm.UPPER"),
    ("a full matrix as one triangle", lambda: model(part="lower"), "not in the lower triangle", "pass plm.FULL or plm.UPPER"),
    ("build forgotten", lambda: run(model(build=False)), "the model is not built", "build it first"),
    ("the sampler's run forgotten", lambda: without_build("sampler"), "the sampler has not run", "run it first"),
    ("the basis' build forgotten", lambda: without_build("basis"), "the basis is not built", "build it first"),
    ("a sampler of another model", other_model, "the sampler is of another model", "make both from one"),
    ("no excitation", lambda: model(force=None), "no harmonic excitation.*the response is zero", "give the model one, of harmonic 1"),
    ("no excitation, and the whole way gone", lambda: run(force=None), "no harmonic excitation acts on the free DOFs",
     "Give the model an excitation of harmonic 1"),
    ("an excitation of zeros", lambda: model(force=unit(TIP, 0.0)), "no harmonic excitation", "give the model one, of harmonic 1"),
    ("an excitation on a support", lambda: model(force=unit(0)), "acts on fixed DOFs only", "move it to DOFs that are free"),
    ("a range upside down", lambda: run(options={"frequency_min_hz": 30.0, "frequency_max_hz": 20.0}), r"range \[30, 20\] Hz is empty",
     "set frequency_min_hz < frequency_max_hz"),
    ("a gap in mm, the rest in m", lambda: run(gap=0.1, force=unit(TIP, 2e-3)), "no contact pair opens or closes .* 5.4e.02 times as large", "Check the units of gaps"),
    ("a gap that never closes", lambda: run(gap=1.0), "no contact pair opens or closes", "Check the units of gaps, pre-load and excitation"),
    ("a force beside the clamp", lambda: run(force=unit(2, 1e-9)), "no contact pair opens or closes", "pre-load and excitation"),
    ("a force on a part that the contact does not hold", two_beams, "does not move the contact", "name the mode of the resonance"),
    ("the peak of a part that the force does not move", two_beams, "this DOF does not move on the curve", "Ask for a DOF that moves"),
    ("a range without a resonance", lambda: run(options={"frequency_min_hz": 20.0, "frequency_max_hz": 30.0}),
     "stands at an end of the curve, 20 Hz", "Follow the curve over a wider range"),
    ("rad/s for Hz", lambda: run(options={"frequency_min_hz": 45.0, "frequency_max_hz": 75.0}), "the whole curve lies outside the 7.9.* Hz",
     r"Are the limits in Hz \(rad/s over 2 pi\)"),
    ("no damping", lambda: model(damping=None), "no damping: .* unbounded", "give the model modal, Rayleigh"),
    ("no damping, and the whole way gone", lambda: run(damping=None), "the model has no damping: at a resonance the response is unbounded",
     "Give the model modal, Rayleigh"),
    ("a pre-load that opens every pair", lambda: model(gap=0, preload=unit(TIP, -5.0)), "under the pre-load all 1 pairs are open", "are wrong"),
    ("contact 1e12 times too stiff", lambda: model(contact=5e14), "9.52e.11 of the local stiffness", "1 to 50 is a good choice"),
    ("an option misspelt", lambda: plm.Hbm(plm.Basis(model()), n_harmonic=5), 'has no key "n_harmonic"', 'did you mean "n_harmonics"'),
    ("an option of another type", lambda: plm.Hbm(plm.Basis(model()), n_harmonics=5.5), "^n_harmonics is", "an integer, not 5.5"),
    ("a negative contact stiffness", lambda: model(contact=-3.0), "stiffness.0. is -3", "must be > 0.*or plm.AUTO_STIFFNESS"),
    ("a normal of length 2", lambda: model(build=False).add_node_pairs([TIP, -1, -1], [2, -1, -1], [2, 0, 0]), "not of unit length",
     "normalise the three components"),
    ("NaN in a matrix", lambda: model(stiffness=STIFFNESS * numpy.nan), "NaN or infinite, at row 0, column 0", "look for a failed element"),
    ("masses without rotary inertia", lambda: model(mass=scipy.sparse.diags(numpy.tile([0.78 / 21, 0.0], ELEMENTS + 1)).tocsr()),
     "20 free DOFs have no mass; they follow quasi-statically", "Give them their .rotary. inertia"),
    ("a peak of a DOF that is none", lambda: plm.Hbm(basis := plm.Basis(m := model(), plm.Sampler(m).run()).build(),
                                                      n_harmonics=5).find_peak(plm.Hbm(basis, n_harmonics=5).sweep(), 999),
     "dof is 999", f"must lie in 0..{DOFS - 1}"),
    ("matrices of different size", lambda: plm.Model(MASS, scipy.sparse.block_diag([STIFFNESS, STIFFNESS]).tocsr()),
     "the stiffness matrix is 84 x 84, but the model has 42 DOFs", "hand over all matrices as 42 x 42"),
    ("no contact pair", no_contact, "no contact pair, so there is no contact area to sample", "use a basis of kind full or craig_bampton"),
    ("one harmonic", lambda: run(options={"n_harmonics": 1}, contact=2e5), "n_harmonics = 1 is too few for this peak", "Raise n_harmonics"),
    ("three harmonics", lambda: run(options={"n_harmonics": 3}, contact=2e5), "n_harmonics = 3 is too few for this peak", "Raise n_harmonics"),
    ("built twice", lambda: model().build(), "is built and no longer changes", "make a new one"),
]


def answer(attempt):
    """All that a host is told."""
    told = []
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", plm.PlmWarning)
        try:
            result = attempt()
        except (plm.PlmError, ValueError, TypeError, AttributeError) as error:
            result, told = None, [str(error)]
    told += [str(w.message) for w in caught if issubclass(w.category, plm.PlmWarning)]
    if isinstance(result, str):
        told.append(result)
    if isinstance(result, plm.Model):
        told += [f"audit ({finding.severity}): {finding.text}" for finding in result.audit()]
    return told


class Mistakes(unittest.TestCase):
    def test_the_correct_model_is_left_in_peace(self):
        """None of the answers below is given to those who made no mistake."""
        told = answer(run)
        self.assertEqual([line for line in told if not line.startswith("audit (0)")], [])

    def test_every_mistake_has_a_cause_and_a_remedy(self):
        self.assertEqual(len({name for name, *_ in MISTAKES}), len(MISTAKES))
        for name, attempt, cause, remedy in MISTAKES:
            with self.subTest(name):
                told = " ".join(answer(attempt))
                self.assertRegex(told, f"(?s){cause}.*{remedy}|{remedy}.*{cause}")
                self.assertNotRegex(told, r"\b(inf|nan) (of itself|times)")


if __name__ == "__main__":
    unittest.main()
