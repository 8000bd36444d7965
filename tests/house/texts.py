#!/usr/bin/env python3
"""texts.py SRC: what the library says to people. A host may be Python or Fortran, where no C function has its C name: texts say what
to do in the terms of the API. Prints the offending lines.

A text is what the compiler makes of literals side by side. In capi/ one that is nothing but a name is no text: it tells the exception
barrier which function this is.
"""
import pathlib
import re
import sys

LITERALS = re.compile(r'"(?:[^"\\\n]|\\.)*"(?:\s*"(?:[^"\\\n]|\\.)*")*')
NAMES_A_FUNCTION = re.compile(r"\bplm_(?:context|model|sampler|basis|hbm|branch|transient|study)_")


def texts_of(path):
    """(line, text) of the literals of a file; comments are left out."""
    code = re.sub(r'("(?:[^"\\\n]|\\.)*")|\'(?:\\.|[^\'\\\n])+\'|//[^\n]*', lambda m: m.group(1) or "", path.read_text(encoding="utf-8"))
    code = re.sub(r"^#include.*$", "", code, flags=re.M)
    for found in LITERALS.finditer(code):
        yield code.count("\n", 0, found.start()) + 1, re.sub(r'"\s*"', "", found.group())[1:-1]


def main():
    source = pathlib.Path(sys.argv[1])
    files = sorted(source.rglob("*.[ch]pp"))
    wrong = []
    for path in files:
        name = path.relative_to(source)
        for number, text in texts_of(path):
            is_name = name.parts[0] == "capi" and re.fullmatch(r"\w+", text)
            if NAMES_A_FUNCTION.search(text) and not is_name:
                wrong.append(f"{name}:{number}: a text names a C function: {text}")
    if len(files) < 200:
        wrong.append(f"{source}: only {len(files)} files were found")
    print("\n".join([*wrong, f"{len(files)} files, {len(wrong)} wrong"]))
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
