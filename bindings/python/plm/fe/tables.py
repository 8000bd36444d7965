"""Columns and fields of numbers from text, fast where all is right and exact about the line where it is not.

NumPy's compiled parser reads the columns. Only when it, or a check of what it read, objects, the lines are walked one by one to
find the one at fault.
"""
import io
import os
import warnings

import numpy

from .errors import FileError

KINDS = {"i": numpy.int64, "f": numpy.float64}
WORDS = {"i": "a whole number", "f": "a number"}


def content(path):
    """The bytes of a file; FileError where there is none to read."""
    try:
        with open(path, "rb") as file:
            return file.read()
    except OSError as error:
        raise FileError(path, 0, f"cannot be read: {error.strerror or error}") from None


def text_lines(path, names_with_zeros=False):
    """The lines of a text, without their ends. Bytes beyond ASCII do no harm: they stand where no number can be read."""
    data = content(path)
    if b"\0" in data[:4096] and not names_with_zeros:
        raise FileError(path, 0, "is binary where a text was expected")
    return data.decode("latin-1").replace("\r\n", "\n").replace("\r", "\n").split("\n")


def number(text):
    """A float as Fortran and bulk data write it: 1.5D+3, 1.5+3, 1.5-103."""
    text = text.strip().upper().replace("D", "E")
    if "_" in text:
        raise ValueError(text)
    try:
        return float(text)
    except ValueError:
        sign = max(text.rfind("+"), text.rfind("-"))
        if sign < 1 or text[sign - 1] == "E":
            raise
        return float(text[:sign] + "E" + text[sign:])


class Table:
    """Columns of numbers of equal length, and the line each row came from."""

    def __init__(self, path, kinds, lines, first, separators, comments):
        self.path, self.kinds, self.first = path, kinds, first
        self._lines, self._separators, self._comments = lines, separators, comments
        self.columns = ()

    def __len__(self):
        return len(self.columns[0])

    def rows(self):
        """(line, words) of each row, by the slow way."""
        lines = text_lines(self.path)[self.first:] if self._lines is None else self._lines
        for count, line in enumerate(lines, self.first + 1):
            for mark in self._separators:
                line = line.replace(mark, " ")
            words = line.split()
            if words and not (self._comments and words[0].startswith(self._comments)):
                yield count, words

    def line(self, row):
        """The line of a row."""
        return next((line for k, (line, _) in enumerate(self.rows()) if k == row), 0)

    def fail(self, row, text):
        """Refuses a row, or all of the file where row is None."""
        raise FileError(self.path, 0 if row is None else self.line(row), text)

    def check(self, good, text):
        """Refuses the first row where good is False. text: its words, or a function of the row."""
        if not good.all():
            row = int(numpy.argmin(good))
            self.fail(row, text(row) if callable(text) else text)

    def find_fault(self, reason):
        """Why the compiled parser refused."""
        for line, words in self.rows():
            if len(words) != len(self.kinds):
                raise FileError(self.path, line, f"{len(words)} values where {len(self.kinds)} are expected: {shown(words)}")
            for kind, word in zip(self.kinds, words):
                try:
                    value = int(word) if kind == "i" else number(word)
                    if kind == "i" and not -2**62 < value < 2**62:
                        raise ValueError
                except ValueError:
                    raise FileError(self.path, line, f"{word[:40]!r} where {WORDS[kind]} is expected") from None
        raise FileError(self.path, 0, f"cannot be read as columns of numbers: {reason}")


def shown(words):
    text = " ".join(words)
    return repr(text if len(text) < 60 else text[:57] + "...")


def read_table(path, kinds, first=0, separators="", comments=None, lines=None):
    """The columns of numbers after the first lines of a file.

    kinds       "iif": two columns of whole numbers and one of floats
    first       lines before them
    separators  characters that separate as blanks do
    comments    what lines begin with that count as comments
    lines       the lines, where they are in memory already (and then `first` is where they begin)
    """
    table = Table(path, kinds, lines, first, separators, comments)
    dtype = [(f"c{k}", KINDS[kind]) for k, kind in enumerate(kinds)]
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of a file without numbers: said below
            warnings.simplefilter("error", DeprecationWarning)  # 2.5 read as the whole number 2
            found = load(path, dtype, first, separators, comments, lines)
    except (ValueError, OverflowError, DeprecationWarning) as error:
        table.find_fault(str(error).splitlines()[0] if str(error) else type(error).__name__)
    table.columns = tuple(numpy.ascontiguousarray(found[name]) for name, _ in dtype)
    if not len(table):
        raise FileError(path, first, "no numbers where a matrix was expected")
    for column, kind in zip(table.columns, kinds):
        if kind == "f":
            table.check(numpy.isfinite(column), "a value that is no finite number")
    return table


def load(path, dtype, first, separators, comments, lines):
    """What numpy.loadtxt makes of it: straight from the file, or from its text with Fortran's letters and separators changed."""
    options = {"dtype": dtype, "comments": comments}
    if lines is None:
        try:
            return numpy.atleast_1d(numpy.loadtxt(os.fspath(path), skiprows=first, encoding="latin-1",
                                                  delimiter=separators[:1] or None, **options))
        except (ValueError, DeprecationWarning):  # letters or separators that it does not know, or a fault
            lines = text_lines(path)[first:]
    text = "\n".join(lines)
    for mark in separators:
        text = text.replace(mark, " ")
    text = text.replace("D", "E").replace("d", "e")
    return numpy.atleast_1d(numpy.loadtxt(io.StringIO(text), **options))


def fixed_fields(path, lines, first, per_line, width, count, kind):
    """`count` numbers from fields of fixed width that may touch, `per_line` of them on a line.

    lines, first  the lines that hold them, and how many lines are before these in the file
    """
    needed = -(-count // per_line)
    if len(lines) < needed:
        raise FileError(path, first + len(lines), f"the file ends after {len(lines)} of {needed} lines of numbers")
    room = per_line * width
    if needed * room > 4 * sum(map(len, lines)) + room:
        raise FileError(path, first + 1, f"the lines are shorter than {per_line} numbers of {width} characters")
    joined = "".join(line[:room].ljust(room) for line in lines[:needed])
    fields = numpy.frombuffer(joined.encode("latin-1", "replace"), f"S{width}")[:count]
    try:
        if "_" in joined:
            raise ValueError("an underscore")
        if kind == "i":
            return fields.astype(numpy.int64)
        values = numpy.char.replace(numpy.char.upper(fields), b"D", b"E") if "d" in joined.lower() else fields
        values = values.astype(float)
        if numpy.isfinite(values).all():
            return values
    except (ValueError, OverflowError):
        pass
    return slow_fields(path, fields, first, per_line, kind)


def slow_fields(path, fields, first, per_line, kind):
    """Field by field: what the compiled conversion does not take (1.5-103), or the line at fault."""
    values = numpy.empty(len(fields), KINDS[kind])
    for k, field in enumerate(fields):
        word = field.decode("latin-1")
        try:
            values[k] = int(word) if kind == "i" and "_" not in word else number(word)
            if not numpy.isfinite(values[k]):
                raise ValueError
        except (ValueError, OverflowError):
            raise FileError(path, first + k // per_line + 1, f"{word.strip()[:40]!r} where {WORDS[kind]} is expected "
                            f"(field {k % per_line + 1} of the line)") from None
    return values
