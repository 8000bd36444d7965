#!/usr/bin/env python3
"""Writes lap_joint.inp and lap_joint_nonmatching.inp, each with its mesh: two beams, one on the other, joined by three bolts,
held nowhere. Public domain.

A bolt is a distributing coupling below its head and one below its nut, with a spring along the bolt and the pre-load between
them, and one on either side of the interface, with springs across: every spring joins two points that are opposite or the same,
so that no rigid motion strains it."""
from bricks import STEEL, Block, box, labels, write

BOLTS = ((140.0, 10.0), (160.0, 30.0), (180.0, 10.0))
RADIUS, PRELOAD, ALONG, ACROSS = 10.5, 8000.0, 4e5, 2e5  # mm, N, N/mm
BEHIND = "1.e-3, 1.e-3"  # what CalculiX wants behind the contact stiffness


def around(block, bolt, k):
    """Nodes of the block's layer k within the radius of a bolt."""
    return [block.node(i, j, k) for i in range(block.cells[0] + 1) for j in range(block.cells[1] + 1)
            if (block.coordinates_at(i, j, k)[0] - bolt[0])**2 + (block.coordinates_at(i, j, k)[1] - bolt[1])**2 <= RADIUS**2]


class Beam(Block):
    def coordinates_at(self, *at):
        return self.place(*(a / n for a, n in zip(at, self.cells)))


def bolt_lines(lower, upper):
    """Reference nodes, couplings and springs; element numbers from 9001 on, reference nodes from 5001 on."""
    nodes, couplings, springs = [], [], []
    for b, bolt in enumerate(BOLTS):
        head, nut, below, above = range(5001 + 4 * b, 5005 + 4 * b)
        for reference, block, k, z in ((nut, lower, 0, 0.0), (below, lower, lower.cells[2], 8.0), (above, upper, 0, 8.0),
                                       (head, upper, upper.cells[2], 16.0)):
            nodes.append(f"{reference}, {bolt[0]:g}, {bolt[1]:g}, {z:g}")
            couplings += [f"*ELEMENT, TYPE=DCOUP3D, ELSET=C{reference}", f"{reference + 4000}, {reference}",
                          f"*DISTRIBUTING COUPLING, ELSET=C{reference}"] + [f"{n}, 1." for n in around(block, bolt, k)]
        for direction, a, c, stiffness in ((3, nut, head, ALONG), (1, below, above, ACROSS), (2, below, above, ACROSS)):
            name = f"S{b + 1}{direction}"
            springs += [f"*ELEMENT, TYPE=SPRING2, ELSET={name}", f"{9500 + 3 * b + direction}, {a}, {c}",
                        f"*SPRING, ELSET={name}", f"{direction}, {direction}", f"{stiffness:e}"]
    return ["*NODE, NSET=BOLTS", *nodes, *couplings, *springs]


def joint(name, cells, rows, contact):
    """cells: of the upper beam along and across; rows: how many of them overlap the lower one; contact: stiffness, N/mm^3."""
    lower = Beam((20, 4, 2), box((0, 0, 0), (200, 40, 8)))
    upper = Beam((*cells, 2), box((120, 0, 8), (320, 40, 16)), 1001, 1001)
    mesh = lower.lines("LOWER") + upper.lines("UPPER")
    mesh += ["*ELSET, ELSET=BEAMS", "LOWER, UPPER", *STEEL, "*SOLID SECTION, ELSET=BEAMS, MATERIAL=STEEL"]
    mesh += labels("LOWERLAP", "ELSET", [lower.element(i, j, 1) for i in range(12, 20) for j in range(4)])
    mesh += labels("UPPERLAP", "ELSET", [upper.element(i, j, 0) for i in range(rows) for j in range(cells[1])])
    mesh += ["*SURFACE, NAME=LOWERFACE, TYPE=ELEMENT", "LOWERLAP, S2", "*SURFACE, NAME=UPPERFACE, TYPE=ELEMENT", "UPPERLAP, S1"]
    mesh += bolt_lines(lower, upper)
    mesh += labels("END", "NSET", [upper.node(cells[0], cells[1] // 2, 1)])
    write(f"{name}_mesh.inp", ["** Two beams and three bolts: mesh, material, couplings. mm, N, t. Public domain.", *mesh])
    loads = [line for b in range(3) for line in (f"{5001 + 4 * b}, 3, {-PRELOAD:g}", f"{5002 + 4 * b}, 3, {PRELOAD:g}")]
    write(f"{name}.inp", [
        "*HEADING", "A bolted lap joint, held nowhere, driven at one end. Public domain.", f"*INCLUDE, INPUT={name}_mesh.inp",
        "*SURFACE INTERACTION, NAME=LAP", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", f"{contact}, {BEHIND}",
        "*CONTACT PAIR, INTERACTION=LAP, TYPE=NODE TO SURFACE", "UPPERFACE, LOWERFACE",
        "*STEP, NAME=TIGHTEN", "*STATIC", "*CLOAD", *loads, "*END STEP",
        "*STEP, NAME=MODES", "*FREQUENCY, STORAGE=YES", "16", "*END STEP",
        "*STEP, NAME=DRIVE", "*STEADY STATE DYNAMICS", "100., 1000., 20, 3.", "*MODAL DAMPING", "1, 16, 0.01",
        "*CLOAD", "END, 3, 1.", "*END STEP"])


def main():
    joint("lap_joint", (20, 4), 8, "5.e3")
    joint("lap_joint_nonmatching", (25, 6), 10, "2.e4")


if __name__ == "__main__":
    main()
