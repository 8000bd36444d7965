"""Decks of CalculiX and Abaqus: what they say about mesh, constraints, contact and loads.

    deck = read_deck("joint.inp")             # matrices: a second argument, or made by CalculiX where it is installed
    for file, line, text in deck.unread:      # what was not understood
        print(f"{file}:{line}: {text}")
    model = deck.model(force=[(17, 3, 1.0)])  # built: 1 N along z at node 17
    response = model.compute_response(deck.dof(17, 3))
"""
import os

import numpy

from .deck_assembly import flatten
from .deck_contact import ContactReader, MaterialReader
from .deck_lines import read_blocks
from .deck_mesh import MeshReader
from .deck_rules import RuleReader
from .deck_sets import Names
from .deck_steps import StepReader
from .deck_surfaces import SurfaceReader
from .errors import FileError

# What is printed and written, how a step is controlled: nothing that changes the model.
WITHOUT_EFFECT = {"HEADING", "PREPRINT", "RESTART", "NODEFILE", "NODEPRINT", "NODEOUTPUT", "ELFILE", "ELPRINT", "ELEMENTOUTPUT",
                  "CONTACTFILE", "CONTACTPRINT", "CONTACTOUTPUT", "SECTIONPRINT", "OUTPUT", "FILEFORMAT", "MONITOR", "PRINT",
                  "ENERGYOUTPUT", "ENERGYPRINT", "ENERGYFILE", "TIMEPOINTS", "CONTROLS", "SOLVERCONTROLS", "NOANALYSIS",
                  "MATRIXOUTPUT", "FILTER", "DIAGNOSTICS", "AMPLITUDE"}

# Of materials: what counts with temperatures alone, which are listed themselves.
WITHOUT_EFFECT |= {"EXPANSION", "CONDUCTIVITY", "SPECIFICHEAT"}
# Sections of elements that CalculiX makes no matrices of: those that are handed over have them.
WITHOUT_EFFECT |= {"BEAMSECTION", "BEAMGENERALSECTION", "SHELLSECTION", "SHELLGENERALSECTION", "MEMBRANESECTION", "TRANSVERSESHEARSTIFFNESS"}


class Deck:
    """A structure as files of other codes describe it.

    node_labels (n, int64, sorted), coordinates (n x 3)
    elements: list of (type, labels, connectivity in node labels)
    node_sets, element_sets: {name: labels}; surfaces: {name: Surface}; names are alike in upper and lower case
    ties, couplings, equations, boundaries, loads, contact_pairs: lists of records, each with file and line
    interactions, materials: {name: record}; steps, procedures: names of the steps and what they are
    unread: list of (file, line, text), what is not understood; notes: list of texts, what was assumed
    matrices: plm.fe.matrices.Matrices, or None
    path: of the file. read_deck and read_mesh make one; by hand it is empty, and these are its members to fill.

        deck = plm.fe.Deck("own.inp")
        deck.node_labels, deck.coordinates = numpy.array([1, 2]), numpy.array([[0, 0, 0], [1, 0, 0]])
    """

    def __init__(self, path):
        self.path = os.fspath(path)
        self.node_labels, self.coordinates = numpy.empty(0, dtype=numpy.int64), numpy.empty((0, 3))
        self.elements, self.node_sets, self.element_sets, self.surfaces = [], Names(), Names(), Names()
        self.ties, self.couplings, self.equations, self.boundaries, self.loads = [], [], [], [], []
        self.contact_pairs, self.interactions, self.materials = [], Names(), Names()
        self.steps, self.procedures, self.unread, self.notes = [], [], [], []
        self.rayleigh, self.modal_damping = None, None
        self.property_blocks, self.matrices, self._map = [], None, None

    def __repr__(self):
        return (f"<plm.fe.Deck {self.path}: {len(self.node_labels)} nodes, {sum(len(e.labels) for e in self.elements)} elements, "
                f"{len(self.contact_pairs)} contact pairs, {len(self.unread)} places not understood>")

    def node_rows(self, labels):
        """Places of nodes in node_labels and coordinates, from 0; labels: an array of them.

            xyz = deck.coordinates[deck.node_rows([1, 2])]
        """
        labels = numpy.asarray(labels, dtype=numpy.int64)
        at = numpy.searchsorted(self.node_labels, labels)
        found = at < len(self.node_labels)
        found[found] = self.node_labels[at[found]] == labels[found]
        if not numpy.all(found):
            raise KeyError(f"there is no node {labels[~found].flat[0]} in {self.path}")
        return at

    def faces(self, surface):
        """Node rows (places in node_labels) of the faces of a surface, by its name or itself: n x k; a list of arrays where faces
        have different numbers of nodes, an empty one for nodes alone. Corners first, normals out of the body.

            corners = deck.faces("TOP")
        """
        if isinstance(surface, str):
            surface = self.surfaces[surface]
        rows = [self.node_rows(face) for face in surface.faces]
        return numpy.array(rows, dtype=numpy.int64) if len({len(row) for row in rows}) == 1 else rows

    def section_set(self, block):
        """Name of the element set that a section, *SPRING or *MASS is for; block: the card, as one of `materials` and such keep it.

            name = deck.section_set(section)
        """
        for name in (block.scope.full(block.needed("ELSET")), block.get("ELSET").upper()):
            if name in self.element_sets:
                return name
        block.fail(f"there is no element set {block.get('ELSET')}")

    def dof(self, node, direction):
        """Row of a node's DOF (direction 1 to 6) in the model, from 0; None where it has none.

            row = deck.dof(node=2, direction=1)
        """
        return self._dofs().row(node, direction)

    @property
    def n_dof(self):
        """Rows of the model: those of the matrices, and of reference nodes that have none there."""
        return self._dofs().n

    def _dofs(self):
        from .deck_dofs import DofMap  # with the first use
        if self._map is None:
            if self.matrices is None:
                raise ValueError("the deck has no matrices yet, so no rows; read_deck(path, matrices), or deck.matrices_by_calculix()")
            self._map = DofMap(self)
        return self._map

    def set_matrices(self, matrices):
        """Matrices of plm.fe.matrices, or the path of files with them.

            deck.set_matrices("two_K.mtx")
        """
        if isinstance(matrices, (str, os.PathLike)):
            from .matrices import read_matrices
            matrices = read_matrices(matrices)
        self.matrices, self._map = matrices, None

    def matrices_by_calculix(self, folder=None, program="ccx"):
        """Stiffness and mass by CalculiX from mesh, materials and sections; constraints, supports and contact stay the library's. A
        temporary folder unless one is given, in which the files then stay (without the point masses of *MASS, which are added to what
        CalculiX writes). Returns the matrices, which are the deck's from now. program: the command that runs CalculiX.

            matrices = deck.matrices_by_calculix(folder="ccx")
        """
        from .deck_calculix import matrices_of
        self.set_matrices(matrices_of(self, folder, program))
        return self.matrices

    def model(self, context=None, **options):
        """A built plm.Model of the deck; see plm.fe.deck_model.build_model for the options. context: a plm.Context; None: the one of
        this thread.

            model = deck.model()
        """
        from .deck_model import build_model
        return build_model(self, context, **options)


