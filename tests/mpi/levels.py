#!/usr/bin/env python3
"""levels.py LEVELS MPIRUN...: the levels shared out over three ranks have the curves of one rank, to the last digit that is printed."""
import subprocess
import sys

program, mpirun = sys.argv[1], sys.argv[2:]
one, three = (subprocess.run(mpirun + ["-n", str(n), program], check=True, text=True, capture_output=True).stdout for n in (1, 3))
rows = [line.split() for line in one.splitlines()[2:]]
peaks = [float(row[2]) for row in rows]
print(one)
if len(rows) != 6 or any(not 0 < a < b for a, b in zip(peaks, peaks[1:])):
    sys.exit("six levels with growing peaks are expected")
if one != three:
    sys.exit("three ranks say otherwise:\n" + three)
