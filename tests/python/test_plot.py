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


class Plot(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.hbm = plm.Hbm(models.basis(), n_harmonics=5)
        cls.curve = cls.hbm.sweep()

    def tearDown(self):
        with tempfile.TemporaryDirectory() as folder:
            for number in pyplot.get_fignums():
                path = os.path.join(folder, f"{number}.png")
                pyplot.figure(number).savefig(path)
                self.assertGreater(os.path.getsize(path), 1000)
        pyplot.close("all")

    def test_response(self):
        peak = self.hbm.find_peak(self.curve, models.WATCHED)
        ax = plm.plot.response([self.curve, peak.branch], models.WATCHED, labels=["curve", "peak"], peaks=[peak])
        numpy.testing.assert_array_equal(ax.lines[0].get_ydata(), self.curve.amplitude(models.WATCHED))
        self.assertIs(plm.plot.response(self.curve, models.WATCHED, "rms", ax=ax), ax)

    def test_contact(self):
        ax = plm.plot.contact_over_frequency(self.curve)
        least, most, mean = (line.get_ydata() for line in ax.lines)
        self.assertTrue((least <= numpy.array(mean) + 1e-12).all() and (mean <= most + 1e-12).all())
        plm.plot.contact_over_cycle(self.curve, -1)

    def test_harmonics(self):
        ax = plm.plot.harmonics(self.curve, 0, [models.WATCHED, 0])
        self.assertEqual(len(ax.patches), 12)

    def test_error_over_time(self):
        self.assertEqual(len(plm.plot.error_over_time([1, 2], [0.1, 0.01], ["a", "b"]).texts), 2)


if __name__ == "__main__":
    unittest.main()
