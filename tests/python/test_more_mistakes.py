"""More of what engineers get wrong, on the way of one call, and what they are told: in the words of Python, by the name of the
argument, with what to do."""
import unittest

import numpy
import plm
import scipy.sparse

from test_mistakes import DOFS, MASS, STIFFNESS, TIP, answer, model, unit

PAIR = [[TIP, -1, -1]], [[2, -1, -1]]


def one_call(dof=TIP, m=None, options=None, **changes):
    m = m or model(**changes)
    m.compute_response(dof, **(options or {}))
    return m


def rows(row, gap=1e-4):
    m = model(row=None, build=False)
    m.add_gap_rows(row, 2e4, gap)
    return m.build()


def pairs(normal, a=PAIR[0], b=PAIR[1]):
    model(build=False).add_node_pairs(a, b, normal)


def hbm(**options):
    return plm.Hbm(plm.Basis(model(), kind="full", frequency_min_hz=8.0, frequency_max_hz=14.0).build(), **options)


def without(dof):
    """The structure with a DOF that has neither stiffness nor mass."""
    keep = scipy.sparse.diags(1 - unit(dof))
    return model(mass=keep @ MASS @ keep, stiffness=keep @ STIFFNESS @ keep)


def asymmetric():
    k = STIFFNESS.tolil()
    k[10, 12] *= 1 + 1e-6
    model(stiffness=k)


def constant_force():
    m = model(force=None, build=False)
    m.set_excitation(unit(TIP, 2e-3), harmonic=0)
    return one_call(m=m.build())


def no_pair():
    one_call(m=model(row=None))


def sweep(**arguments):
    return hbm(n_harmonics=5).sweep(**arguments)


