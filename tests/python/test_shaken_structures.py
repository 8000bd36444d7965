"""Structures on supports that move, as users have them: a cracked plate on a shaker, towers that pound, a table coupled by a rigid
link, a rotor out of balance. Held against the relative formulation, closed forms, and marching in absolute coordinates."""
import unittest

import numpy
import plm
import scipy.linalg
import scipy.sparse
from test_base_motion import Near, history
from test_moving_walls import OWN, RANGE, Marched, full_basis, quietly


def membrane(nodes, elements):
    """Plane stress of four-node elements with a consistent mass, so that supports act through both matrices."""
    e, nu, rho = 2.1e5, 0.3, 7.8e-9
    d = e / (1 - nu**2) * numpy.array([[1, nu, 0], [nu, 1, 0], [0, 0, (1 - nu) / 2]])
    m, k = numpy.zeros((2, 2 * len(nodes), 2 * len(nodes)))
    for element in elements:
        at = numpy.ravel([[2 * i, 2 * i + 1] for i in element])
        for x, y in numpy.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) / numpy.sqrt(3):
            shape = 0.25 * numpy.array([(1 - x) * (1 - y), (1 + x) * (1 - y), (1 + x) * (1 + y), (1 - x) * (1 + y)])
            rates = 0.25 * numpy.array([[y - 1, 1 - y, 1 + y, -1 - y], [x - 1, -1 - x, 1 + x, 1 - x]])
            jacobian = rates @ nodes[element]
            g, size = numpy.linalg.solve(jacobian, rates), numpy.linalg.det(jacobian)
            b = numpy.zeros((3, 8))
            b[0, ::2], b[1, 1::2], b[2, ::2], b[2, 1::2] = g[0], g[1], g[1], g[0]
            n = numpy.kron(shape, numpy.eye(2))
            k[numpy.ix_(at, at)] += size * b.T @ d @ b
            m[numpy.ix_(at, at)] += size * rho * n.T @ n
    return (m + m.T) / 2, (k + k.T) / 2


class Plate:
    """A cantilever of 10 by 3 elements, cracked through its upper half; held at x = 0. mm, t, N."""

    def __init__(self):
        nx, ny = 10, 3
        nodes = [[10.0 * i, 5.0 * j] for i in range(nx + 1) for j in range(ny + 1)]
        number = lambda i, j: i * (ny + 1) + j
        elements = [[number(i, j), number(i + 1, j), number(i + 1, j + 1), number(i, j + 1)] for i in range(nx) for j in range(ny)]
        self.rows = []
        for j in (2, 3):  # right of x = 30 the nodes are others
            nodes.append([30.0, 5.0 * j])
            at, twin = number(3, j), len(nodes) - 1
            for element in elements:
                if at in element and max(element) > number(4, 0) - 1:
                    element[element.index(at)] = twin
            self.rows.append((2 * at, 2 * twin))
        self.nodes, self.n, self.out = numpy.array(nodes), 2 * len(nodes), 2 * number(nx, ny) + 1
        self.m, self.k = membrane(self.nodes, elements)
        self.held = [2 * number(0, j) + axis for j in range(ny + 1) for axis in (0, 1)]

    def model(self):
        made = plm.Model(scipy.sparse.coo_array(self.m), scipy.sparse.coo_array(self.k))
        made.fix_dofs(self.held)
        rows = numpy.zeros((2, self.n))
        for row, (left, right) in zip(rows, self.rows):
            row[[left, right]] = 1, -1
        made.add_gap_rows(rows, 2e5)
        made.set_modal_damping([0.01])
        return made


