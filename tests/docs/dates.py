#!/usr/bin/env python3
"""dates.py ROOT: docs/benchmarks.md names for each page of measurements the day of its numbers, and each such page has the command
that makes them."""
import pathlib
import re
import sys

root = pathlib.Path(sys.argv[1])
text = (root / "docs/benchmarks.md").read_text(encoding="utf-8")
rows = re.findall(r"^\| \[[^\]]+\]\(([^)]+)\) \|.*\| ([^|]*) \|$", text, re.M)
failures = [f"{page}: '{day}' is no day" for page, day in rows if not re.fullmatch(r"20\d\d-[01]\d-[0-3]\d", day)]
for page, _ in rows:
    path = (root / "docs" / page).resolve()
    if not re.search(r"^(?: {4}|\S+ `?).*(?:build/|python3 |plm-study)", path.read_text(encoding="utf-8"), re.M):
        failures.append(f"{page} names no command")
measured = {path.name for path in (root / "docs").glob("*.md")} & {"exact-motions.md", "extreme.md", "campaign.md", "defaults.md", "scale.md", "comparison.md"}
failures += [f"docs/benchmarks.md has no row for {name}" for name in sorted(measured - {page for page, _ in rows})]
print("\n".join(failures) or f"{len(rows)} pages of measurements")
sys.exit(bool(failures) or len(rows) < 6)
