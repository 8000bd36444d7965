"""Ties, couplings, rigid bodies and equations of decks by deck.model() and by CalculiX: two blocks whose meshes do not match."""
import os
import sys
import warnings

import numpy
import plm

import calculix_runs
from plm.fe import FileError, read_deck

sys.path.insert(0, calculix_runs.DECKS)
from bricks import STEEL, Block, box, labels  # noqa: E402

LOWER = Block((4, 2, 2), box((0, 0, 0), (4, 2, 1)))
UPPER = Block((3, 2, 2), box((0, 0, 1), (4, 2, 2)), 101, 101)
TIE = ["*TIE, NAME=T, POSITION TOLERANCE=0.1", "UNDER, OVER"]


def blocks():
    """The lower one clamped at its bottom, the upper one loose."""
    below = [LOWER.node(i, j, 0) for i in range(5) for j in range(3)]
    return (LOWER.lines("LOWER") + UPPER.lines("UPPER")
            + ["*NODE, NSET=REFERENCES", "1001, 2., 1., 1.", "1002, 2., 1., 1.", "1003, 2., 1., 3."]
            + ["*ELSET, ELSET=BOTH", "LOWER, UPPER", *STEEL, "*SOLID SECTION, ELSET=BOTH, MATERIAL=STEEL"]
            + labels("BOTTOM", "NSET", below)
            + labels("UNDERNODES", "NSET", [UPPER.node(i, j, 0) for i in range(4) for j in range(3)])
            + labels("TOPNODES", "NSET", [UPPER.node(i, j, 2) for i in range(4) for j in range(3)])
            + labels("A", "ELSET", [LOWER.element(i, j, 1) for i in range(4) for j in range(2)])
            + labels("B", "ELSET", [UPPER.element(i, j, 0) for i in range(3) for j in range(2)])
            + labels("C", "ELSET", [UPPER.element(i, j, 1) for i in range(3) for j in range(2)])
            + ["*SURFACE, NAME=OVER", "A, S2", "*SURFACE, NAME=UNDER", "B, S1", "*SURFACE, NAME=TOP", "C, S2", "*BOUNDARY", "BOTTOM, 1, 3"])


def ends():
    """(node of the upper block, the one of the lower block at its place)."""
    return [(UPPER.node(i, j, 0), LOWER.node(k, j, 2)) for i, k in ((0, 0), (3, 4)) for j in range(3)]