class OnAShaker(Near):
    def test_cracked_plate_is_the_relative_formulation(self):
        plate = Plate()
        across = numpy.arange(plate.n) % 2 * 1.0  # the direction y, a rigid motion
        hz = quietly(plate.model().build).modes(1, "sliding")[0]
        at_supports = numpy.zeros(plate.n)
        at_supports[plate.held] = across[plate.held]
        base = {"acceleration": (5e4, -1, 0), "displacement": (1e-2, 1, 2)}  # u'', or -u'' = omega^2 u
        for quantity, (size, sign, power) in base.items():
            shaken, relative = plate.model(), plate.model()
            shaken.set_base_motion(size * at_supports, quantity)
            relative.set_excitation(sign * size * plate.m @ across * ~numpy.isin(numpy.arange(plate.n), plate.held), power=power)
            found = []
            for model in (shaken, relative):
                quietly(model.build)
                basis = quietly(lambda: plm.Basis(model, kind="full", frequency_max_hz=8 * hz).build())
                for options in (dict(motion="exact"), dict(motion="harmonics", n_harmonics=9)):
                    hbm = plm.Hbm(basis, frequency_min_hz=0.7 * hz, frequency_max_hz=1.3 * hz, **options)
                    found += [history(quietly(lambda: hbm.solve(f * hz)), 40) for f in (0.8, 0.93, 1.2)]
            half = len(found) // 2
            for one, other in zip(found[:half], found[half:]):
                self.near(one, other, 1e-9)

    def test_structural_and_matrix_damping_in_closed_form(self):
        """Pressed throughout: the complex amplitudes of the whole, with the supports in every matrix."""
        n, omega, eta = 5, 11.0, 0.06
        random = numpy.random.default_rng(3)
        m, k, c = (a @ a.T + 3 * numpy.eye(n) for a in random.normal(size=(3, n, n)))
        k *= 300
        c *= 0.5
        row, kn, u = numpy.zeros((1, n)), 500.0, {0: 0.02 - 0.01j, 3: 0.005j}
        row[0, [1, 3]] = 1, -1  # a support in it
        model = plm.Model(m, k, c)
        model.set_structural_damping(eta)
        model.set_rayleigh_damping(0.3, 2e-3)
        model.fix_dofs(list(u))
        model.add_gap_rows(row, kn, -1.0)
        moved = numpy.zeros(n, complex)
        moved[list(u)] = list(u.values())
        model.set_base_motion(moved)
        quietly(model.build)
        whole = (1 + 1j * eta) * k - omega**2 * m + 1j * omega * (c + 0.3 * m + 2e-3 * k) + kn * row.T @ row
        free = [i for i in range(n) if i not in u]
        q = -numpy.linalg.solve(whole[numpy.ix_(free, free)], whole[numpy.ix_(free, list(u))] @ moved[list(u)])
        q += numpy.linalg.solve(k[numpy.ix_(free, free)], k[numpy.ix_(free, list(u))] @ moved[list(u)])
        for unknowns in ("modal", "gaps"):
            branch = quietly(lambda: plm.Hbm(full_basis(model, 60), **RANGE, motion="harmonics", unknowns=unknowns).solve(omega / 2 / numpy.pi))
            got = numpy.array([branch.coefficients(0, dof) for dof in free])
            self.near(got[:, 1] - 1j * got[:, 2], q, 1e-9)
            self.assertLess(branch.full_residual(0), 1e-9)

    def table(self):
        """A mass on springs to four feet, which a rigid link holds to the table's node of six DOFs: DOFs 0 to 5, 6 to 17, 18 to 20."""
        n, feet = 21, numpy.array([[1.0, 0, 0], [0, 1, 0], [-1, 0, 0.1], [0, -1, 0]])
        k, top = numpy.zeros((n, n)), numpy.array([0.1, 0.2, 1.5])
        for i, foot in enumerate(feet):
            row = numpy.zeros((3, n))
            row[:, 6 + 3 * i:9 + 3 * i], row[:, 18:] = numpy.eye(3), -numpy.eye(3)
            along = numpy.outer(top - foot, top - foot) / ((top - foot) @ (top - foot))
            k += row.T @ (100 * numpy.eye(3) + 300 * along) @ row
        m = numpy.diag(numpy.r_[numpy.full(6, 0.5), numpy.full(12, 0.1), numpy.ones(3)])
        return m, 4e-3 * k + 0.1 * m, k, feet

    def test_a_rigid_link_onto_the_moving_node(self):
        m, c, k, feet = self.table()
        n, omega = len(m), 9.0
        stop = numpy.zeros((2, n))
        stop[0, 18], stop[1, 20], stop[1, 8] = 1, 1, -1  # beside a wall that stands still; and against a foot
        moved = numpy.zeros(n, complex)
        moved[:6] = 0.01, 0.02j, 0.0, 0.003, -0.004j, 0.005
        given = moved.copy()
        for i, foot in enumerate(feet):
            given[6 + 3 * i:9 + 3 * i] = moved[:3] + numpy.cross(moved[3:6], foot)
        found = []
        for linked in (True, False):
            model = plm.Model(m, k, c)
            model.add_gap_rows(stop, [900.0, 700.0], [0.004, 0.002])
            model.fix_dofs(list(range(6 if linked else 18)))
            if linked:
                model.add_rigid_link(list(range(6)), [0, 0, 0], numpy.arange(6, 18).reshape(4, 3), feet)
            model.set_base_motion(moved if linked else given)
            found.append(history(self.exact(quietly(model.build), omega), 40))
        self.assertGreater(numpy.abs(found[0]).max(), 0.004)
        self.near(found[0], found[1], 1e-9)

    def test_constraints_against_the_motion_are_refused(self):
        m, c, k, feet = self.table()
        model = plm.Model(m, k, c)
        model.fix_dofs(list(range(7)))
        model.add_rigid_link(list(range(6)), [0, 0, 0], numpy.arange(6, 18).reshape(4, 3), feet)
        moved = numpy.zeros(len(m))
        moved[0] = 0.01  # and DOF 6, fixed and tied to it, not
        model.set_base_motion(moved)
        with self.assertRaisesRegex(plm.PlmError, "DOF 0 .*otherwise than the constraints"):
            model.build()
        moved[6] = 0.01
        model.set_base_motion(moved)
        quietly(model.build)

    def test_equal_oscillators_that_the_base_alone_moves(self):
        """Nothing couples them, nor does a load act: they are not among DOFs that nothing moves."""
        k = numpy.diag([120.0, 100.0, 100.0, 100.0])
        k[0, 1:] = k[1:, 0] = -40.0, -40.0, -40.0
        model = plm.Model(numpy.diag([1.0, 1, 1, 1]), k)
        model.set_rayleigh_damping(0.5, 0)
        model.fix_dofs([0])
        model.set_base_motion([0.01, 0, 0, 0])
        model.add_gap_rows([[0, 1.0, 0, 0]], 50.0, 5.0)
        quietly(model.build)
        omega, u = 8.0, 0.01
        follows = 0.4 * u
        want = omega**2 * follows / (100 - omega**2 + 0.5j * omega) - 0.5j * omega * follows / (100 - omega**2 + 0.5j * omega)
        branch = self.exact(model, omega)
        for dof in (1, 2, 3):
            got = branch.coefficients(0, dof)
            self.near(got[1] - 1j * got[2], want, 1e-9)


