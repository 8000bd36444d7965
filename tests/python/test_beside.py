"""What lies beside a curve, and where a curve ends: said, and true."""
import math
import unittest
import warnings

import numpy
import plm
import scipy.integrate
import scipy.sparse

import models


def quiet(call):
    """What a call returns, and the texts that it warned of."""
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always", plm.PlmWarning)
        return call(), [str(w.message) for w in said]


def largest_on(branch, dof):
    """Its highest stable amplitude."""
    return branch.amplitude(dof)[branch.stable == 1].max()


class LargerMotion(unittest.TestCase):
    """1 kg pressed against a stop by 50 N carries 0.2 kg. Between 0.674 and 1.451 times the force of 0.6 N there is a closed
    curve beside the main one, whose motions are twice as large."""

    @staticmethod
    def model(force):
        k = 1e4
        m = plm.Model(scipy.sparse.diags([1, 0.2]).tocsc(),
                      scipy.sparse.csc_matrix(k * numpy.array([[3.048, -2.048], [-2.048, 2.048]])))
        m.set_rayleigh_damping(0, 4e-5)
        m.add_gap_rows(scipy.sparse.csr_matrix([[1.0, 0]]), [k])
        m.set_preload([50, 0])
        m.set_excitation([force, 0])
        return m.build()

    def response(self, force):
        return quiet(lambda: self.model(force).compute_response(0))

    def test_is_said(self):
        r, said = self.response(0.6)
        self.assertEqual((r.curve.status, r.hbm.warning_reason), (plm.WARNING, plm.REASON_LARGER_MOTION))
        self.assertRegex(said[0], "stable motion of 0.0126")
        larger = r.larger
        numpy.testing.assert_allclose(larger.force_range, (0.67424, 1.4511), rtol=1e-3)
        self.assertAlmostEqual(larger.amplitude / largest_on(larger.branch, 0), 1, delta=1e-2)  # between its points
        self.assertGreater(larger.amplitude, 2 * r.amplitude)
        self.assertEqual(larger.branch.end_reason, plm.REASON_LOOP_CLOSED)
        (found,) = r.hbm.find_isolated(r.curve)  # which begins at the other resonances, too
        self.assertAlmostEqual(largest_on(found.branch, 0) / larger.amplitude, 1, delta=1e-2)
        self.assertAlmostEqual(r.larger.amplitude / larger.amplitude, 1, delta=1e-6)  # of that search, the same
        numpy.testing.assert_allclose(r.larger.force_range, larger.force_range, rtol=1e-3)

    def test_a_search_for_isolated_branches_knows_it_too(self):
        """Of a curve that was swept by itself, once its peak is known; and the page of the curve says so."""
        r, _ = self.response(0.6)
        model = self.model(0.6)
        hbm = plm.Hbm(plm.Basis(model, plm.Sampler(model).run()).build(), accuracy=1e-3)
        curve, _ = quiet(hbm.sweep)
        quiet(lambda: hbm.find_isolated(curve))
        self.assertEqual(hbm.larger_amplitude, 0)
        self.assertIn("curves beside this one were not looked for", curve.describe())
        quiet(lambda: hbm.find_peak(curve, 0))
        quiet(lambda: hbm.find_isolated(curve))
        self.assertAlmostEqual(hbm.larger_amplitude / r.larger.amplitude, 1, delta=1e-3)
        self.assertRegex(curve.describe(), "a larger stable one beside the curve: 0.0126")
        hbm.find_backbones()
        self.assertEqual(hbm.larger_amplitude, 0)  # the list is that of the last search

    def test_is_stable_in_time(self):
        """Runge and Kutta's method from the point's own state, disturbed by 0.5 %: after 300 periods it is that motion, to which
        each leads nearer by 1 %."""
        r, _ = self.response(0.6)
        branch = r.larger.branch
        stable = numpy.where(branch.stable == 1, branch.amplitude(0), 0)
        top = int(stable.argmax())
        omega = 2 * math.pi * branch.frequency_hz[top]
        stiffness = 1e4 * numpy.array([[3.048, -2.048], [-2.048, 2.048]])
        mass = numpy.array([1, 0.2])

        def motion(t, y):
            q, v = y[:2], y[2:]
            pressed = numpy.array([1e4 * max(q[0], 0), 0])
            load = numpy.array([50 + 0.6 * math.cos(omega * t), 0])
            return numpy.r_[v, (load - pressed - stiffness @ (q + 4e-5 * v)) / mass]

        h = 1e-5
        at = [branch.field(top, f) for f in (0, h, 1 - h)]
        start = numpy.r_[at[0], (at[1] - at[2]) / (2 * h) * omega / (2 * math.pi)] * 1.005
        period = 2 * math.pi / omega
        run = scipy.integrate.solve_ivp(motion, (0, 301 * period), start, rtol=1e-7, atol=1e-9,
                                        t_eval=numpy.linspace(300, 301, 400) * period)
        self.assertAlmostEqual(numpy.ptp(run.y[0]) / 2 / stable[top], 1, delta=1e-3)

    def test_is_not_said_where_there_is_none(self):
        for force in (0.3, 1.0):  # below the birth, above the merger
            r, said = self.response(force)
            self.assertEqual((r.curve.status, said), (plm.OK, []), force)
            self.assertIsNone(r.larger)
            self.assertEqual(r.hbm.n_found, 0)
            self.assertEqual((r.hbm.larger_amplitude, r.hbm.larger_frequency_hz), (0, 0))


