"""Stiffness and mass of a deck by CalculiX: mesh, materials and sections, and nothing that the library does itself."""
import itertools
import os
import shutil
import subprocess
import tempfile

from . import deck_elements, deck_masses
from .deck_sets import Names
from .errors import FileError

TIME_LIMIT = 3600.0  # s
POINTS = ("SPRING1", "SPRING2", "SPRINGA")  # elements beside solids whose matrices CalculiX writes as they are
SECTIONS = {"SOLIDSECTION": "SOLID SECTION", "SPRING": "SPRING"}
NAME = "matrices"


def matrices_of(deck, folder=None, program="ccx"):
    """plm.fe.matrices.Matrices of the deck. folder: where the files go and stay; None: a temporary one."""
    found = shutil.which(program)
    if found is None:
        raise FileError(deck.path, 0, f"the deck has no matrices, and {program} is not installed to make them (Debian: calculix-ccx); "
                        "hand them over: read_deck(path, matrices), plm ... --matrices FILE")
    lines = derived_lines(deck)
    if folder is None:
        with tempfile.TemporaryDirectory(prefix="plm-") as temporary:
            return _run(deck, temporary, found, lines)
    os.makedirs(folder, exist_ok=True)
    return _run(deck, folder, found, lines)


def _run(deck, folder, program, lines):
    from .matrices import read_matrices
    for ending in (".sti", ".mas", ".dof"):
        if os.path.exists(os.path.join(folder, NAME + ending)):
            os.remove(os.path.join(folder, NAME + ending))
    with open(os.path.join(folder, NAME + ".inp"), "w", encoding="ascii", errors="replace") as file:
        file.write("\n".join(lines) + "\n")
    try:
        done = subprocess.run([program, NAME], cwd=folder, capture_output=True, text=True, errors="replace", timeout=TIME_LIMIT,
                              check=False)
    except subprocess.TimeoutExpired:
        raise FileError(deck.path, 0, f"{program} took more than {TIME_LIMIT:g} s for the matrices") from None
    said = done.stdout + done.stderr
    stiffness = os.path.join(folder, NAME + ".sti")
    wrong = _first_error(said.splitlines())
    if wrong or not os.path.exists(stiffness):
        last = said.strip().splitlines()[-1:] or [f"status {done.returncode}"]
        raise FileError(deck.path, 0, f"{program} made no matrices of this deck: {wrong or last[0]}")
    matrices = read_matrices(stiffness)
    # the file is gone when the note is read
    matrices.notes[:] = [note.replace(stiffness, f"{deck.path}, matrices by CalculiX") for note in matrices.notes]
    return deck_masses.with_point_masses(deck, matrices)


def _first_error(lines):
    """The first error that CalculiX tells, with the lines that go with it: which card, which element. '' without any."""
    at = next((i for i, line in enumerate(lines) if "*ERROR" in line), None)
    if at is None:
        return ""
    with_it = itertools.takewhile(lambda line: line.strip() and "*ERROR" not in line, lines[at + 1:at + 4])
    return " ".join(line.strip() for line in [lines[at], *with_it])


def card_number(value):
    """A number on a card of CalculiX, which reads 20 characters of it: what stands behind them, of 1.2345678901234567e-05 all but the
    first digit of the exponent, would be lost without a word. Twenty hold 14 digits of any number and 17 of most."""
    return next(text for text in (f"{value:.{digits}g}" for digits in range(17, 0, -1)) if len(text) <= 20)


def derived_lines(deck):
    """The lines of the deck that CalculiX gets."""
    groups = _check_elements(deck)
    lines = ["*NODE, NSET=ALLNODES"]
    lines += [f"{n},{card_number(x)},{card_number(y)},{card_number(z)}" for n, (x, y, z) in zip(deck.node_labels.tolist(), deck.coordinates.tolist())]
    for i, block in enumerate(groups):
        lines.append(f"*ELEMENT, TYPE={block.type}, ELSET=BLOCK{i}")
        for label, nodes in zip(block.labels.tolist(), block.connectivity.tolist()):
            row = [label, *nodes]
            lines += [",".join(map(str, row[k:k + 12])) + ("," if k + 12 < len(row) else "") for k in range(0, len(row), 12)]
    lines += _properties(deck)
    return lines + ["*STEP", "*FREQUENCY, SOLVER=MATRIXSTORAGE", "*END STEP"]


def _check_elements(deck):
    """The elements that CalculiX shall have."""
    groups = []
    for block in deck.elements:
        if block.type in ("DCOUP3D", "GAPUNI", deck_masses.ELEMENT):
            continue
        if not (deck_elements.SOLID.match(block.type) and block.type.startswith("C3D")) and block.type not in POINTS:
            raise FileError(deck.path, 0, f"elements of type {block.type}: CalculiX makes solids with nodes of their own of these, and no "
                            "matrices in the deck's own DOFs; hand over matrices from the code that the deck is for")
        groups.append(block)
    if not groups:
        raise FileError(deck.path, 0, "the deck has no elements to make matrices of")
    return groups


class _Short(Names):
    """Names that CalculiX takes as they are: without blanks and quotes, and not longer than it reads."""

    def __init__(self, word):
        super().__init__()
        self.word = word

    def add(self, name):
        """True where the name is new."""
        new = name not in self
        if new:
            self[name.upper()] = f"{self.word}{len(self)}"
        return new


def _properties(deck):
    """Materials and sections as they stand in the deck, under short names."""
    lines, seen = [], set()
    short = {"ELSET": _Short("PART"), "MATERIAL": _Short("MATERIAL"), "ORIENTATION": _Short("AXES")}
    blocks = [block for block in deck.property_blocks if block.key != "MASS"]
    for block in blocks:  # a section may stand before what it names
        if block.key in ("MATERIAL", "ORIENTATION"):
            short[block.key].add(_defined(block))
    for block in blocks:
        if (block.file, block.number) in seen and block.key not in SECTIONS:
            continue
        seen.add((block.file, block.number))
        lines += _section_lines(deck, block, short) if block.key in SECTIONS else [_card(block, short)]
        lines += [line.text for line in block.lines]
    if not short["ELSET"]:
        raise FileError(deck.path, 0, "the deck has no sections (*SOLID SECTION), so CalculiX can make no matrices of it")
    return lines


def _defined(block):
    """The name of a material or of axes, which turn with the instance that they are in."""
    if block.key == "ORIENTATION" and block.scope.is_turned:
        block.fail("*ORIENTATION in an instance that is turned, with which its axes would turn; this is not read, give the axes outside of "
                   "the part, as they stand in the end")
    return block.needed("NAME")


def _card(block, short):
    """A card of a material, of axes or of what a material has."""
    if block.key not in short:
        return block.text
    rest = "".join(f", {key}={value}" if value else f", {key}" for key, value in block.parameters.items() if key != "NAME")
    return f"*{block.key}, NAME={short[block.key][block.needed('NAME')]}{rest}"


def _section_lines(deck, block, short):
    name, lines = deck.section_set(block), []
    if short["ELSET"].add(name):
        lines.append(f"*ELSET, ELSET={short['ELSET'][name]}")
        lines += [f"{label}," for label in deck.element_sets[name].tolist()]
    text = f"*{SECTIONS[block.key]}, ELSET={short['ELSET'][name]}"
    for key in ("MATERIAL", "ORIENTATION"):
        if key in block:
            if block.get(key) not in short[key]:
                block.fail(f"there is no *{key} of the name {block.get(key)}")
            text += f", {key}={short[key][block.get(key)]}"
    return [*lines, text]
