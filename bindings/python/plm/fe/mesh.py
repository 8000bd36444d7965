"""Meshes of other programs through meshio: Gmsh, VTU, MED, Nastran and what else it reads."""
import contextlib
import io
import os

import numpy

from . import deck_elements
from .deck import Deck
from .deck_mesh import Elements
from .deck_surfaces import Surface
from .errors import FileError

# cells of meshio -> element types with their nodes in the same order (solids and faces: that of VTK is that of the decks)
SOLIDS = {"hexahedron": "C3D8", "hexahedron20": "C3D20", "tetra": "C3D4", "tetra10": "C3D10", "wedge": "C3D6", "wedge15": "C3D15",
          "pyramid": "C3D5"}
SHEETS = {"triangle": "S3", "triangle6": "S6", "quad": "S4", "quad8": "S8"}
LINES = {"line": "B31"}


def read_mesh(path, matrices=None):
    """A Deck of a mesh file: nodes, elements, sets of physical groups; no loads, materials or constraints.

    Nodes have the labels 1, 2, ... in the order of the file (meshio does not keep others). Where there are solids, groups of
    triangles and quadrilaterals become surfaces whose normals point out of the solids, and no elements of their own.

    path: of a file that meshio reads. matrices: plm.fe.Matrices, or the path of files with them; None: none yet.

        deck = plm.fe.read_mesh("two.vtu")
        deck.set_matrices("two_K.mtx")
    """
    deck = Deck(path)
    mesh, warnings = _read(path)
    deck.unread += [(deck.path, 0, f"meshio: {warning}") for warning in warnings]
    points = numpy.asarray(mesh.points, dtype=float)
    if not len(points) or points.ndim != 2 or points.shape[1] not in (2, 3) or not numpy.all(numpy.isfinite(points)):
        raise FileError(path, 0, f"the mesh has no points in space (an array of shape {points.shape}, of finite numbers)")
    deck.coordinates = numpy.zeros((len(points), 3))
    deck.coordinates[:, :points.shape[1]] = points
    deck.node_labels = numpy.arange(1, len(points) + 1)
    deck.notes.append("nodes and elements are numbered from 1 in the order of the file")
    _MeshParts(deck, mesh).fill()
    if matrices is not None:
        deck.set_matrices(matrices)
    return deck


def _read(path):
    """(mesh, lines that meshio printed about it)."""
    try:
        import meshio
    except ImportError:
        raise ImportError("meshes are read by meshio: pip install 'plm[mesh]' (Debian: python3-meshio)") from None
    if not os.path.isfile(path):
        raise FileError(path, 0, "there is no such file")
    said = io.StringIO()
    try:  # it prints, and ends the program where no reader takes the file
        with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
            mesh = meshio.read(path)
    except (Exception, SystemExit) as error:  # of any kind: the file is at fault, or its format unknown
        words = str(error) if str(error) not in ("", "1") else " ".join(said.getvalue().split()) or type(error).__name__
        raise FileError(path, 0, f"meshio does not read this mesh: {words}") from None
    if not any(len(cells.data) for cells in mesh.cells):
        raise FileError(path, 0, "the mesh has no cells; is the file complete? " + " ".join(said.getvalue().split()))
    return mesh, [line.strip() for line in said.getvalue().splitlines() if line.strip()]


