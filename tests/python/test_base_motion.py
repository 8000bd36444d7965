"""Forces that grow with the frequency and supports that move, held against the marching of test_moving_walls.py and closed forms."""
import unittest

import numpy
import plm
import scipy.sparse
from test_moving_walls import CAGE, OWN, RANGE, Marched, full_basis, quietly

N = 6


def chain(n=N, coupled_mass=True):
    """Matrices of a chain of n masses and one before them, DOF 0, that is its support; the mass couples neighbours."""
    k = 400 * (2 * numpy.eye(n + 1) - numpy.eye(n + 1, k=1) - numpy.eye(n + 1, k=-1))
    k[0, 0] = k[n, n] = 400
    m = numpy.eye(n + 1)
    if coupled_mass:
        m = m + 0.1 * (numpy.eye(n + 1, k=1) + numpy.eye(n + 1, k=-1))
    return m, 4e-3 * k, k


def crack(n=N):
    """Between two masses, and of the last one against a stop that moves with nothing."""
    rows = numpy.zeros((1, n + 1))
    rows[0, 2], rows[0, 4] = -1, 1
    return rows


def supported(m, c, k, rows, stiffness, gap, fixed=(0,), **how):
    model = plm.Model(scipy.sparse.coo_array(m), scipy.sparse.coo_array(k), scipy.sparse.coo_array(c), **how)
    model.fix_dofs(list(fixed))
    model.add_gap_rows(rows, stiffness, gap)
    return model


def history(branch, instants=400):
    return numpy.array([branch.field(0, i / instants) for i in range(instants)])


class Near(unittest.TestCase):
    def near(self, got, want, tolerance):
        self.assertLess(numpy.abs(numpy.asarray(got) - want).max(), tolerance * numpy.abs(want).max())

    def exact(self, model, omega):
        hz = omega / 2 / numpy.pi
        hbm = plm.Hbm(full_basis(model, 20 * hz), motion="exact", frequency_min_hz=0.9 * hz, frequency_max_hz=1.1 * hz)
        return quietly(lambda: hbm.solve(hz))


