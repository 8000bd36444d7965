"""Lines of a CalculiX or Abaqus deck: keyword blocks out of files that include others.

Nothing here knows what a keyword means. A Block is a keyword line with the data lines below it; every line remembers where it
stands, so that whoever reads it can say which one is wrong.
"""
import os
import re
import warnings

import numpy

from .errors import FileError

INCLUDES_DEEP = 16
LARGEST_NUMBER = 1e100  # beyond, squares overflow, and nothing is that large
LARGEST_LABEL = 10**12  # labels beyond are damaged numbers; shifts of instances still fit 64 bits


class Line:
    """A data line: its file, its number from 1, its fields (split when first asked for: of most lines they never are)."""
    __slots__ = ("file", "number", "text", "_fields")

    def __init__(self, file, number, text):
        self.file, self.number, self.text, self._fields = file, number, text, None

    @property
    def fields(self):
        if self._fields is None:
            self._fields = split(self.text)
        return self._fields

    def fail(self, text):
        raise FileError(self.file, self.number, text)

    def field(self, index):
        """Text of a field, "" where there is none."""
        return self.fields[index] if index < len(self.fields) else ""

    def real(self, index, name, default=None):
        text = self.field(index)
        if not text and default is not None:
            return default
        try:
            value = float(text.replace("D", "E").replace("d", "e")) if "_" not in text else None
        except ValueError:
            value = None
        if value is None or not abs(value) < LARGEST_NUMBER:
            self.fail(f"{name} is {shown(text)}; a number is needed (below {LARGEST_NUMBER:g})")
        return value

    def integer(self, index, name, default=None):
        text = self.field(index)
        if not text and default is not None:
            return default
        value = whole(text)
        if value is None:
            self.fail(f"{name} is {shown(text)}; a whole number is needed")
        return value


class Block:
    """A keyword with its parameters (upper case; values as written, without quotes) and its data lines.

    key    the keyword in upper case without blanks, such as "CONTACTPAIR"
    scope  the part or instance it belongs to (deck_assembly); None in a flat deck
    """

    def __init__(self, file, number, text):
        self.file, self.number, self.text, self.scope = file, number, text, None
        first, *rest = split(text[1:]) or [""]
        self.key = re.sub(r"\s+", "", first).upper()
        self.parameters, self.lines = {}, []
        for field in rest:
            name, equals, value = field.partition("=")
            if name.strip():
                self.parameters[re.sub(r"\s+", "", name).upper()] = unquoted(value) if equals else ""

    def __contains__(self, parameter):
        return parameter in self.parameters

    def get(self, parameter, default=""):
        """Value of a parameter; the default where it is not there."""
        return self.parameters.get(parameter, default)

    def word(self, parameter, default=""):
        """A value that is a word of the language, in upper case without blanks."""
        return re.sub(r"\s+", "", self.get(parameter, default)).upper()

    def needed(self, parameter):
        value = self.get(parameter)
        if not value:
            self.fail(f"*{self.key} has no {parameter}=; give it")
        return value

    def real(self, parameter, default):
        """A parameter that is a number."""
        text = self.get(parameter)
        if not text:
            return default
        try:
            value = float(text.replace("D", "E").replace("d", "e"))
        except ValueError:
            value = numpy.nan
        if not abs(value) < LARGEST_NUMBER:
            self.fail(f"{parameter}= is {shown(text)}; a number is needed (below {LARGEST_NUMBER:g})")
        return value

    def fail(self, text):
        raise FileError(self.file, self.number, text)


def split(text):
    """Fields between commas, without the blanks around them; quotes protect commas. A comma at the end adds none."""
    if '"' not in text and "'" not in text:
        fields = [field.strip() for field in text.split(",")]
    else:
        fields, current = [], ""
        for piece in re.findall(r'"[^"]*"|\'[^\']*\'|,|[^,"\']+|["\']', text):
            if piece == ",":
                fields.append(current.strip())
                current = ""
            else:
                current += piece
        fields.append(current.strip())
    while fields and not fields[-1]:
        fields.pop()
    return fields


def unquoted(text):
    text = text.strip()
    if len(text) > 1 and text[0] == text[-1] and text[0] in "\"'":
        text = text[1:-1].strip()
    return text


def shown(text):
    """A text from a file, short enough for a message."""
    return "empty" if not text else repr(text if len(text) <= 40 else text[:37] + "...")


