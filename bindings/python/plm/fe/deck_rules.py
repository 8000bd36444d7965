"""What a deck says about motions that belong together: ties, couplings, rigid bodies, equations, supports."""
from typing import NamedTuple

import numpy

from . import deck_elements
from .deck_lines import shown, whole
from .deck_mesh import is_in
from .errors import FileError

SYMMETRIES = {"XSYMM": (1, 5, 6), "YSYMM": (2, 4, 6), "ZSYMM": (3, 4, 5), "XASYMM": (2, 3, 4), "YASYMM": (1, 3, 5),
              "ZASYMM": (1, 2, 6), "PINNED": (1, 2, 3), "ENCASTRE": (1, 2, 3, 4, 5, 6)}


class Tie(NamedTuple):
    """slave, master: names of surfaces; tolerance: a length, None where the deck gives none."""
    name: str
    slave: str
    master: str
    tolerance: float
    file: str
    line: int


class Coupling(NamedTuple):
    """kind: "distributing" (the reference follows the nodes), "kinematic" or "rigid" (the nodes follow the reference).
    rotation: the node whose directions 1 to 3 are the reference's rotations, None: its own directions 4 to 6.
    nodes, weights: labels and weights (None: alike); directions: those of the nodes that are coupled."""
    kind: str
    reference: int
    rotation: int
    nodes: numpy.ndarray
    weights: numpy.ndarray
    directions: tuple
    file: str
    line: int


class Equation(NamedTuple):
    """terms: (node, direction, coefficient); their sum is zero."""
    terms: list
    file: str
    line: int


class Boundary(NamedTuple):
    """Nodes held in directions first to last, at a value; step: number of the step from 0 on, -1 before all; clears: those of
    earlier steps end here; imaginary: of a harmonic motion; quantity: DISPLACEMENT, VELOCITY or ACCELERATION."""
    nodes: numpy.ndarray
    directions: tuple
    value: float
    step: int
    clears: bool
    imaginary: bool
    quantity: str
    file: str
    line: int


