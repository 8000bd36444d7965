"""Case files: the settings of a command in TOML, for what is longer than a line."""
import pathlib
import re

from ..fe.errors import FileError
from .settings import BY_NAME, Wrong, nearest, value_of

_FILES = ("model", "matrices", "dofs", "mesh", "coordinates", "contact")


def read_case(path):
    """A dict of the settings in a file. One file serves all commands: each takes what it knows. Names of files count from the
    file's folder."""
    text = _text(path)
    case = {}
    for name, value in _parse(path, text).items():
        if name not in BY_NAME:
            raise FileError(path, _line_of(name, text), f"{name} is unknown{nearest(name, list(BY_NAME))}")
        try:
            case[name] = _beside(path, name, value_of(BY_NAME[name], value))
        except Wrong as wrong:
            raise FileError(path, _line_of(name, text), str(wrong)) from None
    return case


def _text(path):
    if not pathlib.Path(path).is_file():
        raise Wrong(f"{path} is no file")
    try:
        return pathlib.Path(path).read_text(encoding="utf-8")
    except UnicodeDecodeError as error:
        raise FileError(path, 0, f"byte {error.start} is no UTF-8, which TOML is written in") from None


def _parse(path, text):
    try:
        import tomllib
    except ImportError:
        try:
            import tomli as tomllib
        except ImportError:
            raise Wrong(f"{path}: case files need Python 3.11, or the package tomli") from None
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        found = re.search(r"\(at line (\d+), column (\d+)\)|\(at end of document\)", str(error))
        line = int(found[1]) if found and found[1] else text.count("\n") + 1
        raise FileError(path, line, f"no TOML: {str(error)}") from None


def _line_of(name, text):
    """Where a key stands first; 0: not found (a quoted key)."""
    pattern = re.compile(rf"\s*(\[+\s*)?[\"']?{re.escape(name)}[\"']?\s*[\].=]")
    return next((i for i, line in enumerate(text.splitlines(), 1) if pattern.match(line)), 0)


def _beside(path, name, value):
    """Files that a case names lie beside it."""
    folder = pathlib.Path(path).parent
    if name not in _FILES or not isinstance(value, (str, list)):
        return value
    if isinstance(value, list):
        return [str(folder / one) if isinstance(one, str) else one for one in value]
    return str(folder / value)
