"""Nastran DMIG entries (bulk data, punch files): several matrices by name in one file.

Points without a direction (SPOINT: scalar points, modal coordinates of superelements) have direction 0.
"""
import os
import re

import numpy

from ..assembly import LABEL_LIMIT, Places, dofs_of, in_order, key_of, symmetric
from ..errors import FileError
from ..tables import content, number
from . import bulk

NAME = "dmig"
# By the names that Nastran, its superelement export and people use; the first kind whose pattern fits.
NAMES = [("structural_damping", re.compile(r"^K4")), ("stiffness", re.compile(r"^(K|STIF)")), ("mass", re.compile(r"^M")),
         ("damping", re.compile(r"^(B|DAMP|C)"))]
EXPONENT = re.compile(r"(?<=[0-9.])(?=[+-])")  # where 1.5+3 leaves out the letter
OWN = {"stiffness": "KAAX", "mass": "MAAX", "damping": "BAAX", "structural_damping": "K4AAX"}


def matches(path, head):
    entry = re.compile(rb"^DMIG[ *,\t]", re.I | re.M)  # behind a mesh, perhaps
    behind = os.fspath(path).lower().endswith((".pch", ".bdf", ".dat", ".nas", ".blk"))
    return bool(entry.search(head)) or behind and bool(entry.search(content(path)))


class Matrix:
    """The entries of one name as texts; they become numbers all at once."""

    def __init__(self, path, entry):
        self.path, self.line = path, entry.line
        data = [field.strip() for field in entry.fields] + [""] * 8
        self.name = data[0].upper()
        self.form, self.kind = self.whole(data[2], "IFO", (1, 2, 6, 9)), self.whole(data[3], "TIN", (1, 2, 3, 4))
        self.polar = data[5]
        self.rows, self.columns, self.real, self.imaginary, self.lines = [], [], [], [], []

    def whole(self, text, what, allowed):
        if not text.isdecimal() or int(text) not in allowed:
            raise FileError(self.path, self.line, f"{what} of matrix {self.name} is {text!r}; it must be one of "
                            f"{', '.join(map(str, allowed))}")
        return int(text)

    def add_column(self, entry):
        """One column: node, direction, and rows of node, direction, real, imaginary part."""
        fields = entry.fields
        if len(fields) < 8 or len(fields) % 4:
            fields = fields + [""] * (-len(fields) % 4)
        column = (fields[1], fields[2])
        for k in range(4, len(fields), 4):
            if not fields[k].strip() and not fields[k + 2].strip():
                continue
            self.columns.append(column)
            self.rows.append((fields[k], fields[k + 1]))
            self.real.append(fields[k + 2])
            self.imaginary.append(fields[k + 3])
            self.lines.append(entry.lines[min(k, len(entry.lines) - 1)])

    def numbers(self, texts, what, blank=None):
        """Floats of texts, converted together where all are plain; else one by one, and the line of the first that is none."""
        try:
            joined = ",".join(texts)
            if "_" not in joined:
                joined = EXPONENT.sub("E", joined.replace("D", "E").replace("d", "e"))
                values = numpy.array(joined.split(",")).astype(float)
                if len(values) == len(texts) and numpy.isfinite(values).all():
                    return values
        except ValueError:
            pass
        values = numpy.empty(len(texts))
        for k, text in enumerate(texts):
            text = text.strip()
            try:
                values[k] = blank if not text and blank is not None else number(text)
                if not numpy.isfinite(values[k]):
                    raise ValueError
            except ValueError:
                raise FileError(self.path, self.lines[k], f"{text!r} where {what} is expected") from None
        return values

    def keys(self, pairs):
        """Keys of (node, direction) texts."""
        known, keys = {}, numpy.empty(len(pairs), numpy.int64)
        for k, pair in enumerate(pairs):
            key = known.get(pair)
            if key is None:
                node, direction = pair[0].strip(), pair[1].strip() or "0"
                if not node.isdecimal() or not 0 < int(node) < LABEL_LIMIT or direction not in "0123456" or len(direction) != 1:
                    raise FileError(self.path, self.lines[k], f"{' '.join(p.strip() for p in pair)!r} where a point and a direction "
                                    "0 .. 6 are expected")
                key = known[pair] = int(key_of(int(node), int(direction)))
            keys[k] = key
        return keys

    def assembled(self, notes):
        """(whole matrix, its DOFs), by label."""
        if not self.rows:
            raise FileError(self.path, self.line, f"matrix {self.name} has no columns")
        rows, columns = self.keys(self.rows), self.keys(self.columns)
        values = self.numbers(self.real, "a number")
        if self.kind > 2:
            second = self.numbers(self.imaginary, "an imaginary part", 0.0)
            polar = self.polar not in ("", "0")
            values = values * numpy.exp(1j * numpy.radians(second)) if polar else values + 1j * second
        keys = in_order(numpy.concatenate([rows, columns]))

        def fail(k, text):
            raise FileError(self.path, self.lines[k] if k is not None else self.line, f"matrix {self.name}: {text}")
        row_of = Places(keys)
        matrix = symmetric(len(keys), row_of(rows), row_of(columns), values, fail, notes, whole=self.form == 1)
        return matrix, dofs_of(keys)


