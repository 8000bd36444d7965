"""Constraints are eliminated inside: what is tied moves as what was never cut, and all answers stay in the DOFs handed over."""
import unittest
import warnings

import numpy
import plm
import scipy.linalg
import scipy.sparse

ELEMENTS = 8
ENDS = 2 * ELEMENTS  # DOFs of a beam held at its left end


def beam(n, length):
    """Mass and stiffness of a beam of n elements: deflection and rotation of n + 1 nodes."""
    h = length / n
    k = 175 / h**3 * numpy.array([[12, 6 * h, -12, 6 * h], [6 * h, 4 * h * h, -6 * h, 2 * h * h],
                                  [-12, -6 * h, 12, -6 * h], [6 * h, 2 * h * h, -6 * h, 4 * h * h]])
    m = 0.78 * h / 420 * numpy.array([[156, 22 * h, 54, -13 * h], [22 * h, 4 * h * h, 13 * h, -3 * h * h],
                                      [54, 13 * h, 156, -22 * h], [-13 * h, -3 * h * h, -22 * h, 4 * h * h]])
    mass, stiffness = numpy.zeros((2 * n + 2, 2 * n + 2)), numpy.zeros((2 * n + 2, 2 * n + 2))
    for e in range(n):
        mass[2 * e:2 * e + 4, 2 * e:2 * e + 4] += m
        stiffness[2 * e:2 * e + 4, 2 * e:2 * e + 4] += k
    return mass, stiffness


def whole():
    """A cantilever with a breathing crack in its middle: two beams with a deflection of their own each, joined by a row of T
    and a spring of rotation. Returns M, K, T of the two beams side by side from the merged one, its gap row."""
    left, right = beam(ELEMENTS, 0.5), beam(ELEMENTS, 0.5)
    mass, stiffness = (scipy.linalg.block_diag(left[i][2:, 2:], right[i]) for i in (0, 1))
    turn = numpy.zeros(len(mass))
    turn[ENDS - 1], turn[ENDS + 1] = 1, -1
    stiffness += 90 * numpy.outer(turn, turn)
    return mass, stiffness, turn


def row(n, **of):
    r = numpy.zeros(n)
    for dof, c in of.items():
        r[int(dof[1:])] = c
    return r


def cut():
    """The same, and what it takes to join the deflections."""
    mass, stiffness, turn = whole()
    n = len(mass)
    tie = numpy.zeros((1, n))
    tie[0, ENDS - 2], tie[0, ENDS] = 1, -1
    merge = numpy.delete(numpy.eye(n), ENDS, axis=1)
    merge[ENDS, ENDS - 2] = 1
    return mass, stiffness, turn, tie, merge


def with_loads(model, turn, force, rayleigh=(0.0, 2e-5)):
    model.set_rayleigh_damping(*rayleigh)
    model.add_gap_rows(turn[None], stiffness=5e3)
    model.set_excitation(force)
    return model.build()


def quietly(work):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", plm.PlmWarning)
        return work()


