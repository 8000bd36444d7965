"""What the audit says of a model whose nodes have coordinates, against closed forms of a block."""
import re
import unittest

import numpy
import plm
import scipy.linalg
import scipy.sparse

from test_couplings import block

SIDES = numpy.array([120.0, 80.0, 40.0])
STEEL = {"modulus": 2.1e5, "density": 7.85e-9}  # mm-N-t


class Geometry(unittest.TestCase):
    def model(self, M, K, nodes, xyz, pairs=()):
        """pairs: of DOFs a and b, gap and stiffness."""
        model = plm.Model(scipy.sparse.csc_matrix(M), scipy.sparse.csc_matrix(K))
        for a, b, gap in pairs:
            row = numpy.zeros((1, len(M)))
            row[0, a], row[0, b] = 1, -1
            model.add_gap_rows(row, gap=gap, stiffness=1e5)
        model.set_coordinates(nodes, xyz)
        return model.build()

    def findings(self, model, words, severity=None):
        return [f for f in model.audit() if re.search(words, f.text) and (severity is None or f.severity >= severity)]

    def one(self, model, words, severity):
        found = self.findings(model, words)
        self.assertEqual([f.severity for f in found], [severity], found)
        return found[0]

    def test_a_block_of_steel(self):
        """Mass, centre and inertia in closed form: consistent masses are exact for what is linear in the coordinates."""
        for shift in (0, 1000):
            M, K, xyz, _ = block((6, 4, 3), (0, 0, 0), SIDES, **STEEL)
            xyz = xyz + shift
            model = self.model(M, K, numpy.arange(len(M)).reshape(-1, 3), xyz)
            text = self.one(model, "centre of gravity", 0).text
            number = r"(-?[\d.e+-]+)"
            got = [float(x) for x in re.match(
                rf"mass {number}, {number}, {number} in x, y, z; centre of gravity \({number}, {number}, {number}\); "
                rf"moments of inertia about it {number}, {number}, {number} \(xy", text).groups()]
            mass = STEEL["density"] * SIDES.prod()
            inertia = mass / 12 * (numpy.sum(SIDES**2) - SIDES**2)
            want = numpy.concatenate([[mass] * 3, SIDES / 2 + shift, inertia])
            numpy.testing.assert_allclose(got, want, rtol=1e-5)  # as printed
            self.assertIn("mm-N-t", self.one(model, "waves run", 0).text)
            speed = self.findings(model, "waves run")[0].value
            self.assertLess(abs(numpy.log2(speed / numpy.sqrt(2.1e5 / 7.85e-9))), 1)
            self.assertEqual(self.findings(model, "leaves forces"), [])
            self.assertIn("of 3 DOFs", self.one(model, "nodes", 0).text)

    def test_units_that_do_not_belong_together(self):
        """Newtons and millimetres with kilograms; pascals with millimetres; and two systems that do."""
        for modulus, density, scale, severity in ((2.1e5, 7.85e-6, 1, 1), (2.1e11, 7.85e-9, 1, 1), (2.1e11, 7850, 1e-3, 0),
                                                  (7e4, 2.7e-9, 1, 0), (3e3, 1.2e-9, 1, 0)):
            M, K, xyz, _ = block((3, 3, 3), (0, 0, 0), scale * SIDES, modulus=modulus, density=density)
            model = self.model(M, K, numpy.arange(len(M)).reshape(-1, 3), xyz)
            self.one(model, "waves run", severity)

    def test_coordinates_of_other_nodes(self):
        """Two nodes exchanged: translations strain nothing, rotations do."""
        M, K, xyz, _ = block((3, 3, 2), (0, 0, 0), SIDES, **STEEL)
        xyz[[5, 20]] = xyz[[20, 5]]
        model = self.model(M, K, numpy.arange(len(M)).reshape(-1, 3), xyz)
        found = self.findings(model, "leaves forces", 1)
        self.assertEqual(len(found), 3)
        self.assertTrue(all("rotation" in f.text for f in found))

    def test_supports_in_the_matrices(self):
        """Springs to the ground at four nodes are a fact: DOFs and how many."""
        M, K, xyz, number = block((3, 3, 2), (0, 0, 0), SIDES, **STEEL)
        for node in number[0, :, 0]:
            K[3 * node, 3 * node] += 1e4
        model = self.model(M, K, numpy.arange(len(M)).reshape(-1, 3), xyz)
        self.assertEqual(self.one(model, "the translation x leaves forces", 0).value, 4)
        self.assertEqual(self.findings(model, "leaves forces", 1), [])

    def test_springs_to_the_ground_along_the_contact(self):
        """They hide from K alone that z is a translation; the coordinates tell, and a pair along z is as it should be."""
        M, K, xyz, _ = block((2, 2, 2), (0, 0, 0), SIDES, **STEEL)
        nodes = numpy.arange(len(M)).reshape(-1, 3)
        K = K.copy()
        K[nodes[:, 2], nodes[:, 2]] += 100.0
        low, high = (numpy.flatnonzero(xyz[:, 2] == z) for z in (0, SIDES[2]))
        model = self.model(M, K, nodes, xyz, [(nodes[low[0], 2], nodes[high[0], 2], SIDES[2])])
        self.assertEqual(self.findings(model, "no DOF of a translation"), [])
        crossed = self.model(M, K, nodes, xyz, [(nodes[low[0], 2], nodes[high[0], 0], SIDES[2])])
        self.one(crossed, "join component 2 of one node to component 0 of another; were they", 1)

    def test_a_pair_of_rotations(self):
        """Two beams' nodes, six DOFs each, told by their coordinates as they are."""
        eye = 100 * numpy.eye(12)
        nodes, xyz = numpy.arange(12).reshape(2, 6), [[0, 0, 0], [0, 0, 1.0]]
        self.one(self.model(eye / 100, eye, nodes, xyz, [(4, 10, 0)]), r"first: pair 0, DOF 4\) touch no DOF of a translation.*by one\?$", 2)
        self.assertEqual(self.findings(self.model(eye / 100, eye, nodes, xyz, [(2, 8, 0)]), "no DOF of a translation"), [])

    def test_a_plane_model_and_modal_coordinates(self):
        """Without DOFs along z, and three DOFs of no node: nothing is missing."""
        M, K, xyz, number = block((4, 3, 1), (0, 0, 0), SIDES, **STEEL)
        T = numpy.zeros((len(M), 2 * number[:, :, 0].size))  # both sides alike
        for place, (a, b) in enumerate(zip(number[:, :, 0].ravel(), number[:, :, 1].ravel())):
            for k in (0, 1):
                T[3 * a + k, 2 * place + k] = T[3 * b + k, 2 * place + k] = 1
        n = T.shape[1]
        M2 = scipy.linalg.block_diag(T.T @ M @ T, numpy.eye(3) * 1e-4)
        K2 = scipy.linalg.block_diag(T.T @ K @ T, numpy.eye(3) * 1e4)
        nodes = numpy.column_stack([numpy.arange(n).reshape(-1, 2), numpy.full(n // 2, -1)])
        at = xyz[number[:, :, 0].ravel()]
        model = self.model(M2, K2, nodes, at)
        self.assertEqual(self.findings(model, "differs between|outside the box|leaves forces", 0), [])
        self.assertIn("of 2 DOFs", self.one(model, "nodes", 0).text)
        self.assertIn("3 DOFs belong to none", self.one(model, "nodes", 0).text)

    def test_gaps_and_normals(self):
        """Two blocks, one over the other at 0.5: the gap of that sign, of the other, and nodes that are not opposite."""
        M, K, xyz, number = block((2, 2, 2), (0, 0, 0), (10, 10, 10), **STEEL)
        m, k, more, other = block((2, 2, 2), (0, 0, 10.5), (10, 10, 20.5), **STEEL)
        masses, stiffness = scipy.linalg.block_diag(M, m), scipy.linalg.block_diag(K, k)
        at = numpy.vstack([xyz, more])
        low, high = 3 * number[:, :, -1].ravel() + 2, 3 * (other[:, :, 0].ravel() + len(xyz)) + 2
        dof = numpy.arange(len(masses)).reshape(-1, 3)

        def audited(a, b, gap):
            return self.model(masses, stiffness, dof, at, [(i, j, gap) for i, j in zip(a, b)])
        right = audited(low, high, 0.5)
        self.one(right, "gaps are those of the coordinates", 0)
        self.assertEqual(self.findings(right, "gap of one sign|as one body", 0), [])
        self.assertEqual(self.one(audited(low, high, -0.5), "gap of one sign", 1).value, 9)
        self.assertAlmostEqual(self.one(audited(low, high, 0.2), "other than their nodes stand apart", 0).value, 0.3)
        self.assertEqual(self.one(audited(high, low, 0.5), "gap of one sign", 1).value, 9)  # the normal reversed
        self.assertAlmostEqual(self.one(audited(low, high[::-1], 0.5), "as one body", 1).value, 10 * 2**0.5, places=9)

    def test_a_mass_far_outside(self):
        """A tool on an arm of 50 at a node of a structure of size 1: coordinates and matrices of different units look so."""
        arm = numpy.zeros((6, 6))
        arm[:3, :3] = arm[3:, 3:] = numpy.eye(3)
        arm[1, 5], arm[2, 4] = 50, -50  # u = t + w x r, r = (50, 0, 0)
        M = scipy.linalg.block_diag(0.1 * numpy.eye(6), arm.T @ numpy.diag([2, 2, 2, 0.1, 0.1, 0.1]) @ arm)
        K = numpy.kron([[2, -1], [-1, 2]], numpy.eye(6))
        model = self.model(M, K, numpy.arange(12).reshape(2, 6), [[0, 0, 0], [1, 0, 0]])
        self.assertAlmostEqual(self.one(model, "outside the box", 2).value, 2 / 2.1 * 51 - 1, places=9)

    def test_refusals(self):
        model = plm.Model(numpy.eye(6), numpy.eye(6))
        with self.assertRaisesRegex(ValueError, "needed is 2 x 3 or 6"):
            model.set_coordinates([[0, 1, 2]], [[0, 0, 0], [1, 0, 0]])
        model.set_coordinates(numpy.arange(6, dtype=numpy.int32).reshape(2, 3), [[0, 0, 0], [1, 0, 0]])


if __name__ == "__main__":
    unittest.main()
