"""Entries of Nastran's bulk data: small, large and free field, continued over lines."""
from ..tables import text_lines
from ..errors import FileError


class Entry:
    """One entry: its name, and the fields behind it, each a text; `lines` has the line of each field."""

    def __init__(self, name, line):
        self.name, self.line, self.fields, self.lines = name, line, [], []

    def add(self, fields, line):
        self.fields += fields
        self.lines += [line] * len(fields)


def split_line(text):
    """(first field, fields) of a line: 8 of 8 characters, 4 of 16, or free with commas."""
    if "\t" in text:
        text = text.expandtabs(8)
    if "," in text:
        words = text.split(",")
        first = words[0].strip()
        count = 4 if first.endswith("*") or first.startswith("*") else 8
        fields = [word.strip() for word in words[1:1 + count]]
        return first, fields + [""] * (count - len(fields))
    first = text[:8].strip()
    if first.endswith("*") or first.startswith("*"):
        return first, [text[8:24], text[24:40], text[40:56], text[56:72]]
    return first, [text[k:k + 8] for k in range(8, 72, 8)]


def entries(path):
    """The entries of a file, until ENDDATA. Comments ($) and empty lines are left out."""
    current = None
    for number, line in enumerate(text_lines(path), 1):
        text = line.partition("$")[0]
        if not text or text.isspace():
            continue
        first, fields = split_line(text)
        if first == "" or first[0] in "+*":
            if current is None:
                raise FileError(path, number, f"{text[:40]!r} continues an entry, but none is before it")
            current.add(fields, number)
            continue
        if current is not None:
            yield current
        name = first.rstrip("*").upper()
        if name == "ENDDATA":
            return
        current = Entry(name, number)
        current.add(fields, number)
    if current is not None:
        yield current
