#!/usr/bin/env python3
"""same_numbers.py PROGRAM OTHER: both print lines of a name and a number; names and numbers must be the same, to the last bit."""
import subprocess
import sys


def printed(program):
    lines = subprocess.run([program], check=True, capture_output=True, text=True).stdout.splitlines()
    return [(name, float(number.replace("D", "E"))) for name, number in (line.split() for line in lines)]


one, other = (printed(program) for program in sys.argv[1:3])
if len(one) < 2 or len(one) != len(other):
    sys.exit(f"{len(one)} lines against {len(other)}")
different = [f"{a[0]}: {a[1]!r} against {b[0]}: {b[1]!r}" for a, b in zip(one, other) if a != b]
if different:
    sys.exit("\n".join(different))
print(f"{len(one)} numbers, the same to the last bit")