def read_deck(path, matrices=None):
    """Reads a deck with what it includes. matrices: plm.fe.matrices.Matrices or a path of files for it; None: there are none yet,
    and deck.model() has CalculiX make them. FileError where the deck is wrong; what is not understood is listed in `unread`. path: of the deck.

        deck = plm.fe.read_deck("two.inp", matrices="two_K.mtx")
        print(deck.model().modes(2), deck.dof(node=2, direction=1))
    """
    blocks, _, notes = flatten(read_blocks(path))
    deck = Deck(path)
    deck.notes += notes
    mesh, others = _read_mesh(deck, blocks)
    _read_others(deck, mesh, others)
    deck.unread.sort(key=lambda place: (place[0], place[1]))
    if matrices is not None:
        deck.set_matrices(matrices)
    return deck


def _read_mesh(deck, blocks):
    """Nodes, elements and sets. Returns (the reader, blocks that are left)."""
    reader = MeshReader()
    others = [block for block in blocks if not reader.take(block)]
    deck.node_labels, deck.coordinates = reader.nodes()
    if not len(deck.node_labels):
        raise FileError(deck.path, 0, "the deck defines no nodes (*NODE)")
    reader.labels, reader.coordinates = deck.node_labels, deck.coordinates
    reader.check_elements(deck.node_labels)
    deck.elements = [elements for elements, _ in reader.blocks]
    deck.node_sets, deck.element_sets = reader.finish_sets(deck.node_labels)
    deck.unread += reader.unread
    return reader, others


def _read_others(deck, mesh, blocks):
    faces = SurfaceReader(deck.elements, mesh.node_sets, mesh.element_sets)
    for block in mesh.surface_blocks:
        surface = faces.read(block)
        if surface.name in deck.surfaces:
            block.fail(f"there is another surface {surface.name}, on line {deck.surfaces[surface.name].line}")
        deck.surfaces[surface.name] = surface
    steps = StepReader(mesh, faces, deck.unread)
    rules = steps.rules = RuleReader(mesh, deck.surfaces, steps, deck.unread)
    contact, materials = ContactReader(rules, deck.unread), MaterialReader(deck.unread)
    handlers = {**steps.handlers, **rules.handlers, **contact.handlers, **materials.handlers}
    for block in blocks:
        if block.key in handlers:
            handlers[block.key](block)
        elif block.key not in WITHOUT_EFFECT:
            deck.unread.append((block.file, block.number, f"*{block.key} is not read"
                                + (f"; {len(block.lines)} lines" if block.lines else "")))
    steps.finish()
    contact.finish()
    rules.check_transformed(steps.loads)
    for boundary in rules.boundaries:
        procedure = steps.procedures[boundary.step] if boundary.step >= 0 else ""
        if boundary.value and procedure != "STEADYSTATEDYNAMICS":
            deck.unread.append((boundary.file, boundary.line, f"*BOUNDARY with the value {boundary.value:g}: held at 0"))
    deck.ties, deck.couplings, deck.equations, deck.boundaries = rules.ties, rules.couplings, rules.equations, rules.boundaries
    deck.loads, deck.steps, deck.procedures, deck.modal_damping = steps.loads, steps.names, steps.procedures, steps.modal_damping
    deck.contact_pairs = contact.pairs
    deck.interactions.update(contact.interactions)
    deck.materials.update(materials.materials)
    deck.rayleigh, deck.property_blocks = materials.rayleigh(), materials.property_blocks
