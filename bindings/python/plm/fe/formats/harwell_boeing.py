"""Harwell-Boeing files, with the mapping and the titles of Ansys' HBMAT where they are there."""
import os
import re
from typing import NamedTuple, Optional

import numpy
import scipy.sparse

from ..assembly import symmetric
from ..errors import FileError
from ..tables import fixed_fields, text_lines
from . import companions, dof_list
from .found import refuse

NAME = "harwell-boeing"
FORMAT = re.compile(r"^\s*(?:\d+P\s*,?\s*)?(\d*)\s*([IEDFG])\s*(\d+)(?:\.\d+)?(?:E\d+)?\s*$", re.I)
TYPE = re.compile(r"^[RCP][SUHZR][AE]$", re.I)
TITLES = (("stiffness", re.compile("stiff", re.I)), ("mass", re.compile("mass", re.I)), ("damping", re.compile("damp", re.I)))


class Header(NamedTuple):
    title: str
    kind: str  # RSA, ...
    n: int
    n_entries: int
    formats: list  # (fields on a line, width) of pointers, rows, values, right-hand sides
    lines: list  # lines of each of these
    rhs_type: str
    n_rhs: int
    first: int  # lines before the numbers


def matches(path, head):
    lines = head.decode("latin-1").split("\n")
    return len(lines) > 4 and bool(TYPE.match(lines[2][:3])) and "(" in lines[3]


def read(path, request, found):
    paths = companions.chosen(path, request, by_title(path))
    for kind, file in paths.items():
        matrix, loads = read_one(file, found.notes)
        mapping = mapping_of(file)
        dofs = None
        if mapping and request.dofs is None:
            dofs, notes = dof_list.read_dof_list(mapping)
            found.notes += notes
            if len(dofs) != matrix.shape[0]:
                raise FileError(mapping, 0, f"lists {len(dofs)} DOFs for a matrix of {matrix.shape[0]} rows")
            found.read_from(mapping)
        found.add(kind, matrix, dofs, file)
        if loads is not None and kind == "stiffness":
            found.loads = loads
    if any(keys is not None for keys in found.keys.values()):  # one mapping may serve all, all come from one file of Ansys
        known = next(keys for keys in found.keys.values() if keys is not None)
        found.keys = {kind: known if keys is None else keys for kind, keys in found.keys.items()}
    else:
        companions.read_dofs_beside(paths["stiffness"], request, found)


def mapping_of(path):
    folder, name = os.path.split(os.fspath(path))
    file = companions.beside(folder).get(os.path.splitext(name.lower())[0] + ".mapping")
    return os.path.join(folder, file) if file else None


def title_kind(path):
    with open(path, "rb") as file:
        title = file.readline(200).decode("latin-1")[:72]
    return next((kind for kind, word in TITLES if word.search(title)), None)


def by_title(path):
    """{kind: path} by the titles that Ansys gives its files, among those with the same suffix; else by name."""
    own = title_kind(path)
    if own is None:
        return companions.by_name(path)
    folder, name = os.path.split(os.fspath(path))
    suffix, found = os.path.splitext(name.lower())[1], {own: [os.fspath(path)]}
    for file in companions.beside(folder).values():
        other = os.path.join(folder, file)
        if file == name or os.path.splitext(file.lower())[1] != suffix:
            continue
        with open(other, "rb") as opened:
            kind = title_kind(other) if matches(other, opened.read(1000)) else None
        if kind not in (None, own):
            found.setdefault(kind, []).append(other)
    several = [kind for kind, files in found.items() if len(files) > 1]
    if several:
        named = companions.by_name(path)
        for kind in several:
            if named.get(kind) not in found[kind]:
                raise FileError(path, 0, f"several {kind} matrices lie beside it ({', '.join(found[kind])}): say which to take")
            found[kind] = [named[kind]]
    return {kind: files[0] for kind, files in found.items()}