class RuleReader:
    """handlers: {keyword: function of a block}. mesh: the MeshReader; surfaces: Names; steps: the StepReader."""

    def __init__(self, mesh, surfaces, steps, unread):
        self._mesh, self._surfaces, self._steps, self._unread = mesh, surfaces, steps, unread
        self.ties, self.couplings, self.equations, self.boundaries = [], [], [], []
        self._open_coupling, self.transformed = None, {}
        self.handlers = {"TRANSFORM": self._transform, "TIE": self._tie, "COUPLING": self._coupling, "KINEMATIC": self._kinematic,
                         "DISTRIBUTING": self._distributing, "DISTRIBUTINGCOUPLING": self._distributing_coupling,
                         "RIGIDBODY": self._rigid_body, "EQUATION": self._equation, "MPC": self._mpc,
                         "BOUNDARY": self._boundary}

    def _skip(self, block, text):
        self._unread.append((block.file, block.number, f"*{block.key}: {text}"))

    def surface(self, name, block):
        """The full name of a surface that a block calls so."""
        for full in (block.scope.full(name), name.upper()):
            if full in self._surfaces:
                return full
        return None

    def needed_surface(self, name, line, block):
        full = self.surface(name.strip("\"'").strip(), block)
        if full is None:
            line.fail(f"there is no surface {shown(name)}")
        return full

    def nodes(self, text, line, block):
        """Labels of defined nodes."""
        labels = self._mesh.node_sets.chosen(text, line, block.scope)
        missing = labels[~is_in(labels, self._mesh.labels)]
        if missing.size:
            line.fail(f"node {missing[0]} is not defined")
        if not labels.size:
            self._unread.append((line.file, line.number, f"*{block.key}: the set {shown(text)} has no nodes, so that it does nothing"))
        return labels

    def node(self, text, line, block):
        labels = self.nodes(text, line, block)
        if len(labels) != 1:
            line.fail(f"{shown(text)} has {len(labels)} nodes; one is needed")
        return int(labels[0])

    # ---- ties ----

    def _tie(self, block):
        if block.word("TYPE") not in ("", "SURFACETOSURFACE", "NODETOSURFACE"):
            return self._skip(block, f"TYPE={block.get('TYPE')} is not read; the tie is left out")
        tolerance = block.real("POSITIONTOLERANCE", -1.0)
        for line in block.lines:
            if len(line.fields) < 2:
                line.fail("a tie has two surfaces, the slave and the master")
            slave, master = (self.needed_surface(line.field(i), line, block) for i in (0, 1))
            if not self._surfaces[master].faces:
                line.fail(f"the master of a tie, {master}, has no faces; its surface must be of elements")
            self.ties.append(Tie(block.get("NAME"), slave, master, tolerance if tolerance > 0 else None, line.file, line.number))

    # ---- couplings ----

    def _coupling(self, block):
        name = block.needed("SURFACE")
        full = self.surface(name, block)
        nodes = self._surfaces[full].nodes if full else self.nodes(name, block, block)
        self._open_coupling = None
        for parameter in ("INFLUENCERADIUS", "ORIENTATION"):
            if parameter in block:
                self._skip(block, f"{parameter}= is not read; the coupling is left out")
                return
        reference = self.node(block.needed("REFNODE"), block, block)
        kept = nodes != reference
        weights = self._tributary(self._surfaces[full], block)[kept] if full and self._surfaces[full].faces else None
        self._open_coupling = block, reference, nodes[kept], weights

    def _tributary(self, surface, block):
        """The area that each node of a surface stands for: the weights of distributing couplings in both codes."""
        weights = numpy.zeros(len(surface.nodes))
        for face in surface.faces:
            xyz = self._mesh.coordinates[numpy.searchsorted(self._mesh.labels, face)]
            numpy.add.at(weights, numpy.searchsorted(surface.nodes, face), deck_elements.shares(xyz))
        if not weights.min() > 0:
            block.fail(f"node {surface.nodes[weights.argmin()]} of the surface {surface.name} stands for no area: its faces are flat lines")
        return weights

    def _directions(self, block):
        """Directions on data lines: first, last."""
        chosen = set()
        for line in block.lines:
            first = line.integer(0, "a direction")
            last = line.integer(1, "a direction", first)
            if not 1 <= first <= last <= 6:
                line.fail(f"directions {first} to {last}; they run from 1 to 6")
            chosen |= set(range(first, last + 1))
        return tuple(sorted(chosen)) or (1, 2, 3, 4, 5, 6)

    def _kinematic(self, block):
        self._of_coupling(block, "kinematic")

    def _distributing(self, block):
        if block.word("WEIGHTINGMETHOD", "UNIFORM") != "UNIFORM":
            return self._skip(block, f"WEIGHTING METHOD={block.get('WEIGHTINGMETHOD')} is not read; the coupling is left out")
        if block.word("COUPLING", "CONTINUUM") != "CONTINUUM":
            return self._skip(block, "COUPLING=STRUCTURAL is not read; the coupling is left out")
        self._of_coupling(block, "distributing")

    def _of_coupling(self, block, kind):
        if self._open_coupling is None:
            if not self._unread or not self._unread[-1][2].startswith("*COUPLING"):
                block.fail(f"*{block.key} does not stand below *COUPLING")
            return
        of, reference, nodes, weights = self._open_coupling
        self._open_coupling = None
        directions = self._directions(block)
        if not len(nodes):
            of.fail("a coupling has no nodes beside its reference node")
        if kind == "distributing" and not {1, 2, 3} <= set(directions):
            block.fail("a distributing coupling of some directions only; give 1 to 3, or 1 to 6")
        self.couplings.append(Coupling(kind, reference, None, nodes, weights if kind == "distributing" else None, directions,
                                       of.file, of.number))

    def _distributing_coupling(self, block):
        """Below it nodes (or sets) and their weights; the reference is the node of a DCOUP3D element."""
        elements = self._mesh.element_sets.chosen(block.needed("ELSET"), block, block.scope)
        of = [nodes for part, _ in self._mesh.blocks if part.type == "DCOUP3D"
              for label, nodes in zip(part.labels, part.connectivity) if label in elements]
        if len(of) != 1:
            block.fail(f"the element set {block.get('ELSET')} has {len(of)} elements DCOUP3D; one is needed, of the reference node")
        nodes, weights = [], []
        for line in block.lines:
            chosen = self.nodes(line.field(0), line, block)
            weight = line.real(1, "the weight", 1.0)
            if weight <= 0:
                line.fail(f"the weight {weight:g}; weights are above 0")
            nodes.append(chosen)
            weights.append(numpy.full(len(chosen), weight))
        if not nodes or not len(numpy.concatenate(nodes)):
            block.fail("a distributing coupling without nodes")
        nodes, weights = numpy.concatenate(nodes), numpy.concatenate(weights)
        if len(numpy.unique(nodes)) < len(nodes):
            block.fail("a node comes twice in a distributing coupling; give it once, with the sum of its weights")
        self.couplings.append(Coupling("distributing", int(of[0][0]), None, nodes, weights, (1, 2, 3), block.file, block.number))

    def _rigid_body(self, block):
        reference = self.node(block.needed("REFNODE"), block, block)
        rotation = self.node(block.get("ROTNODE"), block, block) if block.get("ROTNODE") else None
        nodes, directions = [], (1, 2, 3, 4, 5, 6)
        for parameter in ("NSET", "TIENSET", "PINNSET"):
            if block.get(parameter):
                nodes.append(self.nodes(block.get(parameter), block, block))
        if block.get("ELSET"):
            nodes.append(self._mesh.nodes_of(self._mesh.element_sets.chosen(block.get("ELSET"), block, block.scope)))
        if block.get("PINNSET"):
            directions = (1, 2, 3)
            if len(nodes) > 1:
                block.fail("PIN NSET= together with other sets; give two rigid bodies of one reference node")
        nodes = numpy.unique(numpy.concatenate(nodes)) if nodes else numpy.empty(0, dtype=numpy.int64)
        nodes = nodes[~numpy.isin(nodes, [reference] if rotation is None else [reference, rotation])]
        if not len(nodes):
            block.fail("a rigid body without nodes; NSET=, ELSET=, TIE NSET= or PIN NSET= gives them")
        self.couplings.append(Coupling("rigid", reference, rotation, nodes, None, directions, block.file, block.number))

    # ---- equations ----

    def _equation(self, block):
        lines = list(block.lines)
        while lines:
            first = lines.pop(0)
            n = first.integer(0, "the number of terms")
            if not 1 <= n <= 10**7:
                first.fail(f"an equation of {n} terms")
            fields, last = [], first
            while len(fields) < 3 * n:
                if not lines:
                    first.fail(f"an equation of {n} terms has {len(fields) // 3} before its block ends")
                last = lines.pop(0)
                if len(last.fields) % 3:
                    last.fail(f"{len(last.fields)} fields; terms are node, direction, coefficient")
                fields += [(last, i) for i in range(len(last.fields))]
            if len(fields) > 3 * n:
                last.fail(f"{len(fields) // 3} terms, where {n} were announced on line {first.number}")
            self._one_equation(block, first, fields)

    def _one_equation(self, block, first, fields):
        terms = []
        for k in range(0, len(fields), 3):
            line, i = fields[k]
            direction = line.integer(i + 1, "a direction")
            if not 1 <= direction <= 6:
                line.fail(f"direction {direction}; they run from 1 to 6")
            terms.append((self.nodes(line.field(i), line, block), direction, line.real(i + 2, "a coefficient")))
        length = max(len(nodes) for nodes, _, _ in terms)
        if any(len(nodes) not in (1, length) for nodes, _, _ in terms):
            first.fail("the sets of an equation differ in their number of nodes")
        for i in range(length):
            self.equations.append(Equation([(int(nodes[i if len(nodes) > 1 else 0]), direction, coefficient)
                                            for nodes, direction, coefficient in terms], first.file, first.number))

    def _mpc(self, block):
        for line in block.lines:
            kind = line.field(0).upper()
            if kind not in ("BEAM", "TIE", "PIN"):
                self._unread.append((line.file, line.number, f"*MPC {shown(kind)}: BEAM, TIE and PIN are read; left out"))
                continue
            if len(line.fields) != 3:
                line.fail(f"*MPC {kind} takes two nodes, the dependent one and the one it follows")
            nodes, reference = self.nodes(line.field(1), line, block), self.node(line.field(2), line, block)
            if reference in nodes:
                line.fail(f"node {reference} follows itself")
            if kind == "BEAM":
                self.couplings.append(Coupling("rigid", reference, None, nodes, None, (1, 2, 3, 4, 5, 6), line.file, line.number))
                continue
            for node in nodes:
                for direction in range(1, 4 if kind == "PIN" else 7):
                    self.equations.append(Equation([(int(node), direction, 1.0), (reference, direction, -1.0)],
                                                   line.file, line.number))

    # ---- supports ----

    def _transform(self, block):
        """Axes of nodes of their own: kept, to refuse what would count in them."""
        for node in self.nodes(block.needed("NSET"), block, block).tolist():
            self.transformed[node] = block

    def check_transformed(self, loads):
        """Directions in axes of a node's own are not followed, and must not be taken for those of the whole."""
        for record in (*self.boundaries, *loads, *self.equations):
            nodes = [node for node, _, _ in record.terms] if isinstance(record, Equation) else getattr(record, "nodes", ())
            for node in nodes:
                if int(node) in self.transformed:
                    where = self.transformed[int(node)]
                    raise FileError(record.file, record.line, f"node {node} has axes of its own (*TRANSFORM on line {where.number}), in "
                                    "which this would count; they are not read, write it in the axes of the whole as *EQUATION")

    def _boundary(self, block):
        clears = block.word("OP", "MOD") == "NEW"
        imaginary = block.word("LOADCASE") == "2" or "IMAGINARY" in block
        quantity = block.word("TYPE", "DISPLACEMENT")
        if quantity not in ("DISPLACEMENT", "VELOCITY", "ACCELERATION"):
            block.fail(f"TYPE={block.get('TYPE')} is not known; DISPLACEMENT, VELOCITY or ACCELERATION")
        if "AMPLITUDE" in block:
            self._skip(block, "AMPLITUDE= is not followed; the full value counts")
        for line in block.lines:
            word = line.field(1).upper()
            if word in SYMMETRIES:
                directions, value = SYMMETRIES[word], 0.0
            elif whole(word) is None:
                line.fail(f"{shown(line.field(1))} is no direction and no known kind of support ({', '.join(SYMMETRIES)})")
            else:
                first = line.integer(1, "a direction")
                last = line.integer(2, "a direction", first)
                if not 1 <= first <= last <= 6:
                    self._unread.append((line.file, line.number, f"*BOUNDARY of directions {first} to {last}: 1 to 6 are read"))
                    continue
                directions, value = tuple(range(first, last + 1)), line.real(3, "the value", 0.0)
            nodes = self.nodes(line.field(0), line, block)
            self.boundaries.append(Boundary(nodes, directions, value, self._steps.number, clears, imaginary, quantity,
                                            line.file, line.number))
