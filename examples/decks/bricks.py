"""Blocks of bricks as lines of a deck; what the generators beside this file share. Public domain."""
import os

CORNERS = ((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1))
STEEL = ["*MATERIAL, NAME=STEEL", "*ELASTIC", "210000., 0.3", "*DENSITY", "7.85e-9"]  # mm, N, t: MPa and Hz


class Block:
    """nx x ny x nz bricks; place(a, b, c) gives x, y, z of a point of the unit cube. Nodes and elements number on from
    first_node and first_element."""

    def __init__(self, cells, place, first_node=1, first_element=1):
        self.cells, self.place, self.first_node, self.first_element = cells, place, first_node, first_element

    def node(self, i, j, k):
        return self.first_node + (i * (self.cells[1] + 1) + j) * (self.cells[2] + 1) + k

    def element(self, i, j, k):
        return self.first_element + (i * self.cells[1] + j) * self.cells[2] + k

    def grid(self):
        nx, ny, nz = self.cells
        return [(i, j, k) for i in range(nx + 1) for j in range(ny + 1) for k in range(nz + 1)]

    def coordinates(self):
        """{node: (x, y, z)}"""
        return {self.node(*at): self.place(*(a / n for a, n in zip(at, self.cells))) for at in self.grid()}

    def lines(self, name, kind="C3D8I"):
        nx, ny, nz = self.cells
        cells = [(i, j, k) for i in range(nx) for j in range(ny) for k in range(nz)]
        return ([f"*NODE, NSET={name}"] + [f"{n}, {x:.10g}, {y:.10g}, {z:.10g}" for n, (x, y, z) in self.coordinates().items()]
                + [f"*ELEMENT, TYPE={kind}, ELSET={name}"]
                + [f"{self.element(*at)}, " + ", ".join(str(self.node(*(a + c for a, c in zip(at, corner)))) for corner in CORNERS)
                   for at in cells])


def box(low, high):
    """A straight block."""
    return lambda *at: tuple(a + (b - a) * t for a, b, t in zip(low, high, at))


def labels(name, keyword, items):
    """*NSET or *ELSET with eight labels a line."""
    items = list(items)
    return [f"*{keyword}, {keyword}={name}"] + [", ".join(map(str, items[i:i + 8])) for i in range(0, len(items), 8)]


def write(name, lines):
    with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), name), "w", encoding="ascii") as out:
        out.write("\n".join(lines) + "\n")
