#!/usr/bin/env python3
"""texts.py SRC: what the core says to people. A host may be Python or Fortran, where no C function has its C name: texts
outside capi/ say what to do in the terms of the API. Prints the offending lines.
"""
import pathlib
import re
import sys

NAMES_A_FUNCTION = re.compile(r'"(?:[^"\\]|\\.)*\bplm_(?:context|model|sampler|basis|hbm|branch|transient|study)_')


def main():
    source = pathlib.Path(sys.argv[1])
    files = [path for path in sorted(source.rglob("*.[ch]pp")) if path.relative_to(source).parts[0] != "capi"]
    wrong = [f"{path.relative_to(source)}:{number}: a text names a C function: {line.strip()}" for path in files
             for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1) if NAMES_A_FUNCTION.search(line)]
    if len(files) < 100:
        wrong.append(f"{source}: only {len(files)} files were found")
    print("\n".join([*wrong, f"{len(files)} files, {len(wrong)} wrong"]))
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
