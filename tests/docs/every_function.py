#!/usr/bin/env python3
"""every_function.py ROOT [PLM_H]: every function of plm.h has an example in docs/examples, which the reference shows and a
test runs. An example stands between two comment lines that hold the function's name in brackets, and calls it."""
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "src/capi/api"))
import plm_header  # noqa: E402

root = pathlib.Path(sys.argv[1])
header = pathlib.Path(sys.argv[2]) if len(sys.argv) > 2 else root / "include/plm/plm.h"
folder = root / "docs/examples"
functions = [f.name for f in plm_header.read(header).functions]

shown = {}  # function: (file, the lines between its marks)
failures = []
for path in sorted(folder.glob("*.c")):
    open_marks = {}
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        marks = re.findall(r"\[(plm_\w+)\]", line) if re.match(r"\s*/\* \[", line) else []
        for name in marks:
            if name in open_marks:
                shown[name] = (path.name, "\n".join(open_marks.pop(name)))
            elif name in shown:
                failures.append(f"{path.name}:{number}: {name} is marked a second time")
            else:
                open_marks[name] = []
        for lines in open_marks.values():
            lines.append(line)
    failures += [f"{path.name}: [{name}] opens and does not close" for name in open_marks]


def file_of(name):
    noun = name.split("_")[1]
    return f"{noun}.c" if (folder / f"{noun}.c").exists() else "library.c"


for name in functions:
    if name not in shown:
        failures.append(f"{name}: no example. Write one in docs/examples/{file_of(name)}, between two lines\n"
                        f"    /* [{name}] */\n"
                        f"and call there {name}(...); docs.example_{file_of(name)[:-2]} runs it.")
    elif not re.search(rf"\b{name}\(", re.sub(r"/\*.*?\*/", "", shown[name][1], flags=re.S)):
        failures.append(f"{name}: its example in {shown[name][0]} does not call it")
failures += [f"{place}: [{name}] is no function of plm.h" for name, (place, _) in shown.items() if name not in functions]

print("\n".join(failures) or f"{len(functions)} functions, each with an example that is compiled and run")
sys.exit(bool(failures) or len(functions) < 90)
