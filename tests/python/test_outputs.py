"""Outputs, sums of DOFs that stand wherever a DOF is looked at: held against NumPy on fields, against the same row made a DOF by
a constraint, and against samples in time."""
import unittest
import warnings

import numpy
import plm
import scipy.sparse

N = 8
PAIR = (2, 5)
BY_MOTION = {"exact": {"motion": "exact"}, "harmonic balance": {"motion": "harmonics", "n_harmonics": 9}}


def matrices(extra=0):
    mass = numpy.zeros((N + extra, N + extra))
    stiffness = mass.copy()
    mass[:N, :N] = numpy.eye(N)
    stiffness[:N, :N] = 1e4 * (2 * numpy.eye(N) - numpy.eye(N, k=1) - numpy.eye(N, k=-1))
    stiffness[N - 1, N - 1] = 1e4
    return mass, stiffness


def pair_row(n=N):
    row = numpy.zeros(n)
    row[list(PAIR)] = 1, -1
    return row


def model(extra=0, constraint=None, context=None):
    """A chain with one contact that chatters about a pre-loaded gap, driven at its first mode. extra: DOFs without mass or
    stiffness, given by the constraint."""
    m, k = matrices(extra)
    n = N + extra
    made = plm.Model(m, k, context=context)
    if constraint is not None:
        made.add_constraints(constraint)
    made.set_rayleigh_damping(1.0, 1e-4)
    made.add_gap_rows(pair_row(n)[None], stiffness=5e4, gap=1e-4)
    force, preload = numpy.zeros(n), numpy.zeros(n)
    force[4], preload[2] = 2.0, 3.0
    made.set_preload(preload)
    made.set_excitation(force)
    return made.build()


def sums():
    random = numpy.random.default_rng(5)
    rows = random.normal(size=(3, N))
    rows[0] = pair_row()
    rows[2, :] = 0
    rows[2, 6] = -2
    return rows


def quietly(work, *arguments, **options):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", plm.PlmWarning)
        return work(*arguments, **options)


