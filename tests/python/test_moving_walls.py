"""Walls that move (set_gap_motion), held against motions that this file finds by itself: piece by piece by the exponential of
the linear system of the moment, with its events by bisection; and by closed forms where no pair changes its state."""
import unittest
import warnings

import numpy
import plm
import scipy.linalg
import scipy.optimize
import scipy.sparse

OWN = 1e-10  # of the motion: what is left of the start after so many periods, and the events' rounding


class Marched:
    """M q'' + C q' + K q = Re sum F_h exp(i h w t) - B^T k max(B q - g(t), 0), g(t) = g + Re sum G_h exp(i h w t)."""

    def __init__(self, m, c, k, rows, stiffness, gap, force, motion, omega):
        self.rows, self.gap, self.omega = numpy.atleast_2d(rows), numpy.asarray(gap, float), omega
        self.n, self.springs = len(m), numpy.asarray(stiffness, float)
        self.harmonics = sorted({0, *force, *motion})
        self.wave = 2 * len(self.harmonics)
        inverse = numpy.linalg.inv(m)
        size = 2 * self.n + self.wave
        self.system, self.push = numpy.zeros((size, size)), numpy.zeros((size, len(self.springs)))
        self.system[:self.n, self.n:2 * self.n] = numpy.eye(self.n)
        self.system[self.n:2 * self.n, :2 * self.n] = -inverse @ numpy.hstack([k, c])
        self.push[self.n:2 * self.n] = -inverse @ (self.rows.T * self.springs)
        self.look = numpy.zeros((len(self.springs), size))  # penetrations of a state
        self.look[:, :self.n] = self.rows
        for i, h in enumerate(self.harmonics):  # cos(h w t), sin(h w t) as states of their own
            a, b = 2 * self.n + 2 * i, 2 * self.n + 2 * i + 1
            self.system[a, b], self.system[b, a] = -h * omega, h * omega
            f, g = numpy.asarray(force.get(h, 0)), numpy.asarray(motion.get(h, 0))
            self.system[self.n:2 * self.n, a] = inverse @ (numpy.real(f) + numpy.zeros(self.n))
            self.system[self.n:2 * self.n, b] = -inverse @ (numpy.imag(f) + numpy.zeros(self.n))
            self.look[:, a] -= numpy.real(g)
            self.look[:, b] += numpy.imag(g)
            if h == 0:
                self.look[:, a] -= self.gap
        self.steps, self.known = 400, {}

    def start(self):
        return numpy.concatenate([numpy.zeros(2 * self.n), *([1.0, 0.0] for _ in self.harmonics)])

    def of_set(self, closed):
        if closed not in self.known:
            a = self.system + self.push[:, list(closed)] @ self.look[list(closed)]
            self.known[closed] = a, scipy.linalg.expm(a * 2 * numpy.pi / self.omega / self.steps)
        return self.known[closed]

    def period(self, x, seen=None):
        """One period on; seen: gets the displacements at the ends of the steps."""
        dt = 2 * numpy.pi / self.omega / self.steps
        closed = tuple(numpy.flatnonzero(self.look @ x > 0))
        for _ in range(self.steps):
            a, whole = self.of_set(closed)
            end, left = whole @ x, dt
            while True:
                there = tuple(numpy.flatnonzero(self.look @ end > 0))
                if there == closed:
                    break
                changed = [p for p in range(len(self.springs)) if (p in there) != (p in closed)]
                at = min(scipy.optimize.brentq(lambda t, p=p: self.look[p] @ scipy.linalg.expm(a * t) @ x, 0, left,
                                               xtol=1e-16) for p in changed)
                at = min(left, at * (1 + 1e-14) + 1e-16)
                x, left = scipy.linalg.expm(a * at) @ x, left - at
                now = self.look @ x
                closed = tuple(p for p in range(len(self.springs))
                               if (p in there if p in changed and abs(now[p]) < 1e-11 else p in closed))
                a = self.of_set(closed)[0]
                end = scipy.linalg.expm(a * left) @ x
            x = end
            if seen is not None:
                seen.append(x[:self.n].copy())
        return x

    def settled(self, periods):
        x = self.start()
        for _ in range(periods):
            x = self.period(x)
            x[2 * self.n:] = self.start()[2 * self.n:]
        seen = [x[:self.n].copy()]
        end = self.period(x, seen)
        change = numpy.abs(end[:2 * self.n] - x[:2 * self.n])
        assert (change[:self.n] < 1e-10 * numpy.abs(seen).max()).all(), change
        return numpy.array(seen[:-1])


