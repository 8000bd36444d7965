"""Decks of CalculiX and Abaqus as text: what is read of them, against what is written here by hand."""
import itertools
import os
import shutil
import tempfile
import unittest

import numpy
from plm.fe import FileError, read_deck

CUBE = """*Node, nset="all nodes"
1, 0., 0., 0.
2, 1., 0., 0.
3, 1., 1., 0.
4, 0., 1., 0.
5, 0., 0., 1.
6, 1., 0., 1.
7, 1., 1., 1.
8, 0., 1., 1.
"""
BRICK = "*ELEMENT, TYPE=C3D8, ELSET=E\n1, 1,2,3,4,5,6,7,8\n"


class Case(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.folder)

    def write(self, text, name="deck.inp"):
        path = os.path.join(self.folder, name)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "w", encoding="utf-8", newline="") as file:
            file.write(text)
        return path

    def read(self, text):
        return read_deck(self.write(text))

    def refused(self, text, line, words):
        with self.assertRaisesRegex(FileError, words) as caught:
            self.read(text)
        self.assertEqual(caught.exception.line, line)


class Syntax(Case):
    def test_ways_to_write_the_same(self):
        plain = self.read(CUBE + BRICK + "*NSET, NSET=TOP\n5, 6, 7, 8\n")
        for text in (
                (CUBE + BRICK + "*NSET, NSET=TOP\n5, 6, 7, 8\n").replace("\n", "\r\n"),
                CUBE + "*element,type = c3d8,\n elset=E\n1, 1,2,3,4,\n5,6,7,8,\n*N Set , NSet=top\n5,6,7,8,\n",
                "** a comment\n\n" + CUBE.replace("1.", "1.D0") + "**\n" + BRICK + "*NSET, NSET=Top, GENERATE\n5, 8\n",
                CUBE + BRICK + "*NSET,NSET=TOP\n5,\n6\n*NSET,NSET=TOP,GENERATE\n7,8,1\n",
                CUBE + BRICK.replace("*ELEMENT", "*ELEMENT, ") + "*NSET, NSET=A\n5, 6\n*NSET, NSET=TOP\na, 7., 8.\n",
                CUBE.replace('"all nodes"', "'All Nodes',") + BRICK + "*NSET, NSET=TOP\nLATER, 8\n*NSET, NSET=LATER\n5,6,7\n"):
            deck = self.read(text)
            numpy.testing.assert_array_equal(deck.node_labels, plain.node_labels)
            numpy.testing.assert_array_equal(deck.coordinates, plain.coordinates)
            numpy.testing.assert_array_equal(deck.node_sets["tOp"], [5, 6, 7, 8])
            numpy.testing.assert_array_equal(deck.node_sets["ALL NODES"], range(1, 9))
            self.assertEqual(deck.elements[0].type, "C3D8")
            numpy.testing.assert_array_equal(deck.elements[0].connectivity, [range(1, 9)])
            self.assertEqual(deck.unread, [])

    def test_includes(self):
        """Beside the file that includes, or beside the main one; data go on behind it."""
        self.write(BRICK + "*INCLUDE, INPUT=lower.inc\n", "parts/brick.inc")
        self.write("*NSET, NSET=SOME\n1, 2\n", "parts/lower.inc")
        self.write("4, 5\n", "more.inc")
        deck = self.read(CUBE + '*Include, input="parts/brick.inc"\n3\n*INCLUDE, INPUT=more.inc\n6\n')
        numpy.testing.assert_array_equal(deck.node_sets["SOME"], [1, 2, 3, 4, 5, 6])
        windows = self.read(CUBE + '*INCLUDE, INPUT=.\\parts\\lower.inc\n')
        numpy.testing.assert_array_equal(windows.node_sets["SOME"], [1, 2])
        self.write("*INCLUDE, INPUT=deck.inp\n", "loop.inc")
        self.refused(CUBE + "*INCLUDE, INPUT=nowhere.inp\n", 10, "nowhere.inp is not there")
        with self.assertRaisesRegex(FileError, "loop.inc:1: .*includes itself"):
            self.read(CUBE + "*INCLUDE, INPUT=loop.inc\n")

    def test_what_is_not_understood_is_listed(self):
        deck = self.read(CUBE + BRICK + "*FRICTION\n0.3\n*EL PRINT, ELSET=E\nS\n*MATERIAL, NAME=M\n*PLASTIC\n1, 0\n2, 1\n"
                         "*ELEMENT, TYPE=U17\n7, 1, 2\n*NSET, NSET=G, GENERATE\n1, 10\n*MPC\nSLIDER, 1, 2, 3\n*STEP\n*DYNAMIC\n"
                         "*CLOAD, AMPLITUDE=A\n1, 1, 1.\n*END STEP\n")
        self.assertEqual([(line, text.split(":")[0].split(" is ")[0]) for _, line, text in deck.unread],
                         [(12, "*FRICTION"), (17, "*PLASTIC"), (20, "*ELEMENT, TYPE=U17"),
                          (23, "2 nodes of the set G are not defined, the first"), (25, "*MPC 'SLIDER'"), (27, "*DYNAMIC"),
                          (28, "*CLOAD")])
        self.assertTrue(all(file == os.path.join(self.folder, "deck.inp") for file, _, _ in deck.unread))

    def test_what_changes_no_model_is_not_listed(self):
        """Sections of shells and beams, whose matrices are handed over with them; what a material does with temperatures."""
        deck = self.read(CUBE + "*BEAM SECTION, ELSET=B, SECTION=RECT, MATERIAL=M\n1., 1.\n*SHELL SECTION, ELSET=S, MATERIAL=M\n.1\n"
                         "*MATERIAL, NAME=M\n*ELASTIC\n1., 0.\n*EXPANSION\n1e-5\n")
        self.assertEqual(deck.unread, [])

    def test_large_decks_are_read_in_seconds(self):
        """A hundred thousand nodes and elements, and lists as long: half a second here, and the machine may be busy."""
        import time
        n = 100_000
        nodes = "".join(f"{i}, {i}.5, 2., 3.\n" for i in range(1, n + 1))
        elements = "".join(f"{i}, {i}, {i + 1}, {i + 2}, {i + 3}\n" for i in range(1, n - 2))
        lists = "*NSET, NSET=A\n" + "".join(f"{i}, {i + 1}\n" for i in range(1, n, 2)) + "*BOUNDARY\n" + "".join(
            f"{i}, 1, 3\n" for i in range(1, n, 10)) + "*EQUATION\n" + "".join(f"2\n{i}, 1, 1., {i + 1}, 1, -1.\n" for i in range(1, n, 10))
        path = self.write("*NODE\n" + nodes + "*ELEMENT, TYPE=C3D4\n" + elements + lists)
        begin = time.process_time()
        deck = read_deck(path)
        self.assertLess(time.process_time() - begin, 8)
        self.assertEqual((len(deck.node_sets["A"]), len(deck.boundaries), len(deck.equations)), (n, n // 10, n // 10))
        self.assertEqual((deck.node_labels[-1], deck.coordinates[-1, 0], deck.elements[0].connectivity[-1, -1]), (n, n + 0.5, n))


class Geometry(Case):
    SIDES = {4: 4, 5: 5, 6: 5, 8: 6, 10: 4, 15: 5, 20: 6}
    CORNERS = {"tetrahedron": [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)],
               "wedge": [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (0, 1, 1)],
               "pyramid": [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0.5, 0.5, 1)],
               "brick": [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]}
    EDGES = {"tetrahedron": "12 23 31 14 24 34", "wedge": "12 23 31 45 56 64 14 25 36", "brick": "12 23 34 41 56 67 78 85 15 26 37 48"}

    def solid(self, shape, quadratic):
        """An element of this shape: its deck, with a surface of all sides."""
        xyz = numpy.array(self.CORNERS[shape]) @ numpy.array([[2, 0.3, 0], [0, 1, 0.2], [0.1, 0, 1.5]])
        if quadratic:
            ends = [(int(a) - 1, int(b) - 1) for a, b in self.EDGES[shape].split()]
            xyz = numpy.vstack([xyz, [(xyz[a] + xyz[b]) / 2 for a, b in ends]])
        n = len(xyz)
        text = "*NODE\n" + "".join(f"{i}, {x:.17g}, {y:.17g}, {z:.17g}\n" for i, (x, y, z) in enumerate(xyz, 1))
        text += f"*ELEMENT, TYPE=C3D{n}, ELSET=E\n1, " + ", ".join(map(str, range(1, n + 1))) + "\n*SURFACE, NAME=S\n"
        return self.read(text + "".join(f"E, S{k}\n" for k in range(1, self.SIDES[n] + 1)) + "*SURFACE, NAME=OUT\nE\n"), xyz

    def test_faces_enclose_the_solid(self):
        """Volume by the divergence theorem, positive: normals point outwards; each middle lies between the corners it belongs to."""
        volume = {"tetrahedron": 1 / 6, "wedge": 1 / 2, "pyramid": 1 / 3, "brick": 1}
        for shape, quadratic in itertools.product(volume, (False, True)):
            if quadratic and shape == "pyramid":
                continue
            deck, xyz = self.solid(shape, quadratic)
            total = 0
            for face in deck.faces("S"):
                corners = face if not quadratic else face[:len(face) // 2]
                at = xyz[corners]
                normal = sum(numpy.cross(at[k] - at[0], at[k + 1] - at[0]) for k in range(1, len(at) - 1)) / 2
                total += at.mean(axis=0) @ normal / 3
                if quadratic:
                    numpy.testing.assert_allclose(xyz[face[len(corners):]], (at + numpy.roll(at, -1, axis=0)) / 2, atol=1e-15)
            scale = numpy.linalg.det([[2, 0.3, 0], [0, 1, 0.2], [0.1, 0, 1.5]])
            self.assertAlmostEqual(total, volume[shape] * scale, 12)
            self.assertEqual(sorted(map(tuple, map(sorted, deck.faces("S")))), sorted(map(tuple, map(sorted, deck.faces("OUT")))))

    def test_two_bricks_share_a_face(self):
        deck = self.read(CUBE + BRICK + "*NODE\n9,2,0,0\n10,2,1,0\n11,2,0,1\n12,2,1,1\n*ELEMENT,TYPE=C3D8,ELSET=E\n2,2,9,10,3,6,11,12,7\n"
                         "*SURFACE,NAME=OUT\nE,\n")
        self.assertEqual(len(deck.faces("OUT")), 10)
        self.assertNotIn({2, 3, 6, 7}, [set(deck.node_labels[face]) for face in deck.faces("OUT")])

    def test_sides_of_shells(self):
        text = CUBE + "*NODE\n9,.5,0,0\n10,1,.5,0\n11,.5,1,0\n12,0,.5,0\n*ELEMENT,TYPE=S8R,ELSET=Q\n1,1,2,3,4,9,10,11,12\n"
        deck = self.read(text + "*SURFACE,NAME=P\nQ,SPOS\n*SURFACE,NAME=N\nQ,SNEG\n*SURFACE,NAME=D\nQ,\n")
        numpy.testing.assert_array_equal(deck.surfaces["P"].faces, [[1, 2, 3, 4, 9, 10, 11, 12]])
        numpy.testing.assert_array_equal(deck.surfaces["N"].faces, [[1, 4, 3, 2, 12, 11, 10, 9]])
        numpy.testing.assert_array_equal(deck.surfaces["D"].faces, deck.surfaces["P"].faces)

    def test_local_axes_and_cylindrical_coordinates(self):
        deck = self.read("*SYSTEM\n1,2,3, 1,3,3\n0,2,3\n*NODE\n1, 1, 2, 3\n*SYSTEM\n*NODE, SYSTEM=C\n2, 2., 90., 5.\n"
                         "*NODE, SYSTEM=S\n3, 2., 0., 30.\n")
        # the local x is y, the local y is -x, the local z is z
        numpy.testing.assert_allclose(deck.coordinates, [[1 - 2, 2 + 1, 3 + 3], [0, 2, 5], [3**0.5, 0, 1]], atol=1e-15)

    def test_middle_nodes_of_a_face_carry_what_they_should(self):
        """A unit pressure on the unit square with middle nodes: -1/12 at corners, 1/3 between, as in every textbook."""
        from plm.fe.deck_elements import area_vectors, shares
        xyz = numpy.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (.5, 0, 0), (1, .5, 0), (.5, 1, 0), (0, .5, 0)])
        numpy.testing.assert_allclose(area_vectors(xyz)[:, 2], [-1 / 12] * 4 + [1 / 3] * 4, atol=1e-14)
        self.assertGreater(shares(xyz).min(), 0)
        self.assertAlmostEqual(shares(xyz).sum(), 1, 14)
        triangle = numpy.array([(0, 0, 0), (2, 0, 0), (0, 1, 0), (1, 0, 0), (1, .5, 0), (0, .5, 0)])
        numpy.testing.assert_allclose(area_vectors(triangle)[:, 2], [0] * 3 + [1 / 3] * 3, atol=1e-14)
        numpy.testing.assert_allclose(area_vectors(triangle[:3])[:, 2], [1 / 3] * 3, atol=1e-14)
        skew = numpy.array([(0, 0, 0), (2, 0, 0), (2, 1, 0), (0, 3, 0)])  # integrals of the shape functions by hand
        numpy.testing.assert_allclose(area_vectors(skew)[:, 2], [7 / 6, 5 / 6, 5 / 6, 7 / 6], atol=1e-14)


