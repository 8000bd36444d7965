#!/usr/bin/env python3
"""Writes blade_casing.inp and blade_casing_mesh.inp: the tip of a blade beside a casing that is out of round. Public domain.

The axis of the machine runs along y; the casing's radius is 200 mm + a gap that has its least value before the blade's edge.
A radial load stretches the blade until a part of its tip touches."""
import math

from bricks import STEEL, Block, labels, write

AXIS, RADIUS, GAP, OVAL = -140.0, 200.0, 0.02, 0.3  # mm
BLADE, CASING = (8, 3, 10), (24, 6, 2)


def blade_at(a, b, c):
    """Chord along x, thickness along y, height along z; the tip is ground to the radius of the round casing."""
    x, y = -15 + 30 * a, -2 + 4 * b
    return x, y, c * (AXIS + math.sqrt(RADIUS**2 - x * x))


def casing_at(a, b, c):
    angle = math.radians(-9 + 18 * a)
    radius = RADIUS + GAP + OVAL * (1 - math.cos(2 * (angle - math.radians(4)))) / 2 + 5 * c
    return radius * math.sin(angle), -8 + 16 * b, AXIS + radius * math.cos(angle)


def main():
    blade, casing = Block(BLADE, blade_at), Block(CASING, casing_at, 1001, 1001)
    mesh = blade.lines("BLADE") + casing.lines("CASING")
    mesh += ["*ELSET, ELSET=BOTH", "BLADE, CASING", *STEEL, "*SOLID SECTION, ELSET=BOTH, MATERIAL=STEEL"]
    (nx, ny, nz), (mx, my, mz) = BLADE, CASING
    mesh += labels("TIPCELLS", "ELSET", [blade.element(i, j, nz - 1) for i in range(nx) for j in range(ny)])
    mesh += labels("INNERCELLS", "ELSET", [casing.element(i, j, 0) for i in range(mx) for j in range(my)])
    mesh += ["*SURFACE, NAME=TIPFACE, TYPE=ELEMENT", "TIPCELLS, S2", "*SURFACE, NAME=INNER, TYPE=ELEMENT", "INNERCELLS, S1"]
    mesh += labels("ROOT", "NSET", [blade.node(i, j, 0) for i in range(nx + 1) for j in range(ny + 1)])
    mesh += labels("ENDS", "NSET", [casing.node(i, j, k) for i in (0, mx) for j in range(my + 1) for k in range(mz + 1)])
    mesh += labels("TIPNODES", "NSET", [blade.node(i, j, nz) for i in range(nx + 1) for j in range(ny + 1)])
    mesh += labels("EDGE", "NSET", [blade.node(nx, ny // 2, nz)]) + ["*BOUNDARY", "ROOT, 1, 3", "ENDS, 1, 3"]
    write("blade_casing_mesh.inp", ["** A blade beside a casing: mesh, material, supports. mm, N, t. Public domain.", *mesh])
    write("blade_casing.inp", [
        "*HEADING", "A blade whose tip touches a casing that is out of round. Public domain.",
        "*INCLUDE, INPUT=blade_casing_mesh.inp",
        "*SURFACE INTERACTION, NAME=RUB", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", "1.e5, 1.e-3, 1.e-3",
        "*CONTACT PAIR, INTERACTION=RUB, TYPE=NODE TO SURFACE", "TIPFACE, INNER",
        "*STEP, NAME=SPIN", "*STATIC", "*CLOAD", "TIPNODES, 3, 400.", "*END STEP",
        "*STEP, NAME=MODES", "*FREQUENCY, STORAGE=YES", "10", "*END STEP",
        "*STEP, NAME=DRIVE", "*STEADY STATE DYNAMICS", "100., 3000., 20, 3.", "*MODAL DAMPING", "1, 10, 0.01",
        "*CLOAD", "EDGE, 1, 10.", "*END STEP"])


if __name__ == "__main__":
    main()
