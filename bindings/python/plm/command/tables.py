"""Small tables in CSV, with a line of names above."""
import contextlib
import csv
import math
import re

from ..fe.errors import FileError
from .settings import nearest


def read_table(path, required, optional=()):
    """A list of (line, dict of the texts by name). Columns may come in any order; names are told in small letters."""
    known = [*required, *optional]
    with open(path, newline="", encoding="utf-8-sig") as file:
        try:
            reader = csv.reader(file)
            names = [name.strip().lower() for name in next(reader, [])]
            for name in names:
                if name not in known:
                    raise FileError(path, 1, f"column {name!r} is unknown{nearest(name, known)}")
                if names.count(name) > 1:
                    raise FileError(path, 1, f"column {name!r} comes twice")
            for name in required:
                if name not in names:
                    raise FileError(path, 1, f"there is no column {name}; the first line must name the columns {', '.join(known)}")
            rows = []
            for row in reader:
                if not any(field.strip() for field in row):
                    continue
                if len(row) != len(names):
                    raise FileError(path, reader.line_num, f"{len(row)} fields for {len(names)} columns")
                rows.append((reader.line_num, dict(zip(names, (field.strip() for field in row)))))
            return rows
        except (csv.Error, UnicodeDecodeError) as error:
            raise FileError(path, reader.line_num + 1, f"no CSV in UTF-8: {error}") from None


def number(path, line, row, name, default=None, whole=False):
    """A number of a row; default where nothing stands there."""
    text = row.get(name, "")
    if text == "" and default is not None:
        return default
    if whole and re.fullmatch(r"[-+]?[0-9]{1,15}", text):
        return int(text)
    with contextlib.suppress(ValueError):
        if not whole and math.isfinite(float(text)):
            return float(text)
    raise FileError(path, line, f"{name} is {text[:40]!r}; it must be a {'whole ' if whole else ''}number")
