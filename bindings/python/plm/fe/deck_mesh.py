"""Nodes, elements, sets and surfaces of a deck."""
from typing import NamedTuple

import numpy

from . import deck_elements
from .deck_lines import LARGEST_LABEL, plain_numbers, shown, table
from .deck_sets import SetTable


class Elements(NamedTuple):
    """Elements of one *ELEMENT block: type name in upper case, labels (n), labels of their nodes (n x k)."""
    type: str
    labels: numpy.ndarray
    connectivity: numpy.ndarray


class MeshReader:
    """Reads the blocks that make the mesh; the others are left to others. take(block) tells whether it was one of them."""

    def __init__(self):
        self.node_sets, self.element_sets = SetTable("node"), SetTable("element")
        self.blocks, self.surface_blocks, self.nodes_of_elements, self.unread = [], [], [], []
        self._nodes, self._systems = [], {}
        self.labels, self.coordinates = None, None  # of all nodes, once they are read
        self._of_elements = {"NODE": self._node, "ELEMENT": self._element, "NSET": self._nset, "ELSET": self._elset,
                             "SURFACE": self.surface_blocks.append, "SYSTEM": self._system}

    def take(self, block):
        reader = self._of_elements.get(block.key)
        if reader:
            reader(block)
        return reader is not None

    # ---- nodes ----

    def _node(self, block):
        if not block.lines:
            return
        values = table(block, 4, "a node (label, x, y, z)")
        label = numpy.clip(values[:, 0], 0, LARGEST_LABEL).astype(numpy.int64)
        for i in numpy.flatnonzero((label != values[:, 0]) | (label < 1))[:1]:
            block.lines[i].fail(f"a node has the label {shown(block.lines[i].field(0))}; a whole number from 1 on is needed")
        xyz = self._from_system(block, values[:, 1:])
        label = label + block.scope.shift
        self._nodes.append((label, xyz, block))
        if block.get("NSET"):
            self.node_sets.add(block.scope.full(block.get("NSET")), label, block)

    def _from_system(self, block, xyz):
        """Coordinates in space: of a cylindrical or spherical list, in the local system of *SYSTEM, in the instance's place."""
        kind = block.word("SYSTEM", "R")
        if kind in ("C", "S"):
            r, angle, z = xyz[:, 0], numpy.radians(xyz[:, 1]), xyz[:, 2]
            if kind == "S":
                r, z = r * numpy.cos(numpy.radians(z)), r * numpy.sin(numpy.radians(z))
            xyz = numpy.column_stack([r * numpy.cos(angle), r * numpy.sin(angle), z])
        elif kind != "R":
            block.fail(f"SYSTEM={kind} is not known; R, C or S")
        if block.scope in self._systems:
            origin, axes = self._systems[block.scope]
            xyz = origin + xyz @ axes
        return block.scope.put(xyz)

    def _system(self, block):
        """Local axes as rows: a is the origin, b on the first axis, c in the plane of the first two. Without lines: none."""
        values = [line.real(i, "a coordinate", 0.0) for line in block.lines[:2] for i in range(6 if line is block.lines[0] else 3)]
        if not values:
            self._systems.pop(block.scope, None)
            return
        given = len(block.lines[0].fields)
        origin, axes = numpy.array(values[:3]), numpy.eye(3)
        if given > 3:
            if len(block.lines) < 2:
                block.fail("*SYSTEM has points a and b, but no point c on a second line; give it (it fixes the plane of x and y)")
            x, plane = numpy.array(values[3:6]) - origin, numpy.array(values[6:9]) - origin
            z = numpy.cross(x, plane)
            length = numpy.linalg.norm(x), numpy.linalg.norm(z)
            if not (length[0] > 0 and length[1] > 1e-12 * length[0] * numpy.linalg.norm(plane)):
                block.fail("the three points of *SYSTEM lie on a line; they make no axes")
            x, z = x / length[0], z / length[1]
            axes = numpy.array([x, numpy.cross(z, x), z])
        self._systems[block.scope] = origin, axes

    def nodes(self):
        """(sorted labels, coordinates). A node may come again at the same place."""
        if not self._nodes:
            return numpy.empty(0, dtype=numpy.int64), numpy.empty((0, 3))
        label = numpy.concatenate([part[0] for part in self._nodes])
        xyz = numpy.concatenate([part[1] for part in self._nodes])
        unique, first, which = numpy.unique(label, return_index=True, return_inverse=True)
        apart = numpy.flatnonzero(numpy.any(xyz != xyz[first][which], axis=1))
        if apart.size:
            lines = [line for part in self._nodes for line in part[2].lines]
            lines[apart[0]].fail(f"node {label[apart[0]]} comes again, at another place than on line "
                                 f"{lines[first[which[apart[0]]]].number}")
        return unique, xyz[first]

    # ---- elements ----

    def _element(self, block):
        kind = block.word("TYPE")
        if not kind:
            block.fail("*ELEMENT has no TYPE=; give it")
        n = deck_elements.n_nodes(kind)
        if n is None:
            self.unread.append((block.file, block.number, f"*ELEMENT, TYPE={kind}: this type of element is not known; "
                                f"{len(block.lines)} lines"))
            return
        labels, nodes = self._plain_elements(block, n)
        if labels is None:
            labels, nodes = self._long_elements(block, n, kind)
        shift = block.scope.shift
        self.blocks.append((Elements(kind, labels + shift, nodes + shift), block))
        if block.get("ELSET"):
            self.element_sets.add(block.scope.full(block.get("ELSET")), labels + shift, block)

    @staticmethod
    def _plain_elements(block, n):
        """Elements of one line each, all at once; None where they are not."""
        values = plain_numbers([line.text.rstrip(", ") for line in block.lines], numpy.int64)
        if values is None or values.shape[1:] != (n + 1,) or values.min(initial=1) < 1 or values.max(initial=1) > LARGEST_LABEL:
            return None, None
        return values[:, 0], values[:, 1:]

    @staticmethod
    def _long_elements(block, n, kind):
        """Line by line: an element goes on until it has its nodes."""
        labels, nodes, open_line = [], [], None
        for line in block.lines:
            numbers = [line.integer(i, "a label") for i in range(len(line.fields))]
            for number in numbers:
                if number < 1:
                    line.fail(f"the label {number}; labels begin with 1")
            if open_line is None and numbers:
                labels.append(numbers.pop(0))
                nodes.append([])
                open_line = line
            if nodes:
                nodes[-1] += numbers
                if len(nodes[-1]) > n:
                    line.fail(f"element {labels[-1]} has {len(nodes[-1])} nodes; {kind} has {n}")
                if len(nodes[-1]) == n:
                    open_line = None
        if open_line is not None:
            open_line.fail(f"element {labels[-1]} has {len(nodes[-1])} nodes; {kind} has {n}")
        return numpy.array(labels, dtype=numpy.int64), numpy.array(nodes, dtype=numpy.int64).reshape(-1, n)

    def check_elements(self, node_labels):
        """Each label once, and nodes that are there."""
        for elements, block in self.blocks:
            missing = ~is_in(elements.connectivity, node_labels)
            if missing.any():
                i = numpy.flatnonzero(missing.any(axis=1))[0]
                block.fail(f"element {elements.labels[i]} of this block has the node {elements.connectivity[i][missing[i]][0]}, "
                           "which the deck does not define")
        labels = [elements.labels for elements, _ in self.blocks] or [numpy.empty(0, dtype=numpy.int64)]
        unique, count = numpy.unique(numpy.concatenate(labels), return_counts=True)
        twice = unique[count > 1]
        if twice.size:
            block = [block for elements, block in self.blocks if twice[0] in elements.labels][-1]
            block.fail(f"element {twice[0]} of this block is defined twice")

    # ---- sets ----

    def _nset(self, block):
        self._set(block, self.node_sets, "NSET")
        if block.get("ELSET"):  # all nodes of these elements, which are known at the end
            self.nodes_of_elements.append(block)

    def _elset(self, block):
        self._set(block, self.element_sets, "ELSET")

    @staticmethod
    def _set(block, sets, parameter):
        block.needed(parameter)
        scope = block.scope
        if block.get("INSTANCE"):
            scope = block.scope.instances.get(block.get("INSTANCE").upper())
            if scope is None:
                block.fail(f"there is no instance {shown(block.get('INSTANCE'))} above")
        sets.add_lines(block, block.scope.full(block.get(parameter)), scope)

    def finish_sets(self, node_labels):
        """(node sets, element sets), all labels. Sets that are generated across gaps keep the nodes that are there."""
        elements = self.element_sets.resolve()
        for block in self.nodes_of_elements:
            full = self.element_sets.find(block.get("ELSET"), block.scope)
            if full is None:
                block.fail(f"there is no element set {shown(block.get('ELSET'))}")
            self.node_sets.add(block.scope.full(block.get("NSET")), self.nodes_of(elements[full]), block)
        nodes = self.node_sets.resolve()
        for full, labels in list(nodes.items()):
            missing = labels[~is_in(labels, node_labels)]
            if len(missing):
                line = next((line for item, line in self.node_sets.items[full] if not isinstance(item, tuple) and missing[0] in item),
                            self.node_sets.items[full][0][1])
                self.unread.append((line.file, line.number, f"{len(missing)} nodes of the set {full} are not defined, the "
                                    f"first is {missing[0]}; left out"))
                nodes[full] = labels[is_in(labels, node_labels)]
        return nodes, elements

    def nodes_of(self, elements):
        """Labels of the nodes of elements, sorted."""
        parts = [block.connectivity[numpy.isin(block.labels, elements)].ravel() for block, _ in self.blocks]
        return numpy.unique(numpy.concatenate(parts)) if parts else numpy.empty(0, dtype=numpy.int64)


def is_in(labels, known):
    """Which labels are among the known ones, which are sorted; by the logarithm of their number, also for one label of a million."""
    at = numpy.minimum(numpy.searchsorted(known, labels), max(len(known) - 1, 0))
    return known[at] == labels if len(known) else numpy.zeros(numpy.shape(labels), dtype=bool)
