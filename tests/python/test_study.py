"""Error against run time."""
import os
import tempfile
import unittest

import numpy
import plm

import models


def prepared(**options):
    """(study, hbm of piecewise-linear modes) of the chain: errors of few harmonics against seven on all DOFs."""
    model = models.model().build()
    hbm = plm.Hbm(plm.Basis(model, plm.Sampler(model, system="open", mode=1)), n_harmonics=3, stability="off")
    study = plm.Study(model, repeats=1, curve_tolerance=1e-4, **options)
    study.set_output(models.WATCHED)
    return study, hbm


class Methods(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.study, hbm = prepared()
        cls.study.set_force_levels([0.5, 1.0])
        basis = plm.Basis(cls.study.model, plm.Sampler(cls.study.model, system="open", mode=1, n_samples=2))
        cls.index = [cls.study.add_response("three harmonics", hbm)]
        hbm.n_harmonics = 7
        cls.index.append(cls.study.add_response("seven harmonics", hbm))
        cls.index.append(cls.study.add_compressed("compressed", hbm, 3))
        cls.index.append(cls.study.add_refined("refined", hbm, 1e-2))
        motion = plm.Transient(basis, settled=1e-4, periods=500)
        cls.index.append(cls.study.add_marching("marching", motion, 2))
        sampler = plm.Sampler(cls.study.model, system="open", mode=1)  # gives the frequency range
        cls.study.set_reference(plm.Hbm(plm.Basis(cls.study.model, sampler, kind="full"), n_harmonics=7, stability="off"))
        stages = []
        cls.run_returned = cls.study.run(progress=lambda stage, fraction: stages.append(stage))
        cls.stages = stages

    def test_names_and_outcomes(self):
        study = self.study
        self.assertIs(self.run_returned, study)
        self.assertEqual(self.index, [0, 1, 2, 3, 4])
        self.assertEqual(study.names, ["three harmonics", "seven harmonics", "compressed", "refined", "marching"])
        self.assertEqual(study.status, plm.OK)
        self.assertEqual(study.outcome("seven harmonics"), study.outcome("reference"))
        self.assertEqual(study.outcome(-1), "reached the end of its range")
        self.assertTrue(self.stages)
        with self.assertRaisesRegex(ValueError, "marching"):
            study.outcome("marchin")

    def test_errors_are_those_of_the_curves(self):
        study = self.study
        self.assertEqual(study.amplitude_error.shape, (5,))
        self.assertGreater(study.amplitude_error[0], 3 * study.amplitude_error[1])  # four harmonics less
        worst = 0.0
        for level in (0, 1):
            top, reference = (study.points(m, level).amplitude.max() for m in (0, "reference"))
            worst = max(worst, abs(top / reference - 1))
        # points are as near as 1e-4 of the peak; the peaks of the study are exact
        self.assertLess(abs(study.amplitude_error[0] - worst), 1e-3)
        self.assertEqual(study.basis_size[2], 3)
        self.assertLess(study.amplitude_error[3], 1e-2)
        self.assertTrue((study.setup_seconds + study.curve_seconds > 0).all())

    def test_curves_and_points(self):
        study = self.study
        curve = study.curve("three harmonics", 1)
        self.assertEqual((curve.n_harmonics, curve.status), (3, plm.OK))
        points = study.points(0, 1)
        self.assertGreaterEqual(len(points.amplitude), len(curve))
        self.assertLess(abs(points.amplitude.max() / curve.amplitude(models.WATCHED).max() - 1), 0.05)
        self.assertEqual(len(study.points("marching").frequency_hz), 2)
        with self.assertRaises(plm.PlmError) as caught:
            study.curve("marching")
        self.assertIn("read its points", str(caught.exception))
        with self.assertRaises(plm.PlmError) as caught:
            study.points(0, 2)
        self.assertEqual(caught.exception.argument, "level")

    def test_results(self):
        for name, key in self.study.keys.items():
            kinds = {plm.TYPE_INT: int, plm.TYPE_DOUBLE: float, plm.TYPE_STRING: str}
            self.assertIsInstance(getattr(self.study, name), kinds.get(key.type, numpy.ndarray), name)

    def test_files(self):
        with tempfile.TemporaryDirectory() as folder:
            self.study.write(os.path.join(folder, "report"))
            files = os.listdir(os.path.join(folder, "report"))
            self.assertIn("report.md", files)
            self.assertIn("table.csv", files)
            self.assertEqual(sum(name.startswith("curve_reference") for name in files), 2)
            with self.assertRaises(plm.PlmError):
                self.study.write(os.path.join(folder, "none", "report"))


class Runs(unittest.TestCase):
    def test_bases_of_the_rivals(self):
        study, hbm = prepared()
        model, sampler = study.model, plm.Sampler(study.model, system="open", mode=1)
        amplitude = plm.Hbm(plm.Basis(model, sampler.run()).build(), n_harmonics=3).sweep().amplitude(models.WATCHED).max()
        kinds = {"bilinear": {}, "lelsm": {}, "lelsm_updated": {"equivalent_amplitude": amplitude},
                 "discontinuity": {"n_discontinuities": 2}}
        study.set_reference(plm.Hbm(plm.Basis(model, sampler, kind="full"), n_harmonics=3, stability="off"))
        for kind, options in kinds.items():
            study.add_response(kind, plm.Hbm(plm.Basis(model, sampler, kind=kind, **options), n_harmonics=3, stability="off"))
        study.add_response("piecewise-linear modes", hbm)
        study.run()
        self.assertEqual([study.outcome(name) for name in study.names], ["reached the end of its range"] * 5)
        error = dict(zip(study.names, study.curve_error_l2))
        self.assertTrue(error.pop("lelsm") < 0.2, "one equivalent system for all amplitudes is the coarsest of them")
        self.assertLess(max(error.values()), 2e-3)  # the others nearly span the chain's motions along x

    def test_a_method_that_fails_is_a_row(self):
        study, hbm = prepared()
        study.set_reference(hbm)
        study.add_response("good", hbm)
        study.add_response("bad", plm.Hbm(plm.Basis(study.model)))  # no sampler
        self.assertEqual(study.run().status, plm.WARNING)
        self.assertIn("needs a sampler; give the basis one", study.outcome("bad"))
        self.assertTrue(numpy.isnan(study.curve_error_l2[1]) and study.curve_error_l2[0] < 1e-6)

    def test_cancel(self):
        study, hbm = prepared()
        study.add_response("a", hbm)
        with self.assertRaises(plm.PlmCancelled):
            study.run(progress=lambda stage, fraction: True)
        with self.assertRaises(plm.PlmError):  # nothing is there
            study.outcome("a")
        with self.assertRaises(ZeroDivisionError):
            study.run(progress=lambda stage, fraction: 1 / 0)
        study.add_response("b", hbm)
        calls = []
        for _ in range(2):  # the first run also makes what the next ones share
            calls.clear()
            study.run(progress=lambda stage, fraction: calls.append(stage))
        count = len(calls)
        calls.clear()
        study.run(progress=lambda stage, fraction: calls.append(stage) or len(calls) > count - 5)  # in the last method
        self.assertEqual(study.status, plm.CANCELLED)
        self.assertLess(study.curve_error_l2[0], 1.0)
        self.assertIn("cancelled", study.outcome("b"))

    def test_refusals(self):
        study, hbm = prepared()
        with self.assertRaises(plm.PlmError) as caught:
            study.run()  # no method
        self.assertEqual(caught.exception.function, "plm_study_run")
        with self.assertRaises(plm.PlmKeyError):
            study.repeat = 3
        with self.assertRaisesRegex(TypeError, "^repeats is an integer, not 'three'"):
            study.set("repeats", "three")
        with self.assertRaises(plm.PlmKeyError):
            study.set("repeat", "three")
        with self.assertRaises(plm.PlmError):
            study._get_string(b"repeats")  # no key of a study is a text
        with self.assertRaises(ValueError):
            study.set_output(models.WATCHED, "height")
        with self.assertRaises(plm.PlmError):
            study.set_force_levels([1.0, -1.0])
        study.set_force_levels(2.0)
        self.assertEqual(study.n_levels, 1)
        study.add_response("a", hbm)
        with self.assertRaises(plm.PlmError) as caught:
            study.add_response("a", hbm)
        self.assertEqual(caught.exception.argument, "name")
        study.set_reference()
        with self.assertRaises(plm.PlmError) as caught:
            study.write("nowhere")
        self.assertIn("has not run", str(caught.exception))


if __name__ == "__main__":
    unittest.main()
