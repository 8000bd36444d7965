#!/usr/bin/env python3
"""close_numbers.py REFERENCE PROGRAM FILE: the lines both print under the same name agree to 1e-5, and the curve that
PROGRAM writes to FILE reaches its peak."""
import csv
import subprocess
import sys


def printed(*command):
    result = {}
    for line in subprocess.run(command, check=True, capture_output=True, text=True).stdout.splitlines():
        name, *rest = line.split() or [""]
        try:
            result[name] = [float(number) for number in rest]
        except ValueError:
            pass
    return result


reference = printed(sys.argv[1])
found = printed(sys.argv[2], sys.argv[3])
names = ["open_hz", "sliding_hz", "peak_hz", "peak_mm"]
for name in names:
    for want, got in zip(reference[name], found[name], strict=True):
        if not abs(got / want - 1) < 1e-5:
            sys.exit(f"{name}: {got} in Fortran, {want} in C")
with open(sys.argv[3], encoding="ascii") as file:
    amplitude = [float(row["amplitude_mm"]) for row in csv.DictReader(file)]
if not 0.9 < max(amplitude) / found["peak_mm"][0] < 1 + 1e-6:
    sys.exit(f"the curve's highest point is {max(amplitude)}, the peak {found['peak_mm'][0]}")
print(f"{sum(len(reference[name]) for name in names)} numbers agree; {len(amplitude)} points in the file")