class _MeshParts:
    """Cells and groups of a meshio mesh into a deck."""

    def __init__(self, deck, mesh):
        self.deck, self.mesh = deck, mesh
        self.has_solids = any(cells.type in SOLIDS for cells in mesh.cells)
        self.first = []  # label of the first element of each cell block, 0 where its cells are none
        self.outward = {}

    def fill(self):
        label = 1
        for cells in self.mesh.cells:
            nodes = numpy.asarray(cells.data, dtype=numpy.int64) + 1
            if nodes.size and not (1 <= nodes.min() and nodes.max() <= len(self.deck.node_labels)):
                raise FileError(self.deck.path, 0, f"cells of type {cells.type} have points that are not there")
            kind = self._element_type(cells.type)
            if kind and nodes.shape[1:] != (deck_elements.n_nodes(kind),):
                raise FileError(self.deck.path, 0, f"cells of type {cells.type} have {nodes.shape[1:]} points, where "
                                f"{deck_elements.n_nodes(kind)} are needed; is the file complete?")
            self.first.append(label if kind else 0)
            if kind and len(nodes):
                self.deck.elements.append(Elements(kind, numpy.arange(label, label + len(nodes)), nodes))
                label += len(nodes)
            elif cells.type not in ("vertex", *LINES, *SHEETS):
                self.deck.unread.append((self.deck.path, 0, f"{len(nodes)} cells of type {cells.type} are not read"))
        if self.has_solids:
            self._find_outer_faces()
        for name, members in self._groups().items():
            self._add_group(name, members)
        for name, points in {**(self.mesh.point_sets or {}), **self._tagged_points()}.items():
            self.deck.node_sets[name.upper()] = numpy.unique(numpy.asarray(points, dtype=numpy.int64) + 1)

    def _element_type(self, kind):
        if kind in SOLIDS:
            return SOLIDS[kind]
        if self.has_solids:
            return None
        if kind in SHEETS:
            return SHEETS[kind]
        has_sheets = any(cells.type in SHEETS for cells in self.mesh.cells)
        return None if has_sheets else LINES.get(kind)

    def _find_outer_faces(self):
        """{corners: the face as the solid has it}, to turn faces out of the body."""
        for block in self.deck.elements:
            for face in deck_elements.faces_of(block.type).values():
                for nodes in block.connectivity[:, list(face)]:
                    self.outward[deck_elements.corner_key(nodes)] = nodes

    def _groups(self):
        """{name: {number of a cell block: places of its cells}} of everything that the format calls a group."""
        mesh, groups = self.mesh, {}
        named = {int(tag): name for name, (tag, *_) in (mesh.field_data or {}).items() if numpy.ndim(tag) == 0}
        for key, prefix in (("gmsh:physical", "PHYSICAL_"), ("nastran:ref", "PROPERTY_"), ("medit:ref", "REFERENCE_")):
            for i, tags in enumerate(mesh.cell_data.get(key, [])):
                for tag in numpy.unique(tags):
                    name = self._name(named, tag, mesh.cells[i].dim, f"{prefix}{int(tag)}")
                    groups.setdefault(name, {})[i] = numpy.flatnonzero(numpy.asarray(tags) == tag)
        for i, tags in enumerate(mesh.cell_data.get("cell_tags", [])):
            for tag in numpy.unique(tags):
                for name in getattr(mesh, "cell_tags", {}).get(tag, []):
                    places = numpy.flatnonzero(numpy.asarray(tags) == tag)
                    before = groups.setdefault(name, {}).get(i, places[:0])
                    groups[name][i] = numpy.concatenate([before, places])
        for name, parts in (mesh.cell_sets or {}).items():
            for i, places in enumerate(parts):
                if places is not None and len(places) and not name.startswith("gmsh:"):
                    groups.setdefault(name, {})[i] = numpy.asarray(places, dtype=numpy.int64)
        return groups

    def _name(self, named, tag, dimension, default):
        for name, (number, *rest) in (self.mesh.field_data or {}).items():
            if int(number) == int(tag) and (not rest or int(rest[0]) == dimension):
                return name
        return named.get(int(tag), default)

    def _tagged_points(self):
        tags, sets = self.mesh.point_data.get("point_tags"), {}
        for tag, names in getattr(self.mesh, "point_tags", {}).items():
            for name in names:
                sets[name] = numpy.concatenate([sets.get(name, numpy.empty(0, int)), numpy.flatnonzero(tags == tag)])
        return sets

    def _add_group(self, name, members):
        """A group has nodes; those of elements also elements, those of faces of solids also a surface."""
        nodes, elements, faces = [], [], []
        for i, places in members.items():
            cells = numpy.asarray(self.mesh.cells[i].data, dtype=numpy.int64)[places] + 1
            nodes.append(cells.ravel())
            if self.first[i]:
                elements.append(self.first[i] + places)
            if self.mesh.cells[i].type in SHEETS:
                faces += [self.outward.get(deck_elements.corner_key(face), face) for face in cells]
        self.deck.node_sets[name.upper()] = numpy.unique(numpy.concatenate(nodes))
        if elements:
            self.deck.element_sets[name.upper()] = numpy.unique(numpy.concatenate(elements))
        if faces:
            self.deck.surfaces[name.upper()] = Surface(name.upper(), faces, [], numpy.unique(numpy.concatenate(faces)), None,
                                                       self.deck.path, 0)
