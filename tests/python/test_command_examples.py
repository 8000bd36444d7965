"""plm response on the decks of examples/decks, nothing set: each comes to its peak to the accuracy, with all of its files and status 0."""
import csv
import pathlib
import re
import shutil
import unittest

from command_case import Folder

DECKS = pathlib.Path(__file__).resolve().parents[2] / "examples" / "decks"


@unittest.skipUnless(shutil.which("ccx"), "no ccx (calculix-ccx) to make matrices")
class Examples(Folder):
    def test_from_deck_to_curve_report_and_motion(self):
        for name in ("cracked_plate", "lap_joint", "lap_joint_nonmatching", "blade_casing"):
            with self.subTest(name):
                out = self.folder / name
                said, _ = self.here("response", str(DECKS / f"{name}.inp"), "--out", str(out), "--frames", "4")
                self.assertIn("the motion of the peak is stable", said)
                self.assertLess(float(re.search("may be off by ([^ ]+) of itself", said)[1]), 1e-3)
                self.assertLessEqual({"report.md", "response.csv", "peak.pvd", "peak_000.vtu", "peak_003.vtu"}, {one.name for one in out.iterdir()})
                hz, amplitude = map(float, re.search(r"^Peak\n  (\S+) at (\S+) Hz", said, re.M).groups()[::-1])
                with open(out / "response.csv", encoding="ascii") as file:
                    rows = [[float(x) for x in row[:2]] for row in list(csv.reader(file))[1:]]
                highest = max(rows, key=lambda row: row[1])
                self.assertAlmostEqual(highest[1] / amplitude, 1, delta=0.02)  # between its points
                self.assertAlmostEqual(highest[0] / hz, 1, delta=0.01)


if __name__ == "__main__":
    unittest.main()
