"""Meshes of other programs: files written by hand, and what must come out of them."""
import os
import shutil
import sys
import tempfile
import unittest

import numpy

from plm.fe import FileError, read_mesh

XYZ = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
GMSH = """$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
3
2 7 "upper side"
3 9 "Body"
0 4 "Corner"
$EndPhysicalNames
$Nodes
8
""" + "".join(f"{i} {x} {y} {z}\n" for i, (x, y, z) in enumerate(XYZ, 1)) + """$EndNodes
$Elements
3
1 15 2 4 1 3
2 3 2 7 6 5 8 7 6
3 5 2 9 1 1 2 3 4 5 6 7 8
$EndElements
"""
NASTRAN = "BEGIN BULK\n" + "".join(f"GRID,{i},,{x:.1f},{y:.1f},{z:.1f}\n" for i, (x, y, z) in enumerate(XYZ, 1)) + """CHEXA,11,3,1,2,3,4,5,6,+
+,7,8
ENDDATA
"""
VTU = """<?xml version="1.0"?>
<VTKFile type="UnstructuredGrid" version="0.1" byte_order="LittleEndian"><UnstructuredGrid>
<Piece NumberOfPoints="8" NumberOfCells="1"><Points><DataArray type="Float64" NumberOfComponents="3" format="ascii">
""" + " ".join(f"{v}" for point in XYZ for v in point) + """
</DataArray></Points><Cells><DataArray type="Int64" Name="connectivity" format="ascii">0 1 2 3 4 5 6 7</DataArray>
<DataArray type="Int64" Name="offsets" format="ascii">8</DataArray><DataArray type="Int64" Name="types" format="ascii">12</DataArray>
</Cells></Piece></UnstructuredGrid></VTKFile>
"""


class Meshes(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.folder)

    def write(self, text, name):
        path = os.path.join(self.folder, name)
        with open(path, "w", encoding="ascii") as file:
            file.write(text)
        return path

    def test_gmsh(self):
        deck = read_mesh(self.write(GMSH, "cube.msh"))
        numpy.testing.assert_array_equal(deck.node_labels, range(1, 9))
        numpy.testing.assert_array_equal(deck.coordinates, XYZ)
        self.assertEqual([(block.type, block.labels.tolist(), block.connectivity.tolist()) for block in deck.elements],
                         [("C3D8", [1], [[1, 2, 3, 4, 5, 6, 7, 8]])])
        numpy.testing.assert_array_equal(deck.element_sets["body"], [1])
        numpy.testing.assert_array_equal(deck.node_sets["corner"], [3])
        numpy.testing.assert_array_equal(deck.node_sets["Upper Side"], [5, 6, 7, 8])
        face = deck.coordinates[deck.faces("UPPER SIDE")[0]]  # in the file it looks into the body
        numpy.testing.assert_array_equal(numpy.cross(face[1] - face[0], face[2] - face[1]), [0, 0, 1])

    def test_nastran_and_vtu(self):
        for text, name in ((NASTRAN, "cube.bdf"), (VTU, "cube.vtu")):
            deck = read_mesh(self.write(text, name))
            numpy.testing.assert_array_equal(deck.coordinates, XYZ)
            self.assertEqual(deck.elements[0].connectivity.tolist(), [[1, 2, 3, 4, 5, 6, 7, 8]])
            self.assertEqual(deck.unread, [])

    def test_med(self):
        """No such file is written by hand (HDF5): by meshio's own writer."""
        try:
            import h5py  # noqa: F401
        except ImportError:
            self.skipTest("h5py is not there (Debian: python3-h5py)")
        tags = [numpy.array([-2]), numpy.array([-3])]
        mesh = meshio.Mesh(numpy.array(XYZ, dtype=float), [("hexahedron", [range(8)]), ("quad", [[4, 5, 6, 7]])],
                           point_data={"point_tags": numpy.array([0] * 7 + [2])}, cell_data={"cell_tags": tags})
        mesh.point_tags, mesh.cell_tags = {2: ["last"]}, {-2: ["body"], -3: ["upper"]}
        path = os.path.join(self.folder, "cube.med")
        meshio.write(path, mesh)
        deck = read_mesh(path)
        numpy.testing.assert_array_equal(deck.node_sets["LAST"], [8])
        numpy.testing.assert_array_equal(deck.element_sets["BODY"], [1])
        self.assertEqual(len(deck.faces("UPPER")), 1)

    def test_quadratic_elements_keep_their_order(self):
        """Middles lie between the corners that the faces of the deck say."""
        for kind, corners, edges in (("hexahedron20", XYZ, "01 12 23 30 45 56 67 74 04 15 26 37"),
                                     ("tetra10", [XYZ[0], XYZ[1], XYZ[3], XYZ[4]], "01 12 20 03 13 23")):
            points = numpy.array(corners, dtype=float)
            points = numpy.vstack([points, [(points[int(a)] + points[int(b)]) / 2 for a, b in edges.split()]])
            path = os.path.join(self.folder, kind + ".vtu")
            meshio.write(path, meshio.Mesh(points, [(kind, [range(len(points))])]))
            deck = read_mesh(path)
            from plm.fe.deck_elements import faces_of
            for face in faces_of(deck.elements[0].type).values():
                at = points[list(face)]
                half = len(at) // 2
                numpy.testing.assert_allclose(at[half:], (at[:half] + numpy.roll(at[:half], -1, axis=0)) / 2)

    def test_sheets_alone_are_elements(self):
        deck = read_mesh(self.write(GMSH.replace("3\n1 15", "2\n1 15").replace("3 5 2 9 1 1 2 3 4 5 6 7 8\n", ""), "sheet.msh"))
        self.assertEqual([(block.type, block.connectivity.tolist()) for block in deck.elements], [("S4", [[5, 8, 7, 6]])])

    def test_refusals(self):
        for text, name, words in (("nothing", "a.msh", "meshio does not read"), ("nothing", "a.strange", "meshio does not read"),
                                  (GMSH[:200], "b.msh", "has no cells; is the file complete.* not closed"), ("<VTKFile/>", "c.vtu", "meshio does not read"),
                                  (GMSH.replace("1 2 3 4 5 6 7 8\n$", "1 2 3 4 5 6 7 99\n$"), "d.msh", "meshio does not read|not there"),
                                  (NASTRAN.replace("+\n+", "\n"), "e.bdf", "meshio does not read|is the file complete")):
            path = self.write(text, name)
            with self.subTest(name), self.assertRaisesRegex(FileError, words) as caught:
                read_mesh(path)
            self.assertEqual(caught.exception.file, path)
        with self.assertRaisesRegex(FileError, "no such file"):
            read_mesh(os.path.join(self.folder, "nowhere.msh"))


if __name__ == "__main__":
    try:
        import meshio
    except ImportError:
        print("skipped: no meshio (Debian: python3-meshio)")
        sys.exit(77)
    unittest.main()
