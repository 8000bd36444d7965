"""Contact between surfaces whose meshes do not match, and forces at rest, on solids."""
import unittest
import warnings

import numpy
import plm
import scipy.linalg
import scipy.sparse

from test_couplings import block


def quads(number):
    """Faces of a plane of nodes, their normals as that of its two axes."""
    return numpy.stack([number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]], -1).reshape(-1, 4)


class Two:
    """A block on another, of faces of their own at z = 1, Poisson's number 0: held below in z, along the sides nowhere."""

    def __init__(self, below, above, gap=0.0, poisson=0.0):
        M, K, xyz, number = block(below, (0, 0, 0), (3, 2, 1), poisson=poisson)
        m, k, more, other = block(above, (0, 0, 1 + gap), (3, 2, 2 + gap), poisson=poisson)
        self.n, self.below, self.above = len(xyz), number, other
        self.mass, self.stiffness = scipy.linalg.block_diag(M, m), scipy.linalg.block_diag(K, k)
        self.model = plm.Model(scipy.sparse.csc_matrix(self.mass), scipy.sparse.csc_matrix(self.stiffness))
        self.dof = numpy.arange(len(self.mass)).reshape(-1, 3)
        self.xyz, self.more = xyz, more
        self.master = self.model.add_surface(self.dof[:self.n], xyz, quads(number[:, :, -1]))
        self.slave = self.model.add_surface(self.dof[self.n:], more, quads(other[:, :, 0])[:, ::-1])

    def hold_loosely(self):
        """Bottom in z, and what else moves rigidly."""
        bottom = self.dof[self.below[:, :, 0].ravel(), 2]
        corner = [self.below[0, 0, 0], self.n + self.above[0, 0, 0]]
        far = [self.below[-1, 0, 0], self.n + self.above[-1, 0, 0]]
        self.fixed = numpy.concatenate([bottom, self.dof[corner, :2].ravel(), self.dof[far, 1]])
        self.model.fix_dofs(self.fixed)


class Surfaces(unittest.TestCase):
    def near(self, got, want, tolerance):
        numpy.testing.assert_allclose(got, want, rtol=tolerance, atol=0)

    def test_rigid_motion_is_free(self):
        """Two loose blocks apart: twelve rigid motions, six of them through the contact, and no word of rounded rows."""
        two = Two((3, 2, 1), (4, 3, 1), gap=0.05)
        two.model.add_surface_contact(two.slave, two.master, 0.1, 1e3, smooth=True)
        with warnings.catch_warnings():
            warnings.simplefilter("error", plm.PlmWarning)
            two.model.build()
        self.assertEqual(two.model.n_rigid_modes, 12)
        self.near(two.model.initial_gap, 0.05, 1e-12)
        closed = two.model.modes(14, "sliding")
        self.assertEqual(numpy.count_nonzero(closed > 1e-4 * closed[-1]), 5)  # three motions more are held, and two are elastic

    def test_wall(self):
        """A rigid wall of faces is as ground contacts with its normal and the distances as gaps; interference comes to rest."""
        M, K, xyz, number = block((2, 2, 1), (0, 0, 0), (2, 2, 1))
        dof, top = numpy.arange(3 * len(xyz)).reshape(-1, 3), number[:, :, -1].ravel()
        wall = numpy.array([[-1, -1, 0.999], [3, -1, 0.999], [3, 3, 0.999], [-1, 3, 0.999]])
        forces = []
        for by_hand in (True, False):
            model = plm.Model(scipy.sparse.csc_matrix(M), scipy.sparse.csc_matrix(K))
            model.fix_dofs(dof[number[:, :, 0].ravel()].ravel())
            if by_hand:
                model.add_ground_contacts(dof[top], [0, 0, 1], 50.0, xyz[top, 2] * 0 - 0.001)
            else:
                nodes = model.add_surface(dof[top].astype(numpy.int32), xyz[top])
                model.add_surface_contact(nodes, model.add_surface(None, wall, [[3, 2, 1, 0]]), 0.1, 50.0)
                self.near(model.surface_interference, 0.001, 1e-10)
                self.assertRegex(model.surface_report, "9 pairs.* 0 of them closed, 9 with interference")
            forces.append(model.build().solve_rest().rest_force)
        self.near(forces[1], forces[0], 1e-12)
        free = numpy.setdiff1d(dof.ravel(), dof[number[:, :, 0].ravel()])
        B = numpy.zeros((9, len(K)))
        B[range(9), dof[top, 2]] = 1
        B = B[:, free]
        q = numpy.linalg.solve(K[numpy.ix_(free, free)] + 50 * B.T @ B, -50 * B.T @ numpy.full(9, 0.001))
        self.near(forces[0], 50 * (B @ q + 0.001), 1e-10)

    def test_force_at_rest(self):
        """To the last digit, whatever k_n; gaps solve K q = f - B^T N, g = B q - N / k_n; pairs that keep theirs do."""
        random = numpy.random.default_rng(3)
        n, z = 8, 3
        a = random.normal(size=(n, n))
        stiffness, B, f = a @ a.T + n * numpy.eye(n), random.normal(size=(z, n)), random.normal(size=n)
        N = numpy.array([2.0, 0.3, 0.7])
        for k in 10.0 ** numpy.arange(-3, 6):
            model = plm.Model(numpy.eye(n), stiffness)
            model.add_gap_rows(B, k)
            model.set_preload(f)
            model.set_rest_force(N)
            model.build().solve_rest()
            numpy.testing.assert_array_equal(model.rest_force, N)
            q = numpy.linalg.solve(stiffness, f - B.T @ N)
            numpy.testing.assert_allclose(model.initial_gap, B @ q - N / k, rtol=1e-11, atol=1e-14)
            numpy.testing.assert_allclose(model.rest_displacement, q, rtol=0, atol=1e-13)
            self.near(stiffness @ model.rest_displacement + B.T @ model.rest_force - f + 1, 1, 1e-12)
            # the same by the gaps found
            again = plm.Model(numpy.eye(n), stiffness)
            again.add_gap_rows(B, k, model.initial_gap)
            again.set_preload(f)
            numpy.testing.assert_allclose(again.build().solve_rest().rest_force, N, rtol=0, atol=1e-13 * max(k, 10))
        # one given, two that keep their gaps, one of which presses
        model = plm.Model(numpy.eye(n), stiffness)
        model.add_gap_rows(B, 20.0, [0.0, -0.1, 5.0])
        model.set_rest_force([1.5, numpy.nan, numpy.nan])
        model.build().solve_rest()
        q = numpy.linalg.solve(stiffness + 20 * numpy.outer(B[1], B[1]), -1.5 * B[0] - 20 * 0.1 * B[1])
        self.near(model.rest_force[:2], [1.5, 20 * (B[1] @ q + 0.1)], 1e-12)
        self.near(model.initial_gap, [B[0] @ q - 1.5 / 20, -0.1, 5], 1e-11)
        self.assertEqual(model.rest_force[2], 0)

    def test_force_at_rest_of_a_loose_body(self):
        """Held by contact alone: what balances the pre-load rests, what does not is refused."""
        for force, rests in ((3.0, True), (2.0, False)):
            model = plm.Model(numpy.eye(2), numpy.array([[5.0, -5], [-5, 5]]))
            model.add_gap_rows([[1.0, 0]], 100.0)
            model.set_preload([1.0, 2.0])
            model.set_rest_force([force])
            if rests:
                self.near(model.build().solve_rest().rest_force, [3], 0)
            else:
                with self.assertRaisesRegex(plm.PlmError, "drives a rigid-body motion"):
                    model.build()


if __name__ == "__main__":
    unittest.main()
