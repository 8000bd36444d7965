"""Models as files print them: rows and loads that miss rigid-body motion by their last digit, mass and stiffness exchanged, a
dashpot in the wrong unit."""
import math
import time
import unittest
import warnings

import numpy
import plm

N = 5  # masses of each chain


def chain(n):
    """Springs of 1e6 N/m between n masses, free at both ends."""
    k = numpy.zeros((n, n))
    for i in range(n - 1):
        k[i:i + 2, i:i + 2] += 1e6 * numpy.array([[1, -1], [-1, 1]])
    return k


def pressed(row, load):
    """Two free chains of 1 kg a mass, pressed together by 100 N; two pairs between their ends miss the common motion by `row`
    to either side, the pre-load by `load`, relative."""
    k = numpy.zeros((2 * N, 2 * N))
    k[:N, :N] = k[N:, N:] = chain(N)
    model = plm.Model(numpy.eye(2 * N), k)
    rows = numpy.zeros((2, 2 * N))
    rows[:, N - 1] = 1
    rows[:, N] = -(1 + row), -(1 - row)
    model.add_gap_rows(rows, stiffness=5e5)
    force = numpy.zeros(2 * N)
    force[0], force[-1] = 100, -100 * (1 + load)
    model.set_preload(force)
    force[:] = 0
    force[0] = 30
    model.set_excitation(force)
    model.set_rayleigh_damping(0, 1e-4)
    return model


def answer(row, load):
    """Largest amplitude, its frequency, and the reasons of what was said."""
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always", plm.PlmWarning)
        model = pressed(row, load).build()
        reasons = list(model.warning_reasons)
        result = model.compute_response(0)
    return result.amplitude, result.frequency_hz, reasons, [str(w.message) for w in said]


class Rounding(unittest.TestCase):
    def test_free_chains_pressed_together(self):
        amplitude, frequency, reasons, _ = answer(0, 0)
        self.assertNotIn(plm.REASON_ROUNDED, reasons)
        for row, load in ((1e-12, 0), (1e-7, 0), (1e-6, 1e-7), (1e-8, -1e-6)):
            a, f, reasons, said = answer(row, load)
            digits = 100 * max(row, abs(load))  # a resonance makes more of them
            self.assertLess(abs(a / amplitude - 1), 1e-6 + digits, (row, load))
            self.assertLess(abs(f / frequency - 1), 1e-6 + digits, (row, load))
            self.assertEqual(plm.REASON_ROUNDED in reasons, max(row, abs(load)) > 1e-10, (row, load))
            self.assertEqual(any("gap rows miss" in text for text in said), row > 1e-10, (row, load))

    def test_an_unbalanced_load_is_named(self):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", plm.PlmWarning)
            model = pressed(1e-7, 0.01).build()
        with self.assertRaises(plm.PlmError) as caught:
            model.solve_rest()
        self.assertEqual(caught.exception.reason, plm.REASON_NO_EQUILIBRIUM)
        self.assertRegex(str(caught.exception), "its resultant is 1, 5.0e-03 of its forces.* pair [01], by 7.1e-08")

    def test_mass_and_stiffness_exchanged(self):
        mass = 4 * numpy.eye(N) + numpy.eye(N, k=1) + numpy.eye(N, k=-1)
        model = plm.Model(chain(N), mass)
        model.fix_dofs([0])
        with self.assertRaises(plm.PlmError) as caught:
            model.build()
        self.assertEqual(caught.exception.status, plm.ERR_MATRIX)
        self.assertIn("mass and stiffness are probably exchanged", str(caught.exception))

    def test_a_dashpot_that_locks_its_node(self):
        """The mass at the end of a held chain hangs on 1e10 N s/m: it moves by F / (w c), and the answer takes no longer for it."""
        stiffness, damping = chain(N + 1)[1:, 1:], numpy.zeros((N, N))
        damping[-1, -1] = 1e10
        model = plm.Model(numpy.eye(N), stiffness, damping + 1e-5 * stiffness)
        row = numpy.zeros((1, N))
        row[0, -1] = 1
        model.add_gap_rows(row, stiffness=1e6, gap=1e-3)
        model.set_excitation(10 * row[0])
        begin = time.process_time()
        model.context.progress = lambda stage, fraction: time.process_time() - begin > 10  # without end before
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", plm.PlmWarning)
            result = model.build().compute_response(N - 1)
        self.assertLess(abs(result.amplitude * 2 * math.pi * result.frequency_hz * 1e10 / 10 - 1), 1e-3)


if __name__ == "__main__":
    unittest.main()
