"""Nastran OUTPUT4: matrices by name, ASCII or binary, dense, sparse, or sparse for large sizes (BIGMAT). They carry no DOFs."""
import os
import re

import numpy
import scipy.sparse

from ..assembly import symmetric
from ..errors import FileError
from ..tables import fixed_fields, text_lines
from . import companions, output4_binary
from .dmig import OWN, by_kind
from .dof_list import write_dof_list
from .found import refuse
from .output4_block import Block, dense_of, strings_of

NAME = "output4"
HEADER = re.compile(r"^\s*\d+\s*-?\d+\s+\d+\s+\d\s*\S")
DIGITS = re.compile(r"(\d*)P?,?(\d+)([ED])(\d+)\.(\d+)", re.I)


def matches(path, head):
    if output4_binary.byte_order(head):
        return True
    line = head.split(b"\n")[0].decode("latin-1")
    return bool(HEADER.match(line)) and (bool(DIGITS.search(line[40:])) or os.fspath(path).lower().endswith(".op4"))


def read(path, request, found):
    for kind, file in {"all": path, **request.paths}.items():
        wanted = by_kind(file, blocks(file), request._replace(paths={}) if kind != "all" else request, found)
        if kind != "all":
            if kind not in wanted:
                raise FileError(file, 0, f"has no {kind} matrix")
            wanted = {kind: wanted[kind]}
        for own, block in wanted.items():
            found.add(own, whole(block, found.notes), None, file)
    if "stiffness" in found.matrices:
        companions.read_dofs_beside(path, request, found)


def whole(block, notes):
    """The symmetric matrix of a block."""
    if block.form not in (1, 6) or block.kind not in (1, 2, 3, 4):
        raise FileError(block.path, block.line, f"matrix {block.name} has form {block.form} and type {block.kind}; square and "
                        "symmetric ones (1, 6) of types 1 .. 4 are read")
    if block.n_rows != block.n_columns:
        raise FileError(block.path, block.line, f"matrix {block.name} has {block.n_rows} rows and {block.n_columns} columns; it must "
                        "be square")
    if block.n_rows > 64 + 16 * os.path.getsize(block.path):
        raise FileError(block.path, block.line, f"matrix {block.name} of {block.n_rows} rows does not fit into the file")
    rows, columns, values = block.entries()
    good = numpy.isfinite(values)
    if not good.all():
        raise FileError(block.path, block.line, f"matrix {block.name} has a value that is no finite number")

    def fail(_, text):
        refuse(block.path)(None, f"matrix {block.name}: {text}")
    return symmetric(block.n_rows, rows, columns, values, fail, notes, whole=block.form == 1)


def blocks(path):
    """The matrices of a file, as Block."""
    with open(path, "rb") as file:
        order = output4_binary.byte_order(file.read(64))
    return output4_binary.blocks(path, order) if order else ascii_blocks(path)


def ascii_blocks(path):
    lines, at, result = text_lines(path, names_with_zeros=True), 0, []
    while at < len(lines) and lines[at].strip():
        block, at = ascii_block(path, lines, at)
        result.append(block)
    return result


def whole_numbers(path, lines, row, count, widths=None):
    """The whole numbers of a line: so many words, or fields of these widths."""
    text = lines[row] if row < len(lines) else ""
    ends = numpy.cumsum(widths) if widths else ()
    words = [text[end - width:end] for end, width in zip(ends, widths)] if widths else text.split()
    try:
        if len(words) != count or not all(len(word) < 19 for word in words):
            raise ValueError
        return [int(word) for word in words]
    except ValueError:
        raise FileError(path, row + 1, f"{text.strip()[:60]!r} where {count} whole numbers are expected" if row < len(lines) else
                        "the file ends before its last matrix does") from None


def header_of(path, lines, at):
    """(block, numbers on a line, width of a number) of the header in a line."""
    wide = lines[at].rstrip().endswith("|I16")  # more than 9,999,999 rows or columns: 16 characters for each
    widths = [16, 16, 8, 8] if wide else [8, 8, 8, 8]
    name = sum(widths)
    digits = DIGITS.search(lines[at][name + 8:] if lines[at][name + 8:].strip() else "1P,5E16.9")
    if not digits or not 0 < int(digits.group(4)) < 60 or not 0 < int(digits.group(2)) < 60:
        raise FileError(path, at + 1, f"{lines[at].strip()[:60]!r} where the header of a matrix with its format (1P,3E23.16) is "
                        "expected")
    return (Block(path, at + 1, *whole_numbers(path, lines, at, 4, widths), lines[at][name:name + 8]),
            int(digits.group(2)), int(digits.group(4)))


