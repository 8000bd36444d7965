"""One model written in every format and read back: the same matrices, and the same nonlinear curve to 1e-12."""
import os
import tempfile
import unittest
import warnings

import models
import numpy
import plm
import scipy.io
import scipy.sparse
from plm.fe import Matrices, read_matrices, write_matrices

# Formats that hold every digit: the matrices must come back as they were.
EXACT = [("market", {}), ("calculix", {}), ("abaqus", {}), ("abaqus-coordinate", {}), ("abaqus-substructure", {}), ("harwell-boeing", {}),
         ("ansys", {}), ("dmig", {"free": True})]
EXACT += [("output4", {"layout": layout}) for layout in ("dense", "sparse", "bigmat")]
EXACT += [("output4-binary", {"layout": layout, "byteorder": order}) for layout in ("dense", "sparse", "bigmat") for order in "<>"]
# 13 digits at least in 16 characters; single precision in binary, ten digits in ASCII
ROUNDED = [("dmig", {}, 5e-14), ("output4", {"precision": "single"}, 5e-10), ("output4-binary", {"precision": "single"}, 6e-8)]

FREQUENCIES = (3.4, 4.0, 4.4)  # Hz, up a resonance


def scattered_chain(damped):
    """The chain of models.py with numbers that have no end, on labels of nodes out of order."""
    random = numpy.random.default_rng(9)
    mass, stiffness = models.matrices()
    scale = scipy.sparse.diags(random.uniform(0.9, 1.1, models.DOFS))
    labels = random.permutation(numpy.arange(10, 10 + models.NODES)) * 13
    dofs = numpy.column_stack([numpy.repeat(labels, 3), numpy.tile([1, 2, 3], models.NODES)])
    mass, stiffness = (scipy.sparse.tril(scale @ m @ scale, format="csr") for m in (mass, stiffness))
    mass, stiffness = (m + scipy.sparse.tril(m, -1).T for m in (mass, stiffness))  # symmetric to the last digit
    loads = random.normal(size=(models.DOFS, 2))
    return Matrices(stiffness, mass, 0.3 * mass + 1.1e-4 * stiffness if damped else None, dofs, "chain", loads=loads if damped else None)


def relabelled(matrices, rows, labels):
    """The same with other labels in some rows."""
    dofs = matrices.dofs.copy()
    dofs[rows] = labels
    return Matrices(matrices.stiffness, matrices.mass, matrices.damping, dofs)


def curve(matrices, labels):
    """Amplitudes of the forced response of the chain across a resonance, its contacts and loads placed by label."""
    row = [matrices.rows(node, direction) for node, direction in labels]
    model = plm.Model(matrices.mass, matrices.stiffness, matrices.damping)
    if matrices.damping is None:
        model.set_rayleigh_damping(0.5, 2e-4)
    model.add_node_pairs([row[k] for k in (6, 7, 8)], [row[k] for k in (15, 16, 17)], [1, 0, 0])
    model.add_ground_contacts([row[k] for k in (21, 22, 23)], [1, 0, 0], stiffness=2e4, gap=0.0)
    force = numpy.zeros(matrices.n_dof)
    force[row[models.WATCHED]] = 10
    model.set_excitation(force)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", plm.PlmWarning)
        hbm = plm.Hbm(models.full(model, 2.0, 9.0), n_harmonics=3, motion="harmonics")
        return numpy.array([hbm.solve(hz).amplitude(row[models.WATCHED])[0] for hz in FREQUENCIES])


