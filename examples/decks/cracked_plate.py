#!/usr/bin/env python3
"""Writes cracked_plate.inp and cracked_plate_mesh.inp: a clamped plate with a crack across half its width. Public domain.

Pinching forces hold a part of the crack closed; the free end is driven in the plane of the plate."""
from bricks import STEEL, Block, box, labels, write

LENGTH, WIDTH, THICKNESS = 150.0, 60.0, 5.0
NX, NY, NZ, CRACKED = 20, 12, 2, 6  # cells; rows of them that the crack separates


def main():
    left = Block((NX // 2, NY, NZ), box((0, 0, 0), (LENGTH / 2, WIDTH, THICKNESS)))
    right = Block((NX // 2, NY, NZ), box((LENGTH / 2, 0, 0), (LENGTH, WIDTH, THICKNESS)), 1001, 1001)
    i, kept = NX // 2, range(NY - CRACKED + 1)
    merged = {right.node(0, j, k): left.node(i, j, k) for j in kept for k in range(NZ + 1)}
    mesh = left.lines("LEFT")
    for line in right.lines("RIGHT"):
        fields = line.split(", ")
        if fields[0].isdigit() and len(fields) == 4 and int(fields[0]) in merged:
            continue  # a node of both halves
        if fields[0].isdigit() and len(fields) == 9:
            line = ", ".join(fields[:1] + [str(merged.get(int(n), int(n))) for n in fields[1:]])
        mesh.append(line)
    rows = range(NY - CRACKED, NY)
    mesh += ["*ELSET, ELSET=PLATE", "LEFT, RIGHT", *STEEL, "*SOLID SECTION, ELSET=PLATE, MATERIAL=STEEL"]
    mesh += labels("CLAMPED", "NSET", [left.node(0, j, k) for j in range(NY + 1) for k in range(NZ + 1)])
    mesh += labels("NEAR", "ELSET", [left.element(i - 1, j, k) for j in rows for k in range(NZ)])
    mesh += labels("FAR", "ELSET", [right.element(0, j, k) for j in rows for k in range(NZ)])
    mesh += ["*SURFACE, NAME=NEARLIP, TYPE=ELEMENT", "NEAR, S4", "*SURFACE, NAME=FARLIP, TYPE=ELEMENT", "FAR, S6"]
    mesh += labels("TIP", "NSET", [right.node(NX // 2, NY // 2, NZ // 2)]) + ["*BOUNDARY", "CLAMPED, 1, 3"]
    write("cracked_plate_mesh.inp", ["** A cracked plate: mesh, material, support. mm, N, t. Public domain.", *mesh])
    loads = []
    for k in range(NZ + 1):
        share = (0.5 if k in (0, NZ) else 1.0) / NZ
        for node, fx in ((left.node(i, NY, k), 2000), (right.node(0, NY, k), -2000)):
            loads += [f"{node}, 1, {share * fx:g}", f"{node}, 2, {share * -1200:g}"]
    write("cracked_plate.inp", [
        "*HEADING", "A cracked plate, pinched at the mouth of the crack and driven at its free end. Public domain.",
        "*INCLUDE, INPUT=cracked_plate_mesh.inp",
        "*SURFACE INTERACTION, NAME=LIPS", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", "1.e5, 1.e-3, 1.e-3",
        "*CONTACT PAIR, INTERACTION=LIPS, TYPE=NODE TO SURFACE", "NEARLIP, FARLIP",
        "*STEP, NAME=PINCH", "*STATIC", "*CLOAD", *loads, "*END STEP",
        "*STEP, NAME=MODES", "*FREQUENCY, STORAGE=YES", "10", "*END STEP",
        "*STEP, NAME=DRIVE", "*STEADY STATE DYNAMICS", "100., 1000., 20, 3.", "*MODAL DAMPING", "1, 10, 0.01",
        "*CLOAD", "TIP, 2, 10.", "*END STEP"])


if __name__ == "__main__":
    main()
