"""Runs programs and compares what they print: compare.py REFERENCE -- PROGRAM [ARGUMENT...]

Headings must be equal and numbers equal to the last digit, however a language writes them (1.0E+00 is 1). The first
program is the reference.
"""
import struct
import subprocess
import sys


def output(command):
    done = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=False)
    if done.returncode:
        sys.exit(f"{command[0]} returned {done.returncode}")
    return [line.strip() for line in done.stdout.splitlines() if line.strip()]


def value(line):
    """The bits of a number (a zero has no sign), or the heading."""
    try:
        return struct.pack("d", float(line) + 0.0)
    except ValueError:
        return line


def main():
    cut = sys.argv.index("--")
    wanted, found = output(sys.argv[1:cut]), output(sys.argv[cut + 1:])
    heading = "the first line"
    for number, (a, b) in enumerate(zip(wanted, found), 1):
        if value(a) != value(b):
            sys.exit(f"line {number} (under {heading}): {a} in the reference, {b} here")
        if isinstance(value(a), str):
            heading = a
    if len(wanted) != len(found) or len(wanted) < 100:
        sys.exit(f"{len(wanted)} lines in the reference, {len(found)} here")
    print(f"{len(wanted)} lines are the same")


if __name__ == "__main__":
    main()
