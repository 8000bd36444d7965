"""Rigid links, distributing couplings and ties, from coordinates, against T^T K T made by hand."""
import time
import unittest
import warnings

import numpy
import plm
import scipy.linalg

UNITS = (1.0, 1000.0)  # m, mm


def arm(r):
    """u = u_0 + arm(r) @ theta."""
    x, y, z = r
    return numpy.array([[0, z, -y], [-z, 0, x], [y, -x, 0]])


def body(seed, nodes, more, unit=1.0):
    """An elastic body of nodes with 3 DOFs each, and `more` nodes of 6 DOFs, every one on springs of its own: M, K, coordinates.
    unit: how many make a metre, of lengths alone."""
    random = numpy.random.default_rng(seed)
    xyz = random.uniform(-0.5, 0.5, (nodes + more, 3))
    a = random.normal(size=(3 * nodes, 3 * nodes))
    stiffness, mass = a @ a.T + 5 * numpy.eye(3 * nodes), numpy.diag(random.uniform(1, 2, 3 * nodes))
    for _ in range(more):
        turn = unit**2 * random.uniform(0.1, 0.5, (2, 3))  # torque by angle, moments of inertia
        stiffness = scipy.linalg.block_diag(stiffness, numpy.diag([3, 4, 5]), numpy.diag(turn[0]))
        mass = scipy.linalg.block_diag(mass, numpy.diag([2, 2, 2]), numpy.diag(turn[1]))
    return mass, stiffness, unit * xyz


def by_hand(mass, stiffness, T):
    return scipy.linalg.eigh(T.T @ stiffness @ T, T.T @ mass @ T, eigvals_only=True)


def fit(xyz, centre, weight):
    """The rigid motion about `centre`, 6 x 3 n, of the translations of nodes at xyz: weighted least squares."""
    G = numpy.vstack([numpy.hstack([numpy.eye(3), arm(r - centre)]) for r in xyz])
    W = numpy.repeat(weight, 3)
    return numpy.linalg.solve(G.T @ (W[:, None] * G), G.T * W)


def block(cells, low, high, modulus=100.0, poisson=0.3, density=1.0):
    """A block of 8-node bricks: M, K, coordinates, and the numbers of the nodes as an array nx + 1 x ny + 1 x nz + 1."""
    lines = [numpy.linspace(a, b, n + 1) for a, b, n in zip(low, high, cells)]
    xyz = numpy.stack(numpy.meshgrid(*lines, indexing="ij"), -1).reshape(-1, 3)
    number = numpy.arange(len(xyz)).reshape([n + 1 for n in cells])
    at = numpy.array([[i, j, k] for i in (0, 1) for j in (0, 1) for k in (0, 1)])
    size = (numpy.array(high) - low) / cells
    D = numpy.zeros((6, 6))
    D[:3, :3] = poisson
    D[range(6), range(6)] = [1 - poisson] * 3 + [0.5 - poisson] * 3
    D *= modulus / (1 + poisson) / (1 - 2 * poisson)
    k, m = numpy.zeros((24, 24)), numpy.zeros((24, 24))
    for p in (2 * at - 1) / numpy.sqrt(3):
        N = numpy.prod(1 + (2 * at - 1) * p, axis=1) / 8
        x, y, z = ((2 * at[:, a] - 1) * N / (1 + (2 * at[:, a] - 1) * p[a]) * 2 / size[a] for a in range(3))
        B = numpy.zeros((6, 8, 3))
        B[0, :, 0], B[1, :, 1], B[2, :, 2] = x, y, z
        B[3, :, 1], B[3, :, 2], B[4, :, 0], B[4, :, 2], B[5, :, 0], B[5, :, 1] = z, y, z, x, y, x
        B = B.reshape(6, 24)
        k += B.T @ D @ B * numpy.prod(size) / 8
        m += density * numpy.kron(numpy.outer(N, N), numpy.eye(3)) * numpy.prod(size) / 8
    M, K = numpy.zeros((3 * len(xyz),) * 2), numpy.zeros((3 * len(xyz),) * 2)
    for cell in numpy.ndindex(*cells):
        dof = (3 * number[tuple((at + cell).T)][:, None] + numpy.arange(3)).ravel()
        M[numpy.ix_(dof, dof)] += m
        K[numpy.ix_(dof, dof)] += k
    return M, K, xyz, number