class GrowingForces(Near):
    """An unbalance m e omega^2, and what else has a power of the frequency."""

    def free_chain(self):
        m, c, k = chain()
        return dict(m=m[1:, 1:], c=c[1:, 1:] + 2 * numpy.eye(N), k=k[1:, 1:], rows=crack()[:, 1:], stiffness=[3000.0], gap=[0.002])

    def model(self, s, parts, **more):
        model = plm.Model(scipy.sparse.coo_array(s["m"]), scipy.sparse.coo_array(s["k"]), scipy.sparse.coo_array(s["c"]))
        model.add_gap_rows(s["rows"], s["stiffness"], s["gap"])
        for (harmonic, power), force in parts.items():
            model.set_excitation(force, harmonic=harmonic, power=power)
        return model.build()

    def parts(self):
        turning = numpy.zeros(N, complex)
        turning[4], turning[3] = 0.012, 0.006j
        steady, rate, mean = numpy.zeros(N), numpy.zeros(N), numpy.zeros(N)
        steady[2], rate[5], mean[1] = 0.8, 0.05, 0.004
        return {(1, 2): turning, (1, 0): steady, (1, 1): 1j * rate, (2, 2): 0.3 * turning, (0, 2): mean}

    def at(self, parts, omega, scale=1.0):
        force = {}
        for (harmonic, power), f in parts.items():
            force[harmonic] = force.get(harmonic, 0) + scale * omega**power * f
        return force

    def test_linear_closed_form(self):
        s, parts = self.free_chain(), self.parts()
        s["gap"] = [-10.0]  # pressed throughout
        model = self.model(s, parts)
        k = s["k"] + s["rows"].T @ numpy.diag(s["stiffness"]) @ s["rows"]
        for unknowns in ("modal", "gaps"):
            for omega in (7.0, 13.0):
                hbm = plm.Hbm(full_basis(model, 30), **RANGE, motion="harmonics", unknowns=unknowns)
                branch = quietly(lambda: hbm.solve(omega / 2 / numpy.pi))
                got = numpy.array([branch.coefficients(0, dof) for dof in range(N)])
                for h, f in self.at(parts, omega).items():
                    if h == 0:
                        want = numpy.linalg.solve(k, f + s["rows"].T @ (numpy.array(s["stiffness"]) * s["gap"]))
                        self.near(got[:, 0], want, 1e-9)
                    else:
                        want = numpy.linalg.solve(k + 1j * h * omega * s["c"] - (h * omega)**2 * s["m"], f)
                        self.near(got[:, 2 * h - 1] - 1j * got[:, 2 * h], want, 1e-9)

    def test_contact_against_marching_by_all_ways(self):
        s, parts, omega = self.free_chain(), self.parts(), 9.0
        own = Marched(**s, force=self.at(parts, omega), motion={}, omega=omega).settled(150)
        model = self.model(s, parts)
        exact = self.exact(model, omega)
        self.near(history(exact), own, OWN)
        self.assertLess(exact.full_residual(0), 1e-9)
        hz = omega / 2 / numpy.pi
        for options in (dict(unknowns="modal"), dict(unknowns="gaps"), dict(unknowns="modal", period_multiple=2)):
            hbm = plm.Hbm(full_basis(model, 30), **RANGE, motion="harmonics", n_harmonics=40, **options)
            branch = quietly(lambda: hbm.solve(hz))
            multiple = options.get("period_multiple", 1)
            found = numpy.array([branch.field(0, i / 400 / multiple) for i in range(400)])
            self.near(found, own, 1e-3)
            self.assertLess(branch.full_residual(0), 1e-8)
        march = plm.Transient(model, frequency_hz=hz, periods=150, steps_per_period=3200)
        march.observe([4])
        quietly(march.run)
        self.near(march.history(4)[-3200:][7::8], numpy.roll(own[:, 4], -1), 2e-4)

    def test_a_curve_and_its_point_by_point_solutions(self):
        """The derivatives by the frequency: a sweep meets what single solutions find."""
        model = self.model(self.free_chain(), self.parts())
        for motion in ("exact", "harmonics"):
            options = dict(motion=motion, frequency_min_hz=0.7, frequency_max_hz=2.2)
            basis = full_basis(model, 20)
            curve = quietly(plm.Hbm(basis, **options).sweep)
            self.assertEqual(curve.status, plm.OK)
            at = len(curve) // 2
            alone = quietly(lambda: plm.Hbm(basis, **options).solve(curve.frequency_hz[at], curve, at))
            self.assertLess(abs(alone.amplitude(4)[0] / curve.amplitude(4)[at] - 1), 1e-6)

    def test_folds_are_tracked_over_the_force(self):
        """By the change of the tangent with the frequency; where the tracked fold ends up, the curve at that scale has one."""
        cage = dict(CAGE, c=numpy.array([[0.15]]))
        model = self.model(cage, {(1, 2): numpy.array([8e-4])})
        basis = full_basis(model, 30)
        for motion in ("exact", "harmonics"):
            options = dict(motion=motion, frequency_min_hz=1.2, frequency_max_hz=4.9)
            hbm = plm.Hbm(basis, **options)
            curve = quietly(hbm.sweep)
            fold = next(b for b in curve.bifurcations if b.kind == "fold")
            tracked = quietly(lambda: hbm.track_fold(curve, fold.point, 0.9, 1.2))
            self.assertEqual(tracked.status, plm.OK)
            last = int(numpy.argmin(numpy.abs(tracked.point_force_scale - 1.15)))
            there = plm.Hbm(basis, **options, force_scale=float(tracked.point_force_scale[last]))
            folds = [b.frequency_hz for b in quietly(there.sweep).bifurcations if b.kind == "fold"]
            self.assertLess(min(abs(hz / tracked.frequency_hz[last] - 1) for hz in folds), 1e-5)

    def test_one_call(self):
        s = self.free_chain()
        turning = numpy.zeros(N)
        turning[4] = 0.01
        answer = quietly(lambda: self.model(s, {(1, 2): turning}).compute_response(4, accuracy=1e-3))
        omega = 2 * numpy.pi * answer.frequency_hz
        own = Marched(**s, force={1: omega**2 * turning}, motion={}, omega=omega).settled(300)
        self.assertLess(abs(answer.amplitude / (0.5 * (own[:, 4].max() - own[:, 4].min())) - 1), 2e-3)

    def test_parts_are_taken_back_one_by_one(self):
        s = self.free_chain()
        model = plm.Model(scipy.sparse.coo_array(s["m"]), scipy.sparse.coo_array(s["k"]), scipy.sparse.coo_array(s["c"]))
        for power in (0, 2):
            model.set_excitation(numpy.ones(N), power=power)
        model.set_excitation(None)
        text = "\n".join(str(f) for f in model.build().audit())
        self.assertIn("omega^2", text)
        self.assertNotIn("no harmonic excitation", text)


