"""The elements of a mesh as cells of VTK: types by number, nodes in VTK's order."""
import re
import warnings

import numpy

VERTEX, POLY_VERTEX, LINE, QUADRATIC_LINE = 1, 2, 3, 21

# by shape and number of nodes; the orders of nodes of CalculiX and Abaqus are those of VTK, but for lines of three
_SOLIDS = {4: 10, 5: 14, 6: 13, 8: 12, 10: 24, 13: 27, 15: 26, 20: 25}
_FACES = {3: 5, 4: 9, 6: 22, 8: 23}
_LINES = {2: LINE, 3: QUADRATIC_LINE}

# what a type is called, without what says how it is integrated: C3D8R, CPS4, S8R, STRI65, SFM3D4, B32R, T3D2, SPRINGA
_NAMES = ((r"(C3D|DC3D|AC3D|F3D)\d", _SOLIDS), (r"(CPS|CPE|CPEG|CAX|DC2D|S|SC|STRI|M3D|SFM3D|R3D|DS|AC2D)\d", _FACES),
          (r"(B3|B2|T3D|T2D|D|PIPE3|RB3D|FRAME3D|GAPUNI|SPRING|DASHPOT|CONN3D|ITS)", _LINES))
_GENERIC = {"vertex": (VERTEX, 1), "line": (LINE, 2), "line3": (QUADRATIC_LINE, 3), "triangle": (5, 3), "triangle6": (22, 6),
            "quad": (9, 4), "quad8": (23, 8), "tetra": (10, 4), "tetra10": (24, 10), "pyramid": (14, 5), "pyramid13": (27, 13),
            "wedge": (13, 6), "wedge15": (26, 15), "hexahedron": (12, 8), "hexahedron20": (25, 20)}


def cell_type(name, n_nodes):
    """VTK's number for an element type, by the names of CalculiX and Abaqus (C3D20R) or of meshio (hexahedron20); None where it
    is none of those."""
    generic = _GENERIC.get(name.lower())
    if generic:
        return generic[0] if generic[1] == n_nodes else None
    if n_nodes == 1:
        return VERTEX
    for pattern, by_nodes in _NAMES:
        if re.match(pattern, name.upper()):
            return by_nodes.get(n_nodes)
    return None


class Cells:
    """The cells of a mesh: types (n_cells, uint8), connectivity (places of nodes from 0), offsets (n_cells + 1), and the label of
    every element (0: a node that stands alone). A mesh without elements is shown by its nodes."""

    def __init__(self, mesh):
        self._place = Places(mesh.node_labels)
        types, connectivity, sizes, labels = [], [], [], []
        for name, of_block, nodes in mesh.elements:
            nodes = self._nodes(name, of_block, nodes)
            types.append(numpy.full(len(nodes), self._type(name, nodes.shape[1]), dtype=numpy.uint8))
            sizes.append(numpy.full(len(nodes), nodes.shape[1], dtype=numpy.int64))
            connectivity.append(nodes.ravel())
            labels.append(numpy.asarray(of_block, dtype=numpy.int64))
        if not types:
            n = len(mesh.node_labels)
            types, connectivity = [numpy.full(n, VERTEX, dtype=numpy.uint8)], [numpy.arange(n, dtype=numpy.int64)]
            sizes, labels = [numpy.ones(n, dtype=numpy.int64)], [numpy.zeros(n, dtype=numpy.int64)]
        self.types, self.connectivity, self.labels = map(numpy.concatenate, (types, connectivity, labels))
        self.offsets = numpy.concatenate([[0], numpy.cumsum(numpy.concatenate(sizes))]).astype(numpy.int64)

    def _nodes(self, name, labels, nodes):
        nodes = numpy.asarray(nodes, dtype=numpy.int64)
        nodes = nodes.reshape((len(labels), -1)) if len(labels) else nodes.reshape((0, 1))
        place = self._place.of(nodes, f"elements of type {name}")
        if re.match(r"B\d2|T\dD3|PIPE\d2", name.upper()) and place.shape[1] == 3:
            place = place[:, [0, 2, 1]]  # the middle node stands in the middle there, and last in VTK
        return place

    @staticmethod
    def _type(name, n_nodes):
        found = cell_type(name, n_nodes)
        if found is None:
            warnings.warn(f"elements of type {name} with {n_nodes} nodes have no shape in VTK that is known here; their nodes are "
                          "written as points", stacklevel=4)
        return POLY_VERTEX if found is None else found


class Places:
    """Where the nodes of these labels stand in a mesh."""

    def __init__(self, node_labels):
        labels = numpy.asarray(node_labels, dtype=numpy.int64)
        self._order = numpy.argsort(labels, kind="stable")
        self._sorted = labels[self._order]
        twice = numpy.flatnonzero(self._sorted[1:] == self._sorted[:-1])
        if twice.size:
            raise ValueError(f"node {self._sorted[twice[0]]} comes twice in the mesh; every node needs a label of its own")

    def of(self, labels, what):
        """Places from 0, of the shape of `labels`; what: named where a node is missing."""
        labels = numpy.asarray(labels, dtype=numpy.int64)
        if not self._sorted.size:
            at, known = numpy.zeros(labels.shape, dtype=numpy.int64), numpy.zeros(labels.shape, dtype=bool)
        else:
            at = numpy.searchsorted(self._sorted, labels).clip(0, self._sorted.size - 1)
            known = self._sorted[at] == labels
        if not known.all():
            raise ValueError(f"node {labels[~known].flat[0]} of {what} is not in the mesh")
        return self._order[at] if labels.size else at
