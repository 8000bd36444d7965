"""Steps of a deck and what acts in them: forces, pressures, weight."""
from typing import NamedTuple

import numpy

from . import deck_elements
from .deck_lines import shown

PROCEDURES = {"STATIC", "STEADYSTATEDYNAMICS", "FREQUENCY", "DYNAMIC", "MODALDYNAMIC", "BUCKLE", "COMPLEXFREQUENCY", "VISCO",
              "HEATTRANSFER", "MATRIXGENERATE", "SUBSTRUCTUREGENERATE", "COUPLEDTEMPERATURE-DISPLACEMENT"}


class Load(NamedTuple):
    """A force or moment on each of the nodes; step: number from 0; clears: loads of earlier steps end; imaginary: the part
    that runs a quarter of a period ahead."""
    nodes: numpy.ndarray
    direction: int
    value: float
    step: int
    clears: bool
    imaginary: bool
    file: str
    line: int


class Pressure(NamedTuple):
    """A pressure on faces (arrays of node labels, normals out of what is pressed); else as Load."""
    faces: list
    value: float
    step: int
    clears: bool
    imaginary: bool
    file: str
    line: int


class Gravity(NamedTuple):
    """An acceleration (3) of all that has mass; else as Load."""
    acceleration: numpy.ndarray
    step: int
    clears: bool
    imaginary: bool
    file: str
    line: int


