"""Rows of a deck's model: those of its matrices, and more for reference nodes and their followers, which no element gives any."""
import numpy

from .deck_elements import faces_of, is_sheet

ROTATIONS = (4, 5, 6)


class DofMap:
    """(node, direction) <-> row. n: rows in all; the first ones are those of the matrices; extra: [(node, direction)] behind them."""

    def __init__(self, deck):
        dofs = numpy.asarray(deck.matrices.dofs, dtype=numpy.int64).reshape(-1, 2)
        named = (dofs[:, 0] > 0) & (dofs[:, 1] >= 1) & (dofs[:, 1] <= 6)
        self._row = {}
        for row, (node, direction) in zip(numpy.flatnonzero(named).tolist(), dofs[named].tolist()):
            if self._row.setdefault((node, direction), row) != row:
                raise ValueError(f"the matrices have two rows for node {node} in direction {direction}: "
                                 f"{self._row[node, direction]} and {row}")
        known = set(deck.node_labels.tolist())
        if self._row and not any(node in known for node, _ in self._row):
            raise ValueError(f"no node of the matrices is in {deck.path}; do the two belong together?")
        self._turning, self._solid = _attached(deck)
        self.extra, self._n_matrices = [], len(dofs)
        self._add_references(deck)
        self.n = len(dofs) + len(self.extra)

    def row(self, node, direction):
        return self._row.get((int(node), int(direction)))

    def rows(self, nodes, directions=(1, 2, 3)):
        """n x directions, -1 where there is no such DOF."""
        return numpy.array([[self._row.get((node, d), -1) for d in directions] for node in numpy.asarray(nodes).tolist()],
                           dtype=numpy.int64).reshape(-1, len(directions))

    def is_held(self, node, direction):
        """Whether a node has elements that give it this DOF, but the matrices do not have it: it was held when they were made."""
        return (node, direction) not in self._row and node in (self._turning if direction > 3 else self._turning | self._solid)

    def _add(self, node, direction):
        if (node, direction) not in self._row and not self.is_held(node, direction):
            self._row[node, direction] = self._n_matrices + len(self.extra)
            self.extra.append((node, direction))

    def _add_references(self, deck):
        used = self.asked_rotations = _named_rotations(deck)
        for coupling in deck.couplings:
            node = coupling.reference
            for direction in (1, 2, 3):
                self._add(node, direction)
            turns = coupling.kind != "distributing" or node in used
            if coupling.rotation is not None:
                for direction in (1, 2, 3):
                    self._add(coupling.rotation, direction)
                    self._row.setdefault((node, direction + 3), self._row[coupling.rotation, direction])
            elif turns:
                for direction in ROTATIONS:
                    self._add(node, direction)
            if coupling.kind != "distributing":
                self._add_followers(coupling)
        for equation in deck.equations:
            for node, direction, _ in equation.terms:
                if node not in self._solid or direction < 4:
                    self._add(node, direction)


    def _add_followers(self, coupling):
        """Nodes of no element that follow a reference, as the end of an arm on which a load acts."""
        for node in coupling.nodes.tolist():
            if node not in self._turning and node not in self._solid and not any((node, d) in self._row for d in range(1, 7)):
                for direction in coupling.directions:
                    self._add(node, direction)


def _attached(deck):
    """(nodes of elements whose nodes turn, nodes of all other elements)."""
    turning, solid = set(), set()
    for block in deck.elements:
        if block.type == "DCOUP3D":  # a name for a reference node, not an element
            continue
        turns = block.type.startswith("B3") or is_sheet(block.type) and not block.type.startswith(("M3D", "SFM3D"))
        if turns or faces_of(block.type) or block.type.startswith(("T3D", "C")):
            (turning if turns else solid).update(block.connectivity.ravel().tolist())
    return turning, solid


def _named_rotations(deck):
    """Nodes whose rotations something else in the deck asks for."""
    nodes = {node for equation in deck.equations for node, direction, _ in equation.terms if direction > 3}
    for load in deck.loads:
        if getattr(load, "direction", 0) > 3:
            nodes.update(load.nodes.tolist())
    for coupling in deck.couplings:
        if coupling.kind != "distributing" and set(coupling.directions) & set(ROTATIONS):
            nodes.update(coupling.nodes.tolist())
    return nodes
