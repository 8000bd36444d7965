"""Runs CalculiX on decks and reads what it prints; for the tests that compare with it."""
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

DECKS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "examples", "decks")


def main():
    """As unittest.main; skipped where there is no CalculiX."""
    if shutil.which("ccx") is None:
        print("skipped: no ccx (Debian: calculix-ccx)")
        sys.exit(77)
    unittest.main()


class Case(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.folder)
        warnings.simplefilter("ignore", plm.PlmWarning)

    def run_deck(self, lines):
        """The text of the .dat file."""
        with open(os.path.join(self.folder, "job.inp"), "w", encoding="ascii") as file:
            file.write("\n".join(lines) + "\n")
        done = subprocess.run(["ccx", "job"], cwd=self.folder, capture_output=True, text=True, timeout=600,
                              env={**os.environ, "OMP_NUM_THREADS": "1"}, check=False)
        self.assertNotIn("*ERROR", done.stdout)
        with open(os.path.join(self.folder, "job.dat"), encoding="ascii") as file:
            return file.read()

    def on_mesh(self, name, *more):
        """Lines of a deck on the mesh of an example; ccx wants short names of files."""
        shutil.copy(os.path.join(DECKS, name + "_mesh.inp"), os.path.join(self.folder, "mesh.inp"))
        return ["*INCLUDE, INPUT=mesh.inp", *more]

    def frequencies(self, lines, n):
        """Hz, of the first n modes; what Lanczos finds of negative eigenvalues (rigid motions) is 0."""
        text = self.run_deck([*lines, "*STEP", "*FREQUENCY", str(n), "*END STEP"])
        table = text[text.index("E I G E N"):text.index("P A R T I C I P A T I O N")]
        return numpy.array([float(hz) for hz in re.findall(r"^ +\d+ +\S+ +\S+ +(\S+) +\S+$", table, re.M)])

    def displacements(self, lines, step, labels):
        """{label: x, y, z} at the end of a static step."""
        every = ["*NSET, NSET=EVERY", *(f"{label}," for label in labels)]
        text = self.run_deck([*lines, *every, *step, "*NODE PRINT, NSET=EVERY", "U", "*END STEP"])
        rows = re.findall(r"^ +(\d+) +(\S+) +(\S+) +(\S+)$", text, re.M)
        self.assertEqual(len(rows), len(labels))
        return {int(label): [float(v) for v in values] for label, *values in rows}