class RoundTrips(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = temporary.name

    def again(self, name, options, matrices):
        folder = tempfile.mkdtemp(dir=self.folder)
        paths = write_matrices(os.path.join(folder, "model"), matrices, name, **options)
        self.assertEqual(sorted(paths), sorted(os.path.join(folder, file) for file in os.listdir(folder)))
        return read_matrices(paths[0])

    def test_every_exact_format_gives_the_same_matrices(self):
        for name, options in EXACT:
            with self.subTest(format=name, **options):
                matrices = scattered_chain(name != "calculix")
                found = self.again(name, options, matrices)
                at = found.rows(matrices.dofs[:, 0], matrices.dofs[:, 1])
                self.assertEqual([kind for kind, _ in found.by_kind()], [kind for kind, _ in matrices.by_kind()])
                for (_, got), (_, wanted) in zip(found.by_kind(), matrices.by_kind()):
                    self.assertEqual(abs(got[at][:, at] - wanted).max(), 0.0)
                self.assertEqual(found.notes, [])
                if name in ("harwell-boeing", "ansys"):
                    numpy.testing.assert_array_equal(found.loads[at], matrices.loads)

    def test_formats_with_fewer_digits_round(self):
        matrices = scattered_chain(True)
        for name, options, tolerance in ROUNDED:
            with self.subTest(format=name, **options):
                found = self.again(name, options, matrices)
                at = found.rows(matrices.dofs[:, 0], matrices.dofs[:, 1])
                for (_, got), (_, wanted) in zip(found.by_kind(), matrices.by_kind()):
                    difference = got[at][:, at] - wanted
                    self.assertLess(abs(difference).max(), tolerance * abs(wanted).max())
                    self.assertGreater(abs(difference).max(), 0.0)  # else it belongs to the exact ones

    def test_every_format_gives_the_same_curve(self):
        """1e-12 of the largest amplitude; of OUTPUT4 one layout each, as all of them give the same matrices to the last digit."""
        labels = scattered_chain(True).dofs
        reference = {damped: curve(scattered_chain(damped), labels) for damped in (True, False)}
        for amplitudes in reference.values():
            self.assertGreater(amplitudes.max(), 3 * amplitudes.min())
        tried = [(name, o) for name, o in EXACT if o.get("layout", "bigmat") == "bigmat" and o.get("byteorder") != "<"]
        for name, options in tried + [("dmig", {})]:
            with self.subTest(format=name, **options):
                damped = name != "calculix"
                amplitudes = curve(self.again(name, options, scattered_chain(damped)), labels)
                numpy.testing.assert_allclose(amplitudes, reference[damped], rtol=0, atol=1e-12 * reference[damped].max())

    def test_other_readers_read_what_is_written(self):
        """SciPy's Matrix Market reader, and its Harwell-Boeing reader for one that it knows."""
        matrices = scattered_chain(True)
        paths = write_matrices(os.path.join(self.folder, "x"), matrices, "market")
        for path, (_, matrix) in zip(paths, matrices.by_letter()):
            self.assertEqual(abs(scipy.sparse.csr_matrix(scipy.io.mmread(path)) - matrix).max(), 0.0)
        path = write_matrices(os.path.join(self.folder, "x"), matrices, "harwell-boeing")[1]
        with open(path) as file:  # it reads unsymmetric ones only: the triangle then is the matrix
            text = file.read().replace("RSA", "RUA").replace("(1P,3E25.16)", "(3E25.16)   ")
        with open(os.path.join(self.folder, "scipy.rua"), "w") as file:
            file.write(text)
        lower = scipy.io.hb_read(os.path.join(self.folder, "scipy.rua"))
        self.assertEqual(abs(lower - scipy.sparse.tril(matrices.mass)).max(), 0.0)

    def test_scipy_writes_what_is_read(self):
        """Dense and sparse, general and symmetric Matrix Market of SciPy."""
        matrices = scattered_chain(False)
        for symmetry in ("general", "symmetric"):
            for stored in (scipy.sparse.csc_matrix, lambda m: m.toarray()):
                folder = tempfile.mkdtemp(dir=self.folder)
                for name, matrix in (("stiffness.mtx", matrices.stiffness), ("mass.mtx", matrices.mass)):
                    scipy.io.mmwrite(os.path.join(folder, name), stored(matrix), symmetry=symmetry, precision=17)
                found = read_matrices(os.path.join(folder, "mass.mtx"), dofs=matrices.dofs)
                self.assertEqual(abs(found.stiffness - matrices.stiffness).max(), 0.0)
                self.assertEqual(abs(found.mass - matrices.mass).max(), 0.0)
                self.assertEqual(found.notes, [])

    def test_strings_too_long_for_one_header(self):
        """A full column of 40,000 rows is cut in the sparse layout, where length and row share 32 bits."""
        n = 40000
        column = scipy.sparse.coo_matrix((numpy.arange(1.0, n), (numpy.arange(1, n), numpy.zeros(n - 1, int))), shape=(n, n))
        stiffness = scipy.sparse.csr_matrix(column + column.T + scipy.sparse.identity(n))
        for name in ("output4", "output4-binary"):
            found = self.again(name, {"layout": "sparse"}, Matrices(stiffness, scipy.sparse.identity(n)))
            self.assertEqual(abs(found.stiffness - stiffness).max(), 0.0)

    def test_what_a_format_has_no_place_for_is_refused(self):
        damped, internal = scattered_chain(True), relabelled(scattered_chain(False), [0], [[-1, 1]])
        with_loss = scattered_chain(False)
        with_loss.structural_damping = 0.01 * with_loss.stiffness
        for words, name, matrices in (("no place for a damping matrix", "calculix", damped),
                                      ("no place for DOFs without a node", "ansys", internal),
                                      ("no place for structural damping", "market", with_loss), ("format is 'x'", "x", damped)):
            with self.assertRaisesRegex(ValueError, words):
                write_matrices(os.path.join(self.folder, "model"), matrices, name)

    def test_rows_without_a_node(self):
        """Internal nodes keep their labels where a format has labels below one, and become scalar points in bulk data."""
        matrices = relabelled(scattered_chain(True), [4, 9], [[-1, 1], [-2, 1]])
        for name in ("abaqus", "abaqus-substructure", "market", "output4"):
            found = self.again(name, {}, matrices)
            self.assertEqual(abs(found.stiffness[found.rows(-2, 1), :] - 0).sum(), abs(matrices.stiffness[9, :]).sum())
        found = self.again("dmig", {}, matrices)
        top = matrices.dofs[:, 0].max()
        self.assertAlmostEqual(found.stiffness[found.rows(top + 2, 0), found.rows(top + 2, 0)] / matrices.stiffness[9, 9], 1.0, 12)


if __name__ == "__main__":
    unittest.main()
