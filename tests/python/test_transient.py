"""Motion in time."""
import unittest

import numpy
import plm

import models


class Motion(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.basis = models.basis()
        cls.point = plm.Hbm(cls.basis).solve(10.0)

    def motion(self, **options):
        return plm.Transient(self.basis, **options)

    def test_run(self):
        motion = self.motion(frequency_hz=10.0, periods=3, steps_per_period=20)
        motion.observe([models.WATCHED, 0])
        self.assertIs(motion.run(), motion)
        history = motion.history()
        self.assertEqual(history.shape, (len(motion.time), 2))
        numpy.testing.assert_array_equal(history[:, 0], motion.history(models.WATCHED))
        self.assertAlmostEqual(motion.time[-1], 0.3, places=12)
        self.assertAlmostEqual(motion.state().q[0], history[-1, 1], places=14)
        motion.observe(numpy.array([1], dtype=numpy.int32))  # of the next run
        self.assertEqual(motion.history().shape[1], 2)
        with self.assertRaises(ValueError):
            motion.history(1)
        motion.run()
        self.assertEqual(motion.history(1).shape, motion.time.shape)
        motion.observe([])
        motion.run()
        self.assertEqual(motion.history().size, 0)
        self.assertIs(motion.model, self.basis.model)

    def test_a_point_of_a_curve_is_periodic(self):
        motion = self.motion()
        motion.start_at(self.point, -1)
        self.assertAlmostEqual(motion.frequency_hz, 10.0, places=9)
        self.assertTrue(motion.find_periodic())
        self.assertLess(motion.periodicity_defect, 1e-9)
        self.assertEqual(motion.is_periodic, 1)
        multipliers = motion.multipliers()
        self.assertEqual(motion.stable, abs(multipliers[0]) < 1)
        wanted = self.point.multipliers(0)
        self.assertLess(abs(abs(multipliers[0]) - abs(wanted[0])), 1e-2)
        numpy.testing.assert_allclose(motion.state().q, self.point.field(0), atol=1e-2 * abs(self.point.field(0)).max())

    def test_states(self):
        motion = self.motion(frequency_hz=10.0)
        q = self.basis.vectors()[:, 0] * 1e-3
        motion.set_state(q, 2 * q)
        state = motion.state()
        numpy.testing.assert_allclose(state.q, q, atol=1e-9 * abs(q).max())
        numpy.testing.assert_allclose(state.v, 2 * q, atol=1e-9 * abs(q).max())
        motion.set_state()
        self.assertEqual(abs(motion.state().v).max(), 0)
        with self.assertRaises(ValueError):
            motion.set_state(q[1:])

    def test_full_model(self):
        motion = plm.Transient(self.basis.model, periods=2, steps_per_period=400)
        motion.observe([models.WATCHED])
        motion.start_at(self.point, 0)
        amplitude = numpy.ptp(motion.run().history(models.WATCHED)) / 2
        self.assertEqual(motion.motion, "full")
        self.assertLess(abs(amplitude / self.point.amplitude(models.WATCHED)[0] - 1), 0.05)
        with self.assertRaises(plm.PlmError):
            motion.find_periodic()

    def test_results(self):
        motion = self.motion(march_when_stuck="on")
        motion.start_at(self.point, 0)
        motion.run()
        motion.find_periodic()
        for name, key in motion.keys.items():
            kinds = {plm.TYPE_INT: int, plm.TYPE_DOUBLE: float, plm.TYPE_STRING: str}
            self.assertIsInstance(getattr(motion, name), kinds.get(key.type, numpy.ndarray), name)

    def test_refusals(self):
        with self.assertRaises(plm.PlmError) as caught:
            self.motion().run()  # no frequency
        self.assertEqual(caught.exception.function, "plm_transient_run")
        motion = self.motion(frequency_hz=10.0)
        with self.assertRaises(plm.PlmKeyError):
            motion.frequenzy_hz = 3.0
        with self.assertRaises(plm.PlmError):
            motion.observe([models.DOFS])
        with self.assertRaises(plm.PlmError):
            motion._get_array("get_int_array", b"time", numpy.int64)  # an array of doubles

    def test_cancel(self):
        motion = self.motion(frequency_hz=10.0, periods=1000)
        motion.run(progress=lambda stage, fraction: fraction > 0.1)
        self.assertTrue(50 <= motion.periods_done < 1000, motion.periods_done)
        self.assertAlmostEqual(motion.present_time, motion.periods_done / 10.0, delta=0.1)


if __name__ == "__main__":
    unittest.main()