def quietly(work):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", plm.PlmWarning)
        return work()


def model_of(m, c, k, rows, stiffness, gap, force=None, motion=None):
    model = plm.Model(scipy.sparse.coo_array(m), scipy.sparse.coo_array(k), scipy.sparse.coo_array(c))
    model.add_gap_rows(numpy.atleast_2d(rows), stiffness, gap)
    for h, f in (force or {}).items():
        model.set_excitation(f, harmonic=h)
    for h, g in (motion or {}).items():
        model.set_gap_motion(g, harmonic=h)
    return model.build()


CAGE = dict(m=numpy.array([[1.0]]), c=numpy.array([[4.0]]), k=numpy.array([[100.0]]),
            rows=[[1.0], [-1.0]], stiffness=[900.0, 900.0], gap=[0.01, 0.01])


def full_basis(model, hz):
    return quietly(lambda: plm.Basis(model, kind="full", frequency_max_hz=hz).build())


RANGE = dict(frequency_min_hz=0.5, frequency_max_hz=4.0)


class MovingWalls(unittest.TestCase):
    def exact(self, model, omega, instants=400):
        hz = omega / 2 / numpy.pi
        hbm = plm.Hbm(full_basis(model, 20 * hz), motion="exact", frequency_min_hz=0.9 * hz, frequency_max_hz=1.1 * hz)
        branch = quietly(lambda: hbm.solve(hz))
        return branch, numpy.array([branch.field(0, i / instants) for i in range(instants)])

    def near(self, got, want, tolerance):
        self.assertLess(numpy.abs(got - want).max(), tolerance * numpy.abs(want).max())

    def test_mass_in_a_moving_cage(self):
        omega = 13.0
        motion = {1: [0.02, -0.02]}  # two walls in phase: one gap grows where the other closes
        own = Marched(**CAGE, force={}, motion=motion, omega=omega).settled(120)
        branch, found = self.exact(model_of(**CAGE, motion=motion), omega)
        self.assertGreater(numpy.abs(own).max(), 0.01)
        self.near(found, own, OWN)

    def test_walls_with_two_harmonics_and_a_force(self):
        omega = 11.0
        motion, force = {1: [0.012, 0.004j], 3: [0.003 - 0.002j, 0.001]}, {1: [0.6 - 0.2j], 0: [0.3]}
        own = Marched(**CAGE, force=force, motion=motion, omega=omega).settled(400)
        model = model_of(**CAGE, force={1: [0.6 - 0.2j], 0: [0.3]}, motion=motion)
        branch, found = self.exact(model, omega)
        self.near(found, own, OWN)

    def chain(self):
        n = 5
        k = 400 * (2 * numpy.eye(n) - numpy.eye(n, k=1) - numpy.eye(n, k=-1))
        rows = numpy.zeros((3, n))
        rows[0, 4], rows[1, 2], rows[2, 0] = 1, -1, 1
        return dict(m=numpy.eye(n), c=2 * numpy.eye(n) + 4e-3 * k, k=k, rows=rows, stiffness=[3000.0, 800.0, 500.0],
                    gap=[0.004, 0.006, -0.002])

    def test_a_travelling_wave_by_all_ways(self):
        chain, omega = self.chain(), 9.0
        motion = {2: 0.01 * numpy.exp(-0.7j * numpy.arange(3)), 0: numpy.array([0.001, 0, 0])}
        force = {1: numpy.array([0, 0, 0, 1.5, 0])}
        own = Marched(**chain, force=force, motion=motion, omega=omega).settled(150)
        model = model_of(**chain, force=force, motion=motion)
        branch, found = self.exact(model, omega)
        self.near(found, own, OWN)
        hz = omega / 2 / numpy.pi
        for unknowns in ("modal", "gaps"):
            hbm = plm.Hbm(full_basis(model, 30), **RANGE, motion="harmonics", unknowns=unknowns, n_harmonics=60)
            balance = quietly(lambda: hbm.solve(hz))
            field = numpy.array([balance.field(0, i / 400) for i in range(400)])
            self.near(field, own, 2e-4)
        with self.subTest("forces and penetrations of the pairs"):
            contact = branch.contact(0, 400)
            t = 2 * numpy.pi * numpy.arange(400) / 400
            gaps = numpy.array(chain["gap"])[:, None] + sum(
                numpy.real(numpy.asarray(g)[:, None] * numpy.exp(1j * h * t)) for h, g in motion.items())
            u = numpy.array(chain["rows"]) @ own.T - gaps
            self.near(contact.penetration, u, 2e-3)
        with self.subTest("marching of the full model"):
            march = plm.Transient(model, frequency_hz=hz, periods=150, steps_per_period=3200)
            march.observe([4])
            quietly(march.run)
            values = march.history(4)[-3200:]
            self.near(values[7::8], numpy.roll(own[:, 4], -1), 2e-4)

    def test_all_closed_is_linear(self):
        chain, omega = self.chain(), 14.0
        chain["gap"] = [-0.1, -0.1, -0.1]  # pressed throughout
        moved = numpy.array([1e-4, 2e-4j, 5e-5])
        model = model_of(**chain, motion={1: moved})
        b = numpy.array(chain["rows"])
        k = chain["k"] + b.T @ numpy.diag(chain["stiffness"]) @ b
        q = numpy.linalg.solve(k + 1j * omega * chain["c"] - omega**2 * chain["m"], b.T @ (chain["stiffness"] * moved))
        hz = omega / 2 / numpy.pi
        for unknowns in ("modal", "gaps"):
            branch = quietly(lambda: plm.Hbm(full_basis(model, 30), **RANGE, motion="harmonics", unknowns=unknowns).solve(hz))
            got = numpy.array([branch.coefficients(0, dof)[1:3] for dof in range(5)])
            self.near(got[:, 0] - 1j * got[:, 1], q, 1e-9)

    def test_excitation_is_scaled_as_a_whole(self):
        chain, omega = self.chain(), 9.0
        hz, motion = omega / 2 / numpy.pi, {1: numpy.array([0.01, 0.004j, 0.002])}
        force = {1: numpy.array([0, 0, 0, 1.5, 0])}
        own = Marched(**chain, force={1: 0.4 * force[1]}, motion={1: 0.4 * motion[1]}, omega=omega).settled(150)
        model = model_of(**chain, force=force, motion=motion)
        hbm = plm.Hbm(full_basis(model, 30), **RANGE, motion="exact", force_scale=0.4)
        branch = quietly(lambda: hbm.solve(hz))
        self.near(numpy.array([branch.field(0, i / 400) for i in range(400)]), own, OWN)

    def test_a_curve_and_its_point_by_point_solutions(self):
        """The continuation's derivatives by frequency and by the walls: a sweep meets what single solutions find."""
        model = model_of(**CAGE, motion={1: [0.02, -0.02]})
        for motion in ("exact", "harmonics"):
            options = dict(motion=motion, frequency_min_hz=1.2, frequency_max_hz=2.6)
            basis = full_basis(model, 20)
            hbm = plm.Hbm(basis, **options)
            curve = quietly(hbm.sweep)
            self.assertEqual(curve.status, plm.OK)
            amplitude, at = curve.amplitude(0), len(curve) // 2
            alone = quietly(lambda: plm.Hbm(basis, **options).solve(curve.frequency_hz[at], curve, at))
            self.assertLess(abs(alone.amplitude(0)[0] / amplitude[at] - 1), 1e-6)

    def test_the_one_call_finds_what_walls_drive(self):
        chain = self.chain()
        model = model_of(**chain, motion={1: numpy.array([0.01, 0, 0])})
        answer = quietly(lambda: model.compute_response(4, accuracy=1e-3))
        omega = 2 * numpy.pi * answer.frequency_hz
        own = Marched(**chain, force={}, motion={1: numpy.array([0.01, 0, 0])}, omega=omega).settled(300)
        want = 0.5 * (own[:, 4].max() - own[:, 4].min())
        self.assertLess(abs(answer.amplitude / want - 1), 2e-3)

    def test_folds_are_tracked_over_forces_and_walls(self):
        """By derivatives of the tangent; where the tracked fold ends up, the curve at that scale has one."""
        model = model_of(**dict(CAGE, c=numpy.array([[0.15]])), force={1: [0.15]}, motion={1: [8e-4, -8e-4]})
        basis = full_basis(model, 30)
        for motion in ("exact", "harmonics"):
            options = dict(motion=motion, frequency_min_hz=1.2, frequency_max_hz=4.9)
            hbm = plm.Hbm(basis, **options)
            curve = quietly(hbm.sweep)
            fold = next(b for b in curve.bifurcations if b.kind == "fold")
            tracked = quietly(lambda: hbm.track_fold(curve, fold.point, 0.9, 1.2))
            self.assertEqual(tracked.status, plm.OK)
            self.assertLess(len(tracked), 60)
            last = int(numpy.argmin(numpy.abs(tracked.point_force_scale - 1.15)))
            there = plm.Hbm(basis, **options, force_scale=float(tracked.point_force_scale[last]))
            folds = [b.frequency_hz for b in quietly(there.sweep).bifurcations if b.kind == "fold"]
            self.assertLess(min(abs(hz / tracked.frequency_hz[last] - 1) for hz in folds), 1e-5)

    def test_the_full_structure_has_no_residual(self):
        """Neither the basis nor the balance leaves any: the equations of the whole structure see the walls, too."""
        chain, hz = self.chain(), 9.0 / 2 / numpy.pi
        model = model_of(**chain, motion={1: numpy.array([0.01, 0.004j, 0.002])})
        basis = full_basis(model, 30)
        for options in (dict(motion="exact"), dict(motion="harmonics"), dict(motion="harmonics", period_multiple=2)):
            branch = quietly(lambda: plm.Hbm(basis, **RANGE, **options).solve(hz))
            self.assertLess(branch.full_residual(0), 1e-9)

    def test_resonance_by_phase_is_refused(self):
        model = model_of(**CAGE, force={1: [1.0]}, motion={1: [0.02, -0.02]})
        hbm = plm.Hbm(full_basis(model, 20), frequency_min_hz=1.2, frequency_max_hz=2.6)
        with self.assertRaisesRegex(plm.PlmError, "gaps of the model move"):
            hbm.find_backbones()

    def test_none_takes_it_back(self):
        model = plm.Model(scipy.sparse.eye(1, format="coo"), 100 * scipy.sparse.eye(1, format="coo"))
        model.add_gap_rows([[1.0]], 900.0, 0.01)
        with self.assertRaisesRegex(plm.PlmError, "contact pairs so far"):
            model.set_gap_motion([1, 2])
        model.set_gap_motion([1j])
        model.set_gap_motion(None)
        model.set_excitation([1.0])
        model.set_rayleigh_damping(0.5, 0)
        model.build()
        self.assertNotIn("gaps that move", "\n".join(str(f) for f in model.audit()))


if __name__ == "__main__":
    unittest.main()
