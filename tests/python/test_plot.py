"""The figures can be drawn, and show what they say."""
import os
import tempfile
import unittest

import matplotlib

matplotlib.use("Agg")
import numpy
import plm
from matplotlib import pyplot

import models


class Figures(unittest.TestCase):
    """What a test has drawn can be saved."""

    def tearDown(self):
        with tempfile.TemporaryDirectory() as folder:
            for number in pyplot.get_fignums():
                path = os.path.join(folder, f"{number}.png")
                pyplot.figure(number).savefig(path)
                self.assertGreater(os.path.getsize(path), 1000)
        pyplot.close("all")


class Plot(Figures):
    @classmethod
    def setUpClass(cls):
        cls.hbm = plm.Hbm(models.basis(), n_harmonics=5)
        cls.curve = cls.hbm.sweep()

    def test_response(self):
        peak = self.hbm.find_peak(self.curve, models.WATCHED)
        ax = plm.plot.response([self.curve, peak.branch], models.WATCHED, labels=["curve", "peak"], peaks=[peak], stable=False)
        numpy.testing.assert_array_equal(ax.lines[0].get_ydata(), self.curve.amplitude(models.WATCHED))
        self.assertIs(plm.plot.response(self.curve, models.WATCHED, "rms", ax=ax), ax)

    def test_stability(self):
        n = len(self.curve)
        stable = numpy.ones(n, dtype=bool)
        stable[n // 3:n // 2] = False
        ax = plm.plot.response(self.curve, models.WATCHED, stable=stable, labels=["curve"], bifurcations=False)
        self.assertEqual([line.get_linestyle() for line in ax.lines], ["-", "--", "-"])
        self.assertEqual(len({line.get_color() for line in ax.lines}), 1)
        drawn = numpy.concatenate([line.get_xdata()[:-1] for line in ax.lines[:-1]] + [ax.lines[-1].get_xdata()])
        numpy.testing.assert_array_equal(drawn, self.curve.frequency_hz)  # no gap and no point twice
        self.assertEqual(ax.lines[1].get_xdata()[0], self.curve.frequency_hz[n // 3])
        self.assertEqual(len(ax.get_legend().get_texts()), 1)
        both = plm.plot.response([self.curve, self.curve], models.WATCHED, stable=[False, ~stable], bifurcations=False)
        self.assertEqual([line.get_linestyle() for line in both.lines], ["-", "--", "-", "--"])
        with self.assertRaisesRegex(ValueError, "points"):
            plm.plot.response(self.curve, models.WATCHED, stable=stable[1:])

    def test_stability_and_bifurcations_by_default(self):
        hbm = plm.Hbm(models.between_stops())
        curve = hbm.sweep()
        crossing = curve.bifurcations[0].point
        ax = plm.plot.response([curve, hbm.switch_branch(curve, crossing)], 0, labels=["symmetric", "leaning"])
        self.assertEqual({line.get_linestyle() for line in ax.lines}, {"-", "--", "None"})
        dashed = numpy.concatenate([line.get_xdata() for line in ax.lines if line.get_linestyle() == "--"])
        self.assertTrue(set(curve.frequency_hz[curve.stable == 0]) <= set(dashed))
        (marks,) = [line for line in ax.lines if line.get_label() == "branch point"]
        self.assertIn(curve.frequency_hz[crossing], marks.get_xdata())
        self.assertEqual([text.get_text() for text in ax.get_legend().get_texts()].count("branch point"), 1)
        again = plm.plot.response(curve, 0, ax=ax)  # into the same axes: no second entry
        self.assertEqual([text.get_text() for text in again.get_legend().get_texts()].count("branch point"), 1)
        plain = plm.plot.response(curve, 0, stable=False, bifurcations=False)
        self.assertEqual([line.get_linestyle() for line in plain.lines], ["-"])
        self.assertIsNone(plain.get_legend())

    def test_contact_area(self):
        point = int(numpy.argmax(self.curve.amplitude(models.WATCHED)))
        ax = plm.plot.contact_area_over_cycle(self.curve, point, 512, area=[2.0, 3.0])
        area = numpy.array(ax.lines[0].get_ydata())
        self.assertTrue(set(area) <= {0, 2, 3, 5} and len(set(area)) > 1)
        mean = self.curve.closed_share(point) @ [2.0, 3.0]
        self.assertLess(abs(area[:-1].mean() - mean), 5 * 4 / 512)  # each switching instant is off by one sample at most
        self.assertEqual(plm.plot.contact_area_over_cycle(self.curve, point).get_ylabel(), "pairs in contact")

    def test_contact(self):
        ax = plm.plot.contact_over_frequency(self.curve)
        least, most, mean = (line.get_ydata() for line in ax.lines)
        self.assertTrue((least <= numpy.array(mean) + 1e-12).all() and (mean <= most + 1e-12).all())
        plm.plot.contact_over_cycle(self.curve, -1)

    def test_harmonics(self):
        ax = plm.plot.harmonics(self.curve, 0, [models.WATCHED, 0])
        self.assertEqual(len(ax.patches), 12)
        heights = [patch.get_height() for patch in ax.patches]
        numpy.testing.assert_allclose(heights[:6], numpy.abs(self.curve.harmonics(0, models.WATCHED)))

    def test_error_over_time(self):
        ax = plm.plot.error_over_time([1, 2, 3], [0.1, 0.01, 0], ["a", "b", "reference"])
        self.assertEqual([text.get_text() for text in ax.texts], ["a", "b"])
        numpy.testing.assert_array_equal(ax.lines[0].get_xdata(), [1, 2])
        self.assertEqual((ax.get_xscale(), ax.get_yscale()), ("log", "log"))

    def test_pareto_front(self):
        ax = plm.plot.error_over_time([1, 2, 3, 4], [0.1, 0.2, 0.01, float("nan")], list("abcd"), [1, 0, 1, 0])
        self.assertEqual([text.get_text() for text in ax.texts], ["a", "b", "c"])
        (front,) = [line for line in ax.lines if line.get_label() == "Pareto front"]
        numpy.testing.assert_array_equal(front.get_xdata(), [1, 3])
        numpy.testing.assert_array_equal(front.get_ydata(), [0.1, 0.01])


class StudyPlot(Figures):
    """Of a study of the chain: one to five harmonics, marching, and a method that fails."""

    HARMONICS = [1, 3, 5]

    @classmethod
    def setUpClass(cls):
        model = models.model().build()
        basis = plm.Basis(model, plm.Sampler(model, system="open", mode=1))
        cls.study = plm.Study(model, repeats=1, curve_tolerance=1e-3)
        cls.study.set_output(models.WATCHED)
        hbm = plm.Hbm(basis, stability="off")
        for hbm.n_harmonics in cls.HARMONICS:
            cls.study.add_response(f"H = {hbm.n_harmonics}", hbm)
        cls.study.add_marching("marching", plm.Transient(basis, settled=1e-3, periods=300), 2)
        cls.study.add_response("failed", plm.Hbm(plm.Basis(model)))
        hbm.n_harmonics = 7
        cls.study.set_reference(hbm)
        cls.study.run()

    def test_errors(self):
        study = self.study
        ax = plm.plot.study_errors(study)
        self.assertEqual((ax.get_xscale(), ax.get_yscale()), ("log", "log"))
        self.assertEqual(sorted(text.get_text() for text in ax.texts), sorted(study.names[:4]))  # not of the one that failed
        boxes = [text.get_window_extent(ax.figure.canvas.get_renderer()) for text in ax.texts]
        self.assertFalse(any(a.overlaps(b) for i, a in enumerate(boxes) for b in boxes[:i]))
        numpy.testing.assert_array_equal(ax.lines[0].get_ydata(), study.curve_error_l2[:4])
        (front,) = [line for line in ax.lines if line.get_label() == "Pareto front"]
        self.assertEqual(set(front.get_ydata()), set(study.curve_error_l2[study.pareto == 1]))
        self.assertIn("peak", plm.plot.study_errors(study, "amplitude_error").get_ylabel())

    def test_curves(self):
        study = self.study
        ax = plm.plot.study_curves(study)
        self.assertEqual([line.get_label() for line in ax.lines], ["reference", *study.names[:4]])
        self.assertEqual([line.get_linestyle() for line in ax.lines], ["-", "-", "-", "-", "None"])
        numpy.testing.assert_array_equal(ax.lines[2].get_ydata(), study.points("H = 3").amplitude)
        one = plm.plot.study_curves(study, methods=["H = 1"])
        self.assertEqual([text.get_text() for text in one.get_legend().get_texts()], ["reference", "H = 1"])

    def test_convergence(self):
        study = self.study
        ax = plm.plot.study_convergence(study, self.HARMONICS, methods=range(3), xlabel="harmonics")
        numpy.testing.assert_array_equal(ax.lines[0].get_xdata(), self.HARMONICS)
        numpy.testing.assert_array_equal(ax.lines[1].get_ydata(), study.amplitude_error[:3])
        self.assertGreater(ax.lines[1].get_ydata()[0], ax.lines[1].get_ydata()[2])  # it converges
        two = plm.plot.study_convergence(study, [9, 2], methods=["H = 1", "failed"], errors=["curve_error_l2"])
        numpy.testing.assert_array_equal(two.lines[0].get_xdata(), [9])
        with self.assertRaisesRegex(ValueError, "methods"):
            plm.plot.study_convergence(study, self.HARMONICS)


if __name__ == "__main__":
    unittest.main()