class MovingSupports(Near):
    def curve(self, model, dof):
        hbm = plm.Hbm(full_basis(model, 20), motion="exact", frequency_min_hz=0.7, frequency_max_hz=2.2)
        at = [0.8, 1.1, 1.4, 1.9]
        return numpy.array([quietly(lambda: hbm.solve(hz)).amplitude(dof)[0] for hz in at])

    def test_base_excitation_is_the_relative_formulation(self):
        m, c, k = chain()
        a, moved = 1.5, numpy.zeros(N + 1)
        moved[0] = a
        based = supported(m, c, k, crack(), [3000.0], [0.002])
        based.set_base_motion(moved, "acceleration")
        relative = supported(m, c, k, crack(), [3000.0], [0.002])
        relative.set_excitation(-m @ numpy.full(N + 1, a) * (numpy.arange(N + 1) > 0))
        self.near(self.curve(based.build(), N), self.curve(relative.build(), N), 1e-9)

    def test_displacement_velocity_and_acceleration_mean_one_motion(self):
        m, c, k = chain()
        omega, u = 8.0, 0.03 - 0.01j
        found = []
        for quantity, value in (("displacement", u), ("velocity", 1j * omega * u), ("acceleration", -omega**2 * u)):
            moved = numpy.zeros(N + 1, complex)
            moved[0] = value
            model = supported(m, c + 0.3 * m, k, crack(), [3000.0], [0.002])
            model.set_base_motion(moved, quantity)
            found.append(history(self.exact(model.build(), omega)))
        for other in found[1:]:
            self.near(other, found[0], 1e-9)

    def absolute(self, m, c, k, rows, stiffness, gap, motion, omega, damping_of_mass=0.0):
        """Marched without the relative motion: the supports' forces and the gaps they move, then less what follows at rest."""
        c = c + damping_of_mass * m
        held = sorted({dof for moved in motion.values() for dof in moved})
        free = [i for i in range(len(m)) if i not in held]
        force, walls, lift = {}, {}, 0
        for h, moved in motion.items():
            u, s = numpy.array([moved[dof] for dof in held]), 1j * h * omega
            of = numpy.ix_(free, held)
            force[h] = -(s**2 * m[of] + s * c[of] + k[of]) @ u
            walls[h] = -rows[:, held] @ u
            follows = -numpy.linalg.solve(k[numpy.ix_(free, free)], k[of] @ u)
            lift = lift + numpy.real(numpy.outer(numpy.exp(2j * numpy.pi * h * numpy.arange(400) / 400), follows))
        inner = numpy.ix_(free, free)
        own = Marched(m[inner], c[inner], k[inner], rows[:, free], stiffness, gap, force, walls, omega).settled(150)
        return free, own - lift

    def test_supports_apart_against_marching_in_absolute_motion(self):
        """Both ends of a chain, one a quarter of a period later and in another harmonic, with a stop that stands still and a gap row
        that has a support in it; damping of all kinds."""
        m, c, k = chain()
        rows = numpy.zeros((2, N + 1))
        rows[0, 3], rows[1, 1], rows[1, 0] = 1, 1, -1
        motion, omega = {1: {0: 0.02, N: -0.015j}, 2: {0: 0.004 + 0.001j, N: 0.0}}, 9.0
        free, own = self.absolute(m, c, k, rows, [900.0, 700.0], [0.004, 0.003], motion, omega, 0.4)
        for power, quantity in enumerate(("displacement", "velocity", "acceleration")):
            model = plm.Model(scipy.sparse.coo_array(m), scipy.sparse.coo_array(k), scipy.sparse.coo_array(c))
            model.set_rayleigh_damping(0.4, 0)
            model.fix_dofs([0, N])
            model.add_gap_rows(rows, [900.0, 700.0], [0.004, 0.003])
            for h, moved in motion.items():
                u = numpy.zeros(N + 1, complex)
                u[list(moved)] = list(moved.values())
                model.set_base_motion((1j * h * omega)**power * u, quantity, harmonic=h)
            model.build()
            branch = self.exact(model, omega)
            self.near(history(branch)[:, free], own, OWN)
            self.assertLess(branch.full_residual(0), 1e-9)
            hbm = plm.Hbm(full_basis(model, 30), **RANGE, motion="harmonics", n_harmonics=40)
            self.near(history(quietly(lambda: hbm.solve(omega / 2 / numpy.pi)))[:, free], own, 1e-3)

    def test_curve_of_a_wall_whose_acceleration_is_given(self):
        """The gap moves by another amount at every frequency: points of a curve by either way, against marching there."""
        m, c, k = chain()
        stop, moved = numpy.zeros((1, N + 1)), numpy.zeros(N + 1)
        stop[0, 3], moved[0] = 1, 1.5
        model = supported(m, c + 0.5 * m, k, stop, [900.0], [0.004])
        model.set_base_motion(moved, "acceleration")
        basis = full_basis(model.build(), 30)
        for how, tolerance in (dict(motion="exact"), OWN), (dict(motion="harmonics", n_harmonics=40), 1e-3):
            curve = quietly(lambda: plm.Hbm(basis, frequency_min_hz=0.7, frequency_max_hz=1.3, **how).sweep())
            self.assertEqual(curve.end_text, "reached the end of its range")
            points = [0, curve.n_points // 2, curve.n_points - 1]
            for point in points:
                omega = 2 * numpy.pi * curve.frequency_hz[point]
                free, own = self.absolute(m, c + 0.5 * m, k, stop, [900.0], [0.004], {1: {0: -1.5 / omega**2}}, omega)
                got = numpy.array([curve.field(point, i / 400) for i in range(400)])
                self.near(got[:, free], own, tolerance)

    def test_what_cannot_be_is_refused(self):
        m, c, k = chain()
        moved, wrong = numpy.zeros(N + 1), numpy.zeros(N + 1)
        moved[0], wrong[2] = 1.0, 1.0
        model = supported(m, c, k, crack(), [3000.0], [0.002])
        model.set_base_motion(wrong)
        with self.assertRaisesRegex(plm.PlmError, "DOF 2 .*not fixed"):
            model.build()
        with self.assertRaisesRegex(ValueError, "quantity"):
            model.set_base_motion(moved, "jerk")

    def test_loads_change_beside_it(self):
        """Damping, forces and walls put in place after the build, beside what the base makes of them, against a build with them."""
        m, c, k = chain()
        moved, force = numpy.zeros(N + 1), numpy.zeros(N + 1)
        moved[0], force[4] = 0.02, 0.7
        stop = crack() + numpy.eye(N + 1)[3]  # beside a wall that stands still, too
        found = []
        for later in (True, False):
            model = supported(m, c, k, stop, [3000.0], [0.002])
            model.set_base_motion(moved)
            model.set_excitation(2 * force)
            if later:
                quietly(model.build)
            model.set_excitation(force, power=1)
            model.set_rayleigh_damping(0.4, 1e-3)
            model.set_gap_motion([0.001j])
            if not later:
                quietly(model.build)
            found.append(history(self.exact(model, 8.0), 40))
        self.near(found[0], found[1], 1e-9)

    def test_none_takes_it_back(self):
        m, c, k = chain()
        moved = numpy.zeros(N + 1)
        moved[0] = 1.0
        model = supported(m, c, k, crack(), [3000.0], [0.002])
        model.set_base_motion(moved, "velocity")
        model.set_base_motion(None)
        self.assertIn("no harmonic excitation", "\n".join(str(f) for f in quietly(model.build).audit()))


if __name__ == "__main__":
    unittest.main()