class Constraints(calculix_runs.Case):
    def model(self, lines, **options):
        path = os.path.join(self.folder, "deck.inp")
        with open(path, "w", encoding="ascii") as file:
            file.write("\n".join(lines) + "\n")
        self.deck = read_deck(path)
        self.assertEqual(self.deck.unread, [])
        return self.deck.model(**options)

    def compare(self, *constraints, by_calculix=None):
        got = self.model(blocks() + list(constraints)).modes(8)
        want = self.frequencies(blocks() + list(by_calculix or constraints), 16)[:8]
        numpy.testing.assert_allclose(got, want, rtol=1e-6)  # seven digits are printed

    def test_ties_name_the_nodes_of_the_deck(self):
        """What the library counts from 0 comes back as labels, with the line of the tie."""
        lines = blocks() + ["*SURFACE, NAME=MIXED", "B, S1", "C, S2", "*TIE, NAME=T, POSITION TOLERANCE=0.1", "MIXED, OVER"]
        upper = [UPPER.node(i, j, 2) for i in range(4) for j in range(3)]
        warnings.simplefilter("default", plm.PlmWarning)
        with self.assertWarnsRegex(plm.PlmWarning, rf"deck.inp:{len(lines)}: .*farthest is node ({'|'.join(map(str, upper))}), at 1;"):
            self.model(lines)
        with self.assertRaisesRegex(FileError, rf"deck.inp:{len(lines)}: .*the nearest, node ({'|'.join(map(str, upper))}), is 1 from"):
            self.model([*lines[:-1], "TOP, OVER"])

    def test_tie(self):
        self.compare(*TIE)

    def test_rigid_body_held(self):
        self.compare("*RIGID BODY, NSET=UNDERNODES, REF NODE=1001, ROT NODE=1002", "*BOUNDARY", "1001, 1, 3", "1002, 1, 3")

    def test_rigid_body_that_moves(self):
        self.compare(*TIE, "*RIGID BODY, NSET=TOPNODES, REF NODE=1003, ROT NODE=1002")

    def test_kinematic_coupling(self):
        self.compare(*TIE, "*COUPLING, REF NODE=1003, SURFACE=TOP, CONSTRAINT NAME=K", "*KINEMATIC", "1, 3")

    def test_equations_and_mpcs(self):
        """CalculiX takes the equations; the MPCs of nodes at one place say the same, BEAM too: the rotation moves nothing."""
        equations = ["*EQUATION"] + [line for a, b in ends() for d in (1, 2, 3) for line in ("2", f"{a}, {d}, 1., {b}, {d}, -1.")]
        self.compare(*equations)
        for kind in ("PIN", "BEAM"):
            self.compare("*MPC", *(f"{kind}, {a}, {b}" for a, b in ends()), by_calculix=equations)

    def test_distributing_coupling(self):
        """By areas: what a force and a moment at the reference do. (CalculiX fails with it in *FREQUENCY.)"""
        constraint = [*TIE, "*COUPLING, REF NODE=1003, SURFACE=TOP, CONSTRAINT NAME=K", "*DISTRIBUTING", "1, 6"]
        step = ["*STEP", "*STATIC", "*CLOAD", "1003, 1, 100.", "1003, 3, 50.", "1003, 5, 70."]
        model = self.model(blocks() + constraint + step + ["*END STEP"], build=False)
        model.add_gap_rows(numpy.eye(1, self.deck.n_dof, self.deck.dof(120, 3)), gap=1e6, stiffness=1.0)  # rest wants a pair
        q = model.build().solve_rest().rest_displacement
        nodes = self.deck.node_sets["TOPNODES"]
        want = self.displacements(blocks() + constraint, step, nodes)
        got = [[q[self.deck.dof(n, d)] for d in (1, 2, 3)] for n in nodes]
        want = numpy.array([want[n] for n in nodes])
        numpy.testing.assert_allclose(got, want, rtol=0, atol=1e-6 * numpy.abs(want).max())

    def test_loads_of_steps(self):
        """Forces of one step add up, those of a later one take their place, OP=NEW ends the others; pressure; weight."""
        step = ["*STEP", "*STATIC", "*CLOAD", "130, 1, 30.", "131, 2, 5.", "130, 1, 10.", "*DLOAD", "C, P2, 3.", "*END STEP",
                "*STEP", "*STATIC", "*CLOAD", "130, 1, 7.", "*DLOAD", "BOTH, GRAV, 1.e9, 0., 3., 4."]
        for more in ([], ["*END STEP", "*STEP", "*STATIC", "*CLOAD, OP=NEW", "131, 1, 2."]):
            model = self.model(blocks() + TIE + step + more + ["*END STEP"], build=False)
            model.add_gap_rows(numpy.eye(1, self.deck.n_dof, self.deck.dof(120, 3)), gap=1e6, stiffness=1.0)
            q = model.build().solve_rest().rest_displacement
            nodes = self.deck.node_sets["TOPNODES"]
            text = self.displacements(blocks() + TIE, step + more, nodes)
            want = numpy.array([text[n] for n in nodes])
            got = [[q[self.deck.dof(n, d)] for d in (1, 2, 3)] for n in nodes]
            numpy.testing.assert_allclose(got, want, rtol=0, atol=1e-6 * numpy.abs(want).max())


if __name__ == "__main__":
    calculix_runs.main()
