"""The whole API as data: what plm.h declares, with what src/capi/api.txt adds. Whoever generates or checks reads it here.

    api = plm_api.read()        functions, callbacks, handles, constants; every pointer with its intent and its size

Stops with a sentence where a pointer is not described, and where the description names what does not exist."""
import pathlib
import re
from dataclasses import dataclass

import plm_header
from plm_header import PATH as HEADER
from plm_header import ROOT

DESCRIPTION = ROOT / "src/capi/api.txt"
NUMBERS = ("int32_t", "int64_t", "double", "plm_status")


@dataclass
class Described:
    """What the description says of one argument."""
    name: str
    size: str
    optional: bool
    is_inout: bool


class Description:
    """api.txt as it stands, not yet compared with the header."""

    def __init__(self, path):
        self.place = pathlib.Path(path).name
        self.dimensions = []
        self.everywhere = {}
        self.functions = {}  # name: {argument: Described}
        self.lines = {}  # name: where it stands, for messages
        for number, line in enumerate(pathlib.Path(path).read_text(encoding="utf-8").splitlines(), 1):
            if line.strip() and not line.startswith("#"):
                self.read_line(line, f"{self.place}:{number}")

    def read_line(self, line, where):
        name, _, rest = (part.strip() for part in line.partition(":"))
        if name == "dimensions":
            self.dimensions += [word.strip() for word in rest.split(",")]
        elif name == "everywhere":
            self.everywhere.update(self.read_arguments(rest, where))
        elif name in self.functions:
            raise SystemExit(f"{where}: {name} is described a second time")
        else:
            self.functions[name] = self.read_arguments(rest, where)
            self.lines[name] = where

    def read_arguments(self, text, where):
        """{name: Described} of "a[n + 1], inout x?"."""
        found = {}
        for part in filter(None, re.split(r",\s*", text)):
            match = re.fullmatch(r"(inout )?(\w+)(?:\[(.+)\])?(\?)?", part)
            if not match:
                raise SystemExit(f"{where}: '{part}' cannot be read; an argument is described like name, name[size] or name?")
            found[match[2]] = Described(match[2], match[3] or "", bool(match[4]), bool(match[1]))
        return found


@dataclass
class Api:
    functions: list
    callbacks: list
    handles: list
    constants: dict

    def is_handle(self, argument):
        return argument.base in self.handles

    def is_callback(self, argument):
        return argument.base in {callback.name for callback in self.callbacks}


def without_width(name):
    """plm_x of plm_x_i32 and plm_x_i64, which are described once."""
    return re.sub(r"_i(32|64)$", "", name)


def needs_description(argument):
    """C does not tell one number from many, nor whether there may be none. A text with a length is as numbers are."""
    if argument.base in NUMBERS:
        return argument.stars > 0
    return argument.base == "char" and not argument.is_const or argument.stars == 2 and argument.is_const


def apply(function, own, description):
    """Completes the arguments of a function by what its own line and the names used everywhere say."""
    where = description.lines.get(without_width(function.name), description.place)
    for name in own.keys() - {argument.name for argument in function.arguments}:
        raise SystemExit(f"{where}: {function.name} has no argument '{name}'")
    for argument in function.arguments:
        said = own.get(argument.name)
        if not said and needs_description(argument):
            said = description.everywhere.get(argument.name)
            if not said:
                raise SystemExit(f"{function.name}: {argument.type} {argument.name} is not described: one value, or an array "
                                 f"of which size? Say it in {description.place}")
        if argument.stars and not argument.is_const and (argument.stars == 2 or needs_description(argument)):
            argument.intent = "inout" if function.name.endswith("_destroy") or said and said.is_inout else "out"
        if said:
            argument.size, argument.optional = said.size, said.optional
            check_size(function, argument, description.dimensions, where)


def check_size(function, argument, dimensions, where):
    known = {other.name for other in function.arguments} | set(dimensions) | {"or"}
    for word in re.findall(r"[A-Za-z_]\w*", argument.size):
        if word not in known:
            raise SystemExit(f"{where}: {function.name}: {argument.name}[{argument.size}]: '{word}' is neither an argument nor "
                             "one of the dimensions")
    if argument.size and not argument.stars:
        raise SystemExit(f"{where}: {function.name}: {argument.name} is no pointer, so it is no array")


def read(header=HEADER, description=DESCRIPTION):
    declared, said = plm_header.read(header), Description(description)
    functions = declared.functions + declared.callbacks
    names = {without_width(function.name) for function in functions}
    for name in said.functions:
        if name not in names:
            raise SystemExit(f"{said.lines[name]}: plm.h has no function {name}")
    for function in functions:
        apply(function, said.functions.get(without_width(function.name), {}), said)
    for name in said.everywhere.keys() - {argument.name for function in functions for argument in function.arguments}:
        raise SystemExit(f"{said.place}: everywhere: no function has an argument '{name}'")
    return Api(declared.functions, declared.callbacks, declared.handles, declared.constants)
