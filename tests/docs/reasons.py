#!/usr/bin/env python3
"""reasons.py ROOT: every PLM_REASON_... of plm.h has its row in the table of docs/choosing.md, with a cause and a remedy, and no row
is of another; the words that a row has in quotation marks are in a text of the library, so that a user finds them."""
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "house"))
import texts  # noqa: E402

root = pathlib.Path(sys.argv[1])
header = (root / "include/plm/plm.h").read_text(encoding="utf-8")
reasons = re.findall(r"^#define (PLM_REASON_\w+)", header, re.M)
said = "\n".join(" ".join(text.split()) for path in sorted((root / "src").rglob("*.cpp")) for _, text in texts.texts_of(path))

rows, failures, quotes = {}, [], 0
for line in (root / "docs/choosing.md").read_text(encoding="utf-8").splitlines():
    found = re.match(r"\| `(PLM_REASON_\w+)` \|(.*)\|$", line)
    if found:
        if found[1] in rows:
            failures.append(f"{found[1]}: two rows")
        rows[found[1]] = [cell.strip() for cell in found[2].split("|")]

for name in reasons:
    if name not in rows:
        failures.append(f"{name}: no row in docs/choosing.md")
        continue
    symptom, cause, remedy = rows[name]
    if name != "PLM_REASON_NONE" and not (symptom and cause and remedy):
        failures.append(f"{name}: symptom, cause or remedy is empty")
    for words in re.findall(r'"([^"]+)"', symptom):
        quotes += 1
        if words not in said:
            failures.append(f"{name}: no text of the library says '{words}'")
failures += [f"{name}: no reason of plm.h" for name in rows if name not in reasons]
print("\n".join(failures) or f"{len(reasons)} reasons, {quotes} quotations")
sys.exit(bool(failures) or len(reasons) < 25 or quotes < 20)
