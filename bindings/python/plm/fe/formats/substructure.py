"""Superelements as Abaqus (and CalculiX) write them: *SUBSTRUCTURE MATRIX OUTPUT, a *USER ELEMENT with its dense matrices.

Nodes with labels below one are modal coordinates.
"""
import os
import re

import numpy
import scipy.sparse

from ..assembly import LABEL_LIMIT, symmetric
from ..errors import FileError
from ..tables import number, text_lines
from .found import refuse

NAME = "abaqus-substructure"
TYPES = {"STIFFNESS": "stiffness", "MASS": "mass", "VISCOUSDAMPING": "damping", "STRUCTURALDAMPING": "structural_damping"}
NAMES = {"stiffness": "STIFFNESS", "mass": "MASS", "damping": "VISCOUS DAMPING", "structural_damping": "STRUCTURAL DAMPING"}


def matches(path, head):
    return all(re.search(pattern, head, re.I | re.M) for pattern in (rb"^\*USER ELEMENT", rb"^\*MATRIX\s*,\s*TYPE\s*="))


def read(path, request, found):
    for kind, file in {"all": path, **request.paths}.items():
        matrices, dofs = read_one(file, found)
        wanted = matrices if kind == "all" else {kind: matrices[kind]} if kind in matrices else {}
        if not wanted:
            raise FileError(file, 0, f"has no {kind} matrix")
        for own, matrix in wanted.items():
            if kind != "all" or own not in request.paths:
                found.add(own, matrix, dofs, file)


def read_one(path, found):
    """({kind: whole matrix}, (n, 2) DOFs)."""
    lines = text_lines(path)
    nodes, changes, matrices, state, dofs, passed = [], [], {}, "", None, []
    for row, line in enumerate(lines, 1):
        text = line.strip()
        upper = text.upper()
        if upper.startswith("*MATRIX"):
            kind = TYPES.get(re.sub(r"\s", "", upper.partition("TYPE=")[2].partition(",")[0]))
            if kind is None or kind in matrices:
                raise FileError(path, row, f"{text[:60]!r}: {'no matrix that is known' if kind is None else 'a second one'}")
            dofs = user_element_dofs(path, row, nodes, changes) if dofs is None else dofs
            matrices[kind], state = [row], kind
        elif upper.startswith("*USER ELEMENT"):
            if state:
                raise FileError(path, row, "a second element; only a file of one superelement is read")
            state = "element"
        elif re.match(r"\*\* *ELEMENT NODES", upper):
            state = "nodes"
        elif state == "nodes" and upper.startswith("**") and (labels := labels_of(text[2:])):
            nodes += labels
        elif (also := re.match(r"\*\* *(SUBSTRUCTURE (LOAD CASE|RECOVERY)) ", upper)):
            if also.group(1) not in passed:
                passed.append(also.group(1))
                found.note(path, row, f"{also.group(1).lower()} vectors were not read")
        elif upper.startswith("*"):
            if not upper.startswith("**"):
                found.note(path, row, f"{text[:60]!r} was not read")
                state = "" if state not in ("", "nodes", "element") else state
        elif text and state in ("nodes", "element"):
            changes.append((row, text))
        elif text and state in matrices:
            matrices[state].append((row, text))
    if dofs is None:
        raise FileError(path, 0, "no *MATRIX, TYPE=STIFFNESS was found")
    return {kind: dense(path, entries, len(dofs), found.notes) for kind, entries in matrices.items()}, dofs


def labels_of(text):
    """The labels of nodes in a line; below one are modal coordinates. None where it is a comment of another kind."""
    words = text.replace(",", " ").split()
    return [int(word) for word in words] if all(re.fullmatch("-?[0-9]{1,15}", word) for word in words) else None


def user_element_dofs(path, line, nodes, changes):
    """(n, 2): the directions of each node; a line names a place among the nodes and what directions it and those after it have."""
    if not nodes or not changes or max(map(abs, nodes)) > LABEL_LIMIT:
        raise FileError(path, line, "the nodes ('** ELEMENT NODES') or their directions are missing before this matrix")
    directions = {}
    for k, (row, text) in enumerate(changes):
        try:
            numbers = [int(word) for word in text.replace(",", " ").split()]
        except ValueError:
            raise FileError(path, row, f"{text[:60]!r} where a place and directions are expected") from None
        place, found = (1, numbers) if k == 0 else (numbers[0], numbers[1:])
        if not 1 <= place <= len(nodes) or not found or not all(0 <= d <= 15 for d in found):
            raise FileError(path, row, f"{text[:60]!r} where one of {len(nodes)} places and directions 1 .. 6 are expected")
        directions[place] = found
    dofs, current = [], []
    for place, node in enumerate(nodes, 1):
        current = directions.get(place, current)
        dofs += [(node, direction) for direction in current]
    return numpy.array(dofs, numpy.int64).reshape(-1, 2)


def dense(path, entries, n, notes):
    """The matrix of a list of its header's line and (line, text): the lower triangle by rows, or all of it by columns."""
    values, lines = [], []
    for row, text in entries[1:]:
        for word in text.replace(",", " ").split():
            try:
                values.append(number(word))
            except ValueError:
                raise FileError(path, row, f"{word[:40]!r} where a number is expected") from None
            lines.append(row)
    values = numpy.array(values)
    if len(values) not in (n * (n + 1) // 2, n * n):
        raise FileError(path, entries[0], f"{len(values)} numbers for a matrix of {n} rows, which has {n * (n + 1) // 2} in its "
                        "triangle")
    if not numpy.isfinite(values).all():
        raise FileError(path, lines[int(numpy.argmin(numpy.isfinite(values)))], "a value that is no finite number")
    if len(values) == n * n and n > 1:
        j, i = numpy.divmod(numpy.arange(n * n), n)
        return symmetric(n, i, j, values, refuse(path), notes, whole=True)
    i, j = numpy.tril_indices(n)
    return symmetric(n, i, j, values, refuse(path), notes)


def write(path, matrices):
    """path (x.mtx): nodes, directions, and the lower triangle of each matrix by rows, 17 digits."""
    path = os.path.splitext(path)[0] + ".mtx"
    dofs, n = matrices.dofs, matrices.n_dof
    with open(path, "w", encoding="ascii") as file:
        file.write(f"**\n** GENERATION OF SUBSTRUCTURE\n*USER ELEMENT,NODES={n:10d},LINEAR\n** ELEMENT NODES\n")
        for k in range(0, n, 10):
            file.write("**" + "".join(f"{node:10d}," for node in dofs[k:k + 10, 0]) + "\n")
        file.write(f"{dofs[0, 1]:10d}\n")
        file.writelines(f"{k + 1:10d},{dofs[k, 1]:10d}\n" for k in range(1, n))
        for kind, matrix in matrices.by_kind():
            file.write(f"*MATRIX,TYPE={NAMES[kind]}\n")
            for k, row in enumerate(scipy.sparse.csr_matrix(matrix).toarray()):
                texts = [f"{value:.16E}," for value in row[:k + 1]]
                file.writelines("".join(texts[m:m + 4]) + "\n" for m in range(0, k + 1, 4))
    return [path]