# (mistake, what is done, what must be in the answer)
MISTAKES = [
    ("damping in percent", lambda: model(damping=1.0), r"ratio\[0\] is 1; .*\[0, 1\), the fraction of critical damping"),
    ("damping of 99 per cent", lambda: one_call(damping=0.99), r"does not stand out.*1 % is the ratio 0.01"),
    ("alpha and beta of Rayleigh's damping exchanged", lambda: one_call(m=[m := model(damping=None, build=False), m.set_rayleigh_damping(
        2e-5, 1.0), m.build()][0]), "does not stand out.*alpha is in 1/s, beta in s"),
    ("a gap row of zeros", lambda: rows(scipy.sparse.csr_matrix((1, DOFS))), "^row 0 of rows is all zeros.*check the numbers"),
    ("a gap row of stored zeros", lambda: rows([unit(TIP, 0.0)]), "^row 0 of rows is all zeros"),
    ("gaps of another number", lambda: model(gap=[1e-4, 2e-4]), "^gap has shape .2,.; needed is .1,., one for each pair, or one number"),
    ("contact on a fixed DOF", lambda: model(row=unit(0)), "pair 0 .* touches fixed DOFs only.*release a DOF"),
    ("a response of a fixed DOF", lambda: one_call(0), "does not move .*as one that is fixed.*Ask for a DOF that moves"),
    ("the last DOF as -1", lambda: one_call(-1), f"dof is -1; it must lie in 0..{DOFS - 1}"),
    ("a DOF as a float", lambda: one_call(12.0), "^plm_model_compute_response: dof: an integer is needed, not float"),
    ("a DOF by a name", lambda: one_call("tip"), "^plm_model_compute_response: dof: an integer is needed, not str"),
    ("DOFs counted from 1", lambda: one_call(DOFS), f"dof is {DOFS}; it must lie in 0..{DOFS - 1}"),
    ("normals as columns", lambda: pairs(numpy.zeros((3, 2)), PAIR[0] * 2, PAIR[1] * 2), "^normal has shape .3, 2.; needed is .2, 3., a row for each"),
    ("a normal of zeros", lambda: pairs([0, 0, 0]), "not of unit length .*normalise the three components"),
    ("a normal where no DOF is", lambda: pairs([0, 1, 0]), "the same DOFs, or none, along the normal.*give the DOFs of the two nodes"),
    ("a DOF without stiffness and mass", lambda: without(10), "DOF 10 .* has neither stiffness nor mass; fix it or give it one"),
    ("a negative spring", lambda: model(stiffness=STIFFNESS - scipy.sparse.diags(unit(TIP, 3e3))), "negative eigenvalue.*check element signs"),
    ("a negative mass", lambda: model(mass=MASS - scipy.sparse.diags(unit(TIP))), "row 40, column 40 .* is negative.*check the sign"),
    ("no mass", lambda: model(mass=scipy.sparse.csr_matrix((DOFS, DOFS))), "no free DOF has mass; check the mass matrix"),
    ("everything fixed", lambda: model(fixed=range(DOFS)), "all DOFs are fixed"),
    ("a mask of the wrong length", lambda: plm.Model(MASS, STIFFNESS).fix_dofs(numpy.ones(5, bool)),
     f"^a mask of DOFs has one entry for each of the {DOFS} DOFs; this one has shape .5,."),
    ("fixed DOFs as floats", lambda: plm.Model(MASS, STIFFNESS).fix_dofs([0.0, 1.5]), "^dof must hold integers, not float64"),
    ("a force on the free DOFs", lambda: model(force=numpy.zeros(DOFS - 2)), "^force has shape .40,.; needed is .42,., one for each DOF, the fixed ones included"),
    ("a constant excitation", constant_force, "it moves none of them.*harmonic of 1 or above .a constant force is a pre-load"),
    ("NaN in the pre-load", lambda: model(preload=numpy.full(DOFS, numpy.nan)), r"force\[0\] is NaN or infinite"),
    ("an interference of 100 mm", lambda: one_call(gap=-0.1), "no contact pair opens or closes.*Check the units of gaps"),
    ("accuracy in percent", lambda: one_call(options={"accuracy": 5}), "accuracy is 5; a relative error of 1e-8 to 0.5 is wanted"),
    ("an accuracy beyond double precision", lambda: one_call(options={"accuracy": 1e-12}), "accuracy is 1e-12; .* such as 1e-3"),
    ("a measure that is none", lambda: one_call(options={"measure": "max"}), "^measure is 'max'; it must be one of peak, half_peak_to_peak, rms"),
    ("compute before build", lambda: one_call(m=model(build=False)), "the model is not built; build it first"),
    ("no contact", no_pair, "no contact pair: its response is linear, and a basis of kind full or craig_bampton gives it"),
    ("a full basis without a range", lambda: plm.Basis(model(), kind="full").build(), "frequency_max_hz is needed when there is no sampler"),
    ("mode 99", lambda: plm.Sampler(model(), mode=99).run(), "mode 99 of the open system is asked for, but it has only 40"),
    ("an attribute of hbm misspelt", lambda: setattr(hbm(), "n_harmonic", 5), 'has no key "n_harmonic"; did you mean "n_harmonics"'),
    ("5.5 harmonics", lambda: hbm(n_harmonics=5.5), "^n_harmonics is an integer, not 5.5"),
    ("harmonics in quotes", lambda: hbm(n_harmonics="5"), "^n_harmonics is an integer, not '5'"),
    ("-1 harmonics", lambda: hbm(n_harmonics=-1), '"n_harmonics" is -1; it must lie in 0..1000'),
    ("True for a word", lambda: hbm(stability=True), "^stability is one of the words off, auto, floquet, hill, not True"),
    ("a word that is none", lambda: hbm(motion="exakt"), '"motion" cannot be "exakt"; choose one of auto,exact,harmonics'),
    ("a word for a number", lambda: hbm(tolerance="tight"), "^tolerance is a number, not 'tight'"),
    ("a result misspelt", lambda: model().rest_penetrations, "no attribute 'rest_penetrations'; did you mean 'rest_penetration'"),
    ("a method misspelt", lambda: model().compute_respons(TIP), "did you mean 'compute_response'"),
    ("a result before the run", lambda: plm.Sampler(model()).blf_hz, "the sampler has not run; run it first"),
    ("a complex stiffness", lambda: model(stiffness=STIFFNESS * (1 + 0.02j)), "^the stiffness matrix is complex.*set_structural_damping"),
    ("a matrix rounded to single precision", asymmetric, "not symmetric: .* pass plm.LOWER or plm.UPPER to use one triangle"),
    ("two DOFs for one", lambda: sweep().amplitude([1, 2]), "^plm_branch_get_amplitude: dof: an integer is needed, not list"),
    ("a point that is none", lambda: sweep().field(10**6), "point is 1000000; it must lie in 0.."),
    ("an array for a branch", lambda: hbm().solve(10.0, start=numpy.zeros(DOFS)), "^start must be a plm.Branch, not ndarray"),
    ("a curve for a list of curves", lambda: plm.Basis(model(), responses=[sweep(), 3], kind="pod"), "each of the branches must be a plm.Branch, not int"),
    ("a model for a basis", lambda: plm.Hbm(model()), "^basis must be a plm.Basis, not Model"),
    ("a matrix for a model", lambda: plm.Sampler(STIFFNESS), "^model must be a plm.Model, not csr_matrix"),
    ("a branch for an hbm", lambda: plm.Study(model()).add_response("a", sweep()), "^hbm must be a plm.Hbm, not Branch"),
    ("an hbm for a sampler", lambda: plm.Basis(model(), hbm()), "^sampler must be a plm.Sampler, not Hbm"),
    ("a branch for a transient's basis", lambda: plm.Transient(sweep()), "^a transient is made of a plm.Basis or a plm.Model, not Branch"),
    ("what the hbm of one call is made of", lambda: repr(model().compute_response(TIP).hbm), "on a basis of the library's choice"),
]


class MoreMistakes(unittest.TestCase):
    def test_every_mistake_is_answered(self):
        self.assertEqual(len({name for name, *_ in MISTAKES}), len(MISTAKES))
        for name, attempt, wanted in MISTAKES:
            with self.subTest(name):
                self.assertRegex(" ".join(answer(attempt)), f"(?s){wanted}")

    def test_what_is_no_mistake_is_left_in_peace(self):
        """Matrices of other types, options that are integers in other clothes, a branch to start from."""
        for stiffness in (STIFFNESS.astype(numpy.float32), scipy.sparse.csr_array(STIFFNESS), STIFFNESS.toarray().tolist()):
            self.assertTrue(model(stiffness=stiffness).modes(1)[0] > 0)
        other = hbm(n_harmonics=numpy.int64(5), tolerance=numpy.float32(1e-8), max_step=1)
        curve = other.sweep()
        self.assertEqual(len(other.solve(10.0, start=curve)), 1)
        self.assertEqual(len(other.solve(10.0, start=None)), 1)
        mask = numpy.zeros(DOFS, bool)
        mask[:2] = True
        m = plm.Model(MASS, STIFFNESS)
        m.fix_dofs(mask)


if __name__ == "__main__":
    unittest.main()
