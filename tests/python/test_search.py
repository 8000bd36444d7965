"""Stability, bifurcations, and the curves beside a response curve."""
import math
import unittest

import numpy
import plm

import models


class Stops(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.hbm = plm.Hbm(models.between_stops())
        cls.curve = cls.hbm.sweep()

    def test_bifurcations(self):
        kinds = {b.kind for b in self.curve.bifurcations}
        self.assertEqual(kinds, {"branch point"})
        for b in self.curve.bifurcations:
            self.assertEqual(self.curve.bifurcation[b.point], plm.BIFURCATION_BRANCH_POINT)
            self.assertEqual(self.curve.frequency_hz[b.point], b.frequency_hz)
        self.assertEqual(len(self.curve.bifurcations), numpy.count_nonzero(self.curve.bifurcation))

    def test_stability(self):
        self.assertEqual(set(self.curve.stable), {0, 1})
        for i, stable in enumerate(self.curve.stable):
            multipliers = self.curve.multipliers(i)
            self.assertTrue((numpy.diff(abs(multipliers)) <= 1e-12).all())
            if not self.curve.bifurcation[i]:  # at a bifurcation one of them is at the border
                self.assertEqual(abs(multipliers[0]) < 1, bool(stable))
        numpy.testing.assert_array_equal(self.curve.multipliers(-1), self.curve.multipliers(len(self.curve) - 1))
        self.assertEqual(self.hbm.solve(0.25).multipliers(0).size, 2)
        off = plm.Hbm(models.between_stops(), stability="off").sweep()
        self.assertEqual(off.multipliers(0).size, 0)
        self.assertEqual(set(off.stable), {-1})

    def test_switch_branch(self):
        point = self.curve.bifurcations[0].point
        left, right = (self.hbm.switch_branch(self.curve, point, mirrored) for mirrored in (False, True))
        means = [branch.amplitude(0, "harmonic", 0)[1] for branch in (left, right)]
        self.assertLess(means[0] * means[1], 0)
        with self.assertRaises(plm.PlmError):
            self.hbm.switch_branch(self.curve, 0)

    def test_periodicity_defect(self):
        self.assertLess(self.curve.periodicity_defect(0), 1e-2)

    def test_energy(self):
        energy = self.curve.energy(0)
        self.assertGreater(energy.energy, 0)
        self.assertAlmostEqual(energy.contact_area, self.curve.closed_share(0).mean(), places=9)


    def test_levels(self):
        """In the order asked for, each with the peak and the special points of a sweep of it alone, by fewer points."""
        scales = [0.5, 1.0, 0.75]
        curves = self.hbm.sweep_levels(scales)
        self.assertEqual([curve.force_scale for curve in curves], scales)
        self.assertEqual(self.hbm.n_found, 3)
        self.assertEqual(self.hbm.force_scale, 1)
        for basis, scales in (models.between_stops, scales), (models.carrier, [0.006, 0.005, 0.004]):
            hbm = plm.Hbm(basis())
            for curve, scale in zip(hbm.sweep_levels(scales), scales):
                alone = plm.Hbm(basis(), force_scale=scale)
                sweep = alone.sweep()
                self.assertEqual([b.kind for b in curve.bifurcations], [b.kind for b in sweep.bifurcations])
                numpy.testing.assert_allclose([b.frequency_hz for b in curve.bifurcations], [b.frequency_hz for b in sweep.bifurcations], rtol=1e-5)
                if scale != max(scales):
                    self.assertLess(len(curve), 0.8 * len(sweep))
                if basis == models.between_stops:  # its highest point stands at an end
                    continue
                one, other = hbm.find_peak(curve, 0), alone.find_peak(sweep, 0)
                self.assertLess(abs(one.amplitude / other.amplitude - 1), 1e-9)
                self.assertLess(abs(one.frequency_hz / other.frequency_hz - 1), 1e-8)  # of a flat top

    def test_levels_that_end_early(self):
        """Each is named, and delivered as far as it goes."""
        with self.assertWarnsRegex(plm.PlmWarning, "force_scale 1: max_points.*force_scale 0.5: max_points"):
            curves = plm.Hbm(models.between_stops(), max_points=5).sweep_levels([0.5, 1])
        self.assertEqual([len(curve) for curve in curves], [5, 5])


class Carrier(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.basis = models.carrier()
        cls.hbm = plm.Hbm(cls.basis, force_scale=0.006)
        cls.curve = cls.hbm.sweep()

    def test_isolated(self):
        (isolated,) = self.hbm.find_isolated(self.curve)
        low, high = isolated.force_range
        self.assertTrue(low < 0.006 < high)
        self.assertEqual(isolated.branch.end_reason, plm.REASON_LOOP_CLOSED)
        folds = [b.point for b in isolated.branch.bifurcations if b.kind == "fold"]
        tracked = self.hbm.track_fold(isolated.branch, folds[0], 0.003, 0.01)
        extrema = [tracked.point_force_scale[b.point] for b in tracked.bifurcations]
        self.assertLess(min(abs(force / high - 1) for force in extrema), 1e-6)

    def test_backbones(self):
        (backbone,) = self.hbm.find_backbones(0.02)
        self.assertLessEqual(backbone.point_force_scale.max(), 0.02 * (1 + 1e-9))
        self.assertEqual(len(backbone.point_force_scale), len(backbone))

    def test_marching(self):
        found = self.hbm.find_by_marching(self.curve, 12, 3)
        self.assertGreaterEqual(len(found), 1)
        self.assertEqual(len(self.hbm.find_by_marching([self.curve, *found], 12, 3)), 0)

    def test_nonlinear_mode(self):
        mode = self.hbm.nonlinear_mode(1, 0, 1.5)
        first = mode.amplitude(0, "harmonic", 1)
        self.assertTrue(first[-2] < 1.5)
        self.assertAlmostEqual(first[-1], 1.5, places=6)
        self.assertFalse(mode.point_force_scale.any())
        self.assertEqual(len(mode.damping_ratio), len(mode))
        self.assertTrue((mode.damping_ratio > 0).all())
        self.assertEqual(len(self.curve.damping_ratio), 0)  # a driven motion has none
        # as long as it is closed: the linear mode about rest, and its energy
        rest_hz = self.basis.model.modes(2, "rest")
        self.assertLess(abs(mode.frequency_hz[0] / rest_hz[0] - 1), 1e-6)
        x = mode.coefficients(0)[1]
        energy = [mode.energy(i) for i in range(len(mode))]
        kinetic = 0.5 * (2 * math.pi * rest_hz[0]) ** 2 * (x[0] ** 2 + 0.2 * x[1] ** 2)
        self.assertLess(abs(energy[0].energy / kinetic - 1), 1e-4)
        self.assertAlmostEqual(energy[0].contact_area, 1, places=12)
        self.assertTrue(0 < energy[-1].contact_area < 1)
        self.assertTrue(all(math.isfinite(e.energy) for e in energy))
        self.assertGreater(energy[-1].energy, 10 * energy[0].energy)
        # by itself: from half of the amplitude at which it opens, to a hundred times
        automatic = self.hbm.nonlinear_mode(1, 0).amplitude(0, "harmonic", 1)
        self.assertAlmostEqual(automatic[0], 0.125, places=4)
        self.assertGreater(automatic[-1], 10)


if __name__ == "__main__":
    unittest.main()
