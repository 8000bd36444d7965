"""Contact pairs of a deck, and the materials."""
from typing import NamedTuple

from .deck_lines import shown

PASSED_ON = {"ORIENTATION", "SPRING", "MASS", "SOLIDSECTION", "MATERIAL", "ELASTIC", "DENSITY"}  # to CalculiX


class ContactPair(NamedTuple):
    """slave, master: names of surfaces; points: True for surface to surface, False for node to surface; interaction: its name;
    adjust: gaps up to this length close, None: none; clearance: a gap that holds for all pairs, None: that of the mesh."""
    slave: str
    master: str
    points: bool
    interaction: str
    adjust: float
    clearance: float
    file: str
    line: int


class Interaction(NamedTuple):
    """stiffness: of the contact by area (force/length^3), None where the deck gives none that is linear."""
    name: str
    stiffness: float
    file: str
    line: int


class Material(NamedTuple):
    """density (None: not given), elastic: (Young's modulus, Poisson's number) of an isotropic one, else None."""
    name: str
    density: float
    elastic: tuple


class ContactReader:
    """handlers: {keyword: function of a block}. rules: the RuleReader, which knows surfaces by name."""

    def __init__(self, rules, unread):
        self._rules, self._unread = rules, unread
        self.pairs, self.interactions, self.clearances, self._interaction = [], {}, [], None
        self.handlers = {"CONTACTPAIR": self._pair, "SURFACEINTERACTION": self._begin, "SURFACEBEHAVIOR": self._behaviour,
                         "CLEARANCE": self._clearance}

    def _skip(self, at, text):
        self._unread.append((at.file, at.number, text))

    def _begin(self, block):
        name = block.needed("NAME").upper()
        self._interaction = name
        self.interactions[name] = Interaction(name, None, block.file, block.number)

    def _behaviour(self, block):
        if self._interaction is None:
            block.fail("*SURFACE BEHAVIOR does not stand below *SURFACE INTERACTION")
        kind, stiffness = block.word("PRESSURE-OVERCLOSURE", "HARD"), None
        if kind == "LINEAR":
            if not block.lines:
                block.fail("*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR without its line (the stiffness by area)")
            stiffness = block.lines[0].real(0, "the stiffness")
            if stiffness <= 0:
                block.lines[0].fail(f"the stiffness {stiffness:g}; it must be above 0")
        elif kind != "HARD":
            self._skip(block, f"*SURFACE BEHAVIOR of kind {kind}: LINEAR and HARD are read; the library chooses the stiffness")
        self.interactions[self._interaction] = Interaction(self._interaction, stiffness, block.file, block.number)

    def _pair(self, block):
        kind = block.word("TYPE", "NODETOSURFACE")
        if kind not in ("NODETOSURFACE", "SURFACETOSURFACE"):
            self._skip(block, f"*CONTACT PAIR, TYPE={kind}: taken as SURFACE TO SURFACE")
            kind = "SURFACETOSURFACE"
        interaction = block.get("INTERACTION").upper()
        if interaction and interaction not in self.interactions:
            block.fail(f"there is no *SURFACE INTERACTION {shown(interaction)}")
        adjust = None
        if block.get("ADJUST"):
            if self._rules._mesh.node_sets.find(block.get("ADJUST"), block.scope):
                self._skip(block, "*CONTACT PAIR, ADJUST= to a node set: a length is read; gaps are those of the mesh")
            else:
                adjust = block.real("ADJUST", 0.0)
                if adjust < 0:
                    block.fail("ADJUST= is below 0")
        if not block.lines:
            block.fail("*CONTACT PAIR without surfaces")
        for line in block.lines:
            if len(line.fields) != 2:
                line.fail("a contact pair has two surfaces, the slave and the master")
            slave, master = (self._rules.needed_surface(line.field(i), line, block) for i in (0, 1))
            if not self._rules._surfaces[master].faces:
                line.fail(f"the master {master} has no faces; its surface must be of elements")
            self.pairs.append(ContactPair(slave, master, kind == "SURFACETOSURFACE" and bool(self._rules._surfaces[slave].faces),
                                          interaction, adjust, None, line.file, line.number))

    def _clearance(self, block):
        if not (block.get("MASTER") and block.get("SLAVE") and block.get("VALUE")):
            return self._skip(block, "*CLEARANCE without MASTER=, SLAVE= and VALUE=: left out, gaps are those of the mesh")
        slave, master = (self._rules.needed_surface(block.get(name), block, block) for name in ("SLAVE", "MASTER"))
        self.clearances.append((slave, master, block.real("VALUE", 0.0), block))

    def finish(self):
        """Clearances go to their pairs, which may stand before or after them."""
        for slave, master, value, block in self.clearances:
            at = [i for i, pair in enumerate(self.pairs) if (pair.slave, pair.master) == (slave, master)]
            if not at:
                block.fail(f"there is no contact pair of {slave} and {master}")
            self.pairs[at[0]] = self.pairs[at[0]]._replace(clearance=value)


class MaterialReader:
    """handlers: {keyword: function of a block}. property_blocks: what CalculiX needs to make the matrices."""

    def __init__(self, unread):
        self._unread = unread
        self.materials, self.damping, self.property_blocks, self._open = {}, {}, [], None
        self._last_damping = None
        self.handlers = {"MATERIAL": self._material, "ELASTIC": self._elastic, "DENSITY": self._density, "DAMPING": self._damping}
        self.handlers.update({key: self.property_blocks.append for key in PASSED_ON - set(self.handlers)})

    def _material(self, block):
        self._open = block.needed("NAME").upper()
        self.materials[self._open] = Material(self._open, None, None)
        self.property_blocks.append(block)

    def _of_material(self, block):
        if self._open is None:
            block.fail(f"*{block.key} does not stand below *MATERIAL")
        if not block.lines and block.key != "DAMPING":
            block.fail(f"*{block.key} without numbers")
        if block.key != "DAMPING":
            self.property_blocks.append(block)
        return self.materials[self._open]

    def _elastic(self, block):
        material = self._of_material(block)
        if block.word("TYPE", "ISO") in ("ISO", "ISOTROPIC"):
            line = block.lines[0]
            elastic = line.real(0, "Young's modulus"), line.real(1, "Poisson's number", 0.0)
            if elastic[0] <= 0 or not -1 < elastic[1] < 0.5:
                line.fail(f"Young's modulus {elastic[0]:g} and Poisson's number {elastic[1]:g}: no solid is so")
            self.materials[self._open] = material._replace(elastic=elastic)

    def _density(self, block):
        material = self._of_material(block)
        density = block.lines[0].real(0, "the density")
        if density < 0:
            block.lines[0].fail(f"the density {density:g}; it cannot be below 0")
        self.materials[self._open] = material._replace(density=density)

    def _damping(self, block):
        self._of_material(block)
        if "STRUCTURAL" in block or "COMPOSITE" in block:
            self._unread.append((block.file, block.number, "*DAMPING: ALPHA and BETA are read, the others are left out"))
        self._last_damping = block
        self.damping[self._open] = block.real("ALPHA", 0.0), block.real("BETA", 0.0)
        if min(self.damping[self._open]) < 0:
            block.fail("a damping below 0")

    def rayleigh(self):
        """(alpha, beta) of all materials; None where there is none, or where they differ."""
        given = {self.damping.get(name, (0.0, 0.0)) for name in self.materials}
        if len(given) != 1:
            if given:
                block = self._last_damping
                self._unread.append((block.file, block.number, "*DAMPING differs between the materials; it is left out, set it on the model"))
            return None
        alpha, beta = given.pop()
        return (alpha, beta) if alpha or beta else None