class SweepOnALoop(unittest.TestCase):
    """A chain with one stop and loads in harmonics 1, 2, 4 and 5: at the upper end of its window stands a closed curve, which
    the first solution there lies on."""

    def test_it_goes_on_from_the_other_end(self):
        model = models.chain_with_a_loop()
        hbm = plm.Hbm(plm.Basis(model, plm.Sampler(model).run()).build())
        curve, said = quiet(hbm.sweep)
        self.assertEqual((curve.end_reason, curve.status, said), (plm.REASON_RANGE_END, plm.OK, []))
        ends = curve.frequency_hz[[0, -1]]
        self.assertLess(ends[0], curve.frequency_hz[1:-1].min())
        self.assertGreater(ends[1], curve.frequency_hz[1:-1].max())
        peak, _ = quiet(lambda: hbm.find_peak(curve, 5))
        response, _ = quiet(lambda: model.compute_response(5))
        self.assertAlmostEqual(peak.amplitude / response.amplitude, 1, delta=1e-6)
        self.assertGreater(peak.amplitude, 7e-4)  # of the loop: 3.78e-4


class BroadPeak(unittest.TestCase):
    """Damping ratio 0.27: the peak of a DOF stands far from that of the motion as a whole."""

    def test_the_curve_goes_on_to_the_peak_asked_for(self):
        model = models.damped_chain(0.27)
        r, said = quiet(lambda: model.compute_response(0))
        self.assertEqual((r.curve.status, said), (plm.OK, []))
        wide = plm.Hbm(plm.Basis(model, kind="full", frequency_max_hz=60).build(), frequency_min_hz=1, frequency_max_hz=40)
        truth = wide.find_peak(wide.sweep(), 0)
        self.assertAlmostEqual(r.amplitude / truth.amplitude, 1, delta=1e-5)
        self.assertAlmostEqual(r.frequency_hz / truth.frequency_hz, 1, delta=1e-4)
        self.assertLess(r.error, 1e-3)

    def test_no_number_where_the_peak_lies_elsewhere(self):
        """Beyond a ratio of 0.71 the response falls from zero frequency on: there is no peak to be wrong."""
        r, said = quiet(lambda: models.damped_chain(0.8).compute_response(0))
        self.assertEqual(r.hbm.warning_reason, plm.REASON_NO_PEAK)
        self.assertTrue(math.isnan(r.error))