def read_header(path, lines):
    def whole(line, count):
        words = lines[line].split() if line < len(lines) else []
        try:
            numbers = [int(word) for word in words[-count:]] if line == 2 else [int(word) for word in words[:count]]
            if min(numbers) < 0 or len(numbers) < (4 if line == 1 else count):
                raise ValueError
        except ValueError:
            raise FileError(path, line + 1, f"{' '.join(words)[:60]!r} where {count} whole numbers of the header are "
                            "expected") from None
        return numbers + [0]
    _, n_pointers, n_indices, n_values, n_rhs_lines = whole(1, 5)[:5]
    kind = lines[2][:3].upper() if len(lines) > 2 else ""
    if not TYPE.match(kind):
        raise FileError(path, 3, f"{kind!r} is no type of a Harwell-Boeing matrix, as RSA is")
    n, columns, n_entries, _ = whole(2, 4)[:4]
    if n != columns:
        raise FileError(path, 3, f"{n} rows but {columns} columns; the matrices of a structure are square")
    if kind[0] == "P" or kind[1] not in "SU" or kind[2] != "A":
        raise FileError(path, 3, f"a matrix of type {kind}; assembled real or complex, symmetric or square ones are read (RSA, RUA, "
                        "CSA, CUA)")
    rhs, n_rhs = "", 0
    if n_rhs_lines:
        words = lines[4].split() if len(lines) > 4 else []
        if len(words) < 2 or not words[1].isdecimal():
            raise FileError(path, 5, f"{' '.join(words)[:60]!r} where kind and number of right-hand sides are expected")
        rhs, n_rhs = words[0].upper(), int(words[1])
    return Header(lines[0][:72].strip(), kind, n, n_entries, formats(path, lines[3] if len(lines) > 3 else "", bool(n_rhs_lines)),
                  [n_pointers, n_indices, n_values, n_rhs_lines], rhs, n_rhs, 5 if n_rhs_lines else 4)


def formats(path, line, with_rhs):
    """(fields on a line, width) of each of Fortran's formats."""
    texts = re.findall(r"\(([^()]*)\)", line)
    result = []
    for text in texts:
        match = FORMAT.match(text)
        if not match or not 0 < int(match.group(3)) < 100 or int(match.group(1) or 1) > 1000 or int(match.group(1) or 1) < 1:
            raise FileError(path, 4, f"the format ({text[:30]}) is not understood; (10I8) or (1P,3E25.16) are")
        result.append((int(match.group(1) or 1), int(match.group(3))))
    if len(result) < 3 + with_rhs:
        raise FileError(path, 4, f"{len(result)} formats where {3 + with_rhs} are expected: {line.strip()[:60]!r}")
    return result


