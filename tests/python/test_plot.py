"""The figures can be drawn, and show what they say."""
import os
import tempfile
import unittest

import matplotlib

matplotlib.use("Agg")
import numpy
import plm
from matplotlib import pyplot
from matplotlib.text import Text
from plm.plot.style import LINE as PIECES

import models


def points_of(line):
    """The points of the branch among those of a smooth line."""
    return line.get_xdata()[::PIECES], line.get_ydata()[::PIECES]


class Figures(unittest.TestCase):
    """What a test has drawn is fit to print, and can be saved."""

    def tearDown(self):
        try:
            for number in pyplot.get_fignums():
                self.check_print(pyplot.figure(number))
        finally:
            pyplot.close("all")

    def check_print(self, figure):
        """8 pt and more, nothing cut off, no text on another, no legend on what is drawn."""
        figure.canvas.draw()
        renderer = figure.canvas.get_renderer()
        beyond = self.labels_beyond(figure)
        texts = [text for text in figure.findobj(Text) if text.get_visible() and text.get_text().strip() and text not in beyond]
        boxes = [Text.get_window_extent(text, renderer) for text in texts]
        for text, box in zip(texts, boxes):
            self.assertGreaterEqual(text.get_fontsize(), 8, text)
            inside = box.x0 > -1 and box.y0 > -1 and box.x1 < figure.bbox.x1 + 1 and box.y1 < figure.bbox.y1 + 1
            self.assertTrue(inside, f"{text} at {box} is cut off by {figure.bbox}")
        for i, box in enumerate(boxes):
            for other, text in zip(boxes[:i], texts):
                self.assertFalse(box.overlaps(other), f"{texts[i]} lies on {text}")
        for ax in figure.axes:
            legend = ax.get_legend()
            if legend:  # covers nothing that is drawn
                self.assertFalse(legend.get_window_extent(renderer).overlaps(ax.get_window_extent(renderer).shrunk(0.999, 0.999)))

    @staticmethod
    def labels_beyond(figure):
        """matplotlib keeps labels of ticks that lie outside the axes, and draws none of them."""
        labels, drawn = set(), set()
        for ax in figure.axes:
            for axis in ax._axis_map.values():
                labels |= {axis.label} | {label for tick in axis.majorTicks + axis.minorTicks for label in (tick.label1, tick.label2)}
                if ax.axison and axis.get_visible():
                    drawn |= {axis.label} | {label for tick in axis._update_ticks() for label in (tick.label1, tick.label2)}
        return labels - drawn


