"""The decks of examples/decks against CalculiX itself: natural frequencies without contact, and rest of the bolted joint."""
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
import warnings

import numpy
import plm
import scipy.sparse.linalg

from plm.fe import read_deck

DECKS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "examples", "decks")


def calculix(folder, lines):
    """Runs a deck. Returns the text of its .dat file."""
    with open(os.path.join(folder, "job.inp"), "w", encoding="ascii") as file:
        file.write("\n".join(lines) + "\n")
    done = subprocess.run(["ccx", "job"], cwd=folder, capture_output=True, text=True, timeout=120,
                          env={**os.environ, "OMP_NUM_THREADS": "1"}, check=False)
    if "*ERROR" in done.stdout:
        raise AssertionError(done.stdout[-2000:])
    with open(os.path.join(folder, "job.dat"), encoding="ascii") as file:
        return file.read()


class Decks(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.folder)
        warnings.simplefilter("ignore", plm.PlmWarning)

    def lines(self, name, *more):
        """A deck for CalculiX of the mesh and what is said here."""
        shutil.copy(os.path.join(DECKS, name + "_mesh.inp"), os.path.join(self.folder, "mesh.inp"))
        return ["*INCLUDE, INPUT=mesh.inp", *more]

    def frequencies(self, name, n):
        """The lowest ones that CalculiX finds, and how many rigid motions come first."""
        text = calculix(self.folder, self.lines(name, "*STEP", "*FREQUENCY", str(n), "*END STEP"))
        table = text[text.index("E I G E N"):text.index("P A R T I C I P A T I O N")]
        rows = re.findall(r"^ +\d+ +(\S+) +\S+ +(\S+) +\S+$", table, re.M)
        return numpy.array([float(hz) for _, hz in rows])

    def compare(self, name, n, n_rigid):
        model = read_deck(os.path.join(DECKS, name + ".inp")).model()
        self.assertEqual(model.n_rigid_modes, n_rigid)
        want = self.frequencies(name, n)[n_rigid:]
        self.assertGreaterEqual(len(want), n - n_rigid)
        # printed with seven digits, 5e-7 of the smallest mantissa; half of those asked for, the others Lanczos has not finished
        half = len(want) // 2
        numpy.testing.assert_allclose(model.modes(n_rigid + half)[n_rigid:], want[:half], rtol=1e-6)

    def test_frequencies_of_the_plate(self):
        self.compare("cracked_plate", 20, 0)

    def test_frequencies_of_the_blade(self):
        self.compare("blade_casing", 20, 0)

    def test_frequencies_of_the_joint(self):
        self.compare("lap_joint", 26, 6)

    def test_frequencies_of_the_joint_that_does_not_match(self):
        self.compare("lap_joint_nonmatching", 26, 6)

    # ---- rest ----

    def displacement(self, name, deck):
        """CalculiX's static contact step, the joint held at three nodes so that it can only strain: n x 3."""
        with open(os.path.join(DECKS, name + ".inp"), encoding="ascii") as file:
            text = file.read()
        contact = text[text.index("*SURFACE INTERACTION"):text.index("*STEP, NAME=TIGHTEN")].split("\n")
        loads = text[text.index("*CLOAD"):text.index("*END STEP")].strip().split("\n")
        lower = deck.node_sets["LOWER"]
        xyz = dict(zip(deck.node_labels.tolist(), deck.coordinates.tolist()))
        at = {tuple(xyz[n]): n for n in lower.tolist()}
        held = [f"{at[0, 0, 0]}, 1, 3", f"{at[0, 40, 0]}, 1", f"{at[0, 40, 0]}, 3", f"{at[100, 0, 0]}, 3"]
        dat = calculix(self.folder, self.lines(name, *contact[:-1], "*BOUNDARY", *held, "*NSET, NSET=EVERY", "LOWER, UPPER, BOLTS",
                                               "*STEP, INC=100", "*STATIC", "1., 1.", *loads, "*NODE PRINT, NSET=EVERY", "U",
                                               "*END STEP"))
        u = numpy.zeros((len(deck.node_labels), 3))
        rows = re.findall(r"^ +(\d+) +(\S+) +(\S+) +(\S+)$", dat, re.M)
        self.assertEqual(len(rows), len(deck.node_labels))
        for label, *values in rows:
            u[deck.node_rows([int(label)])[0]] = [float(v) for v in values]
        return u

    def contact_forces(self, deck, u, nodes):
        """What presses on nodes along z: the elements' forces there, with their inner nodes condensed. Only elements act there."""
        K, dofs = deck.matrices.stiffness.tocsc(), deck.matrices.dofs
        known = numpy.isin(dofs[:, 0], deck.node_labels)
        q = numpy.zeros(len(dofs))
        q[known] = [u[deck.node_rows([n])[0], d - 1] for n, d in dofs[known]]
        inner = numpy.flatnonzero(~known)
        q[inner] = scipy.sparse.linalg.spsolve(K[inner][:, inner], -(K @ q)[inner])
        return numpy.array([(K @ q)[deck.dof(n, 3)] for n in nodes])

    def rest(self, name):
        deck = read_deck(os.path.join(DECKS, name + ".inp"))
        model = deck.model().solve_rest()
        nodes = deck.surfaces["UPPERFACE"].nodes[model.surface_point]
        want = self.contact_forces(deck, self.displacement(name, deck), nodes)
        return model.rest_force, want

    def check_rest(self, name):
        got, want = self.rest(name)
        self.assertGreater(want.max(), 100)
        # what CalculiX prints of displacements leaves forces of 1e-3 of the largest at open nodes
        numpy.testing.assert_array_equal(got > 0, want > 2e-3 * want.max())
        self.assertLess(abs(got.sum() - want.sum()), 0.01 * want.sum())
        numpy.testing.assert_allclose(got, want, rtol=0.01, atol=2e-3 * want.max())

    def test_rest_of_the_joint(self):
        self.check_rest("lap_joint")

    def test_rest_of_the_joint_that_does_not_match(self):
        self.check_rest("lap_joint_nonmatching")


if __name__ == "__main__":
    if shutil.which("ccx") is None:
        print("skipped: no ccx (Debian: calculix-ccx)")
        sys.exit(77)
    unittest.main()