def read(path, request, found):
    matrices = collected(path, found)
    for kind, matrix in by_kind(path, list(matrices.values()), request, found).items():
        found.add(kind, *matrix.assembled(found.notes), path)
    for kind, other in request.paths.items():
        others = by_kind(other, list(collected(other, found).values()), request, found)
        if kind not in others:
            raise FileError(other, 0, f"has no {kind} matrix")
        found.add(kind, *others[kind].assembled(found.notes), other)


def collected(path, found):
    """{name: Matrix} of a file; what else is in it is noted."""
    matrices, passed = {}, {}
    for entry in bulk.entries(path):
        if entry.name != "DMIG":
            passed.setdefault(entry.name, []).append(entry.line)
            continue
        name = entry.fields[0].strip().upper()
        if name == "UACCEL":
            found.note(path, entry.line, "DMIG UACCEL is a load and was not read")
        elif entry.fields[1].strip() == "0":
            if name in matrices:
                raise FileError(path, entry.line, f"a second header of matrix {name}; the first is in line {matrices[name].line}")
            matrices[name] = Matrix(path, entry)
        elif name not in matrices:
            raise FileError(path, entry.line, f"a column of matrix {name!r} before its header (DMIG, {name}, 0, ...)")
        else:
            matrices[name].add_column(entry)
    for name, lines in passed.items():
        found.note(path, lines[0], f"{len(lines)} {'entry' if len(lines) == 1 else 'entries'} {name} not read: no matrix")
    if not matrices:
        raise FileError(path, 0, "no DMIG matrix")
    return matrices


def by_kind(path, matrices, request, found):
    """{kind: matrix} by the names the caller gave, else by habit. matrices: with .name, .form, .line."""
    result, used = {}, set()
    for kind, name in request.names.items():
        result[kind] = next((m for m in matrices if m.name == name.upper()), None)
        if result[kind] is None:
            if kind in request.paths:
                del result[kind]
                continue
            raise FileError(path, 0, f"has no matrix {name}; it has {', '.join(m.name for m in matrices)}")
        used.add(name.upper())
    for matrix in matrices:
        kind = next((kind for kind, pattern in NAMES if pattern.match(matrix.name)), None)
        if matrix.name in used or kind in request.names or kind in request.paths:
            continue
        if kind is None or matrix.form in (2, 9):
            reason = "its name says no kind" if kind is None else "it is rectangular"
            found.note(path, matrix.line, f"matrix {matrix.name} was not read: {reason}")
            continue
        if kind in result:
            raise FileError(path, matrix.line, f"{result[kind].name} and {matrix.name} could both be the {kind} matrix: say which, by "
                            f"names={{{kind!r}: ...}}")
        result[kind] = matrix
    return result


def sixteen(value):
    """A number in at most 16 characters with as many digits as go in, without a letter before the exponent where that saves one."""
    best = None
    for digits in range(16, 7, -1):
        text = f"{value:.{digits}E}"
        mantissa, exponent = text.split("E")
        candidates = [f"{mantissa}{int(exponent):+d}"]
        if -3 < int(exponent) < 14:
            candidates.append(f"{value:.{max(digits - int(exponent), 0)}f}" + ("." if digits <= int(exponent) else ""))
        best = next((c for c in candidates if len(c) <= 16), None)
        if best:
            return best
    raise ValueError(f"{value} does not fit into 16 characters")


def labels_for(dofs):
    """(n, 2) that bulk data can say: rows without a node become scalar points behind the largest label."""
    labels = dofs.copy()
    without = (dofs[:, 0] < 1) | (dofs[:, 1] > 6)
    if without.any():
        first = max(int(dofs[:, 0].max()), 0) + 1
        labels[without] = numpy.column_stack([first + numpy.arange(without.sum()), numpy.zeros(without.sum(), numpy.int64)])
    return labels


def write(path, matrices, free=False):
    """x.pch: KAAX, MAAX, BAAX, K4AAX, symmetric. Fields of 16 characters hold 13 to 15 digits.

    free: with commas, where a field may be longer, with 17 digits (a reader other than ours may want 16 characters at most)
    """
    path = os.path.splitext(path)[0] + ".pch"
    labels = labels_for(matrices.dofs).tolist()
    with open(path, "w", encoding="ascii") as file:
        for kind, matrix in matrices.by_kind():
            name, lower = OWN[kind], matrix.tocsc()
            file.write(f"DMIG    {name:<8s}{0:8d}{6:8d}{2:8d}{0:8d}{'':16s}{matrices.n_dof:8d}\n")
            for j, (node, direction) in enumerate(labels):
                entries = range(lower.indptr[j], lower.indptr[j + 1])
                rows = [(labels[lower.indices[k]], lower.data[k]) for k in entries if lower.indices[k] >= j]
                if not rows:
                    continue
                if free:
                    file.write(f"DMIG*,{name},{node},{direction}\n")
                    file.writelines(f"*,{i},{c},{value:.16E}\n" for (i, c), value in rows)
                else:
                    file.write(f"DMIG*   {name:<16s}{node:16d}{direction:16d}\n")
                    file.writelines(f"*       {i:16d}{c:16d}{sixteen(value):>16s}\n" for (i, c), value in rows)
    return [path]
