"""Rows, columns and values as three columns, counted from 1: CalculiX' .sti .mas .dof, and the coordinate form of Abaqus."""
import os

import numpy

from ..assembly import symmetric
from ..errors import FileError
from ..tables import read_table
from . import companions, dof_list

NAME = "calculix"


def matches(path, head):
    suffix = os.path.splitext(os.fspath(path))[1].lower()
    return suffix in (".sti", ".mas", ".dof")


def read(path, request, found):
    """x.sti, x.mas, x.dof of *FREQUENCY, SOLVER=MATRIXSTORAGE. path: any of the three."""
    folder, name = os.path.split(os.fspath(path))
    stem, files = os.path.splitext(name)[0], companions.beside(folder)
    guess = {kind: os.path.join(folder, files[key]) for kind, key in
             (("stiffness", f"{stem}.sti".lower()), ("mass", f"{stem}.mas".lower())) if key in files}
    paths = companions.chosen(path, request, guess)
    listed = files.get(f"{stem}.dof".lower())
    dofs = request.dofs
    if dofs is None and listed:
        dofs, notes = dof_list.read_dof_list(os.path.join(folder, listed))
        found.notes += notes
        found.read_from(os.path.join(folder, listed))
    if dofs is None:
        raise FileError(paths["stiffness"], 0, f"{stem}.dof, which lists the DOFs, is not beside it; hand them over by dofs=")
    for kind, file in paths.items():
        found.add(kind, read_one(file, found.notes, len(dofs)), dofs, file)


def read_one(path, notes, n=None, first=0, separators="", comments=None):
    """The whole matrix; n: its rows, None: the largest number that occurs."""
    table = read_table(path, "iif", first, separators, comments)
    i, j, values = table.columns
    top = int(max(i.max(), j.max()))
    if n is None:
        n = top
        if n > 64 + 16 * len(i):
            table.fail(int(numpy.argmax(numpy.maximum(i, j))), f"row or column {n} in a file of {len(i)} entries")
    for number, what in ((i, "row"), (j, "column")):
        table.check((number >= 1) & (number <= n), lambda k: f"{what} {number[k]} of a matrix of {n} rows")
    return symmetric(n, i - 1, j - 1, values, table.fail, notes)


def write(path, matrices):
    """x.sti, x.mas, x.dof: the upper triangle by columns, as CalculiX writes them but with 17 digits."""
    stem = os.path.splitext(os.fspath(path))[0]
    if matrices.damping is not None:
        raise ValueError("CalculiX' .sti .mas .dof have no place for a damping matrix")
    for suffix, matrix in ((".sti", matrices.stiffness), (".mas", matrices.mass)):
        write_one(stem + suffix, matrix)
    dof_list.write_dof_list(stem + ".dof", matrices.dofs)
    return [stem + suffix for suffix in (".sti", ".mas", ".dof")]


def write_one(path, matrix):
    lower = matrix.tocsr().tocoo()  # row-wise: the lower triangle by rows is the upper by columns
    keep = lower.row >= lower.col
    numpy.savetxt(path, numpy.rec.fromarrays([lower.col[keep] + 1, lower.row[keep] + 1, lower.data[keep]]), fmt="%d %d %24.16e")
