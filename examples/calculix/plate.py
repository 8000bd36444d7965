#!/usr/bin/env python3
"""Writes the CalculiX decks of a cracked plate and, for the host program, what ccx does not put into its files.

    plate.py FOLDER [--nx 20 --ny 16 --nz 2 --crack-rows 8 --contact-stiffness 2e5]

plate.inp     mesh (C3D8I), material, clamped end; included by the three decks
open.inp      natural frequencies without any contact
closed.inp    the same with a linear spring of stiffness k_n between the nodes of every pair, along its normal
matrices.inp  K and M of the open plate, without the clamped DOFs: matrices.sti, .mas and .dof
plate.txt     contact pairs, pre-load, harmonic force: one per line, see "plate.txt" below

Units: mm, N, t (N s2/mm), hence MPa and Hz.
"""
import argparse
import os

LENGTH, WIDTH, THICKNESS = 150.0, 60.0, 5.0
YOUNG, POISSON, DENSITY = 2e5, 0.3, 7.8e-9
N_FREQUENCIES = 20  # the host compares half of them: ARPACK has converged the lower ones far better


class Plate:
    """nx x ny x nz bricks, clamped at x = 0; the crack at mid length runs down from y = WIDTH."""

    def __init__(self, nx, ny, nz, crack_rows):
        self.nx, self.ny, self.nz = nx, ny, nz
        self.crack_i, self.crack_j = nx // 2, ny + 1 - crack_rows
        self.n_grid = (nx + 1) * (ny + 1) * (nz + 1)

    def node(self, i, j, k):
        """The grid's node, numbered from 1: on the crack the one of its near lip (x < 75)."""
        return (i * (self.ny + 1) + j) * (self.nz + 1) + k + 1

    def node_beyond(self, i, j, k):
        """The node which the bricks beyond the crack use: its double on the crack."""
        if i == self.crack_i and j >= self.crack_j:
            return self.n_grid + (j - self.crack_j) * (self.nz + 1) + k + 1
        return self.node(i, j, k)

    def coordinates(self):
        """{node: (x, y, z)}"""
        xyz = {}
        for i in range(self.nx + 1):
            for j in range(self.ny + 1):
                for k in range(self.nz + 1):
                    at = (LENGTH * i / self.nx, WIDTH * j / self.ny, THICKNESS * k / self.nz)
                    xyz[self.node(i, j, k)] = xyz[self.node_beyond(i, j, k)] = at
        return dict(sorted(xyz.items()))

    def bricks(self):
        corners = ((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1))
        for i in range(self.nx):
            node = self.node if i < self.crack_i else self.node_beyond
            for j in range(self.ny):
                for k in range(self.nz):
                    yield [node(i + a, j + b, k + c) for a, b, c in corners]

    def pairs(self):
        """(node of the near lip, node of the far lip)"""
        return [(self.node(self.crack_i, j, k), self.node_beyond(self.crack_i, j, k))
                for j in range(self.crack_j, self.ny + 1) for k in range(self.nz + 1)]


def write(folder, name, lines):
    with open(os.path.join(folder, name), "w", encoding="ascii") as out:
        out.write("\n".join(lines) + "\n")


def mesh_lines(plate):
    bricks = list(plate.bricks())
    clamped = [plate.node(0, j, k) for j in range(plate.ny + 1) for k in range(plate.nz + 1)]
    return (["*NODE, NSET=ALL"] + [f"{n}, {x:.12g}, {y:.12g}, {z:.12g}" for n, (x, y, z) in plate.coordinates().items()]
            + ["*ELEMENT, TYPE=C3D8I, ELSET=PLATE"]
            + [f"{e}, " + ", ".join(map(str, nodes)) for e, nodes in enumerate(bricks, 1)]
            + ["*MATERIAL, NAME=STEEL", "*ELASTIC", f"{YOUNG:g}, {POISSON:g}", "*DENSITY", f"{DENSITY:g}",
               "*SOLID SECTION, ELSET=PLATE, MATERIAL=STEEL", "*BOUNDARY"] + [f"{n}, 1, 3" for n in clamped])


def spring_lines(plate, stiffness):
    first = plate.nx * plate.ny * plate.nz + 1
    return (["*ELEMENT, TYPE=SPRING2, ELSET=CONTACT"]
            + [f"{e}, {a}, {b}" for e, (a, b) in enumerate(plate.pairs(), first)]
            # ccx tells the line of directions from the one of the stiffness by the decimal point
            + ["*SPRING, ELSET=CONTACT", "1, 1", f"{stiffness:.12e}"])


def step_lines(*frequency):
    return ["*STEP", *frequency, "*END STEP"]


def load_lines(plate):
    """Pre-load: oblique forces pinch the lips at the crack's mouth and bend the plate open below, so that a part of the
    pairs is closed at rest. Excitation: 1 N in the plane at the middle of the free end."""
    lines = []
    for k in range(plate.nz + 1):
        share = (0.5 if k in (0, plate.nz) else 1.0) / plate.nz
        for node, fx in ((plate.node(plate.crack_i, plate.ny, k), 2000),
                         (plate.node_beyond(plate.crack_i, plate.ny, k), -2000)):
            lines += [f"preload {node} 1 {share * fx:.12g}", f"preload {node} 2 {share * -1200:.12g}"]
    return lines + [f"force {plate.node(plate.nx, plate.ny // 2, plate.nz // 2)} 2 1"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder")
    parser.add_argument("--nx", type=int, default=20)
    parser.add_argument("--ny", type=int, default=16)
    parser.add_argument("--nz", type=int, default=2)
    parser.add_argument("--crack-rows", type=int, default=8)
    parser.add_argument("--contact-stiffness", type=float, default=2e5, help="k_n of every pair, N/mm")
    options = parser.parse_args()
    if options.nx < 2 or options.nz < 1 or not 0 < options.crack_rows < options.ny:
        parser.error("at least 2 x 2 x 1 bricks, and 0 < crack rows < ny")
    plate = Plate(options.nx, options.ny, options.nz, options.crack_rows)
    stiffness = options.contact_stiffness

    include = ["*INCLUDE, INPUT=plate.inp"]
    frequencies = step_lines("*FREQUENCY", str(N_FREQUENCIES))
    write(options.folder, "plate.inp", mesh_lines(plate))
    write(options.folder, "open.inp", include + frequencies)
    write(options.folder, "closed.inp", include + spring_lines(plate, stiffness) + frequencies)
    write(options.folder, "matrices.inp", include + step_lines("*FREQUENCY, SOLVER=MATRIXSTORAGE"))
    # plate.txt: "pair node_a node_b nx ny nz k_n" (normal from a to b), "preload node direction value" and
    # "force node direction value", direction 1, 2, 3 as in ccx
    write(options.folder, "plate.txt",
          [f"pair {a} {b} 1 0 0 {stiffness:.12g}" for a, b in plate.pairs()] + load_lines(plate))


if __name__ == "__main__":
    main()
