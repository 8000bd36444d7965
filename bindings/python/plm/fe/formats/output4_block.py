"""A matrix of OUTPUT4 as it stands in the file: strings of numbers down the columns."""
import numpy

from ..errors import FileError

LONGEST = 15000  # numbers in a string that is written


class Block:
    """What the header of a matrix says, its strings and their numbers."""

    def __init__(self, path, line, n_columns, n_rows, form, kind, name):
        self.path, self.line, self.name, self.form, self.kind = path, line, name.replace("\0", " ").strip().upper(), form, kind
        self.n_columns, self.n_rows, self.bigmat = n_columns, abs(n_rows), n_rows < 0
        if not (0 < n_columns < 2**40 and 0 < abs(n_rows) < 2**40 and 1 <= kind <= 4):
            raise FileError(path, line, f"matrix {self.name} of {n_rows} rows, {n_columns} columns, type {kind}: no header of OUTPUT4")
        self.per_number = 2 if kind > 2 else 1  # reals in a number
        self.strings = []  # (column, row, count of numbers), from 0
        self.values = None

    def add(self, column, row, count, line):
        if not 1 <= column <= self.n_columns or row < 1 or count < 0 or row - 1 + count > self.n_rows:
            raise FileError(self.path, line, f"{count} numbers from row {row} of column {column} in matrix {self.name} of "
                            f"{self.n_rows} rows and {self.n_columns} columns")
        self.strings.append((column - 1, row - 1, count))

    def entries(self):
        """(rows, columns, values) of all that is not zero."""
        strings = numpy.array(self.strings, numpy.int64).reshape(-1, 3)
        counts = strings[:, 2]
        columns = numpy.repeat(strings[:, 0], counts)
        ends = numpy.cumsum(counts)
        rows = numpy.repeat(strings[:, 1] - (ends - counts), counts) + numpy.arange(counts.sum())
        values = self.values
        if self.kind > 2:
            values = values[0::2] + 1j * values[1::2]
        keep = values != 0
        return rows[keep], columns[keep], values[keep]


def strings_of(matrix, j):
    """(first row, values) of the runs of consecutive rows in a column, cut where a length would not fit beside a row in 32 bits."""
    rows, values = matrix.indices[matrix.indptr[j]:matrix.indptr[j + 1]], matrix.data[matrix.indptr[j]:matrix.indptr[j + 1]]
    if not len(rows):
        return []
    run = numpy.arange(len(rows))
    start = numpy.maximum.accumulate(numpy.where(numpy.diff(rows, prepend=-2) > 1, run, 0))
    breaks = numpy.flatnonzero((run - start) % LONGEST == 0)[1:]
    return [(int(r[0]), v) for r, v in zip(numpy.split(rows, breaks), numpy.split(values, breaks))]


def dense_of(matrix, j):
    """(first row, values) of a column from its first entry to its last."""
    begin, end = matrix.indptr[j], matrix.indptr[j + 1]
    rows = matrix.indices[begin:end]
    values = numpy.zeros(rows[-1] - rows[0] + 1)
    values[rows - rows[0]] = matrix.data[begin:end]
    return int(rows[0]), values