class Assemblies(Case):
    TEXT = ("*HEADING\nassembly\n*PART, NAME=Cube\n" + CUBE.replace('"all nodes"', "N") + BRICK + "*SURFACE, NAME=TOP\nE, S2\n"
            "*SOLID SECTION, ELSET=E, MATERIAL=M\n*END PART\n*ASSEMBLY, NAME=A\n*INSTANCE, NAME=One, PART=CUBE\n*END INSTANCE\n"
            "*INSTANCE, NAME=Two, PART=cube\n0., 0., 2.\n0., 0., 0., 1., 0., 0., 90.\n*END INSTANCE\n*NODE\n1, 9., 9., 9.\n"
            "*NSET, NSET=PICKED, INSTANCE=Two\n3, 4\n*NSET, NSET=BOTH\nOne.N, PICKED\n*NSET, NSET=REF\n1\n"
            "*TIE, NAME=T\nTwo.TOP, One.TOP\n*EQUATION\n2\nTwo.5, 1, 1., One.5, 1, -2.\n"
            "*RIGID BODY, NSET=PICKED, REF NODE=REF\n*END ASSEMBLY\n*MATERIAL, NAME=M\n*ELASTIC\n1., 0.\n*DENSITY\n2.\n"
            "*BOUNDARY\nOne.N, ENCASTRE\n")

    def test_instances_are_laid_flat(self):
        deck = self.read(self.TEXT)
        self.assertEqual(deck.unread, [])
        numpy.testing.assert_array_equal(deck.node_labels, [*range(1, 9), *range(11, 19), 21])
        self.assertRegex(" ".join(deck.notes), r"instance TWO are those of the deck \+ 10.*the assembly are those of the deck \+ 20")
        # moved by 2 along z, then turned by 90 degrees about x: (x, y, z + 2) -> (x, -z - 2, y)
        one, two = deck.coordinates[:8], deck.coordinates[8:16]
        numpy.testing.assert_allclose(two, numpy.column_stack([one[:, 0], -one[:, 2] - 2, one[:, 1]]), atol=1e-15)
        numpy.testing.assert_array_equal(deck.node_sets["PICKED"], [13, 14])
        numpy.testing.assert_array_equal(deck.node_sets["BOTH"], [*range(1, 9), 13, 14])
        numpy.testing.assert_array_equal(sorted(deck.surfaces["TWO.TOP"].nodes), [15, 16, 17, 18])
        self.assertEqual((deck.ties[0].slave, deck.ties[0].master), ("TWO.TOP", "ONE.TOP"))
        self.assertEqual(deck.equations[0].terms, [(15, 1, 1.0), (5, 1, -2.0)])
        self.assertEqual((deck.couplings[0].reference, list(deck.couplings[0].nodes)), (21, [13, 14]))
        self.assertEqual(deck.materials["m"], ("M", 2.0, (1.0, 0.0)))

    def test_refusals(self):
        self.refused(self.TEXT.replace("PART=cube", "PART=cone"), 22, "no part CONE above; there are CUBE")
        self.refused(self.TEXT.replace("*END PART\n", ""), 18, "inside of \\*PART of line 3")
        self.refused(self.TEXT.replace("0., 0., 0., 1., 0., 0., 90.", "0., 0., 0., 0., 0., 0., 90."), 24, "axis are the same")


if __name__ == "__main__":
    unittest.main()
