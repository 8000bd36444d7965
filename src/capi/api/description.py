"""src/capi/api.txt as it stands; plm_api compares it with the header. The file itself tells how it is written."""
import pathlib
import re
from dataclasses import dataclass, field

LAYERS = ("FORTRAN 77", "module plm", "Python")


@dataclass
class Described:
    """What is said of one argument."""
    name: str
    size: str
    optional: bool
    is_inout: bool
    is_position: bool


@dataclass
class Subroutine:
    """A subroutine of the FORTRAN 77 layer."""
    name: str
    arguments: list
    is_by_hand: bool
    text: str = ""


@dataclass
class Entry:
    """What is said of one function, or of one line of constants."""
    where: str = ""  # file and line, for messages
    arguments: dict = field(default_factory=dict)  # name: Described
    subroutines: list = field(default_factory=list)
    left_out: dict = field(default_factory=dict)  # layer: reason
    by_rule: list = field(default_factory=list)  # layers whose method is generated


@dataclass
class Section:
    """A heading of plmf.inc and what stands below it."""
    title: str
    functions: list = field(default_factory=list)  # names
    constants: list = field(default_factory=list)  # (name, six letters or "", Entry)


class Description:
    def __init__(self, path):
        self.file = pathlib.Path(path).name
        self.dimensions, self.positions, self.letters, self.everywhere = [], [], {}, {}
        self.basic = {}  # noun: options that most users need, which the reference shows first
        self.functions = {}  # name: Entry
        self.sections = []
        self.entry = None  # the one that the indented lines below it belong to
        for number, line in enumerate(pathlib.Path(path).read_text(encoding="utf-8").splitlines(), 1):
            self.where = f"{self.file}:{number}"
            if line.strip() and not line.startswith("#"):
                self.read_line(line)

    def fail(self, why):
        raise SystemExit(f"{self.where}: {why}")

    def read_line(self, line):
        if line.startswith(" "):
            self.read_indented(line)
        elif line.startswith("["):
            self.sections.append(Section(line.strip("[]")))
        elif line.startswith("PLM_"):
            self.read_constants(line)
        else:
            name, _, rest = (part.strip() for part in line.partition(":"))
            if name.startswith("plm_"):
                self.read_function(name, rest)
            else:
                self.read_list(name, rest)

    def read_list(self, name, rest):
        """A line that holds for the whole file."""
        words = [word.strip() for word in rest.split(",")]
        if name == "dimensions":
            self.dimensions = words
        elif name == "positions":
            self.positions = words
        elif name == "letters":
            self.letters = dict(word.split() for word in words)
        elif name == "everywhere":
            self.everywhere = self.read_arguments(rest)
        elif name.startswith("basic ") and name[6:] in self.letters:
            self.basic[name[6:]] = words
        else:
            self.fail(f"'{name}' is neither a function nor a constant")

    def read_function(self, name, rest):
        if name in self.functions:
            self.fail(f"{name} is described a second time")
        self.entry = self.functions[name] = Entry(self.where, self.read_arguments(rest))
        self.sections[-1].functions.append(name)

    def read_constants(self, line):
        self.entry = Entry(self.where)
        for part in re.split(r",\s*", line):
            name, _, six = part.partition(" ")
            self.sections[-1].constants.append((name, six, self.entry))

    def read_arguments(self, text):
        """{name: Described} of "a[n + 1], inout x?"."""
        found = {}
        for part in filter(None, re.split(r",\s*", text)):
            match = re.fullmatch(r"(inout |position )?(\w+)(?:\[(.+)\])?(\?)?", part)
            if not match:
                self.fail(f"'{part}' cannot be read; an argument is described like name, name[size] or name?")
            found[match[2]] = Described(match[2], match[3] or "", bool(match[4]), match[1] == "inout ", match[1] == "position ")
        return found

    def read_indented(self, line):
        """A subroutine, what is said of it, a layer that leaves the function out, or layers that have it by rule."""
        subroutine = re.fullmatch(r" {4}(PLM\w{3}) \(([\w, ]*)\)( by hand)?", line)
        left_out = re.fullmatch(rf" {{4}}not in ({'|'.join(LAYERS)}): (.+)", line)
        by_rule = re.fullmatch(r" {4}by rule in (.+)", line)
        if subroutine:
            arguments = [name.strip() for name in subroutine[2].split(",")]
            self.entry.subroutines.append(Subroutine(subroutine[1], arguments, bool(subroutine[3])))
        elif left_out:
            self.entry.left_out[left_out[1]] = left_out[2]
        elif by_rule and set(by_rule[1].split(", ")) <= set(LAYERS):
            self.entry.by_rule = by_rule[1].split(", ")
        elif line.startswith(" " * 8) and self.entry.subroutines:
            last = self.entry.subroutines[-1]
            last.text = f"{last.text} {line.strip()}".strip()
        else:
            self.fail(f"'{line.strip()}' cannot be read")
