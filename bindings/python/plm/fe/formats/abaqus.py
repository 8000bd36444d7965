"""Text matrices of Abaqus' *MATRIX GENERATE: matrix input form (node, direction, node, direction, value) and coordinate form.

Labels below one are internal nodes (Lagrange multipliers, hybrid and contact elements); they stay rows of their own.
"""
import os
import re

import numpy

from ..assembly import LABEL_LIMIT, Places, dofs_of, in_order, key_of, symmetric
from ..errors import FileError
from ..tables import read_table
from . import companions, triplets
from .dof_list import write_dof_list

NAME = "abaqus"
OUTPUT = re.compile(r"^(.*)_(stif|mass|dmpv|dmps)(\d+)$")  # job_STIF2.mtx
KIND = {"stif": "stiffness", "mass": "mass", "dmpv": "damping", "dmps": "structural_damping"}
WORD = {kind: word.upper() for word, kind in KIND.items()}
FIRST_LINE = re.compile(r"^\s*(-?\d+)[\s,]+(\d+)[\s,]+(-?\d+)[\s,]+(\d+)[\s,]+[-+.\dEeDd]+[\s,]*$")
COORDINATES = re.compile(r"^\s*\d+[\s,]+\d+[\s,]+[-+.\dEeDd]+[\s,]*$")


def data_line(head):
    """The first line of numbers, as text."""
    lines = head.decode("latin-1").split("\n")
    return next((line for line in lines if line.strip() and not line.startswith("*")), "")


def matches(path, head):
    line = data_line(head)
    stem, suffix = os.path.splitext(os.path.basename(path).lower())
    return bool(FIRST_LINE.match(line)) or bool(OUTPUT.match(stem)) or (bool(COORDINATES.match(line)) and suffix == ".mtx")


def output_files(path, notes):
    """{kind: path} of a job's matrices. Those of a step go together; the only ones of another step do, too, and it is said."""
    folder, name = os.path.split(os.fspath(path))
    stem, suffix = os.path.splitext(name.lower())
    own = OUTPUT.match(stem)
    if not own:
        return companions.by_name(path)
    found = {}
    files = companions.beside(folder)
    for word, kind in KIND.items():
        steps = {m.group(3): files[file] for file in files if file.endswith(suffix)
                 and (m := OUTPUT.match(os.path.splitext(file)[0])) and m.group(1, 2) == (own.group(1), word)}
        if own.group(2) == word:
            found[kind] = os.fspath(path)
        elif own.group(3) in steps:
            found[kind] = os.path.join(folder, steps[own.group(3)])
        elif len(steps) == 1:
            (step, file), = steps.items()
            found[kind] = os.path.join(folder, file)
            notes.append(f"{found[kind]}: the {kind} matrix was taken from step {step}, {name} is of step {own.group(3)}")
        elif steps:
            raise FileError(path, 0, f"{WORD[kind]} matrices of several steps lie beside it, none of step {own.group(3)}: say "
                            "which to take")
    return found


def read(path, request, found):
    paths = companions.chosen(path, request, output_files(path, found.notes))
    labelled = {kind: labelled_entries(file) for kind, file in paths.items()}
    for kind, file in paths.items():
        if labelled[kind] is None:  # coordinate form: numbers of rows, no labels
            found.add(kind, triplets.read_one(file, found.notes, None, 0, separators_in(file), "*"), None, file)
        else:
            table, rows, columns = labelled[kind]
            keys = in_order(numpy.concatenate([rows, columns]))
            row_of = Places(keys)
            matrix = symmetric(len(keys), row_of(rows), row_of(columns), table.columns[4], table.fail, found.notes)
            found.add(kind, matrix, dofs_of(keys), file)
    if all(entry is None for entry in labelled.values()):
        same_size(found, paths)
        companions.read_dofs_beside(paths["stiffness"], request, found)


def same_size(found, paths):
    """Coordinate form leaves out what is zero, so that a mass matrix may end early: it is made as large as the stiffness matrix."""
    n = found.matrices["stiffness"].shape[0]
    for kind, matrix in found.matrices.items():
        if matrix.shape[0] > n:
            raise FileError(paths[kind], 0, f"has row {matrix.shape[0]}, the stiffness matrix only {n}")
        matrix.resize((n, n))


def first_data_line(path):
    with open(path, "rb") as file:
        return data_line(file.read(1 << 16))


def separators_in(path):
    """What to expect between numbers beside blanks: reading is fastest where the first line tells it."""
    return "," if "," in first_data_line(path) else ""


def labelled_entries(path):
    """(table, key of each row, key of each column), or None for coordinate form."""
    line = first_data_line(path)
    if COORDINATES.match(line):
        return None
    if not FIRST_LINE.match(line):
        raise FileError(path, 1, f"{line.strip()[:60]!r} is neither node, direction, node, direction, value nor row, column, value; "
                        "write the matrices by *MATRIX OUTPUT, FORMAT=MATRIX INPUT")
    table = read_table(path, "iiiif", separators=separators_in(path), comments="*")
    keys = []
    for node, direction in (table.columns[:2], table.columns[2:4]):
        table.check(abs(node) < LABEL_LIMIT, "a node label that is too large")
        table.check((direction >= 0) & (direction <= 15), lambda k: f"direction {direction[k]} where 1 .. 6 is expected")
        keys.append(key_of(node, direction))
    return table, keys[0], keys[1]


def write(path, matrices, coordinate=False):
    """job_STIF1.mtx, job_MASS1.mtx, ... path: job, or any of them. coordinate: row, column, value, and job.dof beside them."""
    stem = os.path.splitext(os.fspath(path))[0]
    output = OUTPUT.match(stem.lower())
    stem = stem[:len(output.group(1))] if output else stem
    written = []
    for kind, matrix in matrices.by_kind():
        written.append(f"{stem}_{WORD[kind]}1.mtx")
        if coordinate:
            triplets.write_one(written[-1], matrix)
        else:
            write_labelled(written[-1], matrix, matrices.dofs)
    if coordinate:
        written.append(stem + ".dof")
        write_dof_list(written[-1], matrices.dofs)
    return written


def write_labelled(path, matrix, dofs):
    entries = matrix.tocoo()
    keep = entries.row >= entries.col
    rows, columns = dofs[entries.row[keep]], dofs[entries.col[keep]]
    numpy.savetxt(path, numpy.rec.fromarrays([rows[:, 0], rows[:, 1], columns[:, 0], columns[:, 1], entries.data[keep]]),
                  fmt="%d,%d, %d,%d, %.16e")