class Constraints(unittest.TestCase):
    def near(self, got, want, tolerance):
        numpy.testing.assert_allclose(got, want, rtol=tolerance, atol=0)

    def pair(self):
        """The cut beam tied, and the merged one. Both are driven at the joint, at the DOF that the tie may give by the other."""
        mass, stiffness, turn, tie, merge = cut()
        force = numpy.zeros(len(mass))
        force[ENDS] = 2.0
        tied = plm.Model(mass, stiffness)
        tied.add_constraints(tie)
        merged = plm.Model(merge.T @ mass @ merge, merge.T @ stiffness @ merge)
        return (with_loads(tied, turn, force), with_loads(merged, turn @ merge, merge.T @ force), merge)

    def test_tied_parts_vibrate_as_the_merged_mesh(self):
        tied, merged, merge = self.pair()
        self.assertEqual((tied.n_dof, tied.n_free, tied.n_redundant_constraints), (4 * ELEMENTS + 2, 4 * ELEMENTS + 1, 0))
        for system in ("open", "sliding"):
            hz, shapes = tied.modes(12, system, shapes=True)
            self.near(hz, merged.modes(12, system), 1e-10)
            self.near(shapes[ENDS], shapes[ENDS - 2], 1e-15)

    def test_peak_of_a_tied_cracked_beam(self):
        tied, merged, merge = self.pair()
        for dof in (ENDS, ENDS - 2):  # one of them is the dependent one
            got = tied.compute_response(dof, measure="peak")
            want = merged.compute_response(ENDS - 2, measure="peak")
            self.near([got.frequency_hz, got.amplitude], [want.frequency_hz, want.amplitude], 1e-9)
            q = got.curve.coefficients(len(got.curve) // 2)
            self.near(q[:, ENDS], q[:, ENDS - 2], 1e-15)

    def test_marching_observes_dependent_dofs(self):
        tied, merged, merge = self.pair()
        hz = float(merged.modes(1)[0])
        values = []
        for m, dof in ((tied, ENDS), (merged, ENDS - 2)):
            motion = plm.Transient(m, frequency_hz=hz, periods=3, steps_per_period=64)
            motion.observe([dof])
            values.append(motion.run().history(dof))
        scale = numpy.abs(values[1]).max()
        self.assertGreater(scale, 0)
        numpy.testing.assert_allclose(values[0], values[1], rtol=0, atol=1e-9 * scale)

    def test_rigid_link_of_six_dofs(self):
        """Four nodes of an elastic body follow a heavy reference node, whose own DOFs are held by springs; the deformation that
        is left against T^T K T, made by hand."""
        random = numpy.random.default_rng(3)
        nodes, n = random.uniform(-500, 500, (10, 3)), 36  # mm; DOFs 30 .. 35: the reference node, at the origin
        a = random.normal(size=(30, 30))
        stiffness, mass = numpy.zeros((n, n)), numpy.zeros((n, n))
        stiffness[:30, :30] = a @ a.T + 5 * numpy.eye(30)
        mass[:30, :30] = numpy.diag(random.uniform(1, 2, 30))
        stiffness[30:, 30:] = numpy.diag([3, 4, 5, 3e5, 4e5, 5e5])
        mass[30:, 30:] = numpy.diag([2, 2, 2, 1e5, 1e5, 1e5])
        rows, by_hand = numpy.zeros((12, n)), numpy.eye(n)
        for i in range(4):
            x, y, z = nodes[i]
            arm = numpy.array([[0, z, -y], [-z, 0, x], [y, -x, 0]])  # u = u_0 + theta x r
            at = slice(3 * i, 3 * i + 3)
            rows[at, at], rows[at, 30:33], rows[at, 33:] = numpy.eye(3), -numpy.eye(3), -arm
            by_hand[at] = 0
            by_hand[at, 30:33], by_hand[at, 33:] = numpy.eye(3), arm
        by_hand = by_hand[:, 12:]
        want = scipy.linalg.eigh(by_hand.T @ stiffness @ by_hand, by_hand.T @ mass @ by_hand, eigvals_only=True)
        turned = scipy.linalg.qr(random.normal(size=(12, 12)))[0] @ rows  # the same, said otherwise
        wide = scipy.sparse.csr_matrix(turned)
        wide.indptr, wide.indices = wide.indptr.astype(numpy.int64), wide.indices.astype(numpy.int64)
        for given in (rows, wide):
            model = plm.Model(mass, stiffness)
            model.add_constraints(given)
            model.build()
            self.assertEqual(model.n_free, 24)
            hz, shapes = model.modes(24, shapes=True)
            self.near((2 * numpy.pi * hz)**2, want, 1e-10)
            self.assertLess(numpy.abs(rows @ shapes).max(), 1e-11 * 500 * numpy.abs(shapes).max())

    def test_rows_as_they_are_merged_and_refused(self):
        mass, stiffness, turn, tie, merge = cut()
        model = plm.Model(mass, stiffness)
        for factor in range(1, 1001):
            model.add_constraints(tie * factor)
        model.fix_dofs([ENDS])
        model.add_constraints(row(len(mass), d1=3)[None])
        model.build()
        self.assertEqual((model.n_free, model.n_redundant_constraints), (len(mass) - 3, 999))
        self.assertTrue((model.modes(3, shapes=True)[1][[1, ENDS - 2, ENDS]] == 0).all())

        model = plm.Model(mass, stiffness)
        model.add_constraints(tie)
        model.add_constraints(tie * (1 + 1e-8 * (turn == 0)) + 1e-8 * tie * (numpy.arange(len(mass)) == ENDS))
        with self.assertWarnsRegex(plm.PlmWarning, "constraint row 1 "):
            model.build()
        self.assertEqual(model.warning_reasons[0], plm.REASON_ROUNDED)

        zeros = scipy.sparse.csr_matrix(tie + 2)
        zeros.data -= 2
        model = plm.Model(mass, stiffness)
        model.add_constraints(zeros)
        self.assertEqual(zeros.nnz, len(mass))  # the caller's own
        model.add_gap_rows(tie)
        with self.assertRaisesRegex(plm.PlmError, "pair 0 .*tied to one another"):
            model.build()
        model = plm.Model(mass, stiffness)
        model.add_constraints(numpy.eye(len(mass)))
        with self.assertRaisesRegex(plm.PlmError, "leave nothing to move"):
            model.build()
        with self.assertRaisesRegex(ValueError, "row 0 of rows is all zeros.*says nothing"):
            plm.Model(mass, stiffness).add_constraints(tie * 0)

    def test_a_body_made_rigid_is_rigid(self):
        """All of a free beam follows one of its nodes: two rigid motions, and no noise of the elements in their place."""
        mass, stiffness = beam(ELEMENTS, 1.0)
        n = len(mass)
        rows = numpy.zeros((n - 2, n))
        for k in range(1, ELEMENTS + 1):
            rows[2 * k - 2, [2 * k, 0, 1]] = 1, -1, -k / ELEMENTS
            rows[2 * k - 1, [2 * k + 1, 1]] = 1, -1
        model = plm.Model(mass, stiffness)
        model.add_constraints(rows)
        model.add_gap_rows(row(n, d0=1)[None], stiffness=1e3)
        quietly(model.build)
        self.assertEqual((model.n_free, model.n_rigid_modes), (2, 2))
        level = numpy.array([[1, 0], [0, 1]])
        by_hand = numpy.array([level[0] + (i // 2) / ELEMENTS * level[1] if i % 2 == 0 else level[1] for i in range(n)], float)
        lever = by_hand.T @ mass @ by_hand
        self.near(model.modes(2, "sliding")[1], numpy.sqrt(1e3 * numpy.linalg.inv(lever)[0, 0]) / (2 * numpy.pi), 1e-9)

    def test_multipliers_of_the_host(self):
        """Refused as they are; handed over as what they are, or fixed and their rows as constraints, the model that was meant."""
        mass, stiffness, turn, tie, merge = cut()
        n = len(mass)
        bordered = numpy.block([[stiffness, tie.T], [tie, numpy.zeros((1, 1))]])
        model = plm.Model(scipy.sparse.csc_matrix(scipy.linalg.block_diag(mass, 0)), scipy.sparse.csc_matrix(bordered))
        with self.assertRaisesRegex(plm.PlmError, "Lagrange multipliers.*as multipliers of the model"):
            model.build()
        by_hand = plm.Model(scipy.sparse.csc_matrix(scipy.linalg.block_diag(mass, 0)), scipy.sparse.csc_matrix(bordered))
        by_hand.fix_dofs([n])
        by_hand.add_constraints(numpy.append(tie, [[0.0]], axis=1))
        merged = plm.Model(merge.T @ mass @ merge, merge.T @ stiffness @ merge).build().modes(5)
        self.near(by_hand.build().modes(5), merged, 1e-10)
        model.set_multipliers(numpy.array([n], dtype=numpy.int32))
        model.set_multipliers([n])
        hz, shapes = model.build().modes(5, shapes=True)
        self.near(hz, merged, 1e-10)
        self.assertTrue((shapes[n] == 0).all())

    def test_recovery_of_a_tied_superelement(self):
        mass, stiffness, turn, tie, merge = cut()
        n, force = len(mass), numpy.zeros(len(mass))
        force[ENDS] = 2.0
        way = numpy.random.default_rng(1).normal(size=(5, n))
        way[0] = numpy.eye(n)[ENDS]
        model = plm.Model(mass, stiffness)
        model.add_constraints(tie)
        model.set_recovery(lambda q: way @ q, 5)
        with_loads(model, turn, force)
        curve = quietly(lambda: model.compute_response(ENDS)).curve
        self.near(model.recover_amplitude(curve, 0, "harmonic", 1), curve.amplitude(ENDS, "harmonic", 1), 1e-12)


if __name__ == "__main__":
    unittest.main()
