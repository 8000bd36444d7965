"""Every setting of the command: one table, from which the options, the keys of case files and their description follow."""
import difflib
import math
from typing import NamedTuple

MEASURES = ("half_peak_to_peak", "peak", "rms")
SYSTEMS = ("open", "sliding", "rest")
ALL = ("response", "modes", "audit", "rest", "study")
LOADED = ("response", "audit", "study")  # what looks at an excitation


class Wrong(Exception):
    """The command is not meant so: what was given, and what to give instead."""


class Setting(NamedTuple):
    """name: key of a case file; with - in place of _ the option. kind: how a value is read. metavar: words of the option."""
    name: str
    kind: str
    default: object
    metavar: object
    commands: tuple
    text: str


SETTINGS = (
    Setting("model", "paths", None, "FILE", ALL, "a deck (.inp), or files with mass and stiffness matrices"),
    Setting("matrices", "paths", [], "FILE", ALL, "files with the matrices of a deck; without them CalculiX (ccx) makes them"),
    Setting("dofs", "path", None, "FILE", ALL, "what each row of the matrices is, where they do not say: lines node.direction"),
    Setting("mesh", "path", None, "FILE", ALL, "mesh of the nodes of matrices: Gmsh, VTU, MED, Nastran, ...; nodes count from 1"),
    Setting("coordinates", "path", None, "FILE", ALL, "CSV with the columns node, x, y, z, for matrices without a mesh"),
    Setting("contact", "pairs", [], "FILE", ALL, "CSV of contact pairs: node, direction, to_node, to_direction, gap, stiffness"),
    Setting("contact_stiffness", "positive", None, "K", ALL, "of the contact in a deck, by area; else the deck's or the library's"),
    Setting("search", "positive", None, "LENGTH", ALL, "how far partners in a deck's contact may be apart"),
    Setting("closed", "not_negative", None, "LENGTH", ALL, "gaps and interferences of a deck's contact up to this are none"),
    Setting("symmetric", "flag", False, None, ALL, "contact of a deck both ways, each side's nodes against the other's faces"),
    Setting("smooth", "flag", False, None, ALL, "normals and gaps of a deck's contact as of curved surfaces"),
    Setting("fix", "dofs", [], ("NODE", "DIRECTION"), ALL, "a support; DIRECTION all: every DOF of the node"),
    Setting("preload", "loads", [], ("NODE", "DIRECTION", "FORCE"), ALL, "a static force; in place of the deck's"),
    Setting("force", "loads", [], ("NODE", "DIRECTION", "AMPLITUDE"), LOADED,
            "a harmonic force AMPLITUDE cos(2 pi f t), in place of the deck's; in a case file its phase in degrees may stand behind it"),
    Setting("output", "dof", None, ("NODE", "DIRECTION"), ("response", "study"), "what is looked at; else where the first force acts"),
    Setting("measure", "words " + " ".join(MEASURES), MEASURES[0], "MEASURE", ("response", "study"),
            "of the amplitude: " + ", ".join(MEASURES)),
    Setting("damping_ratio", "share", None, "RATIO", LOADED, "share of critical damping of every mode"),
    Setting("loss_factor", "share", None, "ETA", LOADED, "structural damping, K (1 + i ETA)"),
    Setting("rayleigh", "pair", None, ("ALPHA", "BETA"), LOADED, "C = ALPHA M + BETA K, in 1/s and s"),
    Setting("frequency_min_hz", "positive", None, "HZ", ("response", "study"), "lower end of the curve; else found around the resonance"),
    Setting("frequency_max_hz", "positive", None, "HZ", ("response", "study"), "upper end of the curve"),
    Setting("accuracy", "accuracy", 1e-3, "SHARE", ("response", "study"), "relative error that the peak may have"),
    Setting("effort", "not_negative", None, "SECONDS", ("response", "study"), "work that a search may cost; 0: no limit; else 10"),
    Setting("threads", "count", 1, "N", ALL, "threads that the library may use"),
    Setting("save_every", "count", None, "N", ("response",), "points after which the curve is written to --out, for plm resume"),
    Setting("frames", "count", 24, "N", ("response",), "files of the .vtu series over the period"),
    Setting("count", "count", 10, "N", ("modes",), "natural frequencies"),
    Setting("system", "words " + " ".join(SYSTEMS), "open", "SYSTEM", ("modes",),
            "no pair closed (open), every one (sliding), those closed at rest (rest)"),
    Setting("harmonics", "counts", [3, 5, 9], "N", ("study",), "numbers of harmonics that are compared"),
    Setting("samples", "counts", [4], "N", ("study",), "numbers of contact samples that are compared"),
    Setting("repeats", "count", 1, "N", ("study",), "timed runs of each method"),
    Setting("length_unit", "words m mm um", "", "UNIT", ("response", "study"),
            "what the model counts lengths in, for the axes of pictures: m, mm or um; without it they name no unit"),
    Setting("out", "path", None, "FOLDER", ("response", "modes", "rest", "study"), "folder for the files, made where it is not there"),
)
BY_NAME = {setting.name: setting for setting in SETTINGS}