class Absolute(Near):
    """Marching of the free DOFs in absolute coordinates: supports act by what the matrices make of their motion, and walls move
    with them only where a row has them in it."""

    def absolute(self, m, c, k, rows, stiffness, gap, motion, omega, preload=None):
        held = sorted({dof for moved in motion.values() for dof in moved})
        free = [i for i in range(len(m)) if i not in held]
        of, inner = numpy.ix_(free, held), numpy.ix_(free, free)
        force, walls, lift = {}, {}, 0
        if preload is not None:
            force[0] = preload[free]
        for h, moved in motion.items():
            u, s = numpy.array([moved[dof] for dof in held]), 1j * h * omega
            force[h] = -(s**2 * m[of] + s * c[of] + k[of]) @ u
            walls[h] = -rows[:, held] @ u
            if k[of].any():
                turn = numpy.exp(2j * numpy.pi * h * numpy.arange(400) / 400)
                lift = lift + numpy.real(numpy.outer(turn, -numpy.linalg.solve(k[inner], k[of] @ u)))
        own = Marched(m[inner], c[inner], k[inner], rows[:, free], stiffness, gap, force, walls, omega).settled(200)
        return free, own - lift

    def towers(self):
        """Three shear buildings of 3, 2 and 4 storeys on one base, DOF 0; slabs that meet, and a wall beside the tallest."""
        n, k = 10, numpy.zeros((10, 10))
        for storeys, stiffness in ((range(1, 4), 3000.0), (range(4, 6), 1500.0), (range(6, 10), 5000.0)):
            for below, above in zip([0, *storeys], storeys):
                row = numpy.eye(n)[above] - numpy.eye(n)[below]
                k += stiffness * numpy.outer(row, row)
        m = numpy.diag([5.0, 1, 1, 0.8, 1, 0.7, 1.2, 1.2, 1.2, 1])
        rows = numpy.zeros((3, n))
        rows[0, [2, 5]], rows[1, [5, 7]], rows[2, 9] = (1, -1), (1, -1), 1
        return m, 6e-3 * k + 0.4 * m, k, rows