def whole(text):
    """The integer that a field says, also as 12. or 1.2e1 (which mesh tools write); None if none, or far too large for a label."""
    try:
        value = float(text) if "_" not in text else numpy.nan
    except ValueError:
        return None
    return int(value) if abs(value) <= LARGEST_LABEL and value == int(value) else None


def table(block, columns, name):
    """Data lines of numbers as an array, lines x columns of double: at least the first column, missing ones 0. Fast where all
    lines are plain; else line by line, which finds the one at fault."""
    values = plain_numbers([line.text for line in block.lines], float)
    if values is not None and values.shape[1] == columns and numpy.all(numpy.abs(values) < LARGEST_NUMBER):
        return values
    values = numpy.zeros((len(block.lines), columns))
    for row, line in zip(values, block.lines):
        if len(line.fields) > columns:
            line.fail(f"{len(line.fields)} fields; {name} has {columns} at most")
        for i in range(max(len(line.fields), 1)):
            row[i] = line.real(i, f"field {i + 1} of {name}", None if i == 0 else 0.0)
    return values


def plain_numbers(texts, kind):
    """Lines of numbers between commas as an array, by NumPy's fast reader; None where it does not take them as they are."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")  # it warns where there are none, and where it would cut 1.5 down to an integer
        try:
            return numpy.loadtxt(texts, delimiter=",", ndmin=2, comments=None, dtype=kind)
        except (ValueError, OverflowError, Warning):
            return None


def read_blocks(path):
    """All blocks of a deck in their order, those of included files in place."""
    main = os.path.abspath(os.fspath(path))
    blocks = []
    _read(main, os.path.dirname(main), (), blocks, None)
    if not blocks:
        raise FileError(path, 0, "there is no keyword (a line that begins with one *) in this file; is it a deck?")
    return blocks


def _read(path, folder, parents, blocks, origin):
    """One file. A block that an included file begins may have its data after *INCLUDE, and the other way round."""
    block = blocks[-1] if blocks else None
    for number, text in _whole_lines(path, origin):
        if text[0] != "*":
            if block is None:
                raise FileError(path, number, f"data before the first keyword: {shown(text)}; is this a deck?")
            block.lines.append(Line(path, number, text))
            continue
        new = Block(path, number, text)
        if not new.key:
            new.fail("a keyword line without a keyword")
        if new.key != "INCLUDE":
            blocks.append(new)
            block = new
            continue
        _read(_included(new, folder, (*parents, path)), folder, (*parents, path), blocks, new)
        block = blocks[-1] if blocks else None


def _included(block, folder, parents):
    """The file that *INCLUDE names: beside the file that says so, or beside the main one."""
    name = block.needed("INPUT")
    if "\0" in name:
        block.fail("the name of the included file has a zero byte")
    if len(parents) >= INCLUDES_DEEP:
        block.fail(f"files include one another more than {INCLUDES_DEEP} deep")
    if os.sep == "/":
        name = name.replace("\\", os.sep)  # a deck written on Windows
    for place in (os.path.dirname(block.file), folder):
        path = os.path.abspath(os.path.join(place, name))
        if path in parents:
            block.fail(f"{name} includes itself")
        if os.path.isfile(path):
            return path
    block.fail(f"the included file {name} is not there (looked for beside this file and in {folder})")


def _whole_lines(path, origin):
    """(number of its first line, text) of the lines that say something; keyword lines that end with a comma may go on."""
    try:
        with open(path, "rb") as file:
            data = file.read()
    except OSError as error:
        where = (origin.file, origin.number) if origin else (path, 0)
        raise FileError(*where, f"{path} cannot be read: {error.strerror}") from None
    if b"\0" in data:
        raise FileError(path, data[:data.index(b"\0")].count(b"\n") + 1, "a zero byte; this is not a text file")
    lines = data.decode("utf-8", "replace").replace("\r\n", "\n").replace("\r", "\n").split("\n")
    keyword, begin = "", 0  # one that ended with a comma
    for number, text in enumerate(lines, 1):
        text = text.strip()
        if not text or text.startswith("**"):
            continue
        if keyword and text[0] not in "*+-.0123456789":  # more parameters; numbers are data below a comma too many
            text, number, keyword = keyword + text, begin, ""
        elif keyword:
            yield begin, keyword
            keyword = ""
        if text[0] == "*" and text[-1] == ",":
            keyword, begin = text, number
        else:
            yield number, text
    if keyword:
        yield begin, keyword
