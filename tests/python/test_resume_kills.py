"""A curve that is written every ten points, killed (SIGKILL) at random moments: whatever is left in the file is a whole branch,
and goes on with the identical points; now and then it is killed again while it goes on.

    test_resume_kills.py [KILLS]    fifty, where nothing is said
"""
import pathlib
import random
import signal
import subprocess
import sys
import tempfile
import time
import unittest
import warnings

import plm

import models
from test_resume import same

KILLS = int(sys.argv.pop()) if len(sys.argv) > 1 and sys.argv[-1].isdigit() else 50
OPTIONS = ({"max_step": 0.03}, {"motion": "harmonics", "max_step": 0.05})
CHILD = """
import sys, warnings, plm
warnings.simplefilter("ignore")
folder, which, resume = sys.argv[1], int(sys.argv[2]), sys.argv[3] == "1"
sys.path.insert(0, sys.argv[4])
from test_resume_kills import OPTIONS
basis = plm.Basis.from_bytes(open(folder + "/basis.plm", "rb").read(), plm.Context())
hbm = plm.Hbm(basis, **OPTIONS[which])
hbm.save_every(10, folder + "/curve.plm")
print("begins", flush=True)
if resume:
    hbm.resume(plm.Branch.from_bytes(basis, open(folder + "/curve.plm", "rb").read()))
else:
    hbm.sweep()
"""


class Kills(unittest.TestCase):
    def setUp(self):
        warnings.simplefilter("ignore")
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.basis = models.basis()
        (self.folder / "basis.plm").write_bytes(self.basis.to_bytes())
        self.curve = self.folder / "curve.plm"
        self.chance = random.Random(1848)

    def start(self, which, resume):
        child = subprocess.Popen([sys.executable, "-c", CHILD, str(self.folder), str(which), "1" if resume else "0",
                                  str(pathlib.Path(__file__).parent)], stdout=subprocess.PIPE, text=True)
        self.assertEqual(child.stdout.readline(), "begins\n")
        return child

    def kill(self, child, after):
        """True: it was killed on its way."""
        time.sleep(after)
        child.send_signal(signal.SIGKILL)
        child.wait()
        child.stdout.close()
        return child.returncode == -signal.SIGKILL

    def read(self):
        return plm.Branch.from_bytes(self.basis, self.curve.read_bytes())

    def test_kills_at_random_moments(self):
        kills, lengths, killed_again, known = 0, set(), 0, {}
        while kills < KILLS:
            which = kills % len(OPTIONS)
            hbm = plm.Hbm(self.basis, **OPTIONS[which])
            if which not in known:
                begin = time.monotonic()
                known[which] = hbm.sweep(), time.monotonic() - begin
            whole, takes = known[which]
            self.curve.unlink(missing_ok=True)
            if not self.kill(self.start(which, False), self.chance.uniform(0, takes)):
                continue
            kills += 1
            if not self.curve.exists():
                continue  # before its tenth point: it begins anew
            part = self.read()
            lengths.add(len(part))
            if part.end_reason != plm.REASON_UNFINISHED:
                continue  # at its end, before its process ended
            if kills % 3 == 0:
                killed_again += self.kill(self.start(which, True), self.chance.uniform(0, 0.5 * takes))
                part = self.read()
            if part.end_reason == plm.REASON_UNFINISHED:
                part = hbm.resume(part)
            self.assertTrue(same(part, whole), (kills, len(part)))
        if KILLS >= 50:
            self.assertGreater(len(lengths), 4)
            self.assertGreater(killed_again, 3)
        # what a kill leaves beside the file has another name, and is never taken for it
        beside = {one.name for one in self.folder.iterdir()} - {"basis.plm", "curve.plm"}
        self.assertTrue(all(name.startswith("curve.plm.") for name in beside))


if __name__ == "__main__":
    unittest.main()