class Pounding(Absolute):
    def test_towers_on_one_base(self):
        m, c, k, rows = self.towers()
        omega, stiffness, gap = 17.0, [2e4, 2e4, 9e3], [0.002, 0.003, 0.02]
        motion = {1: {0: 0.01}, 2: {0: 0.002 - 0.003j}}
        free, own = self.absolute(m, c, k, rows, stiffness, gap, motion, omega)
        model = plm.Model(m, k, c)
        model.fix_dofs([0])
        model.add_gap_rows(rows, stiffness, gap)
        for h, moved in motion.items():
            model.set_base_motion(moved[0] * numpy.eye(len(m))[0], harmonic=h)
        branch = self.exact(quietly(model.build), omega)
        contact = branch.contact(0, 400)
        self.assertTrue((contact.penetration.max(axis=1) > 0).all())  # all of them pound
        self.near(history(branch)[:, free], own, OWN)
        self.assertLess(branch.full_residual(0), 1e-9)
        for unknowns in ("modal", "gaps"):
            hbm = plm.Hbm(full_basis(model, 60), **RANGE, motion="harmonics", unknowns=unknowns, n_harmonics=50)
            self.near(history(quietly(lambda: hbm.solve(omega / 2 / numpy.pi)))[:, free], own, 2e-3)
        march = plm.Transient(model, frequency_hz=omega / 2 / numpy.pi, periods=120, steps_per_period=6400)
        march.observe([9])
        quietly(march.run)
        self.near(march.history(9)[-6400:][15::16], numpy.roll(own[:, free.index(9)], -1), 1e-3)

    def test_a_box_that_bounces_on_the_table(self):
        """Weight presses a body on a table that moves: nothing else holds it, and it does not follow the table but by contact."""
        m, k = numpy.diag([1.0, 2.0, 0.5]), numpy.zeros((3, 3))
        k[1:, 1:] = 4000 * numpy.array([[1, -1], [-1, 1]])
        c, rows, omega = 3.0 * m + 2e-3 * k, numpy.array([[1.0, -1, 0]]), 20.0
        weight, motion = -9.81 * numpy.diag(m) * [0, 1, 1], {1: {0: 0.027}}  # by 1.1 g
        free, own = self.absolute(m, c, k, rows, [3e4], [0.0], motion, omega, weight)
        model = plm.Model(m, k, c)
        model.fix_dofs([0])
        model.add_gap_rows(rows, 3e4)
        model.set_preload(weight)
        model.set_base_motion([0.027, 0, 0])
        branch = self.exact(quietly(model.build), omega)
        self.assertLess(branch.contact(0, 400).penetration.min(), -1e-5)
        self.near(history(branch)[:, free], own, OWN)

    def test_a_rotor_out_of_balance(self):
        """A disc on a shaft in two soft bearings, x and y each, with a stop beside the disc: m e omega^2, turning."""
        k, n = numpy.zeros((6, 6)), 6
        for axis in (0, 1):
            for bearing in (0, 2):
                at = numpy.eye(n)[2 * bearing + axis]
                shaft = numpy.eye(n)[2 + axis] - at
                k += (900.0 + 200 * axis) * numpy.outer(at, at) + 5e3 * numpy.outer(shaft, shaft)
        m = numpy.diag([0.5, 0.5, 4.0, 4.0, 0.5, 0.5])
        c, rows, me = 4e-3 * k, numpy.eye(n)[2:3], 4e-3
        turning = numpy.zeros(n, complex)
        turning[2:4] = me, -1j * me
        model = plm.Model(m, k, c)
        model.add_gap_rows(rows, 8e3, 2e-3)
        model.set_excitation(turning, power=2)
        quietly(model.build)
        for omega in (14.0, 19.0, 26.0):
            own = Marched(m, c, k, rows, [8e3], [2e-3], {1: omega**2 * turning}, {}, omega).settled(250)
            self.near(history(self.exact(model, omega)), own, 1e-9)


