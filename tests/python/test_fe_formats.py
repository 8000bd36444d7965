"""Matrices of other codes: files made by hand from the formats' descriptions and what must come out of each, files that are wrong
and the line each is refused for, and CalculiX' own matrices against the frequencies that it prints."""
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

import numpy
import scipy.linalg
from plm.fe import FileError, Matrices, read_matrices
from plm.fe.formats import dof_list, substructure

FORMATS = pathlib.Path(__file__).parent / "formats"

# The one model that all files describe: rows (101, 1), (101, 2), (205, 1).
K = numpy.array([[3e4, -1e4, 0], [-1e4, 2.5e4, -1.5e4], [0, -1.5e4, 1.5e4]])
M = numpy.array([[2, 0.125, 0], [0.125, 1.5, 0], [0, 0, 0.25]])
C = numpy.array([[6, -2, 0], [-2, 5, 0], [0, 0, 0.5]])
DOFS = [[101, 1], [101, 2], [205, 1]]
LOAD = [[1.0], [0.0], [-2.0]]
WITH_POINT = [[101, 1], [101, 2], [900, 0]]
MULTIPLIER = [[0, 0, 0], [0, 0, 1], [0, 0, -1]]


def bordered(matrix, border):
    """The matrix with a last row and column of a Lagrange multiplier."""
    result = numpy.zeros((4, 4))
    result[:3, :3], result[3, :3], result[:3, 3] = matrix, border, border
    return result


# file: what must come out of it; "notes": words that the notes must have, or that there are none
GOOD = {
    "market_K.mtx": {"C": C},
    "market_M.mtx": {"C": C},
    "beam.sti": {},
    "beam.dof": {},
    "job_STIF2.mtx": {"K": bordered(K, [0, 1, -1]), "M": bordered(M, [0, 0, 0]), "C": bordered(C, [0, 0, 0]),
                      "S": 0.02 * bordered(K, [0, 1, -1]), "dofs": DOFS + [[-1, 1]],
                      "notes": ["damping matrix was taken from step 3", "Lagrange multipliers", "(-1.1)", "0.02 times the stiffness"]},
    "coordinates_STIF1.mtx": {},
    "super.mtx": {"C": C},
    "plain_K.rsa": {"loads": LOAD},
    "touching_K.rsa": {"S": 0.02 * K, "dofs": [[-1, 0], [-2, 0], [-3, 0]],
                       "notes": ["imaginary part", "0.02 times the stiffness", "no list of DOFs"]},
    "hbK.matrix": {"loads": LOAD},
    "hbM.matrix": {"loads": LOAD},
    "small.bdf": {"dofs": WITH_POINT, "notes": ["1 entry BEGIN BU not read", "1 entry GRID not read"]},
    "large.pch": {"C": C, "notes": ["matrix PAX was not read: its name says no kind"]},
    "free.dat": {"S": 0.02 * K, "notes": ["imaginary part", "0.02 times the stiffness"]},
    "dense.op4": {},
    "wide.op4": {},
    "complex.op4": {"S": 0.02 * K, "notes": ["imaginary part", "0.02 times the stiffness"]},
    "whole.mtx": {},
    "cms.mtx": {"dofs": [[101, 1], [101, 2], [-1, 1]], "notes": ["cms.mtx:12: substructure load case vectors were not read",
                                                                 "cms.mtx:20: substructure recovery vectors were not read"]},
    "sparse.op4": {"dofs": [[-1, 0], [-2, 0], [-3, 0]], "notes": ["no list of DOFs"]},
    "dense_big_endian.op4": {"dofs": [[-1, 0], [-2, 0], [-3, 0]], "notes": ["no list of DOFs"]},
    "sparse_little_endian.op4": {"dofs": [[-1, 0], [-2, 0], [-3, 0]], "notes": ["no list of DOFs"]},
    "words_of_eight.op4": {"dofs": [[-1, 0], [-2, 0], [-3, 0]], "notes": ["no list of DOFs"]},
}

