#!/usr/bin/env python3
"""first_lines.py ROOT: the way of a new user is short: each program of README.md and docs/getting-started.md has at most ten lines with
calls of the library up to the one that returns the peak, those that hand over the two matrices left out."""
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import page as pages  # noqa: E402

ROOT, MOST = pathlib.Path(sys.argv[1]), 10
MAIN = {".c": r"int main\b", ".cpp": r"int main\b", ".f90": r"program \w", ".f": r" +PROGRAM ", ".py": r"import plm"}
CALL = {".c": r"\bplm_\w+\(", ".cpp": r"\bmodel[.(]|\bcontext[.;]", ".f90": r"call (?:\w+%|plm_)", ".f": r" CALL PLM", ".py": r"\b(?:plm|model)\.\w+\("}
MATRIX = re.compile(r"PLM_(?:MASS|STIFFNESS)\b|set_mass|set_stiffness|Model\(mass=|PLMMMX")
PEAK = re.compile(r"compute_response|PLMMRP")


def lines_to_the_peak(text, kind):
    begin = re.search(rf"^{MAIN[kind]}", text, re.M).start()
    lines = text[begin:].splitlines()
    last = next(i for i, line in enumerate(lines) if PEAK.search(line))
    return [line for line in lines[:last + 1] if re.search(CALL[kind], line) and not MATRIX.search(line)]


failures, found = [], {}
for page in ("README.md", "docs/getting-started.md"):
    for name, text in pages.named_blocks(ROOT / page, "file").items():
        if pathlib.Path(name).suffix in MAIN and PEAK.search(text):
            lines = lines_to_the_peak(text, pathlib.Path(name).suffix)
            found[f"{page}: {name}"] = len(lines)
            if len(lines) > MOST:
                failures.append(f"{page}: {name}: {len(lines)} lines up to the peak; there may be {MOST}:\n" + "\n".join(lines))
print("\n".join(failures) or ", ".join(f"{name} {count}" for name, count in found.items()))
sys.exit(bool(failures) or len(found) < 8 or min(found.values()) < 3)