class Coefficients(unittest.TestCase):
    """A mass that strikes a stop two thousand times as stiff as its spring, followed exactly: its Fourier series is cut."""

    @classmethod
    def setUpClass(cls):
        m = plm.Model(numpy.eye(1), numpy.eye(1), 0.02 * numpy.eye(1))
        m.add_gap_rows(numpy.eye(1), 2e3)
        m.set_excitation([1.0])
        cls.hbm = plm.Hbm(models.full(m, 0.25, 0.4))
        cls.curve, cls.said = quiet(cls.hbm.sweep)

    @staticmethod
    def left_out(branch, point):
        """Root mean square of the exact motion less its series, over that of the motion about its mean."""
        c, t = branch.coefficients(point, 0), numpy.arange(4000) / 4000
        h = numpy.arange(1, (len(c) - 1) // 2 + 1)
        angle = 2 * math.pi * t[:, None] * h
        series = c[0] + numpy.cos(angle) @ c[1::2] + numpy.sin(angle) @ c[2::2]
        motion = numpy.array([branch.field(point, f)[0] for f in t])
        return numpy.std(motion - series) / numpy.std(motion)

    def test_harmonic_error_tells_what_they_leave_out(self):
        self.assertEqual(self.said, [])  # amplitudes are those of the motion itself
        top = int(self.curve.amplitude(0).argmax())
        told = self.curve.harmonic_error[top]
        self.assertGreater(told, 1e-5)
        self.assertAlmostEqual(self.left_out(self.curve, top) / told, 1, delta=0.05)

    def test_more_can_be_had(self):
        top = int(self.curve.amplitude(0).argmax())
        more = plm.Hbm(self.hbm._basis, max_harmonics=600).solve(self.curve.frequency_hz[top], self.curve, top)
        self.assertGreater(more.n_harmonics, self.curve.n_harmonics)
        self.assertLess(more.harmonic_error[0], self.curve.harmonic_error[top] / 3)
        self.assertAlmostEqual(self.left_out(more, 0) / more.harmonic_error[0], 1, delta=0.1)


class StepByStep(unittest.TestCase):
    """37 masses in a row, the twentieth against a stop a thousand times as stiff as the chain there, damping ratio 5 %: the
    basis of 17 coordinates is 0.4 % off at DOF 0."""

    def test_what_the_basis_makes_wrong_is_told(self):
        n = 37
        stiffness = 1e4 * (2 * numpy.eye(n) - numpy.eye(n, k=1) - numpy.eye(n, k=-1))
        stiffness[-1, -1] = 1e4
        m = plm.Model(numpy.eye(n), stiffness)
        m.set_modal_damping(0.05)
        m.add_gap_rows(numpy.eye(n)[19:20], 1000 / numpy.linalg.inv(stiffness)[19, 19])
        m.set_excitation(numpy.eye(n)[34])
        m.build()
        hbm = plm.Hbm(plm.Basis(m, plm.Sampler(m).run()).build())
        curve, _ = quiet(hbm.sweep)
        self.assertEqual(curve.end_reason, plm.REASON_RANGE_END)
        peak, said = quiet(lambda: hbm.find_peak(curve, 0))
        low, high = curve.frequency_hz.min(), curve.frequency_hz.max()
        whole = plm.Hbm(plm.Basis(m, kind="full", frequency_max_hz=3 * high).build(), frequency_min_hz=low, frequency_max_hz=high)
        truth, _ = quiet(lambda: whole.find_peak(whole.sweep(), 0))
        self.assertGreater(abs(peak.amplitude / truth.amplitude - 1), hbm.accuracy)
        self.assertEqual(hbm.warning_reason, plm.REASON_BASIS_TOO_SMALL)
        told = hbm.estimate_error(peak.branch, 0, 0).amplitude.total
        self.assertAlmostEqual(told / (truth.amplitude - peak.amplitude), 1, delta=0.1)


class TopOfACurve(unittest.TestCase):
    """Where no solutions are found around the highest point, that is the result, and may be lower than the peak."""

    def test_a_peak_that_was_not_closed_in_upon_is_said(self):
        hbm = plm.Hbm(models.basis(), max_step=0.5)
        curve, _ = quiet(hbm.sweep)
        peak, said = quiet(lambda: hbm.find_peak(curve, models.WATCHED))
        self.assertEqual(said, [])
        hbm.max_iterations = 1
        hbm.accuracy = 1e-4
        top, said = quiet(lambda: hbm.find_peak(curve, models.WATCHED))
        self.assertGreater(peak.amplitude / top.amplitude - 1, hbm.accuracy)
        self.assertEqual(hbm.warning_reason, plm.REASON_UNVERIFIED)
        self.assertRegex(said[0], "only the highest point")
        hbm.accuracy = 1e-2  # to which it is right
        self.assertEqual(quiet(lambda: hbm.find_peak(curve, models.WATCHED))[1], [])

    def test_where_a_free_structure_moves_as_a_whole_its_resonance_is_named(self):
        """Two free masses that strike each other: far below their resonance each moves by force over mass and frequency squared."""
        m = plm.Model(numpy.eye(2), 1e4 * numpy.array([[1.0, -1.0], [-1.0, 1.0]]))
        m.set_rayleigh_damping(0, 2e-4)
        m.add_gap_rows([[1.0, -1.0]], stiffness=1e4, gap=0.0)
        m.set_excitation([1.0, 0.0])
        basis = plm.Basis(quiet(m.build)[0], plm.Sampler(m).run()).build()
        hbm = plm.Hbm(basis, frequency_min_hz=1.0, frequency_max_hz=40.0)
        curve, _ = quiet(hbm.sweep)
        heights, hz = curve.amplitude(0), curve.frequency_hz
        peaks = 1 + numpy.flatnonzero((heights[1:-1] > heights[:-2]) & (heights[1:-1] >= heights[2:]))
        top = peaks[numpy.argmax(heights[peaks])]
        end, said = quiet(lambda: hbm.find_peak(curve, 0))
        self.assertAlmostEqual(end.frequency_hz, 1.0)
        self.assertAlmostEqual(end.amplitude * 2 * (2 * numpy.pi)**2, 1, delta=0.02)  # half the force for each mass
        self.assertRegex(" ".join(said), "moves as a whole.*Inside the curve the highest peak is about %.4g, at %.6g Hz" % (heights[top], hz[top]))


if __name__ == "__main__":
    unittest.main()
