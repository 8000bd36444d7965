#!/usr/bin/env python3
"""sources.py ROOT: each section of docs/theory.md that computes something names the files of src that do it, and these exist; every
room of src with numerics is named. (That links lead somewhere is asked of all pages by links.py; here, that there are any.)"""
import pathlib
import re
import sys

root = pathlib.Path(sys.argv[1])
page = (root / "docs/theory.md").read_text(encoding="utf-8")
WITHOUT = {"Notation", "Literature"}
ROOMS = {"structure", "contact", "space", "sampling", "reduction", "motions", "hbm", "orbits", "paths", "searches"}

failures, rooms, count = [], set(), 0
for section in re.split(r"^## ", page, flags=re.M)[1:]:
    title = section.split("\n", 1)[0]
    files = re.findall(r"\[`([\w/]+\.[ch]pp)`\]\(\.\./src/([\w/.]+)\)", section)
    count += len(files)
    for shown, target in files:
        rooms.add(target.split("/")[0])
        if shown != target or not (root / "src" / target).is_file():
            failures.append(f"{title}: {shown} is not at src/{target}")
    if title not in WITHOUT and (not files or "\n* Source: " not in section):
        failures.append(f"{title}: no line '* Source: ...' with a file of src")
failures += [f"no section names a file of src/{room}" for room in sorted(ROOMS - rooms)]
if "## Notation" not in page or page.index("## Notation") > page.index("## Equations of motion"):
    failures.append("the notation does not come first")
print("\n".join(failures) or f"{count} files of {len(rooms)} rooms")
sys.exit(bool(failures) or count < 30)
