"""Elements of CalculiX and Abaqus are the cells of VTK that look alike: same corners, middle nodes and size, by VTK's own geometry."""
import unittest

import numpy
from plm.fe.cells import Cells, cell_type

try:
    import vtk
    from vtk.util.numpy_support import vtk_to_numpy
except ImportError:
    vtk = None

# what an element is in the manuals of CalculiX and Abaqus: corners, and between which of them each middle node stands
_EDGES_8 = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)]
_EDGES_6 = [(0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5)]
_BOX = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
_PRISM = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (0, 1, 1)]
_TETRA = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
SHAPES = {"C3D8R": (_BOX, [], 1), "C3D20R": (_BOX, _EDGES_8, 1), "C3D6": (_PRISM, [], 1 / 2), "C3D15": (_PRISM, _EDGES_6, 1 / 2),
          "C3D4": (_TETRA, [], 1 / 6), "C3D10M": (_TETRA, [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)], 1 / 6),
          "S4R": (_BOX[:4], [], 1), "S8R": (_BOX[:4], _EDGES_8[:4], 1), "S3": (_PRISM[:3], [], 1 / 2),
          "STRI65": (_PRISM[:3], _EDGES_6[:3], 1 / 2), "B31": (_BOX[:2], [], 1), "T3D2": (_BOX[:2], [], 1), "hexahedron20": (_BOX, _EDGES_8, 1)}


class Element:
    def __init__(self, name, points):
        self.coordinates = numpy.array(points, dtype=float)
        self.node_labels = numpy.arange(1, len(points) + 1)
        self.elements = [(name, [1], self.node_labels[None])]


@unittest.skipUnless(vtk, "no VTK (python3-vtk9) to read the files with")
class Shapes(unittest.TestCase):
    def cell(self, name, points):
        cells = Cells(Element(name, points))
        grid = vtk.vtkUnstructuredGrid()
        holder = vtk.vtkPoints()
        for point in points:
            holder.InsertNextPoint(*map(float, point))
        grid.SetPoints(holder)
        grid.InsertNextCell(int(cells.types[0]), len(points), cells.connectivity.tolist())
        return grid

    def test_middle_nodes_stand_where_vtk_has_them(self):
        for name, (corners, edges, _) in SHAPES.items():
            points = corners + [tuple(numpy.mean([corners[i], corners[j]], axis=0)) for i, j in edges]
            cell = self.cell(name, points).GetCell(0)
            self.assertEqual(cell.GetNumberOfPoints(), len(points), name)
            self.assertEqual(cell.IsLinear() == 0, bool(edges), name)
            for e in range(cell.GetNumberOfEdges() if edges else 0):
                ends = [numpy.array(points[cell.GetEdge(e).GetPointId(i)]) for i in range(3)]
                numpy.testing.assert_array_equal(ends[2], (ends[0] + ends[1]) / 2, err_msg=name)
            if not cell.IsLinear() and cell.GetCellDimension() == 2:
                self.assertEqual(cell.GetNumberOfEdges(), len(corners), name)

    def test_size(self):
        for name, (corners, edges, size) in SHAPES.items():
            points = corners + [tuple(numpy.mean([corners[i], corners[j]], axis=0)) for i, j in edges]
            sizes = vtk.vtkCellSizeFilter()
            sizes.SetInputData(self.cell(name, points))
            sizes.Update()
            data = sizes.GetOutput().GetCellData()
            found = sum(vtk_to_numpy(data.GetArray(what))[0] for what in ("Length", "Area", "Volume"))
            self.assertAlmostEqual(abs(found), size, 12, name)

    def test_beam_of_three_nodes(self):
        """Its second node is the middle one; VTK's third."""
        cell = self.cell("B32", [(0, 0, 0), (1, 0, 0), (2, 0, 0)]).GetCell(0)
        self.assertEqual([cell.GetPointId(i) for i in range(3)], [0, 2, 1])

    def test_unknown_elements_are_said_and_shown_as_points(self):
        self.assertIsNone(cell_type("USER7", 5))
        with self.assertWarnsRegex(UserWarning, "USER7 with 5 nodes"):
            cells = Cells(Element("USER7", _BOX[:5]))
        self.assertEqual(cells.types.tolist(), [vtk.VTK_POLY_VERTEX])

    def test_nodes_that_are_not_there(self):
        element = Element("C3D8", _BOX)
        element.elements = [("C3D8", [5], [[1, 2, 3, 4, 5, 6, 7, 99]])]
        with self.assertRaisesRegex(ValueError, "node 99 of elements of type C3D8 is not in the mesh"):
            Cells(element)
        element.node_labels = numpy.array([1, 2, 3, 4, 5, 6, 7, 7])
        with self.assertRaisesRegex(ValueError, "node 7 comes twice"):
            Cells(element)


if __name__ == "__main__":
    unittest.main()
