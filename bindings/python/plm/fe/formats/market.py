"""Matrix Market, one file for each matrix; the list of DOFs beside them or handed over."""
import os

import numpy
import scipy.io
import scipy.sparse

from ..assembly import symmetric
from ..errors import FileError
from ..tables import read_table, shown
from . import companions, dof_list

NAME = "market"


def matches(path, head):
    return head[:14].lower() == b"%%matrixmarket"


def read(path, request, found):
    paths = companions.chosen(path, request, companions.by_name(path))
    for kind, file in paths.items():
        found.add(kind, read_one(file, found.notes), None, file)
    companions.read_dofs_beside(paths["stiffness"], request, found)


def read_one(path, notes):
    """The whole matrix of one file. SciPy's reader (1.10) takes twice the time, and does not return from a file that ends within
    its header; it is used to write."""
    layout, is_complex, symmetry, sizes, first = header(path)
    n, columns = sizes[:2]
    if n != columns:
        raise FileError(path, first, f"{n} rows but {columns} columns; the matrices of a structure are square")
    if not 0 < n <= 64 + 16 * os.path.getsize(path):
        raise FileError(path, first, f"a matrix of {n} x {n} does not fit into a file of {os.path.getsize(path)} bytes")
    if layout == "array":
        return dense(path, n, first, is_complex, symmetry, notes)
    return entries(path, n, sizes[2], first, is_complex, symmetry, notes)


def header(path):
    """(layout, is complex, symmetry, sizes, lines before the numbers)."""
    with open(path, encoding="latin-1") as file:
        words = file.readline().lower().split()
        if len(words) != 5 or words[0] != "%%matrixmarket" or words[1] != "matrix" or words[2] not in ("coordinate", "array"):
            raise FileError(path, 1, "no header of Matrix Market: %%MatrixMarket matrix coordinate real symmetric is one")
        layout, field, symmetry = words[2:]
        if field not in ("real", "double", "integer", "complex") or symmetry not in ("general", "symmetric"):
            raise FileError(path, 1, f"a {field} {symmetry} matrix; real (or complex) symmetric or general ones are read")
        for number, line in enumerate(file, 2):
            words = line.split()
            if words and not words[0].startswith("%"):
                if len(words) != (3 if layout == "coordinate" else 2) or not all(word.isdecimal() and len(word) < 19 for word in words):
                    raise FileError(path, number, f"{shown(words)} where the sizes of the matrix are expected")
                return layout, field == "complex", symmetry, [int(word) for word in words], number
    raise FileError(path, 0, "ends before the sizes of the matrix")


def entries(path, n, claimed, first, is_complex, symmetry, notes):
    """Rows, columns and values as three (four) columns of text."""
    table = read_table(path, "iiff" if is_complex else "iif", first=first)
    if len(table) != claimed:
        raise FileError(path, first, f"{claimed} entries are announced, {len(table)} are there")
    i, j = table.columns[:2]
    table.check((i >= 1) & (i <= n), lambda k: f"row {i[k]} of a matrix of {n} rows")
    table.check((j >= 1) & (j <= n), lambda k: f"column {j[k]} of a matrix of {n} rows")
    values = table.columns[2] + 1j * table.columns[3] if is_complex else table.columns[2]
    return symmetric(n, i - 1, j - 1, values, table.fail, notes, whole=symmetry == "general")


def dense(path, n, first, is_complex, symmetry, notes):
    """All values down the columns, or those from the diagonal downwards."""
    table = read_table(path, "ff" if is_complex else "f", first=first)
    count = n * n if symmetry == "general" else n * (n + 1) // 2
    if len(table) != count:
        raise FileError(path, first, f"{count} values are announced, {len(table)} are there")
    if symmetry == "general":
        columns, rows = numpy.divmod(numpy.arange(count), n)
    else:
        columns, rows = numpy.triu_indices(n)
    values = table.columns[0] + 1j * table.columns[1] if is_complex else table.columns[0]
    keep = numpy.flatnonzero(values)

    def fail(k, text):
        table.fail(None if k is None else keep[k], text)
    return symmetric(n, rows[keep], columns[keep], values[keep], fail, notes, whole=symmetry == "general")


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
