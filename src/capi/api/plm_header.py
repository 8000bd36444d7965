"""plm.h as data: its functions, callbacks, handles and constants, as C declares them. The only reader of the header."""
import pathlib
import re
from dataclasses import dataclass

ROOT = pathlib.Path(__file__).resolve().parents[3]
PATH = ROOT / "include/plm/plm.h"


@dataclass
class Argument:
    """An argument as C declares it; plm_api adds what C cannot say."""
    name: str
    type: str  # "const double *"
    base: str  # "double"
    stars: int
    is_const: bool
    intent: str = "in"  # "in", "out", "inout"
    size: str = ""  # of an array, in terms of the other arguments; "" for one value
    optional: bool = False  # may be NULL
    is_position: bool = False  # counts from 0 in C, from 1 in Fortran


@dataclass
class Function:
    """A function, or a type of callback. returns: "plm_status", "void", "void *", ..."""
    name: str
    returns: str
    arguments: list
    comment: str = ""  # that stands right above it

    @property
    def noun(self):
        """The kind of handle it belongs to by its name, "model" of plm_model_build."""
        return self.name.split("_")[1]

    @property
    def told_sizes(self):
        """{argument that is the size of an array: that array}"""
        names = {argument.name for argument in self.arguments}
        return {argument.size: argument.name for argument in self.arguments if argument.size in names}


@dataclass
class Header:
    functions: list
    callbacks: list
    handles: list  # "plm_context", ...
    constants: dict  # name: value as text, without brackets


def read_argument(text):
    text = " ".join(text.split())
    match = re.fullmatch(r"(const )?(\w+) ?(\*?)( ?const )?(\*?) ?(\w+)", text)
    if not match:
        raise SystemExit(f"plm.h: the parameter '{text}' cannot be read")
    return Argument(name=match[6], type=text[:-len(match[6])].strip(), base=match[2], stars=len(match[3] + match[5]),
                    is_const=bool(match[1] or match[4]))


def read_arguments(text):
    return [read_argument(part) for part in text.split(",")]


def read_comments(text):
    """{function: the words of the comment right above it}"""
    return {name: " ".join(re.sub(r"^ \*", "", comment, flags=re.M).split()) for comment, name in
            re.findall(r"^/\*((?:(?!\*/).)*)\*/\nPLM_API\s+\w+\s+(plm_\w+)", text, re.S | re.M)}


def read(path=PATH):
    """Everything the header declares, in its order."""
    text = pathlib.Path(path).read_text(encoding="utf-8")
    comments = read_comments(text)
    text = re.sub(r"/\*.*?\*/", " ", text, flags=re.S)
    functions = [Function(name, returns, read_arguments(arguments), comments.get(name, "")) for returns, name, arguments in
                 re.findall(r"PLM_API\s+(\w+)\s+(plm_\w+)\s*\(([^;]*?)\)\s*;", text)]
    callbacks = [Function(name, " ".join(returns.split()), read_arguments(arguments)) for returns, name, arguments in
                 re.findall(r"typedef\s+(\w+\s*\*?)\s*\(\*(plm_\w+)\)\s*\(([^;]*?)\)\s*;", text)]
    macros = re.findall(r"^#define[ \t]+(PLM_\w+)[ \t]+\(?(\S.*?)\)?[ \t]*$", text, re.M)
    if len(functions) != len(re.findall(r"^PLM_API\b", text, re.M)) or len(functions) < 90:
        raise SystemExit(f"{path}: a declaration could not be read")
    return Header(functions, callbacks, re.findall(r"typedef struct (plm_\w+) \1;", text),
                  {name: value for name, value in macros if name != "PLM_API"})