# file: line (0: the file as a whole), words of the refusal, and the file at fault where it is another
BROKEN = {
    "letters_K.mtx": (6, "'25k00' where a number"),
    "half_index_K.mtx": (6, "'2.5' where a whole number"),
    "short_line_K.mtx": (6, "2 values where 3"),
    "column_outside_K.mtx": (6, "column 7 of a matrix of 3 rows"),
    "not_finite_K.mtx": (6, "no finite number"),
    "too_few_K.mtx": (3, "50 entries are announced, 5 are there"),
    "huge_K.mtx": (3, "does not fit into a file"),
    "rectangular_K.mtx": (3, "3 rows but 4 columns"),
    "skew_K.mtx": (1, "skew-symmetric"),
    "superscript_K.mtx": (2, "where the sizes of the matrix are expected"),
    "half_K.mtx": (0, "one triangle only"),
    "unsymmetric_K.mtx": (5, "not symmetric: 0.125 in row 2, column 1, but 0.25"),
    "empty_K.mtx": (0, "is empty"),
    "row.sti": (5, "column 9 of a matrix of 3 rows"),
    "cut.sti": (5, "2 values where 3"),
    "list.sti": (0, "node 101, direction 1 stands twice"),
    "word.sti": (2, "'x' where a whole number", "word.dof"),
    "lonely.sti": (0, "no mass matrix"),
    "nolist.sti": (0, "nolist.dof"),
    "direction_STIF1.mtx": (6, "direction 22"),
    "mirror_STIF1.mtx": (5, "not symmetric: -10000 in row 2, column 1, but -11000"),
    "four_STIF1.mtx": (6, "4 values where 5"),
    "labels_STIF1.mtx": (1, "FORMAT=MATRIX INPUT"),
    "steps_STIF4.mtx": (0, "several steps"),
    "skew_K.rsa": (3, "RZA"),
    "kind.rsa": (1, "no format that is known"),
    "pointers_K.rsa": (6, "column 3 begins at entry 3, before"),
    "last_pointer_K.rsa": (6, "the columns end at entry 8, but there are 5"),
    "rhs_K.rsa": (5, "where kind and number of right-hand sides are expected"),
    "row_K.rsa": (7, "row 4 of a matrix of 3 rows"),
    "value_K.rsa": (9, "'-1.50000000x00000E+04' where a number"),
    "format_K.rsa": (4, "the format (8Z5)"),
    "cut_K.rsa": (7, "the file ends after 0 of 2 lines"),
    "entries_K.rsa": (3, "99999 entries do not fit"),
    "titleK.matrix": (3, "'UQ' is no name of a DOF", "titleK.mapping"),
    "equationK.matrix": (0, "the equations are not 1 to 3", "equationK.mapping"),
    "header.pch": (2, "before its header"),
    "value.pch": (8, "'-1.5000O0000D+04' where a number"),
    "form.pch": (2, "IFO of matrix KAAX is '7'"),
    "direction.pch": (8, "'205 8' where a point and a direction"),
    "nocolumns.pch": (2, "matrix KAAX has no columns"),
    "orphan.pch": (1, "continues an entry"),
    "two.pch": (11, "KAAX and KBBX could both be the stiffness matrix"),
    "nomass.pch": (0, "no mass matrix was found here or beside it; hand over its path or its name (passed over:"),
    "value.op4": (3, "'3.000000000000000xE+04' where a number"),
    "below.op4": (4, "3 numbers from row 2 of column 2 in matrix KAA of 3 rows"),
    "cut.op4": (6, "3 whole numbers are expected"),
    "string.op4": (6, "a string of 9 words where 7 are left"),
    "rectangular.op4": (0, "it is rectangular"),
    "below.bin.op4": (0, "at byte 112: 2 numbers from row 3 of column 3"),
    "ends.bin.op4": (0, "at byte 32: a record of 28 bytes does not end as it began"),
    "cut.bin.op4": (0, "at byte 68: the file ends before matrix KAA does"),
    "string.bin.op4": (0, "at byte 72: a string of 8 words where 6 are left"),
    "place.mtx": (7, "'3, 1' where one of 2 places"),
    "count.mtx": (12, "5 numbers for a matrix of 3 rows"),
    "word.mtx": (17, "'x.' where a number"),
    "whole.mtx": (0, "not symmetric: -10000 in row 2, column 1, but -10001 in row 1, column 2"),
    "text.txt": (1, "no format that is known"),
}


def unpacked(folder, target):
    """The files of a folder in another one; what stands in hexadecimal becomes bytes."""
    for path in folder.iterdir():
        if path.suffix == ".hex":
            digits = "".join(line for line in path.read_text().splitlines() if not line.startswith("#"))
            name = path.stem if folder.name == "good" else path.name.replace(".op4.hex", ".bin.op4")
            (target / name).write_bytes(bytes.fromhex(digits))
        else:
            shutil.copy(path, target)
    return target


