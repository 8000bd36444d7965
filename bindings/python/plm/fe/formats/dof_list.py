"""Lists of DOFs, in the order of the rows: node.direction (CalculiX), node and direction, node and components, Ansys mapping."""
import os
import re

import numpy

from ..errors import FileError
from ..tables import text_lines
from ..assembly import LABEL_LIMIT

# Ansys' names. Beyond six they are no displacements; they keep a direction of their own so that rows stay distinct.
ANSYS = {name: k + 1 for k, name in enumerate(
    "UX UY UZ ROTX ROTY ROTZ WARP PRES TEMP VOLT MAG HDSP CURR EMF CONC".split())}


def as_dofs(given):
    """(n, 2) int64 of what the caller hands over: an array, or the path of a list."""
    if isinstance(given, (str, os.PathLike)):
        return read_dof_list(given)[0]
    dofs = numpy.asarray(given)
    if dofs.ndim != 2 or dofs.shape[1] != 2 or not numpy.issubdtype(dofs.dtype, numpy.integer):
        raise ValueError(f"dofs are an array of whole numbers of shape (n, 2), node and direction, not {dofs.dtype} {dofs.shape}")
    return dofs.astype(numpy.int64)


def read_dof_list(path):
    """((n, 2) of node, direction; notes)."""
    rows, numbers, notes = [], [], []
    for number, line in enumerate(text_lines(path), 1):
        words = line.replace(",", " ").split()
        if not words or words[0][0] in "#$%!" or words[0] == "Matrix":
            continue
        rows += one_line(path, number, words, numbers, notes)
    if not rows:
        raise FileError(path, 0, "no DOFs where a list of them was expected")
    dofs = numpy.array(rows, numpy.int64)
    if numbers:  # a mapping names the equation of each line
        order = numpy.array(numbers)
        if len(numbers) != len(rows) or (numpy.sort(order) != numpy.arange(1, len(rows) + 1)).any():
            raise FileError(path, 0, f"the equations are not 1 to {len(rows)}, each once")
        dofs = dofs[numpy.argsort(order)]
    return dofs, notes


def one_line(path, number, words, equations, notes):
    """The DOFs of a line."""
    def whole(word, low, high):
        if not re.fullmatch("[+-]?[0-9]{1,18}", word) or not low <= int(word) <= high:
            raise FileError(path, number, f"{word[:40]!r} where a whole number of {low} .. {high} is expected")
        return int(word)
    if len(words) == 1 and words[0].count(".") == 1:  # 102.3
        node, direction = words[0].split(".")
        return [(whole(node, -LABEL_LIMIT, LABEL_LIMIT), whole(direction, 0, 15))]
    if len(words) == 2:  # 102 3, or 102 123456
        node, components = whole(words[0], -LABEL_LIMIT, LABEL_LIMIT), words[1]
        if len(components) > 1 and set(components) <= set("123456") and len(set(components)) == len(components):
            return [(node, int(c)) for c in sorted(components)]
        return [(node, whole(components, 0, 6))]
    if len(words) == 3 and words[2].isalpha():  # equation, node, UX
        equations.append(whole(words[0], 1, LABEL_LIMIT))
        name = words[2].upper()
        if name not in ANSYS:
            raise FileError(path, number, f"{name[:20]!r} is no name of a DOF that is known: {' '.join(ANSYS)}")
        if ANSYS[name] > 6:
            notes.append(f"{path}:{number}: {name} of node {words[1]} is no displacement; it has direction {ANSYS[name]}")
        return [(whole(words[1], -LABEL_LIMIT, LABEL_LIMIT), ANSYS[name])]
    raise FileError(path, number, f"{' '.join(words)[:60]!r} names no DOF: node.direction, node direction, or equation node UX is "
                    "expected")


def write_dof_list(path, dofs):
    """node.direction, a line each."""
    with open(path, "w", encoding="ascii") as file:
        file.writelines(f"{node}.{direction}\n" for node, direction in dofs.tolist())


def write_mapping(path, dofs):
    """As Ansys writes it; directions 1 .. 15 of nodes."""
    names = {direction: name for name, direction in ANSYS.items()}
    if (dofs[:, 0] < 1).any() or (dofs[:, 1] < 1).any():
        raise ValueError("a mapping file has no place for DOFs without a node; give each of these a node label and a direction")
    with open(path, "w", encoding="ascii") as file:
        file.write("    Matrix Eqn          Node    DOF     \n")
        file.writelines(f"{row:14d}{node:14d}    {names[direction]:<4s}\n" for row, (node, direction) in enumerate(dofs.tolist(), 1))