def read_one(path, notes):
    """(whole matrix, right-hand sides (n, k) or None)."""
    lines = text_lines(path)
    while lines and not lines[-1].strip():
        lines.pop()
    header = read_header(path, lines)
    at, parts = header.first, []
    factor = 2 if header.kind[0] == "C" else 1
    if header.n < 1 or header.n + 1 > 100 * len(lines) or header.n_entries > 1000 * len(lines):
        raise FileError(path, 3, f"{header.n} rows and {header.n_entries} entries do not fit into {len(lines)} lines")
    for count, kind, (per_line, width), claimed in zip((header.n + 1, header.n_entries, factor * header.n_entries), "iif",
                                                       header.formats, header.lines):
        if claimed != -(-count // per_line):
            raise FileError(path, 2, f"{claimed} lines are announced for {count} numbers, {per_line} on a line")
        parts.append(fixed_fields(path, lines[at:at + claimed], at, per_line, width, count, kind))
        at += claimed
    pointers, rows, values = parts
    check_structure(path, header, pointers, rows)
    columns = numpy.repeat(numpy.arange(header.n), numpy.diff(pointers))
    values = values[0::2] + 1j * values[1::2] if factor == 2 else values
    matrix = symmetric(header.n, rows - 1, columns, values, refuse(path), notes, whole=header.kind[1] == "U")
    return matrix, right_hand_sides(path, header, lines, at, factor, notes)


def check_structure(path, header, pointers, rows):
    """Refuses pointers that do not lead through the entries, and rows that are not there."""
    def line_of(k, part):
        return header.first + sum(header.lines[:part]) + k // header.formats[part][0] + 1
    steps = numpy.diff(pointers)
    if pointers[0] != 1:
        raise FileError(path, line_of(0, 0), f"the first column begins at entry {pointers[0]}, not 1")
    if (steps < 0).any():
        k = int(numpy.argmax(steps < 0)) + 1
        raise FileError(path, line_of(k, 0), f"column {k + 1} begins at entry {pointers[k]}, before the column left of it")
    if pointers[-1] != header.n_entries + 1:
        raise FileError(path, line_of(header.n, 0), f"the columns end at entry {pointers[-1] - 1}, but there are {header.n_entries}")
    wrong = (rows < 1) | (rows > header.n)
    if wrong.any():
        k = int(numpy.argmax(wrong))
        raise FileError(path, line_of(k, 1), f"row {rows[k]} of a matrix of {header.n} rows")


def right_hand_sides(path, header, lines, at, factor, notes):
    """(n, k) of full right-hand sides. Others, and first guesses or solutions behind them, are noted."""
    if not header.n_rhs:
        return None
    if header.rhs_type[:1] != "F" or factor == 2:
        notes.append(f"{path}:5: right-hand sides of kind {header.rhs_type} were not read")
        return None
    per_line, width = header.formats[3]
    # each vector begins a line of its own only where a line holds one number; else they follow each other
    count = header.n * header.n_rhs
    if count > 1000 * len(lines):
        raise FileError(path, 5, f"{header.n_rhs} right-hand sides do not fit into the file")
    values = fixed_fields(path, lines[at:], at, per_line, width, count, "f")
    if len(header.rhs_type) > 1:
        notes.append(f"{path}:5: first guesses or solutions behind the right-hand sides ({header.rhs_type}) were not read")
    return values.reshape(header.n_rhs, header.n).T


def write(path, matrices, ansys=False):
    """stem_K.rsa, stem_M.rsa, ... and stem.dof; ansys: stem_K.matrix, ... titles as HBMAT's, and a mapping for each.

    Lower triangle, 17 digits; loads, where there are, as right-hand sides of the stiffness matrix.
    """
    stem = os.path.splitext(os.fspath(path))[0]
    stem = stem[:-2] if stem.endswith("_K") else stem
    suffix, written = ".matrix" if ansys else ".rsa", []
    titles = {"K": "Stiffness", "M": "Mass", "C": "Damping"}
    for letter, matrix in matrices.by_letter():
        written.append(f"{stem}_{letter}{suffix}")
        title = f"{titles[letter]} matrix from ANSYS FULL file dumped into Harwell-Boeing format" if ansys else f"matrix {letter}"
        write_one(written[-1], matrix, title, letter, matrices.loads if letter == "K" else None)
        if ansys:
            written.append(f"{stem}_{letter}.mapping")
            dof_list.write_mapping(written[-1], matrices.dofs)
    if not ansys:
        written.append(stem + ".dof")
        dof_list.write_dof_list(written[-1], matrices.dofs)
    return written


def write_one(path, matrix, title, key, loads: Optional[numpy.ndarray] = None):
    lower = scipy.sparse.tril(matrix, format="csc")
    lower.sort_indices()
    n, n_entries = lower.shape[0], lower.nnz
    pointers = joined(lower.indptr + 1, "%12d", 6)
    rows, values = joined(lower.indices + 1, "%12d", 6), joined(lower.data, "%25.16E", 3)
    rhs = [] if loads is None else joined(numpy.asarray(loads).T.reshape(-1), "%25.16E", 3)
    counts = [len(pointers), len(rows), len(values), len(rhs)]
    with open(path, "w", encoding="ascii") as file:
        file.write(f"{title[:72]:<72s}{key:<8s}\n" + f"{sum(counts):14d}" + "".join(f"{c:14d}" for c in counts) + "\n")
        file.write(f"RSA           {n:14d}{n:14d}{n_entries:14d}{0:14d}\n")
        file.write(f"{'(6I12)':<16s}{'(6I12)':<16s}{'(1P,3E25.16)':<20s}{'(1P,3E25.16)' if rhs else '':<20s}\n")
        if rhs:
            file.write(f"F             {numpy.asarray(loads).shape[1]:14d}{0:14d}\n")
        for block in (pointers, rows, values, rhs):
            file.writelines(line + "\n" for line in block)


def joined(numbers, pattern, per_line):
    """Lines of numbers, so many on each."""
    texts = [pattern % number for number in numbers.tolist()]
    return ["".join(texts[k:k + per_line]) for k in range(0, len(texts), per_line)]