class Plot(Figures):
    @classmethod
    def setUpClass(cls):
        cls.hbm = plm.Hbm(models.basis(), n_harmonics=5)
        cls.curve = cls.hbm.sweep()

    def test_response(self):
        peak = self.hbm.find_peak(self.curve, models.WATCHED)
        ax = plm.plot.response([self.curve, peak.branch], models.WATCHED, labels=["curve", "peak"], peaks=[peak], stable=False)
        numpy.testing.assert_array_equal(points_of(ax.lines[0])[1], self.curve.amplitude(models.WATCHED) * 1e3)
        numpy.testing.assert_array_equal(points_of(ax.lines[0])[0], self.curve.frequency_hz)
        self.assertEqual(ax.get_ylabel(), f"half peak-to-peak of DOF {models.WATCHED} (mm)")
        self.assertEqual(ax.get_xlabel(), "frequency (Hz)")
        words = [text.get_text() for text in ax.get_legend().get_texts()]
        self.assertIn(f"peak: {1e3 * peak.amplitude:.4g} mm at {peak.frequency_hz:.5g} Hz", words)
        self.assertIs(plm.plot.response(self.curve, models.WATCHED, "rms", ax=ax, units=("m", "mm")), ax)

    def test_what_tells_curves_apart_in_grey(self):
        ax = plm.plot.response([self.curve] * 3, models.WATCHED, labels=list("abc"), bifurcations=False, stable=False)
        looks = [(line.get_marker(), line.get_color()) for line in ax.lines if line.get_label() in list("abc")]
        self.assertEqual([len(set(each)) for each in zip(*looks)], [3, 3])

    def test_a_smooth_line_goes_through_the_points_and_not_beyond(self):
        ax = plm.plot.response(self.curve, models.WATCHED, stable=False, bifurcations=False, units="")
        y, line = self.curve.amplitude(models.WATCHED), ax.lines[0].get_ydata()
        self.assertGreater(len(line), 4 * len(y))
        between = line[:-1].reshape(len(y) - 1, -1)
        slack = 1e-12 * y.max()
        self.assertTrue((between >= numpy.minimum(y[1:], y[:-1])[:, None] - slack).all())
        self.assertTrue((between <= numpy.maximum(y[1:], y[:-1])[:, None] + slack).all())
        self.assertEqual(ax.get_ylabel(), f"half peak-to-peak of DOF {models.WATCHED}")

    def test_units(self):
        y = self.curve.amplitude(models.WATCHED)
        for units, factor, name in (("m", 1e3, "mm"), ("mm", 1e3, "µm"), (("mm", "mm"), 1, "mm"), (("m", "um"), 1e6, "µm")):
            ax = plm.plot.response(self.curve, models.WATCHED, units=units)
            numpy.testing.assert_allclose(points_of(ax.lines[0])[1][0], factor * y[0], rtol=1e-15)
            self.assertTrue(ax.get_ylabel().endswith(f"({name})"), ax.get_ylabel())
        with self.assertRaisesRegex(ValueError, "units has 'inch'; lengths are in m, mm, um"):
            plm.plot.response(self.curve, models.WATCHED, units="inch")

    def test_stability(self):
        n = len(self.curve)
        stable = numpy.ones(n, dtype=bool)
        stable[n // 3:n // 2] = False
        ax = plm.plot.response(self.curve, models.WATCHED, stable=stable, labels=["curve"], bifurcations=False)
        parts = [line for line in ax.lines if len(line.get_xdata())]
        self.assertEqual([line.get_linestyle() for line in parts], ["-", "--", "-"])
        self.assertEqual(len({line.get_color() for line in parts}), 1)
        drawn = numpy.concatenate([line.get_xdata()[:-1] for line in parts[:-1]] + [parts[-1].get_xdata()])
        numpy.testing.assert_array_equal(drawn[::PIECES], self.curve.frequency_hz)  # no gap and no point twice
        self.assertEqual(parts[1].get_xdata()[0], self.curve.frequency_hz[n // 3])
        self.assertEqual([text.get_text() for text in ax.get_legend().get_texts()], ["curve", "unstable"])
        both = plm.plot.response([self.curve, self.curve], models.WATCHED, stable=[False, ~stable], bifurcations=False)
        self.assertEqual([line.get_linestyle() for line in both.lines if len(line.get_xdata()) > 9], ["-", "--", "-", "--"])
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
        words = [text.get_text() for text in ax.get_legend().get_texts()]
        self.assertEqual((words.count("branch point"), words.count("unstable")), (1, 1))
        again = plm.plot.response(curve, 0, ax=ax)  # into the same axes: no second entry
        self.assertEqual([text.get_text() for text in again.get_legend().get_texts()].count("branch point"), 1)
        plain = plm.plot.response(curve, 0, stable=False, bifurcations=False)
        self.assertEqual([line.get_linestyle() for line in plain.lines], ["-"])
        self.assertIsNone(plain.get_legend())

    def test_levels(self):
        branches = plm.Hbm(models.basis(), n_harmonics=3, stability="off").sweep_levels([1, 2])
        ax = plm.plot.levels(branches, models.WATCHED, force=10, units="")
        lines = [line for line in ax.lines if len(line.get_xdata()) > 9]
        for line, branch in zip(lines, branches):
            numpy.testing.assert_array_equal(points_of(line)[1], branch.amplitude(models.WATCHED))
        self.assertEqual([text.get_text() for text in ax.get_legend().get_texts()][:2], ["10 N", "20 N"])
        scaled = plm.plot.levels(branches, models.WATCHED, normalised=True, units="", bifurcations=False)
        line = [line for line in scaled.lines if len(line.get_xdata()) > 9][-1]
        self.assertAlmostEqual(line.get_ydata()[-1], branches[1].amplitude(models.WATCHED)[-1] / 2)

    def test_backbone(self):
        backbones = plm.Hbm(models.carrier(), force_scale=0.006).find_backbones(force_max=0.012)
        ax = plm.plot.backbone(backbones, 0, force=1.0, units="")
        numpy.testing.assert_array_equal(points_of(ax.lines[0])[0], backbones[0].point_force_scale)
        (folds,) = [line for line in ax.lines if line.get_label() == "fold of the force"]
        self.assertEqual(len(folds.get_xdata()), 2)  # birth and merging of the isolated branch
        self.assertGreater(folds.get_xdata()[0], folds.get_xdata()[1])
        self.assertEqual(ax.get_xlabel(), "force (N)")
        over = plm.plot.backbone(backbones, 0, over="frequency", units="")
        numpy.testing.assert_array_equal(points_of(over.lines[0])[0], backbones[0].frequency_hz)
        with self.assertRaisesRegex(ValueError, "over must be"):
            plm.plot.backbone(backbones, 0, over="time")

    def test_multipliers(self):
        curve = plm.Hbm(models.between_stops()).sweep()
        ax = plm.plot.multipliers(curve)
        drawn = {line.get_label(): line.get_xdata() + 1j * line.get_ydata() for line in ax.lines}
        self.assertLess(abs(drawn["stable motions"]).max(), 1)
        self.assertEqual(len(drawn["unstable motions"]), sum(len(curve.multipliers(i)) for i in numpy.flatnonzero(curve.stable == 0)))
        self.assertGreater(abs(drawn["unstable motions"]).max(), 1)
        one = plm.plot.multipliers(curve, 0).lines[1]
        numpy.testing.assert_array_equal(one.get_xdata(), curve.multipliers(0).real)
        with self.assertRaisesRegex(ValueError, "option stability"):
            plm.plot.multipliers(plm.Hbm(models.basis(), n_harmonics=3, stability="off").sweep())

    def test_contact_area(self):
        point = int(numpy.argmax(self.curve.amplitude(models.WATCHED)))
        ax = plm.plot.contact_area_over_cycle(self.curve, point, 512, area=[2.0, 3.0], units="")
        area = numpy.array(ax.lines[0].get_ydata())
        self.assertTrue(set(area) <= {0, 2, 3, 5} and len(set(area)) > 1)
        mean = self.curve.closed_share(point) @ [2.0, 3.0]
        self.assertLess(abs(area[:-1].mean() - mean), 5 * 4 / 512)  # each switching instant is off by one sample at most
        self.assertEqual(plm.plot.contact_area_over_cycle(self.curve, point).get_ylabel(), "pairs in contact")
        in_mm = plm.plot.contact_area_over_cycle(self.curve, point, 512, area=[2e-6, 3e-6])
        self.assertEqual(in_mm.get_ylabel(), "contact area (mm²)")
        numpy.testing.assert_allclose(in_mm.lines[0].get_ydata(), area, atol=1e-9)

    def test_contact(self):
        ax = plm.plot.contact_over_frequency(self.curve)
        least, most, mean = (line.get_ydata() for line in ax.lines)
        self.assertTrue((least <= numpy.array(mean) + 1e-9).all() and (mean <= most + 1e-9).all())
        self.assertGreater(max(mean), 1)  # per cent
        cycle = plm.plot.contact_over_cycle(self.curve, -1)
        numpy.testing.assert_array_equal(cycle.images[0].get_array(), self.curve.contact(-1, 256).closed)

    def test_contact_map(self):
        xyz = numpy.array([[1.0, 0.0, 5.0], [3.0, 0.5, 5.0]])
        ax = plm.plot.contact_map(self.curve, 3, xyz)
        numpy.testing.assert_allclose(ax.collections[0].get_array(), 100 * self.curve.closed_share(3))
        numpy.testing.assert_allclose(ax.collections[0].get_offsets(), xyz[:, :2])
        self.assertEqual((ax.get_xlabel(), ax.get_ylabel()), ("x (m)", "y (m)"))
        contact = self.curve.contact(3, 720)
        k = int(numpy.argmax(contact.closed.sum(axis=0) == 1))  # one of the two is closed
        at = plm.plot.contact_map(self.curve, 3, xyz, time_fraction=k / 720)
        (closed,) = [dots for dots in at.collections if dots.get_label() == "closed"]
        numpy.testing.assert_allclose(closed.get_offsets(), xyz[contact.closed[:, k] == 1, :2])
        with self.assertRaisesRegex(ValueError, "2 x 3"):
            plm.plot.contact_map(self.curve, 3, xyz[:1])

    def test_harmonics(self):
        ax = plm.plot.harmonics(self.curve, 0, [models.WATCHED, 0], units="")
        self.assertEqual(len(ax.patches), 12)
        heights = [patch.get_height() for patch in ax.patches]
        numpy.testing.assert_allclose(heights[:6], numpy.abs(self.curve.harmonics(0, models.WATCHED)))

    def test_phase_portrait(self):
        """Velocity against that by the coefficients, a1 cos + b1 sin + ..."""
        ax = plm.plot.phase_portrait(self.curve, [2, 5], models.WATCHED, units="")
        c, omega = self.curve.coefficients(5, models.WATCHED), 2 * numpy.pi * self.curve.frequency_hz[5]
        h, t = numpy.arange(1, (len(c) + 1) // 2), 2 * numpy.pi * numpy.arange(1024) / 1024
        v = omega * ((c[2::2] * h) @ numpy.cos(numpy.outer(h, t)) - (c[1::2] * h) @ numpy.sin(numpy.outer(h, t)))
        numpy.testing.assert_allclose(ax.lines[1].get_ydata()[:-1], v, atol=1e-9 * abs(v).max())
        numpy.testing.assert_array_equal(ax.lines[1].get_xdata()[:-1], self.curve.history(5, models.WATCHED, 1024))
        self.assertEqual(plm.plot.phase_portrait(self.curve, 5, models.WATCHED).get_ylabel(), "velocity (mm/s)")

    def test_field(self):
        q = self.curve.field(4, 0.3)
        x = numpy.arange(models.NODES) / 4
        line = plm.plot.field(self.curve, 4, x, range(0, models.DOFS, 3), 0.3, units=("m", "m"))
        numpy.testing.assert_array_equal(line.lines[1].get_ydata(), q[::3])
        xyz = numpy.stack([x, numpy.sin(x), numpy.cos(x)], axis=1)
        solid = plm.plot.field(self.curve, 4, xyz, numpy.arange(models.DOFS).reshape(-1, 3), 0.3, scale=2.0, units=("m", "m"))
        moved = numpy.transpose(solid.collections[1]._offsets3d)
        numpy.testing.assert_allclose(moved, xyz + 2 * q.reshape(-1, 3))
        plane = plm.plot.field(self.curve, 4, xyz[:, :2], numpy.arange(models.DOFS).reshape(-1, 3)[:, :2], 0.3,
                               faces=[[0, 1, 2], [2, 3, 4, 5]])
        self.assertEqual(len(plane.collections[1].get_array()), 2)
        with self.assertRaisesRegex(ValueError, "DOFs from 0 to 23"):
            plm.plot.field(self.curve, 4, x, range(20, 28))

    def test_error_over_time(self):
        ax = plm.plot.error_over_time([1, 2, 3], [0.1, 0.01, 0], ["a", "b", "reference"], reference=2.5)
        self.assertEqual([text.get_text() for text in ax.texts], ["a", "b"])
        numpy.testing.assert_array_equal(ax.lines[0].get_xdata(), [1, 2])
        self.assertEqual((ax.get_xscale(), ax.get_yscale()), ("log", "log"))
        (line,) = [line for line in ax.lines if line.get_label().startswith("the reference")]
        self.assertEqual(line.get_xdata(), [2.5, 2.5])

    def test_pareto_front(self):
        ax = plm.plot.error_over_time([1, 2, 3, 4], [0.1, 0.2, 0.01, float("nan")], list("abcd"), [1, 0, 1, 0])
        self.assertEqual([text.get_text() for text in ax.texts], ["a", "b", "c"])
        front = ax.lines[1]  # level, then down
        numpy.testing.assert_array_equal(front.get_xdata(), [1, 3, 3])
        numpy.testing.assert_array_equal(front.get_ydata(), [0.1, 0.1, 0.01])

    def test_names_lie_on_nothing(self):
        """Ten points so near to each other that not all names have a place beside them."""
        ax = plm.plot.error_over_time([1 + 0.02 * i for i in range(10)], [0.1 / (1 + 0.05 * i) for i in range(10)],
                                      [f"method {i}" for i in range(10)], [1] * 10)
        self.assertGreater(len(ax.texts), 3)  # and check_print() looks at their boxes

    def test_files(self):
        ax = plm.plot.response(self.curve, models.WATCHED)
        with tempfile.TemporaryDirectory() as folder:
            paths = plm.plot.save(ax, os.path.join(folder, "curve.png"))
            self.assertEqual([path.name for path in paths], ["curve.png", "curve.pdf", "curve.svg"])
            first = [path.read_bytes() for path in paths]
            for data, begin in zip(first, (b"\x89PNG\r\n", b"%PDF-1", b"<?xml")):
                self.assertTrue(data.startswith(begin))
            self.assertNotIn(b"/Type3", first[1])  # fonts that printers take
            again = plm.plot.save(plm.plot.response(self.curve, models.WATCHED), paths[0])
            self.assertEqual(first, [path.read_bytes() for path in again])  # the same picture, the same file
        self.assertEqual(pyplot.rcParams["font.size"], pyplot.rcParamsDefault["font.size"])  # of the host: as it was


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
        numpy.testing.assert_array_equal(ax.lines[0].get_ydata(), study.curve_error_l2[:4])
        front = ax.lines[1]
        self.assertEqual(set(front.get_ydata()), set(study.curve_error_l2[study.pareto == 1]))
        self.assertIn("peak", plm.plot.study_errors(study, "amplitude_error").get_ylabel())

    def test_curves(self):
        study = self.study
        ax = plm.plot.study_curves(study)
        self.assertEqual([line.get_label() for line in ax.lines], ["reference", *study.names[:4]])
        self.assertEqual(len({(line.get_linestyle(), line.get_marker()) for line in ax.lines}), 5)
        numpy.testing.assert_allclose(ax.lines[2].get_ydata(), 1e3 * study.points("H = 3").amplitude, rtol=1e-15)
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
