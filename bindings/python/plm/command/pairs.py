"""Contact pairs of matrices: u = motion of a DOF less that of another one - gap, > 0 closed."""
from typing import NamedTuple

from ..fe.errors import FileError
from .nodes import direction_of
from .settings import Wrong, finite, nearest
from .tables import read_table

COLUMNS = ("node", "direction", "to_node", "to_direction", "gap", "stiffness")


class Pair(NamedTuple):
    """sign: +1, or -1 where it closes against the direction. to: (node, direction) of the other side, None: rigid ground.
    stiffness: None: chosen by the library."""
    node: int
    direction: int
    sign: float
    to: object
    gap: float
    stiffness: object


def read_pairs(given):
    """A list of Pair, from the name of a CSV file or the tables of a case file."""
    if isinstance(given, str):
        pairs = []
        for line, row in read_table(given, COLUMNS[:2], COLUMNS[2:]):
            try:
                pairs.append(_pair({name: text for name, text in row.items() if text != ""}))
            except Wrong as wrong:
                raise FileError(given, line, str(wrong)) from None
        return pairs
    return [_pair(row) for row in given]


def _pair(row):
    for name in row:
        if name not in COLUMNS:
            raise Wrong(f"contact: {name} is unknown{nearest(name, COLUMNS)}")
    for name in COLUMNS[:2]:
        if name not in row:
            raise Wrong(f"contact: a pair needs {name}; it has {', '.join(row) or 'nothing'}")
    text = str(row["direction"]).strip()
    sign = -1.0 if text.startswith("-") else 1.0
    direction = direction_of(text.lstrip("+-"), "contact")
    to = None
    if "to_node" in row:
        to = (_node(row["to_node"]), direction_of(str(row.get("to_direction", direction)).strip().lstrip("+-"), "contact"))
    elif "to_direction" in row:
        raise Wrong("contact: to_direction stands without to_node")
    stiffness = _number(row, "stiffness", None)
    if stiffness is not None and not stiffness > 0:
        raise Wrong(f"contact: stiffness is {stiffness:g}; it must be above 0, or left out")
    return Pair(_node(row["node"]), direction, sign, to, _number(row, "gap", 0.0), stiffness)


def _node(value):
    try:
        if isinstance(value, str) or isinstance(value, int) and not isinstance(value, bool):
            return int(value)
    except ValueError:
        pass
    raise Wrong(f"contact: {value!r} is no node; a whole number is needed")


def _number(row, name, default):
    if name not in row:
        return default
    return finite(f"contact: {name}", row[name])