class StepReader:
    """handlers: {keyword: function of a block}. number: the step that is open, from 0; -1 before the first."""

    def __init__(self, mesh, faces, unread):
        """mesh: the MeshReader; faces: the SurfaceReader."""
        self._mesh, self._faces, self._unread = mesh, faces, unread
        self.names, self.procedures, self.loads, self.number, self._open = [], [], [], -1, None
        self.modal_damping = None  # (step, ratio) or (step, alpha, beta)
        self.rules = None  # set by the deck's reader: it knows nodes and surfaces by name
        self.handlers = {"STEP": self._step, "ENDSTEP": self._end, "CLOAD": self._cload, "DLOAD": self._dload,
                         "DSLOAD": self._dsload, "MODALDAMPING": self._damping}
        self.handlers.update({key: self._procedure for key in PROCEDURES})

    def _step(self, block):
        if self._open:
            block.fail(f"*STEP before the step of line {self._open.number} has ended; *END STEP is missing")
        self._open, self.number = block, self.number + 1
        name = block.get("NAME") or f"STEP-{self.number + 1}"
        self.names.append(name)
        self.procedures.append("")

    def _end(self, block):
        if not self._open:
            block.fail("*END STEP without *STEP")
        self._open = None

    def finish(self):
        if self._open:
            self._open.fail("this step is never ended; *END STEP is missing")

    def _procedure(self, block):
        if not self._open:
            block.fail(f"*{block.key} outside of a step")
        if self.procedures[-1] and block.key != "MATRIXGENERATE":
            block.fail(f"*{block.key} in a step that is of *{self.procedures[-1]} already")
        self.procedures[-1] = block.key
        if "PERTURBATION" in self._open and block.key == "STATIC":
            self.procedures[-1] = "STATIC, PERTURBATION"
            self._unread.append((block.file, block.number, "*STATIC as a perturbation: its loads are no pre-load; left out"))
        elif block.key not in ("STATIC", "STEADYSTATEDYNAMICS", "FREQUENCY", "MATRIXGENERATE"):
            self._unread.append((block.file, block.number, f"*{block.key}: loads of such a step are not taken"))

    def _flags(self, block):
        """(step, clears, imaginary) of a block of loads."""
        if not self._open:
            block.fail(f"*{block.key} outside of a step")
        if "AMPLITUDE" in block:
            self._unread.append((block.file, block.number, f"*{block.key}: AMPLITUDE={block.get('AMPLITUDE')} is not followed; "
                                 "the full value counts"))
        return self.number, block.word("OP", "MOD") == "NEW", block.word("LOADCASE") == "2" or "IMAGINARY" in block

    def _cload(self, block):
        step, clears, imaginary = self._flags(block)
        for parameter in ("FOLLOWER", "SECTOR", "SUBMODEL", "USER", "OMEGA0"):
            if parameter in block:
                block.fail(f"*CLOAD, {parameter} is not read; give plain forces")
        for line in block.lines:
            direction = line.integer(1, "a direction")
            if not 1 <= direction <= 6:
                self._unread.append((line.file, line.number, f"*CLOAD in direction {direction}: 1 to 6 are read; left out"))
                continue
            self.loads.append(Load(self.rules.nodes(line.field(0), line, block), direction, line.real(2, "the force"),
                                   step, clears, imaginary, line.file, line.number))

    def _dload(self, block):
        flags = self._flags(block)
        for line in block.lines:
            label = line.field(1).upper()
            if label == "GRAV":
                self._gravity(block, line, flags)
            elif label[:1] == "P" and (label[1:].isdigit() or label == "P"):
                elements = self._mesh.element_sets.chosen(line.field(0), line, block.scope)
                if not elements.size:
                    self._unread.append((line.file, line.number, f"*DLOAD: the set {shown(line.field(0))} has no elements, so that it does "
                                         "nothing"))
                faces = [face for element in elements for face in self._pressed(element, label, line)]
                self.loads.append(Pressure(faces, line.real(2, "the pressure"), *flags, line.file, line.number))
            else:
                self._unread.append((line.file, line.number, f"*DLOAD of kind {shown(label)}: P, P1 to P6 and GRAV are read; left out"))

    def _pressed(self, label, name, line):
        found = self._faces.element(label)
        if found is None:
            line.fail(f"there is no element {label}")
        kind, nodes = found
        sides = deck_elements.faces_of(kind)
        # a pressure on a shell acts along its normal, hence on its back
        side = "SNEG" if deck_elements.is_sheet(kind) and name in ("P", "P1") else "S" + name[1:]
        if side not in sides:
            line.fail(f"{kind} has no face for the pressure {name}")
        return [nodes[list(sides[side])]]

    def _gravity(self, block, line, flags):
        elements = self._mesh.element_sets.chosen(line.field(0), line, block.scope) if line.field(0) else None
        for part, _ in self._mesh.blocks:
            if elements is not None and deck_elements.faces_of(part.type) and not numpy.all(numpy.isin(part.labels, elements)):
                self._unread.append((line.file, line.number, "*DLOAD, GRAV on a part of the elements: it is read for all; left out"))
                return
        direction = numpy.array([line.real(i, "the direction", 0.0) for i in (3, 4, 5)])
        length = numpy.linalg.norm(direction)
        if not length > 0:
            line.fail("weight without a direction")
        self.loads.append(Gravity(line.real(2, "the acceleration") / length * direction, *flags, line.file, line.number))

    def _dsload(self, block):
        flags = self._flags(block)
        for line in block.lines:
            if line.field(1).upper() != "P":
                self._unread.append((line.file, line.number, f"*DSLOAD of kind {shown(line.field(1))}: P is read; left out"))
                continue
            surface = self.rules.needed_surface(line.field(0), line, block)
            self.loads.append(Pressure(self.rules._surfaces[surface].faces, line.real(2, "the pressure"), *flags,
                                       line.file, line.number))

    def _damping(self, block):
        """One ratio for all modes, or Rayleigh's two numbers."""
        if not self._open:
            block.fail("*MODAL DAMPING outside of a step")
        if "RAYLEIGH" in block and len(block.lines) == 1:
            line = block.lines[0]
            at = 2 if len(line.fields) > 2 else 0  # Abaqus puts a range of modes before
            self.modal_damping = (line.real(at, "alpha", 0.0), line.real(at + 1, "beta", 0.0))
        elif len(block.lines) == 1 and "STRUCTURAL" not in block and block.lines[0].integer(0, "the first mode", 1) == 1:
            self.modal_damping = (block.lines[0].real(2, "the damping ratio"),)
        else:
            self._unread.append((block.file, block.number, "*MODAL DAMPING of several lines: one ratio for all modes is read"))
            return
        if min(self.modal_damping) < 0 or len(self.modal_damping) == 1 and self.modal_damping[0] >= 1:
            block.fail("a damping below 0, or a ratio of 1 or more")
