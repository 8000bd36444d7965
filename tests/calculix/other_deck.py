#!/usr/bin/env python3
"""other_deck.py FILE: a deck that is like no example: surface to surface with a stiffness that the library chooses, a rigid body with a
point mass on its reference node, a tie, an equation, damping by the material."""
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "examples", "decks"))
from bricks import Block, box, labels  # noqa: E402 (the folder of the generators)


def lines():
    lower = Block((8, 2, 2), box((0, 0, 0), (80, 16, 5)))
    upper = Block((7, 3, 2), box((45, 0, 5), (115, 16, 10)), 1001, 1001)
    stub = Block((2, 2, 2), box((80, 3, 10), (95, 13, 16)), 2001, 2001)
    clamped = ([lower.node(0, j, k) for j in range(3) for k in range(3)]
               + [upper.node(7, j, k) for j in range(4) for k in range(3)])
    end = [lower.node(8, j, k) for j in range(3) for k in range(3)]
    deck = ["*HEADING", "Two cantilevers, one on the other.", *lower.lines("LOWER"), *upper.lines("UPPER"), *stub.lines("STUB", "C3D8")]
    deck += ["*ELSET, ELSET=ALL", "LOWER, UPPER, STUB", "*MATERIAL, NAME=ALU", "*ELASTIC", "70000., 0.33", "*DENSITY", "2.7e-9",
             "*DAMPING, ALPHA=30., BETA=1.e-6", "*SOLID SECTION, ELSET=ALL, MATERIAL=ALU"]
    deck += labels("CLAMP", "NSET", clamped) + labels("END", "NSET", end)
    deck += ["*NODE", "5001, 80., 8., 2.5", "5002, 80., 8., 2.5", "*RIGID BODY, NSET=END, REF NODE=5001, ROT NODE=5002",
             "*ELEMENT, TYPE=MASS, ELSET=WEIGHT", "9001, 5001", "*MASS, ELSET=WEIGHT", "5.e-6"]
    deck += labels("ABOVE", "ELSET", [lower.element(i, j, 1) for i in range(4, 8) for j in range(2)])
    deck += labels("BELOW", "ELSET", [upper.element(i, j, 0) for i in range(4) for j in range(3)])
    deck += labels("ROOF", "ELSET", [upper.element(i, j, 1) for i in range(7) for j in range(3)])
    deck += labels("FOOT", "ELSET", [stub.element(i, j, 0) for i in range(2) for j in range(2)])
    for name, face in (("ABOVE", "S2"), ("BELOW", "S1"), ("ROOF", "S2"), ("FOOT", "S1")):
        deck += [f"*SURFACE, NAME=F{name}, TYPE=ELEMENT", f"{name}, {face}"]
    deck += ["*TIE, NAME=GLUE, POSITION TOLERANCE=0.1", "FFOOT, FROOF",
             "*EQUATION", "2", f"{lower.node(4, 0, 1)}, 2, 1., {lower.node(4, 2, 1)}, 2, -1.",
             "*SURFACE INTERACTION, NAME=TOUCH", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD",
             "*CONTACT PAIR, INTERACTION=TOUCH, TYPE=SURFACE TO SURFACE", "FBELOW, FABOVE",
             "*BOUNDARY", "CLAMP, 1, 3"]
    return deck + ["*STEP", "*STATIC", "*CLOAD", f"{upper.node(3, 1, 2)}, 3, -40.", f"{upper.node(3, 2, 2)}, 3, -40.", "*END STEP",
                   "*STEP", "*STEADY STATE DYNAMICS", "100., 2000., 20, 3.", "*CLOAD", "5001, 3, 0.2", "*END STEP"]


if __name__ == "__main__":
    with open(sys.argv[1], "w", encoding="ascii") as out:
        out.write("\n".join(lines()) + "\n")
