"""Matrix Market, one file for each matrix; the list of DOFs beside them or handed over."""
import os

import numpy
import scipy.io
import scipy.sparse

from ..assembly import symmetric
from ..errors import FileError
from ..tables import read_table, text_lines
from . import companions, dof_list
from .found import refuse

NAME = "market"


def matches(path, head):
    return head[:14].lower() == b"%%matrixmarket"


def read(path, request, found):
    paths = companions.chosen(path, request, companions.by_name(path))
    for kind, file in paths.items():
        found.add(kind, read_one(file, found.notes), None, file)
    read_companion_dofs(paths, request, found)


def read_companion_dofs(paths, request, found):
    """The list of DOFs of files that name none, where one lies beside the stiffness matrix."""
    listed = companions.dof_list(paths["stiffness"])
    if request.dofs is None and listed:
        dofs, notes = dof_list.read_dof_list(listed)
        n = found.matrices["stiffness"].shape[0]
        if len(dofs) != n:
            raise FileError(listed, 0, f"lists {len(dofs)} DOFs for a matrix of {n} rows")
        found.keys = {kind: None for kind in found.keys}
        found.listed = dofs
        found.notes += notes
        found.read_from(listed)


def read_one(path, notes):
    """The whole matrix of one file. SciPy reads the header and dense files; entries are read as columns, which is faster."""
    rows, columns, layout, field, symmetry = header(path)
    if field not in ("real", "integer", "double", "complex") or symmetry not in ("general", "symmetric"):
        raise FileError(path, 1, f"a {field} {symmetry} matrix; real (or complex) symmetric or general ones are read")
    if rows != columns:
        raise FileError(path, 1, f"{rows} rows but {columns} columns; the matrices of a structure are square")
    if layout == "array":
        return dense(path, symmetry)
    first, claimed = size_line(path)
    return entries(path, rows, claimed, first, field == "complex", symmetry, notes)


def header(path):
    try:
        rows, columns, _, layout, field, symmetry = scipy.io.mminfo(path)
    except Exception as error:  # SciPy's reader raises whatever its parsing meets
        raise FileError(path, 1, f"no header of Matrix Market: {error}") from None
    if not 0 < rows <= 16 * os.path.getsize(path) or columns < 1:
        raise FileError(path, 1, f"a matrix of {rows} x {columns} does not fit into a file of {os.path.getsize(path)} bytes")
    return rows, columns, layout, field, symmetry


def size_line(path):
    """(the line of the sizes, number of entries they claim)."""
    with open(path, encoding="latin-1") as file:
        for number, line in enumerate(file, 1):
            words = line.split()
            if words and not line.startswith("%"):
                return number, int(words[2])
    raise FileError(path, 0, "the line of the sizes is missing")


def entries(path, n, claimed, first, is_complex, symmetry, notes):
    """Rows, columns and values as three (four) columns of text."""
    table = read_table(path, "iiff" if is_complex else "iif", first=first)
    if len(table) != claimed:
        raise FileError(path, first, f"{claimed} entries are announced, {len(table)} are there")
    i, j = table.columns[:2]
    table.check((i >= 1) & (i <= n), lambda k: f"row {i[k]} of a matrix of {n} rows")
    table.check((j >= 1) & (j <= n), lambda k: f"column {j[k]} of a matrix of {n} rows")
    values = table.columns[2] + 1j * table.columns[3] if is_complex else table.columns[2]
    fail = lambda k, text: table.fail(k, text) if k is not None else refuse(path)(k, text)
    return symmetric(n, i - 1, j - 1, values, fail, notes, whole=symmetry == "general")


def dense(path, symmetry):
    lines = text_lines(path)
    try:
        matrix = numpy.asarray(scipy.io.mmread(path))
    except Exception as error:
        raise FileError(path, len(lines), f"the dense matrix cannot be read: {error}") from None
    if not numpy.isfinite(matrix).all():
        raise FileError(path, 0, "a value that is no finite number")
    i, j = numpy.nonzero(matrix)
    return symmetric(len(matrix), i, j, matrix[i, j], refuse(path), whole=True)


def write(path, matrices):
    """stem_K.mtx, stem_M.mtx, ... with 17 digits, and stem.dof. path: stem, stem.mtx or stem_K.mtx."""
    stem = os.path.splitext(os.fspath(path))[0]
    stem = stem[:-2] if stem.endswith("_K") else stem
    written = []
    for letter, matrix in matrices.by_letter():
        written.append(f"{stem}_{letter}.mtx")
        scipy.io.mmwrite(written[-1], scipy.sparse.tril(matrix, format="coo"), symmetry="symmetric", precision=17)
    written.append(stem + ".dof")
    dof_list.write_dof_list(written[-1], matrices.dofs)
    return written
