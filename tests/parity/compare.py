"""Runs a program and compares what it prints with a file: compare.py REFERENCE -- PROGRAM [ARGUMENT...]

Headings must be equal and numbers equal to the last digit, however a language writes them (1.0E+00 is 1).
"""
import struct
import subprocess
import sys


def lines_of(text):
    return [line.strip() for line in text.splitlines() if line.strip()]


def output(command):
    done = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=False)
    if done.returncode:
        sys.exit(f"{command[0]} returned {done.returncode}")
    return lines_of(done.stdout)


def value(line):
    """The bits of a number (a zero has no sign), or the heading."""
    try:
        return struct.pack("d", float(line) + 0.0)
    except ValueError:
        return line


def main():
    cut = sys.argv.index("--")
    with open(sys.argv[1], encoding="utf-8") as file:
        wanted = lines_of(file.read())
    found = output(sys.argv[cut + 1:])
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