class AbsoluteOutputs(Absolute):
    """Sums of DOFs with the option "absolute_outputs": what marching in absolute coordinates gives, wherever they are looked at."""
    OMEGA, MOTION = 17.0, {1: {0: 0.01}, 2: {0: 0.002 - 0.003j}}

    def setUp(self):
        self.m, self.c, self.k, rows = self.towers()
        self.n, stiffness, gap = len(self.m), [2e4, 2e4, 9e3], [0.002, 0.003, 0.02]
        free, own = self.absolute(self.m, self.c, self.k, rows, stiffness, gap, self.MOTION, self.OMEGA)
        turn = 2 * numpy.pi * numpy.arange(400) / 400
        self.base = sum(numpy.real(moved[0] * numpy.exp(1j * h * turn)) for h, moved in self.MOTION.items())
        self.relative = numpy.column_stack([0 * self.base, own])
        self.own = self.relative + self.base[:, None]  # all follow as one: L = 1
        self.model = plm.Model(self.m, self.k, self.c, absolute_outputs=1)
        self.model.fix_dofs([0])
        self.model.add_gap_rows(rows, stiffness, gap)
        for h, moved in self.MOTION.items():
            self.model.set_base_motion(moved[0] * numpy.eye(self.n)[0], harmonic=h)
        quietly(self.model.build)
        self.sums = numpy.vstack([numpy.eye(self.n), numpy.eye(self.n)[9] - numpy.eye(self.n)[0], numpy.eye(self.n)[9] + 2 * numpy.eye(self.n)[4]])
        self.numbers = self.model.add_outputs(self.sums)
        self.wanted = self.own @ self.sums.T
        self.hz = self.OMEGA / 2 / numpy.pi

    def test_exact_motions(self):
        branch = self.exact(self.model, self.OMEGA)
        harmonics = numpy.fft.rfft(self.own @ self.sums.T, axis=0) / 200
        for number, want, of in zip(self.numbers, self.wanted.T, harmonics.T):
            self.near(branch.history(0, number, 400), want, OWN)
            self.near(branch.amplitude(number, "peak"), numpy.abs(want).max(), 1e-4)  # of instants
            self.near(branch.amplitude(number, "half_peak_to_peak"), 0.5 * numpy.ptp(want), 1e-4)
            self.near(branch.amplitude(number, "rms"), numpy.sqrt((want**2).mean()), 1e-6)
            got = branch.coefficients(0, number)
            self.near(got[1:7:2] - 1j * got[2:7:2], of[1:4], 1e-5)
        for dof in range(1, self.n):  # are relative
            self.near(branch.history(0, dof, 400), self.relative[:, dof], OWN)
        self.near(history(branch), self.relative, OWN)

    def test_harmonic_balance(self):
        for options in (dict(unknowns="modal"), dict(unknowns="gaps"), dict(period_multiple=2)):
            hbm = plm.Hbm(full_basis(self.model, 60), **RANGE, motion="harmonics", n_harmonics=40, **options)
            branch = quietly(lambda: hbm.solve(self.hz))
            many = options.get("period_multiple", 1)
            for number, want in zip(self.numbers, self.wanted.T):
                self.near(branch.history(0, number, 400 * many)[:400], want, 3e-3)
                self.near(branch.amplitude(number, "peak"), numpy.abs(want).max(), 3e-3)
            got = branch.coefficients(0, self.numbers[0])
            want = numpy.zeros(len(got))
            for h, moved in self.MOTION.items():
                want[2 * h * many - 1], want[2 * h * many] = moved[0].real, -moved[0].imag
            self.near(got, want, 1e-12)  # the support itself

    def test_marching(self):
        for of in (self.model, full_basis(self.model, 60)):
            march = plm.Transient(of, frequency_hz=self.hz, periods=120, steps_per_period=3200)
            march.observe([*self.numbers, 9])
            quietly(march.run)
            for number, want in zip([*self.numbers, 9], [*self.wanted.T, self.relative[:, 9]]):
                self.near(march.history(number)[-3200:][7::8], numpy.roll(want, -1), 3e-3)

    def test_marching_at_another_frequency(self):
        """The clock goes on, the excitation begins its period anew: seen at the support itself."""
        for of in (self.model, full_basis(self.model, 60)):
            march = plm.Transient(of, frequency_hz=2.0, periods=3, steps_per_period=64)
            march.observe([self.numbers[0]])
            quietly(march.run)
            march.set_options(dict(frequency_hz=3.1, force_scale=0.5))
            quietly(march.run)
            turn = 2 * numpy.pi * numpy.arange(1, 193) / 64
            want = 0.5 * sum(numpy.real(moved[0] * numpy.exp(1j * h * turn)) for h, moved in self.MOTION.items())
            self.near(march.history(self.numbers[0])[-192:], want, 1e-9)

    def test_peak_error_and_one_call(self):
        number = self.numbers[9]
        answer = quietly(lambda: self.model.compute_response(number, accuracy=1e-3, measure="peak"))
        omega = 2 * numpy.pi * answer.frequency_hz
        self.OMEGA = omega
        m, c, k, rows = self.towers()
        free, own = self.absolute(m, c, k, rows, [2e4, 2e4, 9e3], [0.002, 0.003, 0.02], self.MOTION, omega)
        self.assertLess(abs(answer.amplitude / numpy.abs(own[:, free.index(9)] + self.base).max() - 1), 2e-3)
        at = quietly(lambda: answer.hbm.solve(answer.frequency_hz, answer.curve, int(numpy.argmax(answer.curve.amplitude(number, "peak")))))
        estimate = quietly(lambda: answer.hbm.estimate_error(at, 0, number, "peak"))
        self.assertLess(abs(estimate.amplitude.total), 5e-3 * answer.amplitude)

    def test_by_acceleration_and_with_modal_damping(self):
        """Closed form of the absolute motion of an oscillator, which modal damping damps against its base."""
        omega, a, zeta, w0 = 9.0, 2.0 + 1j, 0.05, 10.0
        model = plm.Model(numpy.eye(2), w0**2 * numpy.array([[1.0, -1], [-1, 1]]), absolute_outputs=1)
        model.fix_dofs([0])
        model.set_modal_damping([zeta])
        model.add_gap_rows([[-1.0, 1]], 50.0, 100.0)
        model.set_base_motion([a, 0], "acceleration")
        quietly(model.build)
        first = model.add_outputs(numpy.eye(2))[0]
        base = -a / omega**2
        want = base * (w0**2 + 2j * zeta * w0 * omega) / (w0**2 - omega**2 + 2j * zeta * w0 * omega)
        for options in (dict(motion="exact"), dict(motion="harmonics")):
            branch = quietly(lambda: plm.Hbm(full_basis(model, 20), **RANGE, **options).solve(omega / 2 / numpy.pi))
            for number, value in ((first, base), (first + 1, want)):
                got = branch.coefficients(0, number)
                self.near(got[1] - 1j * got[2], value, 1e-9)
                self.near(branch.amplitude(number), abs(value), 1e-9)


if __name__ == "__main__":
    unittest.main()
