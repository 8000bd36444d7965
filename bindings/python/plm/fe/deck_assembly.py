"""Parts, instances and assemblies of Abaqus laid flat: every block gets the scope in which its labels and names count."""
import copy

import numpy

from .deck_lines import whole
from .errors import FileError

DEFINES_LABELS = ("NODE", "ELEMENT")


class Scope:
    """Where labels and names of a block count.

    name    of the instance in upper case, "" for the deck itself or its assembly
    shift   what is added to labels of nodes and elements, so that no two are alike
    place   None, or how an instance stands: x -> rotation @ x + translation, as (rotation, translation)
    """

    def __init__(self, name="", place=None):
        self.name, self.shift, self.place, self.instances = name, 0, place, {}

    def full(self, name):
        """The name by which the deck knows what this scope calls so."""
        return f"{self.name}.{name.upper()}" if self.name else name.upper()

    @property
    def is_turned(self):
        """Whether the instance stands otherwise than its part."""
        return self.place is not None and not numpy.array_equal(self.place[0], numpy.eye(3))

    def put(self, xyz):
        """Coordinates (n x 3) where the instance stands."""
        return xyz if self.place is None else xyz @ self.place[0].T + self.place[1]


def flatten(blocks):
    """(blocks in one flat list, the scope of the deck itself, notes on labels that were shifted)."""
    top = Scope()
    parts, flat, inside = {}, [], None
    for block in blocks:
        inside = _sort(block, parts, flat, inside, top)
    if inside is not None:
        inside.block.fail(f"*{inside.block.key} is never ended; *END {inside.block.key} is missing")
    return flat, top, _shift_labels(flat, top)


class _Inside:
    """What is open: a part (its blocks are kept) or an instance (its blocks are laid down in its scope)."""

    def __init__(self, block, blocks, scope=None):
        self.block, self.blocks, self.scope = block, blocks, scope


def _sort(block, parts, flat, inside, top):
    """Lays one block down, or keeps it with its part. Returns what is open behind it."""
    if block.key == "PART":
        if inside:
            block.fail(f"*PART inside of *{inside.block.key} of line {inside.block.number}; parts do not nest")
        name = block.needed("NAME").upper()
        if name in parts:
            block.fail(f"there is another part {name}, on line {parts[name].block.number}")
        parts[name] = _Inside(block, [])
        return parts[name]
    if block.key == "INSTANCE":
        return _begin_instance(block, parts, flat, inside, top)
    if block.key in ("ENDPART", "ENDINSTANCE"):
        if inside is None or "END" + inside.block.key != block.key:
            block.fail(f"*{block.key} without *{block.key[3:]}")
        return None
    if block.key in ("ASSEMBLY", "ENDASSEMBLY"):
        if inside:
            block.fail(f"*{block.key} inside of *{inside.block.key} of line {inside.block.number}, which is not ended")
        return None
    if inside and inside.scope is None:
        inside.blocks.append(block)
        return inside
    block.scope = inside.scope if inside else top
    flat.append(block)
    return inside


def _begin_instance(block, parts, flat, inside, top):
    if inside:
        block.fail(f"*INSTANCE inside of *{inside.block.key} of line {inside.block.number}, which is not ended")
    name, part = block.needed("NAME").upper(), block.needed("PART").upper()
    if part not in parts:
        block.fail(f"there is no part {part} above" + (f"; there are {', '.join(sorted(parts)[:8])}" if parts else ""))
    if name in top.instances:
        block.fail(f"there is another instance {name}")
    scope = top.instances[name] = Scope(name, _placement(block))
    for of_part in parts[part].blocks:
        laid = copy.copy(of_part)
        laid.scope = scope
        flat.append(laid)
    return _Inside(block, [], scope)


def _placement(block):
    """Where the data lines of *INSTANCE put it: a translation, then a turn about a line (two points, degrees)."""
    if not block.lines:
        return None
    if len(block.lines) > 2:
        block.lines[2].fail("an instance has at most two lines, a translation and a rotation")
    translation = numpy.array([block.lines[0].real(i, "a translation", 0.0) for i in range(3)])
    if len(block.lines) == 1:
        return numpy.eye(3), translation
    line = block.lines[1]
    a, b = (numpy.array([line.real(i + k, "a point of the axis") for i in range(3)]) for k in (0, 3))
    length = numpy.linalg.norm(b - a)
    if not 0 < length < numpy.inf:
        line.fail("the two points of the axis are the same (or too far apart)")
    x, y, z = axis = (b - a) / length
    angle = numpy.radians(line.real(6, "the angle"))
    cross = numpy.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    rotation = numpy.cos(angle) * numpy.eye(3) + numpy.sin(angle) * cross + (1 - numpy.cos(angle)) * numpy.outer(axis, axis)
    return rotation, a + rotation @ (translation - a)


def _shift_labels(flat, top):
    """Instances number their nodes each from one on: those of the second and further ones are shifted."""
    scopes = list(dict.fromkeys(block.scope for block in flat if block.key in DEFINES_LABELS))
    if len(scopes) < 2:
        return []
    largest = 0
    for block in flat:
        if block.key in DEFINES_LABELS:
            for line in block.lines:
                label = whole(line.text.split(",")[0])
                largest = max(largest, label or 0)
    step = 10 ** len(str(largest))
    if step * len(scopes) > 10**17:
        raise FileError(flat[0].file, 0, f"labels up to {largest} in {len(scopes)} instances do not fit 64 bits")
    scopes.sort(key=lambda scope: scope is top)  # those of the assembly last: instances keep the low numbers
    notes = []
    for i, scope in enumerate(scopes):
        scope.shift = i * step
        if i:
            notes.append(f"labels of nodes and elements of {'instance ' + scope.name if scope.name else 'the assembly'} "
                         f"are those of the deck + {scope.shift}")
    return notes