def settings_of(command):
    """Those that a command knows, in the order of the table; what goes on with a response knows what that does."""
    command = "response" if command == "resume" else command
    return [setting for setting in SETTINGS if command in setting.commands]


def settings_text(command, settings):
    """(name, value) of all that is not as it is by default."""
    return [(setting.name, settings[setting.name]) for setting in settings_of(command) if settings[setting.name] != setting.default]


def nearest(name, names):
    """'; did you mean ...?' with the nearest name, or which names there are."""
    near = difflib.get_close_matches(name, names, 1)
    return f"; did you mean {near[0]}?" if near else f"; there are {', '.join(names)}"


def value_of(setting, value):
    """A value from the command line (text, or a list of texts) or from a case file, as the command uses it."""
    kind, *words = setting.kind.split()
    if kind == "words":
        if value not in words:
            raise Wrong(f"{setting.name} is {value!r}{nearest(str(value), words)}")
        return value
    return _READERS[kind](setting.name, value)


def finite(name, value):
    """The number that a text or a value of a case file is."""
    try:
        number = float(value) if not isinstance(value, bool) else math.nan
    except (TypeError, ValueError, OverflowError):
        number = math.nan
    if not math.isfinite(number):
        raise Wrong(f"{name} is {value!r}; it must be a number")
    return number


def _bounded(low, high, words):
    def read(name, value):
        number = finite(name, value)
        if not low <= number <= high:
            raise Wrong(f"{name} is {number:g}; it must be {words}")
        return number
    return read


def _positive(name, value):
    number = finite(name, value)
    if number <= 0:
        raise Wrong(f"{name} is {number:g}; it must be above 0")
    return number


def _count(name, value):
    number = finite(name, value)
    if number != int(number) or not 1 <= number <= 10**6:
        raise Wrong(f"{name} is {value!r}; it must be a whole number from 1 on")
    return int(number)


def _list(read):
    def read_all(name, value):
        values = value if isinstance(value, list) else str(value).split(",") if isinstance(value, str) else [value]
        if not values:
            raise Wrong(f"{name} is empty; it needs one value at least")
        return [read(name, one) for one in values]
    return read_all


def _path(name, value):
    if not isinstance(value, str) or not value:
        raise Wrong(f"{name} is {value!r}; it must be the name of a file or folder")
    return value


def _paths(name, value):
    return [_path(name, one) for one in (value if isinstance(value, list) else [value])]


def _pair(name, value):
    if not isinstance(value, list) or len(value) != 2:
        raise Wrong(f"{name} is {value!r}; it needs two numbers")
    return [_bounded(0, math.inf, "0 or above")(name, one) for one in value]


def _row(name, value, least, most, words):
    if not isinstance(value, (list, tuple)) or not least <= len(value) <= most:
        raise Wrong(f"{name} is {value!r}; it must be {words}")
    return list(value)


def _rows(value):
    """One row or several of them: a case file may leave the outer brackets out."""
    return value if isinstance(value, list) and all(isinstance(row, (list, tuple)) for row in value) else [value]


def _dof(name, value):
    return _row(name, value, 2, 2, "a node and a direction, as 12 z")


def _dofs(name, value):
    return [_dof(name, row) for row in _rows(value)]


def _loads(name, value):
    loads = []
    for row in _rows(value):
        node, direction, *numbers = _row(name, row, 3, 4, "a node, a direction and an amplitude, as 12 z 0.5, and may have a phase")
        amplitude, phase = [finite(f"the amplitude of {name}", numbers[0]), 0.0]
        if len(numbers) == 2:
            phase = finite(f"the phase of {name}", numbers[1])
        loads.append((node, direction, amplitude, phase))
    return loads


def _pairs(name, value):
    """The name of a file, or tables of a case file."""
    if isinstance(value, str):
        return _path(name, value)
    if not isinstance(value, list) or not all(isinstance(row, dict) for row in value):
        raise Wrong(f"{name} is {value!r}; it must be the name of a CSV file or tables [[{name}]]")
    return value


def _flag(name, value):
    if not isinstance(value, bool):
        raise Wrong(f"{name} is {value!r}; it must be true or false")
    return value


_READERS = {"flag": _flag, "path": _path, "paths": _paths, "count": _count, "counts": _list(_count), "positive": _positive, "pair": _pair,
            "share": _bounded(0, 0.999, "from 0 to below 1"), "accuracy": _bounded(1e-8, 0.5, "from 1e-8 to 0.5"),
            "not_negative": _bounded(0, math.inf, "0 or above"), "dof": _dof, "dofs": _dofs, "loads": _loads, "pairs": _pairs}