def two_blocks(above):
    """One on the other, with faces of their own at z = 1: a tied model, the lower one's cells being 3 x 2 x 2."""
    M, K, xyz, number = block((3, 2, 2), (0, 0, 0), (3, 2, 1))
    m, k, more, other = block(above, (0, 0, 1), (3, 2, 2))
    n = len(xyz)
    model = plm.Model(scipy.sparse.csc_matrix(scipy.linalg.block_diag(M, m)), scipy.sparse.csc_matrix(scipy.linalg.block_diag(K, k)))
    top, dof = number[:, :, -1], numpy.arange(3 * (n + len(more))).reshape(-1, 3)
    faces = numpy.stack([top[:-1, :-1], top[1:, :-1], top[1:, 1:], top[:-1, 1:]], -1).reshape(-1, 4)
    under = other[:, :, 0].ravel()
    model.add_tie(dof[n + under], more[under], dof[:n], xyz, faces, 1e-3)
    model.add_gap_rows(numpy.eye(1, dof.size, dof.size - 1), stiffness=1.0)
    return model, number, n + other


class Couplings(unittest.TestCase):
    def near(self, got, want, tolerance):
        numpy.testing.assert_allclose(got, want, rtol=tolerance, atol=0)

    def eigenvalues(self, mass, stiffness, couple, n_free):
        model = plm.Model(mass, stiffness)
        couple(model)
        model.build()
        self.assertEqual(model.n_free, n_free)
        hz, shapes = model.modes(n_free, shapes=True)
        return (2 * numpy.pi * hz)**2, shapes

    def test_rigid_link(self):
        """Nodes of solids and one with rotations; the dependent ones keep their springs and masses."""
        for unit in UNITS:
            mass, stiffness, xyz = body(1, 8, 2, unit)
            T = numpy.eye(36)
            for i in range(4):
                T[3 * i:3 * i + 3] = 0
                T[3 * i:3 * i + 3, 24:27], T[3 * i:3 * i + 3, 27:30] = numpy.eye(3), arm(xyz[i] - xyz[8])
            T[30:] = 0
            T[30:33, 24:27], T[30:33, 27:30], T[33:, 27:30] = numpy.eye(3), arm(xyz[9] - xyz[8]), numpy.eye(3)
            T = T[:, 12:30]

            def couple(model):
                hub = numpy.arange(24, 30)
                model.add_rigid_link(hub, xyz[8], numpy.arange(12).reshape(4, 3), xyz[:4])
                model.add_rigid_link(hub.astype(numpy.int32), xyz[8], numpy.arange(30, 36, dtype=numpy.int32), xyz[9])
            got, shapes = self.eigenvalues(mass, stiffness, couple, 18)
            self.near(got, by_hand(mass, stiffness, T), 1e-12)
            self.assertLess(numpy.abs(shapes - T @ shapes[12:30]).max(), 1e-12 * numpy.abs(shapes).max())

    def test_distributing_coupling(self):
        """A heavy reference node on springs of its own, coupled to five of eight nodes with weights."""
        for unit in UNITS:
            mass, stiffness, xyz = body(2, 8, 1, unit)
            weight = numpy.array([1, 2, 0.5, 3, 1])
            T = numpy.zeros((30, 24))
            T[:24], T[24:, :15] = numpy.eye(24), fit(xyz[:5], xyz[8], weight)
            got, shapes = self.eigenvalues(
                mass, stiffness, lambda model: model.add_distributing_coupling(
                    numpy.arange(24, 30), xyz[8], numpy.arange(15).reshape(5, 3), xyz[:5], weight), 24)
            self.near(got, by_hand(mass, stiffness, T), 1e-12)
            # what is left out or made by the elimination of another DOF is the same motion
            self.assertLess(numpy.abs(shapes[24:] - T[24:] @ shapes[:24]).max(), 1e-12 * numpy.abs(shapes).max())

    def test_reference_without_rotations(self):
        """Its translations follow the rigid motion all the same, away from the centre too."""
        mass, stiffness, xyz = body(3, 6, 1)
        mass, stiffness = mass[:21, :21], stiffness[:21, :21]
        T = numpy.zeros((21, 18))
        T[:18], T[18:, :18] = numpy.eye(18), fit(xyz[:6], xyz[6], numpy.ones(6))[:3]
        got, _ = self.eigenvalues(mass, stiffness, lambda model: model.add_distributing_coupling(
            numpy.arange(18, 21, dtype=numpy.int32), xyz[6], numpy.arange(18, dtype=numpy.int32).reshape(6, 3), xyz[:6]), 18)
        self.near(got, by_hand(mass, stiffness, T), 1e-12)

    def test_a_chain_of_couplings(self):
        """A mean of nodes, a link from it to a node with a link to another: given from the end on."""
        for unit in UNITS:
            mass, stiffness, xyz = body(4, 7, 3, unit)
            nodes = numpy.arange(12).reshape(4, 3)
            hubs = [numpy.arange(21 + 6 * k, 27 + 6 * k) for k in range(3)]
            T = numpy.zeros((39, 21))
            T[:21] = numpy.eye(21)
            T[21:27, :12] = fit(xyz[:4], xyz[7], numpy.ones(4))
            for k in (0, 1):
                below = slice(21 + 6 * k, 27 + 6 * k)
                T[27 + 6 * k:30 + 6 * k] = T[below][:3] + arm(xyz[8 + k] - xyz[7 + k]) @ T[below][3:]
                T[30 + 6 * k:33 + 6 * k] = T[below][3:]

            def couple(model):
                model.add_rigid_link(hubs[1], xyz[8], hubs[2], xyz[9])
                model.add_rigid_link(hubs[0], xyz[7], hubs[1], xyz[8])
                model.add_distributing_coupling(hubs[0], xyz[7], nodes, xyz[:4])
            got, _ = self.eigenvalues(mass, stiffness, couple, 21)
            self.near(got, by_hand(mass, stiffness, T), 1e-12)

    def test_a_force_at_the_reference_goes_to_the_nodes(self):
        """Its shares have the same resultant and moment, and the statics are those of the shares."""
        mass, stiffness, xyz = body(5, 6, 1)
        stiffness[18:, 18:], mass[18:, 18:] = 0, 0
        reference, force = xyz[6], numpy.zeros(24)
        force[18:] = 1, -2, 3, 0.4, 0.5, -0.6
        model = plm.Model(mass, stiffness)
        model.add_distributing_coupling(numpy.arange(18, 24), reference, numpy.arange(18).reshape(6, 3), xyz[:6])
        model.add_gap_rows(numpy.eye(1, 24), gap=1e6, stiffness=1.0)
        model.set_preload(force)
        model.build().solve_rest()
        shares = stiffness[:18, :18] @ model.rest_displacement[:18]
        G = numpy.vstack([numpy.hstack([numpy.eye(3), arm(r - reference)]) for r in xyz[:6]])
        self.near(G.T @ shares, force[18:], 1e-11)
        want = numpy.linalg.solve(stiffness[:18, :18], fit(xyz[:6], reference, numpy.ones(6)).T @ force[18:])
        self.near(model.rest_displacement[:18], want, 1e-10)

    def test_tied_meshes(self):
        """Nodes of one body on faces of another, of every kind; against shape functions written down here."""
        random = numpy.random.default_rng(7)
        corners = numpy.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
        middles = numpy.array([[0, -1], [1, 0], [0, 1], [-1, 0]])

        def shape(kind, s, t):
            if kind == 3:
                return numpy.array([1 - s - t, s, t])
            if kind == 6:
                r = 1 - s - t
                return numpy.array([r * (2 * r - 1), s * (2 * s - 1), t * (2 * t - 1), 4 * r * s, 4 * s * t, 4 * t * r])
            a, b = corners.T
            if kind == 4:
                return (1 + s * a) * (1 + t * b) / 4
            c, d = middles.T
            return numpy.concatenate([(1 + s * a) * (1 + t * b) * (s * a + t * b - 1) / 4,
                                      numpy.where(c == 0, (1 - s * s) * (1 + t * d), (1 + s * c) * (1 - t * t)) / 2])
        triangle = numpy.array([[0, 0], [1, 0], [0, 1], [0.5, 0], [0.5, 0.5], [0, 0.5]])
        for kind in (3, 4, 6, 8):
            at = triangle[:kind] if kind in (3, 6) else numpy.vstack([corners, middles])[:kind]
            surface = numpy.column_stack([30 * at, 2 * at[:, 0] * at[:, 1]]) + random.uniform(-1, 1, (kind, 3))
            places = random.uniform(0.1, 0.4, (3, 2))
            N = numpy.array([shape(kind, *p) for p in places])
            n = 3 * (kind + 3)
            a = random.normal(size=(n, n))
            mass, stiffness = numpy.diag(random.uniform(1, 2, n)), a @ a.T + 5 * numpy.eye(n)
            T = numpy.vstack([numpy.eye(3 * kind), numpy.kron(N, numpy.eye(3))])
            dof = numpy.arange(n, dtype=numpy.int32).reshape(-1, 3)

            def couple(model):
                distance = model.add_tie(dof[kind:], N @ surface, dof[:kind], surface, numpy.arange(kind, dtype=numpy.int32)[None], 0.1)
                self.assertLess(distance.max(), 1e-12)
                model.add_tie(dof[kind:kind + 1].astype(int), N[:1] @ surface, dof[:kind].astype(int), surface, [range(kind)], 0.1)
            got, _ = self.eigenvalues(mass, stiffness, couple, 3 * kind)
            self.near(got, by_hand(mass, stiffness, T), 1e-11)

    def test_tied_blocks_vibrate_as_the_merged_mesh(self):
        model, number, other = two_blocks((3, 2, 2))
        M, K, _, merged = block((3, 2, 4), (0, 0, 0), (3, 2, 2))
        whole = plm.Model(scipy.sparse.csc_matrix(M), scipy.sparse.csc_matrix(K))
        for held, bottom in ((model, number), (whole, merged)):
            held.fix_dofs(3 * bottom[:, :, 0].ravel()[:, None] + numpy.arange(3))
        self.near(model.build().modes(20), whole.build().modes(20), 1e-10)

    def test_a_tie_of_meshes_that_do_not_match_strains_nothing(self):
        """Six rigid motions are left, and the stiffness of the whole is about that of the merged mesh."""
        model, _, _ = two_blocks((5, 3, 2))
        M, K, _, _ = block((3, 2, 4), (0, 0, 0), (3, 2, 2))
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", plm.PlmWarning)
            model.build()
        self.assertEqual(model.n_rigid_modes, 6)
        want = numpy.sqrt(scipy.linalg.eigh(K, M, eigvals_only=True)[6:9]) / (2 * numpy.pi)
        self.near(model.modes(9)[6:], want, 0.05)

    def test_what_stays_untied(self):
        mass, stiffness, _ = body(8, 6, 0)
        dof, square = numpy.arange(18).reshape(6, 3), numpy.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
        model = plm.Model(mass, stiffness)
        with self.assertWarnsRegex(plm.PlmWarning, "1 of 2 nodes stay free.*tolerance 0.1.*node 1 .*, at 2"):
            distance = model.add_tie(dof[4:], [[0.5, 0.5, 0.02], [0.5, 0.5, -2]], dof[:4], square, [[0, 1, 2, 3]], 0.1)
        self.near(distance, [0.02, 2], 1e-13)
        self.near([model.n_untied_nodes, model.tie_distance], [1, 0.02], 1e-13)
        with self.assertRaisesRegex(ValueError, "surface_dof has 4 nodes, surface_xyz 3"):
            model.add_tie(dof[4:], square[:2], dof[:4], square[:3], [[0, 1, 2]], 0.1)
        with self.assertRaisesRegex(plm.PlmError, "face 0 has 2 nodes"):
            model.add_tie(dof[4:], square[:2], dof[:4], square, [[0, 1]], 0.1)
        self.assertEqual(model.build().n_free, 15)

    def test_many_couplings_one_by_one(self):
        """They cost as many as there are: half a second, where a copy of all before for each of them takes minutes."""
        n = 20_000
        dof, model = numpy.arange(6 * n).reshape(-1, 6), plm.Model(n_dof=6 * n)
        before = time.process_time()
        for i in range(1, n):
            model.add_rigid_link(dof[0], [0, 0, 0], dof[i], [1, 2, 3])
        self.assertLess(time.process_time() - before, 20)

    def lowest_of(self, mass, stiffness, rows, shift, count):
        """Of the structure under rows q = 0, by Lagrange multipliers: no elimination, no sums."""
        zero = scipy.sparse.csc_matrix((len(rows), len(rows)))
        K = scipy.sparse.bmat([[scipy.sparse.csc_matrix(stiffness), rows.T], [rows, None]], "csc")
        M = scipy.sparse.block_diag([scipy.sparse.csc_matrix(mass), zero], "csc")
        factor = scipy.sparse.linalg.splu(K + shift * M)
        inverse = scipy.sparse.linalg.LinearOperator(K.shape, lambda x: factor.solve(M @ x))
        value = scipy.sparse.linalg.eigs(inverse, count, return_eigenvectors=False, tol=1e-13).real
        return numpy.sort(1 / value) - shift

    def test_a_wide_mean_with_stiffness_and_mass_of_its_own(self):
        """The reference of 441 nodes is an instrument on springs, is held, or floats with all that hangs at it: what
        stands at it would couple 1,323 DOFs, and by way of sums over few nodes couples few."""
        mass, stiffness, xyz, number = block((20, 20, 2), (0, 0, 0), (20, 20, 2))
        n, top = len(mass), number[:, :, -1].ravel()
        mass, stiffness = scipy.sparse.csc_matrix(mass), scipy.sparse.csc_matrix(stiffness)
        rows = numpy.zeros((6, n + 6))
        G = fit(xyz[top], numpy.array([9, 12, 4]), numpy.ones(len(top)))
        rows[:, (3 * top[:, None] + numpy.arange(3)).ravel()] = -G
        rows[:, n:] = numpy.eye(6)
        springs = numpy.diag([30, 40, 50, 900, 800, 700])
        for own, held, shift in ((springs, False, 0), (springs, True, 0), (0 * springs, False, 0.01)):
            M = scipy.sparse.block_diag([mass, numpy.diag([200, 200, 200, 5e3, 6e3, 7e3])], "csc")
            K = scipy.sparse.block_diag([stiffness, own], "csc")
            model = plm.Model(M, K)
            model.add_distributing_coupling(numpy.arange(n, n + 6), [9, 12, 4], numpy.arange(n).reshape(-1, 3)[top], xyz[top])
            kept = slice(0, n if held else n + 6)
            if held:
                model.fix_dofs(numpy.arange(n, n + 6))
            model.build()
            self.assertEqual(model.n_free, n - 6 if held else n)
            hz, shapes = model.modes(12, shapes=True)
            want = self.lowest_of(M[kept, kept], K[kept, kept], rows[:, kept], shift, 12)
            scale = want[-1]
            self.assertLess(numpy.abs((2 * numpy.pi * hz)**2 - want).max(), 1e-9 * scale)  # of ARPACK, here and there
            self.assertLess(numpy.abs(rows @ shapes).max(), 1e-10 * numpy.abs(shapes).max())

    def test_refusals(self):
        mass, stiffness, xyz = body(6, 4, 1)
        model = plm.Model(mass, stiffness)
        nodes = numpy.arange(12).reshape(4, 3)
        with self.assertRaisesRegex(ValueError, "reference_dof has 4 DOFs"):
            model.add_rigid_link([12, 13, 14, 15], xyz[4], nodes, xyz[:4])
        with self.assertRaisesRegex(ValueError, "dependent_dof has shape .4, 3.; needed is 3 x 3 or 6"):
            model.add_rigid_link([12, 13, 14], xyz[4], nodes, xyz[:3])
        with self.assertRaisesRegex(ValueError, "xyz has shape .4, 2."):
            model.add_distributing_coupling([12, 13, 14], xyz[4], nodes, xyz[:4, :2])
        with self.assertRaisesRegex(ValueError, "weight has shape"):
            model.add_distributing_coupling([12, 13, 14], xyz[4], nodes, xyz[:4], [1, 2])
        with self.assertRaisesRegex(plm.PlmError, "at one point"):
            model.add_distributing_coupling(numpy.arange(12, 18), xyz[4], nodes, xyz[[0, 0, 0, 0]])
        model.add_rigid_link([12, 13, 14], xyz[4], nodes, xyz[:4])  # nothing of the others has stayed
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", plm.PlmWarning)
            self.assertEqual(model.build().n_free, 6)


if __name__ == "__main__":
    unittest.main()