class Outputs(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.rows = sums()
        cls.model = quietly(model)
        cls.sampler = quietly(plm.Sampler(cls.model).run)
        cls.basis = quietly(plm.Basis(cls.model, cls.sampler, n_harmonics=9).build)
        cls.curves = {}
        for name, options in BY_MOTION.items():
            hbm = plm.Hbm(cls.basis, **options)
            curve = quietly(hbm.sweep)
            cls.curves[name] = hbm, curve, int(numpy.argmax(curve.amplitude(4)))
        cls.numbers = cls.model.add_outputs(scipy.sparse.csr_matrix(cls.rows))  # after all that

    def near(self, got, want, tolerance):
        numpy.testing.assert_allclose(got, want, rtol=0, atol=tolerance * numpy.abs(want).max())

    def test_they_are_numbered_on_from_the_dofs(self):
        made = quietly(model)
        self.assertEqual(self.numbers, range(N, N + 3))
        self.assertEqual(list(made.add_outputs(self.rows[:1])), [N])
        wide = scipy.sparse.csr_matrix(self.rows[1:])
        wide.indptr, wide.indices = wide.indptr.astype(numpy.int64), wide.indices.astype(numpy.int64)
        self.assertEqual(list(made.add_outputs(wide)), [N + 1, N + 2])
        self.assertEqual(made.n_dof, N)

    def test_coefficients_and_histories_are_sums_of_those_of_dofs(self):
        for name, (hbm, curve, top) in self.curves.items():
            with self.subTest(name):
                c = curve.coefficients(top)
                fields = numpy.array([curve.field(top, t / 32) for t in range(32)])
                for number, row in zip(self.numbers, self.rows):
                    self.near(curve.coefficients(top, number), c @ row, 1e-12)
                    self.near(curve.history(top, number, 32), fields @ row, 1e-10)
                for dof in (0, N - 1):
                    self.near(curve.history(top, dof, 32), fields[:, dof], 1e-10)

    def test_relative_motion_of_a_pair_is_its_gap(self):
        hbm, curve, top = self.curves["harmonic balance"]
        contact = curve.contact(top, 64)
        self.near(curve.history(top, self.numbers[0], 64) - 1e-4, contact.penetration[0], 1e-10)

    def test_extrema_are_those_of_the_motion(self):
        """Samples never exceed the extremum, and come to it with the square of their distance."""
        for name, (hbm, curve, top) in self.curves.items():
            for number in self.numbers:
                with self.subTest(name, number=number):
                    peak, swing = curve.amplitude(number, "peak")[top], curve.amplitude(number)[top]
                    q = curve.history(top, number, 20000)
                    self.assertLessEqual(numpy.abs(q).max(), peak * (1 + 1e-10))
                    self.assertGreater(numpy.abs(q).max(), peak * (1 - 1e-5))
                    half = (q.max() - q.min()) / 2
                    self.assertTrue(swing * (1 - 1e-5) < half <= swing * (1 + 1e-10))

    def test_a_multiple_of_a_dof_is_looked_at_as_the_dof(self):
        number = self.numbers[2]  # -2 q_6
        for name, (hbm, curve, top) in self.curves.items():
            with self.subTest(name):
                for measure in ("peak", "half_peak_to_peak", "rms"):
                    self.near(curve.amplitude(number, measure), 2 * curve.amplitude(6, measure), 1e-9)
                one, other = (quietly(hbm.find_peak, curve, d) for d in (6, number))
                self.near([other.frequency_hz, other.amplitude], [one.frequency_hz, 2 * one.amplitude], 1e-8)
                at, times = (quietly(hbm.estimate_error, p.branch, 0, d) for p, d in ((one, 6), (one, number)))
                self.near(times.amplitude, 2 * numpy.array(at.amplitude), 1e-8)
        mode, again = (quietly(hbm.nonlinear_mode, 1, d, a) for d, a in ((6, 1e-3), (number, 2e-3)))
        self.near(again.frequency_hz, mode.frequency_hz, 1e-9)
        refined, same = (quietly(hbm.refine_basis, d, 1e-2) for d in (6, number))
        self.assertEqual(refined.basis.size, same.basis.size)

    def test_time_marching_observes_them(self):
        for of in (self.basis, self.model):
            motion = plm.Transient(of, frequency_hz=10, periods=3, steps_per_period=64)
            motion.observe([*range(N), *self.numbers])
            motion.run()
            q = numpy.array([motion.history(dof) for dof in range(N)])
            for number, row in zip(self.numbers, self.rows):
                self.near(motion.history(number), row @ q, 1e-10)

    def test_one_call_equals_that_of_a_dof_made_of_the_row_by_a_constraint(self):
        row = self.rows[1]
        constraint = numpy.append(row, -1)[None]
        with_dof = quietly(model, 1, constraint)
        with_output = quietly(model)
        number, = with_output.add_outputs(row[None])
        self.assertEqual(number, N)
        same, = with_dof.add_outputs(numpy.append(row, 0)[None])  # over DOFs of which one is given by others
        dependent, = with_dof.add_outputs(numpy.append(0 * row, 3)[None])
        want = quietly(with_dof.compute_response, N, measure="peak")
        got = quietly(with_output.compute_response, number, measure="peak")
        self.near([got.frequency_hz, got.amplitude], [want.frequency_hz, want.amplitude], 1e-9)
        self.near(want.curve.amplitude(same), want.curve.amplitude(N), 1e-11)
        self.near(want.curve.amplitude(dependent), 3 * want.curve.amplitude(N), 1e-11)

    def test_a_study_looks_at_them(self):
        fewer = plm.Hbm(self.basis, motion="harmonics", n_harmonics=3)
        errors, heights = [], []
        for dof in (6, self.numbers[2]):
            study = plm.Study(self.model, repeats=1, curve_tolerance=1e-3)
            study.set_output(dof)
            study.add_response("response", fewer)
            study.set_reference(self.curves["harmonic balance"][0])
            quietly(study.run)
            errors.append(study["amplitude_error"][0])
            heights.append(study.points("response", 0).amplitude.max())
        self.assertGreater(errors[0], 0)
        self.near(errors[1], errors[0], 1e-5)
        self.near(heights[1], 2 * heights[0], 1e-6)

    def test_what_is_fixed_adds_nothing(self):
        m, k = matrices()
        made = plm.Model(m, k)
        made.fix_dofs([0])
        made.set_rayleigh_damping(1.0, 1e-4)
        made.add_gap_rows(pair_row()[None], stiffness=5e4, gap=1e-4)
        made.set_excitation(numpy.eye(N)[4])
        number, held = made.add_outputs(numpy.array([[1.0, 2, 0, 0, 0, 0, 0, 0], [4.0, 0, 0, 0, 0, 0, 0, 0]]))
        answer = quietly(quietly(made.build).compute_response, number)
        self.near(answer.curve.amplitude(number), 2 * answer.curve.amplitude(1), 1e-12)
        self.assertEqual(numpy.abs(answer.curve.amplitude(held)).max(), 0)

    def test_numbers_that_are_none(self):
        curve = self.curves["exact"][1]
        for use in (curve.amplitude, lambda d: curve.history(0, d), lambda d: curve.coefficients(0, d)):
            with self.assertRaises(plm.PlmError) as caught:
                use(N + 3)
            self.assertIn(f"0..{N + 2}", str(caught.exception))
        with self.assertRaises(plm.PlmError):
            plm.Transient(self.basis).observe([N + 3])
        with self.assertRaises(ValueError):
            self.model.add_outputs(numpy.zeros((1, N)))


if __name__ == "__main__":
    unittest.main()
