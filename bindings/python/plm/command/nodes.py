"""Nodes and directions in words, and the nodes of matrices that have no mesh."""
import numpy

from ..fe.errors import FileError
from .settings import Wrong
from .tables import number, read_table

DIRECTIONS = {"x": 1, "y": 2, "z": 3, "rx": 4, "ry": 5, "rz": 6, **{str(i): i for i in range(1, 7)}}


def direction_of(value, what):
    """1 to 6 of x, y, z, rx, ry, rz or of the number itself."""
    found = DIRECTIONS.get(str(value).strip().lower())
    if found is None:
        raise Wrong(f"{what}: {value!r} is no direction; those are x, y, z, rx, ry, rz, or 1 to 6")
    return found


class NodeCloud:
    """The nodes of matrices, as plm.fe takes meshes: their coordinates where these are known, no elements.

    dofs: n_dof x 2, node and direction (1 to 6) of every row; rows without a node have a node below 1 or direction 0.
    coordinates: dict of node -> x, y, z, or None."""

    def __init__(self, dofs, coordinates=None):
        self._rows = {}
        for row, (node, direction) in enumerate(numpy.asarray(dofs).tolist()):
            if node < 1 or direction < 1:
                continue
            if self._rows.setdefault((node, direction), row) != row:
                raise Wrong(f"direction {direction} of node {node} stands at row {self._rows[node, direction]} and at row {row} of the "
                            "matrices (from 0)")
        self.node_labels = numpy.array(sorted({node for node, _ in self._rows}), dtype=numpy.int64)
        self.elements, self.pair_nodes = [], None
        self.coordinates = None
        if coordinates is not None:
            missing = [node for node in self.node_labels.tolist() if node not in coordinates]
            if missing:
                raise Wrong(f"node {missing[0]} of the matrices has no coordinates")
            self.coordinates = numpy.array([coordinates[node] for node in self.node_labels.tolist()]).reshape((-1, 3))

    def dof(self, node, direction):
        """Row of the model, from 0, or None."""
        return self._rows.get((node, direction))


def read_coordinates(path):
    """{node: (x, y, z)} of a table with the columns node, x, y, z."""
    found = {}
    for line, row in read_table(path, ("node", "x", "y", "z")):
        node = number(path, line, row, "node", whole=True)
        if node in found:
            raise FileError(path, line, f"node {node} comes twice")
        found[node] = tuple(number(path, line, row, axis) for axis in "xyz")
    return found
