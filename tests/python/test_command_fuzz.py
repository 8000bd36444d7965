"""Damaged case files and tables: the command refuses them in words, whatever stands there; it never ends in a defect of its own.

    test_command_fuzz.py [SECONDS [SEED]]    see fuzzing.py
"""
import contextlib
import io
import os
import random
import sys
import time
import unittest

from plm.command import main

from command_case import Folder
from fuzzing import seconds_and_seed

SECONDS, SEED = seconds_and_seed(2.0, 4)
CASE = '''model = ["K.mtx", "M.mtx"]
dofs = "dofs.txt"
coordinates = "xyz.csv"
force = [[20, "x", 0.6], [20, "x", 0.8, 90]]
fix = [10, "all"]
preload = [20, "x", 1.5]
output = [20, "x"]
measure = "rms"
rayleigh = [0, 2e-4]
accuracy = 1e-3
effort = 1
threads = 1
count = 2
system = "open"
harmonics = [1, 2]
symmetric = true

[[contact]]
node = 20
direction = "-x"
gap = 1e-4
stiffness = 5000
'''
PIECES = ["", "0", "-1", "1e400", "-1e400", "nan", "inf", "9" * 400, "true", "'x'", "''", "[]", "[[]]", "[[[1]]]", "{}", "{ a = 1 }",
          "2026-01-01", "[1, 'x', {}]", "[20, 'x']", "[20, 'x', nan]", "'\\u0000'", '"""', "=", "[", "]", "#", "\n", "\x00", "é", ",", "20",
          "x", "-x", "9223372036854775808", "K.mtx", ".", "..", "/dev/null"]


def damaged(text, chance):
    """One to three places changed: a value, a piece of the text, a line that is gone or comes twice."""
    for _ in range(chance.randint(1, 3)):
        lines = text.split("\n")
        i = chance.randrange(len(lines))
        kind = chance.randrange(5)
        if kind == 0 and "=" in lines[i]:
            lines[i] = lines[i].split("=")[0] + "= " + chance.choice(PIECES)
        elif kind == 1 and "," in lines[i]:
            fields = lines[i].split(",")
            fields[chance.randrange(len(fields))] = chance.choice(PIECES)
            lines[i] = ",".join(fields)
        elif kind == 2:
            at = chance.randrange(len(lines[i]) + 1)
            lines[i] = lines[i][:at] + chance.choice(PIECES) + lines[i][at + chance.randrange(3):]
        elif kind == 3:
            lines[i] = lines[chance.randrange(len(lines))]
        else:
            del lines[i]
        text = "\n".join(lines) or "\n"
    return text


class Damage(Folder):
    def test_damage_by_chance(self):
        self.write("case.toml", CASE)
        whole = {name: (self.folder / name).read_text() for name in ("case.toml", "dofs.txt", "xyz.csv", "pairs.csv")}
        chance, tried, seen = random.Random(SEED), 0, set()
        os.chdir(self.folder)
        self.addCleanup(os.chdir, "/")
        end = time.monotonic() + SECONDS
        while time.monotonic() < end:
            name = chance.choice(list(whole))
            (self.folder / name).write_bytes(damaged(whole[name], chance).encode("utf-8", "surrogatepass"))
            arguments = ["modes", "case.toml", *(["--contact", "pairs.csv"] if name == "pairs.csv" else [])]
            out, err = io.StringIO(), io.StringIO()
            with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
                status = main(arguments)
            told = f"{name}:\n{(self.folder / name).read_text(errors='replace')}\n{err.getvalue()}"
            self.assertIn(status, (0, 1, 2, 3), told)
            self.assertNotIn("defect of plm", err.getvalue(), told)
            if status == 2:
                self.assertRegex(err.getvalue(), "^plm: .*\n", told)
            self.write(name, whole[name])
            tried, seen = tried + 1, seen | {status}
        self.assertGreater(tried, 20)
        self.assertTrue({0, 2} <= seen, seen)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
