"""Surfaces of a deck: faces of elements, or nodes alone."""
from typing import NamedTuple

import numpy

from . import deck_elements
from .deck_lines import shown


class Surface(NamedTuple):
    """faces: arrays of the node labels of each face, corners first, normals out of the body; empty for nodes alone.
    elements: the element of each face; nodes: sorted labels; areas: what nodes alone stand for (n), or None."""
    name: str
    faces: list
    elements: list
    nodes: numpy.ndarray
    areas: numpy.ndarray
    file: str
    line: int


class SurfaceReader:
    """Makes surfaces out of *SURFACE blocks, once elements and sets are known."""

    def __init__(self, elements, node_sets, element_sets):
        """elements: list of deck_mesh.Elements; the sets as SetTable."""
        self._elements, self._node_sets, self._element_sets = elements, node_sets, element_sets
        self._outer = None
        count = [len(block.labels) for block in elements]
        self._label = numpy.concatenate([block.labels for block in elements]) if elements else numpy.empty(0, dtype=numpy.int64)
        self._order = numpy.argsort(self._label, kind="stable")
        self._begin = numpy.concatenate([[0], numpy.cumsum(count)]).astype(numpy.int64)

    def element(self, label):
        """(type, nodes) of an element; None where there is none."""
        at = numpy.searchsorted(self._label, label, sorter=self._order)
        if at == len(self._label) or self._label[self._order[at]] != label:
            return None
        place = self._order[at]
        block = numpy.searchsorted(self._begin, place, "right") - 1
        return self._elements[block].type, self._elements[block].connectivity[place - self._begin[block]]

    def read(self, block):
        name = block.scope.full(block.needed("NAME"))
        kind = block.word("TYPE") or "ELEMENT"
        if "COMBINE" in block or kind not in ("ELEMENT", "NODE") or "CROP" in block:
            block.fail("surfaces of TYPE=ELEMENT and TYPE=NODE are read, without COMBINE= and CROP; list the faces or nodes")
        if kind == "NODE":
            return self._of_nodes(name, block)
        faces, elements = [], []
        for line in block.lines:
            if not line.field(0):
                line.fail("a surface of the whole model; name the element sets")
            side = line.field(1).upper().replace(" ", "")
            for label in self._element_sets.chosen(line.field(0), line, block.scope):
                for face in self._faces(label, side, line):
                    faces.append(face)
                    elements.append(int(label))
        if not faces:
            block.fail(f"the surface {name} has no faces")
        return Surface(name, faces, elements, numpy.unique(numpy.concatenate(faces)), None, block.file, block.number)

    def _of_nodes(self, name, block):
        labels, areas = [], []
        for line in block.lines:
            chosen = self._node_sets.chosen(line.field(0), line, block.scope)
            labels.append(chosen)
            areas.append(numpy.full(len(chosen), line.real(1, "an area", 0.0)))
        if not labels or not len(numpy.concatenate(labels)):
            block.fail(f"the surface {name} has no nodes")
        nodes, first = numpy.unique(numpy.concatenate(labels), return_index=True)
        areas = numpy.concatenate(areas)[first]
        return Surface(name, [], [], nodes, areas if numpy.all(areas > 0) else None, block.file, block.number)

    def _faces(self, label, side, line):
        """Node labels of the faces that one element gives."""
        found = self.element(label)
        if found is None:
            line.fail(f"there is no element {label}")
        kind, nodes = found
        known = deck_elements.faces_of(kind)
        if side:
            if side not in known:
                line.fail(f"{kind} has no face {shown(side)}; " + (f"it has {', '.join(known)}" if known else "it has no faces in space"))
            return [nodes[list(known[side])]]
        if deck_elements.is_sheet(kind):
            return [nodes[list(known["SPOS"])]]
        if self._outer is None:
            self._outer = self._count_faces()
        faces = [nodes[list(face)] for face in known.values()]
        return [face for face in faces if self._outer[deck_elements.corner_key(face)] == 1]

    def _count_faces(self):
        """How many solids share each face of any."""
        count = {}
        for block in self._elements:
            if deck_elements.is_sheet(block.type):
                continue
            for face in deck_elements.faces_of(block.type).values():
                for nodes in block.connectivity[:, list(face)]:
                    key = deck_elements.corner_key(nodes)
                    count[key] = count.get(key, 0) + 1
        return count