def ascii_block(path, lines, at):
    """(block, the line behind it)."""
    block, per_line, width = header_of(path, lines, at)
    at, parts = at + 1, []
    while True:
        column, row, n_words = whole_numbers(path, lines, at, 3)
        at += 1
        if column > block.n_columns:  # the column behind the last ends a matrix
            at += -(-max(n_words, 1) // per_line)
            break
        if not 0 <= n_words <= 32 * block.n_rows + 8:
            raise FileError(path, at, f"{n_words} words in a column of {block.n_rows} rows")
        at = dense_column(block, path, lines, at, column, row, n_words, per_line, parts) if row > 0 else \
            sparse_column(block, path, lines, at, column, n_words, per_line, parts)
    block.values = numbers_of(path, lines, parts, per_line, width)
    return block, at


def dense_column(block, path, lines, at, column, row, n_reals, per_line, parts):
    block.add(column, row, n_reals // block.per_number, at)
    parts.append((at, n_reals))
    return at + -(-n_reals // per_line)


def sparse_column(block, path, lines, at, column, n_words, per_line, parts):
    """Strings of a column; each has a header: length and row in two words, or both in one where the matrix is small."""
    words_of_real = 2 if block.kind in (2, 4) else 1
    while n_words > 0:
        if block.bigmat:
            length, row = whole_numbers(path, lines, at, 2)
            length, used = length - 1, length + 1
        else:
            packed, = whole_numbers(path, lines, at, 1)
            length, row = packed // 65536 - 1, packed % 65536
            used = length + 1
        at += 1
        n_reals = length // words_of_real
        if length < words_of_real or n_reals % block.per_number or used > n_words:
            raise FileError(path, at, f"a string of {length} words where {n_words} are left in column {column}")
        block.add(column, row, n_reals // block.per_number, at)
        parts.append((at, n_reals))
        at += -(-n_reals // per_line)
        n_words -= used
    return at


def numbers_of(path, lines, parts, per_line, width):
    """The reals of all strings, in one conversion: short last lines are filled, and what fills them is left out again."""
    texts, counts, first = [], [], []
    for at, n_reals in parts:
        needed = -(-n_reals // per_line)
        if at + needed > len(lines):
            raise FileError(path, len(lines), "the file ends before its last matrix does")
        texts += lines[at:at + needed]
        counts += [per_line] * (needed - 1) + [n_reals - (needed - 1) * per_line] if needed else []
        first += range(at, at + needed)
    counts = numpy.array(counts, numpy.int64)
    room = per_line * width
    filled = [(text[:count * width].ljust(count * width) + "0".rjust(width) * (per_line - count))[:room]
              for text, count in zip(texts, counts.tolist())]
    try:
        values = fixed_fields(path, filled, 0, per_line, width, len(filled) * per_line, "f")
    except FileError as error:
        raise FileError(path, first[error.line - 1] + 1, error.text) from None
    keep = (numpy.arange(per_line) < counts[:, None]).reshape(-1)
    return values[keep]


def write(path, matrices, binary=False, layout="bigmat", precision="double", byteorder="<"):
    """x.op4: KAAX, MAAX, BAAX, K4AAX, and x.dof beside it, which OUTPUT4 itself has no place for.

    layout     "dense", "sparse" (up to 65,535 rows) or "bigmat"
    precision  "double" (17 digits in ASCII) or "single"
    byteorder  "<" or ">" (binary)
    """
    if layout not in ("dense", "sparse", "bigmat") or precision not in ("double", "single") or byteorder not in "<>":
        raise ValueError("layout is dense, sparse or bigmat, precision double or single, byteorder < or >")
    if layout == "sparse" and matrices.n_dof > 65535:
        raise ValueError("the sparse layout has room for 65,535 rows; bigmat has for more")
    stem = os.path.splitext(path)[0]
    kind = 2 if precision == "double" else 1
    with open(stem + ".op4", "wb") as file:
        for own, matrix in matrices.by_kind():
            matrix = scipy.sparse.csc_matrix(matrix)
            matrix.sort_indices()
            if binary:
                output4_binary.write_block(file, OWN[own], matrix, kind, layout, byteorder)
            else:
                file.write(ascii_text(OWN[own], matrix, kind, layout).encode("ascii"))
    write_dof_list(stem + ".dof", matrices.dofs)
    return [stem + ".op4", stem + ".dof"]


def ascii_text(name, matrix, kind, layout):
    n, digits, per_line = matrix.shape[0], (16 if kind == 2 else 9), (3 if kind == 2 else 5)
    width = digits + 7
    out = [f"{n:8d}{-n if layout == 'bigmat' else n:8d}{6:8d}{kind:8d}{name:<8s}1P,{per_line}E{width}.{digits}"]

    def reals(values):
        texts = [f"{value:{width}.{digits}E}" for value in values]
        out.extend("".join(texts[k:k + per_line]) for k in range(0, len(texts), per_line))
    for j in range(n):
        if matrix.indptr[j] == matrix.indptr[j + 1]:
            continue
        if layout == "dense":
            row, values = dense_of(matrix, j)
            out.append(f"{j + 1:8d}{row + 1:8d}{len(values):8d}")
            reals(values)
            continue
        strings, extra = strings_of(matrix, j), 2 if layout == "bigmat" else 1
        out.append(f"{j + 1:8d}{0:8d}{sum(kind * len(v) + extra for _, v in strings):8d}")
        for row, values in strings:
            length = kind * len(values) + 1
            out.append(f"{length:8d}{row + 1:8d}" if layout == "bigmat" else f"{65536 * length + row + 1:12d}")
            reals(values)
    out.append(f"{n + 1:8d}{1:8d}{1:8d}")
    reals([1.0])
    return "\n".join(out) + "\n"