class Samples(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        for name in ("good", "broken"):
            (folder := pathlib.Path(cls.temporary.name) / name).mkdir()
            setattr(cls, name, unpacked(FORMATS / name, folder))

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def test_what_each_file_says_comes_out(self):
        """To the last digit: the numbers of the files have few."""
        for name, expected in GOOD.items():
            with self.subTest(file=name):
                found = read_matrices(self.good / name)
                self.assertEqual(found.dofs.tolist(), expected.get("dofs", DOFS))
                self.assertEqual(found.dofs.dtype, numpy.int64)
                for key, matrix in (("K", found.stiffness), ("M", found.mass), ("C", found.damping), ("S", found.structural_damping)):
                    wanted = expected.get(key, {"K": K, "M": M}.get(key))
                    self.assertEqual(matrix is None, wanted is None, key)
                    if wanted is not None:
                        self.assertEqual(matrix.format, "csr")
                        # 2e-15: structural damping is 0.02 K but written in decimals of its own
                        numpy.testing.assert_allclose(matrix.toarray(), wanted, rtol=0 if key != "S" else 2e-15)
                self.assertEqual(found.loads is None, "loads" not in expected)
                if found.loads is not None:
                    numpy.testing.assert_array_equal(found.loads, expected["loads"])
                notes = "\n".join(found.notes)
                self.assertEqual(bool(notes), "notes" in expected, notes)
                for words in expected.get("notes", ()):
                    self.assertIn(words, notes)
                self.assertIn(str(self.good / name), found.source)

    def test_each_broken_file_is_refused_with_its_line(self):
        for name, (line, words, *other) in BROKEN.items():
            with self.subTest(file=name):
                with self.assertRaises(FileError) as caught:
                    read_matrices(self.broken / name)
                error = caught.exception
                self.assertIn(words, error.text)
                self.assertEqual(error.line, line)
                self.assertEqual(pathlib.Path(error.file).name, *(other or [name]))
                self.assertTrue(str(error).startswith(f"{error.file}:{line}: " if line else f"{error.file}: "))

    def test_two_signs_are_no_number(self):
        self.assertIsNone(substructure.labels_of("1, --1"))
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "list.dof"
            path.write_text("1 3\n+-1 3\n")
            with self.assertRaises(FileError) as caught:
                dof_list.as_dofs(path)
            self.assertEqual(caught.exception.line, 2)

    def test_every_broken_file_is_tried(self):
        companions = {name.rpartition(".")[0] for name in BROKEN if name.endswith((".sti", ".matrix"))}
        untried = [path.name for path in self.broken.iterdir() if path.name not in BROKEN and path.stem not in companions
                   and path.stem not in ("titleM", "steps_MASS1", "steps_MASS2")]
        self.assertEqual(untried, [])

    def test_what_the_caller_says_goes_before_what_lies_beside(self):
        listed = numpy.array([[7, 3], [8, 1], [9, 2]])
        found = read_matrices(self.good / "sparse.op4", dofs=listed)
        self.assertEqual((found.dofs.tolist(), found.notes), (listed.tolist(), []))
        found = read_matrices(self.good / "sparse.op4", dofs=self.good / "coordinates.dof")
        self.assertEqual(found.dofs.tolist(), DOFS)
        found = read_matrices(self.good / "market_K.mtx", damping=self.good / "market_K.mtx")
        numpy.testing.assert_array_equal(found.damping.toarray(), K)
        found = read_matrices(self.broken / "two.pch", names={"stiffness": "KAAX", "mass": "kbbx"})
        numpy.testing.assert_array_equal(found.mass.toarray(), M)
        found = read_matrices(self.broken / "lonely.sti", mass=self.good / "beam.mas")
        numpy.testing.assert_array_equal(found.mass.toarray(), M)
        order = [[205, 1], [101, 2], [101, 1]]
        found = read_matrices(self.good / "large.pch", dofs=numpy.array(order))
        self.assertEqual(found.dofs.tolist(), order)
        numpy.testing.assert_array_equal(found.stiffness.toarray(), K[::-1, ::-1])
        numpy.testing.assert_array_equal(found.mass.toarray(), M[::-1, ::-1])
        with self.assertRaisesRegex(FileError, "has node 205, direction 1, which the DOFs handed over have not"):
            read_matrices(self.good / "large.pch", dofs=numpy.array(order[1:]))
        with self.assertRaisesRegex(FileError, "does not name its DOFs, the stiffness matrix does"):
            read_matrices(self.good / "job_STIF2.mtx", mass=self.good / "coordinates_MASS1.mtx")
        with self.assertRaisesRegex(FileError, "2 DOFs are listed for matrices of 3 rows"):
            read_matrices(self.good / "sparse.op4", dofs=listed[:2])
        with self.assertRaisesRegex(FileError, "has no matrix KXX; it has KAAX, KBBX, BAAX, PAX"):
            read_matrices(self.broken / "two.pch", names={"stiffness": "KXX"})
        for words, options in (("format is 'x'; it must be one of market", {"format": "x"}), ("names has 'k'", {"names": {"k": "K"}}),
                               (r"shape \(n, 2\)", {"dofs": [1, 2]})):
            with self.assertRaisesRegex(ValueError, words):
                read_matrices(self.good / "sparse.op4", **options)
        with self.assertRaisesRegex(FileError, "no header of Matrix Market"):
            read_matrices(self.good / "large.pch", format="market")
        for path, words in ((self.good / "nowhere", "is no file"), (self.good, "is a folder")):
            with self.assertRaisesRegex(FileError, words):
                read_matrices(path)

    def test_rows_are_found_by_node_and_direction(self):
        found = read_matrices(self.good / "beam")  # a stem is enough for CalculiX
        self.assertEqual(found.rows(205, 1), 2)
        numpy.testing.assert_array_equal(found.rows([205, 101], [1, 2]), [2, 1])
        with self.assertRaisesRegex(LookupError, "no row for node 101, direction 3: it has 1, 2"):
            found.rows(101, 3)
        with self.assertRaisesRegex(LookupError, "node 7, direction 1: no row is of this node"):
            found.rows([101, 7], 1)

    def test_mass_with_dofs_of_its_own(self):
        """A mass matrix that lacks a node, and orders the others differently, lands on the stiffness matrix' rows."""
        folder = self.good / "own"
        folder.mkdir()
        shutil.copy(self.good / "job_STIF2.mtx", folder)
        (folder / "job_MASS2.mtx").write_text("101,2,101,2,1.5\n101,1,101,1,2.\n101,2,101,1,0.125\n")
        found = read_matrices(folder / "job_STIF2.mtx")
        wanted = bordered(M, [0, 0, 0])
        wanted[2, 2] = 0
        numpy.testing.assert_array_equal(found.mass.toarray(), wanted)

    def test_amplitude_and_phase(self):
        """DMIG with POLAR: amplitude and phase in degrees. 1e-15: a sine and a cosine."""
        path = self.good / "polar.bdf"
        path.write_text("DMIG,KAAX,0,6,3,0,1\nDMIG,KAAX,5,3,,5,3,2.0+4,60.\n+,6,0,1.,-90.\nDMIG,KAAX,6,0,,6,0,300.,0.\n"
                        "DMIG,MAAX,0,6,1\nDMIG,MAAX,5,3,,5,3,2.\nDMIG,MAAX,6,0,,6,0,1.\n")
        found = read_matrices(path)
        self.assertEqual(found.dofs.tolist(), [[5, 3], [6, 0]])
        numpy.testing.assert_allclose(found.stiffness.toarray(), [[1e4, 0], [0, 300]], rtol=1e-15, atol=1e-15)
        numpy.testing.assert_allclose(found.structural_damping.toarray(), [[1e4 * 3**0.5, -1], [-1, 0]], rtol=1e-15)
        self.assertIn("no loss factor stands for it", found.notes[-1])
        path.write_text(path.read_text().replace("DMIG,MAAX,0,6,1", "DMIG,MAAX,0,6,3").replace("5,3,2.\n", "5,3,2.,1.\n"))
        with self.assertRaisesRegex(FileError, "the mass matrix is complex"):
            read_matrices(path)

    def test_matrices_of_unequal_size_are_no_model(self):
        with self.assertRaisesRegex(ValueError, "mass is 2 x 2, the stiffness has 3 rows"):
            Matrices(K, M[:2, :2])
        with self.assertRaisesRegex(ValueError, "2 DOFs for matrices of 3 rows"):
            Matrices(K, M, dofs=[[1, 1], [2, 1]])


BRICKS = """*NODE
{nodes}
*ELEMENT, TYPE={kind}, ELSET=ALL
{elements}
*MATERIAL, NAME=STEEL
*ELASTIC
210000., 0.3
*DENSITY
7.8E-9
*SOLID SECTION, ELSET=ALL, MATERIAL=STEEL
*BOUNDARY
{fixed}
*STEP
*FREQUENCY{solver}
8
*END STEP
"""


def bricks(kind, solver, cells=(6, 2, 1), lengths=(60.0, 9.0, 4.0)):
    """A cantilever of bricks, its node labels scattered."""
    shape = [c + 1 for c in cells]
    label = 3 + 7 * numpy.random.default_rng(4).permutation(numpy.prod(shape)).reshape(shape)
    places = list(numpy.ndindex(*shape))
    nodes = [f"{label[p]}, " + ", ".join(f"{x * length / c:.9g}" for x, c, length in zip(p, cells, lengths)) for p in places]
    corners = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
    elements = [f"{number}, " + ", ".join(str(label[tuple(numpy.add(cell, corner))]) for corner in corners)
                for number, cell in enumerate(numpy.ndindex(*cells), 1)]
    fixed = [f"{label[p]}, 1, 3" for p in places if p[0] == 0]
    return BRICKS.format(kind=kind, solver=solver, nodes="\n".join(nodes), elements="\n".join(elements), fixed="\n".join(fixed))


@unittest.skipUnless(shutil.which("ccx"), "no ccx (calculix-ccx)")
class CalculixMatrices(unittest.TestCase):
    def run_ccx(self, folder, job, deck):
        pathlib.Path(folder, job + ".inp").write_text(deck)
        subprocess.run(["ccx", job], cwd=folder, env={**os.environ, "OMP_NUM_THREADS": "1"}, stdout=subprocess.DEVNULL, timeout=60)

    def test_modes_of_the_matrices_are_those_that_it_prints(self):
        """1e-6: it prints seven digits. Eight modes of C3D8 and of C3D8I, which has internal DOFs without a place in the mesh."""
        for kind, internal in (("C3D8", 0), ("C3D8I", 12 * 9)):
            with self.subTest(element=kind), tempfile.TemporaryDirectory() as folder:
                self.run_ccx(folder, "modes", bricks(kind, ""))
                self.run_ccx(folder, "beam", bricks(kind, ", SOLVER=MATRIXSTORAGE"))
                found = read_matrices(os.path.join(folder, "beam"))
                self.assertEqual(found.n_dof, 3 * 6 * 6 + internal)
                # M of C3D8I is singular: 1 / omega^2 of (M, K)
                inverse = scipy.linalg.eigh(found.mass.toarray(), found.stiffness.toarray(), eigvals_only=True)[::-1][:8]
                lines = pathlib.Path(folder, "modes.dat").read_text().split("\n")
                printed = [float(words[3]) for line in lines if len(words := line.split()) == 5 and words[0].isdigit()][:8]
                self.assertEqual(len(printed), 8)
                numpy.testing.assert_allclose(1 / (2 * numpy.pi * numpy.sqrt(inverse)), printed, rtol=1e-6)

    def test_superelement(self):
        """Its stiffness are the stored entries at the kept DOFs (ccx 2.20 does not condense them). 1e-12: it prints 13 digits."""
        with tempfile.TemporaryDirectory() as folder:
            deck = bricks("C3D8", ", SOLVER=MATRIXSTORAGE")
            self.run_ccx(folder, "beam", deck)
            full = read_matrices(os.path.join(folder, "beam"))
            kept = full.dofs[[0, 1, 5, 40, 42, 71]]
            step = "*STEP\n*SUBSTRUCTURE GENERATE\n*RETAINED NODAL DOFS, SORTED=NO\n"
            step += "".join(f"{node}, {direction}, {direction}\n" for node, direction in kept)
            step += "*SUBSTRUCTURE MATRIX OUTPUT, FILE NAME=super, OUTPUT FILE=USER DEFINED, STIFFNESS=YES\n*END STEP\n"
            self.run_ccx(folder, "made", deck.partition("*STEP")[0] + step)
            mass = pathlib.Path(folder, "mass.mtx")
            mass.write_text(pathlib.Path(folder, "super.mtx").read_text().replace("STIFFNESS", "MASS"))  # it writes none
            found = read_matrices(os.path.join(folder, "super.mtx"), mass=mass)
            self.assertEqual(found.dofs.tolist(), kept.tolist())
            rows = full.rows(kept[:, 0], kept[:, 1])
            wanted = full.stiffness.toarray()[numpy.ix_(rows, rows)]
            self.assertGreater(numpy.count_nonzero(abs(wanted) > 1e-9 * wanted.max()), len(kept))
            numpy.testing.assert_allclose(found.stiffness.toarray(), wanted, rtol=0, atol=1e-12 * numpy.abs(wanted).max())


if __name__ == "__main__":
    unittest.main()
